"""
One collocation step in time: of a platform at rest, or one that moves under a friction law.

A step reads the state x, v of `Workspace`. It leaves the stage accelerations in `a`, the platform at the stages in
`stage`, the absolute accelerations in `total` and the end of the step in x1, v1. A moving step returns its outcome.
"""

from __future__ import annotations

from math import inf, sqrt

import numpy as np

from reference.solver.chain import (
    CHANNEL_ROUNDING,
    eliminate_chain,
    recover_chain_motion,
    set_chain_loads,
    set_feedback,
)
from reference.solver.collocation import AT_START, STAGES
from reference.solver.compiled import compiled
from reference.solver.contact.platform import load_at_stages, moving_acceleration
from reference.solver.contact.slopes import set_slopes
from reference.solver.equations import vertical_motion
from reference.solver.ground import set_ground_at_stages, set_harmonics
from reference.solver.linear_solve import IDENTITY, factorize, solve
from reference.solver.polynomial import A2_COLUMNS, A_COLUMNS, NODES_ROW
from reference.solver.rows import Number, broadcast_like, is_finite, put, row, row_maximum, row_minimum
from reference.solver.system import CREEPING, OPEN, PAINLEVE, REST, RIM, SLIDING, SOLVED, UNSOLVED, System
from reference.solver.work import (
    BY_DRIVE,
    BY_POSITION,
    BY_VELOCITY,
    DETERMINANT,
    DRIVE,
    POSITION,
    REACTION,
    SQUARED_SPEED,
    VELOCITY,
    Workspace,
)

MAX_ITERATIONS = 14  # number of Newton iterations after which a step counts as unsolved
SLOW_CONVERGENCE = 0.1  # ratio of successive Newton corrections above which the derivatives are computed again
FORCE_ROUNDING = 1e-13  # rounding error, relative to the forces, of an acceleration extrapolated to a step's start
ROUNDING_CHANGE = 4e-15  # relative change of accelerations by rounding alone: a change this small ends the iteration
# Growth of a slide's squared speed in Newton's method above which derivatives are computed again: they are ten times
# too large by then
MAX_SPEED2_GROWTH = 100.0
# Share of the rim's squared displacement, rho^2: a step that began at more and leaves the surface has reached the rim
RIM_SQUARED_FRACTION = 0.99


@compiled
def set_step_loads(system: System, work: Workspace, h: float) -> None:
    """Set, at the stages of a step h, s, the ground's acceleration, and the drive on the platform: work.free."""
    put(work.elapsed, (), h * row(NODES_ROW, ()))
    set_harmonics(system, work, work.time)
    set_ground_at_stages(system, work)
    eliminate_chain(system, work, h)
    set_chain_loads(system, work, h)


@compiled
def solve_rest_step(system: System, work: Workspace, h: float) -> None:
    """Solve a step in which the platform rests and the bodies above it vibrate (4.4)."""
    set_step_loads(system, work, h)
    for axis in range(system.axes):
        put(work.a, (0, axis), 0.0)
        put(work.stage, POSITION + axis, work.x[0, axis])
        put(work.stage, VELOCITY + axis, 0.0)
        put(work.stage, DRIVE + axis, row(work.free, axis))
    recover_chain_motion(system, work, h)
    set_absolute_accelerations(system, work, REST)


