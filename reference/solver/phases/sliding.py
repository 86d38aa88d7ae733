"""Sliding, from its onset at rest or from any speed, until it is about to stop."""

from __future__ import annotations

from math import atan2, inf, log, sqrt

from reference.solver.collocation import STAGES
from reference.solver.compiled import compiled
from reference.solver.contact.friction import coefficient_slope, heading, rising_rate, sliding_speed2
from reference.solver.contact.load import loaded
from reference.solver.contact.platform import directed, load_in_state, rest_excess
from reference.solver.contact.stop_arc import settled_direction, squared_total
from reference.solver.events import first_crossing
from reference.solver.ground import ground_at
from reference.solver.peaks import take_limit
from reference.solver.polynomial import NODES_ROW
from reference.solver.rows import Row, as_many, lowest, put, row
from reference.solver.step_control import (
    ERROR_ORDER,
    MAX_LENGTH_FACTOR,
    MIN_STEP,
    begin,
    begin_with,
    first_guess,
    plain_length,
)
from reference.solver.system import (
    CREEPING,
    PLATFORM,
    REGULARIZED,
    REST,
    SLIDING,
    SOLVED,
    UNSOLVED,
    Demand,
    Load,
    System,
)
from reference.solver.work import SPEED2, VELOCITY, Work

MAX_FIRST_STEP = 0.57  # of the period (Demand.period): longest first step of a slide at a tolerance of 1 in a step
CAUTIOUS_GROWTH = 2.0  # largest growth of a step that had to be shortened
STOP_WITHIN_STEPS = 1.5  # steps: a slide that would stop within them is followed in stretched time,
STOP_WITHIN_TIME = 0.05  # of the period: or within this time
MAX_WAY_TO_STOP = 0.55  # of the time to the stop: a longer step comes too close to where the direction turns fast
MAX_CHAIN_ANGLE = 0.5  # rad: most that the chain's fastest vibration may turn in the time that is left then
MIN_TURN_COSINE = 0.3  # cosine of the largest turn of the velocity between two stages
LEVEL_TOLERANCE = 1e-9  # of the squared speed: a slide this close to v_reg has come down to it
NEAR_LEVEL_FACTOR = 1.25  # of the squared v_reg: a slide below it may pass v_reg between two stages
# of the friction limit times the step: at a lower speed the direction follows the force
STIFF_SPEED_FRACTION = 0.03
MIN_ACCELERATION_FRACTION = 1e-12  # of the drive: a slide that begins has a direction
BARELY_SLIPPING_EXCESS = 1e-4  # of the squared friction limit: a slide with less excess need not begin yet
NEGLIGIBLE_STEP = 1e-6  # of the period, or of a step: sliding that cannot begin with a step this long moves nothing
# likewise, of the time in which friction that depends on the speed answers to it
NEGLIGIBLE_RESPONSE = 1e-3
NEGLIGIBLE_HOLD = 10.0 * NEGLIGIBLE_STEP  # of the period: rest in place of such sliding
MAX_LENGTH_RATIO = 3.0  # of the step before over one that failed: beyond it the former's polynomial is no guess


@compiled
def speed2(system: System, work: Work) -> float:
    """Squared sliding speed in the state x, v."""
    square: float = sliding_speed2(system, work.x[0, 0], work.x[0, 1], work.v[0, 0], work.v[0, 1])
    return square


@compiled
def begin_sliding(system: System, work: Work, demand: Demand) -> None:
    """The accelerations of the state; at rest the direction of the slide, and its share in the peak."""
    begin(system, work, SLIDING)
    work.growth = MAX_LENGTH_FACTOR
    work.start2 = speed2(system, work)
    if work.start2 > 0.0:
        return
    work.length = min(work.length, MAX_FIRST_STEP * demand.period * demand.tolerance ** (1.0 / ERROR_ORDER))
    ground = ground_at(system, work, work.time)
    load = load_in_state(system, work, ground)
    _, reaction = rest_excess(system, load)
    gx, gy = load.fx - reaction * load.px / system.radius, load.fy - reaction * load.py / system.radius
    work.angle = settled_direction(system, load, atan2(gy, gx), 0.0)
    if demand.cutoff == 0.0:
        take_limit(work, PLATFORM, squared_total(system, load, work.angle, 1.0))
    ex, ey = heading(work.angle, system.axes)
    ax, ay, _, _ = directed(system, load, 0.0, ex, ey)
    begin_with(system, work, ground, ax, ay, SLIDING)


