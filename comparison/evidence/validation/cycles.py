"""The cycles of a shaken frame: a measured run folded by the motion of its base, and what is read off a cycle."""

import math
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares

from comparison.evidence.validation.files import Shaken, wrong_file
from comparison.result_types import Array

SAMPLES = 250  # samples of a cycle, as measured
FEWEST = 3  # whole cycles of a run
HARMONICS = 6  # fitted to the base motion
UNEXPLAINED = 0.1  # rms share of the base motion that they may leave; 0.003 in the published runs
DRIFT = 0.1  # share of its range by which the middle of the plate may move between cycles
SPEED = 2.0  # mm/s: slower is at rest
WIDTH = 4  # samples to either side of a velocity


class Cycles(NamedTuple):
    """A measured run, folded: motions (J, SAMPLES), mm, from the largest position of the base on."""

    run: Shaken
    motions: Array
    frequency: float  # Hz
    amplitude: float  # mm, of the fundamental of the base
    second: complex  # mm, second harmonic of the base

    @property
    def mean(self) -> Array:
        """The mean cycle about its mean, mm."""
        mean = self.motions.mean(axis=0)
        about: Array = mean - mean.mean()
        return about


def fold_run(run: Shaken) -> Cycles:
    """The whole cycles of a run, by the fundamental of the base motion."""
    time = run.time - run.time[0]
    spectrum = np.abs(np.fft.rfft(run.base - run.base.mean()))
    first = float(np.argmax(spectrum)) / (time[-1] + time[1])

    def fit_harmonics(frequency: float) -> tuple[Array, Array]:
        turns = 2.0 * np.pi * frequency * np.outer(time, np.arange(HARMONICS + 1))
        terms = np.hstack([np.cos(turns), np.sin(turns[:, 1:])])
        factors: Array = np.linalg.lstsq(terms, run.base, rcond=None)[0]
        return factors, run.base - terms @ factors

    scaled = least_squares(
        lambda factor: fit_harmonics(first * factor[0])[1], [1.0], x_scale=1e-3, xtol=1e-12, ftol=1e-12
    )
    frequency = first * float(scaled.x[0])
    factors, rest = fit_harmonics(frequency)
    left = float(rest.std() / run.base.std())
    if not left <= UNEXPLAINED:
        rule = f"y must be periodic: {HARMONICS} harmonics leave {100.0 * left:.0f} % of it, which may be "
        raise wrong_file(f"s_b_{1e3 * run.weight:g}g_y.mat", f"{rule}{100.0 * UNEXPLAINED:.0f} % at most")
    harmonics = factors[1 : HARMONICS + 1] - 1j * factors[HARMONICS + 1 :]
    begin = np.angle(harmonics[0])
    phase = frequency * time + begin / (2.0 * np.pi)
    whole = range(math.ceil(phase[0]), math.floor(phase[-1]))
    if len(whole) < FEWEST:
        rule = f"y must have {FEWEST} whole cycles of the base, not {len(whole)}"
        raise wrong_file(f"s_b_{1e3 * run.weight:g}g_y.mat", rule)
    grid = np.arange(SAMPLES) / SAMPLES
    motions = np.array([np.interp(number + grid, phase, run.plate) for number in whole])
    plate = f"s_b_{1e3 * run.weight:g}g_x.mat"
    for number, motion in enumerate(motions, start=1):
        if math.isnan(read_cycle(motion, frequency)[2]):
            rule = (
                f"x must be faster than {SPEED:g} mm/s to either side in every cycle, or in none: not in cycle {number}"
            )
            raise wrong_file(plate, rule)
    drift = float(np.abs(np.diff(motions.mean(axis=1))).max() / (np.ptp(motions, axis=1).min() or np.inf))
    if drift > DRIFT:
        rule = f"x must repeat itself: its middle moves by {100.0 * drift:.0f} % of its range from a cycle to the next"
        raise wrong_file(plate, f"{rule}, which may be {100.0 * DRIFT:.0f} % at most")
    return Cycles(run, motions, frequency, abs(harmonics[0]), complex(harmonics[1] * np.exp(-2j * begin)))


def read_cycle(motion: Array, frequency: float) -> Array:
    """
    The quantities of one cycle (SAMPLES,), mm: NAMES.

    The plate starts and stops where its speed passes SPEED, before and behind each of its two largest speeds; the
    phases are from the turn of the base on, means of both directions.
    """
    speed = (np.roll(motion, -WIDTH) - np.roll(motion, WIDTH)) * frequency * SAMPLES / (2 * WIDTH)
    if np.abs(speed).max() < SPEED:  # at rest throughout: nothing starts or stops
        return np.array([0.5 * np.ptp(motion), motion.std(), 100.0, math.nan, math.nan])
    ends = []
    for sign in (-1.0, 1.0):
        top = int(np.argmax(sign * speed))
        turned = np.roll(sign * speed, -top)
        ends.append([top - _first_below(turned[np.arange(0, -SAMPLES, -1)]), top + _first_below(turned)])
    starts, stops = (np.array(ends).T - [0.0, 0.5 * SAMPLES]) * 360.0 / SAMPLES
    moving = (stops - starts).sum() / 360.0
    middles = [np.angle(np.exp(1j * np.radians(phases)).sum(), deg=True) % 360.0 for phases in (starts, stops)]
    return np.array([0.5 * np.ptp(motion), motion.std(), 100.0 * (1.0 - moving), *middles])


def _first_below(speed: Array) -> float:
    """Place at which a speed that begins above SPEED passes it."""
    below = np.flatnonzero(speed < SPEED)
    if not len(below) or below[0] == 0:
        return math.nan
    k = int(below[0])
    return float(k - (SPEED - speed[k]) / (speed[k - 1] - speed[k]))
