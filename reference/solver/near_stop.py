"""
Sliding close to a stop, in the stretched time tau with dt = S dtau, S the horizontal speed.

There the direction theta and the logarithm of the speed, sigma = ln S, obey smooth equations however small S is
(T7 of docs/theory.md),
    theta' = a . e_perp(theta),   sigma' = a . e(theta),   t' = S,   p' = S^2 e(theta),
so the turning of the slip direction on the way into a stop, or past one, is resolved at a constant cost per decade of
speed (docs/decisions/0001-stretched-time.md). The chain above the platform is slow on this time scale and is solved by
iteration.
"""

from __future__ import annotations

from math import exp, inf, log

from reference.solver.collocation import STAGES
from reference.solver.compiled import compiled
from reference.solver.contact.friction import slip_direction_cosines
from reference.solver.contact.platform import acceleration_along, load_at_stages
from reference.solver.ground import set_ground_at_stages, set_harmonics
from reference.solver.linear_solve import IDENTITY, factorize, solve
from reference.solver.polynomial import A_COLUMNS, NODES_ROW, integrate_to_stages
from reference.solver.rows import is_finite, put, row, row_maximum, row_minimum
from reference.solver.steps import classify_unsolved_step, set_absolute_accelerations
from reference.solver.system import OPEN, SLIDING, SOLVED, UNSOLVED, System
from reference.solver.work import (
    ACROSS,
    ACROSS_SLOPE,
    ALONG,
    ALONG_BY_SIGMA,
    ALONG_SLOPE,
    CLOCK,
    COSINE,
    DIRECTION,
    DRIVE,
    POSITION,
    RATIO,
    REACTION,
    SIGMA,
    SINE,
    SPEED,
    SQUARED_SPEED,
    VELOCITY,
    Workspace,
)

MAX_ITERATIONS = 40  # number of Newton iterations after which a step near a stop counts as unsolved
SLOW_CONVERGENCE = 0.01  # ratio of successive Newton corrections above which the derivatives are computed again
ROUNDING_ANGLE = 1e-13  # rad, change of slip directions by rounding alone: a change this small ends the iteration
DIRECTION_DIFFERENCE = 1e-6  # rad, change of slip direction in difference quotients, which need only a few digits
SPEED_DIFFERENCE = 1e-6  # relative change of speed in difference quotients of accelerations by the log speed
MAX_GUESSED_TURN = 0.5  # rad, largest guessed turn of slip direction: a slide turns towards the force, not beyond it
MAX_CHANGE = 1e3  # a step is unsolved if slip directions, rad, or log speeds change by more than this in one iteration


@compiled
def solve_near_stop_step(system: System, work: Workspace, h: float, tolerance: float) -> int:
    """Solve a step of length h in stretched time (dt = speed dtau), and return its outcome (system.py).

    The iteration ends when slip directions, rad, change by at most `tolerance`.
    """
    # One iteration has three parts. Speeds and directions at the stages give time and positions by integration
    # (`set_motion_at_stages`). These give ground, springs and dampers (`set_drive_at_stages`): a fixed-point iteration
    # for the chain, which converges as the chain hardly moves in it. The forces give the platform's acceleration along
    # and across its direction (`set_path_acceleration`), Newton's method corrects the directions, which turn fast; the
    # log speed follows from them (`correct_turning`). Derivatives are kept while the changes fall fast. The first two
    # iterations always compute them anew: the guess is a straight line.
    guess_near_stop(system, work, h)
    set_harmonics(system, work, work.time)
    before, slow = 0.0, True
    for iteration in range(MAX_ITERATIONS):
        fresh = iteration < 2 or slow or system.rate > 0.0
        set_motion_at_stages(system, work, h)
        change = set_drive_at_stages(system, work, h)
        if not is_inside_rim(system, work):
            return classify_unsolved_step(system, work)
        set_path_acceleration(system, work, fresh)
        change = max(change, correct_turning(system, work, h, fresh))
        if not change < MAX_CHANGE or (iteration > 4 and change > 2.0 * before):
            return UNSOLVED
        slow = change > SLOW_CONVERGENCE * before
        before = change
        if change <= max(tolerance, ROUNDING_ANGLE):
            for i in range(work.x.shape[0]):
                for axis in range(system.axes):
                    work.x1[i, axis] = work.positions[i, axis, STAGES - 1]
                    work.v1[i, axis] = work.velocities[i, axis, STAGES - 1]
            put(work.levels, (), row(work.turning, SIGMA) + log(row(work.turning, RATIO)))
            set_absolute_accelerations(system, work, SLIDING)
            return SOLVED if row_minimum(row(work.stage, REACTION)) > 0.0 else OPEN
    return UNSOLVED