@compiled
def solve_moving_step(system: System, work: Workspace, contact: int, h: float, tolerance: float) -> int:
    """
    Solve a step of length h, s, of a moving platform, and return its outcome (system.py).

    `set_step_loads` comes before; work.a[0] holds the first guess. The iteration ends when its change is below
    `tolerance`, m/s^2, or at the level of rounding.
    """
    # Newton's method finds the platform's stage accelerations; the bodies above are eliminated exactly (chain.py).
    # A derivative serves several iterations while these converge fast. The error that remains is then far smaller than
    # the last change, which is what `tolerance` bounds.
    # Across the direction of slip, friction's derivative by the velocity is (friction coefficient) N / v. If it is
    # computed at a guess that is far too slow, it is far too large: Newton's method then hardly corrects a wrong
    # direction, and the small change looks like convergence. So a derivative serves no iteration at a much higher
    # speed (MAX_SPEED2_GROWTH).
    set_feedback(system, work, h)
    pivots = work.pivots[: system.axes * STAGES]
    known = row(work.stage, SQUARED_SPEED)
    fresh, before = True, 0.0
    for iteration in range(MAX_ITERATIONS):
        set_platform_motion(work, h, system.axes)
        code, size = set_residual(system, work, contact)
        if code != SOLVED:
            return code
        if fresh or (
            contact == SLIDING and row_maximum(row(work.stage, SQUARED_SPEED) - MAX_SPEED2_GROWTH * known) > 0.0
        ):
            known = row(work.stage, SQUARED_SPEED)
            set_slopes(system, contact, work)
            set_matrix(work, h, system.axes)
            if not factorize(work.matrix, pivots):
                return UNSOLVED
        solve(work.matrix, pivots, work.residual)
        change = correct_accelerations(work, system.axes)
        settled = change <= max(tolerance, ROUNDING_CHANGE * size)
        if not np.isfinite(change) or (iteration > 1 and fresh and change > before and not settled):
            return UNSOLVED
        if settled:
            set_platform_motion(work, h, system.axes)
            recover_chain_motion(system, work, h)
            set_absolute_accelerations(system, work, contact)
            return SOLVED if row_minimum(row(work.stage, REACTION)) > 0.0 else OPEN
        fresh = iteration > 0 and change > SLOW_CONVERGENCE * before
        before = change
    return UNSOLVED


@compiled
def set_residual(system: System, work: Workspace, contact: int) -> tuple[int, float]:
    """Set the residual of the platform's equations at the stages; return an outcome, and their largest acceleration."""
    a, stage, residual = work.a, work.stage, work.residual
    load = load_at_stages(work)
    if row_maximum(load.px * load.px + load.py * load.py) >= system.radius**2:
        return classify_unsolved_step(system, work), 0.0
    ax, ay, reaction, determinant, squared_speed = moving_acceleration(
        system, contact, load, row(stage, VELOCITY), row(stage, VELOCITY + 1)
    )
    put(stage, REACTION, reaction)
    put(stage, DETERMINANT, determinant)
    put(stage, SQUARED_SPEED, squared_speed)
    put(residual, 0, ax - row(a, (0, 0)))
    put(residual, 1, ay - row(a, (0, 1)))
    # Painleve's paradox is located to FATAL_STEP (step_control.py). Creep may respond within a shorter time: there a
    # determinant that is not positive counts as UNSOLVED, so that the steps may become shorter still.
    code = UNSOLVED if contact == CREEPING else PAINLEVE
    return (SOLVED if row_minimum(determinant) > 0.0 else code), row_maximum(abs(ax) + abs(ay))


@compiled
def correct_accelerations(work: Workspace, axes: int) -> float:
    """Add Newton's correction, in work.residual, to the stage accelerations; return its largest size, m/s^2, or inf."""
    change = 0.0
    for axis in range(axes):
        correction = row(work.residual, axis)
        put(work.a, (0, axis), row(work.a, (0, axis)) + correction)
        change = max(change, row_maximum(abs(correction)) if is_finite(correction) else inf)
    return change


@compiled
def set_platform_motion(work: Workspace, h: float, axes: int) -> None:
    """Set the platform's position, velocity and driving acceleration at the stages from its accelerations there."""
    a, stage, feedback, x, v = work.a, work.stage, work.feedback, work.x, work.v
    for axis in range(axes):
        velocity = position = broadcast_like(0.0, row(NODES_ROW, ()))
        drive = row(work.free, axis)
        for m in range(STAGES):
            acceleration = a[0, axis, m]
            velocity += row(A_COLUMNS, m) * acceleration
            position += row(A2_COLUMNS, m) * acceleration
            drive += row(feedback, (axis, m)) * acceleration
        put(stage, POSITION + axis, x[0, axis] + h * (row(NODES_ROW, ()) * v[0, axis] + h * position))
        put(stage, VELOCITY + axis, v[0, axis] + h * velocity)
        put(stage, DRIVE + axis, drive)


@compiled
def set_matrix(work: Workspace, h: float, axes: int) -> None:
    """Set Newton's matrix: derivatives of a - acceleration(a) = 0 by the platform's stage accelerations a."""
    # A stage acceleration changes the position by h^2 A^2, the velocity by h A, and the drive by `feedback`; the slopes
    # say how the acceleration answers to each of these.
    matrix, feedback, slope = work.matrix, work.feedback, work.slopes
    for axis in range(axes):
        for column in range(axes):
            by_position = h * h * row(slope, BY_POSITION + 2 * column + axis)
            by_velocity = h * row(slope, BY_VELOCITY + 2 * column + axis)
            by_drive = row(slope, BY_DRIVE + 2 * column + axis)
            for m in range(STAGES):
                answer = by_position * row(A2_COLUMNS, m) + by_velocity * row(A_COLUMNS, m)
                answer += by_drive * row(feedback, (column, m))
                own = row(IDENTITY, (column * STAGES + m, axis))
                put(matrix, (column * STAGES + m, axis), own - answer)


