"""Rest: the platform stays where it is while friction can hold it, the chain above it vibrates."""

from __future__ import annotations

from reference.solver.collocation import STAGES
from reference.solver.compiled import compiled, inlined
from reference.solver.events import excess_at, expand, first_onset, lowest
from reference.solver.record import note_stick
from reference.solver.step_control import (
    FATAL_STEP,
    adapt,
    begin,
    commit,
    length_factor,
    next_step,
    remaining,
    shortened,
    unbroken,
)
from reference.solver.steps import rest_step, step_error
from reference.solver.system import (
    HELD,
    LEFT,
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

ONSET_EXCESS = 1e-12  # of the squared friction limit: how far past it the onset is located


@compiled
def located_onset(system: System, phase: Array, work: Work, h: float, onset: float) -> float:
    """Length of the step at rest whose end lies at the onset, just past it; the step is made."""
    expand(work)
    width = 1e-4 * onset
    slope = (excess_at(system, work, onset) - excess_at(system, work, onset - width)) / (width * h)
    end = h * onset
    limit = (system.friction * work.stage[6, STAGES - 1]) ** 2  # hardly changes on the way to the onset
    for _ in range(8):
        rest_step(system, phase, work, work.run[TIME], end)
        expand(work)
        excess = excess_at(system, work, 1.0)
        if not slope > 0.0 or 0.0 < excess <= ONSET_EXCESS * limit:
            break
        end = min(max(end + (0.5 * ONSET_EXCESS * limit - excess) / slope, 0.5 * end), h)
    first_onset(system, work)  # fills the reaction
    return end


@inlined
def rest_phase(system: System, phase: Array, work: Work, demand: Demand, record: Record) -> tuple[int, int]:
    """Until the located onset of slip; (how it went, what the contact does next). See run.py."""
    work.v[0, 0] = work.v[0, 1] = 0.0
    begin(system, phase, work, REST)
    run = work.run
    began = run[TIME] + run[LEFT]
    run[LEFT] = 0.0
    while remaining(system, work, demand) > 0.0:
        if not next_step(work, demand):
            return STEP_LIMIT, REST
        h = min(run[LENGTH], unbroken(system, work, demand))
        if run[HELD] > 0.0:
            h = min(h, run[HELD])
        rest_step(system, phase, work, run[TIME], h)
        error = step_error(work, demand.tolerance)
        factor = length_factor(error, demand.tolerance)
        if not error <= demand.tolerance:
            if not shortened(work, demand, h, factor):
                return UNSOLVED, REST
            continue
        onset = first_onset(system, work)
        if lowest(work.stage[6]) <= 0.0:
            if h < FATAL_STEP * demand.period:
                return OPEN, REST
            run[LENGTH] = 0.3 * h
            continue
        if onset <= 1.0 and run[HELD] == 0.0:
            if onset > 0.0:
                h = located_onset(system, phase, work, h, onset)
                commit(work, record, h, REST, 0.0, 1.0)
            note_stick(record, began, run[TIME])
            return SOLVED, SLIDING
        commit(work, record, h, REST, 0.0, 1.0)
        run[HELD] = 0.0
        adapt(work, h, factor)
    note_stick(record, began, run[TIME])
    return SOLVED, REST
