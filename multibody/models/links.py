"""
Links of the spatial model: upright bars clamped at both ends, as connectors of the engine halfway up.

A link is stiff in tension and in bending about the horizontal axes, with a tenth of the contacts' stiffness. Bars with
an `axial_stiffness` give way in both as the beams that they are, and the stiffness of the link is part of the model.
Its dampers are then proportional to the stiffness in every direction. Where bars shorten as they sway, an upright rod
holds the bodies apart in place of the connector's tension: a body on it sinks by u^2 / (2 L). Its force leans with it,
by which the weight that the rod carries at each instant makes the link softer.

The connector's own damper of displacements acts on the difference of two velocities in fixed axes, and takes the
turning of a displaced link for a deformation. So a damper is made of two long rods along an axis of the link, forth and
back between points far out on both bodies. The displacement along the mean of both bodies' axes makes one longer and
the other shorter by as much; the twist makes both shorter. The rods damp their rates, and a rope along both takes
away what that damps their sum. None of them resists a motion of both bodies as one, and each pulls along one line.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from multibody.models.engine import BODY_COORDINATES, exudyn, items
from multibody.models.units import Units
from reference.problem import Scene
from reference.problem.bar_links import BarLink

Array = NDArray[np.float64]

# Largest stiffness of elastic bars in tension, weights / rho, and in bending, weights * rho: stiffer bars act as rigid.
MAX_BAR_STIFFNESS = 1e7

# Length of the rods of dampers, in the model's unit: longer rods make larger rounding errors and a wrong Jacobian.
ROD_LENGTH = 100.0

# Compliance of a stiff link in tension (and, times pendulum length^2, in bending) as a multiple of that of the contact.
LINK_COMPLIANCE_RATIO = 10.0


class RigidBodies(NamedTuple):
    """Object numbers in the engine, masses (N,) and centers of mass (N, 3) of the bodies, in units of the model."""

    numbers: list[Any]
    masses: Array
    centers: Array


@dataclass(frozen=True)
class Link:
    """
    Connector and stiffness of a link between two neighboring bodies, in units of the model.

    carried: mass above the link, and that mass times x and y of its center, (3,). shear: stiffness in shear, (2, 2).
    twist: stiffness against twist. bars: bars that are elastic in tension and bending, too; None where they are stiff.
    """

    connector: Any
    carried: Array
    shear: Array
    twist: float
    bars: BarLink | None = None

    def set_stiffness(self, mbs: Any, penetration: float) -> None:
        """Set the stiffness of a stiff link in proportion to that of the contacts; elastic bars keep their own."""
        if self.bars is None:
            stiff = 1.0 / (LINK_COMPLIANCE_RATIO * penetration)
            set_link_stiffness(mbs, self.connector, self.carried, self.shear, self.twist, stiff)

    def static_settlement(self, penetration: float) -> float:
        """Return the shortening of a stiff link under the weight; 0 for elastic bars, whose heights include it."""
        return LINK_COMPLIANCE_RATIO * penetration * float(self.carried[0]) if self.bars is None else 0.0

    def damping_time(self, penetration: float) -> float:
        """Return the ratio of damping to stiffness along a stiff link, in the model's time unit; 0 for elastic bars."""
        if self.bars is not None:
            return 0.0
        return float(2.0 * np.sqrt(self.carried[0] * LINK_COMPLIANCE_RATIO * penetration))


def add_links(
    mbs: Any,
    scene: Scene,
    units: Units,
    bodies: RigidBodies,
    stiffness: Array,
    damping: Array,
    square_distance: float,
) -> list[Link]:
    """
    Add the links between neighboring bodies to the engine's system, and return them.

    stiffness, damping: in shear, (N - 1, 2, 2). square_distance: mean square of the supports' distance from the axis.
    """
    links = []
    for number, (bars, shear, damper) in enumerate(zip(scene.bar_links, stiffness, damping)):
        above = bodies.masses[number + 1 :]
        carried = np.array([above.sum(), *(above @ bodies.centers[number + 1 :, :2])])
        neighbors, places = bodies.numbers[number : number + 2], bodies.centers[number : number + 2]
        connector = add_link(mbs, neighbors, places, damper)
        if bars is None:
            twist = _twist_stiffness(scene, number, units, shear, square_distance)
            links.append(Link(connector, carried, shear, twist))
            continue
        own = _bars_in_units(bars, units)
        damping_time = float(np.trace(damper) / np.trace(shear))
        _set_bars(mbs, connector, neighbors, places, carried, own, damping_time)
        links.append(Link(connector, carried, own.shear * np.eye(2), own.torsion, own))
    return links


