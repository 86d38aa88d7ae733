"""
Radau IIA collocation with seven stages (order 13, L-stable), for second-order systems.

On one step of length h the acceleration is a polynomial through the stages c_i, and velocity and position are its
integrals:  v_i = v_0 + h (A a)_i,  x_i = x_0 + c_i h v_0 + h^2 (A^2 a)_i.  The last stage is the end of the step.
A = T diag(lambda) T^-1 turns a linear chain into one scalar problem per eigenvalue; of each conjugate pair one is kept.
Source: Hairer and Wanner, Solving Ordinary Differential Equations II, sections IV.5 and IV.8.

LAPACK rounds differently on every kind of processor, which would change the eighth digit of results. So it gives only
first guesses here, rounded to a few digits. The constants are refined from these with sums in a fixed order
(docs/decisions/0003-floating-point-flags.md).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.polynomial import legendre

STAGES = 7  # number of collocation points (stages) in one time step
ROW_LENGTH = STAGES + 1  # numbers in a row (rows.py): one for each stage, and an unused one
CHANNELS = (STAGES + 1) // 2  # number of collocation eigenvectors kept (channels): the real one, one per conjugate pair
GUESSED_DIGITS = 3  # number of decimals kept of LAPACK's eigenvalues and roots, which are only first guesses
EIGENVALUE_ITERATIONS = 12  # number of iterations that refine a guessed eigenvalue or node until only rounding is left


def _solve_linear(matrix: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solve the linear equations matrix @ X = right by elimination with row pivoting, and return X."""
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
    """Return the matrix product left @ right, the sum in each entry rounded only once."""
    columns = right.T.tolist()
    entries = np.array([[_exact_dot(row, column) for column in columns] for row in left.tolist()])
    return entries if np.iscomplexobj(left) or np.iscomplexobj(right) else entries.real.copy()


def _exact_dot(row: list[complex], column: list[complex]) -> complex:
    """Return the dot product of two vectors, rounded only once."""
    pairs = list(zip(row, column))
    real = math.fsum([*(a.real * b.real for a, b in pairs), *(-a.imag * b.imag for a, b in pairs)])
    return complex(real, math.fsum([*(a.real * b.imag for a, b in pairs), *(a.imag * b.real for a, b in pairs)]))


def _legendre_basis(order: int) -> legendre.Legendre:
    """Return the Legendre polynomial of degree `order`, shifted to the interval [0, 1]."""
    return legendre.Legendre.basis(order, domain=[0.0, 1.0])


def _radau_nodes(stages: int) -> np.ndarray:
    """Return the right Radau points in (0, 1], roots of the Legendre P_s - P_{s-1} (Hairer and Wanner, IV.5)."""
    polynomial = _legendre_basis(stages) - _legendre_basis(stages - 1)
    roots = np.round(np.sort(polynomial.roots().real), GUESSED_DIGITS)
    for _ in range(EIGENVALUE_ITERATIONS):
        roots -= polynomial(roots) / polynomial.deriv()(roots)
    roots[-1] = 1.0
    return roots


def _interpolation_weights(theta: np.ndarray, integrated: bool) -> np.ndarray:
    """Return weights (T, STAGES) of the stage values that give their polynomial at the shares theta (T,) of a step, or
    if `integrated` the integral of this polynomial from 0 to theta."""
    basis = [_legendre_basis(k) for k in range(STAGES)]
    values = np.stack([p(NODES) for p in basis], axis=1)
    raised = np.stack([(p.integ(lbnd=0.0) if integrated else p)(theta) for p in basis], axis=1)
    return np.ascontiguousarray(_solve_linear(values.T, raised.T).T)