@compiled
def sliding_length(system: System, work: Work, demand: Demand) -> float:
    """Length of the next step, s; 0 where the slide is so near its stop that stretched time begins."""
    h: float = plain_length(system, work, demand)
    vx, vy = work.v[0, 0], work.v[0, 1]
    speed = sqrt(vx * vx + vy * vy)
    if speed == 0.0:
        return h
    work.angle = atan2(vy, vx)
    braking = -(vx * work.a0[0, 0] + vy * work.a0[0, 1]) / speed
    soon = speed < max(STOP_WITHIN_STEPS * h, STOP_WITHIN_TIME * demand.period) * braking
    if soon and system.fastest * speed <= MAX_CHAIN_ANGLE * braking:
        work.log_speed = log(speed)
        return 0.0
    return min(h, max(MAX_WAY_TO_STOP * time_to_stop(work, speed, braking), MIN_STEP * demand.period))


@compiled
def time_to_stop(work: Work, speed: float, braking: float) -> float:
    """Time to the stop, s, if the deceleration, m/s^2, goes on changing as at the end of the step before."""
    change = 0.0
    if work.old_length > 0.0:
        for k in range(1, STAGES):
            change -= k * (work.v[0, 0] * work.guess[0, k] + work.v[0, 1] * work.guess[1, k]) / work.old_length
    square = braking * braking + 2.0 * change
    if square < 0.0 or braking + sqrt(square) <= 0.0:
        return inf
    return 2.0 * speed / (braking + sqrt(square))


@compiled
def is_slow(system: System, work: Work, h: float) -> bool:
    """Whether the direction of the slide follows the force within the step."""
    speed = sqrt(work.v[0, 0] ** 2 + work.v[0, 1] ** 2)
    return speed < STIFF_SPEED_FRACTION * h * system.friction * system.mass_ratio * system.gravity


@compiled
def guess_slide(system: System, work: Work, h: float) -> None:
    """Stage accelerations to start with; of a slow slide, what the drive leaves along the direction of its start."""
    if not is_slow(system, work, h):
        first_guess(work, h)
        return
    nodes = row(NODES_ROW, ())
    ex, ey = heading(work.angle, system.axes)
    guess_along(system, work, h, as_many(ex, nodes), as_many(ey, nodes))


@compiled
def guess_turning_slide(system: System, work: Work, h: float) -> None:
    """
    Stage accelerations to start with, along the directions in which the drive at the stages does not turn a slow slide.

    A light platform under a tower turns by hundreds of rad/s.
    """
    free, ground, angle = work.free, work.ground, work.angle
    for k in range(STAGES):
        load = Load(
            work.x[0, 0], work.x[0, 1], free[0, k], free[1, k], ground[0, k], ground[1, k], ground[2, k], ground[3, k]
        )  # fmt: skip
        angle = settled_direction(system, load, angle, 0.0)
        work.a[0, 0, k], work.a[0, 1, k] = heading(angle, system.axes)
    guess_along(system, work, h, row(work.a, (0, 0)), row(work.a, (0, 1)))