def _twist_stiffness(scene: Scene, number: int, units: Units, shear: Array, square_distance: float) -> float:
    """Return the twist stiffness of a stiff link; its bars stand above the supports unless the scene says otherwise."""
    bars, swaying = scene.bodies[number + 1].bars, float(np.diag(shear).mean())
    if bars is None:
        return square_distance * swaying
    square_spread = square_distance if bars.spread is None else (bars.spread / units.length) ** 2
    torsion = bars.count * (bars.torsional_stiffness or 0.0) / bars.length
    return square_spread * swaying + torsion / (units.force * units.length)


def _bars_in_units(bars: BarLink, units: Units) -> BarLink:
    """Return the bars in units of the model, with at most the largest stiffness that the engine resolves."""
    force, moment = units.force / units.length, units.force * units.length
    return replace(
        bars,
        shear=bars.shear / force,
        bending=min(bars.bending / moment, MAX_BAR_STIFFNESS),
        tension=min(bars.tension / force, MAX_BAR_STIFFNESS),
        torsion=bars.torsion / moment,
        pendulum=bars.pendulum / units.length,
        load=bars.load / units.force,
    )


def add_link(mbs: Any, bodies: list[Any], centers: Array, damping: Array) -> Any:
    """Add the connector of a link halfway between two centers of mass (2, 3), and dampers in shear, (2, 2)."""
    values, directions = np.linalg.eigh(damping)
    for value, direction in zip(values, directions.T):
        add_damper(mbs, bodies, centers, np.append(direction, 0.0), value)
    connector = items.ObjectConnectorRigidBodySpringDamper(
        markerNumbers=_add_end_markers(mbs, bodies, centers, np.zeros(3), 0.0), useIntrinsicFormulation=True
    )
    return mbs.AddObject(connector)


def add_damper(mbs: Any, bodies: list[Any], centers: Array, direction: Array, damping: float) -> None:
    """Add a damper along a `direction` (3,) between the ends of a link."""
    if damping <= 0.0:
        return
    forth, back = (_add_end_markers(mbs, bodies, centers, sign * ROD_LENGTH * direction, 0.5) for sign in (1.0, -1.0))
    for ends in (forth, back):
        rod = items.ObjectConnectorSpringDamper(markerNumbers=ends, referenceLength=ROD_LENGTH, damping=0.5 * damping)
        mbs.AddObject(rod)
    # reference length -1 reverses the sign of the rope's damping; a negative regularizationForce lets the rope push
    rope = items.ObjectConnectorReevingSystemSprings(
        markerNumbers=[*forth, *back[::-1]],
        referenceLength=-1.0,
        dampingPerLength=0.25 * damping,
        regularizationForce=-1.0,
        sheavesAxes=exudyn.Vector3DList([[0.0, 0.0, 1.0]] * 4),
        sheavesRadii=[0.0] * 4,
    )
    mbs.AddObject(rope)


def _add_end_markers(mbs: Any, bodies: list[Any], centers: Array, rod: Array, below: float) -> list[Any]:
    """Add markers on two bodies at the ends of a `rod` (3,) whose share `below` lies below the middle of the link."""
    half = 0.5 * (centers[1, 2] - centers[0, 2]) * np.array([0.0, 0.0, 1.0])
    axis = [[-center[0], -center[1], 0.0] for center in centers]
    places = (axis[0] + half - below * rod, axis[1] - half + (1.0 - below) * rod)
    return [
        mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localPosition=[*place]))
        for body, place in zip(bodies, places)
    ]


