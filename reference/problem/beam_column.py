"""
Stiffness of a bar that is clamped at both ends and carries a load along its axis.

E J w'''' + P w'' = 0 between clamped ends. With x = (l / 2) sqrt(P / (E J)) and q = x^2 the stiffness in sway is
P / (l (tan x / x - 1)), and that against equal and opposite rotations of the ends E J / l times x / tan x. Both vanish
at x = pi / 2. They are written with the continued fraction of the tangent, tan x / x = 1 / (1 - q / D) with
D = 3 - q / (5 - q / (7 - ...)), which loses no digits at small loads.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

FRACTION_TERMS = 20  # terms of the continued fraction of tan x / x: exact in double precision up to buckling


@dataclass(frozen=True)
class StabilityFunctions:
    """Stiffness of a bar under axial load P over that without load; sway_slope: d sway / dq, q = P l^2 / (4 E J)."""

    sway: float
    sway_slope: float
    bending: float


def stability_functions(axial_load_parameter: float) -> StabilityFunctions:
    """
    Return the stiffness factors of a clamped bar under an axial load P.

    axial_load_parameter: q = P l^2 / (4 E J), from 0 to buckling at (pi / 2)^2.

    >>> stability_functions(0.0)
    StabilityFunctions(sway=1.0, sway_slope=-0.4, bending=1.0)
    """
    q = axial_load_parameter
    fraction, slope = 2.0 * FRACTION_TERMS + 1.0, 0.0
    for odd in range(2 * FRACTION_TERMS - 1, 1, -2):
        fraction, slope = odd - q / fraction, -1.0 / fraction + q * slope / fraction**2
    return StabilityFunctions((fraction - q) / 3.0, (slope - 1.0) / 3.0, 1.0 - q / fraction)


def buckling_load(bending_stiffness: float, length: float) -> float:
    """Return the load, N, at which a bar buckles sideways whose clamped ends may sway, pi^2 E J / l^2."""
    return math.pi**2 * bending_stiffness / length / length
