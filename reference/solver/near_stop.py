"""
Sliding close to a stop, in the stretched time tau with dt = S dtau, S the horizontal speed.

There the direction theta and the logarithm of the speed, sigma = ln S, obey smooth equations however small S is,
    theta' = a . e_perp(theta),   sigma' = a . e(theta),   t' = S,   p' = S^2 e(theta),
so the turning of the slip direction on the way into a stop, or past one, is resolved at a constant cost per decade of
speed. The chain above the platform, slow on this time scale, follows by iteration.
"""

from __future__ import annotations

from math import exp, inf, log

from reference.solver.collocation import NODES, STAGES, A
from reference.solver.compiled import compiled
from reference.solver.contact.friction import heading
from reference.solver.contact.platform import directed, load_at_stage
from reference.solver.events import lowest
from reference.solver.ground import ground_at_stages, start_waves
from reference.solver.linear_solve import factorize, solve
from reference.solver.steps import absolute_accelerations, beyond_rim
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
    SPEED2,
    VELOCITY,
    Work,
)

MAX_ITERATIONS = 40  # of Newton's method
SLOW_CONVERGENCE = 0.01  # of the change before: a larger change asks for new slopes
ROUNDING_ANGLE = 1e-13  # rad: change of the angles by rounding alone
DIRECTION_DIFFERENCE = 1e-6  # rad: step of the difference quotient by the direction, needed to a few digits only
SPEED_DIFFERENCE = 1e-6  # of the speed: step of the difference quotient by its logarithm
MAX_GUESSED_TURN = 0.5  # rad: a turn is at most towards the force, which the guess must not overshoot
DIVERGED = 1e3  # change of angle or logarithm of the speed that ends the iteration


@compiled
def near_stop_step(system: System, work: Work, h: float, tolerance: float) -> int:
    """
    One step of length h in tau from the state x, v = exp(work.log_speed) e(work.angle).

    Fills a, total and `turning` at the stages and x1, v1 at the end; `tolerance` bounds the last change of the angle.
    """
    guess_turning(system, work, h)
    start_waves(system, work, work.time)
    before, fresh = 0.0, True
    for iteration in range(MAX_ITERATIONS):
        move_bodies(system, work, h)
        change = pull_bodies(system, work, h)
        if not inside_rim(system, work):
            return beyond_rim(system, work)
        turn_platform(system, work, fresh)
        change = max(change, correct_turning(system, work, h, fresh))
        if not change < DIVERGED or (iteration > 4 and change > 2.0 * before):
            return UNSOLVED
        fresh = iteration == 0 or change > SLOW_CONVERGENCE * before or system.rate > 0.0
        before = change
        if change <= max(tolerance, ROUNDING_ANGLE):
            for i in range(work.x.shape[0]):
                for axis in range(system.axes):
                    work.x1[i, axis] = work.chain[i, axis, STAGES - 1]
                    work.v1[i, axis] = work.velocity[i, axis, STAGES - 1]
            for k in range(STAGES):
                work.levels[k] = work.turning[SIGMA, k] + log(work.turning[RATIO, k])
            absolute_accelerations(system, work, SLIDING)
            return SOLVED if lowest(work.stage[REACTION]) > 0.0 else OPEN
    return UNSOLVED


@compiled
def guess_turning(system: System, work: Work, h: float) -> None:
    """Direction and speed at the stages, and the chain's accelerations, from those at the start of the step."""
    ex, ey = heading(work.angle, system.axes)
    along = work.a0[0, 0] * ex + work.a0[0, 1] * ey
    across = work.a0[0, 1] * ex - work.a0[0, 0] * ey
    for k in range(STAGES):
        turn = max(-MAX_GUESSED_TURN, min(MAX_GUESSED_TURN, h * NODES[k] * across))
        work.turning[DIRECTION, k] = work.angle + turn
        work.turning[SIGMA, k] = work.log_speed + h * NODES[k] * along
        for i in range(work.x.shape[0]):
            for axis in range(system.axes):
                work.a[i, axis, k] = work.a0[i, axis]


@compiled
def move_bodies(system: System, work: Work, h: float) -> None:
    """Speed, time, velocities and positions at the stages."""
    x, v, a, turning = work.x, work.v, work.a, work.turning
    speeds = turning[SPEED]
    for k in range(STAGES):
        speeds[k] = exp(turning[SIGMA, k])
        turning[COSINE, k], turning[SINE, k] = heading(turning[DIRECTION, k], system.axes)
    for k in range(STAGES):
        elapsed = 0.0
        for m in range(STAGES):
            elapsed += A[k, m] * speeds[m]
        work.elapsed[k] = h * elapsed
        turning[CLOCK, k] = work.time + work.elapsed[k]
    for i in range(x.shape[0]):
        for axis in range(system.axes):
            velocity, position = work.velocity[i, axis], work.chain[i, axis]
            for k in range(STAGES):
                if i == 0:
                    velocity[k] = speeds[k] * turning[COSINE + axis, k]
                else:
                    gained = 0.0
                    for m in range(STAGES):
                        gained += A[k, m] * speeds[m] * a[i, axis, m]
                    velocity[k] = v[i, axis] + h * gained
            for k in range(STAGES):
                shift = 0.0
                for m in range(STAGES):
                    shift += A[k, m] * speeds[m] * velocity[m]
                position[k] = x[i, axis] + h * shift