def set_link_stiffness(mbs: Any, connector: Any, carried: Array, shear: Array, twist: float, stiff: float) -> None:
    """
    Set the stiffness of a link in units of the model: `shear` (2, 2), `twist`, and `stiff` in tension and bending.

    carried: mass above the link, and that mass times x and y of its center, (3,).
    """
    mass, along_x, along_y = carried
    matrix = np.diag([0.0, 0.0, stiff, stiff, stiff, twist])
    matrix[:2, :2] = shear
    mbs.SetObjectParameter(connector, "stiffness", matrix)
    # the directions with the stiffness `stiff` are damped critically, twist is not damped
    dampers = 2.0 * np.sqrt(np.array([0.0, 0.0, stiff, stiff, stiff, 0.0]) * mass)
    mbs.SetObjectParameter(connector, "damping", np.diag(dampers))
    # at rest the bars carry the weight above them without a change of their length
    mbs.SetObjectParameter(connector, "offset", [0.0, 0.0, mass / stiff, along_y / stiff, -along_x / stiff, 0.0])


def _set_bars(
    mbs: Any,
    connector: Any,
    bodies: list[Any],
    centers: Array,
    carried: Array,
    bars: BarLink,
    damping_time: float,
) -> None:
    """Set stiffness and damping of a link with elastic bars; damping_time: damping over stiffness, except in shear."""
    _, along_x, along_y = carried
    stiffness = np.array([bars.shear, bars.shear, bars.tension, bars.bending, bars.bending, bars.torsion])
    # the heights of the scene are those at rest, under the weight that the bars carry
    offset = [0.0, 0.0, bars.load / bars.tension, along_y / bars.bending, -along_x / bars.bending, 0.0]
    if bars.pendulum:
        stiffness[2] = offset[2] = 0.0
        rod = items.ObjectConnectorSpringDamper(
            markerNumbers=_add_end_markers(mbs, bodies, centers, np.array([0.0, 0.0, bars.pendulum]), 0.5),
            referenceLength=bars.pendulum + bars.load / bars.tension,
            stiffness=bars.tension,
            damping=damping_time * bars.tension,
        )
        mbs.AddObject(rod)
    add_damper(mbs, bodies, centers, np.array([0.0, 0.0, 1.0]), damping_time * stiffness[2])
    dampers = np.diag(damping_time * stiffness * [0.0, 0.0, 0.0, 1.0, 1.0, 1.0])
    mbs.SetObjectParameter(connector, "stiffness", np.diag(stiffness))
    mbs.SetObjectParameter(connector, "damping", dampers)
    mbs.SetObjectParameter(connector, "offset", offset)


def fastest_bar_frequency(links: list[Link], masses: Array, tensors: Array, centers: Array) -> float:
    """Return the largest angular frequency of the bodies on elastic bars alone; 0 without elastic bars."""
    if all(link.bars is None for link in links):
        return 0.0
    # `apart` maps the coordinates of all bodies to the six displacements and rotations of a link's upper end against
    # its lower end, so that the stiffness matrix is a sum over the links. Its fastest mode has the largest eigenvalue.
    size = BODY_COORDINATES * len(masses)
    inertia, stiffness = np.zeros((2, size, size))
    for body, (mass, tensor) in enumerate(zip(masses, tensors)):
        first = BODY_COORDINATES * body
        inertia[first : first + 3, first : first + 3] = mass * np.eye(3)
        inertia[first + 3 : first + 6, first + 3 : first + 6] = tensor
    for number, link in enumerate(links):
        if link.bars is None:
            continue
        half = 0.5 * (centers[number + 1, 2] - centers[number, 2])
        apart = np.zeros((BODY_COORDINATES, size))
        for body, sign in ((number, -1.0), (number + 1, 1.0)):
            lever, first = np.array([*-centers[body, :2], -sign * half]), BODY_COORDINATES * body
            apart[:, first : first + BODY_COORDINATES] = sign * np.eye(BODY_COORDINATES)
            apart[:3, first + 3 : first + 6] = -sign * np.cross(lever, np.eye(3))
        bars = link.bars
        own = np.array([bars.shear, bars.shear, bars.tension, bars.bending, bars.bending, bars.torsion])
        stiffness += apart.T @ (own[:, None] * apart)
    return float(np.sqrt(max(eigh(stiffness, inertia, eigvals_only=True)[-1], 0.0)))
