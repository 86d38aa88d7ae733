"""Rest: the platform stays where it is while friction can hold it, the chain above it vibrates."""

from __future__ import annotations

from reference.advance import FATAL, SHORTEST, begin, commit, length_factor, next_step, remaining
from reference.compiled import compiled
from reference.events import first_onset
from reference.record import note_stick
from reference.steps import rest_step, step_error
from reference.system import (
    HELD,
    LENGTH,
    OPEN,
    REST,
    SLIDING,
    SOLVED,
    STEP_LIMIT,
    TIME,
    UNSOLVED,
    Array,
    Demand,
    Record,
    System,
    Work,
)


@compiled
def rest_phase(system: System, phase: Array, work: Work, demand: Demand, record: Record) -> tuple[int, int]:
    """Until the located onset of slip; (how it went, what the contact does next). See march.py."""
    work.v[0, :] = 0.0
    begin(system, phase, work, REST)
    run = work.run
    began = run[TIME]
    while remaining(system, work, demand) > 0.0:
        if not next_step(work, demand):
            return STEP_LIMIT, REST
        h = min(run[LENGTH], remaining(system, work, demand))
        if run[HELD] > 0.0:
            h = min(h, run[HELD])
        rest_step(system, phase, work, run[TIME], h)
        error = step_error(work, work.scale)
        if not error <= demand.tolerance:
            if h < SHORTEST * demand.period:
                return UNSOLVED, REST
            run[LENGTH] = h * min(0.7, length_factor(error, demand.tolerance))
            continue
        onset = first_onset(system, work)
        if work.stage[6].min() <= 0.0:
            if h < FATAL * demand.period:
                return OPEN, REST
            run[LENGTH] = 0.3 * h
            continue
        if onset <= 1.0 and run[HELD] == 0.0:
            if onset > 0.0:
                h *= onset
                rest_step(system, phase, work, run[TIME], h)
                first_onset(system, work)
                commit(work, record, h, REST, 0.0, 1.0)
            note_stick(record, began, run[TIME])
            return SOLVED, SLIDING
        commit(work, record, h, REST, 0.0, 1.0)
        run[HELD] = 0.0
        if h * length_factor(error, demand.tolerance) > run[LENGTH] or h == run[LENGTH]:
            run[LENGTH] = h * length_factor(error, demand.tolerance)
    note_stick(record, began, run[TIME])
    return SOLVED, REST
