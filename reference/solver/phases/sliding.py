"""Sliding, from its onset at rest or from any speed, until it is about to stop."""

from __future__ import annotations

from math import atan2, log, sqrt

from reference.solver.chain import eliminate_chain, load_chain
from reference.solver.collocation import STAGES
from reference.solver.compiled import compiled, inlined
from reference.solver.contact.friction import heading, sliding_speed2
from reference.solver.contact.platform import directed, rest_excess
from reference.solver.contact.stop_arc import settled_direction, squared_total
from reference.solver.events import first_crossing, lowest
from reference.solver.ground import ground_at, ground_at_stages
from reference.solver.step_control import (
    MAX_LENGTH_FACTOR,
    MIN_STEP,
    NEWTON_FRACTION,
    begin,
    begin_with,
    commit,
    drive,
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
    ANGLE,
    CREEPING,
    HELD,
    LENGTH,
    LOG_SPEED,
    OLD_LENGTH,
    REGULARIZED,
    REST,
    SLIDING,
    SOLVED,
    STEP_LIMIT,
    STOPPING,
    TIME,
    UNSOLVED,
    Array,
    Demand,
    Record,
    System,
    Work,
)

MAX_FIRST_STEP = 0.2  # of the period (Demand.period): longest first step of a slide
CAUTIOUS_GROWTH = 2.0  # largest growth of a step that had to be shortened
STOP_WITHIN_STEPS = 1.5  # steps: a slide that would stop within them is followed in stretched time,
STOP_WITHIN_TIME = 0.05  # of the period: or within this time
MAX_CHAIN_ANGLE = 0.5  # rad: most that the chain's fastest vibration may turn in the time that is left then
MIN_TURN_COSINE = 0.3  # cosine of the largest turn of the velocity between two stages
LEVEL_TOLERANCE = 1e-9  # of the squared speed: a slide this close to v_reg has come down to it
NEAR_LEVEL_FACTOR = 1.25  # of the squared v_reg: a slide below it may pass v_reg between two stages
# of the friction limit times the step: at a lower speed the direction follows the force
STIFF_SPEED_FRACTION = 0.03
MIN_ACCELERATION_FRACTION = 1e-12  # of the drive: a slide that begins has a direction
BARELY_SLIPPING_EXCESS = 1e-4  # of the squared friction limit: a slide with less excess need not begin yet
NEGLIGIBLE_STEP = 1e-6  # of the period, or of a step: sliding that cannot begin with a step this long moves nothing


@compiled
def speed2(system: System, work: Work) -> float:
    """Squared sliding speed in the state x, v."""
    return sliding_speed2(work.x[0, 0], work.x[0, 1], work.v[0, 0], work.v[0, 1], system.radius, system.small)


@compiled
def guess_onset(system: System, phase: Array, work: Work, h: float) -> None:
    """Stage accelerations of a slide that begins: what the drive leaves along the direction of the onset."""
    ground_at_stages(system, phase, work.run[TIME], h, work)
    eliminate_chain(system, work, h)
    load_chain(system, work, h)
    angle = work.run[ANGLE]
    ex, ey = heading(angle, system.axes)
    for k in range(STAGES):
        ax, ay, _, _ = directed(
            system, work.x[0, 0], work.x[0, 1], work.free[0, k], work.free[1, k],
            work.ground[0, k], work.ground[1, k], system.gravity + work.ground[2, k], 0.0, ex, ey,
        )  # fmt: skip
        along = max(ax * ex + ay * ey, MIN_ACCELERATION_FRACTION * (abs(work.free[0, k]) + abs(work.free[1, k])))
        work.a[0, 0, k] = along * ex
        work.a[0, 1, k] = along * ey


@compiled
def begin_slide(system: System, phase: Array, work: Work, demand: Demand) -> None:
    """At rest: the direction of the slide, its acceleration at once, and its share in the peak."""
    ux, uy, uz = ground_at(system, phase, work.run[TIME])
    fx, fy = drive(system, work, ux, uy)
    px, py = work.x[0, 0], work.x[0, 1]
    reaction = system.mass_ratio * (system.gravity + uz)
    gx, gy = fx - reaction * px / system.radius, fy - reaction * py / system.radius
    angle = settled_direction(system, px, py, fx, fy, ux, uy, uz, atan2(gy, gx), 0.0)
    if demand.cutoff == 0.0:
        onset = squared_total(system, px, py, fx, fy, ux, uy, uz, angle)
        if onset > work.best[0]:
            work.best[0] = onset
            work.reading_error[0] = 0.0
    work.run[ANGLE] = angle
    ax, ay, _, _ = directed(system, px, py, fx, fy, ux, uy, system.gravity + uz, 0.0, *heading(angle, system.axes))
    begin_with(system, work, ax, ay, ux, uy, uz, False)


