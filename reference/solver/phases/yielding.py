"""
Motion under friction that yields elastically before it slides: one step, elastic or plastic, and events in it.

The unknowns of a step are the accelerations of the platform and its friction force at the stages.
"""

from __future__ import annotations

from math import inf

from reference.solver.chain import recover_chain_motion, set_chain_acceleration, set_feedback
from reference.solver.collocation import A2, NODES, STAGES, A
from reference.solver.compiled import compiled
from reference.solver.contact.platform import load_in_state
from reference.solver.contact.yielding import yielding_motion
from reference.solver.events import LEVEL_EVENT, NOT_IN_STEP, expand_level, locate_first_event
from reference.solver.ground import ground_at
from reference.solver.linear_solve import factorize_all, solve_all
from reference.solver.polynomial import A_COLUMNS, NODES_ROW, evaluate_polynomial, set_coefficients
from reference.solver.rows import broadcast_like, put, row, row_maximum, row_minimum
from reference.solver.step_control import begin_with_acceleration
from reference.solver.steps import (
    MAX_ITERATIONS,
    ROUNDING_CHANGE,
    SLOW_CONVERGENCE,
    classify_unsolved_step,
    set_absolute_accelerations,
    set_platform_motion,
)
from reference.solver.system import OPEN, PAINLEVE, PLASTIC, SOLVED, UNSOLVED, Load, System
from reference.solver.work import (
    ALONG_FORCE,
    ARGUMENTS,
    DETERMINANT,
    DRIVE,
    DRIVE_ARGUMENT,
    EXCESS,
    FORCE,
    FORCE_RATE,
    FRICTION_LIMIT,
    MOTION,
    POSITION,
    REACTION,
    VELOCITY,
    Workspace,
)

# Changes of arguments in difference quotients for Newton's method: as share of radius, speed, gravity or friction
# limit; and the change of the velocity of a platform at rest, m/s
DIFFERENCE_STEP, MIN_SPEED = 1e-7, 1e-10
FIRST_NODE = float(NODES[0])  # time of the first stage, as a share of the step
LATE_EVENT_SHARE = 1e-10  # share of a step before its end: an event within it counts as one at the end
MAX_SHIFT = 0.5  # largest relative change of a step's length that moves its end to an event


@compiled
def begin_yielding(system: System, work: Workspace, contact: int, slid: bool) -> None:
    """Set the accelerations at the start of an elastic or plastic phase.

    After plastic slip (`slid`), whose steps compute the direction of the friction force alone, scale it to its limit.
    """
    ground = ground_at(system, work, work.time)
    set_chain_acceleration(system, work, ground)
    load = load_in_state(system, work, ground)
    ax, ay, _, _, _, _, limit, size, _ = yielding_motion(
        system, PLASTIC if slid else contact, load, work.v[0, 0], work.v[0, 1], work.force[0], work.force[1]
    )
    if slid:
        work.force[0] *= limit / size
        work.force[1] *= limit / size
    begin_with_acceleration(system, work, ground, ax, ay, contact)


@compiled
def solve_yielding_step(system: System, work: Workspace, contact: int, h: float, tolerance: float) -> int:
    """
    Solve a step of length h, s, for the platform's accelerations and its friction force; return the outcome.

    `set_step_loads` comes before; work.a[0] holds the first guess. Newton's method ends as in `solve_moving_step`.
    """
    set_feedback(system, work, h)
    for axis in range(2):
        rate = 0.0 if contact == PLASTIC else system.stiffness * work.v[0, axis]
        put(work.shear, FORCE + axis, work.force[axis] + h * rate * row(NODES_ROW, ()))
    fresh, before = True, 0.0
    for iteration in range(MAX_ITERATIONS):
        code, size = set_yielding_residual(system, work, contact, h)
        if code != SOLVED:
            return code
        if fresh:
            set_yielding_slopes(system, work, contact)
            set_yielding_matrix(work, h)
            if not factorize_all(work.shear_matrix, work.shear_pivots):
                return UNSOLVED
        solve_all(work.shear_matrix, work.shear_pivots, work.shear_right)
        change = correct_unknowns(work)
        settled = change <= max(tolerance, ROUNDING_CHANGE * size)
        if not change < inf or (iteration > 1 and fresh and change > before and not settled):
            return UNSOLVED
        if settled:
            code, _ = set_yielding_residual(system, work, contact, h)
            recover_chain_motion(system, work, h)
            set_absolute_accelerations(system, work, contact)
            return OPEN if code == SOLVED and row_minimum(row(work.stage, REACTION)) <= 0.0 else code
        fresh = iteration > 0 and change > SLOW_CONVERGENCE * before
        before = change
    return UNSOLVED


