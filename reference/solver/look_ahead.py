"""
Looking ahead: a cheap, rough run from the present state to the end shows whether a larger peak can still follow.

Its constant steps are of second order: positions move by half a step, forces change the velocities, positions move by
the other half (Strang's splitting). Friction acts at the end of the step, so a platform whose velocity it can remove
within the step comes to rest. Forces and friction are those of the accurate run. A value counts as large if it reaches
LARGE_FRACTION of the largest so far. The direction of a slide turns fast near its stop; there the platform's
acceleration counts as the largest that any direction on the way allows, with a margin.
"""

from __future__ import annotations

from math import cos, inf, sin, sqrt

from reference.solver.chain import set_chain_acceleration
from reference.solver.compiled import compiled
from reference.solver.contact.friction import (
    coefficient,
    kinetic_coefficient,
    squared_sliding_speed,
    static_limit,
    viscous_factor,
)
from reference.solver.contact.load import scale_by_load
from reference.solver.contact.platform import load_in_state, rest_excess, slip_factor, solve_platform_acceleration
from reference.solver.ground import next_ground, set_harmonic_step_factors, set_harmonics
from reference.solver.steps import vertical_acceleration
from reference.solver.system import (
    CREEPING,
    LUBRICATED,
    LUBRICATED_SLIDING,
    SET_VALUED,
    SLIDING,
    Ground,
    Load,
    RunSettings,
    System,
)
from reference.solver.work import Workspace

STEPS_PER_PERIOD = 25.0  # number of steps of a rough run per RunSettings.period, the time in which forces change
# Largest number of rough steps that looking ahead may take, per accurate step so far: 50 cost about as much as one
MAX_STEPS_PER_STEP = 50.0
MAX_CHAIN_ANGLE = 0.5  # rad, largest phase angle of the upper bodies' fastest vibration in one rough step
# If a rough run stays below this share of the largest acceleration so far, the accurate run is taken to stay below it
LARGE_FRACTION = 0.85
# Relative distance from the rim, the end of the travel, liftoff or Painleve's paradox below which a rough run is no
# evidence, so that the accurate run goes on
MIN_DISTANCE_TO_SINGULARITY = 0.1
MAX_SLOW_STEPS = 2.0  # a slide counts as near its stop if friction would stop it within this number of rough steps
DIRECTION_MARGIN = 0.35  # rad, uncertainty of a slide's direction near its stop in a rough run
MIN_SURE_DRIVE = 0.5  # frictionless acceleration / friction limit: if less, a rough run admits all slip directions
MAX_HELD_DRIVE = 0.8  # largest ratio of squared drive to squared friction limit at which friction surely holds
LOOK_AHEAD_DELAY = 0.25  # share of RunSettings.period from the last value >= 0.9 of the peak to a rough run to the end


@compiled
def end_run_early(system: System, work: Workspace, settings: RunSettings) -> None:
    """End the run if a rough run to its end shows that no larger peak follows; else set when to try this again."""
    # The run looks ahead a quarter of a period after its last large value, and only if the rough run takes at most
    # fifty times as many steps as the accurate ones so far: then both cost about the same. If the rough run finds a
    # large value, the next look follows that one, so that all rough runs together cover the motion at most once. The
    # measurements are in docs/reference.md, "Early end": no result of 10 000 random scenes and records changed.
    if not settings.early:  # the end of the run is given
        work.end = work.time
        return
    work.look_time = work.last_large + LOOK_AHEAD_DELAY * settings.period
    h = rough_step_length(system, settings)
    if work.time > work.look_time and system.duration - work.time <= MAX_STEPS_PER_STEP * h * work.steps:
        comes = instant_of_next_large(system, work, h)
        work.look_time = comes + LOOK_AHEAD_DELAY * settings.period
        if comes == inf:
            work.end = work.time


@compiled
def rough_step_length(system: System, settings: RunSettings) -> float:
    """Return the step length, s, of a rough run, which shows whether the accurate run can end early."""
    h = settings.period / STEPS_PER_PERIOD
    if system.fastest > 0.0:
        h = min(h, MAX_CHAIN_ANGLE / system.fastest)
    return h


