"""
Trend of a difference with a parameter: an exponent fitted through values that have error bars.

A value enters the fit only where it is known to a fifth of itself: a slope through noise is not a slope. All phase
pairs of a surface share one exponent and have a size of their own. Its uncertainty is two standard errors, of the
scatter about the line and of the error bars together.
"""

import math
from collections.abc import Sequence
from typing import Annotated, NamedTuple

import numpy as np

from comparison.result_types import Array, Number, Text, result
from comparison.surfaces.model_difference import RESOLVED_RATIO
from comparison.verdicts import MET, NOT_COMPARED, NOT_MET, Verdict, count_verdicts, word_counts

NO_VALUES: Array = np.empty((0, 1))  # stands for the differences, and for their errors, if no phase pair has any
MAX_FITTED_ERROR = 1.0 / RESOLVED_RATIO  # A difference enters the fit if its error is at most this fraction of it.
MAX_EXPONENT_UNCERTAINTY = 0.25  # A fitted exponent with a larger uncertainty gets no verdict.
MIN_EXPONENT = 0.3  # A difference that falls with a smaller exponent counts as not converged.
# A fitted exponent may differ from theory by this: at the largest parameters the power law does not yet hold exactly.
MAX_EXPONENT_DEVIATION = 0.15


class FittedSlope(NamedTuple):
    """Exponent n fitted to |difference| ~ parameter^n, with its uncertainty; both are NaN if too little is known."""

    exponent: float
    uncertainty: float
    points: int  # number of differences in the fit
    pairs: int  # number of phase pairs to which these differences belong


@result
class Trend:
    """Power law by which a relative difference of amplification falls with a parameter, and how it is judged."""

    scene: Annotated[Text, "name of the scene"]
    body: Annotated[int, "number of the body; 1 is the platform"]
    what: Annotated[str, "the two things that differ"]
    parameter: Annotated[tuple[float, ...], "values of the parameter, falling"]
    medians: Annotated[tuple[Number, ...], "median absolute relative difference over the phase pairs, for every value"]
    exponent: Number
    """exponent of the power law fitted to the differences above their errors; null without enough of them"""
    uncertainty: Annotated[Number, "of the exponent"]
    points: Annotated[int, "differences in the fit"]
    pairs: Annotated[int, "phase pairs that they are of"]
    expected: Annotated[float | None, "exponent that theory gives, or null"]
    verdict: Annotated[Text, "what the fit allows to say"]


def fit_slope(parameter: Sequence[float], sizes: Array, errors: Array) -> FittedSlope:
    """
    Return the exponent n of |difference| ~ parameter^n, which all phase pairs have in common.

    sizes, errors: differences and their absolute errors, a row for each phase pair, a column for each parameter value.
    """
    # Least squares through log|difference| over log(parameter). Every phase pair has an intercept of its own, which is
    # gone once its mean is subtracted; the slope is common. The variance of the slope has two parts: `scatter`, from
    # the distances to the line, and `carried`, from the error bars of the differences.
    known = np.isfinite(sizes) & (errors <= MAX_FITTED_ERROR * np.abs(sizes)) & (sizes != 0.0)
    rows = np.flatnonzero(known.sum(axis=1) > 1)
    points = int(known[rows].sum())
    freedom = points - len(rows) - 1
    if freedom < 1:
        return FittedSlope(np.nan, np.nan, points, len(rows))
    parts = []
    for row in rows:
        size = np.abs(sizes[row, known[row]])
        logarithms = np.log([np.asarray(parameter)[known[row]], size])
        parts.append([*(logarithms - logarithms.mean(axis=1, keepdims=True)), errors[row, known[row]] / size])
    along, up, noise = (np.concatenate(column) for column in zip(*parts))
    spread = float(along @ along)
    exponent = float(along @ up) / spread
    scatter = float(((up - exponent * along) ** 2).sum()) / freedom / spread
    carried = float(((along * noise) ** 2).sum()) / spread**2
    return FittedSlope(exponent, 2.0 * float(np.sqrt(scatter + carried)), points, len(rows))


def fit_trend(
    scene: str,
    body: int,
    what: str,
    parameter: Sequence[float],
    sizes: Array,
    errors: Array,
    expected: float | None,
    error_message: str = "",
) -> Trend:
    """
    Return the power law |difference| ~ parameter^n fitted to differences, with the verdict whether n is `expected`.

    sizes, errors: signed differences and their errors, a row for each phase pair, a column for each parameter value,
    NaN if unknown. error_message: stands in place of the verdict if the differences could not be computed.
    """
    slope = fit_slope(parameter, sizes, errors)
    columns = [column[np.isfinite(column)] for column in np.abs(sizes).T] if len(sizes) else [sizes] * len(parameter)
    medians = tuple(float(np.median(column)) if column.size else math.nan for column in columns)
    return Trend(
        scene=scene,
        body=body,
        what=what,
        parameter=tuple(parameter),
        medians=medians,
        **slope._asdict(),
        expected=expected,
        verdict=error_message or _word_slope_verdict(slope, expected),
    )


def word_trends(trends: Sequence[Trend]) -> str:
    """Return in words how many fitted exponents agree with theory, and the first that does not."""
    expected = [each for each in trends if each.expected is not None]
    verdicts = {id(each): _judge_exponent(each.exponent, each.uncertainty, each.expected) for each in expected}
    missed = [each for each in expected if verdicts[id(each)] == NOT_MET]
    where = ""
    if missed:
        each = missed[0]
        found = f"{each.exponent:.2f} ± {each.uncertainty:.2f} for {each.expected:g}"
        where = f"{each.scene}, body {each.body}, {each.what}, {found}"
    words = word_counts(count_verdicts(verdicts.values()), "expected exponent")
    return f"{words} (first: {where})" if where else words


def _judge_exponent(exponent: float, uncertainty: float, expected: float | None) -> Verdict:
    """Return whether a fitted exponent agrees with the expected one: met, not met or not compared."""
    if expected is None or not np.isfinite(exponent) or uncertainty > MAX_EXPONENT_UNCERTAINTY:
        return NOT_COMPARED
    return MET if abs(exponent - expected) <= max(MAX_EXPONENT_DEVIATION, uncertainty) else NOT_MET


def _word_slope_verdict(slope: FittedSlope, expected: float | None) -> str:
    """Return in words whether the fitted exponent is the expected one, or why that cannot be said."""
    if not np.isfinite(slope.exponent):
        return "within the error bars: no slope can be told"
    if slope.uncertainty > MAX_EXPONENT_UNCERTAINTY:
        return "no single slope: phase pairs or values do not agree"
    if expected is None:
        return "hardly falls: not converged at any value in use" if slope.exponent < MIN_EXPONENT else "falls"
    agrees = _judge_exponent(slope.exponent, slope.uncertainty, expected) == MET
    return f"like the power {expected:g}" if agrees else f"not like the power {expected:g}"
