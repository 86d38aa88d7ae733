"""Rows of numbers, one of each stage: what is read of them leaves out the unused place."""

import numba
import numpy as np
from numpy.typing import NDArray

from reference.solver.collocation import LANES, STAGES
from reference.solver.rows import finite, highest, lowest, row

Array = NDArray[np.float64]
RANDOM = np.random.default_rng(5)


@numba.njit
def extremes(values: Array) -> tuple[float, float, bool]:
    numbers = row(values, ())
    return lowest(numbers), highest(numbers), finite(numbers)


def test_the_place_behind_the_stages_is_never_looked_at() -> None:
    for unused in (-1e9, 1e9, np.inf, np.nan):
        for values in RANDOM.normal(size=(20, LANES)):
            values[LANES - 1] = unused
            assert extremes(values) == (values[:STAGES].min(), values[:STAGES].max(), True)


def test_a_row_with_a_number_that_is_not_finite_is_not_finite() -> None:
    for wrong in (np.inf, -np.inf, np.nan):
        for stage in range(STAGES):
            values = RANDOM.uniform(0.1, 3.0, LANES)
            values[stage] = wrong
            assert not extremes(values)[2]
