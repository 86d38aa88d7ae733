"""Rows do with every number what a float does alone."""

import math
import operator
from collections.abc import Callable
from typing import Any

import numba
import numpy as np
import pytest
from numpy.typing import NDArray

from reference.solver.collocation import LANES, STAGES
from reference.solver.rows import as_many, finite, highest, lowest, put, row, where_positive

Array = NDArray[np.float64]
OF_TWO: list[Callable[..., Any]] = [operator.add, operator.sub, operator.mul, operator.truediv, max, min]
OF_ONE: list[Callable[..., Any]] = [operator.neg, abs, math.sqrt, math.exp, math.expm1, math.log]
RANDOM = np.random.default_rng(5)
LEFT, RIGHT = RANDOM.uniform(0.1, 3.0, (2, LANES))
UNUSED = LANES - 1


@pytest.mark.parametrize("operation", OF_TWO, ids=lambda operation: operation.__name__)
def test_a_row_and_a_row_or_a_float_give_what_floats_give(operation: Callable[..., Any]) -> None:
    @numba.njit
    def together(left: Array, right: Array, out: Array) -> None:
        put(out, 0, operation(row(left, ()), row(right, ())))
        put(out, 1, operation(row(left, ()), 1.7))
        put(out, 2, operation(1.7, row(right, ())))

    out = np.zeros((3, LANES))
    together(LEFT, RIGHT, out)
    expected = [[operation(a, b), operation(a, 1.7), operation(1.7, b)] for a, b in zip(LEFT, RIGHT)]
    np.testing.assert_array_equal(out.T, expected)


@pytest.mark.parametrize("operation", OF_ONE, ids=lambda operation: operation.__name__)
def test_a_row_gives_what_its_floats_give(operation: Callable[..., Any]) -> None:
    @numba.njit
    def together(values: Array, out: Array) -> None:
        put(out, (), operation(row(values, ())))

    @numba.njit
    def one_by_one(values: Array, out: Array) -> None:
        for k in range(STAGES):
            out[k] = operation(values[k])

    out, expected = np.zeros(LANES), np.zeros(LANES)
    together(LEFT, out)
    one_by_one(LEFT, expected)
    np.testing.assert_array_equal(out[:STAGES], expected[:STAGES])


@numba.njit
def extremes(values: Array) -> tuple[float, float, bool]:
    numbers = row(values, ())
    return lowest(numbers), highest(numbers), finite(numbers)


@pytest.mark.parametrize("unused", [-1e9, 1e9, np.inf, np.nan])
def test_the_place_behind_the_stages_is_never_looked_at(unused: float) -> None:
    for values in RANDOM.normal(size=(20, LANES)):
        values[UNUSED] = unused
        assert extremes(values) == (values[:STAGES].min(), values[:STAGES].max(), True)


@pytest.mark.parametrize("wrong", [np.inf, -np.inf, np.nan])
@pytest.mark.parametrize("stage", range(STAGES))
def test_a_row_with_a_number_that_is_not_finite_is_not_finite(wrong: float, stage: int) -> None:
    values = LEFT.copy()
    values[stage] = wrong
    assert not extremes(values)[2]


def test_rows_are_read_and_written_where_an_array_has_them() -> None:
    @numba.njit
    def moved(source: Array, goal: Array) -> None:
        for i in range(source.shape[0]):
            for j in range(source.shape[1]):
                put(goal, (j, i), row(source, (i, j)))
        put(goal, (0, 0), 7.0)

    source = RANDOM.normal(size=(2, 3, LANES))
    goal = np.zeros((3, 2, LANES))
    moved(source, goal)
    expected = source.transpose(1, 0, 2).copy()
    expected[0, 0] = 7.0
    np.testing.assert_array_equal(goal, expected)


def test_a_choice_is_made_for_every_number_of_a_row() -> None:
    @numba.njit
    def chosen(values: Array, out: Array) -> tuple[float, float]:
        numbers = row(values, ())
        put(out, (), where_positive(numbers, numbers, as_many(5.0, numbers)))
        return where_positive(-0.0, 1.0, 2.0), as_many(3.0, 4.0)

    values, out = LEFT - 1.5, np.zeros(LANES)
    assert chosen(values, out) == (2.0, 3.0)
    np.testing.assert_array_equal(out, np.where(values > 0.0, values, 5.0))
