"""
Largest length over time of vectors that are linear in exp(i alpha_1) and exp(i alpha_2), at many phase pairs.

A body's vector is v(t) = Re(A_1(t) exp(i alpha_1) + A_2(t) exp(i alpha_2)), one entry per axis. Time is cut into
intervals on which A is a short power series. Value and slope at the middle of an interval, with a bound on all later
terms, bound |v| on the whole interval. Intervals that cannot contain the largest length are skipped, and the others are
searched on the series itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import factorial, sqrt

import numpy as np
from numba import njit
from numpy.typing import NDArray

from reference.support.build_cache import cache_on_disk

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

STARTING_POINTS = np.linspace(-1.0, 1.0, 5)  # points of an interval; Newton's method starts from the best of them
NEWTON_STEPS = 5  # iterations of Newton's method that finds the instant of the largest displacement or acceleration
SERIES_REMAINDER = 1e-14  # error of the truncated series of displacement or acceleration, over its bound `envelope`


@dataclass(frozen=True)
class PhaseSeries:
    """
    Displacement or acceleration v of N bodies as power series in time, on T intervals, for any two initial phases.

    Attributes
    ----------
    terms : ndarray, (P, N, axes, 4, T)
        Coefficients of x^p, x from -1 to 1 on each interval, of Re A_1, Im A_1, Re A_2, Im A_2.
    rest : ndarray, (N, axes, T)
        Upper bound on the sum of the terms from p = 2 on at any phases.
    envelope : ndarray, (N,)
        Upper bound on |v| at any time and phases.
    """

    terms: Array
    rest: Array
    envelope: Array

    @classmethod
    def from_derivatives(cls, derivatives: Sequence[Complex], half: float) -> PhaseSeries:
        """Return the series from the time derivatives at the middle of each interval, lowest order first, each of them
        (T, N, axes, 2 harmonics); half: half the length of an interval, s."""
        scaled = np.stack([part * (half**order / factorial(order)) for order, part in enumerate(derivatives)])
        sizes = np.abs(scaled).sum(axis=-1)  # upper bound of each term at any phases: both harmonics' amplitudes add up
        terms = np.stack([scaled.real, scaled.imag], axis=-1).reshape(*scaled.shape[:-1], 4)
        envelope = np.sqrt((sizes.sum(axis=0) ** 2).sum(axis=-1)).max(axis=0)
        rest = np.moveaxis(sizes[2:].sum(axis=0), 0, -1)
        return cls(np.ascontiguousarray(np.moveaxis(terms, 1, -1)), np.ascontiguousarray(rest), envelope)


def largest_lengths(series: PhaseSeries, phases: Array) -> tuple[Array, Array]:
    """Return the largest length of v over time, a displacement or acceleration of each body, at the phases (M, 2), rad,
    and its error; both are (M, N)."""
    peaks, errors = np.empty((2, len(phases), len(series.envelope)))
    _maximize_over_time(series.terms, series.rest, _phase_factors(phases), peaks, errors)
    return peaks, errors + SERIES_REMAINDER * series.envelope


def may_reach_bound(series: PhaseSeries, phases: Array, bound: float) -> NDArray[np.bool_]:
    """Return a mask (M,): True at those phases (M, 2), rad, at which the length of v of body 1 may reach `bound`."""
    if series.envelope[0] < bound:
        return np.zeros(len(phases), dtype=bool)
    least, most = np.empty((2, series.terms.shape[-1]))
    may_reach = np.empty(len(phases), dtype=bool)
    for m, factors in enumerate(_phase_factors(phases)):
        _set_bounds(series.terms, series.rest, factors, 0, least, most)
        may_reach[m] = most.max() >= bound * bound
    return may_reach


def _phase_factors(phases: Array) -> Array:
    """Return cos and -sin of both phases, (M, 4): factors of Re A_n and Im A_n in v = Re(sum of A_n exp(i alpha_n))."""
    return np.stack([np.cos(phases), -np.sin(phases)], axis=-1).reshape(-1, 4)


@cache_on_disk(__file__)
def _set_bounds(terms: Array, rest: Array, factors: Array, body: int, least: Array, most: Array) -> None:
    """Set a body's |v|^2 at the middle of each interval, `least` (T,), and its upper bound in the interval, `most`."""
    least[:] = 0.0
    most[:] = 0.0
    for axis in range(terms.shape[2]):
        for n in range(len(least)):
            value, slope = (
                _power_coefficient(terms, factors, 0, body, axis, n),
                _power_coefficient(terms, factors, 1, body, axis, n),
            )
            size = abs(value) + abs(slope) + rest[body, axis, n]
            least[n] += value * value
            most[n] += size * size


