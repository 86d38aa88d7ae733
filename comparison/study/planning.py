"""
Which models, grids and tolerances a study takes: where `--tolerance`, `--grid` and `--budget` are decided.

A tolerance is met by the cheapest setting of every model that met it at 99 % of the recorded points, by its own error
estimate and in truth; a tighter one that costs hardly more is taken instead. A model that cannot meet it is left out. A
budget is given the finest study: how much of it is computed is decided while it runs (refinement.py).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from comparison.study.accuracy_record import recorded
from comparison.study.costs import is_recorded, tried_costs
from comparison.study.models import MODEL_HIERARCHY, Model
from comparison.study.nesting import nested_grids
from comparison.study.refinement import EQUATIONS, FINEST
from comparison.study.selection import EVERYTHING, Selection
from comparison.study.study import Study
from reference.problem import Scene

DEFAULT_TOLERANCE = 1e-3
DEFAULT_GRID = 48  # phases per axis of the equations; the engine's models have a `most` of their own


@dataclass(frozen=True)
class StudyRequest:
    """
    What the user asks of a study. tolerance, grid: None where that is left to us. budgeted: whether the study is the
    finest that a budget may buy. tries: whether scenes that are not in the record are tried to predict their cost.
    selection: the analyses asked for.
    """

    scenes: tuple[Scene, ...]
    hierarchy: Sequence[Model] = MODEL_HIERARCHY
    tolerance: float | None = None
    grid: int | None = None
    full: bool = False
    budgeted: bool = False
    tries: bool = False
    selection: Selection = EVERYTHING


@dataclass(frozen=True)
class StudyPlan:
    """What is computed."""

    study: Study
    omitted: tuple[str, ...]  # models that cannot meet the tolerance, a line each

    @property
    def compute(self) -> float:
        """Expected processor time of the surfaces, s."""
        return sum(self.study.seconds(model) for model in self.study.hierarchy)


def plan_study(request: StudyRequest) -> StudyPlan:
    """
    The cheapest study that meets the tolerance asked; under a budget the finest one.

    Parameters
    ----------
    request : StudyRequest

    Returns
    -------
    StudyPlan
    """
    tolerance = DEFAULT_TOLERANCE if request.tolerance is None else request.tolerance
    grid = request.grid or (FINEST[EQUATIONS] if request.budgeted else DEFAULT_GRID)
    models, omitted = [], []
    for model in request.hierarchy:
        accuracy = recorded().accuracy[model.recorded_key] if is_recorded(model) else None
        if accuracy is not None and tolerance < accuracy.tightest:
            known = f"the tightest it is known to meet is {accuracy.tightest:.0e}"
            omitted.append(f"{model.title}: cannot meet {tolerance:.0e}, {known}")
            continue
        if request.budgeted:
            model = replace(model, most=_most(model, grid, finest=request.grid is None))
        models.append(model if accuracy is None else replace(model, asks=accuracy.setting(model.tolerance(tolerance))))
    tried = tried_costs(request.scenes, models, request.full) if request.tries else {}
    study = Study(request.scenes, grid, tolerance, models, request.full, tried, selection=request.selection)
    return StudyPlan(study, tuple(omitted))


def _most(model: Model, grid: int, finest: bool) -> int | None:
    """The finest of the nested grids that a model may have."""
    most = FINEST.get(model.recorded_key, model.most) if finest else model.most
    chain = nested_grids(grid)
    return most and max([allowed for allowed in chain if allowed <= most], default=chain[0])


def tightest() -> float:
    """The tightest tolerance that any model is known to meet."""
    return min(accuracy.tightest for accuracy in recorded().accuracy.values())
