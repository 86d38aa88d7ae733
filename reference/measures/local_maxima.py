"""Local maxima of a surface on a grid of phases, from which the searches for its maximum begin."""

from __future__ import annotations

import numpy as np

from reference.problem.phases import phase_grid
from reference.problem.result import Array
from reference.problem.scene import Scene
from reference.problem.symmetry import indices_of_solved_pairs

GRID = 48  # values of either loading phase in the grid on which maxima of amplification or displacement are sought
MAX_STARTS = 12  # largest number of local maxima from which searches start: those that may lead to the highest values


def find_local_maxima(surface: Array, scene: Scene) -> Array:
    """
    Return the phase pairs (K, 2), rad, at which a surface is not lower than at any of 8 neighbors on a grid.

    surface: amplification or displacement (n, n) on `phase_grid(n)`; NaN without an answer. At most MAX_STARTS pairs
    are returned, and only one of those that a symmetry of the motion makes equal. Those next to which the surface may
    rise highest come first.

    >>> from reference.problem import load_scene
    >>> alpha = 2.0 * np.pi * np.arange(8) / 8
    >>> find_local_maxima(np.cos(2.0 * alpha)[:, None] + np.cos(2.0 * alpha)[None, :], load_scene("fig3-I")).tolist()
    [[0.0, 0.0]]
    """
    points = len(surface)
    height = np.where(np.isfinite(surface), surface, -np.inf)
    around = [np.roll(height, (i, j), (0, 1)) for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)]
    lowest = np.min([np.where(np.isfinite(each), each, height) for each in around], axis=0)
    places = np.flatnonzero(np.isfinite(height) & (height >= np.max(around, axis=0)))
    places = places[indices_of_solved_pairs(scene, points)[places] == places]
    high, low = height.ravel()[places], lowest.ravel()[places]
    # The maximum between the grid points may exceed the highest of them by about half the range in its neighborhood.
    may_reach = high + 0.5 * (high - low)
    return phase_grid(points)[places[np.argsort(-may_reach, kind="stable")][:MAX_STARTS]]