@compiled
def set_motion(system: System, work: Workspace, contact: int) -> None:
    """Evaluate the equations at the stages: rows MOTION and FORCE_RATE of work.shear from those from ARGUMENTS on.

    The rows that describe the friction limit are set, too, and work.stage gets reaction and determinant.
    """
    shear, ground = work.shear, work.ground
    load = Load(
        px=row(shear, ARGUMENTS), py=row(shear, ARGUMENTS + 1),
        fx=row(shear, DRIVE_ARGUMENT), fy=row(shear, DRIVE_ARGUMENT + 1),
        ux=row(ground, 0), uy=row(ground, 1), uz=row(ground, 2), k_t=row(ground, 3),
    )  # fmt: skip
    ax, ay, reaction, determinant, rate_x, rate_y, limit, size, along = yielding_motion(
        system, contact, load, row(shear, ARGUMENTS + 2), row(shear, ARGUMENTS + 3), row(shear, FORCE),
        row(shear, FORCE + 1),
    )  # fmt: skip
    put(work.stage, REACTION, reaction)
    put(work.stage, DETERMINANT, determinant)
    put(shear, MOTION, ax)
    put(shear, MOTION + 1, ay)
    put(shear, FORCE_RATE, rate_x)
    put(shear, FORCE_RATE + 1, rate_y)
    put(shear, EXCESS, (size / limit) * (size / limit) - 1.0)  # the square is smooth where the force passes zero
    put(shear, ALONG_FORCE, along)
    put(shear, FRICTION_LIMIT, limit)


@compiled
def set_yielding_residual(system: System, work: Workspace, contact: int, h: float) -> tuple[int, float]:
    """Set the residuals of the equations for acceleration and friction force at the stages.

    Return an outcome, SOLVED if they can be evaluated, and the size of the accelerations, m/s^2.
    """
    stage, shear, right = work.stage, work.shear, work.shear_right
    set_platform_motion(work, h, 2)
    for axis in range(2):
        put(shear, ARGUMENTS + axis, row(stage, POSITION + axis))
        put(shear, ARGUMENTS + 2 + axis, row(stage, VELOCITY + axis))
        put(shear, DRIVE_ARGUMENT + axis, row(stage, DRIVE + axis))
    px, py = row(shear, ARGUMENTS), row(shear, ARGUMENTS + 1)
    if row_maximum(px * px + py * py) >= system.radius**2:
        return classify_unsolved_step(system, work), 0.0
    set_motion(system, work, contact)
    size = 0.0
    for axis in range(2):
        moved = broadcast_like(work.force[axis], px)
        for m in range(STAGES):
            moved += row(A_COLUMNS, m) * (h * shear[FORCE_RATE + axis, m])
        missing_a = row(shear, MOTION + axis) - row(work.a, (0, axis))
        missing_q = moved - row(shear, FORCE + axis)
        for m in range(STAGES):
            right[axis * STAGES + m], right[(2 + axis) * STAGES + m] = missing_a[m], missing_q[m]
        size += row_maximum(abs(row(shear, MOTION + axis)))
    return (SOLVED if row_minimum(row(stage, DETERMINANT)) > 0.0 else PAINLEVE), size


@compiled
def set_yielding_slopes(system: System, work: Workspace, contact: int) -> None:
    """Set work.shear_slopes, the derivatives of accelerations and friction rates, by difference quotients."""
    # Argument n is one of x, y, vx, vy, drive along x and y, friction force along x and y: the rows from ARGUMENTS on.
    shear, slopes = work.shear, work.shear_slopes
    for k in range(4):
        put(slopes, (8, k), row(shear, MOTION + k))
    speed = abs(row(shear, ARGUMENTS + 2)) + abs(row(shear, ARGUMENTS + 3)) + MIN_SPEED / DIFFERENCE_STEP
    limit = row(shear, FRICTION_LIMIT)
    for n in range(8):
        size = broadcast_like(min(system.radius, 1.0) if n < 2 else system.gravity, speed)
        if n == 2 or n == 3:
            size = speed
        elif n > 5:
            size = limit
        step, kept = DIFFERENCE_STEP * size, row(shear, ARGUMENTS + n)
        put(shear, ARGUMENTS + n, kept + step)
        set_motion(system, work, contact)
        for k in range(4):
            put(slopes, (n, k), (row(shear, MOTION + k) - row(slopes, (8, k))) / step)
        put(shear, ARGUMENTS + n, kept)