@compiled
def guess_along(system: System, work: Work, h: float, ex: Row, ey: Row) -> None:
    """
    Stage accelerations of a slow slide in the directions (ex, ey): what the drive leaves along them.

    Where friction rises steeply with the speed, that is what a step of the linearized law makes of it: an iteration
    that begins at a lower speed than the step's does not leave the steep part.
    """
    nodes, ground = row(NODES_ROW, ()), work.ground
    start = sqrt(work.v[0, 0] ** 2 + work.v[0, 1] ** 2) if system.rate > 0.0 else 0.0
    damping = rising_rate(system, start)
    fx, fy = row(work.free, 0), row(work.free, 1)
    px, py = as_many(work.x[0, 0], nodes), as_many(work.x[0, 1], nodes)
    load = Load(px, py, fx, fy, row(ground, 0), row(ground, 1), row(ground, 2), row(ground, 3))
    ax, ay, _, _ = directed(system, load, as_many(start, nodes), ex, ey)
    along = max(ax * ex + ay * ey, MIN_ACCELERATION_FRACTION * (abs(fx) + abs(fy)))
    along = along / (1.0 + nodes * (h * damping))
    put(work.a, (0, 0), along * ex)
    put(work.a, (0, 1), along * ey)


@compiled
def turns_too_far(work: Work) -> bool:
    """Whether the velocity turns too far between two stages to be a smooth slide."""
    bx, by = work.v[0, 0], work.v[0, 1]
    for k in range(STAGES):
        vx, vy = work.stage[VELOCITY, k], work.stage[VELOCITY + 1, k]
        if bx * vx + by * vy < MIN_TURN_COSINE * sqrt((bx * bx + by * by) * (vx * vx + vy * vy)):
            return True
        bx, by = vx, vy
    return False


@compiled
def barely_slips(system: System, work: Work) -> bool:
    """Whether the drive exceeds the friction limit by so little that a slide need not begin yet."""
    load = load_in_state(system, work, ground_at(system, work, work.time))
    excess, reaction = rest_excess(system, load)
    return excess <= BARELY_SLIPPING_EXCESS * loaded(system, load.k_t, reaction, system.friction * reaction) ** 2


@compiled
def after_failed_slide(system: System, work: Work, demand: Demand, h: float) -> tuple[int, int]:
    """(SOLVED to go on, or UNSOLVED; what the contact does then) after a step that failed."""
    shortest = NEGLIGIBLE_STEP * demand.period
    if system.rate > 0.0:
        shortest = min(
            shortest, NEGLIGIBLE_RESPONSE / (abs(coefficient_slope(system, 0.0)) * system.mass_ratio * system.gravity)
        )
    if work.v[0, 0] == 0.0 and work.v[0, 1] == 0.0 and h < shortest:
        if not barely_slips(system, work):
            return UNSOLVED, SLIDING
        work.held = NEGLIGIBLE_HOLD * demand.period
        return SOLVED, REST
    work.growth = CAUTIOUS_GROWTH
    work.old_length = 0.0 if work.old_length > MAX_LENGTH_RATIO * h else work.old_length
    return SOLVED, SLIDING


@compiled
def slowing_within(system: System, work: Work, h: float) -> tuple[float, int]:
    """Length of the step up to where the slide comes down to v_reg, 0 at its start; what the contact does then."""
    if system.law != REGULARIZED:
        return h, SLIDING
    floor2 = (system.v_reg * (1.0 - LEVEL_TOLERANCE)) ** 2
    if lowest(row(work.stage, SPEED2)) < NEAR_LEVEL_FACTOR * floor2:
        start = max(work.start2, floor2 * (1.0 + LEVEL_TOLERANCE))
        slowed = first_crossing(system, work, row(work.stage, SPEED2), start, floor2)
        if slowed < NEGLIGIBLE_STEP:
            return 0.0, CREEPING
        if slowed < 1.0 - NEGLIGIBLE_STEP:
            return h * slowed, SLIDING
    return h, CREEPING if work.stage[SPEED2, STAGES - 1] < floor2 * (1.0 + LEVEL_TOLERANCE) else SLIDING


@compiled
def adapt_slide(work: Work, h: float, factor: float) -> None:
    """The length of the next step after one that was made."""
    if h * factor > work.length or h == work.length:
        work.length = h * min(factor, work.growth)
    work.growth = MAX_LENGTH_FACTOR
    work.start2 = work.stage[SPEED2, STAGES - 1]
