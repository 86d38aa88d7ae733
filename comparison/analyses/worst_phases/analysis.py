"""
Search for the phases where amplification and displacement are largest in every scene; the engine's values there.

`reference.worst_phases` searches by the small equations in both readings of (5.1), that is with accelerations at any
slip speed and only at resolved ones, and by the equations that the engine solves, too. Around the worst phases of the
latter the engine's own maximum is searched in a small square: its ratio to the equations, which hardly changes there,
says where that is. The most complete engine model, whose surface is not smooth, is not searched. It is computed at the
worst phases of the equations, and its largest value there or on its grid is listed. The searches begin at the local
maxima of the surfaces, if these are as fine as the search's own grid.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import Annotated, Any, Literal

import numpy as np
import xarray as xr

import reference
from comparison.result_types import Array, Number, Phases, Text, result
from comparison.runner.mapped_analysis import MappedAnalysis
from comparison.runner.task import TaskResult
from comparison.study.batches import import_function
from comparison.study.models import EXACT, SMALL, SMALL_AS_INTEGRATED, Model, models_of, pairs_of
from comparison.study.study import Study
from comparison.surfaces.distribution import GridMaximum, find_grid_maxima
from comparison.surfaces.model_difference import usable_mu
from comparison.surfaces.surfaces import select_values
from reference.measures.local_maxima import GRID, find_local_maxima
from reference.measures.local_search import ComputedPhases, LocalSearch, Surface, make_square_nodes, predict_best
from reference.phase_maximum import NoAnswerError
from reference.problem import Scene

SEARCH_TOLERANCE = 1e-5  # relative error of the amplification by the equations in a search for the worst phases
# Half width, rad, of the square around the equations' worst phases in which the engine's largest value is searched
ENGINE_HALF_WIDTH = 0.02
NO_PHASES = (math.nan, math.nan)  # stands for unknown phases, or an unknown direction


Quantity = Literal["amplification", "displacement"]  # what is searched for its largest value over the phases


@result
class LargestOverPhases:
    """Largest amplification of a body, or largest displacement of the platform, over all phases by one model."""

    scene: Annotated[str, "name of the scene"]
    model: Annotated[str, "key of the model"]
    quantity: Annotated[Quantity, "mu of the body, or the displacement of the platform, m"]
    body: Annotated[int, "number of the body; 1 is the platform"]
    value: Annotated[Number, "largest value; null without an answer"] = math.nan
    error: Annotated[Number, "estimated absolute error of it"] = math.nan
    phases: Annotated[Phases, "(alpha1, alpha2), rad"] = NO_PHASES
    kind: Literal["smooth", "kink", "jump", "nearby", "grid", ""] = ""
    """what the surface has there; "nearby": the largest of an engine near the worst phases of the equations; "grid":
    of its grid"""
    side: Annotated[Phases, "direction from a jump to the large values next to it; null otherwise"] = NO_PHASES
    runner_up: Annotated[Number, "the highest other value at which a local search ended"] = math.nan
    climbs: Annotated[int, "local maxima from which a search started"] = 0
    reached: Annotated[int, "searches that ended at the maximum"] = 0
    evaluations: Annotated[int, "phase pairs that were computed"] = 0
    at_start: Annotated[Number, "an engine's value at the worst phases of the equations"] = math.nan
    start_error: Annotated[Number, "estimated absolute error of it"] = math.nan
    reason: Annotated[Text, "why there is no value, or empty"] = ""


# Engine model whose amplification is not searched for its maximum, with its largest amplification on the phase grid
UnsearchedEngine = tuple[Model, GridMaximum]
# Arguments of a task: the scene; the model of equations to search by; the engine model of the same equations; the
# engine model that is not searched; the quantity; the body; the relative error asked of the engine; the phases at which
# to start, (K, 2) in rad, or None for those of a grid
SearchTaskArguments = tuple[Scene, Model, Model | None, UnsearchedEngine | None, Quantity, int, float, Array | None]


def find_nearest_search(found: Sequence[Any], models: Sequence[str], scene: str, model: str, body: int) -> Any | None:
    """
    Return the largest amplification of a body over the phases by a model.

    If the model was not searched, it is that of the next model after it in `models` that was, else of the last before.
    """
    searched = {
        worst.model: worst
        for worst in found
        if (worst.scene, worst.quantity, worst.body) == (scene, "amplification", body) and math.isfinite(worst.value)
    }
    place = models.index(model)
    order = [*models[place:], *reversed(models[:place])]
    return next((searched[key] for key in order if key in searched), None)


def _list_searches(study: Study, scene: Scene) -> list[tuple[Model, Model | None, Quantity, int]]:
    """
    Return the searches to make in a scene.

    Each is a model of equations, the engine model of the same equations or None, the quantity and the body.
    """
    equations = [model for model in models_of(scene, study.hierarchy) if model.amplification == SMALL.amplification]
    engines = {pair.first.key: pair.second for pair in pairs_of(scene, study.hierarchy) if pair.key == "like-for-like"}
    bodies = range(1, len(scene.bodies) + 1)
    searched = [model for model in equations if model.key in (SMALL.key, SMALL_AS_INTEGRATED.key, *engines)]
    return [
        *((model, engines.get(model.key), "amplification", body) for model in searched for body in bodies),
        *((model, None, "displacement", 1) for model in equations if model.key == EXACT.key),
    ]


def _starting_phases(
    study: Study, surfaces: xr.Dataset | None, scene: Scene, model: Model, quantity: str, body: int
) -> Array | None:
    """
    Return the phases (K, 2), rad, of the local maxima of a surface, for the search to start at.

    None if there are none, or if the study's grid is coarser than the search's own.
    """
    if surfaces is None or len(study.phase_indices(model, scene)) < GRID:
        return None
    of_platform = quantity == "displacement"
    values = (
        select_values(surfaces, quantity, scene.name, model) if of_platform else usable_mu(surfaces, scene.name, model)
    )
    starts = find_local_maxima(values if of_platform else values[body - 1], scene)
    return starts if len(starts) else None


def search_worst_phases(task: SearchTaskArguments) -> list[LargestOverPhases]:
    """
    Search the largest value over all phases, in a worker process.

    The list has the largest value by the equations, then the largest near it of the engine model of the same equations,
    then the larger of the value there and the largest on the grid of the engine model that is not searched.
    """
    scene, model, engine, on_grid, quantity, body, tolerance, starts = task
    settings: dict[str, Any] = dict(model.settings)
    try:
        maximum = reference.worst_phases(scene, body, quantity, tolerance=SEARCH_TOLERANCE, starts=starts, **settings)
    except NoAnswerError as error:
        return _state_reason(task, error.reason)
    # `reading` and `law`, which peaks count and how friction slides, are left out: the key of the model tells both.
    stated = {name: value for name, value in vars(maximum).items() if name not in ("reading", "law")}
    worst = LargestOverPhases(scene.name, model.key, quantity, body, **stated)
    found = [worst]
    if engine is not None:
        found.append(_compute_engine_nearby(worst, scene, model, engine, tolerance))
    if on_grid is not None:
        found.append(_larger_of_grid_and_worst(worst, scene, on_grid, tolerance))
    return found


def _without_value(task: SearchTaskArguments, failed: TaskResult) -> list[LargestOverPhases]:
    """Return, for each model of a search that failed, a result without value that states the reason."""
    return _state_reason(task, failed.reason)


def _state_reason(task: SearchTaskArguments, reason: str) -> list[LargestOverPhases]:
    """Return, for each model of a search, a result without value that states the reason."""
    scene, model, engine, on_grid, quantity, body, *_ = task
    models = [model, *([engine] if engine else []), *([on_grid[0]] if on_grid else [])]
    return [LargestOverPhases(scene.name, each.key, quantity, body, reason=reason) for each in models]


class WorstPhases(MappedAnalysis[list[LargestOverPhases]]):
    """Analysis that searches the phases of the largest amplification of each body and the largest displacement."""

    key, stage, needs_surfaces = "worst_phases", "worst phases", True
    seconds = 2.0
    function, without_value = staticmethod(search_worst_phases), staticmethod(_without_value)

    def task_arguments(self, study: Study, surfaces: xr.Dataset | None = None) -> Iterator[SearchTaskArguments]:
        """Yield arguments of each search: by a model of equations, and by the engine model of the same equations."""
        for scene in study.phased:
            for model, engine, quantity, body in _list_searches(study, scene):
                starts = _starting_phases(study, surfaces, scene, model, quantity, body)
                on_grid = _largest_on_grid(study, surfaces, scene, body) if engine is not None else None
                yield scene, model, engine, on_grid, quantity, body, study.tolerance, starts


def _compute_engine_nearby(
    worst: LargestOverPhases, scene: Scene, like: Model, model: Model, tolerance: float
) -> LargestOverPhases:
    """Return the engine's amplification at the equations' worst phases, and its largest in a square around them."""
    engine = _surface_of_model(scene, model, model.tolerance(tolerance), worst.body)
    start = engine.compute(np.array([worst.phases]))
    search = LocalSearch(
        phases=start.phases[0],
        value=float(start.value[0]),
        error=float(start.error[0]),
        half_width=ENGINE_HALF_WIDTH,
    )
    # The engine is costly: it is computed at the center and corners of the square and at the highest point predicted.
    (corners, _), (square, _) = make_square_nodes(2), make_square_nodes(3)
    computed = engine.compute(search.phases + ENGINE_HALF_WIDTH * corners)
    equations = _surface_of_model(scene, like, SEARCH_TOLERANCE, worst.body).compute(
        search.phases + ENGINE_HALF_WIDTH * square
    )
    highest, _ = predict_best(engine, search, _estimate_engine_by_ratio(start, computed, equations))
    search.move_to_best(computed)
    search.move_to_best(engine.compute(highest[None]))
    if not math.isfinite(search.value):
        return LargestOverPhases(scene.name, model.key, worst.quantity, worst.body, reason=engine.outcome)
    alpha1, alpha2 = (search.phases % (2.0 * np.pi)).tolist()
    return LargestOverPhases(
        scene=scene.name,
        model=model.key,
        quantity=worst.quantity,
        body=worst.body,
        value=search.value,
        error=search.error,
        phases=(alpha1, alpha2),
        kind="nearby",
        climbs=1,
        reached=1,
        evaluations=engine.evaluations,
        at_start=float(start.numerator[0] / start.denominator[0]),
        start_error=float(start.error[0]),
    )


def _largest_on_grid(study: Study, surfaces: xr.Dataset | None, scene: Scene, body: int) -> UnsearchedEngine | None:
    """Return the spatial engine and a body's largest amplification on its phase grid; None without such a model."""
    model = study.compared(scene)[-1]
    if surfaces is None or not model.is_spatial:
        return None
    largest = find_grid_maxima(surfaces, scene, [model])[body - 1]
    return (model, largest) if math.isfinite(largest.mu) else None


