"""
Gaussian elimination with row pivoting for the small dense systems of one step, without allocation.

A system has one or two blocks of STAGES equations each. Its matrix is kept by columns, `columns` (n, blocks,
ROW_LENGTH) for n equations: `columns[j, b, k]` is the factor of unknown j in equation k of block b. The last place of
each row (rows.py) is not used. `pivots` (n,) are the places, ROW_LENGTH * b + k, of the exchanged equations.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reference.solver.collocation import ROW_LENGTH, STAGES
from reference.solver.compiled import compiled
from reference.solver.rows import put, row, row_maximum
from reference.solver.system import Array

MOST_BLOCKS = 2  # largest number of blocks of equations: one for the platform's acceleration along x, one along y
MIN_PIVOT = 0.1  # rows are exchanged if a pivot is smaller than this share of the largest entry below it
_PLACES = np.arange(MOST_BLOCKS * STAGES)  # row and column numbers of the largest matrix


def _ones_where(chosen: NDArray[np.bool_]) -> Array:
    """Return a mask for `columns` (see the top of this file): 1 where `chosen` (n, n) is True, by column and row."""
    ones = np.zeros((len(_PLACES), MOST_BLOCKS, ROW_LENGTH))
    ones[:, :, :STAGES] = chosen.reshape(-1, MOST_BLOCKS, STAGES)
    return ones


# Mask for the columns of a matrix: 1 above the diagonal, 0 on it and below it
ABOVE_DIAGONAL = _ones_where(_PLACES[:, None] > _PLACES)
IDENTITY = _ones_where(_PLACES[:, None] == _PLACES)  # mask for matrix columns: 1 on the diagonal, else 0
BELOW_DIAGONAL = _ones_where(_PLACES[:, None] < _PLACES)  # mask for matrix columns: 1 below the diagonal, else 0


@compiled
def factorize(columns: Array, pivots: Array) -> bool:
    """Overwrite a matrix, (n, blocks, ROW_LENGTH) by columns, by its LU factors; return False if it is singular."""
    return factorize_blocks(columns, pivots, 1) if pivots.shape[0] == STAGES else factorize_blocks(columns, pivots, 2)


@compiled
def factorize_blocks(columns: Array, pivots: Array, blocks: int) -> bool:
    """Overwrite a matrix by its LU factors (`factorize`); blocks: 1, or 2 for motions along x and y."""
    # Right-looking LU by columns (Golub and Van Loan, Matrix Computations, 3.2): a column lies in one or two rows of
    # rows.py (`upper` and `lower`), so an elimination takes one multiplication and one subtraction for all its entries.
    # Masks leave the entries above and on the diagonal alone. The diagonal keeps the inverse pivots. Rows are exchanged
    # only where a pivot is below MIN_PIVOT of the largest entry (threshold pivoting), which is rare: in short steps
    # these matrices are near the identity.
    n = blocks * STAGES
    for block in range(blocks):
        for k in range(STAGES):
            i = block * STAGES + k
            place = block * ROW_LENGTH + k
            if abs(columns[i, block, k]) < MIN_PIVOT * largest_below_diagonal(columns, i, block, blocks):
                place = locate_largest(columns[i], block, k, blocks)
                for j in range(n):
                    exchange(columns[j], block, k, place)
            pivots[i] = place
            inverse = 1.0 / columns[i, block, k]
            if not abs(inverse) < np.inf:
                return False
            upper = lower = inverse * (row(BELOW_DIAGONAL, (i, 0)) * row(columns, (i, 0)))
            if block == 0:
                put(columns, (i, 0), row(ABOVE_DIAGONAL, (i, 0)) * row(columns, (i, 0)) + upper)
            if blocks == MOST_BLOCKS:
                lower = inverse * (row(BELOW_DIAGONAL, (i, 1)) * row(columns, (i, 1)))
                put(columns, (i, 1), row(ABOVE_DIAGONAL, (i, 1)) * row(columns, (i, 1)) + lower)
            for j in range(i + 1, n):
                factor = columns[j, block, k]
                if block == 0:
                    put(columns, (j, 0), row(columns, (j, 0)) - factor * upper)
                if blocks == MOST_BLOCKS:
                    put(columns, (j, 1), row(columns, (j, 1)) - factor * lower)
            columns[i, block, k] = inverse
    return True


@compiled
def largest_below_diagonal(columns: Array, i: int, block: int, blocks: int) -> float:
    """Return the largest absolute entry of column i below the diagonal, whose entry is in block number `block`."""
    sizes = abs(row(columns, (i, block))) * row(BELOW_DIAGONAL, (i, block))
    if block + 1 < blocks:
        sizes = max(sizes, abs(row(columns, (i, block + 1))))
    largest: float = row_maximum(sizes)
    return largest


@compiled
def locate_largest(column: Array, block: int, first: int, blocks: int) -> int:
    """Return the place, ROW_LENGTH * block + k, of the largest entry of a column (blocks, ROW_LENGTH).

    The search begins at entry `first` of block number `block`, the diagonal.
    """
    best, place = 0.0, block * ROW_LENGTH + first
    for b in range(block, blocks):
        for k in range(first if b == block else 0, STAGES):
            if abs(column[b, k]) > best:
                best, place = abs(column[b, k]), b * ROW_LENGTH + k
    return place


@compiled
def exchange(column: Array, block: int, k: int, place: int) -> None:
    """Exchange entry k of block number `block` in a column with the one at `place`, which is ROW_LENGTH * block + k."""
    other, m = place // ROW_LENGTH, place % ROW_LENGTH
    column[block, k], column[other, m] = column[other, m], column[block, k]


@compiled
def solve(factors: Array, pivots: Array, rhs: Array) -> None:
    """Solve linear equations by the LU factors of `factorize`: overwrite the right side, `rhs`, by the solution."""
    if pivots.shape[0] == STAGES:
        solve_blocks(factors, pivots, rhs, 1)
    else:
        solve_blocks(factors, pivots, rhs, 2)


@compiled
def solve_blocks(factors: Array, pivots: Array, rhs: Array, blocks: int) -> None:
    """Solve linear equations by LU factors: overwrite the right side, `rhs` (blocks, ROW_LENGTH), by the solution."""
    # Exchanges, then forward and back substitution, column by column. The diagonal of the factors has inverse pivots;
    # `upper` and `lower` collect the solved unknowns of the first and of the second block.
    for block in range(blocks):
        for k in range(STAGES):
            place = int(pivots[block * STAGES + k])
            if place != block * ROW_LENGTH + k:
                exchange(rhs, block, k, place)
    for block in range(blocks):
        for k in range(STAGES):
            subtract_column(factors, BELOW_DIAGONAL, block * STAGES + k, rhs, rhs[block, k], block, blocks)
    upper = lower = 0.0 * row(rhs, 0)
    for block in range(blocks - 1, -1, -1):
        for k in range(STAGES - 1, -1, -1):
            j = block * STAGES + k
            known = rhs[block, k] * factors[j, block, k]
            subtract_column(factors, ABOVE_DIAGONAL, j, rhs, known, 0, block + 1)
            upper += known * row(IDENTITY, (j, 0))
            lower += known * row(IDENTITY, (j, 1))
    put(rhs, 0, upper)
    if blocks == MOST_BLOCKS:
        put(rhs, 1, lower)


@compiled
def subtract_column(factors: Array, mask: Array, j: int, rhs: Array, known: float, first: int, end: int) -> None:
    """Subtract `known` times column j of the factors, where `mask` is 1, from the right side, `rhs`.

    Only the blocks from `first` to before `end` change. `known` is the solved unknown j.
    """
    for b in range(first, end):
        put(rhs, b, row(rhs, b) - known * (row(mask, (j, b)) * row(factors, (j, b))))


@compiled
def factorize_all(matrix: Array, pivots: Array) -> bool:
    """Overwrite any square matrix by its LU factors, with row pivoting; return False if singular or not finite."""
    n = matrix.shape[0]
    for i in range(n):
        place = i
        for k in range(i + 1, n):
            if abs(matrix[k, i]) > abs(matrix[place, i]):
                place = k
        pivots[i] = place
        if place != i:
            for j in range(n):
                matrix[i, j], matrix[place, j] = matrix[place, j], matrix[i, j]
        if not 0.0 < abs(matrix[i, i]) < np.inf:
            return False
        inverse = 1.0 / matrix[i, i]
        for k in range(i + 1, n):
            factor = matrix[k, i] * inverse
            matrix[k, i] = factor
            if factor != 0.0:
                for j in range(i + 1, n):
                    matrix[k, j] -= factor * matrix[i, j]
    return True


@compiled
def solve_all(factors: Array, pivots: Array, right: Array) -> None:
    """Solve linear equations by the LU factors of `factorize_all`: overwrite the right side by the solution."""
    n = factors.shape[0]
    for i in range(n):
        place = int(pivots[i])
        right[i], right[place] = right[place], right[i]
    for i in range(n):
        for j in range(i):
            right[i] -= factors[i, j] * right[j]
    for i in range(n - 1, -1, -1):
        for j in range(i + 1, n):
            right[i] -= factors[i, j] * right[j]
        right[i] /= factors[i, i]
