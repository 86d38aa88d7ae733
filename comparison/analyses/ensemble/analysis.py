"""Demands of structures under many motions at several scales (incremental dynamic analysis), by several models."""

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

STAGE = "ensemble"  # name under which the terminal shows the progress of these tasks
NO_PHASES = (0.0, 0.0)  # rad, phases passed to a model under a recorded motion, which has no phases
SPECTRA_COST_RATIO = 1.7  # processor time of a motion with floor spectra, divided by the time without
MOTION_TIME_LIMIT = 900.0  # s, processor time after which the computation of a motion is ended
# Relative error asked of the engine's largest accelerations: much less than motions differ from each other
ENGINE_TOLERANCE = 1e-2


@dataclass(frozen=True)
class MotionDemandsAtScale:
    """
    Demands of one motion at one scale by one model.

    status: outcome of the run. values: the demands by name and body, NaN or missing if the run ended early or failed.
    spectra, forces: floor spectra, and story and support forces, of the motion, or None.
    """

    member: EnsembleMember
    model: str  # key of the model
    status: str
    values: Mapping[Quantity, Estimate] = field(default_factory=dict)
    spectra: FloorSpectra | None = None
    forces: StoryForces | None = None
    instant: float = math.nan  # s, time of the motion at which the run ended with this status

    def estimate(self, quantity: Quantity) -> Estimate:
        """Return a demand, by its name and body, with its error; NaN if it was not computed."""
        return self.values.get(quantity, Estimate(math.nan, math.nan))


@dataclass(frozen=True)
class EnsemblePoints:
    """
    Demands of each motion of an ensemble, by the exact equations and, for chosen motions, by other models.

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


MotionTaskArguments = tuple[Scene, Model, float]  # scene with its motion, model, relative error to aim at
# Result of a task: demands; story forces; floor spectra or None; peak accelerations by body without those during slip
# below 1 mm/s, or empty; time at which the motion ended, s
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
    Ensemble of scenes, and the tasks that compute it: all motions by the exact equations, chosen ones by other models.

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
        """Return tasks that compute the chosen motions by all models but the exact equations."""
        return _drop_repeated_tasks(self._task(each.member, model) for each in chosen for model in self._models(each))

    def collect_points(self, results: TaskResults, chosen: Sequence[ChosenMember] = ()) -> EnsemblePoints:
        """Return the demands of all motions by the exact equations and of `chosen` by other models, from `results`."""
        compared: dict[str, list[MotionDemandsAtScale]] = {}
        for each in chosen:
            for model in self._models(each):
                compared.setdefault(model.key, []).append(self._point(each.member, model, results))
        return EnsemblePoints([self._point(member, EXACT, results) for member in self.members], chosen, compared)

    def _models(self, choice: ChosenMember) -> list[Model]:
        """Return the models that compute a motion selected for the multibody engine."""
        return list_comparison_models(choice.member, self.spatial)

    def _point(self, member: EnsembleMember, model: Model, results: TaskResults) -> MotionDemandsAtScale:
        """Return the demands of one motion at one scale by a model, from `results`; only a status if it failed."""
        found: MotionAnswer | str = results.value(self._task(member, model), lambda task, failed: failed.outcome.value)
        if isinstance(found, str):
            return MotionDemandsAtScale(member=member, model=model.key, status=found)
        numbers, forces, spectra, resolved, instant = found
        if model != EXACT and numbers.status != Outcome.OK:
            # Demands up to an early end are used only from the exact equations; else status and end time remain.
            return MotionDemandsAtScale(member=member, model=model.key, status=numbers.status, instant=instant)
        return MotionDemandsAtScale(
            member=member,
            model=model.key,
            status=numbers.status,
            values=collect_demand_values(member.scene, numbers, forces, resolved),
            spectra=spectra,
            forces=forces,
            instant=instant,
        )

    def _task(self, member: EnsembleMember, model: Model) -> Task:
        """Return the task that computes one motion at one scale by a model."""
        scene = member.scene
        seconds = estimate_motion_seconds(scene, model) * (SPECTRA_COST_RATIO if model == EXACT else 1.0)
        arguments: MotionTaskArguments = scene, model, model.tolerance(self.tolerance)
        return Task(
            function=compute_demands,
            argument=arguments,
            stage=STAGE,
            seconds=seconds,
            about=scene,
            needs_compiled_reference=model.side == "reference",
            timeout=MOTION_TIME_LIMIT,
        )


def _drop_repeated_tasks(tasks: Iterable[Task]) -> list[Task]:
    """Return the tasks with those of equal key only once."""
    return list({task.key: task for task in tasks}.values())


def compute_demands(task: MotionTaskArguments) -> MotionAnswer:
    """Return the demands of one motion by one model, and what else `MotionAnswer` has."""
    scene, model, tolerance = task
    motion = import_function(model.trajectory)(scene, NO_PHASES, tolerance=tolerance, **model.motion_settings)
    spectra = floor_spectra(motion) if model == EXACT else None
    return demands(motion), story_forces(motion), spectra, read_as_integrated(task), motion.instant


def read_as_integrated(task: MotionTaskArguments) -> list[Estimate]:
    """
    Return the peak acceleration of each body as integrated, that is without the instants of slip below 1 mm/s.

    The demands of the same motion have the literal supremum, in which such instants count. The list is empty where the
    two are the same: by engine models, and without dry friction.
    """
    scene, model, tolerance = task
    resolved = {SMALL.key: SMALL_AS_INTEGRATED, EXACT.key: EXACT_AS_INTEGRATED}.get(model.key)
    if resolved is None or not resolved.applies(scene):
        return []
    read = import_function(resolved.amplification)(scene, NO_PHASES, tolerance=tolerance, **resolved.settings)
    (ground,) = ground_peak(scene, [NO_PHASES])
    return [Estimate(float(mu * ground), float(error * ground)) for mu, error in zip(read.mu, read.error)]
