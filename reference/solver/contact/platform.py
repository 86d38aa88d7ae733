"""The platform at one instant: acceleration, reaction and their slopes under one of the friction laws."""

from __future__ import annotations

from math import sqrt

from reference.solver.collocation import STAGES
from reference.solver.compiled import compiled
from reference.solver.contact.friction import (
    rest_excess_exact,
    rest_excess_printed,
    rest_excess_small,
    sliding_speed2,
    slip_vector,
)
from reference.solver.equations import exact_acceleration, small_acceleration
from reference.solver.system import CREEPING, PRINTED, SLIDING, System, Work

ROUNDING_EXCESS = 1e-12  # of the squared friction limit: a drive that exceeds it by no more than rounding is held


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
def directed(
    system: System, px: float, py: float, fx: float, fy: float, ux: float, uy: float, pressure: float,
    speed: float, ex: float, ey: float,
) -> tuple[float, float, float, float]:  # fmt: skip
    """(ax, ay, reaction / m1, full over horizontal speed) when sliding in the direction (ex, ey) at any speed >= 0."""
    sx, sy, ratio = slip_vector(px, py, ex, ey, system.friction, system.radius, system.small)
    ax, ay, reaction, _ = acceleration(system, px, py, fx, fy, ux, uy, pressure, (speed * ratio) ** 2, sx, sy)
    return ax, ay, reaction, ratio


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
    return excess - ROUNDING_EXCESS * (mu * reaction) ** 2, reaction


@compiled
def slopes(system: System, contact: int, work: Work) -> None:
    """
    Derivative of the platform's (ax, ay) by px, py, vx, vy, fx, fy at the stages, where `moving` was asked before.

    Rows of work.slopes (12, S): two for each of the six.
    """
    radius, ratio, out = system.radius, system.mass_ratio, work.slopes
    for k in range(STAGES):
        px, py, vx, vy = work.stage[0, k], work.stage[1, k], work.stage[2, k], work.stage[3, k]
        fx, fy, reaction, speed2 = work.stage[4, k], work.stage[5, k], work.stage[6, k], work.stage[7, k]
        determinant = work.stage[8, k]
        ux, uy, pressure = work.ground[0, k], work.ground[1, k], system.gravity + work.ground[2, k]
        factor = slip_factor(system, contact, speed2)
        sx, sy = factor * vx, factor * vy
        # d factor = bend * d speed2
        bend = -0.5 * factor / speed2 if contact == SLIDING else 0.0
        if system.small:
            for c in range(6):
                dpx, dpy = (1.0 if c == 0 else 0.0), (1.0 if c == 1 else 0.0)
                dvx, dvy = (1.0 if c == 2 else 0.0), (1.0 if c == 3 else 0.0)
                dfx, dfy = (1.0 if c == 4 else 0.0), (1.0 if c == 5 else 0.0)
                dfactor = 2.0 * bend * (vx * dvx + vy * dvy)
                dsx, dsy = factor * dvx + dfactor * vx, factor * dvy + dfactor * vy
                lever = (dpx * sx + dpy * sy + px * dsx + py * dsy) / radius
                out[2 * c, k] = dfx - reaction * (dpx / radius + dsx) + ux * lever
                out[2 * c + 1, k] = dfy - reaction * (dpy / radius + dsy) + uy * lever
            continue
        depth2 = radius * radius - px * px - py * py
        climb = (px * vx + py * vy) / depth2
        nx, ny = -px / radius, -py / radius
        rise = pressure / sqrt(1.0 - nx * nx - ny * ny)
        share = ratio / determinant  # of the reaction in a load along the normal
        turn = reaction * (ratio - 1.0) / determinant
        for axis in range(system.axes):
            p, v, n, s, f = (px, vx, nx, sx, fx) if axis == 0 else (py, vy, ny, sy, fy)
            # by position
            dspeed2 = 2.0 * climb * (v + climb * p)
            gain = bend * dspeed2
            dn = -1.0 / radius
            lean = nx * vx + ny * vy
            d_reaction = share * (dspeed2 / radius - dn * f - dn * n * rise) - turn * (dn * (2.0 * n - s) - gain * lean)
            out[2 * axis, k] = d_reaction * (nx - sx) + reaction * ((dn if axis == 0 else 0.0) - gain * vx)
            out[2 * axis + 1, k] = d_reaction * (ny - sy) + reaction * ((dn if axis == 1 else 0.0) - gain * vy)
            # by velocity
            dspeed2 = 2.0 * (v + climb * p)
            gain = bend * dspeed2
            d_reaction = share * dspeed2 / radius + turn * (gain * lean + factor * n)
            out[4 + 2 * axis, k] = d_reaction * (nx - sx) - reaction * (gain * vx + (factor if axis == 0 else 0.0))
            out[5 + 2 * axis, k] = d_reaction * (ny - sy) - reaction * (gain * vy + (factor if axis == 1 else 0.0))
            # by drive
            d_reaction = -share * n
            out[8 + 2 * axis, k] = d_reaction * (nx - sx) + (1.0 if axis == 0 else 0.0)
            out[9 + 2 * axis, k] = d_reaction * (ny - sy) + (1.0 if axis == 1 else 0.0)
