"""
Friction laws at the contact: slip vectors (friction over normal force) and the conditions for rest.

Laws: dry and set-valued (2.5), dry and linear below the speed v_reg, lubricated with mu = f_c v (3.14); mu is the
friction coefficient. Each gives a slip vector s = factor * v_h with v_h the horizontal velocity:
  sliding     factor = mu / v       (v the full sliding speed (3.8))
  creeping    factor = mu / v_reg   (v < v_reg)
  lubricated  factor = f_c
The dry coefficient may depend on the sliding speed, mu(v) = mu(0) + rise (1 - exp(-rate v)). The condition for rest
takes `static_coefficient` and the directions at a stop `kinetic_coefficient`, both mu(0). Where the coefficient depends
on the normal force or on heating as well, these are the cold values under the weight, and
`solve_platform_acceleration` (platform.py) corrects the slip vector by load.py. In the solver only this file reads the
law of a system (reference/problem/friction.py), and yielding.py the stiffness of friction that yields.
"""

from __future__ import annotations

from math import cos, exp, expm1, sin, sqrt

from reference.solver.compiled import compiled
from reference.solver.contact.load import scale_by_load
from reference.solver.rows import Number, broadcast_like, where_positive
from reference.solver.system import CREEPING, Load, System

SMALLEST_SPEED = 1e-200  # m/s: the square of a slower speed underflows, so a slower slide has stopped


@compiled
def static_coefficient(system: System) -> float:
    """Return the static friction coefficient of the platform when the contact carries just the weight."""
    return system.friction


@compiled
def kinetic_coefficient(system: System) -> float:
    """Return the friction coefficient in sliding at vanishing speed when the contact carries just the weight."""
    return system.friction


@compiled
def viscous_factor(system: System) -> float:
    """Return f_c, s/m, of a lubricated contact, whose friction coefficient is f_c times the sliding speed (3.14)."""
    return system.friction


@compiled
def static_limit(system: System, k_t: Number, reaction: Number) -> Number:
    """Return the largest friction force at rest under a normal force `reaction`, both over the platform's mass, m/s^2.

    k_t is the factor by which temperature changes the friction coefficient.
    """
    return scale_by_load(system, k_t, reaction, static_coefficient(system) * reaction)


@compiled
def coefficient(system: System, speed: Number) -> Number:
    """Return the dry friction coefficient at a sliding speed, m/s, when the contact carries just the weight."""
    if system.rate == 0.0:
        return broadcast_like(system.friction, speed)
    return system.friction - system.rise * expm1(-system.rate * speed)


@compiled
def coefficient_slope(system: System, speed: Number) -> Number:
    """Return the derivative of the dry friction coefficient by the sliding speed, s/m, at a speed in m/s."""
    return system.rise * system.rate * exp(-system.rate * speed)


@compiled
def rising_rate(system: System, speed: float) -> float:
    """Return the rate, 1/s, at which friction that grows with speed makes a small change of speed decay; else 0."""
    return max(0.0, coefficient_slope(system, speed)) * system.mass_ratio * system.gravity


@compiled
def squared_sliding_speed(system: System, px: Number, py: Number, vx: Number, vy: Number) -> Number:
    """Return the squared sliding speed, m^2/s^2: along the sphere (3.8), or horizontal for small vibrations (4.3)."""
    planar = vx * vx + vy * vy
    if system.small:
        return planar
    radial = px * vx + py * vy
    return planar + radial * radial / (system.radius * system.radius - px * px - py * py)


@compiled
def squared_rest_excess_exact(system: System, load: Load) -> tuple[Number, Number]:
    """
    Return squared tangential force minus squared friction limit, m^2/s^4, and reaction over m1, by the exact equations.

    The force that holds the platform at rest is (-f, M pressure) per m1. Rest is possible while its tangential part is
    at most the friction coefficient mu times its normal part N > 0: while |T|^2 - (mu N)^2 is not positive.
    """
    nx = -load.px / system.radius
    ny = -load.py / system.radius
    nz = sqrt(1.0 - nx * nx - ny * ny)
    rz = system.mass_ratio * (system.gravity + load.uz)
    normal = -load.fx * nx - load.fy * ny + rz * nz
    tx = -load.fx - normal * nx
    ty = -load.fy - normal * ny
    tz = rz - normal * nz
    limit = static_limit(system, load.k_t, normal)
    return tx * tx + ty * ty + tz * tz - limit * limit, normal


