"""Derivatives of the platform's acceleration (equations.py) under one of the friction laws, for Newton's method."""

from __future__ import annotations

from math import sqrt

from reference.solver.collocation import STAGES
from reference.solver.compiled import compiled
from reference.solver.contact.friction import coefficient_slope
from reference.solver.contact.platform import slip_factor
from reference.solver.system import LUBRICATED_SLIDING, SLIDING, System
from reference.solver.work import (
    BY_DRIVE,
    BY_POSITION,
    BY_VELOCITY,
    DETERMINANT,
    DRIVE,
    POSITION,
    REACTION,
    SPEED2,
    VELOCITY,
    Work,
)


@compiled
def slopes(system: System, contact: int, work: Work) -> None:
    """
    Derivative of the platform's (ax, ay) by position, velocity and drive at the stages, where it was asked before.

    Rows of work.slopes: behind BY_POSITION, BY_VELOCITY and BY_DRIVE (ax, ay) by x, then by y.
    """
    for k in range(STAGES):
        speed2 = work.stage[SPEED2, k]
        factor = slip_factor(system, contact, speed2)
        bend = factor_slope(system, contact, factor, speed2)
        if system.small:
            small_slopes(system, work, k, factor, bend)
        else:
            exact_slopes(system, work, k, factor, bend)


@compiled
def factor_slope(system: System, contact: int, factor: float, speed2: float) -> float:
    """Derivative of the slip factor (platform.py) by the squared sliding speed, s^3/m^3."""
    bend = -0.5 * factor / speed2 if contact == SLIDING else 0.0
    if system.rate > 0.0 and speed2 > 0.0 and contact != LUBRICATED_SLIDING:
        speed = sqrt(speed2)
        bend += 0.5 * coefficient_slope(system, speed) / (speed2 if contact == SLIDING else speed * system.v_reg)
    return bend


@compiled
def small_slopes(system: System, work: Work, k: int, factor: float, bend: float) -> None:
    """Of (4.3)."""
    stage, out, radius = work.stage, work.slopes, system.radius
    px, py, vx, vy = stage[POSITION, k], stage[POSITION + 1, k], stage[VELOCITY, k], stage[VELOCITY + 1, k]
    reaction, ux, uy = stage[REACTION, k], work.ground[0, k], work.ground[1, k]
    sx, sy = factor * vx, factor * vy
    for axis in range(2):
        ex, ey = (1.0, 0.0) if axis == 0 else (0.0, 1.0)
        lever = (ex * sx + ey * sy) / radius
        out[BY_POSITION + 2 * axis, k] = ux * lever - reaction * ex / radius
        out[BY_POSITION + 2 * axis + 1, k] = uy * lever - reaction * ey / radius
        gain = 2.0 * bend * (vx * ex + vy * ey)
        dsx, dsy = factor * ex + gain * vx, factor * ey + gain * vy
        lever = (px * dsx + py * dsy) / radius
        out[BY_VELOCITY + 2 * axis, k] = ux * lever - reaction * dsx
        out[BY_VELOCITY + 2 * axis + 1, k] = uy * lever - reaction * dsy
        out[BY_DRIVE + 2 * axis, k], out[BY_DRIVE + 2 * axis + 1, k] = ex, ey


@compiled
def exact_slopes(system: System, work: Work, k: int, factor: float, bend: float) -> None:
    """Of (3.9)-(3.13)."""
    stage, out, radius, ratio = work.stage, work.slopes, system.radius, system.mass_ratio
    px, py, vx, vy = stage[POSITION, k], stage[POSITION + 1, k], stage[VELOCITY, k], stage[VELOCITY + 1, k]
    reaction, determinant = stage[REACTION, k], stage[DETERMINANT, k]
    sx, sy, nx, ny = factor * vx, factor * vy, -px / radius, -py / radius
    climb = (px * vx + py * vy) / (radius * radius - px * px - py * py)
    rise = (system.gravity + work.ground[2, k]) / sqrt(1.0 - nx * nx - ny * ny)
    lean = nx * vx + ny * vy
    share = ratio / determinant  # of the reaction in a load along the normal
    turn = reaction * (ratio - 1.0) / determinant
    dn = -1.0 / radius
    for axis in range(system.axes):
        ex, ey = (1.0, 0.0) if axis == 0 else (0.0, 1.0)
        p, v, n, s, f = stage[POSITION + axis, k], stage[VELOCITY + axis, k], nx, sx, stage[DRIVE + axis, k]
        if axis == 1:
            n, s = ny, sy
        dspeed2 = 2.0 * climb * (v + climb * p)
        gain = bend * dspeed2
        d_reaction = share * (dspeed2 / radius - dn * f - dn * n * rise) - turn * (dn * (2.0 * n - s) - gain * lean)
        out[BY_POSITION + 2 * axis, k] = d_reaction * (nx - sx) + reaction * (dn * ex - gain * vx)
        out[BY_POSITION + 2 * axis + 1, k] = d_reaction * (ny - sy) + reaction * (dn * ey - gain * vy)
        dspeed2 = 2.0 * (v + climb * p)
        gain = bend * dspeed2
        d_reaction = share * dspeed2 / radius + turn * (gain * lean + factor * n)
        out[BY_VELOCITY + 2 * axis, k] = d_reaction * (nx - sx) - reaction * (gain * vx + factor * ex)
        out[BY_VELOCITY + 2 * axis + 1, k] = d_reaction * (ny - sy) - reaction * (gain * vy + factor * ey)
        d_reaction = -share * n
        out[BY_DRIVE + 2 * axis, k] = d_reaction * (nx - sx) + ex
        out[BY_DRIVE + 2 * axis + 1, k] = d_reaction * (ny - sy) + ey
