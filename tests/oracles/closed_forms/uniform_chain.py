"""
Natural modes of a uniform chain, fixed at its foot and free at its top: N masses m on N equal springs k.

On the isolator the first spring is the pendulum m_sum g / rho, so every link must have that stiffness.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def uniform_chain_frequencies(count: int, mass: float, stiffness: float) -> Array:
    """Return omega_j = 2 sqrt(k/m) sin(theta_j/2), theta_j = (2 j - 1) pi / (2 N + 1): (N,), rad/s, lowest first."""
    result: Array = 2.0 * np.sqrt(stiffness / mass) * np.sin(0.5 * _modal_angles(count))
    return result


def uniform_chain_shapes(count: int, mass: float) -> Array:
    """Return shapes X_j(i) = sin(i theta_j) scaled to unit modal mass, (N, N), kg^-1/2, shape[body, mode]."""
    scale = 2.0 / np.sqrt((2 * count + 1) * mass)
    result: Array = scale * np.sin(np.outer(np.arange(1, count + 1), _modal_angles(count)))
    return result


def _modal_angles(count: int) -> Array:
    """Return theta_j of the modes, (N,), rad."""
    result: Array = (2.0 * np.arange(1, count + 1) - 1.0) * np.pi / (2 * count + 1)
    return result
