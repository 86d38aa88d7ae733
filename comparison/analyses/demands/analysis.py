"""
Demand surfaces over all phase pairs (displacement, base shear, drifts, contact forces) and their statistics.

Every model moves at the phases of its own surface. Motions go to their end, which takes many times as long as mu: a
study makes this analysis where it is asked for by name.
"""

from collections.abc import Iterator
from typing import Annotated, Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from comparison.result_types import Array, Number, Phases, UncertainNumber, result
from comparison.runner.mapped_analysis import MappedAnalysis
from comparison.runner.task_results import TaskResults
from comparison.study.batches import compute_motion
from comparison.study.costs import estimate_motion_seconds
from comparison.study.models import SMALL_REGULARIZED, Model, models_of
from comparison.study.study import Study
from comparison.surfaces.distribution import CURVE_PROBABILITIES, Fractile
from comparison.surfaces.surfaces import NOT_ASKED, copy_to_mirror_images
from reference.measures import Estimates, phase_distribution
from reference.measures.distribution import FRACTILES, fractile
from reference.measures.peak_demands import PER_BODY, QUANTITIES, demands_of_motions
from reference.problem import Scene, phase_grid
from reference.problem.phases import phase_axis

MOTIONS_PER_TASK = {"reference": 32, "engine": 4}  # motions per task: as many as a program computes in 2 s
VARIABLE_PREFIX = "demand_"  # prefix of the variables of demands in surfaces.nc

# Arguments of a task: scene, model, relative error that is aimed at, phase pairs (M, 2) in rad
DemandTaskArguments = tuple[Scene, Model, float, Array]
TaskDemands = tuple[dict[str, Estimates], list[str]]  # demands by name, and outcome of each motion


@result
class PhaseExtreme:
    """Largest or smallest value of a demand over the computed phase pairs, with its error and its phases."""

    value: Annotated[Number, "largest or smallest value, in the unit of the demand"]
    error: Annotated[Number, "estimated absolute error; null where it is not known"]
    phases: Annotated[Phases, "(alpha1, alpha2), rad; null under a record"]


@result
class DemandStatistics:
    """Statistics of a demand by one model over independent uniform phases; under a recorded motion a single value."""

    model: Annotated[str, "key of the model"]
    quantity: Annotated[str, "key in `demands`, with the unit stated there"]
    body: Annotated[int, "number of the body; 0 where the demand is of the isolator"]
    points: Annotated[int, "phase pairs that it was taken from"]
    unknown: Annotated[float, "share of them without an answer"]
    mean: Annotated[UncertainNumber, "mean over all phases; its error includes that of sampling"]
    fractiles: Annotated[tuple[Fractile, ...], "by rising probability"]
    lowest: Annotated[PhaseExtreme, "smallest value"]
    highest: Annotated[PhaseExtreme, "largest value"]
    curve: Annotated[tuple[Number, ...], "the demand at 50 probabilities from 0.01 to 0.99"]

    def fractile(self, probability: float) -> float:
        """Return the value of the demand at one of the probabilities in FRACTILES."""
        return self.fractiles[FRACTILES.index(probability)].value


def compute_demands(task: DemandTaskArguments) -> TaskDemands:
    """Compute, in a worker process, every demand of the motions of one task, and how each motion ended."""
    scene, model, tolerance, phases = task
    demands = demands_of_motions(scene, phases, lambda phase: compute_motion(scene, model, phase, tolerance=tolerance))
    return dict(demands), [str(status) for status in demands.status]


class DemandSurfaces(MappedAnalysis[xr.Dataset]):
    """Analysis that computes demands (peak responses) at all phase pairs where a model's amplification is computed."""

    key, stage, level = "demands", "demands", 2
    function = staticmethod(compute_demands)
    without_value = staticmethod(lambda task, failed: ({}, [failed.outcome.value] * len(task[3])))

    def estimate_seconds(self, study: Study) -> float:
        """Return the rough processor time, s, that the motions of all scenes and models take."""
        return sum(
            estimate_motion_seconds(scene, model) * len(study.solved(scene, model))
            for scene in study.scenes
            for model in _models_with_own_motions(study, scene)
        )

    def task_arguments(self, study: Study, surfaces: xr.Dataset | None = None) -> Iterator[DemandTaskArguments]:
        """Yield the arguments of every task; the motions of one task take about two seconds together."""
        phases = phase_grid(study.grid)
        for scene, model, places in _list_task_motions(study):
            yield scene, model, model.tolerance(study.tolerance), phases[places]

    def collect(self, study: Study, surfaces: xr.Dataset | None, results: TaskResults) -> xr.Dataset | None:
        """
        Return the demands of all tasks as a dataset with the dimensions scene, model, body, alpha1, alpha2.

        Its variables have the names of the fields of `Demands`, and their estimated absolute errors end in "_error".
        The variable `status` names the outcome of each phase pair.
        """
        names, models = [scene.name for scene in study.scenes], [model.key for model in study.hierarchy]
        bodies, grid = max(len(scene.bodies) for scene in study.scenes), study.grid
        status = np.full((len(names), len(models), grid**2), NOT_ASKED, dtype=object)
        numbers: dict[str, Array] = {}  # by variable: (scene, model, body, index in the flattened grid of phases)
        answers = self.values(study, surfaces, results)
        for (scene, model, places), (estimated, outcomes) in zip(_list_task_motions(study), answers, strict=True):
            where = names.index(scene.name), models.index(model.key)
            status[where][places] = outcomes
            for name, estimates in estimated.items():
                shape = *status.shape[:2], bodies if name in PER_BODY else 1, grid**2
                for key, values in ((name, estimates.value), (f"{name}_error", estimates.error)):
                    rows, first = values.reshape(len(places), -1).T, PER_BODY.get(name, 0)
                    numbers.setdefault(key, np.full(shape, np.nan))[where][first : first + len(rows), places] = rows
        copy_to_mirror_images(study, [status, *numbers.values()])
        point, axis, square = ("scene", "model", "alpha1", "alpha2"), phase_axis(grid), (*status.shape[:2], grid, grid)
        variables: dict[str, Any] = {
            "status": (point, status.reshape(square), {"long_name": "named outcome of the pair"})
        }
        for name, table in numbers.items():
            quantity = name.removesuffix("_error")
            meaning, unit = QUANTITIES.get(quantity, (quantity, "1"))
            long_name = meaning if name == quantity else f"estimated absolute error: {meaning}"
            surface = table.reshape(*table.shape[:3], grid, grid)
            dims, data = (
                ((*point[:2], "body", *point[2:]), surface) if quantity in PER_BODY else (point, surface[:, :, 0])
            )
            variables[name] = dims, data, {"units": unit, "long_name": long_name}
        body = np.arange(1, bodies + 1)
        return xr.Dataset(variables, {"scene": names, "model": models, "alpha1": axis, "alpha2": axis, "body": body})


