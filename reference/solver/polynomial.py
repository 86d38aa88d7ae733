"""Polynomial through the numbers at the stages of a step: its integrals, its coefficients and its values."""

from __future__ import annotations

from reference.solver.collocation import A2, MONOMIALS, NODES, STAGES, A, columns_as_rows
from reference.solver.compiled import compiled
from reference.solver.rows import Row, combine_columns, put
from reference.solver.system import Array

# Columns of matrices of collocation.py: from stage values to integrals, to second integrals, and to coefficients
A_COLUMNS, A2_COLUMNS, MONOMIALS_COLUMNS = columns_as_rows(A), columns_as_rows(A2), columns_as_rows(MONOMIALS)
NODES_ROW = columns_as_rows(NODES[:, None])[0]  # stages c_i, as shares of a step, in a row
POWERS = STAGES + 2  # number of coefficients: a position is the second integral of a polynomial through the stages


@compiled
def integrate_to_stages(values: Row) -> Row:
    """Return integrals of the polynomial through `values` from the step's start to every stage, over its length."""
    return combine_columns(A_COLUMNS, values)


@compiled
def set_coefficients(values: Row, coefficients: Array) -> None:
    """Set the coefficients (POWERS,) of the powers of theta of the polynomial through the stages."""
    put(coefficients, (), combine_columns(MONOMIALS_COLUMNS, values))
    for k in range(STAGES, POWERS):
        coefficients[k] = 0.0


@compiled
def evaluate_polynomial(coefficients: Array, theta: float) -> float:
    """Return the value of the polynomial at theta."""
    value = 0.0
    for k in range(STAGES - 1, -1, -1):
        value = value * theta + coefficients[k]
    return value
