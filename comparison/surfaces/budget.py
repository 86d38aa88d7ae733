"""
Budget of the total difference of a surface: what each model of the hierarchy adds, with its uncertainty.

Steps are taken between neighboring models that apply to the scene, so that they add up to the total by construction.
All are relative to the amplification by the first model: their sum is then the relative total.
"""

from collections.abc import Iterable, Sequence
from typing import Annotated, Any

import numpy as np

from comparison.result_types import Array, Number, result
from comparison.study.models import Pair
from comparison.surfaces.body_comparison import BodyComparison
from comparison.surfaces.differences import DifferenceStatistics, compute_difference_statistics
from comparison.surfaces.surfaces import select_values

TOTAL = "total"  # key of the difference between the first and the last model


@result
class BudgetEntry(DifferenceStatistics):
    """
    Statistics of the difference of a body's amplification between two successive models, or the first and the last.

    Sizes are relative to the first model. The signed mean is the bar in `waterfalls`.
    """

    step: Annotated[str, "key of the model that the step leads to, or total"]
    rms: Annotated[Number, "root mean square of the size"]
    resolved: Annotated[Number, "fraction of the points where |D| > 5 u_D"]
    unresolved: Annotated[Number, "fraction of the points where u_D < |D| <= 5 u_D"]
    error_estimate: Annotated[Number, "median of u_D"]
    peak_moves: Annotated[Number, "how far the highest point of the surface moves at least on the periodic square, rad"]
    correlation: Annotated[Number, "Pearson's correlation of the two surfaces"]
    points: Annotated[int, "phase pairs where both models have a value"]


def list_budget_entries(comparisons: Iterable[BodyComparison]) -> list[BudgetEntry]:
    """Return for each body an entry for the difference between every two successive models, then for the total."""
    return [
        _budget_entry(comparison, pair, key)
        for comparison in comparisons
        for key, pair in [
            *((pair.second.key, pair) for pair in comparison.consecutive_model_pairs),
            (TOTAL, comparison.total_pair),
        ]
    ]


def compute_closure_error(comparison: BodyComparison) -> float:
    """
    Return the largest |sum of effects - total difference| over the phase pairs; NaN if unknown.

    It is relative to the amplification by the first model.
    """
    total = comparison.difference(comparison.total_pair)
    differences = [comparison.difference(pair) for pair in comparison.consecutive_model_pairs]
    coarsest = max([total.stride, *(each.stride for each in differences)])
    gap = np.abs(
        np.sum([each.at_stride(coarsest, each.size) for each in differences], axis=0)
        - total.at_stride(coarsest, total.size)
    )
    return float(np.nanmax(gap)) if np.isfinite(gap).any() else float("nan")


def compute_torus_distance(first: Sequence[float], second: Sequence[float]) -> float:
    """Return the distance of two phase pairs on the square that is periodic in both directions, rad."""
    apart = np.abs(np.subtract(first, second)) % (2.0 * np.pi)
    return float(np.hypot(*np.minimum(apart, 2.0 * np.pi - apart)))


def _budget_entry(comparison: BodyComparison, pair: Pair, key: str) -> BudgetEntry:
    """Return the statistics of the difference of two models, with the share of phase pairs where it is resolved."""
    scene, difference = comparison.scene.name, comparison.difference(pair)
    known = difference.known
    about: dict[str, Any] = {
        **compute_difference_statistics(scene, difference),
        "step": key,
        "points": int(known.sum()),
    }
    if not known.any():
        names = ("rms", "resolved", "unresolved", "error_estimate", "peak_moves", "correlation")
        return BudgetEntry(**about | dict.fromkeys(names, float("nan")))
    pairs = (pair.first, pair.second, pair.base), (pair.second, pair.first, pair.base)

    def values(name: str) -> list[Array]:
        """Return the variable `name` of each of the two models; NaN where either has no value."""
        columns = (select_values(comparison.surfaces, name, scene, *each)[difference.body - 1] for each in pairs)
        return [np.where(known, column, np.nan) for column in columns]

    # Within its errors a surface may be highest at several phase pairs. The highest point moves at least as far as the
    # nearest two of them are apart.
    both, errors = values("mu"), values("error")
    places = [np.argwhere(mu + error >= np.nanmax(mu - error)) for mu, error in zip(both, errors)]
    highest = [[(difference.alpha1[row], difference.alpha2[column]) for row, column in place] for place in places]
    return BudgetEntry(
        **about,
        rms=float(np.sqrt((difference.size[known] ** 2).mean())),
        resolved=float(difference.resolved[known].mean()),
        unresolved=float(difference.unresolved[known].mean()),
        error_estimate=float(np.median(difference.uncertainty[known])),
        peak_moves=float("nan")
        if difference.recorded
        else min(compute_torus_distance(first, second) for first in highest[0] for second in highest[1]),
        correlation=_correlation(both[0][known], both[1][known]),
    )


def _correlation(first: Array, second: Array) -> float:
    """Return Pearson's correlation of two arrays, NaN if one of them is constant."""
    a, b = first - first.mean(), second - second.mean()
    scale = float(np.sqrt((a @ a) * (b @ b)))
    return float(a @ b) / scale if scale > 0.0 else float("nan")
