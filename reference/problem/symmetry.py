"""
Amplifications on a grid of phases from half or a quarter of its points, or one line of them, by an exact symmetry.

Which symmetries a scene has is decided by `reductions`. Here they become indices of grid points with equal results.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from reference.problem.phases import phase_grid
from reference.problem.reductions import find_unused_harmonics, has_half_turn_symmetry, has_one_axis_per_harmonic
from reference.problem.result import Amplification
from reference.problem.scene import Scene

Array = NDArray[np.float64]


def find_half_turns(scene: Scene) -> NDArray[np.intp]:
    """
    Return the shifts of (alpha_1, alpha_2) that keep every amplification, (K, 2), in units of pi.

    The first row is no shift, so that K is 1, 2 or 4.
    """
    shifts = np.array([[0, 0], [1, 1], [0, 1], [1, 0]], dtype=np.intp)
    return shifts if has_one_axis_per_harmonic(scene) else shifts[: 2 if has_half_turn_symmetry(scene) else 1]


def indices_of_solved_pairs(scene: Scene, grid: int) -> NDArray[np.intp]:
    """
    Return for each of the grid^2 phase pairs the index of the pair that is solved in its place, (grid^2,).

    Both have the same amplification; of all such pairs the one with the lowest index is solved.
    """
    steps = np.stack(np.divmod(np.arange(grid**2), grid), axis=-1)
    shifts = find_half_turns(scene)[: 1 if grid % 2 else None] * (grid // 2)
    images = (steps[:, None] + shifts) % grid
    images[..., find_unused_harmonics(scene)] = 0
    first: NDArray[np.intp] = (grid * images[..., 0] + images[..., 1]).min(axis=1)
    return first


def distinct_pairs(scene: Scene, grid: int) -> tuple[Array, NDArray[np.intp]]:
    """
    Return the fewest phase pairs (P, 2), rad, from which symmetry gives a whole grid.

    The second array, (grid, grid), holds for each point of the grid the index of the pair that stands for it.
    """
    solved, taken = np.unique(indices_of_solved_pairs(scene, grid), return_inverse=True)
    return phase_grid(grid)[solved], taken.reshape(grid, grid)


def complete_surface(
    scene: Scene, grid: int, solve: Callable[[Scene, Array], Amplification]
) -> tuple[Array, Array, list[str]]:
    """
    Return amplification and error, each (grid, grid, N), on a grid of phases, and the list of all statuses that arose.

    Only the fewest phase pairs (P, 2) are passed to `solve`; symmetry gives the rest.
    """
    phases, taken = distinct_pairs(scene, grid)
    answer = solve(scene, phases)
    return answer.mu[taken], answer.error[taken], sorted(set(map(str, answer.status)))
