"""Contact phase of sliding, from its onset at rest or from any speed, until it is about to stop."""

from __future__ import annotations

from math import atan2, inf, log, sqrt

from reference.solver.collocation import STAGES
from reference.solver.compiled import compiled
from reference.solver.contact.friction import (
    coefficient_slope,
    kinetic_coefficient,
    rising_rate,
    slip_direction_cosines,
    squared_sliding_speed,
    static_limit,
)
from reference.solver.contact.platform import acceleration_along, load_in_state, rest_excess
from reference.solver.contact.stop_arc import direction_at_stop, squared_absolute_acceleration
from reference.solver.events import locate_level_crossing
from reference.solver.ground import ground_at
from reference.solver.peaks import update_peak_by_limit
from reference.solver.polynomial import NODES_ROW
from reference.solver.rows import Row, broadcast_like, put, row, row_minimum
from reference.solver.step_control import (
    ERROR_ORDER,
    MAX_LENGTH_FACTOR,
    MIN_STEP,
    begin_from_state,
    begin_with_acceleration,
    guess_from_last_step,
    propose_plain_length,
)
from reference.solver.system import (
    CREEPING,
    PLATFORM,
    REGULARIZED,
    REST,
    SLIDING,
    SOLVED,
    UNSOLVED,
    Load,
    RunSettings,
    System,
)
from reference.solver.work import SQUARED_SPEED, VELOCITY, Workspace

# "Period" below is RunSettings.period, the time in which forces change.
# The first step of a slide from rest is at most this number of periods times the 7th root of the tolerance
MAX_FIRST_STEP = 0.57
CAUTIOUS_GROWTH = 2.0  # largest ratio of the next step to the present one if the present one had to be shortened
# A slide goes on in stretched time (dt = speed dtau), which resolves its turn, if it would stop in STOP_WITHIN_STEPS
# steps or STOP_WITHIN_TIME periods, and until then the upper bodies' fastest vibration turns at most MAX_CHAIN_ANGLE.
STOP_WITHIN_STEPS = 1.5  # a slide that would stop within so many steps goes on in stretched time (dt = speed dtau)
STOP_WITHIN_TIME = 0.05  # a slide that would stop within so many periods goes on in stretched time (dt = speed dtau)
MAX_CHAIN_ANGLE = 0.5  # rad; time is not stretched if the upper bodies' fastest vibration moves further until the stop
# Longest step as share of the time to the stop: a longer one would end where the slip direction turns fast
MAX_WAY_TO_STOP = 0.55
# Smallest cosine of the angle between velocities at two successive stages: below it the step is not smooth, and fails
MIN_TURN_COSINE = 0.3
LEVEL_TOLERANCE = 1e-9  # relative distance of squared speed from v_reg^2, creep's limit, at which a slide becomes creep
NEAR_LEVEL_FACTOR = 1.25  # creep is looked for if the squared speed at a stage is below this multiple of v_reg^2
# A slide slower than this share of (friction deceleration * step length) aligns with the force within the step
STIFF_SPEED_FRACTION = 0.03
# Share of the driving acceleration (link, ground) to which a slide's smaller first guess is raised, for a direction
MIN_ACCELERATION_FRACTION = 1e-12
# Largest share by which the squared drive may exceed the squared friction limit while a slide need not begin yet
BARELY_SLIPPING_EXCESS = 1e-4
# A slide from rest that cannot begin with a step of NEGLIGIBLE_STEP periods, or NEGLIGIBLE_RESPONSE times the time in
# which friction responds to speed, moves nothing: rest replaces it for NEGLIGIBLE_HOLD periods. A slide that slows to
# v_reg, where creep begins, within the share NEGLIGIBLE_STEP of a step creeps from the start of this step.
NEGLIGIBLE_STEP = 1e-6  # rest replaces a slide that fails in a step of fewer periods; also the share of a step, above
NEGLIGIBLE_RESPONSE = 1e-3  # rest replaces a slide that fails in a step below this share of friction's response time
NEGLIGIBLE_HOLD = 10.0 * NEGLIGIBLE_STEP  # periods of rest that replace a slide which moves nothing
MAX_LENGTH_RATIO = 3.0  # a step shorter than 1 / MAX_LENGTH_RATIO of the last one takes no first guess from that


@compiled
def squared_speed_in_state(system: System, work: Workspace) -> float:
    """Return the platform's squared sliding speed at the present position work.x and velocity work.v, m^2/s^2."""
    square: float = squared_sliding_speed(system, work.x[0, 0], work.x[0, 1], work.v[0, 0], work.v[0, 1])
    return square


