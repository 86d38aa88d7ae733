"""
The total difference of a surface, taken apart: what each model of the hierarchy adds, with its uncertainty.

Steps are taken between neighboring models that apply to the scene, so that they add up to the total by construction.
All are relative to mu of the first model: their sum is then the relative total.
"""

from collections.abc import Sequence
from itertools import pairwise
from typing import Annotated, Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from comparison.result_types import Array, Number, Phases, Text, result
from comparison.study.study import Study
from comparison.surfaces.steps import Step, step
from comparison.surfaces.surfaces import values_of
from reference.measures.distribution import fractile

TOTAL = "total"


@result
class Sizes:
    """How large the difference of two models is in one body, over the phase pairs where both have a value."""

    scene: Annotated[Text, "name of the scene"]
    body: Annotated[int, "number of the body; 1 is the platform"]
    first: Annotated[str, "key of the first model"]
    second: Annotated[str, "key of the second model"]
    median: Annotated[Number, "median of the absolute size"]
    percentile95: Annotated[Number, "95 % of the absolute sizes are below this"]
    maximum: Annotated[Number, "largest absolute size"]
    phases: Annotated[Phases, "(alpha1, alpha2) of the largest, rad"]
    asked: Annotated[int, "phase pairs that both models were asked for"]


@result
class BudgetEntry(Sizes):
    """
    One step of the model hierarchy, or the total, in one body; relative to mu of the first model.

    Its signed mean is the bar in `waterfalls`.
    """

    step: Annotated[str, "key of the model that the step leads to, or total"]
    rms: Annotated[Number, "root mean square of the size"]
    real: Annotated[Number, "fraction of the points where |D| > 5 u_D"]
    unresolved: Annotated[Number, "fraction of the points where u_D < |D| <= 5 u_D"]
    error_estimate: Annotated[Number, "median of u_D"]
    peak_moves: Annotated[Number, "how far the highest point of the surface moves at least on the periodic square, rad"]
    correlation: Annotated[Number, "Pearson's correlation of the two surfaces"]
    points: Annotated[int, "phase pairs where both models have a value"]


def steps(study: Study, surfaces: xr.Dataset, scene: str, body: int) -> list[Step]:
    """The steps of one body's surface in the order of the hierarchy, named after their second model, and the total."""
    models = study.compared(next(known for known in study.scenes if known.name == scene))
    pairs = [(second.key, first, second) for first, second in pairwise(models)]
    return [
        step(surfaces, scene, key, first, second, body, per=models[0])
        for key, first, second in [*pairs, (TOTAL, models[0], models[-1])]
    ]


def budget(study: Study, surfaces: xr.Dataset) -> list[BudgetEntry]:
    """Every entry of the table, in the order scene, body, step."""
    return [
        _entry(surfaces, scene.name, step)
        for scene in study.scenes
        for body in range(1, len(scene.bodies) + 1)
        for step in steps(study, surfaces, scene.name, body)
    ]


def known_to_all(steps: Sequence[Step]) -> tuple[int, NDArray[np.bool_]]:
    """Where every step has a size: the stride of the coarsest of their phases, and which of these phases."""
    coarsest = max(step.stride for step in steps)
    return coarsest, np.all([step.every(coarsest, step.known) for step in steps], axis=0)


def closure(steps: Sequence[Step]) -> float:
    """Largest |sum of the steps - total| relative to mu of the first model: rounding; NaN without a common point."""
    coarsest = max(step.stride for step in steps)
    *sizes, total = (step.every(coarsest, step.size) for step in steps)
    gap = np.abs(np.sum(sizes, axis=0) - total)
    return float(np.nanmax(gap)) if np.isfinite(gap).any() else float("nan")


def torus_distance(first: Sequence[float], second: Sequence[float]) -> float:
    """Distance of two phase pairs on the square that closes at 2 pi in both directions, rad."""
    apart = np.abs(np.subtract(first, second)) % (2.0 * np.pi)
    return float(np.hypot(*np.minimum(apart, 2.0 * np.pi - apart)))


def sizes(scene: str, step: Step) -> dict[str, Any]:
    """The fields of `Sizes`."""
    size = np.abs(step.size[step.known])
    median, percentile95, maximum = (fractile(size, p) if size.size else np.nan for p in (0.5, 0.95, 1.0))
    return {
        "scene": scene,
        "body": step.body,
        "first": step.first.key,
        "second": step.second.key,
        "median": float(median),
        "percentile95": float(percentile95),
        "maximum": float(maximum),
        "phases": step.phases,
        "asked": step.size.size,
    }


def _entry(surfaces: xr.Dataset, scene: str, step: Step) -> BudgetEntry:
    known = step.known
    about: dict[str, Any] = {**sizes(scene, step), "step": step.key, "points": int(known.sum())}
    if not known.any():
        names = ("rms", "real", "unresolved", "error_estimate", "peak_moves", "correlation")
        return BudgetEntry(**about | dict.fromkeys(names, float("nan")))
    pairs = (step.first, step.second), (step.second, step.first)
    both, errors = (
        [np.where(known, values_of(surfaces, name, scene, *pair)[step.body - 1], np.nan) for pair in pairs]
        for name in ("mu", "error")
    )
    places = [np.argwhere(mu + error >= np.nanmax(mu - error)) for mu, error in zip(both, errors)]
    highest = [[(step.alpha1[row], step.alpha2[column]) for row, column in place] for place in places]
    return BudgetEntry(
        **about,
        rms=float(np.sqrt((step.size[known] ** 2).mean())),
        real=float(step.real[known].mean()),
        unresolved=float(step.unresolved[known].mean()),
        error_estimate=float(np.median(step.uncertainty[known])),
        peak_moves=float("nan")
        if step.recorded
        else min(torus_distance(first, second) for first in highest[0] for second in highest[1]),
        correlation=_correlation(both[0][known], both[1][known]),
    )


def _correlation(first: Array, second: Array) -> float:
    """Pearson's, NaN for a flat surface."""
    a, b = first - first.mean(), second - second.mean()
    scale = float(np.sqrt((a @ a) * (b @ b)))
    return float(a @ b) / scale if scale > 0.0 else float("nan")