@compiled
def guess_near_stop(system: System, work: Workspace, h: float) -> None:
    """Set the first guess at the stages: directions and log speeds change linearly, accelerations are constant."""
    ex, ey = slip_direction_cosines(work.angle, system.axes)
    along = work.a0[0, 0] * ex + work.a0[0, 1] * ey
    across = work.a0[0, 1] * ex - work.a0[0, 0] * ey
    elapsed = h * row(NODES_ROW, ())
    turn = max(-MAX_GUESSED_TURN, min(MAX_GUESSED_TURN, elapsed * across))
    put(work.turning, DIRECTION, work.angle + turn)
    put(work.turning, SIGMA, work.log_speed + elapsed * along)
    for i in range(work.x.shape[0]):
        for axis in range(system.axes):
            put(work.a, (i, axis), work.a0[i, axis])


@compiled
def set_motion_at_stages(system: System, work: Workspace, h: float) -> None:
    """Set speed, time, velocities and positions at the stages near a stop from slip directions and log speeds there."""
    x, v, a, turning = work.x, work.v, work.a, work.turning
    for k in range(STAGES):
        turning[COSINE, k], turning[SINE, k] = slip_direction_cosines(turning[DIRECTION, k], system.axes)
    speeds = exp(row(turning, SIGMA))
    elapsed = h * integrate_to_stages(speeds)
    put(turning, SPEED, speeds)
    put(turning, CLOCK, work.time + elapsed)
    put(work.elapsed, (), elapsed)
    for i in range(x.shape[0]):
        for axis in range(system.axes):
            if i == 0:
                velocity = speeds * row(turning, COSINE + axis)
            else:
                velocity = v[i, axis] + h * integrate_to_stages(speeds * row(a, (i, axis)))
            put(work.velocities, (i, axis), velocity)
            put(work.positions, (i, axis), x[i, axis] + h * integrate_to_stages(speeds * velocity))


@compiled
def set_drive_at_stages(system: System, work: Workspace, h: float) -> float:
    """Set the accelerations of the upper bodies, and the driving acceleration of the platform, at the stages.

    Return by how much, in velocity over the step, m/s, the accelerations of the upper bodies have changed at most.
    """
    place, velocity, stage = work.positions, work.velocities, work.stage
    bodies = work.x.shape[0]
    change = 0.0
    set_ground_at_stages(system, work)
    duration = row(work.turning, SPEED) * h
    for axis in range(system.axes):
        for i in range(1, bodies):
            pull = system.below[i, axis] * (row(place, (i - 1, axis)) - row(place, (i, axis)))
            pull += system.damping_below[i, axis] * (row(velocity, (i - 1, axis)) - row(velocity, (i, axis)))
            if i < bodies - 1:
                pull += system.above[i, axis] * (row(place, (i + 1, axis)) - row(place, (i, axis)))
                pull += system.damping_above[i, axis] * (row(velocity, (i + 1, axis)) - row(velocity, (i, axis)))
            pull -= row(work.ground, axis)
            change = max(change, row_maximum(abs(pull - row(work.a, (i, axis))) * duration))
            put(work.a, (i, axis), pull)
    for axis in range(2):
        drive = -row(work.ground, axis)
        if bodies > 1:
            drive += system.above[0, axis] * (row(place, (1, axis)) - row(place, (0, axis)))
            drive += system.damping_above[0, axis] * (row(velocity, (1, axis)) - row(velocity, (0, axis)))
        put(stage, POSITION + axis, row(place, (0, axis)))
        put(stage, VELOCITY + axis, row(velocity, (0, axis)))
        put(stage, DRIVE + axis, drive)
    return change


@compiled
def is_inside_rim(system: System, work: Workspace) -> bool:
    """Return True if the platform is inside the rim of the concave surface at every stage (4.1)."""
    x, y = row(work.stage, POSITION), row(work.stage, POSITION + 1)
    inside: bool = row_maximum(x * x + y * y) < system.radius**2
    return inside


