"""Motion under a friction law without a corner: lubricated, or creep below v_reg under the regularized law."""

from __future__ import annotations

from reference.solver.collocation import STAGES
from reference.solver.compiled import inlined
from reference.solver.contact.friction import sliding_speed2
from reference.solver.contact.platform import slip_factor
from reference.solver.events import first_crossing, highest
from reference.solver.record import note_stick
from reference.solver.step_control import (
    NEWTON_FRACTION,
    adapt,
    begin,
    commit,
    first_guess,
    length_factor,
    next_step,
    remaining,
    shortened,
    too_short,
    unbroken,
)
from reference.solver.steps import moving_step, step_error
from reference.solver.system import (
    CREEPING,
    HELD,
    LENGTH,
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

LEVEL_TOLERANCE = 1e-9  # of the squared speed: creep this close to v_reg has reached it
EARLY_CROSSING = 1e-6  # of a step: a crossing this early means that the phase begins on the level


@inlined
def smooth_phase(
    system: System, phase: Array, work: Work, contact: int, demand: Demand, record: Record
) -> tuple[int, int]:
    """To the end of the motion, or until creep becomes sliding at v_reg; see run.py."""
    begin(system, phase, work, contact)
    run = work.run
    began = run[TIME]
    level = system.v_reg * system.v_reg
    rate = slip_factor(system, contact, 0.0) * system.mass_ratio * system.gravity  # 1/s, of the velocity's decay
    if contact == CREEPING:
        run[LENGTH] = min(run[LENGTH], 2.0 / rate)
    while remaining(system, work, demand) > 0.0:
        if not next_step(work, demand):
            return STEP_LIMIT, contact
        h = min(run[LENGTH], unbroken(system, work, demand))
        if run[HELD] > 0.0:
            h = min(h, run[HELD])
        first_guess(work, h)
        # where friction is stiff a small error of the acceleration is a large one of the velocity, and so of the force
        enough = NEWTON_FRACTION * demand.tolerance * work.scale[0] / (1.0 + h * rate)
        code = moving_step(system, phase, work, contact, run[TIME], h, enough)
        if code != SOLVED:
            if too_short(demand, h, code):
                return code, contact
            run[LENGTH] = 0.3 * h
            continue
        error = step_error(work, demand.tolerance)
        factor = length_factor(error, demand.tolerance)
        if not error <= demand.tolerance:
            if not shortened(work, demand, h, factor):
                return UNSOLVED, contact
            continue
        if contact == CREEPING and highest(work.stage[7]) > 0.8 * level:
            start = sliding_speed2(work.x[0, 0], work.x[0, 1], work.v[0, 0], work.v[0, 1], system.radius, system.small)
            crossing = first_crossing(work.stage[7], min(start, level * (1.0 - LEVEL_TOLERANCE)), level)
            if crossing < EARLY_CROSSING and run[HELD] == 0.0:
                note_stick(record, began, run[TIME])
                return SOLVED, SLIDING
            if EARLY_CROSSING <= crossing < 1.0 - EARLY_CROSSING:
                run[LENGTH] = h * crossing
                continue
        commit(work, record, h, contact, 0.0, 1.0)
        run[HELD] = 0.0
        if contact == CREEPING and work.stage[7, STAGES - 1] > level * (1.0 - LEVEL_TOLERANCE):
            note_stick(record, began, run[TIME])
            return SOLVED, SLIDING
        adapt(work, h, factor)
    if contact == CREEPING:
        note_stick(record, began, run[TIME])
    return SOLVED, contact
