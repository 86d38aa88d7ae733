"""Surfaces mu_i(alpha1, alpha2) of every scene and model: their tasks, and one xarray data set of their results."""

import math
from collections import Counter
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.batches import Batch, BatchResult, execute_batch
from comparison.study.costs import estimate_point_seconds
from comparison.study.models import Model, models_of
from comparison.study.study import Study
from reference.problem import Scene
from reference.problem.phases import phase_axis

NOT_APPLICABLE = "not applicable"  # status of a model that does not apply to a scene
MEANING_OF_VARIABLE = {  # unit and meaning of each variable that `label_surfaces` states on the phases
    "mu": {"units": "1", "long_name": "dynamic amplification factor (5.1)"},
    "error": {"units": "1", "long_name": "estimated absolute error of mu"},
    "instant": {"units": "s", "long_name": "time when the outcome arose"},
    "displacement": {"units": "m", "long_name": "largest horizontal displacement of the platform"},
    "cap_share": {"units": "1", "long_name": "largest horizontal displacement of the platform over rho"},
    "status": {"long_name": "named outcome of the point"},
}
NOT_ASKED = "not asked"  # status at phases that a model skips because it computes only every k-th phase


def make_surface_tasks(study: Study) -> list[Task]:
    """Return a task for every batch of the study, in the same order."""
    models = {model.key: model for model in study.hierarchy}
    return [
        Task(
            function=execute_batch,
            argument=batch,
            stage=models[batch.model].title,
            seconds=batch.points * estimate_point_seconds(batch.scene, models[batch.model]),
            about=batch.question,
            needs_compiled_reference=batch.amplification.startswith("reference:"),
            timeout=batch.timeout,
            group=batch.group,
            model=batch.amplification,
        )
        for batch in study.batches()
    ]


def collect_batch_results(tasks: Sequence[Task], results: TaskResults) -> list[BatchResult]:
    """Return the models' results for the batches; NaN with the reason for a task that ended without a result."""
    return [
        results.value(task, lambda batch, failed: batch.without_result(failed.outcome, failed.error_message))
        for task in tasks
    ]


def label_surfaces(study: Study, batches: Sequence[Batch], answers: Sequence[BatchResult]) -> xr.Dataset:
    """
    Return the models' results as a data set with the dimensions scene, model, body, alpha1, alpha2 (rad).

    `mu` is the amplification and `error` its estimated absolute error. Both are NaN at a phase pair without an answer,
    where a model does not apply to the scene, between the phases of a model that computes only every `stride`-th, and
    in a body that the scene does not have (`bodies` counts them). A `recorded` scene has one value, at the first pair.
    `status` names the outcome of each pair and `instant` when it arose, s. `displacement` is the largest of the
    platform, m, and `cap_share` the same over rho. `cost` (scene, model) is the compute time, s.
    """
    bodies, axis = max(len(scene.bodies) for scene in study.scenes), phase_axis(study.grid)
    values, cost = _place_answers(study, batches, answers, bodies)
    copy_to_mirror_images(study, list(values.values()))
    values["cap_share"] = values["displacement"] / np.array([scene.radius for scene in study.scenes])[:, None, None]
    variables = {}
    for name, array in values.items():
        dims = ("scene", "model", *(("body",) if array.ndim > 3 else ()), "alpha1", "alpha2")
        variables[name] = dims, array.reshape(*array.shape[:-1], study.grid, study.grid), MEANING_OF_VARIABLE[name]
    strides = [[study.stride(model, scene) for model in study.hierarchy] for scene in study.scenes]
    of_scenes = {
        "recorded": ([scene.recorded for scene in study.scenes], "whether it has no phases"),
        "bodies": ([len(scene.bodies) for scene in study.scenes], "bodies of the scene"),
        "digest": ([scene.digest() for scene in study.scenes], "hash of the scene"),
    }
    return xr.Dataset(
        {
            **variables,
            "cost": (("scene", "model"), cost, {"units": "s", "long_name": "compute time of the surface"}),
            "stride": (("scene", "model"), strides, {"long_name": "the model has every k-th phase"}),
            **{name: ("scene", listed, {"long_name": meaning}) for name, (listed, meaning) in of_scenes.items()},
        },
        coords={
            "scene": [scene.name for scene in study.scenes],
            "model": [model.key for model in study.hierarchy],
            "body": ("body", np.arange(1, bodies + 1), {"long_name": "body i of mu_i, 1 is the platform"}),
            "alpha1": ("alpha1", axis, {"units": "rad", "long_name": "initial phase of the first harmonic"}),
            "alpha2": ("alpha2", axis, {"units": "rad", "long_name": "initial phase of the second harmonic"}),
        },
        attrs={"title": "phase-resonance surfaces", "tolerance": study.tolerance},
    )


