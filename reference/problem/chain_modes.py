"""
Undamped vibration modes of a chain of masses along one axis.

A general eigensolver of the stiffness matrix C0 and the mass matrix M0 gets the low frequencies of a long or stiff
chain wrong by eps times the condition number. The stiffness is therefore kept as a product, C0 = D^T diag(k) D, where D
gives the elongation of each link. Hence M0^-1/2 C0 M0^-1/2 = L^T L with the bidiagonal matrix L = diag(k)^1/2 D
M0^-1/2, whose entries are computed without subtraction. The frequencies are the singular values of L, and the entries
of a bidiagonal matrix determine every one of them to full relative precision (Demmel and Kahan, SIAM J. Sci. Stat.
Comput. 11, 1990). They are found by bisection as eigenvalues of the Golub-Kahan matrix. Its rows are link, mass, link,
mass, ... along the chain; its diagonal is zero, and next to the diagonal stand the entries of L.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def solve_chain_modes(masses: Array, stiffness: Array, count: int | None = None) -> tuple[Array, Array]:
    """
    Return the lowest natural frequencies, (M,), rad/s, and mode shapes, (N, M), kg^-1/2, with modal mass 1.

    masses: (N,), kg. stiffness: (N,), N/m, of the link below each mass; the first is 0 for a chain that is free, whose
    first frequency is 0. count: M; all N if it is None.

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
