"""Cycles of a shaken frame: a measured run folded by the motion of its base, and the quantities of a cycle."""

import math
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares

from comparison.evidence.validation.files import FrameRun, make_file_error
from comparison.result_types import Array

CYCLE_SAMPLES = 250  # number of samples in each cycle of a folded run; the measurements have as many
MIN_CYCLES = 3  # A measured run with fewer whole cycles is refused.
BASE_HARMONICS = 6  # number of harmonics of the base frequency that are fitted to the measured base motion
# A run is refused if the rms of what the fitted harmonics leave of the base motion is more than this share of its rms.
MAX_UNEXPLAINED_SHARE = 0.1  # The published runs have 0.003.
MAX_DRIFT_SHARE = 0.1  # Runs whose plate's mean shifts between cycles by a larger share of its range are refused.
REST_SPEED = 2.0  # mm/s, speed below which the plate counts as at rest
VELOCITY_HALF_WIDTH = 4  # A velocity is computed from the positions this many samples before and after.


class Cycles(NamedTuple):
    """Measured run of the frame cut into cycles, each of which starts at the largest position of the base."""

    run: FrameRun
    motions: Array  # mm, positions of the plate, (cycles, CYCLE_SAMPLES)
    frequency: float  # Hz, frequency of the base
    amplitude: float  # mm, amplitude of the base's fundamental
    second: complex  # mm, complex amplitude of the base's second harmonic, relative to the fundamental's phase

    @property
    def mean(self) -> Array:
        """Return the plate's motion in the mean cycle, mm, about its mean position, (samples,)."""
        mean = self.motions.mean(axis=0)
        about: Array = mean - mean.mean()
        return about


def fold_run(run: FrameRun) -> Cycles:
    """
    Return a measured run cut into whole cycles of the base motion's fundamental frequency.

    Raises SceneError if the base is not periodic, or if the plate does not repeat its motion.
    """
    # The peak of the spectrum is a first guess of the frequency. The guess is refined so that harmonics of the base
    # leave as little as possible of its motion. The phase of the fundamental then tells where each cycle begins.
    time = run.time - run.time[0]
    spectrum = np.abs(np.fft.rfft(run.base - run.base.mean()))
    first = float(np.argmax(spectrum)) / (time[-1] + time[1])

    def fit_harmonics(frequency: float) -> tuple[Array, Array]:
        """Return Fourier coefficients fitted to the base motion for a fundamental frequency, Hz, and the residual."""
        angles = 2.0 * np.pi * frequency * np.outer(time, np.arange(BASE_HARMONICS + 1))
        terms = np.hstack([np.cos(angles), np.sin(angles[:, 1:])])
        factors: Array = np.linalg.lstsq(terms, run.base, rcond=None)[0]
        return factors, run.base - terms @ factors

    scaled = least_squares(
        lambda factor: fit_harmonics(first * factor[0])[1], [1.0], x_scale=1e-3, xtol=1e-12, ftol=1e-12
    )
    frequency = first * float(scaled.x[0])
    factors, rest = fit_harmonics(frequency)
    left = float(rest.std() / run.base.std())
    if not left <= MAX_UNEXPLAINED_SHARE:
        rule = f"y must be periodic: {BASE_HARMONICS} harmonics leave {100.0 * left:.0f} % of it, which may be "
        raise make_file_error(
            f"s_b_{1e3 * run.weight:g}g_y.mat", f"{rule}{100.0 * MAX_UNEXPLAINED_SHARE:.0f} % at most"
        )
    harmonics = factors[1 : BASE_HARMONICS + 1] - 1j * factors[BASE_HARMONICS + 1 :]
    begin = np.angle(harmonics[0])
    phase = frequency * time + begin / (2.0 * np.pi)  # number of cycles since the base was at its largest position
    whole = range(math.ceil(phase[0]), math.floor(phase[-1]))
    if len(whole) < MIN_CYCLES:
        rule = f"y must have {MIN_CYCLES} whole cycles of the base, not {len(whole)}"
        raise make_file_error(f"s_b_{1e3 * run.weight:g}g_y.mat", rule)
    grid = np.arange(CYCLE_SAMPLES) / CYCLE_SAMPLES
    motions = np.array([np.interp(number + grid, phase, run.plate) for number in whole])
    plate = f"s_b_{1e3 * run.weight:g}g_x.mat"
    for number, motion in enumerate(motions, start=1):
        if math.isnan(measure_cycle(motion, frequency)[2]):
            rule = f"x must be faster than {REST_SPEED:g} mm/s to either side in every cycle, or in none: "
            raise make_file_error(plate, f"{rule}not in cycle {number}")
    drift = float(np.abs(np.diff(motions.mean(axis=1))).max() / (np.ptp(motions, axis=1).min() or np.inf))
    if drift > MAX_DRIFT_SHARE:
        rule = f"x must repeat itself: its middle moves by {100.0 * drift:.0f} % of its range from a cycle to the next"
        raise make_file_error(plate, f"{rule}, which may be {100.0 * MAX_DRIFT_SHARE:.0f} % at most")
    return Cycles(run, motions, frequency, abs(harmonics[0]), complex(harmonics[1] * np.exp(-2j * begin)))


def measure_cycle(motion: Array, frequency: float) -> Array:
    """
    Return the quantities of one cycle of the plate's motion (samples,), mm, in the order and units of `frame.NAMES`.

    The plate starts and stops where its speed passes REST_SPEED, before and after its largest speed in each direction.
    Phases count from the largest position of the base; each is the mean over both directions, half a cycle apart.
    """
    speed = (
        (np.roll(motion, -VELOCITY_HALF_WIDTH) - np.roll(motion, VELOCITY_HALF_WIDTH))
        * frequency
        * CYCLE_SAMPLES
        / (2 * VELOCITY_HALF_WIDTH)
    )
    if np.abs(speed).max() < REST_SPEED:  # The plate rests throughout, so that it neither starts nor stops.
        return np.array([0.5 * np.ptp(motion), motion.std(), 100.0, math.nan, math.nan])
    ends = []
    for sign in (-1.0, 1.0):
        top = int(np.argmax(sign * speed))
        onward = np.roll(sign * speed, -top)  # speed from its largest value on
        backward = onward[np.arange(0, -CYCLE_SAMPLES, -1)]
        ends.append([top - _find_end_of_motion(backward), top + _find_end_of_motion(onward)])
    starts, stops = (np.array(ends).T - [0.0, 0.5 * CYCLE_SAMPLES]) * 360.0 / CYCLE_SAMPLES
    moving = (stops - starts).sum() / 360.0
    middles = [np.angle(np.exp(1j * np.radians(phases)).sum(), deg=True) % 360.0 for phases in (starts, stops)]
    return np.array([0.5 * np.ptp(motion), motion.std(), 100.0 * (1.0 - moving), *middles])


def _find_end_of_motion(speed: Array) -> float:
    """Return the index, interpolated between samples, at which a speed falls to REST_SPEED; NaN if it does not."""
    below = np.flatnonzero(speed < REST_SPEED)
    if not len(below) or below[0] == 0:
        return math.nan
    k = int(below[0])
    return float(k - (REST_SPEED - speed[k]) / (speed[k - 1] - speed[k]))
