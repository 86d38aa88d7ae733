"""
The measured quantity: the dynamic amplification factor (5.1).

mu_i = sqrt(max_t |absolute acceleration of body i|^2 / max_t |ground acceleration|^2) over 0 <= t <= duration.
The denominator depends on the scene and the phases alone, so both sides take it from here.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray

from reference.problem.excitation import exponents, ground_acceleration, loading_period
from reference.problem.phases import check_phases
from reference.problem.scene import Scene, require_scene
from reference.support.build_cache import cache_on_disk

Array = NDArray[np.float64]

SAMPLES_PER_PERIOD = 32  # samples per period of the faster harmonic: 16 per wave of the squared acceleration
# Fraction of the highest squared sample above which a sample is computed again: rounding may hide which is the highest
MIN_RECOMPUTED_SHARE = 1.0 - 1e-9


@require_scene
def ground_peak(scene: Scene, phases: ArrayLike) -> Array:
    """
    Return the largest ground acceleration over the duration, the denominator of the amplification (5.1).

    Parameters
    ----------
    scene : Scene
    phases : array_like, (M, 2), rad

    Returns
    -------
    ndarray, (M,), m/s^2
        max_t |ground acceleration| over [0, duration], to rounding.

    Raises
    ------
    ValueError
        As `check_phases`.

    Examples
    --------
    >>> from reference.problem import load_scene
    >>> ground_peak(load_scene("fig3-I"), [(0.0, 0.0)]).round(3).tolist()  # both harmonics at their largest
    [1.414]
    """
    pairs = check_phases(phases)
    if scene.recorded:
        return np.full(len(pairs), _record_peak(scene))
    s = exponents(scene)
    step = loading_period(scene) / SAMPLES_PER_PERIOD
    with np.errstate(over="ignore"):
        weights = np.sqrt((scene.amplitudes**2).sum(axis=0))
    rates = np.stack([s.real, s.imag], axis=1)
    return _ground_peaks(pairs, scene.amplitudes, weights, rates, scene.duration, min(step, scene.duration / 8.0))


def _record_peak(scene: Scene) -> float:
    """Return the largest acceleration of a recorded motion over the duration, m/s^2."""
    # The length of a vector that changes linearly in time is convex: largest at a sample, or where the motion ends.
    time = scene.record[:, 0]
    instants = np.append(time[time < scene.duration], scene.duration)
    with np.errstate(over="ignore"):
        return float(np.sqrt((ground_acceleration(scene, (0.0, 0.0), instants) ** 2).sum(axis=1)).max())


@njit(nogil=True)
def _square_and_slopes(t: float, phase: Array, amplitudes: Array, s: Array) -> tuple[float, float, float]:
    """
    Return the squared ground acceleration and its first two derivatives at time t, s.

    phase: (2,), rad. amplitudes: (3, 2), m/s^2. s: (2, 2), 1/s, real and imaginary part of each harmonic's exponent.
    """
    value = slope = curvature = 0.0
    for k in range(3):
        u = du = ddu = 0.0
        for harmonic in range(2):
            rate, pace = s[harmonic, 0], s[harmonic, 1]
            size, angle = amplitudes[k, harmonic] * math.exp(rate * t), pace * t + phase[harmonic]
            x, y = size * math.cos(angle), size * math.sin(angle)
            u += x
            du += rate * x - pace * y
            ddu += (rate * rate - pace * pace) * x - 2.0 * rate * pace * y
        value += u * u
        slope += 2.0 * u * du
        curvature += 2.0 * (du * du + u * ddu)
    return value, slope, curvature


@njit(nogil=True)
def _refine_maximum(left: float, right: float, phase: Array, amplitudes: Array, s: Array) -> float:
    """
    Return the peak of the squared ground acceleration near a high sample between the times left and right, s.

    Newton's method finds the zero of the slope; a step that leaves the interval is replaced by a bisection.
    """
    t = 0.5 * (left + right)
    close = 1e-9 * (right - left)
    best = 0.0
    for _ in range(60):
        value, slope, curvature = _square_and_slopes(t, phase, amplitudes, s)
        best = max(best, value)
        guess = t - slope / curvature if curvature < 0.0 else math.inf
        if abs(guess - t) <= close or right - left <= close:
            break
        if slope > 0.0:
            left = t
        else:
            right = t
        t = guess if left < guess < right else 0.5 * (left + right)
    return best


@njit(nogil=True)
def _fill_sample(n: int, t: float, weights: Array, s: Array, grown: Array, bound: Array) -> None:
    """
    Set row n of the tables over the samples, which serve all phase pairs, for the sample at time t, s.

    grown: exp(s t) of both harmonics. bound: the squared acceleration never exceeds it from this sample on.
    """
    largest = 0.0
    for harmonic in range(2):
        size, angle = math.exp(s[harmonic, 0] * t), s[harmonic, 1] * t
        grown[n, harmonic, 0], grown[n, harmonic, 1] = size * math.cos(angle), size * math.sin(angle)
        largest += weights[harmonic] * size
    bound[n] = largest**2


@njit(nogil=True)
def _square_at_sample(phase_factor: Array, amplitudes: Array, grown: Array) -> float:
    """
    Return the squared ground acceleration at one sample.

    phase_factor: exp(i phase), and grown: exp(s t), each (2, 2): per harmonic the real and the imaginary part.
    """
    value = 0.0
    for k in range(3):
        u = 0.0
        for harmonic in range(2):
            real, imaginary = grown[harmonic]
            cosine, sine = phase_factor[harmonic]
            u += amplitudes[k, harmonic] * (cosine * real - sine * imaginary)
        value += u * u
    return value


@cache_on_disk(__file__, nogil=True)
def _ground_peaks(phases: Array, amplitudes: Array, weights: Array, s: Array, duration: float, step: float) -> Array:
    """
    Return the peaks of the ground acceleration (M,), m/s^2, for phase pairs (M, 2), rad.

    weights: (2,), m/s^2, length of each harmonic's amplitude vector. s: (2, 2), 1/s, as in `_square_and_slopes`.
    step: s, between the samples.
    """
    # For each phase pair the squared acceleration is sampled until a bound shows that all later values are smaller than
    # the highest sample. Only samples that may stand beside the peak are then refined. As exp(s t) does not depend on
    # the phases, it is computed once per sample and kept.
    count = math.ceil(duration / step) + 1
    peaks = np.empty(phases.shape[0])
    grown = np.empty((count, 2, 2))  # exp(s t) of both harmonics at the samples, as real and imaginary part
    bound = np.empty(count)  # upper bound on the squared acceleration from each sample on
    phase_factor = np.empty((2, 2))  # real and imaginary part of exp(i phase) of both harmonics
    known = 0  # number of samples at which `grown` and `bound` are computed
    square = np.empty(count)  # squared acceleration at the samples for one phase pair
    for m in range(phases.shape[0]):
        phase = phases[m]
        for harmonic in range(2):
            phase_factor[harmonic, 0], phase_factor[harmonic, 1] = math.cos(phase[harmonic]), math.sin(phase[harmonic])
        highest = 0.0
        end = count
        for n in range(count):
            if n == known:
                _fill_sample(n, min(n * step, duration), weights, s, grown, bound)
                known += 1
            value = square[n] = _square_at_sample(phase_factor, amplitudes, grown[n])
            highest = max(highest, value) if math.isfinite(value) else math.inf
            if bound[n] < highest:
                end = n + 1
                break
        best = 0.0 if math.isfinite(highest) else math.inf
        for n in range(end):
            if square[n] >= MIN_RECOMPUTED_SHARE * highest:
                best = max(best, _square_and_slopes(min(n * step, duration), phase, amplitudes, s)[0])
            # the peak of a wave sampled 16 times exceeds its highest sample by at most 4 %
            rises = n == 0 or square[n] >= square[n - 1]
            falls = n == end - 1 or square[n] >= square[n + 1]
            if rises and falls and 1.04 * square[n] > highest:
                right = min((n + 1) * step, duration)
                left = max(right - (2.0 if n < end - 1 else 1.0) * step, 0.0)
                best = max(best, _refine_maximum(left, right, phase, amplitudes, s))
        peaks[m] = math.sqrt(best)
    return peaks
