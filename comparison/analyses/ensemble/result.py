"""The file in which an ensemble is kept beside a report: fractiles, the curve of every motion, the engine's subset."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field
from typing import Any, Literal

from comparison.analyses.ensemble.analysis import FRACTILES, EnsembleResult, Point, Quantity, quantities
from comparison.json_file import StoredFile, finite_or_none
from comparison.result_types import result
from reference.measures import Estimate
from reference.measures.peak_demands import unit_of

FILE, PICTURE = "ensemble.json", "ensemble.png"
SCHEMA: Literal["phase-resonance/ensemble/2"] = "phase-resonance/ensemble/2"


@result
class StoredFractile:
    """A fractile of a demand over the motions."""

    share: float
    """part of the motions below it"""
    value: float | None
    """in the unit of the demand; null where it falls on a motion without an answer"""
    error: float | None
    """largest change within the errors of the motions"""


@result
class StoredNumber:
    """A statistic of a demand over the motions."""

    value: float | None
    """in the unit of the demand; null where it rests on a motion without an answer"""
    error: float | None
    """largest change within the errors of the motions"""


@result
class StoredStructure:
    """What the statistics are of: a file, or one of the values that run in it beside motion and scale."""

    name: str
    """name"""
    title: str
    """title of its scenes"""
    bodies: int
    """number of bodies"""
    weight: float
    """N"""


@result
class StoredSpectrum:
    """Floor spectrum of a body over all motions at the largest scale, by the equations; the larger of x and y."""

    structure: str
    """name"""
    body: int
    """from 1"""
    scale: float
    """factor of the motions"""
    damping: float
    """damping ratio of the oscillators"""
    period: Sequence[float]
    """s"""
    mean: Sequence[StoredNumber]
    """pseudo-acceleration at every period, m/s^2"""
    fractiles: Sequence[Sequence[StoredNumber]]
    """16, 50 and 84 % at every period, m/s^2"""
    largest: Sequence[StoredNumber]
    """at every period, m/s^2"""


@result
class StoredStripe:
    """A demand at one scale over all motions by one model."""

    structure: str
    """name"""
    model: str
    """key of the model"""
    quantity: str
    """demand"""
    body: int | None
    """from 1, counted from the platform; null for the isolator"""
    unit: str
    """SI; empty for a pure number"""
    scale: float
    """factor of the motions"""
    answered: int
    """motions that have the demand"""
    mean: StoredNumber
    """mean over the motions"""
    fractiles: Sequence[StoredFractile]
    """from small to large shares"""
    largest: StoredNumber
    """largest over the motions"""
    smallest: StoredNumber
    """smallest over the motions"""
    reasons: Mapping[str, int] = field(default_factory=dict)
    """why the other motions do not have it, and how many each"""


@result
class StoredCurve:
    """A demand of one motion over its scale factors."""

    structure: str
    """name"""
    quantity: str
    """demand"""
    body: int | None
    """from 1; null for the isolator"""
    model: str
    """key of the model"""
    motion: str
    """what runs beside the scale"""
    scales: Sequence[float]
    """factors of the motion"""
    values: Sequence[float | None]
    """in the unit of the demand; null without an answer"""
    errors: Sequence[float | None]
    """error estimates of the values"""


@result
class StoredDifference:
    """How far the engine is from the equations in one demand."""

    structure: str
    """name"""
    quantity: str
    """demand"""
    body: int | None
    """from 1; null for the isolator"""
    largest: float | None
    """relative difference from the equations of the ensemble; null without a common point"""
    like_for_like: float | None
    """relative difference from the equations with the engine's friction law"""
    errors: float | None
    """the two error estimates together, relative"""
    points: int
    """motions that both sides have"""


@result
class StoredEngine:
    """The engine at its subset."""

    model: str
    """key of the model"""
    points: Sequence[Mapping[str, str]]
    """scene and status of every motion"""
    differences: Sequence[StoredDifference]
    """one for each demand"""


