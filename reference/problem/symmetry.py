"""
Surfaces from half or a quarter of their points, or one line of them, where a symmetry of the motion is exact.

Which symmetries a scene has is decided by `reductions`; here they become places on a grid of phases.
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
    """Return the shifts of both phases, in units of pi, that keep every amplification, (K, 2), first no shift."""
    turns = np.array([[0, 0], [1, 1], [0, 1], [1, 0]], dtype=np.intp)
    return turns if has_one_axis_per_harmonic(scene) else turns[: 2 if has_half_turn_symmetry(scene) else 1]


def indices_of_solved_pairs(scene: Scene, grid: int) -> NDArray[np.intp]:
    """Return for every phase pair of a grid, (grid^2,), the index of the pair of equal amplification solved for it."""
    steps = np.stack(np.divmod(np.arange(grid**2), grid), axis=-1)
    shifts = find_half_turns(scene)[: 1 if grid % 2 else None] * (grid // 2)
    images = (steps[:, None] + shifts) % grid
    images[..., find_unused_harmonics(scene)] = 0
    first: NDArray[np.intp] = (grid * images[..., 0] + images[..., 1]).min(axis=1)
    return first


def distinct_pairs(scene: Scene, grid: int) -> tuple[Array, NDArray[np.intp]]:
    """Return the fewest phase pairs (P, 2), rad, that by symmetry stand for a grid, and each point's index in them."""
    solved, taken = np.unique(indices_of_solved_pairs(scene, grid), return_inverse=True)
    return phase_grid(grid)[solved], taken.reshape(grid, grid)


def complete_surface(
    scene: Scene, grid: int, solve: Callable[[Scene, Array], Amplification]
) -> tuple[Array, Array, list[str]]:
    """Return amplification and error (grid, grid, N) on a grid of phases from fewest phase pairs, and all statuses."""
    phases, taken = distinct_pairs(scene, grid)
    answer = solve(scene, phases)
    return answer.mu[taken], answer.error[taken], sorted(set(map(str, answer.status)))
