"""Modes of the uniform chain against a dense eigensolver."""

import numpy as np
import pytest
from scipy.linalg import eigh

from reference.analytical import uniform_chain_frequencies, uniform_chain_shapes


@pytest.mark.parametrize("count", [1, 2, 7, 40])
def test_frequencies_and_shapes_are_the_eigenpairs(count):
    mass, stiffness = 3.0, 700.0
    k = stiffness * (2.0 * np.eye(count) - np.eye(count, k=1) - np.eye(count, k=-1))
    k[-1, -1] = stiffness
    values, _ = eigh(k, mass * np.eye(count))
    omega, shape = uniform_chain_frequencies(count, mass, stiffness), uniform_chain_shapes(count, mass)
    np.testing.assert_allclose(omega**2, values, rtol=1e-11)
    np.testing.assert_allclose(mass * shape.T @ shape, np.eye(count), atol=1e-13)
    np.testing.assert_allclose(k @ shape, mass * shape * omega**2, atol=1e-12 * stiffness)
