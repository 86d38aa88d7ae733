"""
One body sliding down and through the cap in a vertical plane under dry friction, the ground at rest (exact equations).

theta is the angle from the lowest point, v = rho theta', N = m (g cos theta + v^2/rho). While theta falls, w = theta'^2
obeys w' = 2 mu w + (2 g / rho)(mu cos theta - sin theta), linear in theta:
    w = A exp(2 mu theta) + 2 g / (rho (1 + 4 mu^2)) ((1 - 2 mu^2) cos theta + 3 mu sin theta).
"""

from __future__ import annotations

from math import cos, exp, sin, sqrt

import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy.optimize import brentq

from reference.problem import GRAVITY


def squared_rate(angle: float, start: float, start_rate: float, friction: float, radius: float) -> float:
    """Return theta'^2, 1/s^2, at `angle`, rad, of the slide that passes `start`, rad, at `start_rate` <= 0, rad/s."""
    constant = (start_rate**2 - _particular_solution(start, friction, radius)) * exp(-2.0 * friction * start)
    return constant * exp(2.0 * friction * angle) + _particular_solution(angle, friction, radius)


def turning_angle(start: float, friction: float, radius: float) -> float:
    """Return the angle, rad, of the next stop of a slide released at rest at `start` > atan(mu), rad."""
    released = 1e-3 * (start - np.arctan(friction))
    lowest = -start - 1e-6  # friction shortens every swing
    return float(
        brentq(
            lambda a: squared_rate(a, start, 0.0, friction, radius), lowest, start - released, xtol=1e-15, rtol=1e-14
        )
    )


def turning_time(start: float, friction: float, radius: float) -> float:
    """Return the time, s, from release at `start`, rad, to the next stop: the integral of d theta / |theta'|."""
    end = turning_angle(start, friction, radius)
    # The substitution theta = middle + half cos(psi) removes the inverse square roots at both ends.
    nodes, weights = leggauss(60)
    psi = 0.5 * np.pi * (nodes + 1.0)
    middle, half = 0.5 * (start + end), 0.5 * (start - end)
    rates = [sqrt(squared_rate(middle + half * cos(p), start, 0.0, friction, radius)) for p in psi.tolist()]
    return float(0.5 * np.pi * np.sum(weights * half * np.sin(psi) / np.array(rates)))


def _particular_solution(angle: float, friction: float, radius: float) -> float:
    scale = 2.0 * GRAVITY / (radius * (1.0 + 4.0 * friction**2))
    return scale * ((1.0 - 2.0 * friction**2) * cos(angle) + 3.0 * friction * sin(angle))
