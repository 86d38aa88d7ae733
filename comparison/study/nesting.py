"""Nested grids of phases: every grid is part of the next finer one, so that no phase pair is computed twice."""

from __future__ import annotations

from functools import cache
from itertools import accumulate
from operator import mul

import numpy as np
from numpy.typing import NDArray


@cache
def nested_grids(grid: int) -> tuple[int, ...]:
    """
    Grids from coarse to fine, each a part of the next, the last one with `grid` phases per axis: halvings come first.

    >>> nested_grids(48), nested_grids(96), nested_grids(7)
    ((2, 4, 8, 16, 48), (2, 4, 8, 16, 32, 96), (7,))
    """
    factors, rest = [], grid
    for prime in range(2, grid + 1):
        while rest % prime == 0:
            factors.append(prime)
            rest //= prime
    return tuple(accumulate(factors, mul)) or (1,)


def levels(grid: int) -> NDArray[np.intp]:
    """
    Which of `nested_grids` is the first with each phase of an axis.

    >>> levels(8).tolist()
    [0, 2, 1, 2, 0, 2, 1, 2]
    """
    level = np.zeros(grid, dtype=np.intp)
    for coarse in nested_grids(grid)[:-1]:
        level[np.arange(grid) % (grid // coarse) != 0] += 1
    return level
