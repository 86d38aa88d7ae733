"""The platform at one instant: the forces on it, and its acceleration and reaction under one of the friction laws."""

from __future__ import annotations

from math import sqrt

from reference.solver.compiled import compiled
from reference.solver.contact.friction import (
    coefficient,
    slip_vector,
    squared_rest_excess_as_printed,
    squared_rest_excess_exact,
    squared_rest_excess_small,
    squared_sliding_speed,
    static_limit,
    viscous_factor,
)
from reference.solver.contact.load import exact_equations, scale_by_load
from reference.solver.equations import small_acceleration
from reference.solver.rows import Number, broadcast_like, row
from reference.solver.system import CREEPING, PRINTED, SLIDING, Ground, Load, System
from reference.solver.work import DRIVE, POSITION, Workspace

ROUNDING_EXCESS = 1e-12  # share of the squared friction limit by which rounding alone lets the squared force exceed it


@compiled
def load_in_state(system: System, work: Workspace, ground: Ground) -> Load:
    """Return the position of the platform and what acts on it (`Load`) in the state work.x, work.v."""
    fx, fy = -ground.x, -ground.y
    if work.x.shape[0] > 1:
        fx += system.above[0, 0] * (work.x[1, 0] - work.x[0, 0])
        fy += system.above[0, 1] * (work.x[1, 1] - work.x[0, 1])
        fx += system.damping_above[0, 0] * (work.v[1, 0] - work.v[0, 0])
        fy += system.damping_above[0, 1] * (work.v[1, 1] - work.v[0, 1])
    return Load(
        px=work.x[0, 0], py=work.x[0, 1], fx=fx, fy=fy, ux=ground.x, uy=ground.y, uz=ground.z, k_t=ground.k_t
    )  # fmt: skip


@compiled
def load_at_stages(work: Workspace) -> Load:
    """Return the position of the platform and what acts on it (`Load`) at all stages of the step, as rows (rows.py)."""
    stage, ground = work.stage, work.ground
    return Load(
        px=row(stage, POSITION), py=row(stage, POSITION + 1), fx=row(stage, DRIVE), fy=row(stage, DRIVE + 1),
        ux=row(ground, 0), uy=row(ground, 1), uz=row(ground, 2), k_t=row(ground, 3),
    )  # fmt: skip


@compiled
def slip_factor(system: System, contact: int, squared_speed: Number) -> Number:
    """Return the slip vector (friction over normal force) per unit of horizontal velocity, s/m."""
    if contact == SLIDING:
        speed = sqrt(squared_speed)
        return coefficient(system, speed) / speed
    if contact == CREEPING:
        return coefficient(system, sqrt(squared_speed)) / system.v_reg
    return broadcast_like(viscous_factor(system), squared_speed)


@compiled
def solve_platform_acceleration(
    system: System, load: Load, squared_speed: Number, sx: Number, sy: Number
) -> tuple[Number, Number, Number, Number]:
    """Return ax, ay, reaction over platform mass and inertia matrix determinant (equations.py) for a slip vector.

    The slip vector is given for friction that depends on neither load nor temperature.
    """
    if system.small:
        pressure = system.gravity + load.uz
        reaction = system.mass_ratio * pressure
        return small_acceleration(
            load.px, load.py, load.fx, load.fy, load.ux, load.uy, pressure,
            scale_by_load(system, load.k_t, reaction, sx), scale_by_load(system, load.k_t, reaction, sy),
            system.mass_ratio, system.radius,
        )  # fmt: skip
    return exact_equations(system, load, squared_speed, sx, sy)


@compiled
def moving_acceleration(
    system: System, contact: int, load: Load, vx: Number, vy: Number
) -> tuple[Number, Number, Number, Number, Number]:
    """Return ax, ay, reaction over mass, inertia matrix determinant and squared sliding speed of a moving platform."""
    squared_speed = squared_sliding_speed(system, load.px, load.py, vx, vy)
    factor = slip_factor(system, contact, squared_speed)
    ax, ay, reaction, determinant = solve_platform_acceleration(system, load, squared_speed, factor * vx, factor * vy)
    return ax, ay, reaction, determinant, squared_speed


@compiled
def acceleration_along(
    system: System, load: Load, speed: Number, ex: Number, ey: Number
) -> tuple[Number, Number, Number, Number]:
    """Return ax, ay, reaction over platform mass, and ratio of full to horizontal speed, of a slide along (ex, ey).

    `speed` is the horizontal one, m/s. It may be 0: then these are the limits at a stop.
    """
    sx, sy, ratio = slip_vector(system, load.px, load.py, speed, ex, ey)
    ax, ay, reaction, _ = solve_platform_acceleration(system, load, (speed * ratio) * (speed * ratio), sx, sy)
    return ax, ay, reaction, ratio


@compiled
def rest_excess(system: System, load: Load) -> tuple[Number, Number]:
    """Return squared tangential force minus squared friction limit at rest, m^2/s^4, and reaction, both per mass m1.

    Rest is possible while the first is not positive and the second is positive.
    """
    if system.small:
        excess, reaction = squared_rest_excess_small(system, load)
    else:
        excess, reaction = squared_rest_excess_exact(system, load)
    if system.rest_condition == PRINTED:
        # The paper's condition for rest (4.6) may release a platform that friction can hold: it counts as at rest here.
        excess = min(excess, squared_rest_excess_as_printed(system, load))
    limit = static_limit(system, load.k_t, reaction)
    return excess - ROUNDING_EXCESS * (limit * limit), reaction
