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
    """Ratios of a bar's stiffness under an axial load P to its stiffness without load, with q = P l^2 / (4 E J)."""

    sway: float  # against a sideways displacement of one end
    sway_slope: float  # derivative of `sway` by q
    bending: float  # against equal and opposite rotations of the ends


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
    return StabilityFunctions(sway=(fraction - q) / 3.0, sway_slope=(slope - 1.0) / 3.0, bending=1.0 - q / fraction)


def buckling_load(bending_stiffness: float, length: float) -> float:
    """Return the axial load, N, pi^2 E J / l^2, at which a bar buckles whose clamped ends may move sideways."""
    return math.pi**2 * bending_stiffness / length / length
