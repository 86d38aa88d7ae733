"""One body on the frictionless isolator at rest on the ground: a spherical pendulum of length rho."""

from __future__ import annotations

import math

from scipy.special import ellipk

from reference.problem import GRAVITY


def conical_frequency(radius: float, circle: float) -> float:
    """Return the frequency, rad/s, on a horizontal circle of radius `circle`, m: omega^2 = g / (rho cos theta)."""
    cosine = math.sqrt(1.0 - (circle / radius) ** 2)
    return math.sqrt(GRAVITY / (radius * cosine))


def planar_period(radius: float, swing: float) -> float:
    """Return the period, s, of planar swings from the distance `swing`, m: 4 sqrt(rho/g) K(sin^2(theta0 / 2))."""
    half = 0.5 * math.asin(swing / radius)
    return float(4.0 * math.sqrt(radius / GRAVITY) * ellipk(math.sin(half) ** 2))
