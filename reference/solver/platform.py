"""The platform at one instant: acceleration, reaction and their slopes under one of the friction laws."""

from __future__ import annotations

from math import sqrt

from reference.solver.compiled import compiled
from reference.solver.equations import exact_acceleration, small_acceleration
from reference.solver.friction import rest_excess_exact, rest_excess_printed, rest_excess_small, sliding_speed2
from reference.solver.system import CREEPING, PRINTED, SLIDING, Array, System


@compiled
def slip_factor(system: System, contact: int, speed2: float) -> float:
    """Slip vector over horizontal velocity (friction.py), s/m."""
    if contact == SLIDING:
        return system.friction / sqrt(speed2)
    if contact == CREEPING:
        return system.friction / system.v_reg
    return system.friction


@compiled
def acceleration(
    system: System,
    px: float,
    py: float,
    fx: float,
    fy: float,
    ux: float,
    uy: float,
    pressure: float,
    speed2: float,
    sx: float,
    sy: float,
) -> tuple[float, float, float, float]:
    """(ax, ay, reaction / m1, inertia determinant) by the system's own equations (equations.py)."""
    if system.small:
        return small_acceleration(px, py, fx, fy, ux, uy, pressure, sx, sy, system.mass_ratio, system.radius)
    return exact_acceleration(px, py, fx, fy, pressure, speed2, sx, sy, system.mass_ratio, system.radius)


@compiled
def moving(
    system: System,
    contact: int,
    px: float,
    py: float,
    vx: float,
    vy: float,
    fx: float,
    fy: float,
    ux: float,
    uy: float,
    pressure: float,
) -> tuple[float, float, float, float, float]:
    """(ax, ay, reaction / m1, inertia determinant, speed2) at a velocity that is not zero while sliding."""
    speed2 = sliding_speed2(px, py, vx, vy, system.radius, system.small)
    factor = slip_factor(system, contact, speed2)
    ax, ay, reaction, determinant = acceleration(
        system, px, py, fx, fy, ux, uy, pressure, speed2, factor * vx, factor * vy
    )
    return ax, ay, reaction, determinant, speed2


@compiled
def rest_excess(
    system: System, px: float, py: float, fx: float, fy: float, ux: float, uy: float, pressure: float
) -> tuple[float, float]:
    """(excess, reaction / m1): rest is possible while the excess is not positive (friction.py)."""
    mu, ratio, radius = system.friction, system.mass_ratio, system.radius
    if system.small:
        excess, reaction = rest_excess_small(px, py, fx, fy, ux, uy, pressure, mu, ratio, radius)
    else:
        excess, reaction = rest_excess_exact(px, py, fx, fy, pressure, mu, ratio, radius)
    if system.rest_condition == PRINTED:
        # where (4.6) lets go of a platform that friction can hold, no motion begins all the same
        excess = min(excess, rest_excess_printed(px, py, fx, fy, ux, uy, pressure, mu, ratio, radius))
    return excess, reaction


@compiled
def slopes(
    system: System,
    contact: int,
    px: float,
    py: float,
    vx: float,
    vy: float,
    fx: float,
    fy: float,
    ux: float,
    uy: float,
    pressure: float,
    out: Array,
    k: int,
) -> tuple[float, float, float, float, float]:
    """
    As `moving`, and the derivative of (ax, ay) by px, py, vx, vy, fx, fy in column k of `out` (12, S), two rows each.
    """
    radius, ratio = system.radius, system.mass_ratio
    speed2 = sliding_speed2(px, py, vx, vy, radius, system.small)
    factor = slip_factor(system, contact, speed2)
    sx, sy = factor * vx, factor * vy
    ax, ay, reaction, determinant = acceleration(system, px, py, fx, fy, ux, uy, pressure, speed2, sx, sy)
    depth2 = radius * radius - px * px - py * py
    climb = px * vx + py * vy
    nx, ny = -px / radius, -py / radius
    nz = sqrt(depth2) / radius
    for c in range(6):
        dpx = 1.0 if c == 0 else 0.0
        dpy = 1.0 if c == 1 else 0.0
        dvx = 1.0 if c == 2 else 0.0
        dvy = 1.0 if c == 3 else 0.0
        dfx = 1.0 if c == 4 else 0.0
        dfy = 1.0 if c == 5 else 0.0
        dspeed2 = 2.0 * (vx * dvx + vy * dvy)
        if not system.small:
            dclimb = px * dvx + py * dvy + vx * dpx + vy * dpy
            dspeed2 += 2.0 * climb * (dclimb + climb * (px * dpx + py * dpy) / depth2) / depth2
        dfactor = -0.5 * factor * dspeed2 / speed2 if contact == SLIDING else 0.0
        dsx = factor * dvx + dfactor * vx
        dsy = factor * dvy + dfactor * vy
        if system.small:
            lever = (dpx * sx + dpy * sy + px * dsx + py * dsy) / radius
            out[2 * c, k] = dfx - reaction * (dpx / radius + dsx) + ux * lever
            out[2 * c + 1, k] = dfy - reaction * (dpy / radius + dsy) + uy * lever
        else:
            dnx, dny = -dpx / radius, -dpy / radius
            dtilt = 2.0 * (nx * dnx + ny * dny)
            d_determinant = (ratio - 1.0) * (dtilt - dnx * sx - dny * sy - nx * dsx - ny * dsy)
            d_load = dspeed2 / radius - dnx * fx - dny * fy - nx * dfx - ny * dfy - 0.5 * dtilt / nz * pressure
            d_reaction = (ratio * d_load - reaction * d_determinant) / determinant
            out[2 * c, k] = dfx + d_reaction * (nx - sx) + reaction * (dnx - dsx)
            out[2 * c + 1, k] = dfy + d_reaction * (ny - sy) + reaction * (dny - dsy)
    return ax, ay, reaction, determinant, speed2