NODES = _radau_nodes(STAGES)  # (STAGES,) c_i: times of the stages from the start of a step, as shares of its length
# Butcher's matrix, the collocation matrix: it takes stage values to their integrals from the step's start to each stage
A = _interpolation_weights(NODES, True)
A2 = exact_product(A, A)  # matrix that takes stage values to their second integrals up to the stages
# Weights that extrapolate stage values to the start of a step; the true value known there shows the error
AT_START = _interpolation_weights(np.zeros(1), False)[0]
# Matrix that takes stage values to the coefficients of their polynomial in theta (share of a step), lowest power first
MONOMIALS = _solve_linear(np.vander(NODES, increasing=True), np.eye(STAGES))


def _defect_polynomial() -> np.ndarray:
    """Return the coefficients, highest power first, of a polynomial in the share of a step: 1 at 0, 0 at the stages."""
    coefficients = [1.0]
    for node in NODES.tolist():
        coefficients = [a - b / node for a, b in zip([0.0, *coefficients], [*coefficients, 0.0])]
    return np.array(coefficients)


# Coefficients of the interpolation error's shape in a step: polynomial in its share theta, 1 at start, 0 at the stages
DEFECT_POLYNOMIAL = _defect_polynomial()
# Weights whose sum with stage accelerations, times the step length, is the error of the velocity when its polynomial is
# extrapolated to the start of the step
VELOCITY_AT_START = exact_product(AT_START[None, :], A)[0]
# Coefficients, highest power first, of the integral of DEFECT_POLYNOMIAL from the start of a step (theta = 0)
DEFECT_INTEGRAL = np.append(DEFECT_POLYNOMIAL / np.arange(len(DEFECT_POLYNOMIAL), 0, -1), 0.0)


def _compute_channels() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the eigenvalues of the collocation matrix A, one of each conjugate pair (CHANNELS,), the matrix from stage
    values to its eigenbasis (CHANNELS, STAGES), and the matrix back, whose result's real part counts."""
    # A has one real eigenvalue and three conjugate pairs. The numbers in the channels of a pair are conjugate, so one
    # channel is kept and counted twice. LAPACK's eigenvalues are rounded to GUESSED_DIGITS and refined by inverse
    # iteration; the inverse of the eigenvectors gets one step of Newton's method (X <- 2 X - X V X), which makes it
    # exact to rounding. All sums have a fixed order, so the constants are the same on every processor.
    guesses = np.round(np.linalg.eigvals(A), GUESSED_DIGITS)
    kept = sorted((complex(guess) for guess in guesses if guess.imag >= 0.0), key=lambda guess: guess.imag)
    values, vectors = zip(*(_eigenpair_near(guess) for guess in kept))
    # A complex eigenvector that is kept counts twice in the matrix back to stages, since its conjugate is left out
    doubled = [1.0 if value.imag == 0.0 else 2.0 for value in values]
    others = [vector.conj() for vector, factor in zip(vectors, doubled) if factor == 2.0]
    every = np.stack([*vectors, *others], axis=1)
    inverse = _solve_linear(every, np.eye(STAGES))
    inverse = 2.0 * inverse - exact_product(inverse, exact_product(every, inverse))
    return np.array(values), inverse[:CHANNELS], np.stack(vectors, axis=1) * doubled


def _eigenpair_near(guess: complex) -> tuple[complex, np.ndarray]:
    """Return the collocation matrix's eigenvalue nearest to a guess, and its eigenvector, whose largest entry is 1."""
    # Inverse iteration about the guess, by corrections: A vector - value vector (`missed`) is solved for and taken off.
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


# Eigenvalues lambda_j of the collocation matrix A; matrices from stage values to its eigenbasis (channels) and back
EIGENVALUES, TO_CHANNELS, FROM_CHANNELS = (np.ascontiguousarray(part) for part in _compute_channels())

# Shares of a step (theta) at which a quantity is evaluated first when its peaks or events in the step are searched
SEARCH_POINTS = np.linspace(0.0, 1.0, 15)


def columns_as_rows(matrix: np.ndarray) -> np.ndarray:
    """Return a matrix transposed: each column as a row of ROW_LENGTH numbers (rows.py), filled up with zeros."""
    filled = np.zeros((matrix.shape[1], ROW_LENGTH))
    filled[:, : len(matrix)] = matrix.T
    return filled
