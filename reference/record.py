"""Samples of a motion at asked times, read from the polynomials of each step."""

from __future__ import annotations

from reference.collocation import MONOMIALS, STAGES, A
from reference.compiled import compiled
from reference.events import value_at
from reference.near_stop import CLOCK
from reference.system import STOPPING, TIME, Array, Record, Work


@compiled
def integral_at(values: Array, theta: float) -> float:
    """Integral from 0 to theta of the polynomial through the stage values (S,)."""
    total = 0.0
    for k in range(STAGES - 1, -1, -1):
        coefficient = 0.0
        for m in range(STAGES):
            coefficient += MONOMIALS[k, m] * values[m]
        total = (total + coefficient / (k + 1)) * theta
    return total


@compiled
def record_step(work: Work, record: Record, h: float, contact: int) -> None:
    """Write every sample whose time lies in the step just made (not yet committed)."""
    t = work.run[TIME]
    end = work.turning[CLOCK, STAGES - 1] if contact == STOPPING else t + h
    while record.count[0] < record.times.shape[0] and record.times[record.count[0]] <= end * (1.0 + 1e-15):
        n = record.count[0]
        theta = place(work, record.times[n], t, h, contact)
        for i in range(work.x.shape[0]):
            for axis in range(2):
                if contact == STOPPING:
                    record.x[n, i, axis] = value_at(work.chain[i, axis], theta)
                    record.v[n, i, axis] = value_at(work.velocity[i, axis], theta)
                else:
                    record.v[n, i, axis] = work.v[i, axis] + h * integral_at(work.a[i, axis], theta)
                    shift = 0.0
                    weight = theta
                    for k in range(STAGES):
                        coefficient = 0.0
                        for m in range(STAGES):
                            gained = 0.0
                            for q in range(STAGES):
                                gained += A[m, q] * work.a[i, axis, q]
                            coefficient += MONOMIALS[k, m] * gained
                        shift += coefficient * weight / (k + 1)
                        weight *= theta
                    record.x[n, i, axis] = work.x[i, axis] + h * (theta * work.v[i, axis] + h * shift)
            for axis in range(3):
                record.total[n, i, axis] = value_at(work.total[i, axis], theta)
        record.reaction[n] = value_at(work.stage[6], theta)
        record.count[0] += 1


@compiled
def place(work: Work, time: float, t: float, h: float, contact: int) -> float:
    """Where in the step `time` is; near a stop time itself is a polynomial of the step's variable."""
    if contact != STOPPING:
        return min(1.0, (time - t) / h)
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        if value_at(work.turning[CLOCK], middle) > time:
            high = middle
        else:
            low = middle
    return low


@compiled
def note_stick(record: Record, start: float, end: float) -> None:
    """One interval of rest; intervals that touch are one."""
    n = record.count[1]
    if n > 0 and record.sticks.shape[0] > 0 and record.sticks[n - 1, 1] == start:
        record.sticks[n - 1, 1] = end
    elif n < record.sticks.shape[0]:
        record.sticks[n, 0] = start
        record.sticks[n, 1] = end
        record.count[1] += 1
