"""
Gaussian elimination with row pivoting for the small dense systems of one step, without allocation.

A matrix is kept by columns: row i of column j is `columns[j, i]`. Every inner loop goes along a column, and the sizes
are known when the solver is compiled: the processor does several entries at once.
"""

from __future__ import annotations

from reference.solver.collocation import STAGES
from reference.solver.compiled import compiled
from reference.solver.system import Array


@compiled
def factorize(columns: Array, pivots: Array) -> bool:
    """
    Overwrites a matrix (n, n) by its factors, pivots (n,) by rows; False if it is singular or not finite.

    n is STAGES, or twice as much.
    """
    if pivots.shape[0] == STAGES:
        return factorize_order(columns, pivots, STAGES)
    return factorize_order(columns, pivots, 2 * STAGES)


@compiled
def solve(factors: Array, pivots: Array, rhs: Array) -> None:
    """Overwrites rhs (n,) by the solution, with what `factorize` left."""
    if pivots.shape[0] == STAGES:
        solve_order(factors, pivots, rhs, STAGES)
    else:
        solve_order(factors, pivots, rhs, 2 * STAGES)


@compiled
def factorize_order(columns: Array, pivots: Array, n: int) -> bool:
    """`factorize` for n rows."""
    for i in range(n):
        pivot = columns[i]
        best = abs(pivot[i])
        row = i
        for k in range(i + 1, n):
            if abs(pivot[k]) > best:
                best = abs(pivot[k])
                row = k
        if not best > 0.0:
            return False
        pivots[i] = row
        if row != i:
            for j in range(n):
                columns[j, i], columns[j, row] = columns[j, row], columns[j, i]
        inverse = 1.0 / pivot[i]
        for k in range(i + 1, n):
            pivot[k] *= inverse
        for j in range(i + 1, n):
            column = columns[j]
            factor = column[i]
            for k in range(i + 1, n):
                column[k] -= factor * pivot[k]
    return True


@compiled
def solve_order(factors: Array, pivots: Array, rhs: Array, n: int) -> None:
    """`solve` for n rows."""
    for i in range(n):
        row = int(pivots[i])
        rhs[i], rhs[row] = rhs[row], rhs[i]
    for j in range(n):
        column = factors[j]
        known = rhs[j]
        for i in range(j + 1, n):
            rhs[i] -= known * column[i]
    for j in range(n - 1, -1, -1):
        column = factors[j]
        known = rhs[j] / column[j]
        rhs[j] = known
        for i in range(j):
            rhs[i] -= known * column[i]
