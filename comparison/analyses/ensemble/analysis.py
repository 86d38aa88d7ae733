"""Demands of structures under many motions at many intensities (incremental dynamic analysis), by both sides."""

import math
from collections import Counter
from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from operator import attrgetter
from typing import Any

import numpy as np
import xarray as xr

from comparison.analyses.ensemble import result
from comparison.json_file import finite_or_none
from comparison.runner.analysis import Analysis
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.batches import import_function
from comparison.study.models import EXACT, REGULARIZED, TRANSLATIONAL, Model, has_spatial_data, why_not_spatial
from comparison.study.study import Study
from reference.measures import Demands, Estimate, FloorSpectra, demands, effective_isolator, floor_spectra
from reference.measures.distribution import fractile
from reference.measures.peak_demands import list_demands, unit_of
from reference.problem import GRAVITY, Family, Scene, SceneError

SCALE = "excitation.scale"
RECORD = "excitation.record"
FRACTILES = (0.16, 0.5, 0.84)
MEDIAN = FRACTILES.index(0.5)
SMALLEST = ("contact_force_min", "support_force_min")  # demands of which the smallest value is the worst
GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)  # steps of which fill an interval evenly
REST = (0.0, 0.0)  # a record has no phases
SECONDS_PER_KNOT = {"reference": 8e-5, "engine": 1e-3, "spatial": 7e-3}  # s of processor time, for six bodies
LIMIT = 900.0  # s of processor time of one motion
TOLERANCE = 1e-2  # asked of the engine's largest accelerations: motions differ by far more

Quantity = tuple[str, int]  # field of `Demands`, and body from 1 or 0 for the isolator


@dataclass(frozen=True)
class Member:
    """A scene of the ensemble and its place in it."""

    structure: str  # file, and the values that run in it beside motion and scale
    motion: str
    scale: float  # scale of the ensemble; a factor of the motion itself comes on top
    scene: Scene
    place: int = 0  # among the members
    factor: float = 1.0  # factor of the motion, to a target spectrum


@dataclass(frozen=True)
class Point:
    """One motion at one scale by one model. demands: NaN if it ended early; None if there is nothing at all."""

    member: Member
    model: str  # key
    status: str
    demands: Demands | None = None
    spectra: FloorSpectra | None = None

    def estimate(self, quantity: Quantity) -> Estimate:
        """A demand; NaN without an answer."""
        known = () if self.demands is None else list_demands(self.demands)
        return next((number for *key, number in known if tuple(key) == quantity), Estimate(math.nan, math.nan))


@dataclass(frozen=True)
class Points:
    """equations: in the order of the members. engine: at the subset; alike: by the equations with its friction law."""

    equations: Sequence[Point]
    engine: Sequence[Point]
    alike: Sequence[Point]


Arguments = tuple[Scene, Model, float]
Answer = tuple[Demands, FloorSpectra | None]  # what is kept of a motion


def _alike(scene: Scene) -> Model:
    """The equations with the friction law of the engine."""
    return REGULARIZED if REGULARIZED.applies(scene) else EXACT


