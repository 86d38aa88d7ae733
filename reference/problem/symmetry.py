"""
Surfaces from half or a quarter of their points, or one line of them, where a symmetry of the motion is exact.

Which symmetries a scene has is decided by `reductions`; here they become places on a grid of phases.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from reference.problem.phases import phase_grid
from reference.problem.reductions import half_turn, own_axes, unused_harmonics
from reference.problem.result import Amplification
from reference.problem.scene import Scene

Array = NDArray[np.float64]


def shifts(scene: Scene) -> Array:
    """
    By what phase pairs may be shifted without any change of mu.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    ndarray, (K, 2), rad
        The first is no shift. A harmonic without amplitude permits any shift of its phase besides.
    """
    if own_axes(scene):
        return np.pi * np.array([[0.0, 0.0], [1.0, 1.0], [0.0, 1.0], [1.0, 0.0]])
    return np.pi * np.array([[0.0, 0.0], [1.0, 1.0]][: 2 if half_turn(scene) else 1])


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
