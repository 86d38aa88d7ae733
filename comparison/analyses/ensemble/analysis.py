"""Demands of structures under many motions at many intensities (incremental dynamic analysis), by both sides."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from comparison.analyses.ensemble.governing import Choice
from comparison.analyses.ensemble.members import Member
from comparison.analyses.ensemble.quantities import Quantity, values_of_motion
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.batches import import_function
from comparison.study.costs import seconds_per_motion
from comparison.study.models import (
    EXACT,
    REGULARIZED,
    RESOLVED,
    SMALL,
    SMALL_RESOLVED,
    SPATIAL,
    TRANSLATIONAL,
    Model,
    has_spatial_data,
)
from reference.measures import Demands, Estimate, FloorSpectra, StoryForces, demands, floor_spectra, story_forces
from reference.problem import Outcome, Scene, ground_peak

STAGE = "ensemble"
REST = (0.0, 0.0)  # a record has no phases
WITH_SPECTRA = 1.7  # processor time of a motion with its floor spectra over that without
LIMIT = 900.0  # s of processor time of one motion
TOLERANCE = 1e-2  # asked of the engine's largest accelerations: motions differ by far more


@dataclass(frozen=True)
class Point:
    """One motion at one scale by one model. values: NaN if it ended early; empty if there is nothing at all."""

    member: Member
    model: str  # key
    status: str
    values: Mapping[Quantity, Estimate] = field(default_factory=dict)
    spectra: FloorSpectra | None = None
    forces: StoryForces | None = None
    instant: float = math.nan  # when the status arose, s

    def estimate(self, quantity: Quantity) -> Estimate:
        """A demand; NaN without an answer."""
        return self.values.get(quantity, Estimate(math.nan, math.nan))


@dataclass(frozen=True)
class Points:
    """
    Points of an ensemble.

    equations: in the order of the members. chosen: motions that the engine computes. compared: those motions by every
    other model, by key of the model.
    """

    equations: Sequence[Point]
    chosen: Sequence[Choice] = ()
    compared: Mapping[str, Sequence[Point]] = field(default_factory=dict)

    @property
    def all_points(self) -> list[Point]:
        """All points, those of the equations first."""
        return [*self.equations, *(point for points in self.compared.values() for point in points)]


Arguments = tuple[Scene, Model, float]
# what is kept of a motion; accelerations as integrated, where its demands have others; when it ended early, s
Answer = tuple[Demands, StoryForces, FloorSpectra | None, Sequence[Estimate], float]


def models_beside(member: Member, spatial: bool) -> list[Model]:
    """
    The models that compute a chosen motion beside the exact equations.

    The small equations show what the geometry adds, the equations with the engine's friction law whether the codes
    agree, the translational engine what its contact adds, and the spatial one what the turning of the bodies adds.
    """
    alike = [REGULARIZED] if REGULARIZED.applies(member.scene) else []
    turning = [SPATIAL] if spatial and has_spatial_data(member.scene) else []
    return [SMALL, *alike, TRANSLATIONAL, *turning]


@dataclass(frozen=True)
class Ensemble:
    """
    Demands of every scene by the equations, and of chosen ones by the other models.

    members: every scene has a recorded motion. spatial: whether the spatial model is among those of the engine.
    tolerance: relative error asked of the largest accelerations by the engine; the equations take theirs.
    """

    members: tuple[Member, ...]
    spatial: bool = True
    tolerance: float = TOLERANCE

    def equation_tasks(self) -> list[Task]:
        """One for each scene."""
        return _drop_repeated_tasks(self._task(member, EXACT) for member in self.members)

    def engine_tasks(self, chosen: Sequence[Choice]) -> list[Task]:
        """Return those of all other models at the chosen motions."""
        return _drop_repeated_tasks(self._task(each.member, model) for each in chosen for model in self._models(each))

    def points(self, results: TaskResults, chosen: Sequence[Choice] = ()) -> Points:
        """Every motion by every model that was asked for it."""
        compared: dict[str, list[Point]] = {}
        for each in chosen:
            for model in self._models(each):
                compared.setdefault(model.key, []).append(self._point(each.member, model, results))
        return Points([self._point(member, EXACT, results) for member in self.members], chosen, compared)

    def _models(self, choice: Choice) -> list[Model]:
        return models_beside(choice.member, self.spatial)

    def _point(self, member: Member, model: Model, results: TaskResults) -> Point:
        found: Answer | str = results.value(self._task(member, model), lambda task, failed: failed.outcome.value)
        if isinstance(found, str):
            return Point(member, model.key, found)
        numbers, forces, spectra, resolved, instant = found
        if model != EXACT and numbers.status != Outcome.OK:
            return Point(member, model.key, numbers.status, instant=instant)  # a status that is not ok is no value
        values = values_of_motion(member.scene, numbers, forces, resolved)
        return Point(member, model.key, numbers.status, values, spectra, forces, instant)

    def _task(self, member: Member, model: Model) -> Task:
        scene = member.scene
        seconds = seconds_per_motion(scene, model) * (WITH_SPECTRA if model == EXACT else 1.0)
        arguments: Arguments = scene, model, model.tolerance(self.tolerance)
        return Task(compute_demands, arguments, STAGE, seconds, scene, model.side == "reference", timeout=LIMIT)


def _drop_repeated_tasks(tasks: Iterable[Task]) -> list[Task]:
    """Each task once."""
    return list({task.key: task for task in tasks}.values())


def compute_demands(task: Arguments) -> Answer:
    """The demands of one motion by one model, and its floor spectra by the equations."""
    scene, model, tolerance = task
    motion = import_function(model.trajectory)(scene, REST, tolerance=tolerance, **model.motion_settings)
    spectra = floor_spectra(motion) if model == EXACT else None
    return demands(motion), story_forces(motion), spectra, read_as_integrated(task), motion.instant


def read_as_integrated(task: Arguments) -> list[Estimate]:
    """Return accelerations as integrated of equations that have the literal suprema; none of any other model."""
    scene, model, tolerance = task
    resolved = {SMALL.key: SMALL_RESOLVED, EXACT.key: RESOLVED}.get(model.key)
    if resolved is None or not resolved.applies(scene):
        return []
    read = import_function(resolved.amplification)(scene, REST, tolerance=tolerance, **resolved.settings)
    (ground,) = ground_peak(scene, [REST])
    return [Estimate(float(mu * ground), float(error * ground)) for mu, error in zip(read.mu, read.error)]
