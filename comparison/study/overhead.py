"""What a run takes beside what it computes, s, recorded on `models.RECORDED_ON`."""

from __future__ import annotations

import time

# said wherever a command may have to compile first
COMPILED_ONCE = "On a new installation the reference is compiled first, once: about 20 s of one worker."
START_UP = 5.0  # worker processes start and load the compiled equations
LOADING = 1.5  # modules load before the clock of a run starts
WRITING = 6.0  # the page and its data are written by one process
WORK = 0.009  # wall time of `_fixed_work`
ROUNDS = 10


def slowness() -> float:
    """
    How many times as long as on the machine of the record plain Python takes here and now, at least 1.

    A machine that other processes keep busy counts as slow. Takes a tenth of a second.
    """
    return max(1.0, sum(_fixed_work() for _ in range(ROUNDS)) / ROUNDS / WORK)


def _fixed_work() -> float:
    """Wall time of a fixed piece of work, s."""
    begin, words = time.perf_counter(), {}
    for number in range(50_000):
        words[str(number)] = number
    return time.perf_counter() - begin
