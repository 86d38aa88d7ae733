"""
Steady forced oscillation with dry friction and without stops (Den Hartog, Phil. Mag. 9, 1930).

x'' + omega_n^2 x = omega_n^2 (a cos(omega t + phi) - x_f sign(x')). Between a turning point x0 at t = 0 and the next,
-x0, half a loading period later, friction is constant and the motion is
    x = x_f (1 - cos omega_n t - tan(theta/2) sin omega_n t) + a V cos(omega t + phi)
with b = omega/omega_n, theta = pi/b, V = 1/(1 - b^2), U = tan(theta/2)/b, and phi from a V cos(phi) = x0,
a V sin(phi) = -x_f U. For one body on the isolator, ground acceleration amplitude A: omega_n^2 = g/rho, x_f = mu rho,
a = A/omega_n^2.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import minimize_scalar

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SteadyOscillation:
    """Steady motion in units of a: ratio b = omega/omega_n, dead zone x_f/a, amplitude x0/a, phase phi, rad."""

    ratio: float
    dead_zone: float
    amplitude: float
    phase: float

    def position(self, angle: ArrayLike) -> Array:
        """Return x/a at the loading angle omega t (T,), rad, from a positive turning point on."""
        turn, sign = _fold_angle(angle)
        tangent = np.tan(0.5 * np.pi / self.ratio)
        natural = 1.0 - np.cos(turn / self.ratio) - tangent * np.sin(turn / self.ratio)
        forced = np.cos(turn + self.phase) / (1.0 - self.ratio**2)
        result: Array = sign * (self.dead_zone * natural + forced)
        return result

    def acceleration(self, angle: ArrayLike) -> Array:
        """Return x''/(a omega_n^2) at the loading angle omega t (T,), rad; at turning points the limit from above."""
        turn, sign = _fold_angle(angle)
        tangent = np.tan(0.5 * np.pi / self.ratio)
        natural = np.cos(turn / self.ratio) + tangent * np.sin(turn / self.ratio)
        forced = -(self.ratio**2) * np.cos(turn + self.phase) / (1.0 - self.ratio**2)
        result: Array = sign * (self.dead_zone * natural + forced)
        return result


def den_hartog(ratio: float, dead_zone: float) -> SteadyOscillation:
    """Return the steady motion for b = `ratio` (not 1) and x_f/a = `dead_zone`; ValueError where it would stop."""
    if dead_zone > no_stop_bound(ratio):
        raise ValueError(f"x_f/a = {dead_zone}: the motion stops, the bound is {no_stop_bound(ratio)}")
    v = 1.0 / (1.0 - ratio**2)
    u = np.tan(0.5 * np.pi / ratio) / ratio
    amplitude = float(np.sqrt(v * v - (dead_zone * u) ** 2))
    phase = float(np.arctan2(-dead_zone * u / v, amplitude / v))
    return SteadyOscillation(ratio, dead_zone, amplitude, phase)


def no_stop_bound(ratio: float) -> float:
    """
    Return the largest x_f/a for which the motion does not stop, |V| / sqrt(U^2 + S^2).

    S is the largest value over a half period of [sin omega_n t + b U (cos omega t - cos omega_n t)] / (b sin omega t).
    """
    v = 1.0 / (1.0 - ratio**2)
    u = np.tan(0.5 * np.pi / ratio) / ratio

    def stop_ratio_at(turn: ArrayLike) -> Array:
        turn = np.asarray(turn, dtype=float)
        natural = turn / ratio
        top = np.sin(natural) + ratio * u * (np.cos(turn) - np.cos(natural))
        result: Array = top / (ratio * np.sin(turn))
        return result

    # The limits at both ends are 1/b^2 up to a sign, finite but of the form 0/0: keep a small distance.
    turns = np.linspace(1e-4, np.pi - 1e-4, 2001)
    values = stop_ratio_at(turns)
    k = int(values.argmax())
    low, high = turns[max(k - 1, 0)], turns[min(k + 1, len(turns) - 1)]
    minimum = minimize_scalar(
        lambda t: -float(stop_ratio_at(t)), bounds=(low, high), method="bounded", options={"xatol": 1e-12}
    )
    largest = max(float(values[k]), -float(minimum.fun))
    return float(abs(v) / np.sqrt(u * u + largest * largest))


def _fold_angle(angle: ArrayLike) -> tuple[Array, Array]:
    """Return the angle within the current half period, and the sign of that half period."""
    angle = np.asarray(angle, dtype=float)
    half = np.floor(angle / np.pi)
    return angle - half * np.pi, 1.0 - 2.0 * np.mod(half, 2.0)