@compiled
def set_yielding_matrix(work: Workspace, h: float) -> None:
    """Set the matrix of Newton's method: derivatives of the stage equations by stage accelerations and forces."""
    # The unknowns z are of four kinds: acceleration along x and y, then friction force along x and y. Kind k at stage m
    # is z[k * STAGES + m]. A change of one acts at stage i on position, velocity and drive there, and so on
    # accelerations and on rates of the force, which the matrix A of the collocation integrates.
    matrix, slopes, feedback = work.shear_matrix, work.shear_slopes, work.feedback
    for kind in range(4):
        axis = kind % 2
        for m in range(STAGES):
            column = kind * STAGES + m
            for k in range(4):
                for i in range(STAGES):
                    change = 0.0
                    if kind < 2:
                        change += h * h * A2[i, m] * slopes[axis, k, i] + h * A[i, m] * slopes[2 + axis, k, i]
                        change += feedback[axis, m, i] * slopes[4 + axis, k, i]
                    elif i == m:
                        change += slopes[6 + axis, k, i]
                    if k < 2:
                        matrix[k * STAGES + i, column] = -change
                    else:
                        for j in range(STAGES):
                            place = k * STAGES + j
                            before = 0.0 if i == 0 else matrix[place, column]
                            matrix[place, column] = before - h * A[j, i] * change
            matrix[column, column] += 1.0


@compiled
def correct_unknowns(work: Workspace) -> float:
    """Add Newton's correction to stage accelerations and forces; return its largest acceleration, m/s^2, or inf."""
    change = 0.0
    for axis in range(2):
        for m in range(STAGES):
            step, turn = work.shear_right[axis * STAGES + m], work.shear_right[(2 + axis) * STAGES + m]
            work.a[0, axis, m] += step
            work.shear[FORCE + axis, m] += turn
            change = max(change, abs(step)) if abs(step) + abs(turn) < inf else inf
    return change


@compiled
def expand_event(system: System, work: Workspace, contact: int, h: float) -> float:
    """Set work.powers[0] to a polynomial that turns positive where the phase ends; return its value at stage 1."""
    # Elastic friction yields where its force reaches the friction limit. Plastic friction unloads where the rate of
    # slip, the velocity along the force less the rate of the limit over k, passes zero.
    shear = work.shear
    values = row(shear, EXCESS)
    if contact == PLASTIC:
        set_coefficients(row(shear, FRICTION_LIMIT), work.powers[1])
        theta = row(NODES_ROW, ())
        growth = broadcast_like(0.0, theta)
        for k in range(STAGES - 1, 0, -1):
            growth = growth * theta + k * work.powers[1, k]
        values = growth / (h * system.stiffness) - row(shear, ALONG_FORCE)
    expand_level(work, values, 0.0)
    first: float = values[0]
    return first


@compiled
def locate_event(system: System, work: Workspace, contact: int, h: float, begun: bool) -> float:
    """Return the share of the step at which the phase ends: 0 at its start, NOT_IN_STEP if it does not end in it."""
    # At the start of a phase the tested value is zero up to rounding, and its polynomial misses this zero: in the first
    # step the value at stage 1 decides. In any other step the polynomial may be positive at its start by error.
    first = expand_event(system, work, contact, h)
    if begun and first > 0.0:
        return 0.0
    start = evaluate_polynomial(work.powers[0], 0.0)
    if begun or (start > 0.0 and first <= 0.0):
        return locate_first_event(system, work, LEVEL_EVENT, 1.0, FIRST_NODE, first)
    return 0.5 * FIRST_NODE if start > 0.0 else locate_first_event(system, work, LEVEL_EVENT, 1.0, 0.0, start)


@compiled
def shift_to_event(system: System, work: Workspace, contact: int, h: float) -> float:
    """Return the relative change of the step's length that moves its end to the phase's end; NOT_IN_STEP if none."""
    expand_event(system, work, contact, h)
    slope = 0.0
    for k in range(1, STAGES):
        slope += k * work.powers[0, k]
    end = evaluate_polynomial(work.powers[0], 1.0)
    if not slope > 0.0:  # the value jumps, as behind a kink of the friction limit
        return 0.0 if end > 0.0 else NOT_IN_STEP
    return min(max(-end / slope, -MAX_SHIFT), MAX_SHIFT)


@compiled
def step_share_to_slowest_point(system: System, work: Workspace) -> float:
    """Return the step share at which the speed is smallest, 1 if at its end: friction may have a kink in time there."""
    shear = work.shear
    gain = row(shear, ARGUMENTS + 2) * row(shear, MOTION) + row(shear, ARGUMENTS + 3) * row(shear, MOTION + 1)
    if system.rate == 0.0 or gain[0] >= 0.0:
        return 1.0
    expand_level(work, gain, 0.0)
    portion = locate_first_event(system, work, LEVEL_EVENT, 1.0, FIRST_NODE, gain[0])
    return 1.0 if portion > 1.0 - LATE_EVENT_SHARE else portion


@compiled
def commit_force(work: Workspace) -> None:
    """Make the friction force at the end of the step that at the start of the next one."""
    for axis in range(2):
        work.force[axis] = work.shear[FORCE + axis, STAGES - 1]