@compiled
def instant_of_next_large(system: System, work: Workspace, h: float) -> float:
    """Return the time, s, at which a rough run may reach LARGE_FRACTION of the largest acceleration or displacement.

    It is infinite if the run does not. The run goes from the present state to the end of the motion in steps h, s.
    """
    bodies = work.x.shape[0]
    for i in range(bodies):  # x1, v1 keep the state here, as the next accurate step sets them anew
        for axis in range(2):
            work.x1[i, axis], work.v1[i, axis] = work.x[i, axis], work.v[i, axis]
    time, large = work.time, False
    set_harmonics(system, work, time + 0.5 * h)
    set_harmonic_step_factors(system, work, h)
    while time < system.duration and not large:
        large = make_rough_step(system, work, time, h)
        time += h
    for i in range(bodies):
        for axis in range(2):
            work.x[i, axis], work.v[i, axis] = work.x1[i, axis], work.v1[i, axis]
    return time if large else inf


@compiled
def make_rough_step(system: System, work: Workspace, time: float, h: float) -> bool:
    """Make one rough step of length h, s; return True if it may reach LARGE_FRACTION of a largest value so far."""
    move_at_velocity(work, 0.5 * h)
    ground = next_ground(system, work, time + 0.5 * h)
    set_chain_acceleration(system, work, ground)
    vx, vy = work.v[0, 0], work.v[0, 1]
    largest, far = push_platform(system, work, load_in_state(system, work, ground), ground, h)
    ax, ay = (work.v[0, 0] - vx) / h, (work.v[0, 1] - vy) / h
    vertical = ground.z + vertical_acceleration(system, work.x[0, 0], work.x[0, 1], vx, vy, ax, ay)
    level = LARGE_FRACTION * LARGE_FRACTION
    # A comparison with NaN is False, so an overflow counts as a large acceleration.
    small = not far and largest * largest + vertical * vertical < level * work.best[0]
    for i in range(1, work.x.shape[0]):
        tx, ty = work.a0[i, 0] + ground.x, work.a0[i, 1] + ground.y
        small = small and tx * tx + ty * ty + vertical * vertical < level * work.best[i]
        for axis in range(2):
            work.v[i, axis] += h * work.a0[i, axis]
    move_at_velocity(work, 0.5 * h)
    return not small


@compiled
def move_at_velocity(work: Workspace, h: float) -> None:
    """Move every body by its velocity times h, s."""
    for i in range(work.x.shape[0]):
        for axis in range(2):
            work.x[i, axis] += h * work.v[i, axis]


@compiled
def push_platform(system: System, work: Workspace, load: Load, ground: Ground, h: float) -> tuple[float, bool]:
    """
    Update the platform's velocity, work.v[0], by the forces of one rough step of length h, s.

    Return a bound on its horizontal absolute acceleration, m/s^2, and True if it may come near one of these: its
    largest displacement so far, the rim, the end of the travel, liftoff, Painleve's paradox.
    """
    # Four cases. (1) At rest under the set-valued law and held: the acceleration is the ground's; where the drive comes
    # near the limit, the accurate run may have slipped, so the acceleration of a stop counts. (2) Moving, friction
    # removes less than the velocity: `share` of the velocity without friction remains, implicitly for the linear laws.
    # (3) Friction would stop the platform within MAX_SLOW_STEPS: on the way its direction turns, which steps this long
    # do not resolve, so the largest acceleration of any direction counts. (4) Near a limit: infinity, the run goes on.
    vx, vy = work.v[0, 0], work.v[0, 1]
    place2 = load.px * load.px + load.py * load.py
    bound = (1.0 - MIN_DISTANCE_TO_SINGULARITY) * min(system.radius, system.travel)
    if not place2 < bound * bound:
        return inf, True
    far = place2 >= LARGE_FRACTION * LARGE_FRACTION * work.squared_reach
    least = MIN_DISTANCE_TO_SINGULARITY * system.mass_ratio * system.gravity
    squared_speed = squared_sliding_speed(system, load.px, load.py, vx, vy)
    if system.law == SET_VALUED and squared_speed == 0.0:
        excess, reaction = rest_excess(system, load)
        if excess <= 0.0:
            nearly, largest = bound_held_acceleration(system, load, ground, excess, reaction)
            return largest, (nearly and far) or not reaction >= least
    sx, sy = slip_in_state(system, vx, vy, squared_speed)
    ax, ay, reaction, determinant = solve_platform_acceleration(system, load, squared_speed, sx, sy)
    if not (reaction >= least and determinant >= MIN_DISTANCE_TO_SINGULARITY):
        return inf, True
    held = scale_by_load(system, load.k_t, reaction, reaction)
    gx, gy = ax + held * sx, ay + held * sy  # acceleration if there were no friction
    free_x, free_y = vx + h * gx, vy + h * gy
    free = sqrt(free_x * free_x + free_y * free_y)
    if free == 0.0:
        work.v[0, 0] = work.v[0, 1] = 0.0
        return sqrt(ground.x * ground.x + ground.y * ground.y), far
    if system.law == LUBRICATED:
        share = 1.0 / (1.0 + h * reaction * viscous_factor(system))
    else:
        ratio = sqrt(squared_sliding_speed(system, load.px, load.py, free_x / free, free_y / free))
        limit = held * coefficient(system, sqrt(squared_speed)) / ratio
        share = max(0.0, 1.0 - h * limit / free)
        if share * free * ratio < system.v_reg:
            share = 1.0 / (1.0 + h * limit * ratio / system.v_reg)
        limit = max(limit, held * kinetic_coefficient(system) / ratio)  # friction may rise on the way to the stop
        slow = share * free < MAX_SLOW_STEPS * h * limit
        if slow and squared_speed > system.v_reg * system.v_reg:
            work.v[0, 0], work.v[0, 1] = share * free_x, share * free_y
            return largest_near_stop(gx, gy, vx, vy, ground, limit), far
    work.v[0, 0], work.v[0, 1] = share * free_x, share * free_y
    ax, ay = (share * free_x - vx) / h + ground.x, (share * free_y - vy) / h + ground.y
    return sqrt(ax * ax + ay * ay), far


