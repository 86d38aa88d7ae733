"""Natural modes (4.8)-(4.11) against closed form, exact rational arithmetic and the identities they must satisfy."""

from fractions import Fraction

import numpy as np
import pytest
from chains import chain
from scipy.linalg import eigh

import reference
from reference.analytical import uniform_chain_frequencies, uniform_chain_shapes
from reference.natural_modes import linear_stiffness
from reference.problem import GRAVITY, Scene


def uniform_chain(count: int, mass: float = 3.0, radius: float = 0.25) -> Scene:
    """Every link as stiff as the pendulum m_sum g / rho: the fixed-free uniform chain."""
    pendulum = count * mass * GRAVITY / radius
    return chain(radius, 0.1, [mass] * count, [[pendulum, pendulum]] * (count - 1))


@pytest.mark.parametrize("count", [1, 2, 3, 17, 200])
def test_uniform_chain_has_its_closed_form(count, within):
    """omega_j = 2 sqrt(k/m) sin theta_j / 2, X_j(i) ~ sin(i theta_j), theta_j = (2j - 1) pi / (2N + 1)."""
    scene = uniform_chain(count)
    modes = reference.modes(scene)
    stiffness = scene.total_mass * GRAVITY / scene.radius
    exact = uniform_chain_frequencies(count, scene.masses[0], stiffness)
    shape = uniform_chain_shapes(count, scene.masses[0])
    # participation of these shapes is sum_i sin(i theta) > 0 by the cotangent of theta/2
    for axis in range(2):
        within(abs(modes.frequency[axis] / exact - 1.0).max(), 1e-12)
        # vectors are as good as eps over the relative gap of neighbors, which is ~ 1/N
        np.testing.assert_allclose(modes.shape[axis], shape, atol=1e-14 * count * np.abs(shape).max())


def test_every_frequency_of_a_stiff_chain_is_right():
    """Links from 1e-2 s to 10 s: the slowest frequency keeps 13 digits although it is 1e-4 of the fastest."""
    masses = [5.0, 1.0, 2.0, 0.1, 3.0, 1.0, 1.0, 4.0]
    periods = [1e-2, 10.0, 1e-2, 3.0, 0.5, 1e-2, 10.0]
    stiffness = [[m * (2.0 * np.pi / t) ** 2] * 2 for m, t in zip(masses[1:], periods)]
    scene = chain(2.0, 0.1, masses, stiffness)
    frequency = reference.modes(scene).frequency[0]
    k = linear_stiffness(scene)[:, 0]
    for number, omega in enumerate(frequency.tolist()):
        assert eigenvalues_below(scene.masses, k, Fraction(omega) ** 2 * (1 - Fraction(2, 10**13))) == number
        assert eigenvalues_below(scene.masses, k, Fraction(omega) ** 2 * (1 + Fraction(2, 10**13))) == number + 1


def eigenvalues_below(masses: np.ndarray, stiffness: np.ndarray, bound: Fraction) -> int:
    """How many omega^2 lie below the bound: negative pivots of C0 - bound M0 in exact rational arithmetic."""
    k = [Fraction(value) for value in stiffness.tolist()] + [Fraction(0)]
    count, pivot = 0, Fraction(1)
    for i, mass in enumerate(masses.tolist()):
        off = k[i] ** 2 / pivot if i else Fraction(0)
        pivot = k[i] + k[i + 1] - bound * Fraction(mass) - off
        count += pivot < 0
    return count


def test_modes_diagonalize_mass_and_stiffness():
    """Unequal links along x and y, against SciPy; participation and effective masses from M0 and the shapes."""
    masses, links = np.array([2.0, 0.5, 3.0]), np.array([[80.0, 20.0], [30.0, 500.0]])
    scene = chain(0.4, 0.1, masses.tolist(), links.tolist())
    modes = reference.modes(scene)
    for axis in range(2):
        below, above = np.append(5.5 * GRAVITY / 0.4, links[:, axis]), np.append(links[:, axis], 0.0)
        stiffness = np.diag(below + above) - np.diag(below[1:], 1) - np.diag(below[1:], -1)
        squares, shapes = eigh(stiffness, np.diag(masses))
        shapes *= np.sign(masses @ shapes)
        np.testing.assert_allclose(modes.frequency[axis], np.sqrt(squares), rtol=1e-12)
        np.testing.assert_allclose(modes.shape[axis], shapes, atol=1e-12)
        np.testing.assert_allclose(modes.participation[axis], masses @ shapes, atol=1e-12)
        np.testing.assert_allclose(modes.effective_mass[axis], (masses @ shapes) ** 2, atol=1e-12)