@result
class StoredEnsemble:
    """Content of the file."""

    schema: Literal["phase-resonance/ensemble/2"]
    """what the file is"""
    structures: Sequence[StoredStructure]
    """what the statistics are of"""
    scales: Sequence[float]
    """scale factors"""
    motions: int
    """number of motions"""
    outcomes: Mapping[str, int]
    """motions by the equations with every status"""
    stripes: Sequence[StoredStripe]
    """by structure, demand and scale; by the equations, then by the engine over its subset"""
    curves: Sequence[StoredCurve]
    """by structure, demand, model and motion"""
    spectra: Sequence[StoredSpectrum]
    """by structure and body"""
    engine: StoredEngine
    """the engine's subset"""
    run: Mapping[str, Any]
    """command, times, provenance"""


STORED = StoredFile(FILE, StoredEnsemble, "an ensemble", "python -m comparison.ensemble")


def stored(result: EnsembleResult, run: Mapping[str, Any]) -> StoredEnsemble:
    """The content of the file."""
    stripes = [
        StoredStripe(
            stripe.structure,
            stripe.model,
            *_named(stripe.quantity),
            unit_of(stripe.quantity[0]),
            stripe.scale,
            stripe.answered,
            StoredNumber(*_finite(stripe.mean)),
            [StoredFractile(share, *_finite(value)) for share, value in zip(FRACTILES, stripe.fractiles)],
            StoredNumber(*_finite(stripe.largest)),
            StoredNumber(*_finite(stripe.smallest)),
            stripe.reasons,
        )
        for stripe in result.stripes
    ]
    curves = [
        _curve(structure.name, quantity, [point for point in own if point.curve == motion])
        for structure in result.structures
        for quantity in quantities([*result.points, *result.engine])
        for points in (result.points, result.engine)
        for own in [[point for point in points if point.structure == structure.name]]
        if quantity in quantities(own)
        for motion in dict.fromkeys(point.curve for point in own)
    ]
    differences = [
        StoredDifference(
            bound.structure,
            *_named(bound.quantity),
            finite_or_none(bound.largest),
            finite_or_none(bound.like_for_like),
            finite_or_none(bound.errors),
            bound.points,
        )
        for bound in result.bounds
    ]
    spectra = [
        StoredSpectrum(
            band.structure,
            band.body,
            band.scale,
            band.damping,
            band.period,
            _numbers(band.mean),
            [_numbers(row) for row in band.fractiles],
            _numbers(band.largest),
        )
        for band in result.spectra
    ]
    asked = [{"scene": point.scene, "status": point.status} for point in result.engine]
    return StoredEnsemble(
        schema=SCHEMA,
        structures=[StoredStructure(each.name, each.title, each.bodies, each.weight) for each in result.structures],
        scales=sorted({point.scale for point in result.points}),
        motions=result.motions(),
        outcomes=result.outcomes(),
        stripes=stripes,
        curves=curves,
        spectra=spectra,
        engine=StoredEngine(result.model.key, asked, differences),
        run=run,
    )


def _numbers(estimates: Sequence[Estimate]) -> list[StoredNumber]:
    return [StoredNumber(*_finite(estimate)) for estimate in estimates]


def _named(quantity: Quantity) -> tuple[str, int | None]:
    return quantity[0], quantity[1] or None


def _finite(estimate: Estimate) -> tuple[float | None, float | None]:
    return finite_or_none(estimate.value), finite_or_none(estimate.error)


def _curve(structure: str, quantity: Quantity, points: Sequence[Point]) -> StoredCurve:
    points = sorted(points, key=lambda point: point.scale)
    values, errors = zip(*(_finite(point.estimate(quantity)) for point in points))
    scales = [point.scale for point in points]
    return StoredCurve(
        structure, *_named(quantity), points[0].model, points[0].curve, scales, list(values), list(errors)
    )
