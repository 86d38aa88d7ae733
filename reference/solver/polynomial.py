"""Polynomial through the numbers at the stages of a step: its integrals, its coefficients and its values."""

from __future__ import annotations

from reference.solver.collocation import A2, MONOMIALS, NODES, STAGES, A, columns_as_rows
from reference.solver.compiled import compiled
from reference.solver.rows import Row, combine_columns, put
from reference.solver.system import Array

# Matrices from stage values to integrals, second integrals, and coefficients; by columns, for `combine_columns`
A_COLUMNS, A2_COLUMNS, MONOMIALS_COLUMNS = columns_as_rows(A), columns_as_rows(A2), columns_as_rows(MONOMIALS)
NODES_ROW = columns_as_rows(NODES[:, None])[0]  # times of the stages, as shares of a step, in a row (rows.py)
POWERS = STAGES + 2  # number of coefficients of a position, the second integral of a polynomial through the stages


@compiled
def integrate_to_stages(values: Row) -> Row:
    """Return the integral over theta (share of a step), from 0 to each stage, of the polynomial through `values`."""
    return combine_columns(A_COLUMNS, values)


@compiled
def set_coefficients(values: Row, coefficients: Array) -> None:
    """Set `coefficients` (POWERS,), lowest power of theta first, of the polynomial through stage `values`."""
    put(coefficients, (), combine_columns(MONOMIALS_COLUMNS, values))
    for k in range(STAGES, POWERS):
        coefficients[k] = 0.0


@compiled
def evaluate_polynomial(coefficients: Array, theta: float) -> float:
    """Return the value at share theta of a step of a polynomial with `coefficients`, lowest power first."""
    value = 0.0
    for k in range(STAGES - 1, -1, -1):
        value = value * theta + coefficients[k]
    return value
