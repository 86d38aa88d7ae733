"""Structures that compiled code passes by reference return their memory."""

from typing import NamedTuple

import numpy as np
from numba import njit
from numba.core.runtime import _nrt_python, rtsys

from reference.solver.compiled.by_reference import ByReference, by_reference, empty


class RoomType(ByReference):
    """Numba's type of a structure that is made without values."""


class Given(NamedTuple):
    """A flag, which shifts the fields behind it, and an array."""

    flag: bool
    values: np.ndarray


class GivenType(ByReference):
    """Numba's type of Given, passed by reference."""


empty_room = empty(RoomType, {"many": np.zeros((2, 2)), "number": 0.0, "waves": np.zeros(2, complex)})
given_by_reference = by_reference(GivenType)


@njit
def filled(size):
    """Whether all was zero, and the sums of what is written."""
    room = empty_room()
    zero = room.number == 0.0 and room.many.size == 0 and room.waves.size == 0
    room.many, room.waves, room.number = np.full((size, 2), 2.0), np.full(size, 3.0 + 1.0j), 4.0
    return zero, (room.many.sum(), room.waves.sum(), room.number)


@njit
def summed(given):
    reference = given_by_reference(given)
    return reference.values.sum() if reference.flag else -1.0


@njit
def kept(size):
    """What an array holds after structures that held it, too."""
    values = np.ones(size)
    for _ in range(2):
        summed(Given(True, values))
    filled = np.full((50, size), -1.0)  # takes the memory of an array that is no longer kept
    return values.sum() + filled[0, 0]


def test_structures_return_their_memory_and_keep_that_of_others() -> None:
    values = np.ones(4)
    assert filled(3) == (True, (12.0, (3.0 + 1.0j) * 3, 4.0))
    summed(Given(True, values))
    _nrt_python.memsys_enable_stats()
    before = rtsys.get_allocation_stats()
    sums = [(summed(Given(True, values)), summed(Given(False, values)), filled(3)[0]) for _ in range(5)]
    after = rtsys.get_allocation_stats()
    _nrt_python.memsys_disable_stats()
    assert sums == [(4.0, -1.0, True)] * 5
    assert after.alloc - before.alloc == after.free - before.free
    assert after.alloc > before.alloc
    assert kept(1000) == 999.0