@compiled
def begin_sliding(system: System, work: Workspace, settings: RunSettings) -> None:
    """Prepare a phase of sliding; from rest, find the direction and the acceleration just after the onset."""
    begin_from_state(system, work, SLIDING)
    work.max_growth = MAX_LENGTH_FACTOR
    work.squared_start_speed = squared_speed_in_state(system, work)
    if work.squared_start_speed > 0.0:
        return
    work.length = min(work.length, MAX_FIRST_STEP * settings.period * settings.tolerance ** (1.0 / ERROR_ORDER))
    ground = ground_at(system, work, work.time)
    load = load_in_state(system, work, ground)
    _, reaction = rest_excess(system, load)
    gx, gy = load.fx - reaction * load.px / system.radius, load.fy - reaction * load.py / system.radius
    work.angle = direction_at_stop(system, load, atan2(gy, gx), 0.0)
    if settings.cutoff == 0.0:
        update_peak_by_limit(work, PLATFORM, squared_absolute_acceleration(system, load, work.angle, 1.0))
    ex, ey = slip_direction_cosines(work.angle, system.axes)
    ax, ay, _, _ = acceleration_along(system, load, 0.0, ex, ey)
    begin_with_acceleration(system, work, ground, ax, ay, SLIDING)


@compiled
def propose_sliding_length(system: System, work: Workspace, settings: RunSettings) -> float:
    """Return the length of the next step, s; 0 if the slide is so near its stop that near_stop.py takes over."""
    # Close to a stop the direction of slip turns like a power of the speed (T6 of docs/theory.md), which no polynomial
    # in time resolves. So a slide that would stop within a step or two goes on in stretched time (dt = v dtau), unless
    # the chain would vibrate in the time left: stretched time solves the chain by iteration. A step of a slide that
    # stops later ends well before its stop; without MAX_WAY_TO_STOP a third of the steps in plain time in the built-in
    # scene fig3-I missed the tolerance, up to 300 times over (docs/decisions/0001-stretched-time.md).
    h: float = propose_plain_length(system, work, settings)
    vx, vy = work.v[0, 0], work.v[0, 1]
    speed = sqrt(vx * vx + vy * vy)
    if speed == 0.0:
        return h
    work.angle = atan2(vy, vx)
    braking = -(vx * work.a0[0, 0] + vy * work.a0[0, 1]) / speed
    soon = speed < max(STOP_WITHIN_STEPS * h, STOP_WITHIN_TIME * settings.period) * braking
    if soon and system.fastest * speed <= MAX_CHAIN_ANGLE * braking:
        work.log_speed = log(speed)
        return 0.0
    return min(h, max(MAX_WAY_TO_STOP * time_to_stop(work, speed, braking), MIN_STEP * settings.period))


@compiled
def time_to_stop(work: Workspace, speed: float, braking: float) -> float:
    """Return the time to a slide's stop, s, if its deceleration `braking`, m/s^2, keeps its present rate of change."""
    # With the deceleration b and its rate b', v - b t - b' t^2 / 2 = 0 at the stop. Its first root is
    # 2 v / (b + sqrt(b^2 + 2 v b')), in the form without cancellation; `change` is v b' = -v . a'.
    change = 0.0
    if work.last_length > 0.0:
        for k in range(1, STAGES):
            change -= k * (work.v[0, 0] * work.guess[0, k] + work.v[0, 1] * work.guess[1, k]) / work.last_length
    square = braking * braking + 2.0 * change
    if square < 0.0 or braking + sqrt(square) <= 0.0:
        return inf
    return 2.0 * speed / (braking + sqrt(square))


@compiled
def is_slow(system: System, work: Workspace, h: float) -> bool:
    """Return True if a slide is so slow that its direction aligns with the force within the step."""
    speed = sqrt(work.v[0, 0] ** 2 + work.v[0, 1] ** 2)
    return speed < STIFF_SPEED_FRACTION * h * kinetic_coefficient(system) * system.mass_ratio * system.gravity


@compiled
def guess_slide(system: System, work: Workspace, h: float) -> None:
    """Set the first guess of stage accelerations in a slide: along its direction if slow, else from the last step."""
    if not is_slow(system, work, h):
        guess_from_last_step(work, h)
        return
    nodes = row(NODES_ROW, ())
    ex, ey = slip_direction_cosines(work.angle, system.axes)
    guess_along(system, work, h, broadcast_like(ex, nodes), broadcast_like(ey, nodes))


@compiled
def guess_turning_slide(system: System, work: Workspace, h: float) -> None:
    """
    Set the first guess of a slow slide's stage accelerations, in the directions in which the forces no longer turn it.

    A light platform under a tower turns by hundreds of rad/s where it begins to slide.
    """
    free, ground, angle = work.free, work.ground, work.angle
    for k in range(STAGES):
        load = Load(
            px=work.x[0, 0], py=work.x[0, 1], fx=free[0, k], fy=free[1, k],
            ux=ground[0, k], uy=ground[1, k], uz=ground[2, k], k_t=ground[3, k],
        )  # fmt: skip
        angle = direction_at_stop(system, load, angle, 0.0)
        work.a[0, 0, k], work.a[0, 1, k] = slip_direction_cosines(angle, system.axes)
    guess_along(system, work, h, row(work.a, (0, 0)), row(work.a, (0, 1)))