@compiled
def squared_rest_excess_small(system: System, load: Load) -> tuple[Number, Number]:
    """
    Return the values of `squared_rest_excess_exact`, by the equations for small vibration (4.3).

    F_3 = f - R p / rho is the tangential force to be held, and Mf e, with Mf = mu (R I - u p^T / rho), the largest
    friction against a slip direction e, |e| = 1. Here R = M (g + zeta'') is the reaction, f the driving acceleration, u
    the ground's and p the position. Rest is possible while |Mf^-1 F_3| <= 1. With Mf^-1 = adj / det the excess is
    |adj F_3|^2 - det^2, so that nothing is divided by a small number.
    """
    px, py, radius = load.px, load.py, system.radius
    reaction = system.mass_ratio * (system.gravity + load.uz)
    friction = scale_by_load(system, load.k_t, reaction, static_coefficient(system))
    gx = load.fx - reaction * px / radius
    gy = load.fy - reaction * py / radius
    a = friction * (reaction - load.ux * px / radius)
    b = -friction * load.ux * py / radius
    c = -friction * load.uy * px / radius
    d = friction * (reaction - load.uy * py / radius)
    hx = d * gx - b * gy
    hy = a * gy - c * gx
    det = a * d - b * c
    scale = friction * friction * reaction * reaction  # divisor that gives the difference of squares the unit m^2/s^4
    return where_positive(scale, (hx * hx + hy * hy - det * det) / scale, gx * gx + gy * gy), reaction


@compiled
def squared_rest_excess_as_printed(system: System, load: Load) -> Number:
    """
    Return squared tangential force minus squared friction limit at rest, m^2/s^4, by (4.6) as printed in the paper.

    The components of F_F are mu N each, so the limit is sqrt(2) mu N at the origin. F_3 has gravity and spring with the
    printed signs. It serves to measure the effect of this misprint.
    """
    reaction = system.mass_ratio * (system.gravity + load.uz)
    friction = scale_by_load(system, load.k_t, reaction, static_coefficient(system))
    lx = friction * (reaction - load.ux * (load.px + load.py) / system.radius)
    ly = friction * (reaction - load.uy * (load.px + load.py) / system.radius)
    # Equation (4.6) in the paper has the spring force, f + u (drive + ground acceleration), with the opposite sign.
    gx = -(2.0 * load.ux + load.fx) + reaction * load.px / system.radius
    gy = -(2.0 * load.uy + load.fy) + reaction * load.py / system.radius
    return gx * gx + gy * gy - lx * lx - ly * ly


@compiled
def slip_direction_cosines(angle: float, axes: int) -> tuple[float, float]:
    """Return cosine and sine of the angle of a slip direction; exactly 1 or -1, and 0, in motions along x alone."""
    cosine, sine = cos(angle), sin(angle)  # next to each other, so that the compiler computes both in one call
    if axes == 1:
        return (1.0 if cosine > 0.0 else -1.0), 0.0
    return cosine, sine


@compiled
def slip_vector(
    system: System, px: Number, py: Number, speed: Number, ex: Number, ey: Number
) -> tuple[Number, Number, Number]:
    """
    Return the slip vector (horizontal friction over normal force) along x and y of a slide in the direction (ex, ey).

    `speed` is its horizontal speed, m/s. The third value is the ratio of its full to its horizontal speed.
    """
    ratio = sqrt(squared_sliding_speed(system, px, py, ex, ey))
    friction = coefficient(system, speed * ratio) / ratio
    return friction * ex, friction * ey, ratio


@compiled
def largest_coefficient(system: System) -> float:
    """Return the largest friction coefficient at any speed when the contact carries just the weight."""
    largest: float = system.friction + max(0.0, system.rise)
    return largest


@compiled
def decay_rate(system: System, contact: int) -> float:
    """Return the rate, 1/s, at which friction proportional to velocity (creep, lubricated) makes the velocity decay."""
    largest = largest_coefficient(system)
    factor = largest / system.v_reg if contact == CREEPING else largest
    rate: float = factor * system.mass_ratio * system.gravity
    return rate


@compiled
def turning_rate(system: System, speed: float) -> float:
    """Return the rate, 1/s, at which friction makes a velocity component across the sliding direction decay."""
    rate: float = largest_coefficient(system) * system.mass_ratio * system.gravity / max(speed, SMALLEST_SPEED)
    return rate