@njit(nogil=True)
def _power_coefficient(terms: Array, factors: Array, order: int, body: int, axis: int, n: int) -> float:
    """Return the coefficient of x^order in a body's motion along an axis; x runs from -1 to 1 in interval n, and
    `factors` (4,) is a row of `_phase_factors`."""
    total = 0.0
    for part in range(4):
        total += factors[part] * terms[order, body, axis, part, n]
    return total


@cache_on_disk(__file__, nogil=True)
def _maximize_over_time(terms: Array, rest: Array, factors: Array, peaks: Array, errors: Array) -> None:
    """Set `peaks` (M, N), the largest |v| over time, and their `errors` (M, N); factors: `_phase_factors` (M, 4)."""
    # Branch and bound: the largest value at the middle of any interval is a lower bound of the peak, so only intervals
    # whose upper bound exceeds the best value so far are searched.
    orders, bodies, axes, _, intervals = terms.shape
    least, most = np.empty(intervals), np.empty(intervals)
    series = np.empty((axes, orders))
    for m in range(len(factors)):
        for body in range(bodies):
            _set_bounds(terms, rest, factors[m], body, least, most)
            best = 0.0
            for n in range(intervals):
                best = max(best, least[n])
            possible = best
            for n in range(intervals):
                if most[n] < best:
                    continue
                for axis in range(axes):
                    for order in range(orders):
                        series[axis, order] = _power_coefficient(terms, factors[m], order, body, axis, n)
                value, error = _maximize_on_interval(series)
                best = max(best, value)
                possible = max(possible, value + error)
            peaks[m, body] = sqrt(best)
            errors[m, body] = sqrt(max(best, possible)) - sqrt(best)


@njit(nogil=True)
def _maximize_on_interval(series: Array) -> tuple[float, float]:
    """Return the largest |v|^2 on an interval and its error; series: coefficients of x^p along each axis, (axes, P)."""
    # The error is the slope times the last step of Newton's method.
    best, place = -1.0, 0.0
    for x in STARTING_POINTS:
        value, _, _ = _squared_length(series, x)
        if value > best:
            best, place = value, x
    left = 0.0
    for _ in range(NEWTON_STEPS):
        _, slope, curvature = _squared_length(series, place)
        step = -slope / curvature if curvature < 0.0 else np.sign(slope)
        target = min(max(place + step, -1.0), 1.0)
        left = abs(slope * (target - place))
        if target == place:
            break
        place = target
        value, _, _ = _squared_length(series, place)
        best = max(best, value)
    return best, left


@njit(nogil=True)
def _squared_length(series: Array, x: float) -> tuple[float, float, float]:
    """Return |v|^2 and its first two derivatives by x, at x in [-1, 1]; series: coefficients of x^p, (axes, P)."""
    total = first = second = 0.0
    for axis in range(series.shape[0]):
        value = slope = curvature = 0.0
        for order in range(series.shape[1] - 1, -1, -1):
            curvature = curvature * x + 2.0 * slope
            slope = slope * x + value
            value = value * x + series[axis, order]
        total += value * value
        first += 2.0 * value * slope
        second += 2.0 * (slope * slope + value * curvature)
    return total, first, second
