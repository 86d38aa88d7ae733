"""
Response spectra of ground motions, and of the floors of a moving structure.

An oscillator of one degree of freedom stands on a body and follows its absolute acceleration, which is linear between
the samples. Its motion from one sample to the next is the exact one (Nigam and Jennings, Bull. Seism. Soc. Am. 59,
1969), as a power series in its angle: unlike the closed form, that has no cancellation in short steps.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reference.measures.demand_reader import FULL_LENGTH_OUTCOMES
from reference.problem.result import Array, Trajectory, require_motion
from reference.support.arguments import Range, check_array, check_number
from reference.support.build_cache import cache_on_disk

PERIODS = np.geomspace(0.02, 5.0, 49)  # s, periods of a spectrum by default
DAMPING_RANGE = Range(0.0, 1.0, "of critical")  # allowed damping ratio of the oscillator
SERIES_TERMS = 8  # terms of the power series, in the phase angle, of an oscillator's motion in one step
MAX_ANGLE = 0.25  # rad, largest phase angle of the oscillator in a step, for which its power series errs by 1e-12
# The sampling error is SAMPLING_FACTOR times the largest change when only every third sample is used. On the built-in
# scenes, against ten times as many samples, the errors were at most 0.6 of this estimate.
SAMPLING_FACTOR, DECIMATION = 2.0, 3


@dataclass(frozen=True)
class FloorSpectra:
    """
    Pseudo-acceleration spectra of N bodies in the directions x and y at P periods.

    Attributes
    ----------
    period : ndarray, (P,), s
        Natural periods of the oscillator.
    damping : float
        Its damping ratio.
    acceleration : ndarray, (N, 2, P), m/s^2
        Largest displacement of the oscillator relative to the body, times the square of its natural frequency. NaN
        where the motion ended early.
    error : ndarray, (N, 2, P), m/s^2
        Estimated absolute error; NaN where it is not known.
    """

    period: Array
    damping: float
    acceleration: Array
    error: Array


@require_motion
def floor_spectra(trajectory: Trajectory, periods: ArrayLike | None = None, damping: float = 0.05) -> FloorSpectra:
    """
    Return floor response spectra of every body of one motion, with errors.

    Parameters
    ----------
    trajectory : Trajectory
        From `reference.trajectory`, `multibody.trajectory` or `multibody.single_run`.
    periods : array_like, (P,), s, optional
        Natural periods. By default 49 from 0.02 to 5 s, evenly spaced in their logarithm.
    damping : float
        Damping ratio of the oscillator, from 0 to 1.

    Returns
    -------
    FloorSpectra
        Spectra of the oscillator's motion from rest to the end of the scene, without the free vibration that follows.

    Raises
    ------
    ValueError
        For an argument outside its range, in one line.

    Notes
    -----
    An error has two parts. That of sampling is twice the largest change if only every third sample is taken. That of
    the solution comes from the other runs in `Trajectory.accuracy`. Without these it is NaN. Accelerations jump where
    the platform stops. The instants that a trajectory has by default include both sides of a jump. With `times` of
    one's own the spectra may miss them by more than the error.

    Examples
    --------
    >>> import reference
    >>> motion = reference.trajectory(reference.load_scene("fig3-I"), (0.3, 1.1))
    >>> spectra = reference.floor_spectra(motion, periods=[0.05, 0.5])
    >>> spectra.acceleration.shape, bool((spectra.error < 1e-2 * spectra.acceleration).all())
    ((2, 2, 2), True)
    """
    damping = check_number("damping", damping, DAMPING_RANGE)
    period = PERIODS if periods is None else _check_periods(periods)
    if trajectory.status not in FULL_LENGTH_OUTCOMES or len(trajectory.time) < 2:
        nothing = np.full((trajectory.position.shape[1], 2, len(period)), np.nan)
        return FloorSpectra(period=period, damping=damping, acceleration=nothing, error=nothing.copy())

    series = _power_series(damping)

    def spectra(motion: Trajectory, first: int = 0, every: int = 1) -> Array:
        """Return floor spectra (N, 2, P) from the samples `first`, `first` + `every`, ... and both end samples."""
        last = len(motion.time) - 1
        kept = np.arange(last + 1) % every == first
        kept[[0, last]] = True
        floors = motion.absolute_acceleration[kept, :, :2]
        floors = np.ascontiguousarray(floors.reshape(len(floors), -1))
        largest: Array = _largest_accelerations(motion.time[kept], floors, period, damping, series)
        return largest.reshape(-1, 2, len(period))

    value, accuracy = spectra(trajectory), trajectory.accuracy
    if accuracy is None:
        return FloorSpectra(period=period, damping=damping, acceleration=value, error=np.full_like(value, np.nan))
    changes = [np.abs(spectra(trajectory, first, DECIMATION) - value) for first in range(DECIMATION)]
    error = SAMPLING_FACTOR * np.max(changes, axis=0) + accuracy.floor * value
    for share, other in zip(accuracy.share, accuracy.coarser, strict=True):
        error += share * np.abs(spectra(other) - value)
    return FloorSpectra(period=period, damping=damping, acceleration=value, error=error)


def factor_for_spectrum(
    time: ArrayLike,
    acceleration: ArrayLike,
    periods: ArrayLike,
    target: ArrayLike,
    damping: float = 0.05,
) -> float:
    """
    Return the factor of a ground motion that brings its response spectrum closest to a target spectrum.

    Parameters
    ----------
    time : array_like, (K,), s
        Rising instants of the samples.
    acceleration : array_like, (K,) or (K, 2), m/s^2
        Along x, or x and y. The spectrum of two directions is their geometric mean.
    periods : array_like, (P,), s
        Natural periods of the target spectrum.
    target : array_like, (P,), m/s^2
        Its pseudo-accelerations.
    damping : float
        Damping ratio of the spectra, from 0 to 1.

    Returns
    -------
    float

    Raises
    ------
    ValueError
        For arguments that do not fit together, in one line.

    Notes
    -----
    Least squares in the logarithm, with the same weight at every period: the mean over the periods of
    (ln(f S) - ln T)^2 is smallest at f = exp(mean(ln T - ln S)). Give periods that are evenly spaced in their
    logarithm.

    Examples
    --------
    >>> import numpy as np, reference
    >>> time = np.arange(0.0, 10.0, 0.01)
    >>> motion = np.sin(6.0 * time)
    >>> round(reference.factor_for_spectrum(time, motion, [0.01, 0.02], [0.5, 0.5]), 2)
    0.5
    """
    rule = "must be positive numbers (P,), as many periods as accelerations of the target"
    period, wanted = check_array("periods", periods, rule), check_array("target", target, rule)
    if period.ndim != 1 or period.shape != wanted.shape or not len(period) or not min(period.min(), wanted.min()) > 0.0:
        raise ValueError(f"periods {period.shape}, target {wanted.shape}: {rule}")
    return float(np.exp(np.mean(np.log(wanted) - np.log(response_spectrum(time, acceleration, period, damping)))))


def response_spectrum(
    time: ArrayLike, acceleration: ArrayLike, periods: ArrayLike, damping: float = 0.05
) -> NDArray[np.float64]:
    """
    Return the response spectrum of a ground motion.

    Parameters
    ----------
    time : array_like, (K,), s
        Rising instants of the samples.
    acceleration : array_like, (K,) or (K, 2), m/s^2
        Along x, or x and y. The spectrum of two directions is their geometric mean.
    periods : array_like, (P,), s
        Natural periods.
    damping : float
        Damping ratio, from 0 to 1.

    Returns
    -------
    ndarray, (P,), m/s^2
        Pseudo-accelerations.

    Raises
    ------
    ValueError
        For arguments that do not fit together, in one line.

    Examples
    --------
    >>> import numpy as np, reference
    >>> time = np.arange(0.0, 10.0, 0.01)
    >>> reference.response_spectrum(time, 2.0 * np.sin(6.0 * time), [0.01]).round(2)
    array([2.])
    """
    damping = check_number("damping", damping, DAMPING_RANGE)
    period = _check_periods(periods)
    rule = "must be rising instants (K,), s, and as many accelerations (K,) or (K, 2), m/s^2"
    instants, ground = check_array("time", time, rule), check_array("acceleration", acceleration, rule)
    ground = ground[:, None] if ground.ndim == 1 else ground
    shaped = instants.ndim == 1 and ground.ndim == 2 and len(ground) == len(instants) > 1 and ground.shape[1] in (1, 2)
    if not (shaped and (np.diff(instants) > 0.0).all()):
        raise ValueError(f"time {instants.shape}, acceleration {ground.shape}: {rule}")
    if not ground.any(axis=0).all():
        raise ValueError("acceleration: at rest along a direction: leave it out")
    ground = np.ascontiguousarray(ground)
    spectra = _largest_accelerations(instants, ground, period, damping, _power_series(damping))
    mean: NDArray[np.float64] = np.exp(np.log(spectra).mean(axis=0))
    return mean


def _check_periods(periods: ArrayLike) -> Array:
    """Return the periods of oscillators as an array (P,), s. Raises ValueError unless all are positive."""
    rule = "must be positive numbers (P,), s"
    period = check_array("periods", periods, rule)
    if period.ndim != 1 or not len(period) or not (period > 0.0).all():
        raise ValueError(f"periods: {rule}")
    return period


@cache_on_disk(__file__, nogil=True)
def _largest_accelerations(time: Array, floor: Array, period: Array, damping: float, series: Array) -> Array:
    """
    Return the largest pseudo-acceleration (C, P), m/s^2, of oscillators on floors with acceleration (T, C), m/s^2.

    The equation is y'' + 2 damping y' + y = -floor. y is the displacement times the square of the natural frequency,
    and derivatives are by the phase angle omega t. time: (T,), s. period: (P,), s. series: as `_power_series` returns.
    """
    # The first loop over the intervals computes the matrices of their steps, which depend on the lengths alone, so that
    # no interval waits for the motion in the one before. The second loop follows the motion. An interval between two
    # samples is cut into equal steps of MAX_ANGLE at most.
    # At the end of a step, b is the motion from rest under a unit impulse, s under a constant 1, and r under a ramp up
    # to 1. The speeds under these are d, b and f.
    count, total = floor.shape[1], time.shape[0] - 1
    largest = np.zeros((count, period.shape[0]))
    place, speed = np.zeros(count), np.zeros(count)
    steps_of, motion = np.empty(total), np.empty((total, 6))
    for p in range(period.shape[0]):
        frequency = 2.0 * math.pi / period[p]
        for n in range(total):
            angle = frequency * (time[n + 1] - time[n])
            steps_of[n] = steps = max(1.0, np.ceil(angle / MAX_ANGLE))
            angle /= steps
            b = f = r = 0.0
            for k in range(SERIES_TERMS - 1, -1, -1):
                b, f, r = b * angle + series[k, 0], f * angle + series[k, 1], r * angle + series[k, 2]
            b, f, r = b * angle, f * angle, r * angle**2
            s = f * angle
            motion[n, 0], motion[n, 1], motion[n, 2] = b, f, r
            motion[n, 3], motion[n, 4], motion[n, 5] = s, 1.0 - s - 2.0 * damping * b, angle
        place[:], speed[:] = 0.0, 0.0
        for n in range(total):
            b, f, r, s, d, angle = motion[n]
            fraction = 1.0 / steps_of[n]
            for k in range(int(steps_of[n])):
                for i in range(count):
                    change = fraction * (floor[n + 1, i] - floor[n, i])
                    y, v = place[i], speed[i]
                    pulled = y + floor[n, i] + k * change
                    y1 = y - s * pulled + b * v - r * change
                    v1 = d * v - b * pulled - f * change
                    top = abs(y1)
                    if v * v1 < 0.0:  # where the oscillator reverses, its speed is taken as linear
                        top = max(top, abs(y + 0.5 * v * v / (v - v1) * angle))
                    if top > largest[i, p]:
                        largest[i, p] = top
                    place[i], speed[i] = y1, v1
    return largest


def _power_series(damping: float) -> Array:
    """
    Return coefficients (SERIES_TERMS, 3), lowest first, of the motion of an oscillator from rest in powers of omega t.

    The columns are the motion under a unit impulse, divided by the angle omega t; under a constant 1, divided by the
    square of the angle; and under a ramp up to 1, divided by the square of the angle. All motions in a step are sums of
    these. Under the constant, the derivatives at the start are f_0 = f_1 = 0, f_2 = 1 and then
    f_k = -2 damping f_(k-1) - f_(k-2). The motion under the impulse is the derivative of that under the constant; the
    one under the ramp is the integral of that under the constant, divided by the angle.
    """
    derivatives = [0.0, 1.0]
    for _ in range(SERIES_TERMS - 1):
        derivatives.append(-2.0 * damping * derivatives[-1] - derivatives[-2])
    power = np.arange(1.0, SERIES_TERMS + 1.0)
    impulse = np.array(derivatives[1:]) / np.cumprod(power)
    constant = impulse / (power + 1.0)
    return np.column_stack([impulse, constant, constant / (power + 2.0)])
