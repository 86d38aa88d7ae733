"""The approach to a stop in stretched time (near_stop.py): into rest or creep, or past the stop and on."""

from __future__ import annotations

from math import exp, log, pi

import numpy as np

from reference.solver.chain import chain_acceleration
from reference.solver.collocation import STAGES
from reference.solver.compiled import compiled, inlined
from reference.solver.contact.friction import heading
from reference.solver.contact.platform import directed, rest_excess
from reference.solver.contact.stop_arc import arc_peak
from reference.solver.events import first_crossing, lowest
from reference.solver.ground import ground_at
from reference.solver.near_stop import ACROSS, ALONG, CLOCK, DIRECTION, LOG_RATIO, SIGMA, near_stop_step
from reference.solver.step_control import (
    FATAL_STEP,
    MIN_STEP,
    begin_with,
    commit,
    drive,
    length_factor,
    next_break,
    next_step,
)
from reference.solver.steps import step_error
from reference.solver.system import (
    ANGLE,
    CREEPING,
    LEFT,
    LENGTH,
    LOG_SPEED,
    OPEN,
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

MAX_CHAIN_ANGLE = 0.7  # rad: most that the chain's fastest vibration may turn during one step
# of the length of a plain step: time scale at which a slide that gathers speed leaves stretched time,
LEAVING_TIME_FRACTION = 0.3
MIN_LEAVING_TIME = 0.05  # of the period (Demand.period): and its lower bound
MAX_STOPPED_SPEED = 1e-5  # of the loading's velocity: below it a platform that friction can hold has stopped
MIN_FOLLOWED_SPEED = 1e-10  # of the loading's velocity: a stop whose arc decides the peak is followed down to it
DECISIVE_ARC_FRACTION = 0.97  # of the peak so far: an arc that stays below it decides nothing
LEVEL_TOLERANCE = 1e-9  # of ln v: a slide this close to v_reg has come down to it
MAX_FROZEN_TIME = 1e-4  # of the period: time left at a stop within which forces count as constant
MAX_STRAIGHT_TURN = 1e-6  # of the friction: a slide with a smaller sideways acceleration turns back on its own line
# of the loading's velocity: below it a straight slide that friction cannot hold is at its turning point
MAX_TURNING_POINT_SPEED = 1e-12
NEWTON_FRACTION = 1e-3  # of the tolerance: change of the angle at which Newton's method ends
# Time and place are integrals of v and v^2 over tau. Where forces stay constant no acceleration shows their error. With
# these bounds on the change of ln v in one step it stays below 1e-8 of what is left of the slide at its start.
MAX_FIRST_LOG_SPEED_CHANGE = 2.0  # in the first step
LOG_SPEED_CHANGE_GROWTH = 0.7  # growth of the bound per unit by which ln v has fallen since


@compiled
def ratio_in(system: System, work: Work, phase: Array) -> tuple[float, float]:
    """Fill a0 for the state and the direction of the run; log of full over horizontal speed, acceleration's size."""
    run = work.run
    ux, uy, uz = ground_at(system, phase, run[TIME])
    chain_acceleration(system, work, ux, uy)
    fx, fy = drive(system, work, ux, uy)
    ax, ay, _, ratio = directed(
        system, work.x[0, 0], work.x[0, 1], fx, fy, ux, uy, system.gravity + uz,
        exp(run[LOG_SPEED]), *heading(run[ANGLE], system.axes),
    )  # fmt: skip
    begin_with(system, work, ax, ay, ux, uy, uz, False)
    return log(ratio), (ax * ax + ay * ay) ** 0.5


@compiled
def has_stopped(system: System, phase: Array, work: Work, demand: Demand) -> int:
    """
    REST or SLIDING (a straight slide turns back) if the motion is at a stop, STOPPING if it goes on.

    Leaves the time that is left of the slide at its deceleration in run[LEFT]: rest is entered so much early.
    """
    run = work.run
    run[LEFT] = 0.0
    unit = demand.unit * demand.period / (2.0 * pi)
    speed = exp(run[LOG_SPEED])
    if speed > MAX_STOPPED_SPEED * unit:
        return STOPPING
    along, across = work.turning[ALONG, STAGES - 1], work.turning[ACROSS, STAGES - 1]
    ux, uy, uz = ground_at(system, phase, run[TIME])
    fx, fy = drive(system, work, ux, uy)
    px, py = work.x[0, 0], work.x[0, 1]
    excess, reaction = rest_excess(system, px, py, fx, fy, ux, uy, system.gravity + uz)
    if excess > 0.0:
        straight = abs(across) <= MAX_STRAIGHT_TURN * system.friction * reaction
        return SLIDING if straight and along < 0.0 and speed < MAX_TURNING_POINT_SPEED * unit else STOPPING
    if along < 0.0:
        run[LEFT] = -speed / along
    if along >= 0.0 or speed > MAX_FROZEN_TIME * demand.period * -along:
        return STOPPING if speed > 1e-200 else REST
    if demand.cutoff == 0.0:
        arc = arc_peak(system, px, py, fx, fy, ux, uy, uz, run[ANGLE])
        if speed > MIN_FOLLOWED_SPEED * unit and arc > DECISIVE_ARC_FRACTION * DECISIVE_ARC_FRACTION * work.best[0]:
            return STOPPING
        if arc > work.best[0]:
            work.best[0] = arc
            work.reading_error[0] = 0.0
    elif speed > demand.cutoff:
        return STOPPING
    return REST


@compiled
def longest(work: Work, entered: float, axes: int) -> float:
    """The longest step in tau that keeps time and place, `entered` being ln v where the phase began."""
    ex, ey = heading(work.run[ANGLE], axes)
    along = work.a0[0, 0] * ex + work.a0[0, 1] * ey
    change = MAX_FIRST_LOG_SPEED_CHANGE + LOG_SPEED_CHANGE_GROWTH * max(0.0, entered - work.run[LOG_SPEED])
    if along > 0.0:  # the end of the step counts, not its start
        change /= 1.0 + LOG_SPEED_CHANGE_GROWTH
    return change / max(abs(along), 1e-300)


@inlined
def stopping_phase(system: System, phase: Array, work: Work, demand: Demand, record: Record) -> tuple[int, int]:
    """(how it went, what the contact does next); see run.py."""
    run = work.run
    log_ratio, size = ratio_in(system, work, phase)
    h = 0.5 / max(size, 1e-3 * demand.unit)
    regularized = system.law == REGULARIZED
    level = log(system.v_reg) if regularized else 0.0
    counted = log(demand.cutoff) if demand.cutoff > 0.0 else -1e300
    values = np.empty(STAGES)
    entered = run[LOG_SPEED]
    while True:
        if not next_step(work, demand):
            return STEP_LIMIT, STOPPING
        h = min(h, longest(work, entered, system.axes))
        if system.fastest > 0.0:
            h = min(h, MAX_CHAIN_ANGLE / (system.fastest * exp(run[LOG_SPEED])))
        if h * exp(run[LOG_SPEED]) < MIN_STEP * demand.period * 1e-3 * exp(min(0.0, run[LOG_SPEED])):
            return UNSOLVED, STOPPING
        code = near_stop_step(
            system, phase, work, run[TIME], h, run[ANGLE], run[LOG_SPEED], NEWTON_FRACTION * demand.tolerance
        )
        if code == SOLVED and lowest(work.stage[6]) <= 0.0:
            code = OPEN
        if code != SOLVED:
            if code != UNSOLVED and h * exp(run[LOG_SPEED]) < FATAL_STEP * demand.period:
                return code, STOPPING
            h *= 0.3
            continue
        error = step_error(work, demand.tolerance)
        factor = length_factor(error, demand.tolerance)
        if not error <= demand.tolerance:
            h *= min(0.7, factor)
            continue
        end = work.turning[CLOCK, STAGES - 1]
        limit = next_break(system, work, demand)
        if end > limit + MIN_STEP * demand.period:
            portion = first_crossing(work.turning[CLOCK], run[TIME], limit)
            if portion < 1.0 - 1e-9:
                h *= portion
                continue
        for k in range(STAGES):
            values[k] = work.turning[SIGMA, k] + work.turning[LOG_RATIO, k]
        start_value = run[LOG_SPEED] + log_ratio
        if regularized and lowest(values) < level - LEVEL_TOLERANCE:
            portion = first_crossing(values, max(start_value, level), level - 0.5 * LEVEL_TOLERANCE)
            if portion < 1e-9:
                return SOLVED, CREEPING
            if portion < 1.0 - 1e-9:
                h *= portion
                continue
        low, high = 0.0, 1.0
        if start_value < counted and values[STAGES - 1] < counted:
            high = 0.0
        elif start_value < counted:
            low = min(1.0, first_crossing(values, start_value, counted))
        elif values[STAGES - 1] < counted:
            high = min(1.0, first_crossing(values, start_value, counted))
        commit(work, record, h, STOPPING, low, high)
        run[TIME] = work.turning[CLOCK, STAGES - 1]
        run[ANGLE] = work.turning[DIRECTION, STAGES - 1]
        run[LOG_SPEED] = work.turning[SIGMA, STAGES - 1]
        log_ratio = work.turning[LOG_RATIO, STAGES - 1]
        h *= factor
        if run[TIME] >= system.duration - 10.0 * MIN_STEP * demand.period:
            return SOLVED, STOPPING
        if regularized:
            if values[STAGES - 1] <= level + LEVEL_TOLERANCE:
                return SOLVED, CREEPING
        else:
            next_contact = has_stopped(system, phase, work, demand)
            if next_contact != STOPPING:
                work.v[0, 0] = work.v[0, 1] = 0.0
                return SOLVED, next_contact
        along = work.turning[ALONG, STAGES - 1]
        if (
            along > 0.0
            and exp(run[LOG_SPEED]) > max(LEAVING_TIME_FRACTION * run[LENGTH], MIN_LEAVING_TIME * demand.period) * along
        ):
            run[LENGTH] = min(run[LENGTH], exp(run[LOG_SPEED]) / along)
            return SOLVED, SLIDING