@dataclass(frozen=True)
class Ensemble(Analysis[Points]):
    """
    Demands of every scene by the equations, and by the engine at `subset` of every structure's.

    members: every scene has a recorded motion. subset: scenes that the engine computes, spread evenly over motions and
    scales; None for all. model: that of the engine. tolerance: relative error asked of the largest accelerations by
    the engine; the equations take theirs.
    """

    key, stage = "ensemble", "ensemble"
    members: tuple[Member, ...]
    subset: int | None = 2
    model: Model = TRANSLATIONAL
    tolerance: float = TOLERANCE
    target: result.Target | None = None

    def tasks(self, study: Study | None = None, surfaces: xr.Dataset | None = None) -> list[Task]:
        """One for each scene, then those of the engine."""
        subset = [
            (member.scene, model)
            for member in map(self.members.__getitem__, self.chosen())
            for model in (self.model, _alike(member.scene))
        ]
        asked = [*((member.scene, EXACT) for member in self.members), *subset]
        tasks = {task.key: task for task in (self._task(scene, model) for scene, model in asked)}
        return list(tasks.values())

    def collect(self, study: Study | None, surfaces: xr.Dataset | None, results: TaskResults) -> Points:
        """Every motion by every model that was asked for it."""

        def point(member: Member, model: Model) -> Point:
            task = self._task(member.scene, model)
            found: Answer | str = results.value(task, lambda task, failed: failed.outcome.value)
            answer = (found,) if isinstance(found, str) else (found[0].status, *found)
            return Point(member, model.key, *answer)

        asked = [self.members[place] for place in self.chosen()]
        return Points(
            [point(member, EXACT) for member in self.members],
            [point(member, self.model) for member in asked],
            [point(member, _alike(member.scene)) for member in asked],
        )

    def result(self, points: Points, run: Mapping[str, Any]) -> result.EnsembleResult:
        """The statistics of the points, the curves of the motions and the engine's bound."""
        both = points.equations, points.engine
        rows = [stripe for each in both for stripe in stripes(each)]
        scales = sorted({point.member.scale for point in points.equations})
        asked = "displacement", EXACT.key, scales[-1]
        moved = {row.structure: row for row in rows if (row.quantity, row.model, row.scale) == asked}
        statuses = Counter(sorted(point.status for point in points.equations))
        ran = [
            {"scene": point.member.scene.name, "motion": point.member.motion, "status": point.status}
            for point in points.engine
        ]
        return result.EnsembleResult(
            schema=result.SCHEMA,
            structures=structures_of(self.members, moved),
            scales=scales,
            motions=len({point.member.motion for point in points.equations}),
            outcomes=dict(statuses.most_common()),
            stripes=rows,
            curves=list(curves(*both)),
            spectra=list(spectrum_bands(points.equations)),
            engine=result.Engine(
                self.model.key, ran, list(bounds(points.equations, points.engine, points.alike)), self.tolerance
            ),
            run=run,
            target=self.target,
        )

    def chosen(self) -> list[int]:
        """Places of the engine's members: of every structure, the motions and the scales each spread evenly."""
        if self.subset is None:
            return list(range(len(self.members)))
        numbered = [replace(member, place=place) for place, member in enumerate(self.members)]
        return sorted(place for own in _by(numbered, "structure").values() for place in _spread(own, self.subset))

    def _task(self, scene: Scene, model: Model) -> Task:
        seconds = SECONDS_PER_KNOT["spatial" if model.is_spatial else model.side] * len(scene.record)
        arguments: Arguments = scene, model, model.tolerance(self.tolerance)
        return Task(answered, arguments, self.stage, seconds, scene, model.side == "reference", timeout=LIMIT)


