"""
How a difference falls with what causes it: an exponent fitted through values that have error bars.

A value enters the fit only where it is known to a fifth of itself: a slope through noise is not a slope. All phase
pairs of a surface share one exponent and have a size of their own. Its uncertainty is two standard errors, of the
scatter about the line and of the error bars together.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from comparison.surfaces.steps import RESOLVED

Array = NDArray[np.float64]

KNOWN = 1.0 / RESOLVED  # largest error of a value that enters the fit, as its fraction
SETTLED = 0.25  # largest uncertainty of an exponent that says something
SLOW = 0.3  # exponent below which a difference is no smaller at any value in use
AGREES = 0.15  # of an exponent with its theory: the largest parameter is not yet in the asymptotic range


@dataclass(frozen=True)
class Slope:
    """
    size ~ parameter^exponent, +- uncertainty; NaN where too few values are known. points: how many were used, of how
    many phase pairs.
    """

    exponent: float
    uncertainty: float
    points: int
    pairs: int


@dataclass(frozen=True)
class Trend:
    """
    Relative differences of mu_`body` over a parameter, for some phase pairs.

    what: the two things that differ. parameter: falling values (S,). sizes, errors: (P, S), signed and absolute, NaN
    without an answer. expected: exponent that theory gives, or None. error_message: what went wrong, or "".
    """

    scene: str
    body: int
    what: str
    parameter: tuple[float, ...]
    sizes: tuple[tuple[float, ...], ...]
    errors: tuple[tuple[float, ...], ...]
    expected: float | None
    error_message: str = ""

    @property
    def slope(self) -> Slope:
        """Exponent of the sizes over the parameter."""
        return fitted(self.parameter, np.array(self.sizes), np.array(self.errors))

    @property
    def medians(self) -> list[float]:
        """Median absolute size over the phase pairs, for every value of the parameter."""
        sizes = np.abs(np.array(self.sizes)).reshape(-1, len(self.parameter))
        return [float(np.median(column[np.isfinite(column)])) if np.isfinite(column).any() else np.nan
                for column in sizes.T]  # fmt: skip

    @property
    def verdict(self) -> str:
        """What the fit allows to say, in words."""
        slope = self.slope
        if self.error_message:
            return self.error_message
        if not np.isfinite(slope.exponent):
            return "within the error bars: no slope can be told"
        if slope.uncertainty > SETTLED:
            return "no single slope: phase pairs or values do not agree"
        if self.expected is None:
            return "hardly falls: not converged at any value in use" if slope.exponent < SLOW else "falls"
        agrees = abs(slope.exponent - self.expected) <= max(AGREES, slope.uncertainty)
        return f"like the power {self.expected:g}" if agrees else f"not like the power {self.expected:g}"


def fitted(parameter: Sequence[float], sizes: Array, errors: Array) -> Slope:
    """One exponent for all rows of sizes (P, S) with absolute errors (P, S), over the parameter (S,)."""
    known = np.isfinite(sizes) & (errors <= KNOWN * np.abs(sizes)) & (sizes != 0.0)
    rows = [row for row in range(len(sizes)) if known[row].sum() > 1]
    points = sum(int(known[row].sum()) for row in rows)
    freedom = points - len(rows) - 1
    if freedom < 1:
        return Slope(np.nan, np.nan, points, len(rows))
    x, y, error_estimate = [], [], []
    for row in rows:
        abscissa = np.log(np.asarray(parameter)[known[row]])
        ordinate = np.log(np.abs(sizes[row, known[row]]))
        x.append(abscissa - abscissa.mean())
        y.append(ordinate - ordinate.mean())
        error_estimate.append(errors[row, known[row]] / np.abs(sizes[row, known[row]]))
    along, up, noise = (np.concatenate(parts) for parts in (x, y, error_estimate))
    spread = float(along @ along)
    exponent = float(along @ up) / spread
    scatter = float(((up - exponent * along) ** 2).sum()) / freedom / spread
    carried = float(((along * noise) ** 2).sum()) / spread**2
    return Slope(exponent, 2.0 * float(np.sqrt(scatter + carried)), points, len(rows))


def trend(
    scene: str,
    body: int,
    what: str,
    parameter: Sequence[float],
    sizes: Array,
    errors: Array,
    expected: float | None,
) -> Trend:
    """A trend from arrays (P, S)."""
    rows = [tuple(tuple(map(float, row)) for row in values) for values in (sizes, errors)]
    return Trend(scene, body, what, tuple(parameter), rows[0], rows[1], expected)
