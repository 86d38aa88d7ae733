"""
The total difference of one body as signed bars that add up: what each model of the hierarchy adds.

The bars are means over the phase pairs where every compared model has a value, relative to mu of the first model there.
The mean of a sum is the sum of the means, so that the bars end at the total; medians would not.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Annotated

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from pydantic import computed_field

from comparison.result_types import Number, Phases, Text, result
from comparison.study.models import Model
from comparison.study.study import Study
from comparison.surfaces.budget import known_to_all, steps
from comparison.surfaces.steps import RESOLVED, Step, step
from reference.problem import Scene

NAN = float("nan")


@result
class WaterfallBar:
    """One step of the model hierarchy, or the total; relative to mu of the first model."""

    model: Annotated[str, "key of the model that the step leads to"]
    size: Annotated[Number, "signed size; null where a model has no value"]
    error: Annotated[Number, "error estimate of the size"]

    @computed_field  # type: ignore[prop-decorator]
    @property
    def real(self) -> bool:
        """Whether the size is known to a fifth of itself or better (the five-fold rule)."""
        return bool(abs(self.size) > RESOLVED * self.error)


@result
class LargestDifference:
    """The largest absolute difference of an engine model and the first model, taken apart at its phase pair."""

    bars: tuple[WaterfallBar, ...]
    """one per step, up to the model that has the difference; they add up to the total"""
    total: Annotated[WaterfallBar, "the difference itself"]
    phases: Annotated[Phases, "(alpha1, alpha2), rad; null under a record"]
    phases_per_axis: int
    """of the grid of phase pairs that both models were asked for; 1 under a record, 0 without a difference"""


@result
class Waterfall:
    """The total difference of one body as signed bars that add up."""

    scene: Annotated[Text, "name of the scene"]
    body: Annotated[int, "number of the body; 1 is the platform"]
    bars: tuple[WaterfallBar, ...]
    """one per step: means over the phase pairs where every compared model has a value"""
    total: Annotated[WaterfallBar, "mean of the total difference over the same phase pairs: the sum of the bars"]
    spread: Annotated[Number, "standard deviation of the total difference over the same phase pairs"]
    points: Annotated[int, "number of these phase pairs"]
    independent: Annotated[int, "of these, not related by a symmetry of the scene"]
    largest: Annotated[LargestDifference, "the same at the phase pair of the largest difference"]


def waterfall(study: Study, surfaces: xr.Dataset, scene: Scene, body: int) -> Waterfall:
    """The waterfall of one body. The error of a mean is the mean of the errors, which have the same cause nearby."""
    hierarchy = steps(study, surfaces, scene.name, body)
    stride, known = known_to_all(hierarchy)
    bars = tuple(_mean(step, known, stride) for step in hierarchy)
    models = study.compared(scene)
    return Waterfall(
        scene=scene.name,
        body=body,
        bars=bars[:-1],
        total=bars[-1],
        spread=hierarchy[-1].mean(known, stride)[1],
        points=int(known.sum()),
        independent=independent_phases(study, scene, models, known, stride),
        largest=largest_difference(study, surfaces, scene, body),
    )


def independent_phases(
    study: Study, scene: Scene, models: Sequence[Model], known: NDArray[np.bool_], stride: int
) -> int:
    """Number of orbits of the `known` phase pairs (K, K) under the symmetries of all models, whatever --full says."""
    if scene.recorded:
        return int(known.any())
    reduced = replace(study, full=False)
    axis = np.arange(0, study.grid, stride)
    places = (study.grid * axis[:, None] + axis)[known]
    orbits = np.empty((len(places), len(models)), dtype=np.intp)
    for column, model in enumerate(models):
        orbit = np.full(study.grid**2, -1)
        orbit[reduced.places(model, scene)] = reduced.sources(scene, model)
        orbits[:, column] = orbit[places]
    return len(np.unique(orbits, axis=0))


def largest_difference(study: Study, surfaces: xr.Dataset, scene: Scene, body: int) -> LargestDifference:
    """The largest absolute difference of any engine model (without one, of the last model) and the first model."""
    models = study.compared(scene)
    later = [model for model in models[1:] if model.side == "engine"] or models[-1:]
    totals = [step(surfaces, scene.name, "total", models[0], model, body, per=models[0]) for model in later]
    known = [total for total in totals if total.known.any()]
    if not known:
        nothing = WaterfallBar(models[-1].key, NAN, NAN)
        return LargestDifference((), nothing, (NAN, NAN), 0)
    total = max(known, key=lambda total: float(np.abs(total.size[total.known]).max()))
    assert total.place is not None
    chain = models[: models.index(total.second) + 1]
    bars = tuple(
        _at(step(surfaces, scene.name, second.key, first, second, body, per=models[0]), total.place)
        for first, second in pairwise(chain)
    )
    return LargestDifference(bars, _at(total, total.place), total.phases, len(total.size))


def _mean(step: Step, known: NDArray[np.bool_], stride: int) -> WaterfallBar:
    size, _ = step.mean(known, stride)
    error = float(step.every(stride, step.uncertainty)[known].mean()) if known.any() else NAN
    return WaterfallBar(step.second.key, size, error)


def _at(step: Step, place: tuple[int, int]) -> WaterfallBar:
    """The step at a place of the study's grid; NaN where it is not computed there."""
    if place[0] % step.stride or place[1] % step.stride:
        return WaterfallBar(step.second.key, NAN, NAN)
    index = place[0] // step.stride, place[1] // step.stride
    return WaterfallBar(step.second.key, float(step.size[index]), float(step.uncertainty[index]))
