"""
Natural frequencies and modes of small undamped vibration (4.8)-(4.11), each axis on its own.

Per axis the linearized (4.3)-(4.4) is M0 q'' + C0 q = 0: a chain of N masses whose first link is the pendulum stiffness
of the isolator. A general eigensolver gets the low frequencies of a long or stiff chain wrong by eps * condition, so
the chain is kept as its factor: C0 = D^T diag(k) D with D the elongation of each link, hence
M0^-1/2 C0 M0^-1/2 = L^T L with L = diag(k)^1/2 D M0^-1/2 bidiagonal, its entries free of subtraction. The frequencies
are the singular values of L, and the entries of a bidiagonal matrix determine every one of them to full relative
precision (Demmel and Kahan 1990). They are found by bisection on the Golub-Kahan matrix, which couples link, mass,
link, mass, ... along the chain: zero diagonal, the entries of L beside it. Without the first link, of a flat slider,
the chain is free: its first mode is the motion of all bodies as one, of frequency zero.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh_tridiagonal

from reference.problem import GRAVITY, Scene

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Modes:
    """
    Modes of a chain of N bodies, in order of rising frequency; axis 0 is x, 1 is y.

    Attributes
    ----------
    frequency : ndarray, (2, N), rad/s
        omega_ix and omega_iy of (4.8), each to about 1e-13 of itself. The first is 0 on a flat slider.
    shape : ndarray, (2, N, N), kg^-1/2
        shape[axis, body, mode], the vectors X_i, Y_j of (4.10)-(4.11), scaled to unit modal mass (shape^T M0 shape =
        identity) and signed so that the participation factor is not negative.
    participation : ndarray, (2, N), kg^1/2
        shape^T M0 1: modal force per unit ground acceleration, Gamma_i. Its square is the effective modal mass; these
        add up to m_sum.
    """

    frequency: Array
    shape: Array
    participation: Array

    @property
    def period(self) -> Array:
        """Natural periods T_ci = 2 pi / omega_i, (2, N), s, longest first; inf for the rigid motion on a plane."""
        with np.errstate(divide="ignore"):
            result: Array = 2.0 * np.pi / self.frequency
        return result

    @property
    def effective_mass(self) -> Array:
        """Effective modal masses for base excitation, (2, N), kg."""
        result: Array = self.participation**2
        return result


def linear_stiffness(scene: Scene) -> Array:
    """
    Stiffness below each body, (N, 2), N/m, columns x and y: m_sum g / rho of (4.3) under the platform, then the links.

    C0 of (4.8) has k_i + k_{i+1} on its diagonal and -k_{i+1} beside it; M0 is diag(m_i).
    """
    pendulum = scene.total_mass * GRAVITY / scene.radius
    return np.vstack([np.full((1, 2), pendulum), scene.stiffness])


def modes(scene: Scene) -> Modes:
    """
    Natural frequencies, shapes and participation factors of the frictionless linearized chain.

    Parameters
    ----------
    scene : Scene
        Its friction and its loading do not enter.

    Returns
    -------
    Modes

    Notes
    -----
    Equations (4.8)-(4.11), for each axis on its own.

    Examples
    --------
    >>> import reference
    >>> natural = reference.modes(reference.load_scene("fig3-I"))
    >>> natural.period.shape
    (2, 2)
    >>> round(float(natural.effective_mass[0].sum()), 12)  # kg, the mass of both bodies
    2.0
    """
    per_axis = [_axis(scene.masses, stiffness) for stiffness in linear_stiffness(scene).T]
    frequency, shape, participation = (np.stack(parts) for parts in zip(*per_axis))
    return Modes(frequency, shape, participation)


def _axis(masses: Array, stiffness: Array) -> tuple[Array, Array, Array]:
    """Frequencies (N,), shapes (N, N) and participation factors (N,) along one axis."""
    count = len(masses)
    beside = np.empty(2 * count - 1)
    beside[0::2] = np.sqrt(stiffness / masses)  # link and the mass above it
    beside[1::2] = -np.sqrt(stiffness[1:] / masses[:-1])  # link and the mass below it
    free = stiffness[0] == 0.0
    beside = beside[1:] if free else beside
    size = len(beside) + 1
    scale = np.abs(beside).max(initial=np.finfo(float).tiny)
    values, vectors = eigh_tridiagonal(
        np.zeros(size),
        beside / scale,
        select="i",
        select_range=(size - count, size - 1),  # the spectrum is +-omega
        lapack_driver="stebz",
        tol=2.0 * np.finfo(float).tiny,  # bisect to the last bit of each value, not of the largest
    )
    frequency = values * scale
    if free:
        frequency[0] = 0.0
    symmetric = vectors[0 if free else 1 :: 2]  # the rows of masses: M0^1/2 times the shape
    symmetric = symmetric / np.linalg.norm(symmetric, axis=0)
    participation = np.sqrt(masses) @ symmetric
    sign = np.where(participation < 0.0, -1.0, 1.0)
    return frequency, symmetric * sign / np.sqrt(masses)[:, None], participation * sign
