"""
Surfaces from half or a quarter of their points, where a symmetry of the motion is exact.

Started at rest without vertical loading, the motion for (alpha1 + pi, alpha2 + pi) is the one for (alpha1, alpha2)
turned by half a turn: same mu. Where each harmonic acts along an axis of its own, alpha1 + pi alone mirrors the motion.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from reference.problem import Amplification, Scene

Array = NDArray[np.float64]


def halved(scene: Scene) -> bool:
    """Whether adding pi to both phases leaves every mu alone."""
    return not scene.amplitudes[2].any()


def quartered(scene: Scene) -> bool:
    """Whether adding pi to either phase alone does."""
    used = scene.amplitudes[:2] != 0.0
    return halved(scene) and bool((used.sum(axis=0) <= 1).all() and (used.sum(axis=1) <= 1).all())


def surface(scene: Scene, grid: int, solve: Callable[[Scene, Array], Amplification]) -> tuple[Array, Array, list[str]]:
    """
    mu and error, (grid, grid, N), and every status met, on phases 2 pi k / grid; `solve` is asked for as few as needed.

    An odd grid has no points that are mirror images of each other and is solved in full.
    """
    half = grid // 2
    even = grid % 2 == 0
    rows = half if even and halved(scene) else grid
    columns = half if even and quartered(scene) else grid
    alpha1, alpha2 = np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij")
    answer = solve(scene, np.asarray(2.0 * np.pi / grid * np.stack([alpha1.ravel(), alpha2.ravel()], axis=-1), float))

    def whole(values: Array) -> Array:
        part = values.reshape(rows, columns, -1)
        if columns < grid:
            return np.tile(part, (2, 2, 1))
        return part if rows == grid else np.concatenate([part, np.roll(part, half, axis=1)])

    return whole(answer.mu), whole(answer.error), sorted(set(map(str, answer.status)))
