"""Derivatives of the platform's acceleration (equations.py) under one of the friction laws, for Newton's method."""

from __future__ import annotations

from math import sqrt

from reference.solver.compiled import compiled
from reference.solver.contact.friction import coefficient_slope
from reference.solver.contact.load import scale_by_load, scale_by_response
from reference.solver.contact.platform import slip_factor
from reference.solver.rows import Row, broadcast_like, put, row, where_positive
from reference.solver.system import LUBRICATED_SLIDING, SLIDING, Array, System
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


@compiled
def set_slopes(system: System, contact: int, work: Workspace) -> None:
    """
    Set the derivatives of the platform's acceleration by its position, velocity and driving acceleration at the stages.

    They go to work.slopes: four rows from each of BY_POSITION, BY_VELOCITY and BY_DRIVE on, the derivatives of ax and
    ay by the x component, then those by the y component. work.stage holds reaction, determinant and squared speed.
    """
    squared_speed = row(work.stage, SQUARED_SPEED)
    factor = slip_factor(system, contact, squared_speed)
    bend = factor_slope(system, contact, factor, squared_speed)
    reaction, k_t = row(work.stage, REACTION), row(work.ground, 3)
    factor, bend = scale_by_load(system, k_t, reaction, factor), scale_by_load(system, k_t, reaction, bend)
    if system.small:
        set_small_slopes(system, work, factor, bend)
    else:
        set_exact_slopes(system, work, factor, bend)


@compiled
def factor_slope(system: System, contact: int, factor: Row, squared_speed: Row) -> Row:
    """Return the derivative of the slip vector per velocity, `factor`, by the squared sliding speed, s^3/m^3."""
    bend = -0.5 * factor / squared_speed if contact == SLIDING else broadcast_like(0.0, squared_speed)
    if system.rate > 0.0 and contact != LUBRICATED_SLIDING:
        speed = sqrt(squared_speed)
        changing = squared_speed if contact == SLIDING else speed * system.v_reg
        bend = where_positive(squared_speed, bend + 0.5 * coefficient_slope(system, speed) / changing, bend)
    return bend


@compiled
def write_pair(slopes: Array, place: int, x: Row, y: Row) -> None:
    """Write a derivative of ax, given as x, into row `place` of `slopes`, and that of ay, given as y, into the next."""
    put(slopes, place, x)
    put(slopes, place + 1, y)


@compiled
def set_small_slopes(system: System, work: Workspace, factor: Row, bend: Row) -> None:
    """Set the derivatives of the platform's acceleration (rows: `set_slopes`) by the small equations (4.3)."""
    # By (4.3) the acceleration is a = f - R (p / rho + s) + u (p . s) / rho, with R the reaction over m1, u the
    # ground's acceleration and s = factor v the slip vector, which changes as s' = factor v' + bend (v^2)' v. `lever`
    # is the change of (p . s) / rho, and `gain` is bend (v^2)'.
    stage, out, radius = work.stage, work.slopes, system.radius
    px, py, vx, vy = row(stage, POSITION), row(stage, POSITION + 1), row(stage, VELOCITY), row(stage, VELOCITY + 1)
    reaction, ux, uy = row(stage, REACTION), row(work.ground, 0), row(work.ground, 1)
    sx, sy = factor * vx, factor * vy
    for axis in range(2):
        ex, ey = (1.0, 0.0) if axis == 0 else (0.0, 1.0)
        lever = (ex * sx + ey * sy) / radius
        write_pair(
            out, BY_POSITION + 2 * axis, ux * lever - reaction * ex / radius, uy * lever - reaction * ey / radius
        )
        gain = 2.0 * bend * (vx * ex + vy * ey)
        dsx, dsy = factor * ex + gain * vx, factor * ey + gain * vy
        lever = (px * dsx + py * dsy) / radius
        write_pair(out, BY_VELOCITY + 2 * axis, ux * lever - reaction * dsx, uy * lever - reaction * dsy)
        write_pair(out, BY_DRIVE + 2 * axis, broadcast_like(ex, ux), broadcast_like(ey, uy))


@compiled
def set_exact_slopes(system: System, work: Workspace, factor: Row, bend: Row) -> None:
    """Set the derivatives of the platform's acceleration (rows: `set_slopes`) by the exact equations (3.9)-(3.13)."""
    # By equations.py the acceleration is a = f + R (n - s), with f the drive, n the normal, s the slip vector and
    # R = M (v^2 / rho - n . f + n_z q) / D the reaction over m1; q is the pressure, M the mass ratio and
    # D = 1 + (M - 1) (n^2 - n . s). So every derivative is a' = f' + R' (n - t) + R (n' - s'), where t is s times the
    # relative change of the friction force per relative change of R (load.py), and
    #     R' = (M / D) (v^2 / rho - n . f + n_z q)' - R (M - 1) / D (n^2 - n . s)'.
    # Below, `share` is M / D, `turn` is R (M - 1) / D, and the slip vector changes as s' = factor v' + bend (v^2)' v.
    stage, out, radius, ratio = work.stage, work.slopes, system.radius, system.mass_ratio
    px, py, vx, vy = row(stage, POSITION), row(stage, POSITION + 1), row(stage, VELOCITY), row(stage, VELOCITY + 1)
    reaction, determinant = row(stage, REACTION), row(stage, DETERMINANT)
    sx, sy, nx, ny = factor * vx, factor * vy, -px / radius, -py / radius
    radial = (px * vx + py * vy) / (radius * radius - px * px - py * py)
    rise = (system.gravity + row(work.ground, 2)) / sqrt(1.0 - nx * nx - ny * ny)  # q / n_z: (n_z q)' = -n . n' q / n_z
    lean = nx * vx + ny * vy  # n . v: (n . s)' = n' . s + factor n . v' + bend (v^2)' n . v
    share = ratio / determinant  # change of the reaction per change of the load along the normal
    turn = reaction * (ratio - 1.0) / determinant
    dn = -1.0 / radius  # derivative of n by position
    tx, ty = scale_by_response(system, reaction, sx), scale_by_response(system, reaction, sy)
    for axis in range(system.axes):
        ex, ey = (1.0, 0.0) if axis == 0 else (0.0, 1.0)
        p, v, n, s = row(stage, POSITION + axis), row(stage, VELOCITY + axis), nx, sx
        f = row(stage, DRIVE + axis)
        if axis == 1:
            n, s = ny, sy
        dspeed2 = 2.0 * radial * (v + radial * p)
        gain = bend * dspeed2
        d_reaction = share * (dspeed2 / radius - dn * f - dn * n * rise) - turn * (dn * (2.0 * n - s) - gain * lean)
        write_pair(
            out, BY_POSITION + 2 * axis,
            d_reaction * (nx - tx) + reaction * (dn * ex - gain * vx),
            d_reaction * (ny - ty) + reaction * (dn * ey - gain * vy),
        )  # fmt: skip
        dspeed2 = 2.0 * (v + radial * p)
        gain = bend * dspeed2
        d_reaction = share * dspeed2 / radius + turn * (gain * lean + factor * n)
        write_pair(
            out, BY_VELOCITY + 2 * axis,
            d_reaction * (nx - tx) - reaction * (gain * vx + factor * ex),
            d_reaction * (ny - ty) - reaction * (gain * vy + factor * ey),
        )  # fmt: skip
        d_reaction = -share * n
        write_pair(out, BY_DRIVE + 2 * axis, d_reaction * (nx - tx) + ex, d_reaction * (ny - ty) + ey)
