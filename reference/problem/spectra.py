"""
Floor response spectra: what equipment on the bodies of a motion is exposed to.

An oscillator of one degree of freedom stands on a body and follows its absolute acceleration, which is linear between
the samples. Its motion from one sample to the next is the exact one (Nigam and Jennings, 1969), as a power series in
the angle that it goes through: unlike the closed form, that has no cancellation in short steps.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reference.problem.build_cache import cached_on_disk
from reference.problem.compiled_parts import compiled_part
from reference.problem.demands import ANSWERED
from reference.problem.ranges import Range, checked_array, checked_number
from reference.problem.result import Trajectory

Array = NDArray[np.float64]

PERIODS = np.geomspace(0.02, 5.0, 49)  # s, where no others are asked for
DAMPING = Range(0.0, 1.0, "of critical")
TERMS = 8  # of the power series of a step
MAX_ANGLE = 0.25  # rad, that the oscillator goes through in a step: the series then has an error of 1e-12
# The sampling error is so many times the largest change if only one of so many samples is taken. Measured on the
# built-in scenes against ten times as many samples: 0.6 of that at most.
SAMPLING_FACTOR, THINNING = 2.0, 3


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


def floor_spectra(trajectory: Trajectory, periods: ArrayLike | None = None, damping: float = 0.05) -> FloorSpectra:
    """
    Floor response spectra of every body of one motion, with errors.

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
        Of the oscillator's motion from rest until the end of the scene, without the free vibration that follows.

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
    damping = checked_number("damping", damping, DAMPING)
    rule = "must be positive numbers (P,), s"
    period = PERIODS if periods is None else checked_array("periods", periods, rule)
    if period.ndim != 1 or not len(period) or not (period > 0.0).all():
        raise ValueError(f"periods: {rule}")
    if trajectory.status not in ANSWERED or len(trajectory.time) < 2:
        nothing = np.full((trajectory.position.shape[1], 2, len(period)), np.nan)
        return FloorSpectra(period, damping, nothing, nothing.copy())

    def spectra(motion: Trajectory, first: int = 0, every: int = 1) -> Array:
        last = len(motion.time) - 1
        kept = np.unique([0, *range(first, last, every), last])
        floors = np.moveaxis(motion.absolute_acceleration[kept, :, :2], 0, -1).reshape(-1, len(kept))
        largest = _largest_displacements(motion.time[kept], np.ascontiguousarray(floors.T), period, damping)
        return (2.0 * math.pi / period) ** 2 * largest.reshape(-1, 2, len(period))

    value, accuracy = spectra(trajectory), trajectory.accuracy
    if accuracy is None:
        return FloorSpectra(period, damping, value, np.full_like(value, np.nan))
    changes = [np.abs(spectra(trajectory, first, THINNING) - value) for first in range(THINNING)]
    error = SAMPLING_FACTOR * np.max(changes, axis=0) + accuracy.floor * value
    for share, other in zip(accuracy.share, accuracy.coarser, strict=True):
        error += share * np.abs(spectra(other) - value)
    return FloorSpectra(period, damping, value, error)


@cached_on_disk(__file__, nogil=True)
def _largest_displacements(time: Array, floor: Array, period: Array, damping: float) -> Array:
    """Largest displacement (C, P), m, of oscillators on floors (T, C), m/s^2, relative to these."""
    count = floor.shape[1]
    largest = np.zeros((count, period.shape[0]))
    place, speed = np.zeros(count), np.zeros(count)  # speed over the natural frequency
    for p in range(period.shape[0]):
        frequency = 2.0 * math.pi / period[p]
        place[:], speed[:] = 0.0, 0.0
        before, steps = -1.0, 1
        a = b = c = d = from_start = from_change = speed_start = speed_change = 0.0
        for n in range(time.shape[0] - 1):
            angle = frequency * (time[n + 1] - time[n])
            if angle != before:
                before = angle
                steps = max(1, math.ceil(angle / MAX_ANGLE))
                a, b, c, d, from_start, from_change, speed_start, speed_change = _transition(angle / steps, damping)
            for k in range(steps):
                for i in range(count):
                    change = (floor[n + 1, i] - floor[n, i]) / (steps * frequency**2)
                    start = floor[n, i] / frequency**2 + k * change
                    x, v = place[i], speed[i]
                    x1 = a * x + b * v - from_start * start - from_change * change
                    v1 = c * x + d * v - speed_start * start - speed_change * change
                    top = abs(x1)
                    if v * v1 < 0.0:  # it turns: its speed is taken as linear
                        top = max(top, abs(x + 0.5 * v * v / (v - v1) * (angle / steps)))
                    largest[i, p] = max(largest[i, p], top)
                    place[i], speed[i] = x1, v1
    return largest


@compiled_part(nogil=True)
def _transition(angle: float, damping: float) -> tuple[float, float, float, float, float, float, float, float]:
    """
    One step of x'' + 2 damping x' + x = -(start + change s / angle), over the angle s: power series of what is added.

    x1 = a x + b v - from_start start - from_change change, and v1 likewise. The functions are sums of
    angle^k f_k / k!, with f_k the k-th derivative at the start; of the forcing, those of a unit ramp over the step.
    """
    a, b, c, d = 1.0, 0.0, 0.0, 1.0
    from_start = from_change = speed_start = speed_change = 0.0
    # derivatives (k, k + 1) at the start of the free motion from x = 1, from v = 1, under a constant, under a ramp
    x0, x1 = 1.0, 0.0
    v0, v1 = 0.0, 1.0
    s0, s1 = 0.0, 0.0
    r0, r1 = 0.0, 0.0
    power = 1.0
    for k in range(1, TERMS + 2):
        power *= angle / k
        constant = 1.0 if k == 1 else 0.0
        ramp = 1.0 / angle if k == 2 and angle > 0.0 else 0.0
        x0, x1 = x1, -2.0 * damping * x1 - x0
        v0, v1 = v1, -2.0 * damping * v1 - v0
        s0, s1 = s1, constant - 2.0 * damping * s1 - s0
        r0, r1 = r1, ramp - 2.0 * damping * r1 - r0
        a, c = a + power * x0, c + power * x1
        b, d = b + power * v0, d + power * v1
        from_start, speed_start = from_start + power * s0, speed_start + power * s1
        from_change, speed_change = from_change + power * r0, speed_change + power * r1
    return a, b, c, d, from_start, from_change, speed_start, speed_change
