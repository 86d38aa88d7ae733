"""Natural modes (4.8)-(4.11) against closed form and SciPy."""

import numpy as np
import pytest
from chains import chain
from closed_forms.uniform_chain import uniform_chain_frequencies, uniform_chain_shapes
from scipy.linalg import eigh

import reference
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
