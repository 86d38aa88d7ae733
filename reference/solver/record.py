"""Keeps the steps of a motion, to be sampled afterwards (samples.py)."""

from __future__ import annotations

from reference.solver.compiled import compiled
from reference.solver.near_stop import CLOCK
from reference.solver.system import STOPPING, TIME, Record, Work


@compiled
def record_step(work: Work, record: Record, h: float, contact: int) -> None:
    """Keep the step just made (not yet committed) while there is room; count it in any case."""
    n = record.made[0]
    record.made[0] += 1
    if n >= record.start.shape[0]:
        return
    record.start[n] = work.run[TIME]
    record.length[n] = h
    record.contact[n] = contact
    record.x[n] = work.x
    record.v[n] = work.v
    record.total[n] = work.total
    record.reaction[n] = work.stage[6]
    if contact == STOPPING:
        record.position[n] = work.chain
        record.velocity[n] = work.velocity
        record.clock[n] = work.turning[CLOCK]
    else:
        record.a[n] = work.a


@compiled
def note_stick(record: Record, start: float, end: float) -> None:
    """One interval of rest; intervals that touch are one."""
    n = record.made[1]
    if 0 < n <= record.sticks.shape[0] and record.sticks[n - 1, 1] == start:
        record.sticks[n - 1, 1] = end
        return
    if n < record.sticks.shape[0]:
        record.sticks[n, 0] = start
        record.sticks[n, 1] = end
    record.made[1] += 1