def _larger_of_grid_and_worst(
    worst: LargestOverPhases, scene: Scene, on_grid: UnsearchedEngine, tolerance: float
) -> LargestOverPhases:
    """Return the larger of two amplifications by the engine: at the worst phases of the equations, or on its grid."""
    model, largest = on_grid
    engine = _surface_of_model(scene, model, model.tolerance(tolerance), worst.body)
    there = engine.compute(np.array([worst.phases]))
    start, start_error = float(there.value[0]), float(there.error[0])
    make_largest = partial(
        LargestOverPhases,
        scene=worst.scene,
        model=model.key,
        quantity=worst.quantity,
        body=worst.body,
        at_start=start,
        start_error=start_error,
        evaluations=engine.evaluations,
    )
    if start > largest.mu:
        return make_largest(value=start, error=start_error, phases=worst.phases, kind="nearby")
    return make_largest(value=largest.mu, error=largest.error, phases=largest.phases, kind="grid")


def _surface_of_model(scene: Scene, model: Model, tolerance: float, body: int) -> Surface:
    """Return a body's amplification by a model as a function of the phases, for the search of its maximum."""
    return Surface(scene, import_function(model.amplification), {**model.settings, "tolerance": tolerance}, body - 1)


def _estimate_engine_by_ratio(
    center: ComputedPhases, corners: ComputedPhases, equations: ComputedPhases
) -> ComputedPhases:
    """
    Return an estimate of the engine's amplification at 3 x 3 phase pairs of a square.

    It is that of the equations times the ratio of the engine to the equations. The ratio is known at the center and the
    corners; in the middle of a side it is the mean of two corners.
    """
    like = equations.numerator.reshape(3, 3)
    ratio = np.empty((3, 3))
    ratio[::2, ::2] = corners.numerator.reshape(2, 2) / like[::2, ::2]
    ratio[1, ::2], ratio[::2, 1] = ratio[::2, ::2].mean(axis=0), ratio[::2, ::2].mean(axis=1)
    ratio[1, 1] = center.numerator[0] / like[1, 1]
    return replace(equations, numerator=(ratio * like).ravel())
