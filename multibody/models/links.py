"""
The links of the spatial model: upright bars clamped at both ends, as the engine's connectors half-way up.

A link is stiff in tension and in bending about the horizontal axes, ten times less than the contacts. Bars with an
`axial_stiffness` give way in both as the beams that they are, and the stiffness of the link is part of the model. Its
dampers are then proportional to the stiffness in every direction. Where bars shorten as they sway, an upright rod
holds the bodies apart in place of the connector's tension: a body on it sinks by u^2 / (2 L). Its force leans with it,
by which the weight that the rod carries at each instant makes the link softer.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from multibody.models.engine import items
from multibody.models.units import Units
from reference.problem import Scene
from reference.problem.bar_links import BarLink, bar_links

Array = NDArray[np.float64]

PER_BODY = 6  # coordinates: x, y, z of the center of mass and three rotations
MAX_BAR_STIFFNESS = 1e7  # of bars in tension, weights over rho, and in bending: as good as rigid
LINK_COMPLIANCE_RATIO = 10.0  # of a bar in tension (and, times rho^2, in bending) over the contact, under one force


@dataclass(frozen=True)
class Link:
    """A link between neighbors, in units of the model."""

    connector: Any
    carried: Array  # (3,), mass above it, and that mass times the place x, y of its center
    shear: Array  # (2, 2), stiffness
    damping: Array  # (2, 2), in shear
    twist: float  # stiffness against twist
    bars: BarLink | None = None  # that give way in tension and bending; None: these are stiff

    def set_stiffness(self, mbs: Any, penetration: float) -> None:
        """Stiffness of a link that is stiff beside contacts of this penetration; bars that give way have their own."""
        if self.bars is None:
            stiff = 1.0 / (LINK_COMPLIANCE_RATIO * penetration)
            set_link_stiffness(mbs, self.connector, self.carried, self.shear, self.damping, self.twist, stiff)

    def sinking(self, penetration: float) -> float:
        """How far a stiff link gives way along its bars under the weight on it; 0 for bars that give way."""
        return LINK_COMPLIANCE_RATIO * penetration * float(self.carried[0]) if self.bars is None else 0.0

    def lag(self, penetration: float) -> float:
        """Damping over stiffness along a link that is stiff; 0 for bars that give way."""
        if self.bars is not None:
            return 0.0
        return float(2.0 * np.sqrt(self.carried[0] * LINK_COMPLIANCE_RATIO * penetration))


def add_links(
    mbs: Any,
    scene: Scene,
    units: Units,
    bodies: list[Any],
    masses: Array,
    centers: Array,
    stiffness: Array,
    damping: Array,
    square_distance: float,
) -> list[Link]:
    """Links between neighbors. stiffness, damping: in shear, (N - 1, 2, 2). Supports so far from the axis, squared."""
    links = []
    for number, (bars, shear, damper) in enumerate(zip(bar_links(scene), stiffness, damping)):
        above = masses[number + 1 :]
        carried = np.array([above.sum(), *(above @ centers[number + 1 :, :2])])
        neighbors, places = bodies[number : number + 2], centers[number : number + 2]
        connector = add_link(mbs, neighbors, places)
        if bars is None:
            twist = _twist(scene, number, units, shear, square_distance)
            links.append(Link(connector, carried, shear, damper, twist))
            continue
        own = _in_units(bars, units)
        _set_bars(mbs, connector, neighbors, places, carried, own, damper, float(np.trace(damper) / np.trace(shear)))
        links.append(Link(connector, carried, own.shear * np.eye(2), damper, own.torsion, own))
    return links


def _twist(scene: Scene, number: int, units: Units, shear: Array, square_distance: float) -> float:
    """Stiffness against twist of a link that is stiff otherwise, of bars that stand where the supports do."""
    bars, swaying = scene.bodies[number + 1].bars, float(np.diag(shear).mean())
    if bars is None:
        return square_distance * swaying
    square_spread = square_distance if bars.spread is None else (bars.spread / units.length) ** 2
    torsion = bars.count * (bars.torsional_stiffness or 0.0) / bars.length
    return square_spread * swaying + torsion / (units.force * units.length)


def _in_units(bars: BarLink, units: Units) -> BarLink:
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


def add_link(mbs: Any, bodies: list[Any], centers: Array) -> Any:
    """
    The link between two neighbors with centers of mass (2, 3), half-way up between them and on the vertical axis.

    `set_link_stiffness` completes it.
    """
    return mbs.AddObject(
        items.ObjectConnectorRigidBodySpringDamper(
            markerNumbers=_ends(mbs, bodies, centers, 0.0), useIntrinsicFormulation=True
        )
    )


def _ends(mbs: Any, bodies: list[Any], centers: Array, length: float) -> list[Any]:
    """Markers on two neighbors at the ends of a rod of a length, upright on the axis, its middle half-way up."""
    middle = 0.5 * (centers[1, 2] - centers[0, 2] - length)
    return [
        mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localPosition=[-center[0], -center[1], sign * middle]))
        for body, center, sign in zip(bodies, centers, (1.0, -1.0))
    ]


def set_link_stiffness(
    mbs: Any, bars: Any, carried: Array, shear: Array, damping: Array, twist: float, stiff: float
) -> None:
    """
    Give bars the scene's stiffness and damping in shear, (2, 2) each, stiffness in twist, and `stiff` otherwise.

    carried: (3,), mass above them, and that mass times the place x, y of its center.
    """
    mass, along_x, along_y = carried
    stiffness = np.array([0.0, 0.0, stiff, stiff, stiff, 0.0])
    matrix = np.diag([0.0, 0.0, *stiffness[2:5], twist])
    matrix[:2, :2] = shear
    mbs.SetObjectParameter(bars, "stiffness", matrix)
    # the stiff directions are damped critically, twist not at all
    dampers = np.diag(2.0 * np.sqrt(stiffness * mass))
    dampers[:2, :2] = damping
    mbs.SetObjectParameter(bars, "damping", dampers)
    # at rest the bars carry what stands on them without giving way
    mbs.SetObjectParameter(bars, "offset", [0.0, 0.0, mass / stiff, along_y / stiff, -along_x / stiff, 0.0])


def _set_bars(
    mbs: Any,
    connector: Any,
    bodies: list[Any],
    centers: Array,
    carried: Array,
    bars: BarLink,
    damping: Array,
    lag: float,
) -> None:
    """Give a link the stiffness of its bars, and dampers `lag` times that; damping: in shear, (2, 2)."""
    _, along_x, along_y = carried
    stiffness = np.array([bars.shear, bars.shear, bars.tension, bars.bending, bars.bending, bars.torsion])
    # at rest the bars have the heights of the scene under the weight that they carry
    offset = [0.0, 0.0, bars.load / bars.tension, along_y / bars.bending, -along_x / bars.bending, 0.0]
    if bars.pendulum:
        stiffness[2] = offset[2] = 0.0
        rod = items.ObjectConnectorSpringDamper(
            markerNumbers=_ends(mbs, bodies, centers, bars.pendulum),
            referenceLength=bars.pendulum + bars.load / bars.tension,
            stiffness=bars.tension,
            damping=lag * bars.tension,
        )
        mbs.AddObject(rod)
    dampers = np.diag(lag * stiffness)
    dampers[:2, :2] = damping
    mbs.SetObjectParameter(connector, "stiffness", np.diag(stiffness))
    mbs.SetObjectParameter(connector, "damping", dampers)
    mbs.SetObjectParameter(connector, "offset", offset)


def fastest_of_bars(links: list[Link], masses: Array, tensors: Array, centers: Array) -> float:
    """
    Largest angular frequency that bars which give way make, of bodies that nothing else holds; 0 without such bars.

    tensors: moments of inertia, (N, 3, 3).
    """
    if all(link.bars is None for link in links):
        return 0.0
    size = PER_BODY * len(masses)
    inertia, stiffness = np.zeros((2, size, size))
    for body, (mass, tensor) in enumerate(zip(masses, tensors)):
        first = PER_BODY * body
        inertia[first : first + 3, first : first + 3] = mass * np.eye(3)
        inertia[first + 3 : first + 6, first + 3 : first + 6] = tensor
    for number, link in enumerate(links):
        if link.bars is None:
            continue
        half = 0.5 * (centers[number + 1, 2] - centers[number, 2])
        apart = np.zeros((PER_BODY, size))
        for body, sign in ((number, -1.0), (number + 1, 1.0)):
            lever, first = np.array([*-centers[body, :2], -sign * half]), PER_BODY * body
            apart[:, first : first + PER_BODY] = sign * np.eye(PER_BODY)
            apart[:3, first + 3 : first + 6] = -sign * np.cross(lever, np.eye(3))
        bars = link.bars
        own = np.array([bars.shear, bars.shear, bars.tension, bars.bending, bars.bending, bars.torsion])
        stiffness += apart.T @ (own[:, None] * apart)
    return float(np.sqrt(max(eigh(stiffness, inertia, eigvals_only=True)[-1], 0.0)))


def undeformed(links: list[Link], centers: Array, coordinates: Array, start: Array) -> Array:
    """
    Coordinates (n,) with bodies on bars that give way moved as one with the body below since `start` (n,).

    By so little that rotations add up: contacts and stiff links have settled.
    """
    settled = coordinates.copy()
    for number, link in enumerate(links):
        lower, upper = (slice(PER_BODY * body, PER_BODY * (body + 1)) for body in (number, number + 1))
        before = coordinates if link.bars is None else start  # in which the link is as it is to be
        moved = (settled - before)[lower]
        settled[upper] = before[upper]
        settled[upper][3:] += moved[3:]
        settled[upper][2] += moved[2] + np.cross(moved[3:], centers[number + 1] - centers[number])[2]
    return settled
