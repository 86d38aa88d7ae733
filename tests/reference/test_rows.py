"""Rows of numbers, one of each stage: what is read of them leaves out the unused place."""

import numba
import numpy as np
from numpy.typing import NDArray

from reference.solver.collocation import LANES, STAGES
from reference.solver.rows import finite, highest, lowest, row

Array = NDArray[np.float64]


@numba.njit
def extremes(values: Array) -> tuple[float, float, bool]:
    numbers = row(values, ())
    return lowest(numbers), highest(numbers), finite(numbers)


def test_the_place_behind_the_stages_is_never_looked_at_and_those_of_stages_are() -> None:
    for unused in (-1e9, 1e9, np.inf, np.nan):
        for values in np.random.default_rng(5).normal(size=(20, LANES)):
            values[LANES - 1] = unused
            assert extremes(values) == (values[:STAGES].min(), values[:STAGES].max(), True)
            values[np.argmax(values[:STAGES])] = np.nan
            assert not extremes(values)[2]
