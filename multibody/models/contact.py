"""
Contact of the platform in every model: its friction law, and the states from which a run starts or continues.

The friction law has a corner at v_reg: friction is linear in the slip speed below it, and constant above.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from multibody.models.friction_springs import slide_end_speed
from multibody.models.state import EngineState
from multibody.models.units import Units
from reference.problem import Scene

Array = NDArray[np.float64]

# Damping ratio of the contact: at 1 its vibration along the normal dies out within a few of its periods.
DAMPING_RATIO = 1.0

# Rounding error of a position, in units of length. Divided by the contact's penetration under the weight, it is the
# rounding error of the contact force, in weights.
POSITION_ROUNDING = 1e-15

# Slip speed, in units of velocity, up to which the friction coefficient of a lubricated contact grows linearly with
# the slip speed: no motion reaches it.
LUBRICATED_SPEED_LIMIT = 1e6


class ContactLaw(NamedTuple):
    """
    Friction coefficient of the engine's contact, and the slip speed below which friction falls linearly to zero.

    The threshold is in units of velocity. Where friction depends on slip speed or load, the coefficient is the largest
    under the weight: `SpeedFriction` sets it before every step.
    """

    friction: float
    threshold: float


def contact_law(scene: Scene, regularization: float | None, units: Units) -> ContactLaw:
    """Return the friction law of the contact; regularization: v_reg, m/s, None without dry friction."""
    if scene.lubricated:
        return ContactLaw(scene.friction_coefficient * units.velocity * LUBRICATED_SPEED_LIMIT, LUBRICATED_SPEED_LIMIT)
    if scene.dry_friction.elastic:
        return ContactLaw(scene.friction_coefficient, slide_end_speed(scene, units))
    if regularization is None:
        return ContactLaw(scene.friction_coefficient, 1.0)
    return ContactLaw(scene.friction_coefficient, regularization / units.velocity)


def set_contact_parameters(
    mbs: Any,
    contact: Any,
    radii: list[float] | float,
    penetration: float,
    count: int = 1,
    damping_ratio: float = DAMPING_RATIO,
) -> None:
    """
    Set stiffness and damping of one of `count` contacts that share the weight, in units of the model.

    radii: radii of sphere and depression, or the radius of a sphere on a plane. penetration: by the weight, the inverse
    of the stiffness of all contacts together.
    """
    mbs.SetObjectParameter(contact, "spheresRadii" if isinstance(radii, list) else "sphereRadius", radii)
    # the total mass, 1, on the stiffness k = 1 / penetration is damped critically by 2 sqrt(k)
    mbs.SetObjectParameter(contact, "contactStiffness", 1.0 / (count * penetration))
    mbs.SetObjectParameter(contact, "contactDamping", 2.0 * damping_ratio / (count * np.sqrt(penetration)))


def corner_and_relaxation(scene: Scene, regularization: float | None, units: Units) -> tuple[float, float]:
    """
    Return the slip speed at the corner of the friction law, and the relaxation time of a slower slip.

    Both are in units of the model, and inf if the law has no corner. The relaxation time is m1 v_reg / (mu m_sum g)
    with the platform's mass m1, the friction coefficient mu and the total mass m_sum.
    """
    friction, threshold = contact_law(scene, regularization, units)
    if scene.lubricated or friction == 0.0 or scene.dry_friction.elastic:
        return math.inf, math.inf
    return threshold, float(scene.masses[0]) / scene.total_mass * threshold / friction


def viscous_relaxation(scene: Scene, units: Units) -> float:
    """
    Return the relaxation time of a lubricated platform's slip speed, in the model's time unit; inf if not lubricated.

    It is m1 / (f_c m_sum g) with the platform's mass m1, the viscous friction coefficient f_c and the total mass m_sum.
    """
    friction = scene.friction_coefficient * units.velocity if scene.lubricated else 0.0
    return float(scene.masses[0]) / scene.total_mass / friction if friction > 0.0 else math.inf


def place_on_sphere(
    offset: Array, speed: Array, ground: Array, penetration: float
) -> tuple[Array, Array, float, float]:
    """
    Return position, velocity, gap and slip speed of a platform on the sphere, pressed in as if all mass were one body.

    offset, speed: horizontal (2,). ground: the plate's acceleration (3,). Returns displacement (3,), velocity (3,),
    gap and slip speed, all in units of the model. For several bodies off the vertical the penetration is not exact; the
    contact damps the difference out within a few of its own time constants.
    """
    height = float(np.sqrt(max(1.0 - float(offset @ offset), 0.0)))
    normal = np.array([-offset[0], -offset[1], height])
    vertical = float(offset @ speed) / height if height > 0.0 else np.inf
    # the contact carries the weight, the inertia of the mass in the accelerated frame, and the centripetal force
    slip = float(np.sqrt(speed @ speed + vertical**2))
    pressed = penetration * float(normal @ ground + normal[2] + slip**2)
    place = np.array([0.0, 0.0, 1.0]) - normal * (1.0 + pressed - penetration)
    return place, np.array([*speed, vertical]), -pressed, slip


def settle_contact(state: EngineState, gap_rate: float, penetration: float, normal: list[float]) -> EngineState:
    """
    Return the state with the same contact force, made by the penetration alone and no longer by the contact's damper.

    At a step h the engine's position and velocity disagree along the normal by O(h^2). The contact's damper makes a
    force of that, which a change of the gap balances. With a smaller step the balance would be lost and the force ring.

    gap_rate: rate at which the gap grows. normal: unit normal of the contact, (3,).
    """
    coordinates, velocities, contact = state.coordinates.copy(), state.velocities.copy(), state.contact.copy()
    damping = 2.0 * DAMPING_RATIO / math.sqrt(penetration)
    excess_speed = sum(share * speed for share, speed in zip(normal, velocities[:3].tolist())) - gap_rate
    # a change of the position along the normal makes the contact's spring exert the force that its damper exerted
    rise = -penetration * damping * excess_speed
    for axis, share in enumerate(normal):
        velocities[axis] -= share * excess_speed
        coordinates[axis] -= share * rise
    contact[0] -= rise
    return replace(state, coordinates=coordinates, velocities=velocities, contact=contact)