@compiled
def set_path_acceleration(system: System, work: Workspace, fresh: bool) -> None:
    """Set the platform's acceleration along and across its slip direction at the stages.

    If `fresh`, set its derivatives as well: by the direction, and by the log speed where friction depends on speed.
    """
    turning, stage, load = work.turning, work.stage, load_at_stages(work)
    speed, ex, ey = row(turning, SPEED), row(turning, COSINE), row(turning, SINE)
    ax, ay, reaction, ratio = acceleration_along(system, load, speed, ex, ey)
    along, across, full = ax * ex + ay * ey, ay * ex - ax * ey, speed * ratio
    put(work.a, (0, 0), ax)
    put(work.a, (0, 1), ay)
    put(turning, ALONG, along)
    put(turning, ACROSS, across)
    put(turning, RATIO, ratio)
    put(stage, REACTION, reaction)
    put(stage, SQUARED_SPEED, full * full)
    if not fresh:
        return
    gx, gy = ex - DIRECTION_DIFFERENCE * ey, ey + DIRECTION_DIFFERENCE * ex
    bx, by, _, _ = acceleration_along(system, load, speed, gx, gy)
    put(turning, ALONG_SLOPE, (bx * gx + by * gy - along) / DIRECTION_DIFFERENCE)
    put(turning, ACROSS_SLOPE, (by * gx - bx * gy - across) / DIRECTION_DIFFERENCE)
    if system.rate > 0.0:
        cx, cy, _, _ = acceleration_along(system, load, (1.0 + SPEED_DIFFERENCE) * speed, ex, ey)
        put(turning, ALONG_BY_SIGMA, (cx * ex + cy * ey - along) / SPEED_DIFFERENCE)


@compiled
def correct_turning(system: System, work: Workspace, h: float, fresh: bool) -> float:
    """Correct slip directions, rad, and log speeds by one iteration of Newton's method; return the largest change.

    With `fresh`, its matrix is computed and factorized again.
    """
    # The unknowns are the directions at the stages: theta_0 + h A (a . e_perp) - theta = 0, linearized by the
    # derivative of the sideways acceleration by the direction alone. The logarithms of the speed follow explicitly from
    # the corrected directions, since constant friction hardly depends on the speed. Where friction depends on the
    # speed, this iteration converges slowly or not at all, and Newton's method takes its place (`correct_log_speeds`).
    # The return value is infinite if the linear equations have no solution.
    turning, residual = work.turning, work.residual
    matrix, pivots = work.turn_matrix, work.pivots[:STAGES]
    put(residual, 0, work.angle - row(turning, DIRECTION) + h * integrate_to_stages(row(turning, ACROSS)))
    if fresh:
        for m in range(STAGES):
            put(matrix, (m, 0), row(IDENTITY, (m, 0)) - row(A_COLUMNS, m) * (h * turning[ACROSS_SLOPE, m]))
        if not factorize(matrix, pivots):
            return inf
    solve(matrix, pivots, residual)
    turn = row(residual, 0)
    along = row(turning, ALONG) + row(turning, ALONG_SLOPE) * turn
    put(work.levels, (), work.log_speed + h * integrate_to_stages(along))
    if system.rate > 0.0 and not correct_log_speeds(work, h):
        return inf
    rise = row(work.levels, ()) - row(turning, SIGMA)
    if not (is_finite(turn) and is_finite(rise)):
        return inf
    put(turning, DIRECTION, row(turning, DIRECTION) + turn)
    put(turning, SIGMA, row(work.levels, ()))
    change: float = row_maximum(max(abs(turn), abs(rise)))
    return change


@compiled
def correct_log_speeds(work: Workspace, h: float) -> bool:
    """Correct the log speeds at the stages by one Newton iteration; return False if its matrix is singular."""
    turning, levels, residual = work.turning, work.levels, work.residual
    matrix, pivots = work.turn_matrix, work.pivots[:STAGES]
    turn = row(residual, 0)
    put(residual, 0, row(levels, ()) - row(turning, SIGMA))
    for m in range(STAGES):
        put(matrix, (m, 0), row(IDENTITY, (m, 0)) - row(A_COLUMNS, m) * (h * turning[ALONG_BY_SIGMA, m]))
    if not factorize(matrix, pivots):
        return False
    solve(matrix, pivots, residual)
    put(levels, (), row(turning, SIGMA) + row(residual, 0))
    put(residual, 0, turn)
    return True
