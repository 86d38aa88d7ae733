"""Gaussian elimination with row pivoting for the small dense systems of one step, without allocation."""

from __future__ import annotations

from reference.solver.compiled import compiled
from reference.solver.system import Array


@compiled
def solve_in_place(matrix: Array, rhs: Array) -> bool:
    """Overwrites rhs (n,) by the solution; False if the matrix (n, n), destroyed, is singular or not finite."""
    n = rhs.shape[0]
    for i in range(n):
        best = abs(matrix[i, i])
        row = i
        for k in range(i + 1, n):
            if abs(matrix[k, i]) > best:
                best = abs(matrix[k, i])
                row = k
        if not best > 0.0:
            return False
        if row != i:
            for j in range(i, n):
                matrix[i, j], matrix[row, j] = matrix[row, j], matrix[i, j]
            rhs[i], rhs[row] = rhs[row], rhs[i]
        inverse = 1.0 / matrix[i, i]
        for k in range(i + 1, n):
            factor = matrix[k, i] * inverse
            if factor != 0.0:
                for j in range(i + 1, n):
                    matrix[k, j] -= factor * matrix[i, j]
                rhs[k] -= factor * rhs[i]
    for i in range(n - 1, -1, -1):
        total = rhs[i]
        for j in range(i + 1, n):
            total -= matrix[i, j] * rhs[j]
        rhs[i] = total / matrix[i, i]
    return True
