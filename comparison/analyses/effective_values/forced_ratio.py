"""
How intensively the bodies above the platform vibrate, without any fit or integration.

By (4.4) the bodies above are a chain driven by the absolute motion of the platform alone, whatever (4.3) says about
friction. The forced part of their motion under exp(s t), s = -lambda + i nu, is therefore a fixed multiple of that of
the platform. For one body above, without dampers, A_2 / A_1 = 1 / (1 + (s T_3 / 2 pi)^2); without decay of the loading
that is 1 / (1 - (T_3 / T)^2).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from comparison.result_types import Radius, result
from reference.problem import Scene, exponents

Array = NDArray[np.float64]
AXES = "x", "y"


@result
class ForcedRatio:
    """Amplitude of a body over that of the platform under one harmonic, by (4.4) alone."""

    body: int
    """from 2"""
    harmonic: int
    """1 or 2"""
    axis: str
    """x or y"""
    period: float
    """period of the harmonic, s"""
    ratio: Radius
    """with the decay of the loading"""
    steady: Radius
    """without it; "inf" at resonance"""


def forced_ratios(scene: Scene) -> list[ForcedRatio]:
    """
    The ratios of a scene by axis, harmonic and body: none of a platform alone or under a recorded motion.

    >>> from reference import load_scene
    >>> [(each.axis, each.harmonic, round(each.ratio, 2)) for each in forced_ratios(load_scene("fig3-I"))]
    [('x', 1, 0.56), ('y', 2, 4.56)]
    """
    if scene.recorded or len(scene.bodies) == 1:
        return []
    ratios = []
    for axis, name in enumerate(AXES):
        for harmonic, exponent in enumerate(exponents(scene)):
            if scene.amplitudes[axis, harmonic] == 0.0:
                continue
            period = float(2.0 * np.pi / exponent.imag)
            forced, steady = (_ratios(scene, axis, s) for s in (exponent, 1j * exponent.imag))
            ratios += [
                ForcedRatio(number + 2, harmonic + 1, name, period, float(forced[number]), float(size))
                for number, size in enumerate(steady)
            ]
    return ratios


def _ratios(scene: Scene, axis: int, s: complex) -> Array:
    """|A_i / A_1| for the bodies above the platform: (m_i s^2 + links) A = link to the platform times A_1."""
    links = scene.stiffness[:, axis] + s * scene.damping[:, axis]
    matrix = np.diag(scene.masses[1:] * s**2 + links + np.append(links[1:], 0.0))
    matrix -= np.diag(links[1:], 1) + np.diag(links[1:], -1)
    drive = np.zeros(len(links), complex)
    drive[0] = links[0]
    if np.linalg.matrix_rank(matrix) < len(matrix):
        return np.full(len(links), np.inf)
    sizes: Array = np.abs(np.linalg.solve(matrix, drive))
    return sizes