@compiled
def guess_along(system: System, work: Workspace, h: float, ex: Row, ey: Row) -> None:
    """Set the first guess of a slow slide's stage accelerations, along the directions (ex, ey) at the stages."""
    # Where friction rises steeply with the speed, an iteration that begins at a lower speed than the step's does not
    # leave the steep part. Linearized about the start, friction damps the speed at the rate `damping`. An implicit
    # Euler step of length nodes * h then has the acceleration at the start over 1 + nodes * h * damping.
    nodes, ground = row(NODES_ROW, ()), work.ground
    start = sqrt(work.v[0, 0] ** 2 + work.v[0, 1] ** 2) if system.rate > 0.0 else 0.0
    damping = rising_rate(system, start)
    fx, fy = row(work.free, 0), row(work.free, 1)
    px, py = broadcast_like(work.x[0, 0], nodes), broadcast_like(work.x[0, 1], nodes)
    load = Load(
        px=px, py=py, fx=fx, fy=fy, ux=row(ground, 0), uy=row(ground, 1), uz=row(ground, 2), k_t=row(ground, 3)
    )  # fmt: skip
    ax, ay, _, _ = acceleration_along(system, load, broadcast_like(start, nodes), ex, ey)
    along = max(ax * ex + ay * ey, MIN_ACCELERATION_FRACTION * (abs(fx) + abs(fy)))
    along = along / (1.0 + nodes * (h * damping))
    put(work.a, (0, 0), along * ex)
    put(work.a, (0, 1), along * ey)


@compiled
def turns_too_far(work: Workspace) -> bool:
    """Return True if the velocity turns so far between two stages that the step does not resolve the slide."""
    bx, by = work.v[0, 0], work.v[0, 1]
    for k in range(STAGES):
        vx, vy = work.stage[VELOCITY, k], work.stage[VELOCITY + 1, k]
        if bx * vx + by * vy < MIN_TURN_COSINE * sqrt((bx * bx + by * by) * (vx * vx + vy * vy)):
            return True
        bx, by = vx, vy
    return False


@compiled
def barely_slips(system: System, work: Workspace) -> bool:
    """Return True if the drive exceeds the friction limit by so little that a slide need not begin yet."""
    load = load_in_state(system, work, ground_at(system, work, work.time))
    excess, reaction = rest_excess(system, load)
    return excess <= BARELY_SLIPPING_EXCESS * static_limit(system, load.k_t, reaction) ** 2


@compiled
def recover_failed_slide(system: System, work: Workspace, settings: RunSettings, h: float) -> tuple[int, int]:
    """Return how to go on after a sliding step of length h, s, that failed: SOLVED or UNSOLVED, and the next contact.

    UNSOLVED means to give up. A slide from rest that moves nothing is replaced by rest.
    """
    shortest = NEGLIGIBLE_STEP * settings.period
    if system.rate > 0.0:
        shortest = min(
            shortest, NEGLIGIBLE_RESPONSE / (abs(coefficient_slope(system, 0.0)) * system.mass_ratio * system.gravity)
        )
    if work.v[0, 0] == 0.0 and work.v[0, 1] == 0.0 and h < shortest:
        if not barely_slips(system, work):
            return UNSOLVED, SLIDING
        work.hold_time = NEGLIGIBLE_HOLD * settings.period
        return SOLVED, REST
    work.max_growth = CAUTIOUS_GROWTH
    work.last_length = 0.0 if work.last_length > MAX_LENGTH_RATIO * h else work.last_length
    return SOLVED, SLIDING


@compiled
def limit_step_to_creep(system: System, work: Workspace, h: float) -> tuple[float, int]:
    """Return the length of a step h, s, up to where the slide slows to v_reg, and the next contact state.

    Below v_reg a slide under the regularized law is creep. The length is 0 if that begins at the start of the step.
    """
    if system.law != REGULARIZED:
        return h, SLIDING
    floor2 = (system.v_reg * (1.0 - LEVEL_TOLERANCE)) ** 2
    if row_minimum(row(work.stage, SQUARED_SPEED)) < NEAR_LEVEL_FACTOR * floor2:
        start = max(work.squared_start_speed, floor2 * (1.0 + LEVEL_TOLERANCE))
        slowed = locate_level_crossing(system, work, row(work.stage, SQUARED_SPEED), start, floor2)
        if slowed < NEGLIGIBLE_STEP:
            return 0.0, CREEPING
        if slowed < 1.0 - NEGLIGIBLE_STEP:
            return h * slowed, SLIDING
    return h, CREEPING if work.stage[SQUARED_SPEED, STAGES - 1] < floor2 * (1.0 + LEVEL_TOLERANCE) else SLIDING


@compiled
def adapt_sliding_length(work: Workspace, h: float, factor: float) -> None:
    """Set the length of the next sliding step after one of h, s, for which h * factor would have met the tolerance."""
    if h * factor > work.length or h == work.length:
        work.length = h * min(factor, work.max_growth)
    work.max_growth = MAX_LENGTH_FACTOR
    work.squared_start_speed = work.stage[SQUARED_SPEED, STAGES - 1]
