"""
Radau IIA collocation with seven stages (order 13, L-stable), for second-order systems.

On one step of length h the acceleration is a polynomial through the stages c_i, and velocity and position are its
integrals:  v_i = v_0 + h (A a)_i,  x_i = x_0 + c_i h v_0 + h^2 (A^2 a)_i.  The last stage is the end of the step.
A = T diag(lambda) T^-1 turns a linear chain into one scalar problem per eigenvalue; of each conjugate pair one is kept.
Source: Hairer and Wanner, Solving Ordinary Differential Equations II, sections IV.5 and IV.8.

LAPACK rounds differently on every kind of processor, and mu would follow in its eighth digit. So it only gives first
guesses here, rounded to a few digits. The constants are refined from these with sums in a fixed order
(docs/decisions/0003-floating-point-flags.md).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.polynomial import legendre

STAGES = 7  # collocation points of one time step
ROW_LENGTH = STAGES + 1  # numbers in a row (rows.py): one for each stage, and an unused one
CHANNELS = (STAGES + 1) // 2  # number of channels: one for A's real eigenvalue, and one for each conjugate pair
GUESSED_DIGITS = 3  # number of decimals of LAPACK's results that serve as first guesses
EIGENVALUE_ITERATIONS = 12  # iterations that refine a guessed eigenvalue or node to rounding


def _solve_linear(matrix: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Return X of matrix X = right, by elimination with row pivoting."""
    rows = [[*left, *rest] for left, rest in zip(matrix.tolist(), right.tolist())]
    size = len(rows)
    for i in range(size):
        pivot = max(range(i, size), key=lambda k: abs(rows[k][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for k in range(size):
            if k != i:
                factor = rows[k][i] / rows[i][i]
                rows[k] = [value - factor * top for value, top in zip(rows[k], rows[i])]
    return np.array([[value / row[i] for value in row[size:]] for i, row in enumerate(rows)])


def exact_product(left: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Return the matrix product left @ right with exactly rounded sums."""
    columns = right.T.tolist()
    entries = np.array([[_exact_dot(row, column) for column in columns] for row in left.tolist()])
    return entries if np.iscomplexobj(left) or np.iscomplexobj(right) else entries.real.copy()


def _exact_dot(row: list[complex], column: list[complex]) -> complex:
    """Return the dot product of two vectors, rounded only once."""
    pairs = list(zip(row, column))
    real = math.fsum([*(a.real * b.real for a, b in pairs), *(-a.imag * b.imag for a, b in pairs)])
    return complex(real, math.fsum([*(a.real * b.imag for a, b in pairs), *(a.imag * b.real for a, b in pairs)]))


def _legendre_basis(order: int) -> legendre.Legendre:
    """Return the Legendre polynomial of an order, shifted to [0, 1]."""
    return legendre.Legendre.basis(order, domain=[0.0, 1.0])


def _radau_nodes(stages: int) -> np.ndarray:
    """Return the right Radau points on (0, 1]: the roots of P_s - P_{s-1} (Hairer and Wanner, IV.5)."""
    polynomial = _legendre_basis(stages) - _legendre_basis(stages - 1)
    roots = np.round(np.sort(polynomial.roots().real), GUESSED_DIGITS)
    for _ in range(EIGENVALUE_ITERATIONS):
        roots -= polynomial(roots) / polynomial.deriv()(roots)
    roots[-1] = 1.0
    return roots


def _interpolation_weights(theta: np.ndarray, integrated: bool) -> np.ndarray:
    """Return weights (len(theta), STAGES) of values at the stages in their interpolant, or its integral, at theta."""
    basis = [_legendre_basis(k) for k in range(STAGES)]
    values = np.stack([p(NODES) for p in basis], axis=1)
    raised = np.stack([(p.integ(lbnd=0.0) if integrated else p)(theta) for p in basis], axis=1)
    return np.ascontiguousarray(_solve_linear(values.T, raised.T).T)


NODES = _radau_nodes(STAGES)  # stages c_i, as shares of a step
A = _interpolation_weights(NODES, True)  # Butcher's matrix: integrals from the start of a step to the stages
A2 = exact_product(A, A)  # matrix of the second integrals to the stages
# Weights of values at the stages in their interpolant at theta = 0, the start of a step: its misfit there is an error
AT_START = _interpolation_weights(np.zeros(1), False)[0]
# Matrix from values at the stages to the coefficients of their polynomial in powers of theta, lowest first
MONOMIALS = _solve_linear(np.vander(NODES, increasing=True), np.eye(STAGES))


def _defect_polynomial() -> np.ndarray:
    """Return the coefficients of the polynomial in theta, highest power first, that is 1 at 0 and 0 at the stages."""
    coefficients = [1.0]
    for node in NODES.tolist():
        coefficients = [a - b / node for a, b in zip([0.0, *coefficients], [*coefficients, 0.0])]
    return np.array(coefficients)


# Shape of the interpolation error within a step, a polynomial in theta: 1 at the start, 0 at the stages
DEFECT_POLYNOMIAL = _defect_polynomial()
# Weights of the stage accelerations in the misfit at the start of a step of the interpolant of velocities, over h
VELOCITY_AT_START = exact_product(AT_START[None, :], A)[0]
# Coefficients, highest power first, of the integral of DEFECT_POLYNOMIAL from theta = 0
DEFECT_INTEGRAL = np.append(DEFECT_POLYNOMIAL / np.arange(len(DEFECT_POLYNOMIAL), 0, -1), 0.0)


def _compute_channels() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the eigenvalues of A, one of each conjugate pair, and the matrices to their eigenbasis and back."""
    # A has one real eigenvalue and three conjugate pairs. The numbers in the channels of a pair are conjugate, so one
    # channel is kept and counted twice. LAPACK's eigenvalues are rounded to GUESSED_DIGITS and refined by inverse
    # iteration; the inverse of the eigenvectors gets one step of Newton's method (X <- 2 X - X V X), which makes it
    # exact to rounding. All sums have a fixed order, so the constants are the same on every processor.
    guesses = np.round(np.linalg.eigvals(A), GUESSED_DIGITS)
    kept = sorted((complex(guess) for guess in guesses if guess.imag >= 0.0), key=lambda guess: guess.imag)
    values, vectors = zip(*(_eigenpair_near(guess) for guess in kept))
    # A channel that is kept stands for its conjugate as well
    doubled = [1.0 if value.imag == 0.0 else 2.0 for value in values]
    others = [vector.conj() for vector, factor in zip(vectors, doubled) if factor == 2.0]
    every = np.stack([*vectors, *others], axis=1)
    inverse = _solve_linear(every, np.eye(STAGES))
    inverse = 2.0 * inverse - exact_product(inverse, exact_product(every, inverse))
    return np.array(values), inverse[:CHANNELS], np.stack(vectors, axis=1) * doubled


def _eigenpair_near(guess: complex) -> tuple[complex, np.ndarray]:
    """Return the eigenvalue of A next to a guess and its eigenvector with one entry 1, by inverse iteration."""
    shifted = A - guess * np.eye(STAGES)
    vector = _solve_linear(shifted, np.ones((STAGES, 1), complex))
    unit = int(np.abs(vector).argmax())
    value = guess
    for _ in range(EIGENVALUE_ITERATIONS):
        vector = np.array([[entry / vector[unit, 0].item()] for entry in vector[:, 0].tolist()])
        image = exact_product(A, vector)
        value = image[unit, 0].item()
        missed = [[a - value * b] for a, b in zip(image[:, 0].tolist(), vector[:, 0].tolist())]
        vector = vector - _solve_linear(shifted, np.array(missed))
    return value, vector[:, 0]


# Eigenvalues lambda_j of the collocation matrix A, and the matrices from stages to its eigenbasis (channels) and back
EIGENVALUES, TO_CHANNELS, FROM_CHANNELS = (np.ascontiguousarray(part) for part in _compute_channels())

# Shares of a step, theta, at which the search for peaks and events begins
SEARCH_POINTS = np.linspace(0.0, 1.0, 15)


def columns_as_rows(matrix: np.ndarray) -> np.ndarray:
    """Return the columns of a matrix as rows of ROW_LENGTH numbers (rows.py), filled up with zeros."""
    filled = np.zeros((matrix.shape[1], ROW_LENGTH))
    filled[:, : len(matrix)] = matrix.T
    return filled
