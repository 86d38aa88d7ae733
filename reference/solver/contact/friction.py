"""
Friction at the contact: slip vectors, the condition for rest, the direction in which a slide begins.

Laws: dry and set-valued (2.5), dry and linear below the speed v_reg, lubricated with mu = f_c v (3.14). Each gives
a slip vector s = factor * v_h with v_h the horizontal velocity:
  sliding     factor = mu / v       (v the full sliding speed (3.8))
  creeping    factor = mu / v_reg   (v < v_reg)
  lubricated  factor = f_c
"""

from __future__ import annotations

from math import cos, sin, sqrt

from reference.solver.compiled import compiled


@compiled
def sliding_speed2(px: float, py: float, vx: float, vy: float, radius: float, small: bool) -> float:
    """Squared sliding speed: v-bar^2 of (3.8), or the horizontal one in the small equations (4.3)."""
    planar = vx * vx + vy * vy
    if small:
        return planar
    climb = px * vx + py * vy
    return planar + climb * climb / (radius * radius - px * px - py * py)


@compiled
def rest_excess_exact(
    px: float, py: float, fx: float, fy: float, pressure: float, friction: float, mass_ratio: float, radius: float
) -> tuple[float, float]:
    """
    Consistent condition for rest of the exact equations: (excess, reaction / m1).

    The force that holds the platform at rest is (-f, M pressure) per m1; rest is possible while its tangential part is
    at most mu times its normal part N > 0: while the excess |T|^2 - (mu N)^2 is not positive.
    """
    nx = -px / radius
    ny = -py / radius
    nz = sqrt(1.0 - nx * nx - ny * ny)
    rz = mass_ratio * pressure
    normal = -fx * nx - fy * ny + rz * nz
    tx = -fx - normal * nx
    ty = -fy - normal * ny
    tz = rz - normal * nz
    limit = friction * normal
    return tx * tx + ty * ty + tz * tz - limit * limit, normal


@compiled
def rest_excess_small(
    px: float,
    py: float,
    fx: float,
    fy: float,
    ux: float,
    uy: float,
    pressure: float,
    friction: float,
    mass_ratio: float,
    radius: float,
) -> tuple[float, float]:
    """
    Consistent condition for rest of (4.3): (excess, reaction / m1); rest while |Mf^-1 F_3| <= 1 (4.6, corrected).

    Mf = mu (R I - u p^T / rho) with R = M (g + zeta''); F_3 = f - R p / rho. The excess is |adj F_3|^2 - det^2 with
    Mf^-1 = adj / det, so that nothing is divided by a small number.
    """
    reaction = mass_ratio * pressure
    gx = fx - reaction * px / radius
    gy = fy - reaction * py / radius
    a = friction * (reaction - ux * px / radius)
    b = -friction * ux * py / radius
    c = -friction * uy * px / radius
    d = friction * (reaction - uy * py / radius)
    hx = d * gx - b * gy
    hy = a * gy - c * gx
    det = a * d - b * c
    scale = friction * friction * reaction * reaction  # the unit of the exact excess
    return (hx * hx + hy * hy - det * det) / scale if scale > 0.0 else gx * gx + gy * gy, reaction


@compiled
def rest_excess_printed(
    px: float,
    py: float,
    fx: float,
    fy: float,
    ux: float,
    uy: float,
    pressure: float,
    friction: float,
    mass_ratio: float,
    radius: float,
) -> float:
    """
    |F_3|^2 - |F_F|^2 of (4.6) as printed: the components of F_F are mu N each, so the limit is sqrt(2) mu N at the
    origin, and F_3 carries gravity and spring with the printed signs. Kept to measure what the slip costs.
    """
    reaction = mass_ratio * pressure
    lx = friction * (reaction - ux * (px + py) / radius)
    ly = friction * (reaction - uy * (px + py) / radius)
    gx = -(2.0 * ux + fx) + reaction * px / radius  # spring force f + u with its sign turned
    gy = -(2.0 * uy + fy) + reaction * py / radius
    return gx * gx + gy * gy - lx * lx - ly * ly


@compiled
def heading(angle: float, axes: int) -> tuple[float, float]:
    """Cosine and sine of a slip direction; along x exactly where the motion stays in that plane."""
    if axes == 1:
        return (1.0 if cos(angle) > 0.0 else -1.0), 0.0
    return cos(angle), sin(angle)


@compiled
def slip_vector(
    px: float, py: float, ex: float, ey: float, friction: float, radius: float, small: bool
) -> tuple[float, float, float]:
    """Slip vector of dry sliding in the horizontal direction (ex, ey), and the ratio of full to horizontal speed."""
    ratio = sqrt(sliding_speed2(px, py, ex, ey, radius, small))
    return friction * ex / ratio, friction * ey / ratio, ratio