@compiled
def pull_bodies(system: System, work: Work, h: float) -> float:
    """
    Ground, accelerations of the chain and drive of the platform at the stages.

    Returns the largest change of the chain's accelerations, as a change of velocity over the speed.
    """
    place, velocity, stage, ground = work.chain, work.velocity, work.stage, work.ground
    bodies = work.x.shape[0]
    change = 0.0
    ground_at_stages(system, work)
    for k in range(STAGES):
        duration = work.turning[SPEED, k] * h
        for axis in range(system.axes):
            for i in range(1, bodies):
                pull = system.below[i, axis] * (place[i - 1, axis, k] - place[i, axis, k])
                pull += system.damping_below[i, axis] * (velocity[i - 1, axis, k] - velocity[i, axis, k])
                if i < bodies - 1:
                    pull += system.above[i, axis] * (place[i + 1, axis, k] - place[i, axis, k])
                    pull += system.damping_above[i, axis] * (velocity[i + 1, axis, k] - velocity[i, axis, k])
                pull -= ground[axis, k]
                change = max(change, abs(pull - work.a[i, axis, k]) * duration)
                work.a[i, axis, k] = pull
        for axis in range(2):
            drive = -ground[axis, k]
            if bodies > 1:
                drive += system.above[0, axis] * (place[1, axis, k] - place[0, axis, k])
                drive += system.damping_above[0, axis] * (velocity[1, axis, k] - velocity[0, axis, k])
            stage[POSITION + axis, k] = place[0, axis, k]
            stage[VELOCITY + axis, k] = velocity[0, axis, k]
            stage[DRIVE + axis, k] = drive
    return change


@compiled
def inside_rim(system: System, work: Work) -> bool:
    """Whether the platform is within the cap at every stage (4.1)."""
    for k in range(STAGES):
        if not work.stage[POSITION, k] ** 2 + work.stage[POSITION + 1, k] ** 2 < system.radius**2:
            return False
    return True


@compiled
def turn_platform(system: System, work: Work, fresh: bool) -> None:
    """
    Acceleration of the platform at the stages, along and across its direction; `fresh`: and slopes by the direction.

    Where friction depends on the speed, also the slope of that along the direction by the speed's logarithm.
    """
    turning, stage = work.turning, work.stage
    for k in range(STAGES):
        speed, ex, ey = turning[SPEED, k], turning[COSINE, k], turning[SINE, k]
        load = load_at_stage(work, k)
        ax, ay, reaction, ratio = directed(system, load, speed, ex, ey)
        work.a[0, 0, k], work.a[0, 1, k] = ax, ay
        turning[ALONG, k] = ax * ex + ay * ey
        turning[ACROSS, k] = ay * ex - ax * ey
        turning[RATIO, k] = ratio
        stage[REACTION, k], stage[SPEED2, k] = reaction, (speed * ratio) ** 2
        if not fresh:
            continue
        gx, gy = ex - DIRECTION_DIFFERENCE * ey, ey + DIRECTION_DIFFERENCE * ex
        bx, by, _, _ = directed(system, load, speed, gx, gy)
        turning[ALONG_SLOPE, k] = (bx * gx + by * gy - turning[ALONG, k]) / DIRECTION_DIFFERENCE
        turning[ACROSS_SLOPE, k] = (by * gx - bx * gy - turning[ACROSS, k]) / DIRECTION_DIFFERENCE
        if system.rate > 0.0:
            cx, cy, _, _ = directed(system, load, (1.0 + SPEED_DIFFERENCE) * speed, ex, ey)
            turning[ALONG_BY_SIGMA, k] = (cx * ex + cy * ey - turning[ALONG, k]) / SPEED_DIFFERENCE


@compiled
def correct_turning(system: System, work: Work, h: float, fresh: bool) -> float:
    """
    One iteration of Newton's method for the directions, the speeds behind them; the largest change, or infinity.

    fresh: with slopes of this iteration, not with the factors of the one before.
    """
    turning, residual = work.turning, work.residual[:STAGES]
    matrix, pivots = work.turn_matrix, work.pivots[:STAGES]
    for k in range(STAGES):
        residual[k] = work.angle - turning[DIRECTION, k]
        for m in range(STAGES):
            residual[k] += h * A[k, m] * turning[ACROSS, m]
    if fresh:
        for k in range(STAGES):
            for m in range(STAGES):
                matrix[m, k] = -h * A[k, m] * turning[ACROSS_SLOPE, m]
            matrix[k, k] += 1.0
        if not factorize(matrix, pivots):
            return inf
    solve(matrix, pivots, residual)
    change, levels = 0.0, work.levels
    for k in range(STAGES):
        level = work.log_speed
        for m in range(STAGES):
            level += h * A[k, m] * (turning[ALONG, m] + turning[ALONG_SLOPE, m] * residual[m])
        levels[k] = level
    if system.rate > 0.0 and not correct_levels(work, h):
        return inf
    for k in range(STAGES):
        change = max(change, max(abs(residual[k]), abs(levels[k] - turning[SIGMA, k])))
        turning[DIRECTION, k] += residual[k]
        turning[SIGMA, k] = levels[k]
        if not change < DIVERGED:
            return inf
    return change


@compiled
def correct_levels(work: Work, h: float) -> bool:
    """Newton's method in place of iteration for the logarithms of the speed in `levels`; False if it has no step."""
    turning, levels = work.turning, work.levels
    matrix, pivots = work.turn_matrix, work.pivots[:STAGES]
    for k in range(STAGES):
        levels[k] -= turning[SIGMA, k]
        for m in range(STAGES):
            matrix[m, k] = -h * A[k, m] * turning[ALONG_BY_SIGMA, m]
        matrix[k, k] += 1.0
    if not factorize(matrix, pivots):
        return False
    solve(matrix, pivots, levels)
    for k in range(STAGES):
        levels[k] += turning[SIGMA, k]
    return True
