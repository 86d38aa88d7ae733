"""
Radau IIA collocation with seven stages (order 13, L-stable), for second-order systems.

On one step of length h the acceleration is a polynomial through the stages c_i, and velocity and position are its
integrals:  v_i = v_0 + h (A a)_i,  x_i = x_0 + c_i h v_0 + h^2 (A^2 a)_i.  The last stage is the end of the step.
A = T diag(lambda) T^-1 turns a linear chain into one scalar problem per eigenvalue; of each conjugate pair one is kept.
Source: Hairer and Wanner, Solving Ordinary Differential Equations II, sections IV.5 and IV.8.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import legendre

STAGES = 7
CHANNELS = (STAGES + 1) // 2  # one real eigenvalue and one of each conjugate pair


def _shifted_legendre(order: int) -> legendre.Legendre:
    return legendre.Legendre.basis(order, domain=[0.0, 1.0])


def _nodes(stages: int) -> np.ndarray:
    """Right Radau points on (0, 1]: the roots of P_s - P_{s-1}."""
    roots = np.sort((_shifted_legendre(stages) - _shifted_legendre(stages - 1)).roots().real)
    roots[-1] = 1.0
    return roots


def _weights(theta: np.ndarray, integrated: bool) -> np.ndarray:
    """Weights of the interpolating polynomial at theta, or of its integral from 0 to theta: (len(theta), STAGES)."""
    basis = [_shifted_legendre(k) for k in range(STAGES)]
    values = np.stack([p(NODES) for p in basis], axis=1)
    raised = np.stack([(p.integ(lbnd=0.0) if integrated else p)(theta) for p in basis], axis=1)
    weights: np.ndarray = np.linalg.solve(values.T, raised.T).T
    return weights


NODES = _nodes(STAGES)
A = _weights(NODES, True)
A2 = A @ A
# values of the interpolating polynomial at theta = 0: the defect there against the true acceleration is the error
AT_START = _weights(np.zeros(1), False)[0]
# coefficients of theta^k of the interpolating polynomial
MONOMIALS = np.linalg.inv(np.vander(NODES, increasing=True))


def _channels() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    values, vectors = np.linalg.eig(A)
    inverse = np.linalg.inv(vectors)
    kept = np.flatnonzero(values.imag > -1e-12)
    kept = kept[np.argsort(values[kept].imag)]
    doubled = np.where(np.abs(values[kept].imag) > 1e-12, 2.0, 1.0)  # the conjugate's share
    return values[kept], inverse[kept], vectors[:, kept] * doubled


EIGENVALUES, TO_CHANNELS, FROM_CHANNELS = (np.ascontiguousarray(part) for part in _channels())

# where peaks and events are looked for inside a step
DENSE = np.linspace(0.0, 1.0, 15)
DENSE_VALUES = _weights(DENSE, False)
DENSE_FIRST = _weights(DENSE, True)
DENSE_SECOND = DENSE_FIRST @ A  # position as the integral of the velocity through the stages
