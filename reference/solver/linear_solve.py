"""Gaussian elimination with row pivoting for the small dense systems of one step, without allocation."""

from __future__ import annotations

from reference.solver.compiled import compiled
from reference.solver.system import Array


@compiled
def factorize(matrix: Array, pivots: Array) -> bool:
    """Overwrites matrix (n, n) by its factors, pivots (n,) by rows; False if it is singular or not finite."""
    n = pivots.shape[0]
    for i in range(n):
        best = abs(matrix[i, i])
        row = i
        for k in range(i + 1, n):
            if abs(matrix[k, i]) > best:
                best = abs(matrix[k, i])
                row = k
        if not best > 0.0:
            return False
        pivots[i] = row
        if row != i:
            for j in range(n):
                matrix[i, j], matrix[row, j] = matrix[row, j], matrix[i, j]
        inverse = 1.0 / matrix[i, i]
        for k in range(i + 1, n):
            factor = matrix[k, i] * inverse
            matrix[k, i] = factor
            if factor != 0.0:
                for j in range(i + 1, n):
                    matrix[k, j] -= factor * matrix[i, j]
    return True


@compiled
def solve(factors: Array, pivots: Array, rhs: Array) -> None:
    """Overwrites rhs (n,) by the solution, with what `factorize` left."""
    n = pivots.shape[0]
    for i in range(n):
        row = int(pivots[i])
        rhs[i], rhs[row] = rhs[row], rhs[i]
    for i in range(1, n):
        total = rhs[i]
        for j in range(i):
            total -= factors[i, j] * rhs[j]
        rhs[i] = total
    for i in range(n - 1, -1, -1):
        total = rhs[i]
        for j in range(i + 1, n):
            total -= factors[i, j] * rhs[j]
        rhs[i] = total / factors[i, i]
