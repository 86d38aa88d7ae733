"""
Which models, grids and tolerances a study takes: the one place where `--tolerance` and `--budget` are decided.

A tolerance is met by the cheapest setting of every model that met it at 99 % of the recorded points, by its own error
estimate and in truth; a tighter one that costs hardly more is taken instead. A model that cannot meet it is left out. A
budget is spent along STUDY_PRESETS: the last study that fits.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from comparison.study.accuracy_record import recorded
from comparison.study.costs import Costs, costs, is_recorded
from comparison.study.models import MODEL_HIERARCHY, Model
from comparison.study.overhead import START_UP, WRITING
from comparison.study.selection import EVERYTHING, Selection
from comparison.study.study import Study
from reference.problem import Scene

HARDLY_MORE = 1.05  # times the cheapest cost: a setting that tightens the tolerance for so little is taken
DEFAULT_TOLERANCE = 1e-3


@dataclass(frozen=True)
class StudyPreset:
    """A study that a budget may buy."""

    grid: int  # phases per axis of the equations
    translational: int  # most phases per axis of the engine's models, 0 without them
    spatial: int
    with_analyses: bool  # all that the report tells beside the surfaces
    tolerance: float = DEFAULT_TOLERANCE  # relative error asked


STUDY_PRESETS = (  # each costs more than the one before
    StudyPreset(4, 0, 0, False),
    StudyPreset(8, 0, 0, False),
    StudyPreset(16, 0, 0, False),
    StudyPreset(16, 2, 0, False),
    StudyPreset(16, 4, 0, False),
    StudyPreset(16, 4, 2, False),
    StudyPreset(32, 8, 2, False),
    StudyPreset(32, 8, 4, False),
    StudyPreset(48, 16, 4, False),
    StudyPreset(48, 24, 8, True),
    StudyPreset(48, 24, 8, True, 1e-4),
    StudyPreset(96, 48, 8, True, 1e-4),
)
DEFAULT_PRESET = STUDY_PRESETS.index(StudyPreset(48, 24, 8, True))


def nothing(study: Study, with_analyses: bool) -> float:
    return 0.0


@dataclass(frozen=True)
class StudyRequest:
    """
    What the user asks of a study. tolerance, budget (s of the whole run), grid: None where that is left to us.
    analysis_cost: processor time of the analyses of a study, s, of all or of the essential ones. selection: the
    analyses asked for.
    """

    scenes: tuple[Scene, ...]
    hierarchy: Sequence[Model] = MODEL_HIERARCHY
    tolerance: float | None = None
    budget: float | None = None
    grid: int | None = None
    jobs: int = 1
    full: bool = False
    analysis_cost: Callable[[Study, bool], float] = nothing
    selection: Selection = EVERYTHING

    @property
    def measures_machine(self) -> bool:
        """Whether the measured trade is to choose, and this machine to be measured for it."""
        return self.tolerance is not None or self.budget is not None


@dataclass(frozen=True)
class StudyPlan:
    """What is computed, and what it is expected to cost."""

    study: Study
    with_analyses: bool  # all that the report tells beside the surfaces
    omitted: tuple[str, ...]  # models that cannot meet the tolerance or do not fit, a line each
    compute: float  # expected processor time of the surfaces, s
    wall: float  # expected time of the whole run with all workers, s


class BudgetError(ValueError):
    """Nothing fits. `str(error)` is one line."""


def plan_study(request: StudyRequest) -> StudyPlan:
    """
    The cheapest study that meets the tolerance asked, or the last preset that fits the budget.

    Parameters
    ----------
    request : StudyRequest

    Returns
    -------
    StudyPlan

    Raises
    ------
    BudgetError
        If nothing fits.
    """
    begin = time.monotonic()
    measured = costs(request.scenes, request.hierarchy, request.measures_machine, request.full)
    if request.budget is None:
        return _plan(STUDY_PRESETS[DEFAULT_PRESET], request, measured)
    allowed = [preset for preset in STUDY_PRESETS if request.tolerance is None or preset.tolerance == DEFAULT_TOLERANCE]
    spent = time.monotonic() - begin
    plans = [_plan(preset, request, measured) for preset in allowed]
    fitting = [plan for plan in plans if plan.wall + spent <= request.budget]
    if not fitting:
        least = plans[0].wall + spent
        raise BudgetError(
            f"the smallest study of {_count(request.scenes)} takes about {least:.0f} s here with {request.jobs} "
            f"worker{'' if request.jobs == 1 else 's'}: give that, or fewer scenes"
        )
    return fitting[-1]


def _count(scenes: Sequence[Scene]) -> str:
    return f"{len(scenes)} scenes" if len(scenes) > 1 else scenes[0].name


def _plan(preset: StudyPreset, request: StudyRequest, measured: Costs) -> StudyPlan:
    """The study of one preset, with what it costs."""
    tolerance = preset.tolerance if request.tolerance is None else request.tolerance
    grid = request.grid or preset.grid
    models, omitted = [], []
    for model in request.hierarchy:
        most = {"translational": preset.translational, "spatial": preset.spatial}.get(model.key)
        if request.budget is not None and most is not None and is_recorded(model):
            model = replace(model, most=most)
        if model.most == 0:
            omitted.append(f"{model.title}: does not fit the budget")
        elif is_recorded(model) and tolerance < recorded().accuracy[model.key].tightest:
            tightest = recorded().accuracy[model.key].tightest
            omitted.append(
                f"{model.title}: cannot meet {tolerance:.0e}, the tightest it is known to meet is {tightest:.0e}"
            )
        else:
            models.append(
                replace(model, asks=setting(model, model.tolerance(tolerance))) if is_recorded(model) else model
            )
    seconds = {
        (scene.name, model.key): cost
        for scene in request.scenes
        for model in models
        if (cost := measured.of(scene, model, model.tolerance(tolerance))) is not None
    }
    study = Study(request.scenes, grid, tolerance, models, request.full, seconds, selection=request.selection)
    compute = sum(study.seconds(model) for model in models)
    workers = compute + request.analysis_cost(study, preset.with_analyses) * measured.speed
    wall = (START_UP + WRITING) * measured.speed + workers / request.jobs
    return StudyPlan(study, preset.with_analyses, tuple(omitted), compute, wall)


def setting(model: Model, tolerance: float) -> float:
    """
    What to ask of a model so that a tolerance is met.

    Parameters
    ----------
    model : Model
    tolerance : float
        Relative error that 99 % of the points are to meet.

    Returns
    -------
    float
        The cheapest tolerance that was recorded to meet it, or a tighter one that costs hardly more.
    """
    accuracy = recorded().accuracy[model.key]
    able = [tolerance] + [asked for asked, met in zip(accuracy.tolerances, accuracy.met) if met and asked < tolerance]
    cheapest = min(accuracy.cost(asked) for asked in able)
    return min(asked for asked in able if accuracy.cost(asked) <= HARDLY_MORE * cheapest)


def tightest() -> float:
    """The tightest tolerance that any model is known to meet."""
    return min(accuracy.tightest for accuracy in recorded().accuracy.values())
