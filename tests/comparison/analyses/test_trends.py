"""Exponents are fitted with their uncertainty; what is not known, or has no single slope, is said and not fitted."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from comparison.analyses.trends import Slope, fitted, trend

Array = NDArray[np.float64]
SCALES = (1.0, 0.5, 0.25, 0.125)
S = np.array(SCALES)


def _power(exponent: float, *heights: float) -> Array:
    return np.array([height * S**exponent for height in heights])


@pytest.mark.parametrize("exponent", [0.5, 1.0, 2.0])
def test_a_power_is_found_whatever_its_size_and_sign(exponent: float) -> None:
    sizes = _power(exponent, 1e-2, -3e-4)
    slope = fitted(SCALES, sizes, 1e-9 * np.abs(sizes))
    assert slope.exponent == pytest.approx(exponent, abs=1e-9)
    assert slope.uncertainty < 1e-6
    assert (slope.points, slope.pairs) == (8, 2)


def test_the_uncertainty_covers_the_scatter() -> None:
    """Two standard errors: at least nine of ten fits lie within them; 200 draws leave 3 % of play."""
    random = np.random.default_rng(4)
    within = 0
    for _ in range(200):
        sizes = _power(2.0, 1e-2, 2e-2, 3e-3) * np.exp(random.normal(0.0, 0.1, (3, 4)))
        slope = fitted(SCALES, sizes, 1e-6 * np.abs(sizes))
        within += abs(slope.exponent - 2.0) <= slope.uncertainty
    assert within > 174


def test_error_bars_alone_make_an_uncertainty() -> None:
    sizes = _power(1.0, 1e-2)
    wide, narrow = (fitted(SCALES, sizes, share * sizes) for share in (0.1, 0.01))
    assert wide.uncertainty == pytest.approx(10.0 * narrow.uncertainty, rel=1e-6)
    assert 0.05 < wide.uncertainty < 0.2


def test_values_within_their_error_bars_are_not_fitted() -> None:
    sizes = _power(2.0, 1e-3)
    errors = np.full_like(sizes, 1e-4)  # the last two sizes, 6e-5 and 1.6e-5, drown, and 2.5e-4 is not known to a fifth
    assert np.isnan(fitted(SCALES, sizes, errors).exponent)
    noise = trend("s", 1, "w", SCALES, sizes, errors, 2.0)
    assert noise.verdict == "within the error bars: no slope can be told"


def test_points_without_a_value_are_left_out() -> None:
    sizes = _power(2.0, 1e-2, 2e-2)
    sizes[0, 1] = np.nan
    slope = fitted(SCALES, sizes, 1e-8 * np.abs(sizes))
    assert slope.points == 7
    assert slope.exponent == pytest.approx(2.0)
    nothing = fitted(SCALES, np.full((2, 4), np.nan), np.full((2, 4), np.nan))
    assert (nothing.points, np.isnan(nothing.exponent)) == (0, True)


@pytest.mark.parametrize(
    ("sizes", "expected", "says"),
    [
        (_power(2.0, 1e-2), 2.0, "like the power 2"),
        (_power(1.0, 1e-2), 2.0, "not like the power 2"),
        (np.array([[1e-2, 2e-3, 5e-3, 1e-5]]), 2.0, "no single slope: phase pairs or values do not agree"),
        (_power(0.1, 1e-2), None, "hardly falls: not converged at any value in use"),
        (_power(1.0, 1e-2), None, "falls"),
    ],
)
def test_the_verdict_says_what_the_fit_allows(sizes: Array, expected: float | None, says: str) -> None:
    assert trend("s", 1, "w", SCALES, sizes, 1e-6 * np.abs(sizes), expected).verdict == says


def test_medians_are_of_the_absolute_size_of_what_is_known() -> None:
    sizes = trend("s", 1, "w", (1.0, 0.5), np.array([[-4.0, 1.0], [2.0, np.nan], [3.0, np.nan]]), np.ones((3, 2)), None)
    assert sizes.medians == (3.0, 1.0)
    assert Slope(1.0, 0.1, 2, 1).points == 2
