"""
Sliding close to a stop, in the stretched time tau with dt = S dtau, S the horizontal speed.

There the direction theta and the logarithm of the speed, sigma = ln S, obey smooth equations however small S is,
    theta' = a . e_perp(theta),   sigma' = a . e(theta),   t' = S,   p' = S^2 e(theta),
so the turning of the slip direction on the way into a stop, or past one, is resolved at a constant cost per decade of
speed. The chain above the platform, slow on this time scale, follows by iteration.
"""

from __future__ import annotations

from math import exp, log

from reference.solver.collocation import NODES, STAGES, A
from reference.solver.compiled import compiled
from reference.solver.contact.friction import heading
from reference.solver.contact.platform import directed
from reference.solver.ground import ground_at
from reference.solver.linear_solve import factorize, solve
from reference.solver.steps import absolute_accelerations, beyond_rim
from reference.solver.system import SLIDING, SOLVED, UNSOLVED, Array, System, Work

MAX_ITERATIONS = 40  # of Newton's method
ROUNDING_ANGLE = 1e-13  # rad: change of the angles by rounding alone
DIRECTION_DIFFERENCE = 1e-6  # rad: step of the difference quotient by the direction, needed to a few digits only

# rows of Work.turning
DIRECTION, SIGMA, CLOCK, ALONG, ACROSS, ALONG_SLOPE, ACROSS_SLOPE, LOG_RATIO, SPEED, COSINE, SINE = range(11)


