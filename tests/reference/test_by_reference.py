"""Structures that compiled code passes by reference."""

from __future__ import annotations

import numpy as np
from numba import njit
from numba.experimental import structref

from reference.solver.by_reference import ByReference


class PairType(ByReference):
    """Numba's type of Pair."""


class Pair(structref.StructRefProxy):
    """A flag, which shifts the fields behind it, a number and an array."""


structref.define_proxy(Pair, PairType, ["flag", "size", "values"])


@njit
def changed(pair, size, values):
    pair.size = size
    pair.values = values


@njit
def made(count):
    """The arrays are kept by the structure alone."""
    pair = Pair(True, 0.5, np.ones(count))
    before = pair.flag, pair.size, pair.values.sum()
    changed(pair, 2.5, np.arange(count) * 1.0)
    filled = np.full((50, count), -1.0)  # takes the memory of an array that is no longer kept
    return before, pair.flag, pair.size, pair.values.copy(), filled.sum()


def test_fields_are_read_and_set_where_they_are() -> None:
    before, flag, size, values, _ = made(1000)
    assert before == (True, 0.5, 1000.0)
    assert flag is True
    assert size == 2.5
    assert np.array_equal(values, np.arange(1000.0))


def test_the_fields_are_not_spelled_out_in_the_code_of_a_function() -> None:
    made(3)
    (built,) = changed.overloads.values()
    assert "PairType" in built.fndesc.mangled_name
    assert "values" not in built.fndesc.mangled_name
    assert built.fndesc.mangled_name.count("Array") == 1  # the argument
