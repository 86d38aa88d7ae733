"""
The links of the spatial model: upright bars clamped at both ends, as the engine's connectors halfway up.

A link is stiff in tension and in bending about the horizontal axes, ten times less than the contacts. Bars with an
`axial_stiffness` give way in both as the beams that they are, and the stiffness of the link is part of the model. Its
dampers are then proportional to the stiffness in every direction. Where bars shorten as they sway, an upright rod
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

# Largest stiffness of bars in tension, weights over rho, and in bending: as good as rigid.
MAX_BAR_STIFFNESS = 1e7

# Length of the rods of dampers, in units of length; longer ones round, and mislead the Jacobian.
ROD = 100.0

# Compliance of a stiff link in tension (and, times rho^2, in bending) over that of the contact, under one force.
LINK_COMPLIANCE_RATIO = 10.0


class RigidBodies(NamedTuple):
    """Bodies one above the other: the engine's numbers, masses (N,), centers of mass (N, 3) in units of the model."""

    numbers: list[Any]
    masses: Array
    centers: Array


@dataclass(frozen=True)
class Link:
    """
    A link between neighbors, in units of the model.

    carried: mass above it, and that mass times the place x, y of its center, (3,). shear: stiffness, (2, 2). twist:
    stiffness against twist. bars: those that give way in tension and bending; None where these are stiff.
    """

    connector: Any
    carried: Array
    shear: Array
    twist: float
    bars: BarLink | None = None

    def set_stiffness(self, mbs: Any, penetration: float) -> None:
        """Set the stiffness of a stiff link for contacts of this penetration; bars that give way have their own."""
        if self.bars is None:
            stiff = 1.0 / (LINK_COMPLIANCE_RATIO * penetration)
            set_link_stiffness(mbs, self.connector, self.carried, self.shear, self.twist, stiff)

    def sinking(self, penetration: float) -> float:
        """Shortening of a stiff link along its bars under the weight on it; 0 for bars that give way."""
        return LINK_COMPLIANCE_RATIO * penetration * float(self.carried[0]) if self.bars is None else 0.0

    def lag(self, penetration: float) -> float:
        """Damping over stiffness along a stiff link, in units of time; 0 for bars that give way."""
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
    Add the links between neighbors.

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
        lag = float(np.trace(damper) / np.trace(shear))
        _set_bars(mbs, connector, neighbors, places, carried, own, lag)
        links.append(Link(connector, carried, own.shear * np.eye(2), own.torsion, own))
    return links


def _twist_stiffness(scene: Scene, number: int, units: Units, shear: Array, square_distance: float) -> float:
    """Stiffness against twist of a link that is stiff otherwise, of bars that stand where the supports do."""
    bars, swaying = scene.bodies[number + 1].bars, float(np.diag(shear).mean())
    if bars is None:
        return square_distance * swaying
    square_spread = square_distance if bars.spread is None else (bars.spread / units.length) ** 2
    torsion = bars.count * (bars.torsional_stiffness or 0.0) / bars.length
    return square_spread * swaying + torsion / (units.force * units.length)


def _bars_in_units(bars: BarLink, units: Units) -> BarLink:
    """Return bars in units of the model, no stiffer than the engine resolves."""
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
    """Add a link halfway between two centers of mass (2, 3), on the vertical axis; damping: in shear, (2, 2)."""
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
    forth, back = (_add_end_markers(mbs, bodies, centers, sign * ROD * direction, 0.5) for sign in (1.0, -1.0))
    for ends in (forth, back):
        rod = items.ObjectConnectorSpringDamper(markerNumbers=ends, referenceLength=ROD, damping=0.5 * damping)
        mbs.AddObject(rod)
    # a reference length of -1 turns the sign of the rope's damping, and a regularization force below zero lets it push
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
    """Add markers on two neighbors at the ends of a rod (3,), of which a share lies below halfway up on the axis."""
    half = 0.5 * (centers[1, 2] - centers[0, 2]) * np.array([0.0, 0.0, 1.0])
    axis = [[-center[0], -center[1], 0.0] for center in centers]
    places = (axis[0] + half - below * rod, axis[1] - half + (1.0 - below) * rod)
    return [
        mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localPosition=[*place]))
        for body, place in zip(bodies, places)
    ]


def set_link_stiffness(mbs: Any, connector: Any, carried: Array, shear: Array, twist: float, stiff: float) -> None:
    """Give a link its stiffness in shear, (2, 2), and twist, else `stiff`; carried: (3,), mass and its moments."""
    mass, along_x, along_y = carried
    matrix = np.diag([0.0, 0.0, stiff, stiff, stiff, twist])
    matrix[:2, :2] = shear
    mbs.SetObjectParameter(connector, "stiffness", matrix)
    # the stiff directions are damped critically, twist not at all
    dampers = 2.0 * np.sqrt(np.array([0.0, 0.0, stiff, stiff, stiff, 0.0]) * mass)
    mbs.SetObjectParameter(connector, "damping", np.diag(dampers))
    # at rest the bars carry what stands on them without giving way
    mbs.SetObjectParameter(connector, "offset", [0.0, 0.0, mass / stiff, along_y / stiff, -along_x / stiff, 0.0])


def _set_bars(
    mbs: Any,
    connector: Any,
    bodies: list[Any],
    centers: Array,
    carried: Array,
    bars: BarLink,
    lag: float,
) -> None:
    """Give a link the stiffness of its bars, and dampers `lag` times that, but in shear."""
    _, along_x, along_y = carried
    stiffness = np.array([bars.shear, bars.shear, bars.tension, bars.bending, bars.bending, bars.torsion])
    # at rest the bars have the heights of the scene under the weight that they carry
    offset = [0.0, 0.0, bars.load / bars.tension, along_y / bars.bending, -along_x / bars.bending, 0.0]
    if bars.pendulum:
        stiffness[2] = offset[2] = 0.0
        rod = items.ObjectConnectorSpringDamper(
            markerNumbers=_add_end_markers(mbs, bodies, centers, np.array([0.0, 0.0, bars.pendulum]), 0.5),
            referenceLength=bars.pendulum + bars.load / bars.tension,
            stiffness=bars.tension,
            damping=lag * bars.tension,
        )
        mbs.AddObject(rod)
    add_damper(mbs, bodies, centers, np.array([0.0, 0.0, 1.0]), lag * stiffness[2])
    dampers = np.diag(lag * stiffness * [0.0, 0.0, 0.0, 1.0, 1.0, 1.0])
    mbs.SetObjectParameter(connector, "stiffness", np.diag(stiffness))
    mbs.SetObjectParameter(connector, "damping", dampers)
    mbs.SetObjectParameter(connector, "offset", offset)


def fastest_bar_frequency(links: list[Link], masses: Array, tensors: Array, centers: Array) -> float:
    """Largest angular frequency that bars which give way make of bodies held by nothing else; 0 without bars."""
    if all(link.bars is None for link in links):
        return 0.0
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
