"""
Friction that yields elastically before it slides: its force, and the rate of its change.

The friction force is a stiffness k times an elastic displacement e in the tangent plane, and is bounded by mu N. Here
it is q = k e / m1, m/s^2, stored by its horizontal part; kappa = k / m1, R = N / m1, v is the platform's velocity.
  elastic  q' = kappa v + transport            while |q| < mu R
  plastic  |q| = mu R, and e' = v - lambda q / |q| with lambda >= 0: slip along the force turns q by the part of the
           velocity across it. The steps compute the direction of q alone, since its size is mu R.
Transport along the sphere, n (v . q) / rho, keeps q in the tangent plane. The speed in mu is that of the platform, too.
The friction limit mu R, its dependence on speed and load, and the equations of motion are those of sliding friction.
"""

from __future__ import annotations

from math import sqrt

from reference.solver.compiled import compiled
from reference.solver.contact.friction import coefficient, squared_sliding_speed
from reference.solver.contact.load import scale_by_load
from reference.solver.contact.platform import solve_platform_acceleration
from reference.solver.rows import Number, broadcast_like
from reference.solver.system import ELASTIC, Load, System


@compiled
def elastic_acceleration(
    system: System, load: Load, squared_speed: Number, qx: Number, qy: Number
) -> tuple[Number, Number, Number]:
    """Return ax, ay and reaction under friction (qx, qy), both over the platform's mass, by (T13) of docs/theory.md."""
    px, py = load.px, load.py
    pressure = system.gravity + load.uz
    if system.small:
        reaction = system.mass_ratio * pressure
        lever = (px * qx + py * qy) / (system.radius * reaction)
        slope = reaction / system.radius
        return load.fx - slope * px - qx + load.ux * lever, load.fy - slope * py - qy + load.uy * lever, reaction
    nx, ny = -px / system.radius, -py / system.radius
    tilt = nx * nx + ny * ny
    drive = squared_speed / system.radius - nx * load.fx - ny * load.fy + sqrt(1.0 - tilt) * pressure
    held = (system.mass_ratio - 1.0) * (nx * qx + ny * qy)
    reaction = (system.mass_ratio * drive + held) / (1.0 + (system.mass_ratio - 1.0) * tilt)
    return load.fx + reaction * nx - qx, load.fy + reaction * ny - qy, reaction


@compiled
def yielding_motion(
    system: System, contact: int, load: Load, vx: Number, vy: Number, qx: Number, qy: Number
) -> tuple[Number, Number, Number, Number, Number, Number, Number, Number, Number]:
    """
    Return the platform's motion under a friction force over m1, (qx, qy), m/s^2; contact: ELASTIC or PLASTIC.

    The nine values are: ax, ay, reaction / m1, inertia matrix determinant, the rates of q along x and y, m/s^3, the
    limit of |q|, |q| itself (both m/s^2, of full vectors in the tangent plane), and the velocity along q, m/s.
    """
    nx = ny = qz = vz = broadcast_like(0.0, qx)
    nz = broadcast_like(1.0, qx)
    if not system.small:
        nx, ny = -load.px / system.radius, -load.py / system.radius
        nz = sqrt(1.0 - nx * nx - ny * ny)
        qz, vz = -(nx * qx + ny * qy) / nz, -(nx * vx + ny * vy) / nz
    squared_speed = squared_sliding_speed(system, load.px, load.py, vx, vy)
    size = sqrt(qx * qx + qy * qy + qz * qz)
    friction = coefficient(system, sqrt(squared_speed))
    work = vx * qx + vy * qy + vz * qz
    transport = work / system.radius
    if contact == ELASTIC:
        ax, ay, reaction = elastic_acceleration(system, load, squared_speed, qx, qy)
        limit = scale_by_load(system, load.k_t, reaction, friction * reaction)
        turned_x, turned_y, determinant = system.stiffness * vx, system.stiffness * vy, broadcast_like(1.0, qx)
    else:
        ax, ay, reaction, determinant = solve_platform_acceleration(
            system, load, squared_speed, friction * qx / size, friction * qy / size
        )
        limit = scale_by_load(system, load.k_t, reaction, friction * reaction)
        # c = n x q: direction, normal to q in the tangent plane, in which the friction force q rotates
        cx, cy, cz = ny * qz - nz * qy, nz * qx - nx * qz, nx * qy - ny * qx
        turn = system.stiffness * (vx * cx + vy * cy + vz * cz) / (size * limit)
        turned_x, turned_y = turn * cx, turn * cy
    return (
        ax, ay, reaction, determinant, turned_x + nx * transport, turned_y + ny * transport, limit, size, work / size,
    )  # fmt: skip
