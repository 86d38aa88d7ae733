"""
Demands of a structure under many motions at many intensities (incremental dynamic analysis).

A family of scenes with recorded motions: what runs beside the scale factor, the motions of a suite as a rule, makes the
curves of demand against scale; with one scale factor there is one set of statistics. The equations compute every scene,
the engine a stated subset of them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from comparison.analyses.families.analysis import listed_demands
from comparison.json_file import finite_or_none
from comparison.runner.analysis import Analysis
from comparison.runner.task import Task, TaskResult
from comparison.runner.task_results import TaskResults
from comparison.study.batches import imported
from comparison.study.models import EXACT, REGULARIZED, TRANSLATIONAL, Model
from comparison.study.study import Study
from reference.measures import Demands, Estimate, demands
from reference.measures.distribution import fractile
from reference.problem import Family, Scene, SceneError

SCALE = "excitation.scale"
FRACTILES = (0.16, 0.5, 0.84)
GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)  # steps of which fill an interval evenly
REST = (0.0, 0.0)  # a record has no phases
SECONDS_PER_KNOT = {"reference": 8e-5, "engine": 4e-3}  # of processor time, for six bodies
LIMIT = 900.0  # s of processor time of one motion

Quantity = tuple[str, int]  # field of `Demands`, and body from 1 or 0 for the isolator


@dataclass(frozen=True)
class Point:
    """One motion at one scale by one model. demands: NaN if it ended early; None if there is nothing at all."""

    curve: str  # what runs beside the scale, as in names of scenes: the motion
    scale: float
    peak: float  # m/s^2, largest horizontal acceleration of the ground
    scene: str  # name
    model: str  # key
    status: str
    demands: Demands | None

    def estimate(self, quantity: Quantity) -> Estimate:
        """A demand; NaN without an answer."""
        known = () if self.demands is None else listed_demands(self.demands)
        return next((number for *key, number in known if tuple(key) == quantity), Estimate(math.nan, math.nan))


@dataclass(frozen=True)
class Stripe:
    """One demand at one scale over all motions. Fractiles are NaN where they fall on a motion without an answer."""

    quantity: Quantity
    scale: float
    fractiles: tuple[Estimate, ...]  # at FRACTILES
    answered: int  # motions that have the demand
    reasons: dict[str, int]  # why the others do not have it: how many each


@dataclass(frozen=True)
class Bound:
    """How far the engine is from the equations in one demand, at the points that both have computed."""

    quantity: Quantity
    largest: float  # |engine - equations| / |equations| of the ensemble; NaN without a common point
    like_for_like: float  # the same against the equations with the engine's friction law
    errors: float  # the two error estimates together, relative, at the point of `like_for_like`
    points: int


@dataclass(frozen=True)
class EnsembleResult:
    """points: by the equations, in the order of the family. engine: at the subset; alike: with its friction law."""

    family: Family
    points: Sequence[Point]
    engine: Sequence[Point]
    alike: Sequence[Point]
    stripes: Sequence[Stripe]
    bounds: Sequence[Bound]

    def outcomes(self) -> dict[str, int]:
        """How many motions ended with which status by the equations, the most frequent first."""
        names = [point.status for point in self.points]
        return {name: names.count(name) for name in sorted(set(names), key=lambda name: (-names.count(name), name))}


Arguments = tuple[Scene, Model, float]


def _alike(scene: Scene) -> Model:
    """The equations with the friction law of the engine."""
    return REGULARIZED if REGULARIZED.applies(scene) else EXACT


@dataclass(frozen=True)
class Ensemble(Analysis[EnsembleResult]):
    """
    Demands of every scene of a family by the equations, and by the engine at `subset` of them.

    family: every scene has a recorded motion. subset: scenes that the engine computes, spread evenly over motions and
    scales. tolerance: relative error asked of the largest accelerations by the engine; the equations take theirs.
    """

    key, stage = "ensemble", "ensemble"
    family: Family
    subset: int = 2
    tolerance: float = 1e-3

    def tasks(self, study: Study | None = None, surfaces: xr.Dataset | None = None) -> list[Task]:
        """One for each scene, then those of the engine."""
        scenes = self.family.scenes
        subset = [(scenes[n], model) for n in self.chosen() for model in (TRANSLATIONAL, _alike(scenes[n]))]
        asked = [*((scene, EXACT) for scene in scenes), *subset]
        tasks = {task.key: task for task in (self._task(scene, model) for scene, model in asked)}
        return list(tasks.values())

    def collect(self, study: Study | None, surfaces: xr.Dataset | None, results: TaskResults) -> EnsembleResult:
        """Points, stripes and the engine's bound."""
        curves, scales = curves_of(self.family), scales_of(self.family)

        def point(number: int, model: Model) -> Point:
            scene = self.family.scenes[number]
            answer: Demands | str = results.value(self._task(scene, model), _outcome)
            peak = float(np.hypot(scene.record[:, 1], scene.record[:, 2]).max())
            named = curves[number], scales[number], peak, scene.name, model.key
            return Point(*named, answer, None) if isinstance(answer, str) else Point(*named, answer.status, answer)

        points = [point(number, EXACT) for number in range(len(curves))]
        engine = [point(number, TRANSLATIONAL) for number in self.chosen()]
        alike = [point(number, _alike(self.family.scenes[number])) for number in self.chosen()]
        listed = list(stripes(points)), list(bounds(points, engine, alike))
        return EnsembleResult(self.family, points, engine, alike, *listed)

    def chosen(self) -> list[int]:
        """Places of the engine's scenes in the family: the motions and the scales each spread evenly."""
        curves = list(dict.fromkeys(curves_of(self.family)))
        scales = sorted(set(scales_of(self.family)))
        at = {point: n for n, point in enumerate(zip(curves_of(self.family), scales_of(self.family)))}
        count = min(self.subset, len(at))
        last, chosen = len(scales) + 1, []
        stride = next(n for n in range(max(1, round(GOLDEN * len(scales))), last + 1) if math.gcd(n, len(scales)) == 1)
        for k in range(count):
            scale = scales[(len(scales) // 2 + k * stride) % len(scales)]
            wanted = curves[int((k + 0.5) / count * len(curves))], scale
            chosen.append(at.get(wanted, k * len(at) // count))  # a zip does not have every combination
        return sorted(set(chosen))

    def _task(self, scene: Scene, model: Model) -> Task:
        seconds = SECONDS_PER_KNOT[model.side] * len(scene.record)
        arguments: Arguments = scene, model, model.tolerance(self.tolerance)
        return Task(demanded, arguments, self.stage, seconds, scene, model.side == "reference", timeout=LIMIT)


def refuse_unfit(family: Family, label: str) -> None:
    """Raise SceneError unless every scene has a recorded motion; label: the file, for the message."""
    for scene in family.scenes:
        if not scene.recorded:
            rule = "an ensemble needs recorded motions: give --suite, or a record in the scene"
            raise SceneError(label, "excitation", scene.name, rule)


def scales_of(family: Family) -> list[float]:
    """The scale factor of every scene, whether it runs or not."""
    return [float(scene.excitation.scale or 1.0) for scene in family.scenes]


def curves_of(family: Family) -> list[str]:
    """For every scene, what runs beside the scale, as one text."""
    others = [key for key in family.columns if key != SCALE]
    return [
        ", ".join(f"{key.rpartition('.')[2]} {family.columns[key][n]}" for key in others)
        for n in range(len(family.scenes))
    ]


def demanded(task: Arguments) -> Demands:
    """The demands of one motion by one model."""
    scene, model, tolerance = task
    settings = {key: value for key, value in model.settings.items() if key != "cutoff"}  # a way to read, not to move
    return demands(imported(model.trajectory)(scene, REST, tolerance=tolerance, **settings))


def _outcome(task: Arguments, failed: TaskResult) -> str:
    return failed.outcome.value


def stripes(points: Sequence[Point]) -> Iterator[Stripe]:
    """Fractiles of every demand at every scale. A motion without an answer counts as larger than all others."""
    for quantity in quantities(points):
        for scale in sorted({point.scale for point in points}):
            numbers = [point.estimate(quantity) for point in points if point.scale == scale]
            fractiles = tuple(uncertain_fractile(numbers, share) for share in FRACTILES)
            ended = [point.status for point in points if point.scale == scale]
            lacking = [
                number.reason or status for number, status in zip(numbers, ended) if not math.isfinite(number.value)
            ]
            reasons = {reason: lacking.count(reason) for reason in lacking}
            yield Stripe(quantity, scale, fractiles, len(numbers) - len(lacking), reasons)


def quantities(points: Sequence[Point]) -> list[Quantity]:
    """The demands that any point has, in the order of `Demands`, without the check of its energy."""
    listed = (listed_demands(point.demands) for point in points if point.demands is not None)
    names = dict.fromkeys((name, body) for numbers in listed for name, body, _ in numbers)
    return [quantity for quantity in names if quantity[0] != "energy_balance"]


def uncertain_fractile(numbers: Sequence[Estimate], share: float) -> Estimate:
    """
    Fractile of numbers with errors; NaN numbers count as infinite. Its error is the largest change within the errors.

    >>> numbers = [Estimate(1.0, 0.1), Estimate(2.0, 0.2), Estimate(float("nan"), float("nan"))]
    >>> median = uncertain_fractile(numbers, 0.5)
    >>> median.value, round(median.error, 12), uncertain_fractile(numbers, 0.75).value
    (2.0, 0.2, nan)
    """
    value = np.array([number.value for number in numbers])
    error = np.array([number.error for number in numbers])
    low, middle, high = (
        fractile(np.where(np.isfinite(value), x, np.inf), share) for x in (value - error, value, value + error)
    )
    return Estimate(middle, max(high - middle, middle - low)) if math.isfinite(middle) else Estimate(math.nan, math.nan)


def bounds(points: Sequence[Point], engine: Sequence[Point], alike: Sequence[Point]) -> Iterator[Bound]:
    """The largest difference of every demand that both sides have, and the largest with the same friction law."""
    equations = {point.scene: point for point in points}
    matching = [equations[point.scene] for point in engine]
    for quantity in quantities(engine):
        apart, same = ([*_differences(quantity, first, engine)] for first in (matching, alike))
        closest = max(same, default=(math.nan, math.nan))
        yield Bound(quantity, max(apart, default=closest)[0], *closest, len(apart))


def _differences(quantity: Quantity, first: Sequence[Point], second: Sequence[Point]) -> Iterator[tuple[float, float]]:
    """Relative size of each known difference, and the two errors together, relative."""
    for one, other in zip(first, second):
        before, after = one.estimate(quantity), other.estimate(quantity)
        size = abs(before.value)
        if math.isfinite(before.value) and math.isfinite(after.value) and size > 0.0:
            yield abs(after.value - before.value) / size, (before.error + after.error) / size


def of_quantity(items: Sequence[Stripe], quantity: Quantity) -> list[Stripe]:
    """The stripes of one demand, by scale."""
    return [stripe for stripe in items if stripe.quantity == quantity]


def as_rows(result: EnsembleResult) -> list[dict[str, object]]:
    """A row for every motion, scale and model, with all demands and their errors; None where there is no answer."""
    names = quantities(result.points)
    rows = []
    alike = [point for point in result.alike if point.model != EXACT.key]  # else it is among the points
    for point in (*result.points, *alike, *result.engine):
        row: dict[str, object] = {
            "scene": point.scene,
            "motion": point.curve,
            "scale": point.scale,
            "peak_ground_acceleration": point.peak,
            "model": point.model,
            "status": point.status,
            "missing": "; ".join(
                f"{quantity_name(quantity)}: {reason}"
                for quantity in names
                for reason in [point.estimate(quantity).reason]
                if reason
            ),
        }
        for quantity in names:
            number = point.estimate(quantity)
            name = quantity_name(quantity)
            row[name], row[f"{name}_error"] = (finite_or_none(value) for value in (number.value, number.error))
        rows.append(row)
    return rows


def quantity_name(quantity: Quantity) -> str:
    """A demand as one word, "drift_2" of body 2."""
    name, body = quantity
    return f"{name}_{body}" if body else name
