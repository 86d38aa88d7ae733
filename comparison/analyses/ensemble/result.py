"""The file in which an ensemble is kept beside a report: fractiles, the curve of every motion, the engine's subset."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field
from typing import Any, Literal

from comparison.analyses.ensemble.analysis import FRACTILES, EnsembleResult, Point, Quantity, quantities
from comparison.json_file import StoredFile, finite_or_none
from comparison.result_types import result
from comparison.study.models import TRANSLATIONAL
from reference.measures import Estimate
from reference.measures.peak_demands import unit_of

FILE, PICTURE = "ensemble.json", "ensemble.png"
SCHEMA: Literal["phase-resonance/ensemble"] = "phase-resonance/ensemble"


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
class StoredStripe:
    """A demand at one scale over all motions."""

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
    fractiles: Sequence[StoredFractile]
    """from small to large shares"""
    reasons: Mapping[str, int] = field(default_factory=dict)
    """why the other motions do not have it, and how many each"""


@result
class StoredCurve:
    """A demand of one motion over its scale factors."""

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

    schema: Literal["phase-resonance/ensemble"]
    """what the file is"""
    scene: str
    """name of the family"""
    title: str
    """title of its scenes"""
    keys: Sequence[str]
    """what runs"""
    scales: Sequence[float]
    """scale factors"""
    motions: int
    """number of motions"""
    bodies: int
    """number of bodies"""
    outcomes: Mapping[str, int]
    """motions by the equations with every status"""
    stripes: Sequence[StoredStripe]
    """by demand and scale"""
    curves: Sequence[StoredCurve]
    """by demand, model and motion"""
    engine: StoredEngine
    """the engine's subset"""
    run: Mapping[str, Any]
    """command, times, provenance"""


STORED = StoredFile(FILE, StoredEnsemble, "an ensemble", "python -m comparison.ensemble")


def stored(result: EnsembleResult, run: Mapping[str, Any]) -> StoredEnsemble:
    """The content of the file."""
    scene, names = result.family.scenes[0], quantities(result.points)
    stripes = [
        StoredStripe(
            *_named(stripe.quantity),
            unit_of(stripe.quantity[0]),
            stripe.scale,
            stripe.answered,
            [StoredFractile(share, *_finite(value)) for share, value in zip(FRACTILES, stripe.fractiles)],
            stripe.reasons,
        )
        for stripe in result.stripes
    ]
    curves = [
        _curve(quantity, [point for point in points if point.curve == motion])
        for quantity in names
        for points in (result.points, result.engine)
        for motion in dict.fromkeys(point.curve for point in points)
    ]
    differences = [
        StoredDifference(
            *_named(bound.quantity),
            finite_or_none(bound.largest),
            finite_or_none(bound.like_for_like),
            finite_or_none(bound.errors),
            bound.points,
        )
        for bound in result.bounds
    ]
    asked = [{"scene": point.scene, "status": point.status} for point in result.engine]
    return StoredEnsemble(
        schema=SCHEMA,
        scene=result.family.name,
        title=scene.title,
        keys=list(result.family.columns),
        scales=sorted({point.scale for point in result.points}),
        motions=len({point.curve for point in result.points}),
        bodies=len(scene.bodies),
        outcomes=result.outcomes(),
        stripes=stripes,
        curves=curves,
        engine=StoredEngine(TRANSLATIONAL.key, asked, differences),
        run=run,
    )


def _named(quantity: Quantity) -> tuple[str, int | None]:
    return quantity[0], quantity[1] or None


def _finite(estimate: Estimate) -> tuple[float | None, float | None]:
    return finite_or_none(estimate.value), finite_or_none(estimate.error)


def _curve(quantity: Quantity, points: Sequence[Point]) -> StoredCurve:
    points = sorted(points, key=lambda point: point.scale)
    values, errors = zip(*(_finite(point.estimate(quantity)) for point in points))
    scales = [point.scale for point in points]
    return StoredCurve(*_named(quantity), points[0].model, points[0].curve, scales, list(values), list(errors))
