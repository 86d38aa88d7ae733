"""Positions of the supports of the platform, and their loads at rest."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

MIN_WIDTH_RATIO = 1e-6  # supports count as on one line if their extent across it is below this fraction of that along


def ring_positions(count: int, radius: float) -> Array:
    """Return the positions (count, 2), m, of supports on a ring, at angles 2 pi (k + 1/2) / count."""
    angles = 2.0 * np.pi * (np.arange(count) + 0.5) / count
    return radius * np.column_stack([np.cos(angles), np.sin(angles)])


def static_shares(places: Array, center: Array) -> Array:
    """
    Return the fraction of a weight that each of K equally stiff supports carries, (K,); negative if one would pull.

    Under a rigid platform the forces are linear in the position, N_k = c0 + c1 x_k + c2 y_k, and balance the weight.
    places: (K, 2), m, not on one line. center: (2,), m, where the weight acts.

    >>> square = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])
    >>> static_shares(square, np.array([1.0, 0.0])).round(12).tolist()
    [0.5, 0.0, 0.0, 0.5]
    """
    middle = places.mean(axis=0)
    arms = places - middle
    shares: Array = 1.0 / len(places) + arms @ np.linalg.solve(arms.T @ arms, center - middle)
    return shares


def are_on_one_line(places: Array) -> bool:
    """Return True if positions (K, 2) span no area in double precision."""
    extents = np.linalg.svd(places - places.mean(axis=0), compute_uv=False)
    return bool(extents[1] <= MIN_WIDTH_RATIO * extents[0])
