"""
Natural frequencies and modes of small vibration (4.8)-(4.11), undamped and damped, each axis on its own.

Along each axis the linearized equations (4.3)-(4.4) are M0 q'' + C0 q = 0. This is a chain of N masses whose first link
is the pendulum stiffness of the isolator; `reference.problem.chain_modes` solves it. A flat slider has no first link.
The chain is then free: its first mode is the motion of all bodies as one, of frequency zero.

With dampers, M0 q'' + D0 q' + C0 q = 0 has complex modes q = X exp(lambda t), even if D0 is not proportional to C0.
Let the matrix D give the elongation of each link, and L = diag(k)^1/2 D M0^-1/2. The state is y = M0^1/2 q', one entry
for each mass, and s = L M0^1/2 q, one entry for each link. The modes are then the eigenvectors of
    [s' y']^T = [[0, L], [-L^T, -M0^-1/2 D0 M0^-1/2]] [s y]^T.
This adds damping to a skew matrix, so that no eigenvalue has a positive real part.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eig

from reference.problem import GRAVITY, Scene
from reference.problem.chain_modes import solve_chain_modes
from reference.problem.result import Array
from reference.problem.scene import require_scene


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


@dataclass(frozen=True)
class DampedModes:
    """
    Complex modes Re(X exp(lambda t)) of a damped chain of N bodies, in order of rising |lambda|; axis 0 is x, 1 is y.

    Attributes
    ----------
    eigenvalue : ndarray of complex, (2, 2 N), 1/s
        lambda. A vibration has a conjugate pair, first the one with a positive imaginary part. On a flat slider the
        first two are 0: all bodies go along as one, at any speed.
    shape : ndarray of complex, (2, N, 2 N)
        shape[axis, body, mode], X scaled so that its largest entry is 1.
    """

    eigenvalue: NDArray[np.complex128]
    shape: NDArray[np.complex128]

    @property
    def frequency(self) -> Array:
        """Size |lambda|, (2, 2 N), rad/s, which is the natural frequency if the dampers are weak."""
        result: Array = np.abs(self.eigenvalue)
        return result

    @property
    def damping_ratio(self) -> Array:
        """Damping ratio -Re lambda / |lambda|, (2, 2 N): 0 undamped or rigid, 1 for a motion without oscillation."""
        size = self.frequency
        result: Array = np.divide(-self.eigenvalue.real, size, where=size > 0.0, out=np.zeros_like(size))
        return result


def linear_stiffness(scene: Scene) -> Array:
    """
    Return the stiffness below each body along x and y, (N, 2), N/m.

    Below the platform it is that of the pendulum, m_sum g / rho (4.3), below every other body that of its link.
    """
    pendulum = scene.total_mass * GRAVITY / scene.radius
    return np.vstack([np.full((1, 2), pendulum), scene.stiffness])


@require_scene
def modes(scene: Scene) -> Modes:
    """
    Return natural frequencies, shapes and participation factors of the frictionless linearized chain.

    Parameters
    ----------
    scene : Scene
        Its friction and its loading have no effect.

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
    per_axis = [_solve_modes_along_axis(scene.masses, stiffness) for stiffness in linear_stiffness(scene).T]
    frequency, shape, participation = (np.stack(parts) for parts in zip(*per_axis))
    return Modes(frequency=frequency, shape=shape, participation=participation)


@require_scene
def damped_modes(scene: Scene) -> DampedModes:
    """
    Return complex modes of the frictionless linearized chain with the dampers of its links.

    Parameters
    ----------
    scene : Scene
        Its friction and its loading have no effect.

    Returns
    -------
    DampedModes

    Notes
    -----
    The isolator has no damper. A link with the ratio zeta has c = 2 zeta sqrt(k m_i) with the mass above it, so modes
    of the chain have other ratios.

    Examples
    --------
    >>> import reference
    >>> scene = reference.load_scene("fig3-I").with_values({"bodies.1.damping": 0.05})
    >>> reference.damped_modes(scene).damping_ratio[0].round(4).tolist()
    [0.0335, 0.0335, 0.0294, 0.0294]
    """
    dampers = np.vstack([np.zeros((1, 2)), scene.damping])
    per_axis = [_solve_damped_axis(scene.masses, k, c) for k, c in zip(linear_stiffness(scene).T, dampers.T)]
    eigenvalue, shape = (np.stack(parts) for parts in zip(*per_axis))
    return DampedModes(eigenvalue, shape)


def _solve_damped_axis(
    masses: Array, stiffness: Array, damping: Array
) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
    """Return eigenvalues (2 N,), 1/s, and complex mode shapes (N, 2 N) of the damped chain along one axis."""
    # The state has the elongations of the links times the root of their stiffness, and the velocities times the root of
    # the masses, as derived at the top of this file. A flat slider has no first link: its rigid motion has the
    # eigenvalue 0 twice, once as a displacement, which this state does not contain, and once as a velocity. Both modes
    # are left out of the solution and added exactly.
    count = len(masses)
    # (N, N): row i is the elongation of link i for each mass-normalized coordinate
    elongation = (np.eye(count) - np.eye(count, k=-1)) / np.sqrt(masses)
    held = stiffness > 0.0  # False for the missing first link of a flat slider
    factor = np.sqrt(stiffness[held])[:, None] * elongation[held]
    links = len(factor)
    state = np.zeros((links + count, links + count))
    state[:links, links:] = factor
    state[links:, :links] = -factor.T
    state[links:, links:] = -(elongation.T * damping) @ elongation
    values, vectors = eig(state)
    order = np.lexsort((-values.imag, np.abs(values)))
    rigid = 2 * count - len(order)  # 1 on a flat slider, where the state lacks the rigid displacement; otherwise 0
    values, vectors = values[order[rigid:]], vectors[links:, order[rigid:]]
    shape = vectors / np.sqrt(masses)[:, None] / values
    values = np.concatenate([np.zeros(2 * rigid), values])
    shape = np.hstack([np.ones((count, 2 * rigid)), shape])
    largest = np.abs(shape).argmax(axis=0)
    return values, shape / shape[largest, np.arange(2 * count)]


def _solve_modes_along_axis(masses: Array, stiffness: Array) -> tuple[Array, Array, Array]:
    """Return frequencies (N,), shapes (N, N) and participation factors (N,) along one axis."""
    frequency, shape = solve_chain_modes(masses, stiffness)
    participation = masses @ shape
    sign = np.where(participation < 0.0, -1.0, 1.0)
    return frequency, shape * sign, participation * sign
