"""
Surfaces from half or a quarter of their points, or one line of them, where a symmetry of the motion is exact.

Which symmetries a scene has is decided by reference.problem.reductions; here they become places on a grid of phases.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from reference.problem import Amplification, Scene, half_turn, own_axes, phase_grid, unused_harmonics

Array = NDArray[np.float64]


def sources(scene: Scene, grid: int) -> NDArray[np.intp]:
    """
    For every pair of phases on a grid the pair that is solved for it.

    An odd grid has no points that are mirror images of each other.

    Parameters
    ----------
    scene : Scene
    grid : int
        Phases 2 pi k / grid per axis.

    Returns
    -------
    ndarray, (grid^2,)
        Places, alpha2 running fastest.
    """
    place: list[NDArray[np.intp]] = list(np.divmod(np.arange(grid**2), grid))
    half, unused = grid // 2, unused_harmonics(scene)
    if grid % 2 == 0 and (own_axes(scene) or (unused and half_turn(scene))):
        place = [alpha % half for alpha in place]
    elif grid % 2 == 0 and half_turn(scene):
        place = [place[0] % half, np.where(place[0] < half, place[1], (place[1] + half) % grid)]
    for harmonic in unused:
        place[harmonic] = np.zeros_like(place[harmonic])
    return grid * place[0] + place[1]


def surface(scene: Scene, grid: int, solve: Callable[[Scene, Array], Amplification]) -> tuple[Array, Array, list[str]]:
    """
    The surface of a scene from the fewest phase pairs.

    Parameters
    ----------
    scene : Scene
    grid : int
        Phases 2 pi k / grid per axis.
    solve : callable
        Amplification of the scene at phases (M, 2), rad.

    Returns
    -------
    mu, error : ndarray, (grid, grid, N)
    status : list of str
        Every status met.
    """
    solved, taken = np.unique(sources(scene, grid), return_inverse=True)
    answer = solve(scene, phase_grid(grid)[solved])
    mu, error = (values[taken].reshape(grid, grid, -1) for values in (answer.mu, answer.error))
    return mu, error, sorted(set(map(str, answer.status)))
