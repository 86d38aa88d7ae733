"""
The spatial model: rigid bodies free to turn, supports on a ring, contacts that open and close.

Platform and bodies are boxes with six degrees of freedom at their heights. The platform's underside has one depression
per support, each with its own unilateral contact, so supports share the load as overturning demands. A link is a set of
upright bars clamped at both ends: stiff in tension and in bending about the horizontal axes, with the scene's shear
stiffness acting half-way up, and against twist the stiffness of bars that stand on the ring, ring^2 (kx + ky) / 2. Its
forces act on both bodies at the same point, the middle between the two ends.

More than three supports share the load as elastic bearings do (`supports`), or give way by the scene's
`support_stiffness`. Then the stiffness of the contacts is the bearings' own, and part of the model.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from multibody.models.contact import DAMPING, ROUNDING, contact_law, corner_and_relaxation, pressed_in
from multibody.models.engine import exudyn, items
from multibody.models.loading import Ground, ground_of, symbolic_load
from multibody.models.plate import plate_for
from multibody.models.recorders import recorded
from multibody.models.supports import DETERMINATE, GIVES_WAY, fixed_supports, sharing_supports, sphere_nodes
from multibody.models.system import EngineModel, EngineState
from multibody.models.units import Units, link_stiffness, units_of
from reference.problem import Scene, State

Array = NDArray[np.float64]

PER_BODY = 6  # x, y, z of the centre of mass and three rotations
GIVES = 10.0  # of a bar in tension (and, times rho^2, in bending) over that of the contact under the same force


def spatial(
    scene: Scene, regularization: float | None, *, loading: str = "inertial", contact_force: bool = False
) -> EngineModel:
    """
    Assemble the spatial model; arguments as in `translational`.

    Raises ValueError if the scene lacks supports, ring, sphere_radius, or the height or size of a body.
    """
    units = units_of(scene)
    ring, radius, heights, sizes = _geometry(scene, units)
    masses = scene.masses / units.mass
    container = exudyn.SystemContainer()
    mbs = container.AddSystem()
    nodes, bodies = [], []
    for mass, height, size in zip(masses, heights, sizes):
        nodes.append(mbs.AddNode(items.NodeRigidBodyRxyz(referenceCoordinates=[0.0, 0.0, height, 0.0, 0.0, 0.0])))
        inertia = mass / 12.0 * (size @ size - size**2)
        box = items.ObjectRigidBody(nodeNumber=nodes[-1], mass=mass, inertia=[*inertia, 0.0, 0.0, 0.0])
        bodies.append(mbs.AddObject(box))
    links = []
    for link, stiffness in enumerate(link_stiffness(scene, units)):
        carried = float(masses[link + 1 :].sum())
        bars = link_between(mbs, bodies[link : link + 2], heights[link : link + 2])
        twist = float(np.hypot(*ring[0])) ** 2 * stiffness.mean()
        links.append((bars, carried, stiffness, twist))

    ground = ground_of(mbs, scene, units)
    bearings = scene.isolator.support_stiffness
    given = 0.0 if bearings is None else units.force / (len(ring) * bearings * units.length)
    shared = not given and len(ring) > DETERMINATE
    spheres = sphere_nodes(mbs, ring, loading == "plate") if shared else []
    plate = plate_for(mbs, loading, ground)
    supports = sharing_supports(mbs, plate, ring, spheres) if shared else fixed_supports(mbs, plate, ring)
    friction, threshold = contact_law(scene, regularization, units)
    contacts, contact_nodes = [], []
    for place, support in zip(ring, supports.markers):
        contact_nodes.append(
            mbs.AddNode(items.NodeGenericData(initialCoordinates=[0.0] * 4, numberOfDataCoordinates=4))
        )
        depression = items.MarkerBodyRigid(bodyNumber=bodies[0], localPosition=[*place, -heights[0]])
        contacts.append(
            mbs.AddObject(
                items.ObjectContactSphereSphere(
                    markerNumbers=[support, mbs.AddMarker(depression)],
                    nodeNumber=contact_nodes[-1],
                    spheresRadii=[radius, radius + 1.0],
                    isHollowSphere1=True,
                    dynamicFriction=friction,
                    frictionProportionalZone=threshold,
                )
            )
        )
    expressions = list(plate.expressions)
    for mass, body in zip(masses, bodies):
        centre = mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body))
        load = mbs.AddLoad(items.LoadForceVector(markerNumber=centre, loadVector=[0.0, 0.0, -mass]))
        if not plate.moves:
            expressions.append(symbolic_load(mbs, load, "loadVectorUserFunction", _inertial(ground, float(mass))))
    recorders = recorded(mbs, [*nodes, *supports.nodes], contact_nodes, contacts if contact_force else [], plate.node)
    mbs.Assemble()

    count = len(contacts)

    def stiffen(penetration: float, gives_way: float = GIVES_WAY) -> None:
        pressed = given or penetration
        for contact in contacts:
            mbs.SetObjectParameter(contact, "spheresRadii", [radius + pressed, radius + 1.0])
            mbs.SetObjectParameter(contact, "contactStiffness", 1.0 / (count * pressed))
            mbs.SetObjectParameter(contact, "contactDamping", 2.0 * DAMPING / (count * np.sqrt(pressed)))
        supports.hold(penetration, gives_way)
        for link in links:
            stiffen_link(mbs, *link, 1.0 / (GIVES * penetration))

    index = PER_BODY * np.arange(len(masses))[:, None] + np.arange(3)
    own = PER_BODY * len(masses)  # coordinates of the bodies, before those of the spheres
    vertical = own + supports.vertical

    def start(initial: State | None, ground_acceleration: Array, penetration: float) -> EngineState:
        coordinates, velocities = np.zeros((2, own + supports.coordinates))
        if initial is not None:
            coordinates[index[:, :2]] = np.asarray(initial.position, float) / units.length
            velocities[index[:, :2]] = np.asarray(initial.velocity, float) / units.velocity
        place, velocity, gap, slip = pressed_in(
            coordinates[:2],
            velocities[:2],
            ground_acceleration / units.acceleration,
            given or penetration,
        )
        coordinates[:3], velocities[:3] = place, velocity
        coordinates[index[1:, 2]], velocities[index[1:, 2]] = place[2], velocity[2]
        return EngineState(coordinates, velocities, np.tile([gap, slip, 0.0, 0.0], count))

    def slippery(is_so: bool) -> None:
        for contact in contacts:
            mbs.SetObjectParameter(contact, "dynamicFriction", 0.0 if is_so else friction)

    def settle(state: EngineState, gap_rate: Array, penetration: float) -> EngineState:
        return state

    def warped(coordinates: Array) -> Array:
        spread: Array = np.abs(coordinates[:, vertical] @ supports.warping).max(axis=1, initial=0.0)
        return spread

    corner, relaxation = corner_and_relaxation(scene, regularization, units)
    return EngineModel(
        mbs=mbs,
        units=units,
        ground=ground,
        recorders=recorders,
        bodies=index,
        stiffen=stiffen,
        start=start,
        settle=settle,
        rim=1.0,
        corner=corner,
        relaxation=relaxation,
        # of places, and of their moments
        rounding=ROUNDING * max(1.0, float(np.hypot(*ring[0])), float(heights.max())) ** 2,
        moving_plate=plate.moves,
        carried=np.vstack([index, own + supports.carried]),
        keep_alive=(container, expressions),
        liftoff=True,
        slippery=slippery,
        warped=warped,
        bearings=given,
    )


def _geometry(scene: Scene, units: Units) -> tuple[Array, float, Array, Array]:
    """Supports (K, 2), sphere radius, heights (N,), sizes (N, 3), all in units of length. Raises ValueError."""
    isolator = scene.isolator
    wanted = {f"isolator.{key}": getattr(isolator, key) for key in ("supports", "ring", "sphere_radius")}
    for number, body in enumerate(scene.bodies):
        wanted |= {f"bodies.{number}.{key}": getattr(body, key) for key in ("height", "size")}
    missing = [key for key, value in wanted.items() if value is None]
    if missing:
        raise ValueError(f"model: 'spatial': {scene.name} needs {', '.join(missing)}")
    assert isolator.supports is not None
    assert isolator.ring is not None
    assert isolator.sphere_radius is not None
    angles = 2.0 * np.pi * (np.arange(isolator.supports) + 0.5) / isolator.supports
    ring = isolator.ring / units.length * np.column_stack([np.cos(angles), np.sin(angles)])
    heights = np.array([body.height for body in scene.bodies]) / units.length
    sizes = np.array([body.size for body in scene.bodies]) / units.length
    return ring, isolator.sphere_radius / units.length, heights, sizes


def link_between(mbs: Any, bodies: list[Any], heights: Array) -> Any:
    """The link between two neighbours, acting half-way between their centres; its stiffness comes later."""
    middle = 0.5 * (heights[1] - heights[0])
    markers = [
        mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localPosition=[0.0, 0.0, sign * middle]))
        for body, sign in zip(bodies, (1.0, -1.0))
    ]
    return mbs.AddObject(
        items.ObjectConnectorRigidBodySpringDamper(markerNumbers=markers, useIntrinsicFormulation=True)
    )


def stiffen_link(mbs: Any, bars: Any, carried: float, shear: Array, twist: float, stiff: float) -> None:
    """Give bars the scene's stiffness in shear and twist and `stiff` otherwise; carried: mass above them."""
    held = np.array([0.0, 0.0, stiff, stiff, stiff, 0.0])
    mbs.SetObjectParameter(bars, "stiffness", np.diag([*shear, *held[2:5], twist]))
    # the stiff directions are damped critically, the others not at all
    mbs.SetObjectParameter(bars, "damping", np.diag(2.0 * np.sqrt(held * carried)))
    # at rest the bars carry what stands on them without giving way
    mbs.SetObjectParameter(bars, "offset", [0.0, 0.0, carried / stiff, 0.0, 0.0, 0.0])


def _inertial(ground: Ground, mass: float) -> Any:
    """Weight and -m times the plate's acceleration."""

    def force(mbs: Any, t: Any, loadVector: Any) -> list[Any]:
        return [-mass * ground.along(0, t), -mass * ground.along(1, t), -mass - mass * ground.along(2, t)]

    return force