@compiled
def bound_held_acceleration(
    system: System, load: Load, ground: Ground, excess: float, reaction: float
) -> tuple[bool, float]:
    """Return True if a platform at rest may slip, and a bound on its absolute acceleration, m/s^2.

    excess and reaction: the values of `rest_excess`.
    """
    largest = sqrt(ground.x * ground.x + ground.y * ground.y)
    limit = static_limit(system, load.k_t, reaction)
    nearly = excess > (MAX_HELD_DRIVE - 1.0) * limit * limit
    if nearly:
        gx, gy = load.fx - reaction * load.px / system.radius, load.fy - reaction * load.py / system.radius
        largest = max(largest, largest_near_stop(gx, gy, gx, gy, ground, limit))
    return nearly, largest


@compiled
def slip_in_state(system: System, vx: float, vy: float, squared_speed: float) -> tuple[float, float]:
    """Return the slip vector (friction over normal force, along x and y) at the start of a rough step; 0 at rest."""
    if squared_speed == 0.0:
        return 0.0, 0.0
    contact = SLIDING
    if system.law == LUBRICATED:
        contact = LUBRICATED_SLIDING
    elif squared_speed < system.v_reg * system.v_reg:
        contact = CREEPING
    factor = slip_factor(system, contact, squared_speed)
    return factor * vx, factor * vy


@compiled
def largest_near_stop(gx: float, gy: float, vx: float, vy: float, ground: Ground, friction: float) -> float:
    """
    Return a bound on the horizontal absolute acceleration, m/s^2, of a slide on its way to its stop.

    The direction of the slide turns from that of its velocity v to that of g, the acceleration without friction
    (stop_arc.py), and friction, m/s^2, turns with it.
    """
    # The absolute acceleration is d - f e: d the drive with the ground's acceleration, f friction, e the direction of
    # slip. It is the larger, the more e points against d. The smallest cosine between them over the turn, less a margin
    # for the direction, bounds it by the law of cosines. If e passes the direction opposite to d on its way, or if the
    # direction is too uncertain, the bound is |d| + f.
    dx, dy = gx + ground.x, gy + ground.y
    drive, speed, force = sqrt(dx * dx + dy * dy), sqrt(vx * vx + vy * vy), sqrt(gx * gx + gy * gy)
    if drive == 0.0 or speed == 0.0 or force <= MIN_SURE_DRIVE * friction:
        return drive + friction
    cosine = min((dx * vx + dy * vy) / speed, (dx * gx + dy * gy) / force) / drive
    cosine = min(max(cosine, -1.0), 1.0)
    sine = sqrt(1.0 - cosine * cosine)
    turn = vx * gy - vy * gx
    opposed = turn * (dx * vy - dy * vx) > 0.0 and turn * (gx * dy - gy * dx) > 0.0  # slip opposes the drive on the way
    if opposed or cosine < -cos(DIRECTION_MARGIN):
        return drive + friction
    cosine = cosine * cos(DIRECTION_MARGIN) - sine * sin(DIRECTION_MARGIN)
    return sqrt(drive * drive + friction * friction - 2.0 * cosine * drive * friction)
