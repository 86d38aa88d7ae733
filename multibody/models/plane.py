"""
Contact and start of a flat slider, a platform on a plane: the limit of a sphere of infinite radius.

The engine's contact is that of a sphere with a triangle, which is made so large that no motion leaves it. Friction,
stiffness and damping follow the same laws as those of two spheres. The gap does not depend on the place, so a plane
rounds no more than a sphere of radius one, wherever the platform is.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from multibody.models.contact import ContactLaw, place_on_sphere
from multibody.models.engine import exudyn, items
from multibody.models.units import Units
from reference.problem import Scene, State

Array = NDArray[np.float64]

# Smallest extent, in units of length, of the triangle that the engine has for the plane: larger ones round more.
MIN_TRIANGLE_EXTENT = 1e4

# Extent of the triangle that stands for the plane, as a multiple of the largest distance that the platform can move.
TRIANGLE_EXTENT_OVER_TRAVEL = 2.0


def make_plane_contact(sphere: Any, plane: Any, node: Any, radius: float, law: ContactLaw) -> Any:
    """Return the engine's contact of a sphere with the marker `plane`, at the height that `set_plane_extent` sets."""
    return items.ObjectContactSphereTriangle(
        markerNumbers=[sphere, plane],
        nodeNumber=node,
        sphereRadius=radius,
        includeEdges=0,
        dynamicFriction=law.friction,
        frictionProportionalZone=law.threshold,
    )


def set_plane_extent(mbs: Any, contact: Any, distance: float, height: float) -> None:
    """Set the triangle for the plane at `height`, large enough for a platform that moves `distance`, in model units."""
    extent = max(MIN_TRIANGLE_EXTENT, TRIANGLE_EXTENT_OVER_TRAVEL * distance)
    mbs.SetObjectParameter(contact, "trianglePoints", _make_triangle(extent, height))


def _largest_distance_possible(scene: Scene, units: Units, coordinates: Array, velocities: Array) -> float:
    """Return a bound of the distance that initial state and loading may move a body, in units of length."""
    end = scene.duration / units.time
    loading = 2.0 * scene.largest_acceleration / units.acceleration
    return float(np.abs(coordinates).max() + np.abs(velocities).max() * end + loading * end**2)


def place_on_plane(offset: Array, speed: Array, ground: Array, penetration: float) -> tuple[Array, Array, float, float]:
    """Return position, velocity, gap and slip speed of the platform on the plane; arguments: see `place_on_sphere`."""
    pressed = penetration * float(1.0 + ground[2])
    place = np.array([*offset, penetration - pressed])
    return place, np.array([*speed, 0.0]), -pressed, float(np.hypot(*speed))


def start_platform(
    scene: Scene,
    units: Units,
    bodies: NDArray[np.int_],
    count: int,
    initial: State | None,
    ground: Array,
    penetration: float,
    set_extent: Callable[[float], None],
) -> tuple[Array, Array, float, float]:
    """
    Return the state with the platform on its sphere or plane and all bodies in an initial state (None: at rest).

    bodies: index of the coordinates of the bodies, (N, 3), among `count`. ground: acceleration of the plate, m/s^2,
    (3,). set_extent: makes the plane large enough for a distance. Returns coordinates and velocities (count,), gap and
    slip speed of the contact.
    """
    coordinates, velocities = np.zeros((2, count))
    if initial is not None:
        coordinates[bodies[:, :2]] = np.asarray(initial.position, float) / units.length
        velocities[bodies[:, :2]] = np.asarray(initial.velocity, float) / units.velocity
    if scene.flat:
        set_extent(_largest_distance_possible(scene, units, coordinates, velocities))
    on_surface = place_on_plane if scene.flat else place_on_sphere
    coordinates[:3], velocities[:3], gap, slip = on_surface(
        coordinates[:2], velocities[:2], ground / units.acceleration, penetration
    )
    return coordinates, velocities, gap, slip


def _make_triangle(extent: float, height: float) -> Any:
    """Return the corners of a triangle at `height` whose center is above the origin."""
    points = [[-extent, -extent, height], [2.0 * extent, -extent, height], [-extent, 2.0 * extent, height]]
    return exudyn.Vector3DList(points)
