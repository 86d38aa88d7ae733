"""
A bar clamped at both ends that carries a load along its axis: what the load leaves of its stiffness.

E J w'''' + P w'' = 0 between clamped ends. With x = (l / 2) sqrt(P / (E J)) and q = x^2 the stiffness in sway is
P / (l (tan x / x - 1)), and that against equal and opposite rotations of the ends E J / l times x / tan x. Both vanish
at x = pi / 2. They are written with the continued fraction of the tangent, tan x / x = 1 / (1 - q / D) with
D = 3 - q / (5 - q / (7 - ...)), which loses no digits at small loads.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

DEPTH = 20  # terms of the continued fraction: exact in double precision up to buckling


@dataclass(frozen=True)
class LoadFactors:
    """Stiffness under load over that without, by q = P l^2 / (4 E J); sway_slope: the derivative of `sway`."""

    sway: float
    sway_slope: float
    bending: float


def load_factors(q: float) -> LoadFactors:
    """
    Return the factors of a bar under load, q = P l^2 / (4 E J) from 0 to (pi / 2)^2, at which it buckles sideways.

    >>> load_factors(0.0)
    LoadFactors(sway=1.0, sway_slope=-0.4, bending=1.0)
    """
    fraction, slope = 2.0 * DEPTH + 1.0, 0.0
    for odd in range(2 * DEPTH - 1, 1, -2):
        fraction, slope = odd - q / fraction, -1.0 / fraction + q * slope / fraction**2
    return LoadFactors((fraction - q) / 3.0, (slope - 1.0) / 3.0, 1.0 - q / fraction)


def buckling_load(bending_stiffness: float, length: float) -> float:
    """Return the load, N, at which a bar between clamped ends that may sway buckles, pi^2 E J / l^2."""
    return math.pi**2 * bending_stiffness / length / length
