"""
Undamped vibration modes of a chain of masses along one axis.

A general eigensolver gets the low frequencies of a long or stiff chain wrong by eps * condition, so the chain is kept
as its factor: C0 = D^T diag(k) D with D the elongation of each link, hence M0^-1/2 C0 M0^-1/2 = L^T L with
L = diag(k)^1/2 D M0^-1/2 bidiagonal, its entries free of subtraction. The frequencies are the singular values of L, and
the entries of a bidiagonal matrix determine every one of them to full relative precision (Demmel and Kahan, SIAM J.
Sci. Stat. Comput. 11, 1990). They are found by bisection on the Golub-Kahan matrix, which couples link, mass, link,
mass, ... along the chain: zero diagonal, the entries of L next to it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def solve_chain_modes(masses: Array, stiffness: Array, count: int | None = None) -> tuple[Array, Array]:
    """
    Return the lowest natural frequencies, (M,), rad/s, and mode shapes, (N, M), kg^-1/2, with modal mass 1.

    masses: (N,), kg. stiffness: (N,), N/m, of the link below each mass; 0 for the first of a free chain, whose first
    frequency is 0. count: M, all N without.

    >>> solve_chain_modes(np.array([2.0]), np.array([8.0]))[0].tolist()
    [2.0]
    """
    from scipy.linalg import eigh_tridiagonal  # SciPy is loaded on first use

    bodies = len(masses)
    modes = bodies if count is None else min(count, bodies)
    couplings = np.empty(2 * bodies - 1)
    couplings[0::2] = np.sqrt(stiffness / masses)  # entries that couple a link to the mass above it
    couplings[1::2] = -np.sqrt(stiffness[1:] / masses[:-1])  # entries that couple a link to the mass below it
    free = stiffness[0] == 0.0
    couplings = couplings[1:] if free else couplings
    size = len(couplings) + 1
    scale = np.abs(couplings).max(initial=np.finfo(float).tiny)
    values, vectors = eigh_tridiagonal(
        np.zeros(size),
        couplings / scale,
        select="i",
        select_range=(size - bodies, size - bodies + modes - 1),  # positive half of the eigenvalues +-omega
        lapack_driver="stebz",
        tol=2.0 * np.finfo(float).tiny,  # bisection locates even the smallest value to its last bit
    )
    frequency = values * scale
    if free:
        frequency[0] = 0.0
    symmetric = vectors[0 if free else 1 :: 2]  # rows of the masses: square root of the mass times mode shape
    shape: Array = symmetric / np.linalg.norm(symmetric, axis=0) / np.sqrt(masses)[:, None]
    return frequency, shape