def _models_with_own_motions(study: Study, scene: Scene) -> list[Model]:
    """
    Return the models whose motions are computed.

    Left out are a user's models, models that differ from another only in which peaks count, and SMALL_REGULARIZED.
    """
    models = (model for model in models_of(scene, study.hierarchy) if model.side != "user")
    return [model for model in models if "cutoff" not in model.settings and model.key != SMALL_REGULARIZED.key]


def _list_task_motions(study: Study) -> Iterator[tuple[Scene, Model, NDArray[np.intp]]]:
    """Yield the scene, the model and the indices (in the whole grid) of the phase pairs of every task."""
    for scene in study.scenes:
        for model in _models_with_own_motions(study, scene):
            places, size = study.solved(scene, model), MOTIONS_PER_TASK[model.side]
            for first in range(0, len(places), size):
                yield scene, model, places[first : first + size]


def with_demands(surfaces: xr.Dataset, demands: xr.Dataset | None) -> xr.Dataset:
    """Return the dataset `surfaces` with the demands as further variables, as surfaces.nc holds them."""
    if demands is None:
        return surfaces
    renamed = demands.rename({name: f"{VARIABLE_PREFIX}{name}" for name in demands.data_vars})
    empty: dict[Any, Any] = dict.fromkeys(renamed.data_vars, np.nan)
    empty[f"{VARIABLE_PREFIX}status"] = NOT_ASKED
    aligned = renamed.reindex(scene=surfaces["scene"], body=surfaces["body"], fill_value=empty)
    # Keep the coordinates of `surfaces`, which state units; those of `demands` do not.
    return surfaces.assign(aligned.data_vars).assign_coords(surfaces.coords)


def demand_statistics(study: Study, demands: xr.Dataset | None, scene: Scene) -> list[DemandStatistics]:
    """Return the statistics of each demand, body and model that has a value, in the order of QUANTITIES."""
    if demands is None or scene.name not in demands["scene"]:
        return []
    return [
        statistics
        for name in QUANTITIES
        if name in demands
        for body in (range(1, len(scene.bodies) + 1) if name in PER_BODY else [0])
        for model in _models_with_own_motions(study, scene)
        for statistics in _statistics_of_demand(study, demands, scene, model, name, body)
    ]


def _statistics_of_demand(
    study: Study, demands: xr.Dataset, scene: Scene, model: Model, name: str, body: int
) -> Iterator[DemandStatistics]:
    """Yield the statistics of a demand over the phase pairs, or nothing without a value. body: 0 for the isolator."""
    place = {"scene": scene.name, "model": model.key} | ({"body": body} if body else {})
    axis = study.phase_indices(model, scene)
    value, error = (np.asarray(demands[key].sel(place), float)[np.ix_(axis, axis)] for key in (name, f"{name}_error"))
    known = np.isfinite(value)
    if not known.any():
        return
    taken = phase_distribution(value, np.where(np.isfinite(error), error, np.inf))
    error_of_mean = taken.mean.error

    def extreme(index: int) -> PhaseExtreme:
        """Return the value at an index of the flattened grid of phases, with its error and phase pair, rad."""
        row, column = np.unravel_index(index, value.shape)
        phases = phase_axis(study.grid)[axis]
        pair = (np.nan, np.nan) if scene.recorded else (float(phases[row]), float(phases[column]))
        return PhaseExtreme(float(value[row, column]), float(error[row, column]), pair)

    yield DemandStatistics(
        model=model.key,
        quantity=name,
        body=body,
        points=taken.points,
        unknown=taken.unknown,
        mean=UncertainNumber(value=taken.mean.value, error=error_of_mean if np.isfinite(error_of_mean) else np.nan),
        fractiles=tuple(Fractile(p, each.value, each.error) for p, each in zip(FRACTILES, taken.fractiles)),
        lowest=extreme(int(np.nanargmin(value))),
        highest=extreme(int(np.nanargmax(value))),
        curve=tuple(fractile(value[known], p) for p in CURVE_PROBABILITIES),
    )
