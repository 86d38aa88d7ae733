"""Demands of structures under many motions at many intensities (incremental dynamic analysis), by both sides."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from comparison.analyses.ensemble.governing import ChosenMember
from comparison.analyses.ensemble.members import EnsembleMember
from comparison.analyses.ensemble.quantities import Quantity, collect_demand_values
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.batches import import_function
from comparison.study.costs import estimate_motion_seconds
from comparison.study.models import (
    EXACT,
    EXACT_AS_INTEGRATED,
    REGULARIZED,
    SMALL,
    SMALL_AS_INTEGRATED,
    SPATIAL,
    TRANSLATIONAL,
    Model,
    has_spatial_data,
)
from reference.measures import Demands, Estimate, FloorSpectra, StoryForces, demands, floor_spectra, story_forces
from reference.problem import Outcome, Scene, ground_peak

STAGE = "ensemble"  # name of the stage of these tasks on the terminal
NO_PHASES = (0.0, 0.0)  # phases passed to a model under a record, which has none
SPECTRA_COST_RATIO = 1.7  # Processor time of a motion with floor spectra over the time without them.
MOTION_TIME_LIMIT = 900.0  # s, largest processor time of one motion
ENGINE_TOLERANCE = (
    1e-2  # relative error asked of the engine's largest accelerations: between motions they differ by far more
)


@dataclass(frozen=True)
class MotionDemandsAtScale:
    """Demands of one motion at one scale by one model. values: NaN if it ended early; empty if nothing was computed."""

    member: EnsembleMember
    model: str  # key of the model
    status: str
    values: Mapping[Quantity, Estimate] = field(default_factory=dict)
    spectra: FloorSpectra | None = None
    forces: StoryForces | None = None
    instant: float = math.nan  # s, time at which the status arose

    def estimate(self, quantity: Quantity) -> Estimate:
        """Return a demand with its error; NaN where there is none."""
        return self.values.get(quantity, Estimate(math.nan, math.nan))


@dataclass(frozen=True)
class EnsemblePoints:
    """
    Demands of every motion of an ensemble, by the exact equations and by the models compared with them.

    equations: in the order of the members. chosen: motions that the engine computes. compared: those motions by every
    other model, by key of the model.
    """

    equations: Sequence[MotionDemandsAtScale]
    chosen: Sequence[ChosenMember] = ()
    compared: Mapping[str, Sequence[MotionDemandsAtScale]] = field(default_factory=dict)

    @property
    def all_points(self) -> list[MotionDemandsAtScale]:
        """Return the demands of every motion by all models, those of the exact equations first."""
        return [*self.equations, *(point for points in self.compared.values() for point in points)]


MotionTaskArguments = tuple[Scene, Model, float]  # the scene under its motion, the model, and the relative error asked
# demands, story forces, floor spectra, accelerations as integrated where the demands hold suprema, time of the end, s
MotionAnswer = tuple[Demands, StoryForces, FloorSpectra | None, Sequence[Estimate], float]


def list_comparison_models(member: EnsembleMember, spatial: bool) -> list[Model]:
    """
    Return the models that compute a chosen motion in addition to the exact equations.

    The small equations show what the geometry adds, the equations with the engine's friction law whether the codes
    agree, the translational engine what its contact adds, and the spatial one what the turning of the bodies adds.
    """
    alike = [REGULARIZED] if REGULARIZED.applies(member.scene) else []
    turning = [SPATIAL] if spatial and has_spatial_data(member.scene) else []
    return [SMALL, *alike, TRANSLATIONAL, *turning]


@dataclass(frozen=True)
class Ensemble:
    """
    Task list of an ensemble: every motion by the exact equations, chosen motions by the other models.

    members: every scene has a recorded motion. spatial: whether the spatial model is among those of the engine.
    tolerance: relative error asked of the largest accelerations by the engine; the equations take theirs.
    """

    members: tuple[EnsembleMember, ...]
    spatial: bool = True
    tolerance: float = ENGINE_TOLERANCE

    def make_equation_tasks(self) -> list[Task]:
        """Return a task of the exact equations for each scene."""
        return _drop_repeated_tasks(self._task(member, EXACT) for member in self.members)

    def make_engine_tasks(self, chosen: Sequence[ChosenMember]) -> list[Task]:
        """Return the tasks of all other models at the chosen motions."""
        return _drop_repeated_tasks(self._task(each.member, model) for each in chosen for model in self._models(each))

    def collect_points(self, results: TaskResults, chosen: Sequence[ChosenMember] = ()) -> EnsemblePoints:
        """Return the demands of every motion by every model that was asked for it."""
        compared: dict[str, list[MotionDemandsAtScale]] = {}
        for each in chosen:
            for model in self._models(each):
                compared.setdefault(model.key, []).append(self._point(each.member, model, results))
        return EnsemblePoints([self._point(member, EXACT, results) for member in self.members], chosen, compared)

    def _models(self, choice: ChosenMember) -> list[Model]:
        """Return the models that compute a motion selected for the multibody engine."""
        return list_comparison_models(choice.member, self.spatial)

    def _point(self, member: EnsembleMember, model: Model, results: TaskResults) -> MotionDemandsAtScale:
        """Return the demands of one motion at one scale by a model; a status without values where it failed."""
        found: MotionAnswer | str = results.value(self._task(member, model), lambda task, failed: failed.outcome.value)
        if isinstance(found, str):
            return MotionDemandsAtScale(member, model.key, found)
        numbers, forces, spectra, resolved, instant = found
        if model != EXACT and numbers.status != Outcome.OK:
            # A status other than ok means that there is no value.
            return MotionDemandsAtScale(member, model.key, numbers.status, instant=instant)
        values = collect_demand_values(member.scene, numbers, forces, resolved)
        return MotionDemandsAtScale(member, model.key, numbers.status, values, spectra, forces, instant)

    def _task(self, member: EnsembleMember, model: Model) -> Task:
        """Return the task that computes one motion at one scale by a model."""
        scene = member.scene
        seconds = estimate_motion_seconds(scene, model) * (SPECTRA_COST_RATIO if model == EXACT else 1.0)
        arguments: MotionTaskArguments = scene, model, model.tolerance(self.tolerance)
        return Task(
            compute_demands, arguments, STAGE, seconds, scene, model.side == "reference", timeout=MOTION_TIME_LIMIT
        )


def _drop_repeated_tasks(tasks: Iterable[Task]) -> list[Task]:
    """Return the tasks without repetitions."""
    return list({task.key: task for task in tasks}.values())


def compute_demands(task: MotionTaskArguments) -> MotionAnswer:
    """Return the demands of one motion by one model, with floor spectra if it is the exact equations."""
    scene, model, tolerance = task
    motion = import_function(model.trajectory)(scene, NO_PHASES, tolerance=tolerance, **model.motion_settings)
    spectra = floor_spectra(motion) if model == EXACT else None
    return demands(motion), story_forces(motion), spectra, read_as_integrated(task), motion.instant


def read_as_integrated(task: MotionTaskArguments) -> list[Estimate]:
    """Return accelerations as integrated for the exact equations, whose demands are suprema; none for other models."""
    scene, model, tolerance = task
    resolved = {SMALL.key: SMALL_AS_INTEGRATED, EXACT.key: EXACT_AS_INTEGRATED}.get(model.key)
    if resolved is None or not resolved.applies(scene):
        return []
    read = import_function(resolved.amplification)(scene, NO_PHASES, tolerance=tolerance, **resolved.settings)
    (ground,) = ground_peak(scene, [NO_PHASES])
    return [Estimate(float(mu * ground), float(error * ground)) for mu, error in zip(read.mu, read.error)]
