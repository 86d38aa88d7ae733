"""Variations of a scene that test the paper's assumptions, and the symmetries that make one without effect."""

import itertools
import math
from dataclasses import replace
from typing import Annotated, Any, Literal

import numpy as np

from comparison.result_types import result
from reference.problem import Scene, SceneError
from reference.problem.reductions import (
    has_half_turn_symmetry,
    has_one_axis_per_harmonic,
    is_mirror_symmetric,
    is_planar,
)

ROUNDING = 1e-9  # tolerance in tests of symmetry: share of the ring's radius (offsets) or of 90 degrees (angles)
# Reason why rotation of the links about the vertical has no effect, as users read it
TURNED_LINK = "links equally stiff along x and y below square boxes: turned, they are the same"
# Reason why no body rotates about the vertical, as users read it
ONE_PLANE = "loading and bodies are their own mirror images about the plane of the motion: nothing turns out of it"


@result
class Variation:
    """Change of a scene: ring and number of supports, heights, offset and yaw of bodies, effect of load on bars."""

    ring: Annotated[float, "radius of the ring, as a multiple of the stated one"] = 1.0
    height: Annotated[float, "heights of the bodies, as multiples of the stated ones"] = 1.0
    supports: Annotated[int | None, "number of supports; null for the stated one"] = None
    oval: Annotated[float, "share by which the ring of supports is narrowed along the direction"] = 0.0
    offset: float = 0.0
    """distance by which centers of mass above the platform are moved in the direction, over the radius of the ring"""
    direction: Annotated[float, "direction of `oval` and of `offset`, rad from the x axis"] = 0.0
    yaw: Annotated[float, "angle by which bodies above the platform and their links are turned, rad"] = 0.0
    bars: Literal["softening", "shortening"] | None = None
    """what the weight above does to bars that give way: softening or shortening; null as stated"""

    def of(self, scene: Scene) -> Scene:
        """Return the scene changed by this variation."""
        radius, stated = float(scene.support_radius or np.nan), scene.isolator.supports
        along = np.array([math.cos(self.direction), math.sin(self.direction)])
        values: dict[str, Any] = {"isolator.supports": self.supports or stated, "isolator.ring": radius * self.ring}
        if isinstance(stated, list) and self.supports is None:
            values = {"isolator.supports": self.ring * np.array(stated)}
        if self.oval:
            narrowed = np.array(scene.support_places) @ (np.eye(2) - self.oval * np.outer(along, along))
            values = {"isolator.supports": self.ring * narrowed, "isolator.ring": None}
        for number, body in enumerate(scene.bodies):
            values[f"bodies.{number}.height"] = float(body.height or 0.0) * self.height
            if number and self.offset:
                values[f"bodies.{number}.offset"] = scene.offsets[number] + self.offset * radius * along
            if number and self.yaw:
                values[f"bodies.{number}.yaw"] = float(scene.yaws[number] + self.yaw)
            if self.bars and body.bars is not None:
                gives_way = body.bars.axial_stiffness is not None
                values[f"bodies.{number}.bars.load_effect"] = self.bars if gives_way else "softening"
        return scene.with_values(values)


FEW = (  # variations that a study computes in each scene: ring radius and heights, times the stated ones
    *(Variation(ring=ring) for ring in (0.5, 1.0, 2.0)),
    Variation(height=0.0),
)
MANY = (  # variations that `phase-resonance assumptions` computes: ring, heights (times the stated ones), 3 supports
    *(Variation(ring, height) for ring in (0.5, 1.0, 2.0, 4.0, 8.0) for height in (0.0, 0.25, 0.5, 1.0)),
    *(Variation(ring, 2.0) for ring in (1.0, 2.0, 4.0, 8.0)),  # On the narrowest ring (0.5) buildings overturn.
    Variation(supports=3),
)
# Variations of bars with axial stiffness: the weight above softens them; in the second they also shorten in sway
UNDER_LOAD = (Variation(bars="softening"), Variation(bars="shortening"))

Axis = Literal["ring", "height", "oval", "offset", "yaw"]  # quantity of the building that is varied
DIRECTED: tuple[Axis, ...] = ("oval", "offset", "yaw")  # varied in several directions to find the worst one
# First size of each variation, at which its directions are compared; bodies are also turned by half this yaw
FIRST_SIZE = {
    "oval": 0.5,  # share of the ring's radius
    "offset": 0.1,  # share of the ring's radius: about the accidental eccentricity of design codes, width / 20
    "yaw": 0.2,  # rad
}
# Smallest size of each variation; smaller ones are not tried, even if the assumption fails at this one
SMALLEST_SIZE = {"oval": 0.5, "offset": 0.025, "yaw": 0.05}
# Largest size tried of each variation; beyond it supports lift off, or the plan has little to do with the stated one
LARGEST_SIZE = {"oval": 0.5, "offset": 0.4, "yaw": math.pi / 4.0}
DIRECTIONS = 4  # directions of an oval or offset tried for the worst: in 180 degrees, or in 90 where symmetry allows


