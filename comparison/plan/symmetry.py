"""
Surfaces from half or a quarter of their points, where a symmetry of the motion is exact.

Started at rest without vertical loading, the motion for (alpha1 + pi, alpha2 + pi) is the one for (alpha1, alpha2)
turned by half a turn: same mu. Where each harmonic acts along an axis of its own, alpha1 + pi alone mirrors the motion.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from reference.problem import Amplification, Scene, phase_grid

Array = NDArray[np.float64]


def halved(scene: Scene) -> bool:
    """Whether adding pi to both phases leaves every mu alone."""
    return not scene.amplitudes[2].any()


def quartered(scene: Scene) -> bool:
    """Whether adding pi to either phase alone does."""
    used = scene.amplitudes[:2] != 0.0
    return halved(scene) and bool((used.sum(axis=0) <= 1).all() and (used.sum(axis=1) <= 1).all())


def symmetry(scene: Scene) -> str:
    """What the scene allows, in words."""
    if quartered(scene):
        return "each harmonic has its own axis and none is vertical: adding pi to either phase mirrors the motion"
    if halved(scene):
        return "no vertical loading: adding pi to both phases turns the motion by half a turn"
    return "vertical loading: every phase pair is its own"


def sources(scene: Scene, grid: int) -> NDArray[np.intp]:
    """
    For every pair of phases 2 pi k / grid, alpha2 running fastest, the pair that is solved for it: (grid^2,).

    An odd grid has no points that are mirror images of each other: every point is its own source.
    """
    alpha1, alpha2 = np.divmod(np.arange(grid**2), grid)
    half = grid // 2
    if grid % 2 == 0 and quartered(scene):
        alpha1, alpha2 = alpha1 % half, alpha2 % half
    elif grid % 2 == 0 and halved(scene):
        alpha1, alpha2 = alpha1 % half, np.where(alpha1 < half, alpha2, (alpha2 + half) % grid)
    return grid * alpha1 + alpha2


def surface(scene: Scene, grid: int, solve: Callable[[Scene, Array], Amplification]) -> tuple[Array, Array, list[str]]:
    """
    mu and error, (grid, grid, N), and every status met, on phases 2 pi k / grid; `solve` is asked for as few as needed.

    """
    solved, taken = np.unique(sources(scene, grid), return_inverse=True)
    answer = solve(scene, phase_grid(grid)[solved])
    mu, error = (values[taken].reshape(grid, grid, -1) for values in (answer.mu, answer.error))
    return mu, error, sorted(set(map(str, answer.status)))
