"""Amplitude ratios of the bodies above the platform under harmonic loading, by (4.4) alone."""

from typing import Annotated

import numpy as np

from comparison.result_types import Array, Radius, result
from reference.problem import Scene, exponents

AXES = "x", "y"  # names of the horizontal axes


@result
class ForcedRatio:
    """Ratio of a body's amplitude to the platform's under one harmonic, by the linear equations of the links (4.4)."""

    body: Annotated[int, "from 2"]
    harmonic: Annotated[int, "1 or 2"]
    axis: Annotated[str, "x or y"]
    period: Annotated[float, "period of the harmonic, s"]
    ratio: Annotated[Radius, "with the decay of the loading"]
    steady: Annotated[Radius, 'without it; "inf" at resonance']


def compute_forced_ratios(scene: Scene) -> list[ForcedRatio]:
    """
    Return the ratio of each upper body's amplitude to the platform's under each harmonic along each axis.

    The list is empty for a platform alone and under a recorded ground motion, which has no harmonics.
    """
    if scene.recorded or len(scene.bodies) == 1:
        return []
    return [
        ForcedRatio(
            body=body,
            harmonic=harmonic,
            axis=name,
            period=float(2.0 * np.pi / s.imag),
            ratio=float(forced),
            steady=float(steady),
        )
        for axis, name in enumerate(AXES)
        for harmonic, s in enumerate(exponents(scene), start=1)  # s = -decay + i omega
        if scene.amplitudes[axis, harmonic - 1] != 0.0
        for body, (forced, steady) in enumerate(
            zip(*(_amplitude_ratios(scene, axis, each) for each in (s, 1j * s.imag))), start=2
        )
    ]


def _amplitude_ratios(scene: Scene, axis: int, s: complex) -> Array:
    """
    Return each upper body's amplitude over the platform's in a motion like exp(s t); infinite at resonance.

    The platform's motion drives the links: by (4.4), the inertia of each upper body balances the forces of the links
    below and above it, which gives a tridiagonal system of linear equations for the amplitudes.
    """
    links = scene.stiffness[:, axis] + s * scene.damping[:, axis]  # force per stretch of each link
    matrix = np.diag(scene.masses[1:] * s**2 + links + np.append(links[1:], 0.0))
    matrix -= np.diag(links[1:], 1) + np.diag(links[1:], -1)
    drive = np.zeros(len(links), complex)
    drive[0] = links[0]
    if np.linalg.matrix_rank(matrix) < len(matrix):
        return np.full(len(links), np.inf)
    sizes: Array = np.abs(np.linalg.solve(matrix, drive))
    return sizes