def with_size(variation: Variation, key: Axis, size: float) -> Variation:
    """Return the variation with the size of its quantity `key` replaced; direction and sign stay."""
    changes: dict[str, Any] = {key: math.copysign(size, getattr(variation, key))}
    return replace(variation, **changes)


def trials_of(scene: Scene, key: Axis) -> list[Variation]:
    """
    Return variations of one quantity (oval, offset or yaw) in several directions, no two equivalent by symmetry.

    An offset has a full turn of directions and an oval half a one. A half turn of the loading makes opposite offsets
    equivalent, mirror images about both axes or about the plane of the motion make a quarter of a turn enough. An angle
    has two directions and is tried at two sizes.
    """
    size = FIRST_SIZE[key]
    if key == "yaw":
        return [Variation(yaw=part * size) for part in (1.0, -1.0, 0.5, -0.5)]
    plane = plane_of_symmetry(scene)
    if plane is not None:  # one direction more: an offset in the plane has no effect
        start, turn, count = plane, math.pi / 2.0, DIRECTIONS + 1
    elif has_one_axis_per_harmonic(scene) and is_mirror_symmetric(scene):
        start, turn, count = 0.0, math.pi / 2.0, DIRECTIONS
    else:
        opposite = key == "oval" or bool(has_half_turn_symmetry(scene))
        count = DIRECTIONS if opposite else 2 * DIRECTIONS
        start, turn = 0.0, (math.pi if opposite else 2.0 * math.pi) * (1.0 - 1.0 / count)
    directions = (start + turn * step / (count - 1) for step in range(count))
    sized: dict[str, Any] = {key: size}
    return [Variation(direction=direction, **sized) for direction in directions]


def blind_by_symmetry(scene: Scene, variation: Variation) -> str:
    """
    Return why symmetry makes a variation useless as a test, or "".

    With such a symmetry the spatial and the translational model have equal amplifications.
    """
    if variation.bars is not None or any(link is not None for link in scene.bar_links):
        return ""  # Bars that bend tilt the body on them, even in plane motion: no symmetry.
    if variation.yaw and replace(variation, yaw=0.0) == Variation() and are_turned_links_the_same(scene):
        return TURNED_LINK
    if scene.isolator.support_stiffness is not None or scene.dry_friction.depends_on_load:
        return ""  # no symmetry: unequal loads of the supports tilt the platform or change friction
    try:
        varied = variation.of(scene)
    except SceneError:  # the varied scene is invalid: computing it will give the reason
        return ""
    return "" if plane_of_symmetry(varied) is None else ONE_PLANE


def are_turned_links_the_same(scene: Scene) -> bool:
    """Return whether links are as stiff and damped along x as along y, and the boxes above the platform square."""
    links = itertools.chain(scene.stiffness, scene.damping)
    return all(x == y for x, y in links) and all(body.size is None or is_square(body.size) for body in scene.bodies[1:])


def is_square(size: Any) -> bool:
    """Return whether a box of that size is square in plan."""
    return bool(size[0] == size[1])


def plane_of_symmetry(scene: Scene) -> float | None:
    """
    Return the direction, rad, of the vertical plane about which loading, links and bodies are mirror images; or None.

    The motion of a scene at rest stays in it, whatever the places of the supports. Their loads are in balance with
    what overturns in the plane, so that friction in proportion to them, all along the plane, has no moment about the
    vertical; and its sum is that of the whole weight, as in translation.
    """
    if not is_planar(scene) or scene.support_places is None:
        return None
    horizontal = scene.amplitudes[:2]
    if not horizontal.any():
        return None
    along = horizontal[:, np.abs(horizontal).sum(axis=0).argmax()]
    along = along / np.hypot(*along)
    across = np.array([-along[1], along[0]])
    direction = math.atan2(along[1], along[0])
    reach = float(np.abs(scene.support_places).max())
    centered = bool((np.abs(scene.offsets @ across) <= ROUNDING * reach).all())
    boxes = all(
        body.size is None or is_square(body.size) or is_multiple(direction - yaw, math.pi / 2.0)
        for body, yaw in zip(scene.bodies, scene.yaws)
    )
    return direction if centered and boxes else None


def is_multiple(angle: float, unit: float) -> bool:
    """Return whether an angle is an integer multiple of `unit`, within ROUNDING."""
    return abs(angle / unit - round(angle / unit)) <= ROUNDING
