"""
Dry friction that depends on load and heat: coefficient mu k_T (N / W)^n under a normal force N.

W is the weight, mu the cold coefficient under it, k_T(t) the temperature factor (heating.py), 1 without heating. The
slip vector s of equations.py is multiplied by phi(R) = k_T (R / (M g))^n, where R = N / m1 and M is the mass ratio. In
the exact equations R depends on friction in turn: R (1 + (M - 1) (n_h^2 - phi(R) n_h . s)) = M q, with n_h the
horizontal part of the normal and q the drive along the normal. Without such friction nothing of this is compiled
(variants.py).
"""

from __future__ import annotations

from math import exp, log, sqrt

from reference.problem.friction import LEAST_LOAD
from reference.solver.compiled import compiled
from reference.solver.compiled.variants import choose_variant
from reference.solver.equations import exact_acceleration
from reference.solver.rows import Number, broadcast_like, row_maximum, where_positive
from reference.solver.system import Load, System

MAX_ITERATIONS = 40  # largest number of Newton iterations for the reaction of the contact
LAST_CHANGE = 1e-8  # relative change of the reaction below which its iteration ends: the next is below rounding
# Largest residual of the equation for the contact's normal force, over its right side: above it no solution was found
MAX_MISFIT = 1e-7


@compiled
def _keep_coefficient(system: System, k_t: Number, reaction: Number, coefficient: Number) -> Number:
    """Return `coefficient` unchanged: variant for friction that depends on neither load nor temperature."""
    return coefficient


@compiled
def _coefficient_at_load_and_temperature(system: System, k_t: Number, reaction: Number, coefficient: Number) -> Number:
    """Correct a cold friction coefficient under the weight for temperature factor k_t and normal force `reaction`."""
    return coefficient * load_factor(system, k_t, reaction)


@compiled
def _keep_slip(system: System, reaction: Number, slip: Number) -> Number:
    """Return a component of the slip vector unchanged: variant for friction that does not depend on the load."""
    return slip


@compiled
def _scale_by_response(system: System, reaction: Number, slip: Number) -> Number:
    """Return a slip vector component times the relative change of friction force per relative change of reaction."""
    return slip * (1.0 + elasticity(system, reaction))


# Corrects friction for temperature and load if either changes it (`exponent` is not None); else keeps it
scale_by_load = choose_variant("exponent", _keep_coefficient, _coefficient_at_load_and_temperature)
"""Return a number proportional to the cold friction coefficient under the weight, corrected for k_T and reaction."""

# For derivatives of the acceleration, where friction varies with the load; else a slip vector component as it is
scale_by_response = choose_variant("exponent", _keep_slip, _scale_by_response)
"""Return a slip vector component times the relative change of friction force per relative change of reaction."""


@compiled
def load_factor(system: System, k_t: Number, reaction: Number) -> Number:
    """Return the friction coefficient at temperature factor k_t and a reaction, over the cold one under the weight."""
    return k_t * exp(system.exponent * log(max(reaction / (system.mass_ratio * system.gravity), LEAST_LOAD)))


@compiled
def elasticity(system: System, reaction: Number) -> Number:
    """Return the relative change of the friction coefficient per relative change of the reaction."""
    above = reaction - LEAST_LOAD * system.mass_ratio * system.gravity
    return where_positive(above, broadcast_like(system.exponent, above), broadcast_like(0.0, above))


@compiled
def _acceleration_of_given_slip(
    system: System, load: Load, squared_speed: Number, sx: Number, sy: Number
) -> tuple[Number, Number, Number, Number]:
    """Return ax, ay, reaction over platform mass and inertia determinant for a slip vector independent of the load."""
    pressure = system.gravity + load.uz
    return exact_acceleration(
        load.px, load.py, load.fx, load.fy, pressure, squared_speed, sx, sy, system.mass_ratio, system.radius
    )


@compiled
def _acceleration_of_load(
    system: System, load: Load, squared_speed: Number, sx: Number, sy: Number
) -> tuple[Number, Number, Number, Number]:
    """Return ax, ay, reaction over platform mass and inertia determinant if friction varies with the load or heat."""
    # A friction coefficient that falls with the load (n < 0) makes the equation for the reaction R, at the top of this
    # file, nonlinear: R (`plain` - phi(R) `taken`) = `drive`, with phi(R) = `factor`. The derivative of this equation
    # takes the place of the inertia determinant: where it vanishes, no acceleration exists (Painleve's paradox). If the
    # iteration ends far from a solution, no acceleration exists either: the determinant is set to -1, which the callers
    # read as the paradox.
    curvature = 1.0 / system.radius
    nx, ny = -load.px * curvature, -load.py * curvature
    tilt = nx * nx + ny * ny
    plain = 1.0 + (system.mass_ratio - 1.0) * tilt
    taken = (system.mass_ratio - 1.0) * (nx * sx + ny * sy)
    drive = squared_speed * curvature - nx * load.fx - ny * load.fy + sqrt(1.0 - tilt) * (system.gravity + load.uz)
    drive = system.mass_ratio * drive
    reaction, misfit = drive / plain, drive
    for _ in range(MAX_ITERATIONS):
        factor = load_factor(system, load.k_t, reaction)
        slope = plain - (1.0 + elasticity(system, reaction)) * factor * taken
        misfit = drive - reaction * (plain - factor * taken)
        change = misfit / slope
        reaction += change
        if not row_maximum(abs(change) - LAST_CHANGE * abs(reaction)) > 0.0:
            break
    factor = load_factor(system, load.k_t, reaction)
    determinant = plain - (1.0 + elasticity(system, reaction)) * factor * taken
    determinant = where_positive(abs(misfit) - MAX_MISFIT * abs(drive), broadcast_like(-1.0, determinant), determinant)
    sx, sy = factor * sx, factor * sy
    return load.fx + reaction * (nx - sx), load.fy + reaction * (ny - sy), reaction, determinant


# Solves the exact equations (3.9)-(3.13) for acceleration and reaction, also for friction that varies with load or heat
exact_equations = choose_variant("exponent", _acceleration_of_given_slip, _acceleration_of_load)
"""Return (ax, ay, reaction / platform mass, inertia matrix determinant) by the exact equations (3.9)-(3.13)."""
