"""Difference statistics of two models' surfaces: one row for each scene, pair of models and body."""

import math
from typing import Annotated, Any

import numpy as np

from comparison.result_types import Number, Phases, Text, result
from comparison.study.models import readings_of
from comparison.study.study import nested_grids
from comparison.surfaces.model_difference import RESOLVED_RATIO, ModelDifference
from comparison.surfaces.sampling import compute_mean_of_known, estimate_sampling_error
from reference.measures.distribution import fractile
from reference.problem import Scene
from reference.problem.readings import BOTH_READINGS

MAX_AGREEING_RATIO = 2.0  # models agree if their difference is at most so many times its uncertainty u_D


@result
class DifferenceStatistics:
    """Statistics of the relative difference of two models in one body, over the phase pairs where both have a value."""

    scene: Annotated[Text, "name of the scene"]
    body: Annotated[int, "number of the body; 1 is the platform"]
    first: Annotated[str, "key of the first model"]
    second: Annotated[str, "key of the second model"]
    base: Annotated[str, "key of the model whose mu all sizes are relative to"]
    median: Annotated[Number, "median of the absolute size"]
    percentile95: Annotated[Number, "95 % of the absolute sizes are below this"]
    maximum: Annotated[Number, "largest absolute size"]
    phases: Annotated[Phases, "(alpha1, alpha2) of the largest, rad"]
    asked: Annotated[int, "phase pairs that both models were asked for"]


@result
class GridMean:
    """Mean and largest difference of two models on one of the nested grids of phases."""

    phases_per_axis: Annotated[int, "phases per axis"]
    mean: Annotated[Number, "mean of the signed size"]
    maximum: Annotated[Number, "largest absolute size"]


@result
class Difference(DifferenceStatistics):
    """
    Statistics of the difference between the amplifications of a body by two models, as a row of the report's table.

    The difference is that of the second less the first model, relative to `base`, at the phase pairs of both.
    """

    pair: Annotated[str, "key of the pair: total, translational, like-for-like, supremum, reading, or of an effect"]
    effect: Annotated[str, "what the second model adds to the first; empty where that is no single effect"]
    reading: Annotated[str, "reading of (5.1) on both sides; the two readings joined by ' to ' where they differ"]
    mean: Annotated[Number, "mean of the signed size over the phase pairs where both models have a value"]
    numerical_error: Annotated[Number, "error of the mean that the error estimates of both models leave"]
    sampling_error: Annotated[Number, "error of the mean that the grid of phases leaves; null where it does not tell"]
    spread: Annotated[Number, "standard deviation of the signed size over the same phase pairs"]
    low: Annotated[Number, "smallest signed size"]
    low_error: Annotated[Number, "error estimate of it"]
    low_phases: Annotated[Phases, "(alpha1, alpha2) of it, rad"]
    high: Annotated[Number, "largest signed size"]
    high_error: Annotated[Number, "error estimate of it"]
    high_phases: Annotated[Phases, "(alpha1, alpha2) of it, rad"]
    phases_per_axis: Annotated[int, "of the grid of phase pairs that both models were asked for; 1 under a record"]
    independent: Annotated[int, "phase pairs where both have a value that no symmetry of the scene relates"]
    grids: Annotated[tuple[GridMean, ...], "the same on the nested grids, from coarse to fine"]
    beyond_error: Number
    """fraction of the phase pairs where it exceeds u_D = sqrt(u_A^2 + u_B^2), the two error estimates together"""
    resolved: Annotated[Number, "fraction of the phase pairs where it exceeds 5 u_D"]
    ratio: Annotated[Number, "largest absolute size in units of u_D"]
    not_ok: Annotated[int, "phase pairs where either outcome is not ok"]
    unanswered: Annotated[int, "phase pairs where either has no value"]

    @property
    def error(self) -> float:
        """Return the error of the mean difference, numerical and from the choice of phases; NaN if one is unknown."""
        return float(np.hypot(self.numerical_error, self.sampling_error))

    @property
    def largest(self) -> float:
        """Return the difference whose absolute value is largest, with its sign; it occurs at `phases`."""
        return self.low if abs(self.low) > abs(self.high) else self.high

    @property
    def agrees(self) -> bool | None:
        """
        Return whether the models agree within their errors wherever both have a value; None where an error is unknown.
        """
        return None if math.isnan(self.ratio) else self.ratio <= MAX_AGREEING_RATIO

    @property
    def mean_is_resolved(self) -> bool:
        """Return whether the mean difference exceeds its sampling error, and five times its numerical error."""
        return abs(self.mean) > self.sampling_error and abs(self.mean) > RESOLVED_RATIO * self.numerical_error


def compute_difference_statistics(scene: str, difference: ModelDifference) -> dict[str, Any]:
    """Return the fields of `DifferenceStatistics` (median, largest, and others) for a difference of two models."""
    size = np.abs(difference.size[difference.known])
    median, percentile95, maximum = (fractile(size, p) if size.size else np.nan for p in (0.5, 0.95, 1.0))
    return {
        "scene": scene,
        "body": difference.body,
        "first": difference.pair.first.key,
        "second": difference.pair.second.key,
        "base": difference.pair.base.key,
        "median": float(median),
        "percentile95": float(percentile95),
        "maximum": float(maximum),
        "phases": difference.phases,
        "asked": difference.size.size,
    }


def make_difference_row(scene: Scene, difference: ModelDifference, independent: int, not_ok: int) -> Difference:
    """
    Return the statistics of a difference of two models.

    independent: number of phase pairs with a value, mirrored ones counted once. not_ok: number of pairs at which the
    outcome of either model is not "ok".
    """
    pair, size, known = difference.pair, difference.size, difference.known
    grid = len(size)
    stated = known & np.isfinite(difference.uncertainty)
    nan = float("nan")
    ends = difference.find_largest(-size), difference.find_largest(size)  # where it is smallest, where largest
    return Difference(
        **compute_difference_statistics(scene.name, difference),
        pair=pair.key,
        effect=pair.effect,
        reading=" to ".join(readings_of((pair.first, pair.second), scene)) or BOTH_READINGS,
        mean=compute_mean_of_known(size),
        numerical_error=float(difference.uncertainty[known].mean()) if known.any() else nan,
        sampling_error=0.0 if difference.recorded else estimate_sampling_error(size, independent),
        spread=float(size[known].std()) if known.any() else nan,
        low=difference.at(size, ends[0]),
        low_error=difference.at(difference.uncertainty, ends[0]),
        low_phases=difference.phases_at(ends[0]),
        high=difference.at(size, ends[1]),
        high_error=difference.at(difference.uncertainty, ends[1]),
        high_phases=difference.phases_at(ends[1]),
        phases_per_axis=grid,
        independent=independent,
        grids=tuple(_grid_mean(size[:: grid // coarse, :: grid // coarse]) for coarse in nested_grids(grid)),
        beyond_error=float((np.abs(size) > difference.uncertainty)[stated].mean()) if stated.any() else nan,
        resolved=float(difference.resolved[known].mean()) if known.any() else nan,
        ratio=float(difference.ratio[known].max()) if known.any() and (stated == known).all() else nan,
        not_ok=not_ok,
        unanswered=int((~known).sum()),
    )


def _grid_mean(sizes: np.ndarray) -> GridMean:
    """Return the mean of a difference and its largest absolute value on a phase grid. sizes: (n, n), NaN if unknown."""
    known = np.abs(sizes[np.isfinite(sizes)])
    return GridMean(
        phases_per_axis=len(sizes),
        mean=compute_mean_of_known(sizes),
        maximum=float(known.max()) if known.size else float("nan"),
    )