@compiled
def near_stop_step(
    system: System, phase: Array, work: Work, t: float, h: float, angle: float, log_speed: float, tolerance: float
) -> int:
    """
    One step of length h in tau from the state x, v = exp(log_speed) e(angle).

    Fills a, total and `turning` at the stages and x1, v1 at the end; `tolerance` bounds the last change of the angle.
    """
    bodies = work.x.shape[0]
    x, v, a, xs, vs = work.x, work.v, work.a, work.chain, work.velocity
    turn, ground, stage, residual = work.turning, work.ground, work.stage, work.residual[:STAGES]
    matrix, pivots = work.matrix[:STAGES, :STAGES], work.pivots[:STAGES]
    ex, ey = heading(angle, system.axes)
    along = work.a0[0, 0] * ex + work.a0[0, 1] * ey
    across = work.a0[0, 1] * ex - work.a0[0, 0] * ey
    for k in range(STAGES):
        turn[DIRECTION, k] = angle
        turn[SIGMA, k] = log_speed + h * NODES[k] * along
        # a turn is at most towards the force: do not overshoot it in the guess
        turn[DIRECTION, k] += max(-0.5, min(0.5, h * NODES[k] * across))
        for i in range(bodies):
            for axis in range(system.axes):
                xs[i, axis, k] = x[i, axis]
                a[i, axis, k] = work.a0[i, axis]
    reach = 0.0
    for iteration in range(MAX_ITERATIONS):
        moved = 0.0
        for k in range(STAGES):
            turn[SPEED, k] = exp(turn[SIGMA, k])
            turn[COSINE, k], turn[SINE, k] = heading(turn[DIRECTION, k], system.axes)
        for k in range(STAGES):
            elapsed = 0.0
            for m in range(STAGES):
                elapsed += A[k, m] * turn[SPEED, m]
            turn[CLOCK, k] = t + h * elapsed
        for i in range(bodies):
            for axis in range(system.axes):
                for k in range(STAGES):
                    if i == 0:
                        vs[i, axis, k] = turn[SPEED, k] * turn[COSINE + axis, k]
                    else:
                        gained = 0.0
                        for m in range(STAGES):
                            gained += A[k, m] * turn[SPEED, m] * a[i, axis, m]
                        vs[i, axis, k] = v[i, axis] + h * gained
                for k in range(STAGES):
                    shift = 0.0
                    for m in range(STAGES):
                        shift += A[k, m] * turn[SPEED, m] * vs[i, axis, m]
                    xs[i, axis, k] = x[i, axis] + h * shift
        for k in range(STAGES):
            ux, uy, uz = ground_at(system, phase, turn[CLOCK, k])
            ground[0, k], ground[1, k], ground[2, k] = ux, uy, uz
            for i in range(1, bodies):
                for axis in range(system.axes):
                    pull = system.below[i, axis] * (xs[i - 1, axis, k] - xs[i, axis, k])
                    if i < bodies - 1:
                        pull += system.above[i, axis] * (xs[i + 1, axis, k] - xs[i, axis, k])
                    pull -= ground[axis, k]
                    moved = max(moved, abs(pull - a[i, axis, k]) * turn[SPEED, k] * h)
                    a[i, axis, k] = pull
            fx, fy = -ux, -uy
            if bodies > 1:
                fx += system.above[0, 0] * (xs[1, 0, k] - xs[0, 0, k])
                fy += system.above[0, 1] * (xs[1, 1, k] - xs[0, 1, k])
            speed, ex, ey = turn[SPEED, k], turn[COSINE, k], turn[SINE, k]
            px, py, pressure = xs[0, 0, k], xs[0, 1, k], system.gravity + uz
            if px * px + py * py >= system.radius**2:
                return beyond_rim(system, work)
            ax, ay, reaction, ratio = directed(system, px, py, fx, fy, ux, uy, pressure, speed, ex, ey)
            gx, gy = ex - DIRECTION_DIFFERENCE * ey, ey + DIRECTION_DIFFERENCE * ex
            bx, by, _, _ = directed(system, px, py, fx, fy, ux, uy, pressure, speed, gx, gy)
            a[0, 0, k], a[0, 1, k] = ax, ay
            turn[ALONG, k] = ax * ex + ay * ey
            turn[ACROSS, k] = ay * ex - ax * ey
            turn[ALONG_SLOPE, k] = (bx * gx + by * gy - turn[ALONG, k]) / DIRECTION_DIFFERENCE
            turn[ACROSS_SLOPE, k] = (by * gx - bx * gy - turn[ACROSS, k]) / DIRECTION_DIFFERENCE
            turn[LOG_RATIO, k] = log(ratio)
            stage[0, k], stage[1, k] = px, py
            stage[2, k], stage[3, k] = speed * ex, speed * ey
            stage[4, k], stage[5, k] = fx, fy
            stage[6, k], stage[7, k] = reaction, (speed * ratio) ** 2
        for k in range(STAGES):
            residual[k] = angle - turn[DIRECTION, k]
            for m in range(STAGES):
                residual[k] += h * A[k, m] * turn[ACROSS, m]
                matrix[k, m] = -h * A[k, m] * turn[ACROSS_SLOPE, m]
            matrix[k, k] += 1.0
        if not factorize(matrix, pivots):
            return UNSOLVED
        solve(matrix, pivots, residual)
        for k in range(STAGES):
            turn[DIRECTION, k] += residual[k]
            moved = max(moved, abs(residual[k]))
        for k in range(STAGES):
            level = log_speed
            for m in range(STAGES):
                level += h * A[k, m] * (turn[ALONG, m] + turn[ALONG_SLOPE, m] * residual[m])
            moved = max(moved, abs(level - turn[SIGMA, k]))
            turn[SIGMA, k] = level
        if not moved < 1e3 or (iteration > 4 and moved > 2.0 * reach):
            return UNSOLVED
        reach = moved
        if moved <= max(tolerance, ROUNDING_ANGLE):
            for i in range(bodies):
                for axis in range(system.axes):
                    work.x1[i, axis] = xs[i, axis, STAGES - 1]
                    work.v1[i, axis] = vs[i, axis, STAGES - 1]
            absolute_accelerations(system, work, SLIDING)
            return SOLVED
    return UNSOLVED