def _place_answers(
    study: Study, batches: Sequence[Batch], answers: Sequence[BatchResult], bodies: int
) -> tuple[dict[str, NDArray[Any]], NDArray[np.float64]]:
    """
    Return the arrays of all variables by name, and the compute time of each surface, s, (scene, model).

    An array is (scene, model, body, index in the flattened grid of phases), without body where the variable has none.
    """
    names, models = [scene.name for scene in study.scenes], [model.key for model in study.hierarchy]
    square, points = (len(names), len(models)), study.grid**2
    values: dict[str, NDArray[Any]] = {name: np.full((*square, bodies, points), np.nan) for name in ("mu", "error")}
    values |= {name: np.full((*square, points), np.nan) for name in ("instant", "displacement")}
    values["status"] = np.full((*square, points), NOT_APPLICABLE, dtype=object)
    cost, solved = np.zeros(square), {}
    for row, scene in enumerate(study.scenes):
        for model in models_of(scene, study.hierarchy):
            values["status"][row, models.index(model.key)] = NOT_ASKED
            solved[scene.name, model.key] = study.solved(scene, model)
    for batch, answer in zip(batches, answers, strict=True):
        where = names.index(batch.scene.name), models.index(batch.model)
        span = solved[batch.scene.name, batch.model][batch.first : batch.first + len(batch.phases)]
        for name, array in values.items():
            found = np.asarray(getattr(answer, name))
            array[where][(slice(found.shape[1]), span) if found.ndim > 1 else span] = found.T
        cost[where] += answer.cost
    return values, cost


def copy_to_mirror_images(study: Study, arrays: Sequence[NDArray[Any]]) -> None:
    """
    Copy values from the computed phase pairs to their mirror images.

    arrays: (scene, model, ..., index in the flattened grid of phases); they are changed in place.
    """
    for row, scene in enumerate(study.scenes):
        for column, model in enumerate(study.hierarchy):
            if model.applies(scene):
                place, source = study.places(model, scene), study.symmetric_sources(scene, model)
                for array in arrays:
                    array[row, column][..., place] = array[row, column][..., source]


def find_largest_cap_share(surfaces: xr.Dataset, scene: str, model: str) -> float:
    """Return the platform's largest displacement, as a share of the pendulum radius rho; NaN without a value."""
    return float(surfaces["cap_share"].sel(scene=scene, model=model).max())  # max() skips NaN


def find_largest_travel_share(surfaces: xr.Dataset, scene: Scene, model: str) -> float:
    """Return the platform's largest displacement as a share of the isolator's travel; NaN without either."""
    travel = scene.isolator.travel
    displacement = surfaces["displacement"].sel(scene=scene.name, model=model)
    return math.nan if travel is None else float(displacement.max()) / travel


def find_common_stride(surfaces: xr.Dataset, scene: str, *models: Model) -> int:
    """Return the smallest k such that all these models compute every k-th phase of the study."""
    strides = surfaces.variables["stride"].values
    return int(max(strides[_find_model_index(surfaces, scene, model)] for model in models))


def select_values(surfaces: xr.Dataset, name: str, scene: str, *models: Model) -> NDArray[Any]:
    """
    Return a variable of the surfaces for the first of `models`, at the phases that all of them compute.

    It is (alpha1, alpha2), for "mu" and "error" (body, alpha1, alpha2).
    """
    every = slice(None, None, find_common_stride(surfaces, scene, *models))
    values: NDArray[Any] = surfaces.variables[name].values[
        (*_find_model_index(surfaces, scene, models[0]), ..., every, every)
    ]
    return values


def count_outcomes(surfaces: xr.Dataset, scene: str, model: Model) -> dict[str, int]:
    """Return how many of the phase pairs that the model was to compute have each outcome, most frequent first."""
    return dict(Counter(select_values(surfaces, "status", scene, model).ravel().tolist()).most_common())


def _find_model_index(surfaces: xr.Dataset, scene: str, model: Model) -> tuple[Any, Any]:
    """Return the indices of a scene and of a model along these dimensions of the surfaces."""
    return surfaces.get_index("scene").get_loc(scene), surfaces.get_index("model").get_loc(model.key)