def _spread(members: Sequence[Member], subset: int) -> set[int]:
    """Places of at most `subset` of the members."""
    curves, scales = [*_by(members, "motion")], sorted(_by(members, "scale"))
    at = {(member.motion, member.scale): member.place for member in members}
    count = min(subset, len(at))
    last, chosen = len(scales) + 1, set()
    stride = next(n for n in range(max(1, round(GOLDEN * len(scales))), last + 1) if math.gcd(n, len(scales)) == 1)
    for k in range(count):
        scale = scales[(len(scales) // 2 + k * stride) % len(scales)]
        wanted = curves[int((k + 0.5) / count * len(curves))], scale
        chosen.add(at.get(wanted, members[k * len(at) // count].place))  # a zip does not have every combination
    return chosen


def members_of(families: Sequence[Family]) -> tuple[Member, ...]:
    """The members of families. Raises SceneError unless every scene has a record and every file a name of its own."""
    names = [family.name for family in families]
    for name in names:
        if names.count(name) > 1:
            raise SceneError(name, "scene", name, "two files have this name, and the structures are named by it")
    members = []
    for family in families:
        inner = [key for key in family.columns if key != SCALE and not key.startswith(RECORD)]
        outer = [key for key in family.columns if key.startswith(RECORD)]
        for n, scene in enumerate(family.scenes):
            if not scene.recorded:
                rule = "an ensemble needs recorded motions: give --suite, or a record in the scene"
                raise SceneError(family.name, "excitation", scene.name, rule)
            values = ", ".join(f"{key.rpartition('.')[2]}={family.columns[key][n]}" for key in inner)
            motion = ", ".join(family.labels[key][n] for key in outer)
            structure = f"{family.name}[{values}]" if values else family.name
            members.append(Member(structure, motion, float(scene.excitation.scale or 1.0), scene))
    return tuple(members)


def refuse_unfit(members: Sequence[Member], model: Model) -> None:
    """Raise SceneError if a scene does not state what the engine's model needs."""
    for scene in (member.scene for member in members):
        if model.is_spatial and not has_spatial_data(scene):
            rule = why_not_spatial(scene) or "has no supports, heights and sizes of bodies: --model translational"
            raise SceneError(scene.name, "--model", "spatial", rule)


def structures_of(members: Sequence[Member], moved: Mapping[str, result.Stripe]) -> list[result.Structure]:
    """The structures in their order. moved: their isolator displacements at the largest scale."""
    found = []
    for name, own in _by(members, "structure").items():
        scene, isolator, stripe = own[0].scene, None, moved.get(name)
        at = {} if stripe is None else {"mean": stripe.mean.value, "median": stripe.fractiles[MEDIAN].value}
        statistic, displacement = next(((key, value) for key, value in at.items() if value), ("", 0.0))
        if displacement and not scene.flat and scene.dry_friction.fast:
            linear = effective_isolator(scene, displacement)
            period, damping, restoring = map(float, (linear.period, linear.damping, linear.restoring))
            isolator = result.LinearIsolator(displacement, period, damping, restoring, statistic)
        found.append(result.Structure(name, scene.title, len(scene.bodies), scene.total_mass * GRAVITY, isolator))
    return found


def _by(rows: Sequence[Any], name: str) -> dict[Any, list[Any]]:
    """The rows by one of their attributes, in the order in which its values come."""
    groups: dict[Hashable, list[Any]] = {}
    for row in rows:
        groups.setdefault(attrgetter(name)(row), []).append(row)
    return groups


def answered(task: Arguments) -> Answer:
    """The demands of one motion by one model, and its floor spectra by the equations."""
    scene, model, tolerance = task
    motion = import_function(model.trajectory)(scene, REST, tolerance=tolerance, **model.motion_settings)
    return demands(motion), floor_spectra(motion) if model == EXACT else None


def stripes(points: Sequence[Point]) -> Iterator[result.Stripe]:
    """Statistics of every demand at every scale; a motion without an answer counts as worse than all others."""
    for name, own in _by(points, "member.structure").items():
        for quantity in quantities(own):
            for scale, at_scale in sorted(_by(own, "member.scale").items()):
                numbers = [point.estimate(quantity) for point in at_scale]
                worst = -math.inf if quantity[0] in SMALLEST else math.inf
                mean, *shares, largest, smallest = statistics(numbers, (*FRACTILES, 1.0, 0.0), worst)
                fractiles = [
                    result.DemandFractile(each.value, each.error, share) for share, each in zip(FRACTILES, shares)
                ]
                lost = [pair for pair in zip(numbers, at_scale) if not math.isfinite(pair[0].value)]
                lacking = Counter(number.reason or point.status for number, point in lost)
                about = name, *_name_points(quantity), own[0].model, unit_of(quantity[0]), scale
                answered = len(numbers) - lacking.total()
                yield result.Stripe(*about, answered, mean, fractiles, largest, smallest, dict(lacking))


def _name_points(quantity: Quantity) -> tuple[str, int | None]:
    return quantity[0], quantity[1] or None


def _statistic(number: Estimate) -> result.Statistic:
    return result.Statistic(finite_or_none(number.value), finite_or_none(number.error))


def statistics(numbers: Sequence[Estimate], shares: Sequence[float], worst: float = math.inf) -> list[result.Statistic]:
    """Mean of numbers with errors, which has no value unless all are known, and their fractiles."""
    value, error = (float(np.mean([getattr(each, part) for each in numbers])) for part in ("value", "error"))
    fractiles = [uncertain_fractile(numbers, share, worst) for share in shares]
    return [_statistic(each) for each in (Estimate(value, error), *fractiles)]


def spectrum_bands(points: Sequence[Point]) -> Iterator[result.Spectrum]:
    """Floor spectra of every body of every structure at the largest scale, over all motions; the larger of x and y."""
    top = max((point.member.scale for point in points), default=math.nan)
    for name, own in _by([point for point in points if point.member.scale == top], "member.structure").items():
        known = [point.spectra for point in own if point.spectra is not None]
        if not known:
            continue
        bodies, _, periods = known[0].acceleration.shape
        nothing = np.full((2, bodies, periods), np.nan)
        values = [
            (p.spectra.acceleration.max(axis=1), p.spectra.error.max(axis=1)) if p.spectra else nothing for p in own
        ]
        for body in range(bodies):
            columns = np.array(values)[:, :, body].transpose(2, 0, 1).tolist()  # by period, motion, value and error
            numbers = ([Estimate(*pair) for pair in column] for column in columns)
            mean, *shares, largest = zip(*(statistics(column, (*FRACTILES, 1.0)) for column in numbers))
            about = name, body + 1, top, known[0].damping, known[0].period.tolist()
            yield result.Spectrum(*about, mean, shares, largest)


def curves(equations: Sequence[Point], engine: Sequence[Point]) -> Iterator[result.DemandCurve]:
    """Every demand of every motion over its scales, by structure, demand, model and motion."""
    for name in _by(equations, "member.structure"):
        both = [[point for point in points if point.member.structure == name] for points in (equations, engine)]
        for quantity in quantities([*equations, *engine]):
            for own in both:
                for motion, points in _by(own, "member.motion").items() if quantity in quantities(own) else ():
                    points = sorted(points, key=lambda point: point.member.scale)
                    numbers = [_statistic(point.estimate(quantity)) for point in points]
                    values, errors = [each.value for each in numbers], [each.error for each in numbers]
                    scales = [point.member.scale for point in points]
                    yield result.DemandCurve(
                        name, *_name_points(quantity), points[0].model, motion, scales, values, errors
                    )


def quantities(points: Sequence[Point]) -> list[Quantity]:
    """The demands that any point has, in the order of `Demands`, without the check of its energy."""
    listed = (list_demands(point.demands) for point in points if point.demands is not None)
    names = dict.fromkeys((name, body) for numbers in listed for name, body, _ in numbers)
    return [quantity for quantity in names if quantity[0] != "energy_balance"]


def uncertain_fractile(numbers: Sequence[Estimate], share: float, worst: float = math.inf) -> Estimate:
    """Fractile of numbers; NaN ones count as `worst`. Its error is the largest change within the errors."""
    value = np.array([number.value for number in numbers])
    error = np.array([number.error for number in numbers])
    low, middle, high = (
        fractile(np.where(np.isfinite(value), x, worst), share) for x in (value - error, value, value + error)
    )
    return Estimate(middle, max(high - middle, middle - low)) if math.isfinite(middle) else Estimate(math.nan, math.nan)


def bounds(
    points: Sequence[Point], engine: Sequence[Point], alike: Sequence[Point]
) -> Iterator[result.DemandDifference]:
    """The largest difference of every demand that both sides have, and the largest with the same friction law."""
    equations = {(point.member.structure, point.member.scene.name): point for point in points}
    for name, own in _by(engine, "member.structure").items():
        same_law = [point for point in alike if point.member.structure == name]
        matching = [equations[name, point.member.scene.name] for point in own]
        for quantity in quantities(own):
            apart, same = ([*_differences(quantity, first, own)] for first in (matching, same_law))
            closest = max(same, default=(math.nan, math.nan))
            largest, alike_apart, errors = map(finite_or_none, (max(apart, default=closest)[0], *closest))
            yield result.DemandDifference(name, *_name_points(quantity), largest, alike_apart, errors, len(apart))


def _differences(quantity: Quantity, first: Sequence[Point], second: Sequence[Point]) -> Iterator[tuple[float, float]]:
    """Relative size of each known difference, and the two errors together, relative."""
    for one, other in zip(first, second):
        before, after = one.estimate(quantity), other.estimate(quantity)
        size = abs(before.value)
        if math.isfinite(before.value) and math.isfinite(after.value) and size > 0.0:
            yield abs(after.value - before.value) / size, (before.error + after.error) / size


def as_rows(points: Points) -> list[dict[str, object]]:
    """A row for every motion, scale and model, with all demands and their errors; None where there is no answer."""
    listed = quantities([*points.equations, *points.engine])
    names = {quantity: "_".join(map(str, filter(None, quantity))) for quantity in listed}  # drift_2 of body 2
    rows = []
    alike = [point for point in points.alike if point.model != EXACT.key]  # else it is among the points
    for point in (*points.equations, *alike, *points.engine):
        numbers = {name: point.estimate(quantity) for quantity, name in names.items()}
        row: dict[str, object] = {
            "structure": point.member.structure,
            "scene": point.member.scene.name,
            "motion": point.member.motion,
            "scale": point.member.scale,
            "factor": point.member.factor,
            "peak_ground_acceleration": float(np.hypot(*point.member.scene.record[:, 1:3].T).max()),
            "model": point.model,
            "status": point.status,
            "missing": "; ".join(f"{name}: {number.reason}" for name, number in numbers.items() if number.reason),
        }
        for name, number in numbers.items():
            row[name], row[f"{name}_error"] = finite_or_none(number.value), finite_or_none(number.error)
        rows.append(row)
    return rows