@compiled
def barely_slips(system: System, phase: Array, work: Work) -> bool:
    """Whether the drive exceeds the friction limit by so little that a slide need not begin yet."""
    ux, uy, uz = ground_at(system, phase, work.run[TIME])
    fx, fy = drive(system, work, ux, uy)
    px, py = work.x[0, 0], work.x[0, 1]
    excess, reaction = rest_excess(system, px, py, fx, fy, ux, uy, system.gravity + uz)
    return excess <= BARELY_SLIPPING_EXCESS * (system.friction * reaction) ** 2


@compiled
def turns_too_far(work: Work) -> bool:
    """Whether the velocity turns too far between two stages to be a smooth slide."""
    bx, by = work.v[0, 0], work.v[0, 1]
    for k in range(STAGES):
        vx, vy = work.stage[2, k], work.stage[3, k]
        if bx * vx + by * vy < MIN_TURN_COSINE * sqrt((bx * bx + by * by) * (vx * vx + vy * vy)):
            return True
        bx, by = vx, vy
    return False


@inlined
def sliding_phase(system: System, phase: Array, work: Work, demand: Demand, record: Record) -> tuple[int, int]:
    """(how it went, what the contact does next); see run.py."""
    run = work.run
    begin(system, phase, work, SLIDING)
    start2 = speed2(system, work)
    if start2 == 0.0:
        begin_slide(system, phase, work, demand)
        run[LENGTH] = min(run[LENGTH], MAX_FIRST_STEP * demand.period)
    growth = MAX_LENGTH_FACTOR
    floor2 = (system.v_reg * (1.0 - LEVEL_TOLERANCE)) ** 2 if system.law == REGULARIZED else 0.0
    counted2 = demand.cutoff * demand.cutoff
    while remaining(system, work, demand) > 0.0:
        if not next_step(work, demand):
            return STEP_LIMIT, SLIDING
        h = min(run[LENGTH], unbroken(system, work, demand))
        vx, vy = work.v[0, 0], work.v[0, 1]
        speed = sqrt(vx * vx + vy * vy)
        braking = -(vx * work.a0[0, 0] + vy * work.a0[0, 1]) / speed if speed > 0.0 else 0.0
        if braking > 0.0 and speed < max(STOP_WITHIN_STEPS * h, STOP_WITHIN_TIME * demand.period) * braking:
            if system.fastest * speed <= MAX_CHAIN_ANGLE * braking:
                run[ANGLE] = atan2(vy, vx)
                run[LOG_SPEED] = log(speed)
                return SOLVED, STOPPING
            h = min(h, max(0.5 * speed / braking, MIN_STEP * demand.period))
        if speed < STIFF_SPEED_FRACTION * h * system.friction * system.mass_ratio * system.gravity:
            if speed > 0.0:
                run[ANGLE] = atan2(vy, vx)
            guess_onset(system, phase, work, h)
        else:
            first_guess(work, h)
        code = moving_step(
            system, phase, work, SLIDING, run[TIME], h, NEWTON_FRACTION * demand.tolerance * work.scale[0]
        )
        if code == SOLVED and turns_too_far(work):
            code = UNSOLVED
        if code != SOLVED:
            if speed == 0.0 and h < NEGLIGIBLE_STEP * demand.period:
                if not barely_slips(system, phase, work):
                    return UNSOLVED, SLIDING
                run[HELD] = 10.0 * NEGLIGIBLE_STEP * demand.period
                return SOLVED, REST
            if too_short(demand, h, code):
                return code, SLIDING
            run[LENGTH] = 0.3 * h
            growth = CAUTIOUS_GROWTH
            run[OLD_LENGTH] = 0.0 if run[OLD_LENGTH] > 3.0 * h else run[OLD_LENGTH]
            continue
        error = step_error(work, demand.tolerance)
        factor = length_factor(error, demand.tolerance)
        if not error <= demand.tolerance:
            if not shortened(work, demand, h, factor):
                return UNSOLVED, SLIDING
            continue
        if lowest(work.stage[7]) < NEAR_LEVEL_FACTOR * floor2:
            slowed = first_crossing(work.stage[7], max(start2, floor2 * (1.0 + 1e-9)), floor2)
            if slowed < NEGLIGIBLE_STEP:
                return SOLVED, CREEPING
            if slowed < 1.0 - NEGLIGIBLE_STEP:
                run[LENGTH] = h * slowed
                continue
        low, high = 0.0, 1.0
        end2 = work.stage[7, STAGES - 1]
        if start2 < counted2 and end2 < counted2:
            high = 0.0
        elif start2 < counted2:
            low = min(1.0, first_crossing(work.stage[7], start2, counted2))
        elif end2 < counted2:
            high = min(1.0, first_crossing(work.stage[7], start2, counted2))
        commit(work, record, h, SLIDING, low, high)
        start2 = end2
        if end2 < floor2 * (1.0 + LEVEL_TOLERANCE):
            return SOLVED, CREEPING
        if h * factor > run[LENGTH] or h == run[LENGTH]:
            run[LENGTH] = h * min(factor, growth)
        growth = MAX_LENGTH_FACTOR
    return SOLVED, SLIDING
