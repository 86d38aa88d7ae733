"""
Acceleration of the platform: exact equations (3.6)-(3.13) and small-vibration equations (4.3).

Everything is per platform mass m1. The inputs, all horizontal pairs in x, y:
  px, py    position of the platform relative to the plate, m
  fx, fy    driving acceleration: spring force of body 2 over m1 minus ground acceleration, m/s^2
  ux, uy    horizontal ground acceleration xi'', eta'', m/s^2 (used by the small equations only)
  pressure  g + zeta'', m/s^2
  speed2    squared sliding speed v-bar^2 of (3.8), m^2/s^2
  sx, sy    slip vector: friction coefficient times the horizontal part of the slip direction, mu v_h / v-bar
The friction force of both equations is linear in the slip vector, which alone depends on the friction law
(contact/friction.py). All inputs are floats at one instant, or rows at all stages of a step (rows.py).
"""

from __future__ import annotations

from math import sqrt

from reference.solver.compiled import compiled
from reference.solver.rows import Number, broadcast_like


@compiled
def exact_acceleration(
    px: Number,
    py: Number,
    fx: Number,
    fy: Number,
    pressure: Number,
    squared_speed: Number,
    sx: Number,
    sy: Number,
    mass_ratio: float,
    radius: float,
) -> tuple[Number, Number, Number, Number]:
    """
    Return (ax, ay, reaction N / platform mass m1, inertia matrix determinant) by the exact equations (3.9)-(3.13).

    With n = -p / rho the inward normal, M = m_sum / m1 and s the slip vector, Newton's law
        a_h = f + R (n_h - s),   a_z = -pressure + (R / M) (n_z - s_z),   R = N / m1
    and the differentiated constraint n . a = v^2 / rho give R = M (v^2 / rho - n_h . f + n_z pressure) / D with
    D = 1 + (M - 1) (n_h^2 - n_h . s). D is the determinant of M in (3.10) up to a factor that never vanishes; where it
    reaches zero the equations have no solution (Painleve's paradox). R <= 0 means that the contact opens.
    """
    curvature = 1.0 / radius
    nx = -px * curvature
    ny = -py * curvature
    tilt = nx * nx + ny * ny
    nz = sqrt(1.0 - tilt)
    determinant = 1.0 + (mass_ratio - 1.0) * (tilt - nx * sx - ny * sy)
    reaction = mass_ratio * (squared_speed * curvature - nx * fx - ny * fy + nz * pressure) / determinant
    return fx + reaction * (nx - sx), fy + reaction * (ny - sy), reaction, determinant


@compiled
def small_acceleration(
    px: Number,
    py: Number,
    fx: Number,
    fy: Number,
    ux: Number,
    uy: Number,
    pressure: Number,
    sx: Number,
    sy: Number,
    mass_ratio: float,
    radius: float,
) -> tuple[Number, Number, Number, Number]:
    """
    Return (ax, ay, reaction N / platform mass m1, 1 as determinant) by the paper's small-vibration equations (4.3).

    Friction is mu [M (g + zeta'') w - u (p . w) / rho], with mu its coefficient and w the direction of slip. As in the
    paper, terms with xi'' p are kept, and those with the acceleration and the spring force, which are of the same
    order, are left out.
    """
    reaction = mass_ratio * pressure
    lever = (px * sx + py * sy) / radius
    return (
        fx - reaction * (px / radius + sx) + ux * lever,
        fy - reaction * (py / radius + sy) + uy * lever,
        reaction,
        broadcast_like(1.0, reaction),
    )


@compiled
def vertical_motion(
    px: Number, py: Number, vx: Number, vy: Number, ax: Number, ay: Number, radius: float
) -> tuple[Number, Number, Number]:
    """Return height above the sphere's lowest point, m, vertical velocity, m/s, and vertical acceleration, m/s^2, of a
    body that moves along the sphere, by (2.1) and (3.4)-(3.5)."""
    depth = sqrt(radius * radius - px * px - py * py)  # depth below the sphere's center: -Delta of (3.3)
    vz = (px * vx + py * vy) / depth
    az = (vx * vx + vy * vy + vz * vz + px * ax + py * ay) / depth
    return (px * px + py * py) / (radius + depth), vz, az