@compiled
def classify_unsolved_step(system: System, work: Workspace) -> int:
    """Return why a step is unsolved: RIM (4.1) if it began close to the rim of the surface, else UNSOLVED."""
    return RIM if work.x[0, 0] ** 2 + work.x[0, 1] ** 2 > RIM_SQUARED_FRACTION * system.radius**2 else UNSOLVED


@compiled
def vertical_acceleration(
    system: System, px: Number, py: Number, vx: Number, vy: Number, ax: Number, ay: Number
) -> Number:
    """Return the vertical acceleration of all bodies relative to the ground (2.2); zero for small vibrations (4.3)."""
    if system.small:
        return broadcast_like(0.0, px)
    _, _, az = vertical_motion(px, py, vx, vy, ax, ay, system.radius)
    return az


@compiled
def set_absolute_accelerations(system: System, work: Workspace, contact: int) -> None:
    """Set the absolute accelerations at the stages: relative plus ground acceleration."""
    a, ground, stage, total = work.a, work.ground, work.stage, work.total
    vertical = row(ground, 2)
    if contact != REST:
        vertical += vertical_acceleration(
            system, row(stage, POSITION), row(stage, POSITION + 1), row(stage, VELOCITY), row(stage, VELOCITY + 1),
            row(a, (0, 0)), row(a, (0, 1)),
        )  # fmt: skip
    for i in range(work.x.shape[0]):
        for axis in range(2):
            put(total, (i, axis), row(a, (i, axis)) + row(ground, axis))
        put(total, (i, 2), vertical)


@compiled
def step_error(system: System, work: Workspace, tolerance: float, weight: float) -> float:
    """
    Return the largest error of the bodies' absolute accelerations inside the step, relative to work.scale.

    `weight` multiplies the error; `tolerance` is the relative error that the step may have.
    """
    # The acceleration at the start of the step is known. The polynomial through the stages, evaluated there, misses it
    # by the interpolation error of the step, which falls like h^7: Radau IIA has no stage at theta = 0. This defect is
    # the error of the step.
    # By rounding, the defect is at least FORCE_ROUNDING of the forces, plus CHANNEL_ROUNDING if there are bodies above,
    # solved in the collocation matrix's eigenbasis. No shorter step would reduce an error of that size, so it counts as
    # the tolerance at most, and the step passes.
    # On a plane surface (infinite radius) the platform's acceleration relative to the ground counts as well: without a
    # restoring force no absolute acceleration shows an error of the position.
    total, total0, stage, a = work.total, work.total0, work.stage, work.a
    load = abs(total0[0, 2])
    load = max(load, row_maximum(abs(row(stage, DRIVE)) + abs(row(stage, DRIVE + 1))))
    # Friction may decelerate a platform without any drive, so the acceleration of the platform is a measure of the
    # forces, too.
    load = max(load, row_maximum(abs(row(a, (0, 0))) + abs(row(a, (0, 1)))))
    noise = FORCE_ROUNDING * load
    channels = noise + (CHANNEL_ROUNDING * load if work.x.shape[0] > 1 else 0.0)
    worst = 0.0
    for i in range(work.x.shape[0]):
        squared = 0.0
        for axis in range(3):
            defect = -total0[i, axis]
            for k in range(STAGES):
                defect += AT_START[k] * total[i, axis, k]
            squared += defect * defect
        work.defect[i] = sqrt(squared)
        error = weight * (work.defect[i] - noise) / work.scale[i]
        worst = max(worst, min(error, tolerance) if work.defect[i] <= channels else error)
    if system.radius == inf:
        error = (relative_defect(work) - channels) / work.scale[0]
        worst = max(worst, error)
    return worst


@compiled
def relative_defect(work: Workspace) -> float:
    """Return the interpolation error, m/s^2, of the platform's acceleration relative to the ground plate."""
    squared = 0.0
    for axis in range(2):
        defect = -work.a0[0, axis]
        for k in range(STAGES):
            defect += AT_START[k] * work.a[0, axis, k]
        squared += defect * defect
    return sqrt(squared)
