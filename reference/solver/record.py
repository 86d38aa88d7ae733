"""Storing of a motion's time steps in a StepRecord, from which samples.py computes the motion at any instant."""

from __future__ import annotations

from reference.solver.collocation import STAGES
from reference.solver.compiled import compiled
from reference.solver.system import StepRecord
from reference.solver.work import CLOCK, REACTION, Workspace


@compiled
def record_step(work: Workspace, record: StepRecord, h: float, contact: int) -> None:
    """Store the step just solved, before its end becomes the new state, if `record` has room; count it in any case."""
    n = record.counts[0]
    record.counts[0] += 1
    if n >= record.start.shape[0]:
        return
    record.start[n] = work.time
    record.length[n] = h
    record.contact[n] = contact
    for k in range(STAGES):
        record.reaction[n, k] = work.stage[REACTION, k]
        record.clock[n, k] = work.turning[CLOCK, k]
        for i in range(work.x.shape[0]):
            for axis in range(3):
                record.total[n, i, axis, k] = work.total[i, axis, k]
            for axis in range(2):
                record.x[n, i, axis] = work.x[i, axis]
                record.v[n, i, axis] = work.v[i, axis]
                record.a[n, i, axis, k] = work.a[i, axis, k]
                record.position[n, i, axis, k] = work.positions[i, axis, k]
                record.velocities[n, i, axis, k] = work.velocities[i, axis, k]


@compiled
def record_stick(record: StepRecord, start: float, end: float) -> None:
    """Store an interval of rest, creep or elastic contact, s; ignore an empty one, and join intervals that touch."""
    if end <= start:
        return
    n = record.counts[1]
    if 0 < n <= record.sticks.shape[0] and record.sticks[n - 1, 1] == start:
        record.sticks[n - 1, 1] = end
        return
    if n < record.sticks.shape[0]:
        record.sticks[n, 0] = start
        record.sticks[n, 1] = end
    record.counts[1] += 1
