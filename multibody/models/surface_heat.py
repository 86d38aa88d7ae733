"""
Temperature of the contacts at the end of each step, before the step is made, for friction that heat lowers.

The kernel 1 / sqrt(s) of the temperature is a sum of decays exp(-x^2 s), its integral over ln x by the trapezoidal
rule. So the state of a contact is its share of each decay, and a step adds a power that is linear in time.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from reference.problem.friction import Heat

Array = NDArray[np.float64]

# Temperature is a sum of decays exp(-x^2 t). Spacing of ln x in it: relative error exp(-pi^2 / (2 LOG_SPACING)) = 7e-8.
LOG_SPACING = 0.3

# Smallest x in a temperature's sum of decays exp(-x^2 t), times sqrt(duration): slower decays hardly add to it.
MIN_DECAY_RATE_ROOT = 1e-5

# Share of the duration: heat that was released less than this time before has no effect on the temperature yet.
KERNEL_CUTOFF_TIME = 1e-6


class _HeatState(NamedTuple):
    """
    Heat in the contact surfaces at one instant, kept per decay rate: a weighted sum of it is the temperature rise.

    time: instant, in units of time. shares: heat in each of the decays, W s, (K, X). power: power of friction, W, (K,),
    whether the platform covers the contact or not. distance: of the platform from the center, in units of length.
    """

    time: float
    shares: Array
    power: Array
    distance: float


class SurfaceHeat:
    """Temperature of `count` contacts in a run; unit_time, s, and unit_length, m: units of the model."""

    def __init__(self, heat: Heat, count: int, duration: float, unit_time: float, unit_length: float) -> None:
        """Set up the exponential decays whose sum is the temperature; duration: length of the motion, s."""
        self._initial, self._rise, self._cover = heat.initial, count * heat.rise, heat.cover / unit_length
        self._unit_time, self._count = unit_time, count
        # the fastest decay, at x = exp(high), has died out by exp(-9) after a thousandth of the cutoff time
        low, high = math.log(MIN_DECAY_RATE_ROOT), math.log(3.0 / math.sqrt(KERNEL_CUTOFF_TIME * 1e-3))
        x = np.exp(np.arange(low, high, LOG_SPACING)) / math.sqrt(duration)
        self._rates, self._weights = x * x, 2.0 / math.sqrt(math.pi) * LOG_SPACING * x
        self._kept: list[_HeatState] = []

    def begin(self, time: float) -> bool:
        """Delete heat states after `time`, where a run begins; return whether the friction power at `time` is known."""
        if time == 0.0:
            nothing = np.zeros((self._count, len(self._rates)))
            self._kept = [_HeatState(0.0, nothing, nothing[:, 0], 0.0)]
            return False
        near = time * (1.0 + 1e-12)
        while self._kept[-1].time > near:
            self._kept.pop()
        known = self._kept[-1].time >= time * (1.0 - 1e-12)
        self._kept = self._kept[-1:]
        return known

    def step_to(self, time: float, power: Array, distance: float) -> None:
        """
        Store the heat after a step to `time`.

        power, distance: friction power of the contacts, (K,), W, and distance of the platform from the center, both at
        the end of the step.
        """
        self._kept.append(self._advance(time, power, distance))

    def temperature(self, time: float, power: Array, distance: float) -> Array:
        """Return the temperature (K,), degrees C, after a step up to `time`, where the friction power is (K,), W."""
        shares = self._advance(time, power, distance).shares if time > self._kept[-1].time else self._kept[-1].shares
        celsius: Array = self._initial + self._rise * (shares @ self._weights)
        return celsius

    def distance(self, time: float) -> float:
        """Return the platform's distance from the center at `time`, extrapolated linearly from the last two states."""
        *before, last = self._kept[-2:]
        if not before or last.time <= before[0].time:
            return last.distance
        return last.distance + (time - last.time) * (last.distance - before[0].distance) / (last.time - before[0].time)

    def _advance(self, time: float, power: Array, distance: float) -> _HeatState:
        """Return the heat state after a step to `time` with friction power and distance from center linear in time."""
        # With a power that is linear over the step, the heat that each decay keeps of it is known in closed form: of a
        # power equal to one the share `whole`, of a power that rises from zero to one the share `rising`, for which a
        # series takes over at small z. Only the part of the step in which the platform covers the contact adds heat.
        last = self._kept[-1]
        span = (time - last.time) * self._unit_time
        nearest, way = min(last.distance, distance), abs(distance - last.distance)
        covered = min(max((self._cover - nearest) / way, 0.0), 1.0) if way > 0.0 else float(nearest < self._cover)
        z = self._rates * span
        whole = -np.expm1(-z) / np.maximum(z, 1e-300)
        rising = np.where(z < 1e-4, 0.5 - z / 6.0, (1.0 - whole) / np.maximum(z, 1e-300))
        added = np.outer(last.power, whole - rising) + np.outer(power, rising)
        return _HeatState(time, last.shares * np.exp(-z) + covered * span * added, power, distance)
