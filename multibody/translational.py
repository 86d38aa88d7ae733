"""
The translational model: the paper's degrees of freedom, the engine's bodies and contact.

The platform is a rigid body whose moments of inertia are so large that it does not turn: the contact item needs a
body with an orientation, and locking the rotations by constraints would cost more coordinates. The bodies above
share its vertical motion, so they are a linear chain in the plane whose mass is added to the platform's vertical
coordinate only. The contact is a sphere inside a hollow sphere, in the plate's frame, with inertial loads.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from multibody.engine import exudyn, items
from multibody.loading import SymbolicGround, symbolic_load
from multibody.system import EngineModel, EngineState, Recorders
from multibody.units import Units, link_stiffness, units_of
from reference.problem import Scene, State

Array = NDArray[np.float64]

PLATFORM = 6  # coordinates of the rigid body: x, y, z and three rotations
LOCKED = 1e15  # moment of inertia, in units of mass * length^2: turns by 1e-11 rad in 20 s under the largest torque
HOLLOW = 2.0  # R in units of rho; in translation only R - r matters
DAMPING = 1.0  # ratio of the contact: its own motion dies out within a few of its periods and is not seen
ALWAYS_LINEAR = 1e6  # v_reg of the lubricated contact in units of velocity, above any speed: mu = f_c |v| throughout


def translational(scene: Scene, regularization: float | None, *, contact_force: bool = False) -> EngineModel:
    """
    Assemble the translational model.

    regularization: v_reg, m/s, of dry friction; None where the contact is lubricated or frictionless. contact_force:
    record it too.
    """
    units = units_of(scene)
    masses = scene.masses / units.mass
    container = exudyn.SystemContainer()
    mbs = container.AddSystem()
    frame = mbs.AddObject(items.ObjectGround())
    platform_node = mbs.AddNode(items.NodeRigidBodyRxyz(referenceCoordinates=[0.0] * PLATFORM))
    platform = mbs.AddObject(
        items.ObjectRigidBody(nodeNumber=platform_node, mass=masses[0], inertia=[LOCKED] * 3 + [0.0] * 3)
    )
    depression = mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=platform))
    nodes = [platform_node]
    if len(masses) > 1:
        nodes.append(_chain(mbs, platform_node, masses, link_stiffness(scene, units)))

    friction, threshold = _law(scene, regularization, units)
    contact_node = mbs.AddNode(items.NodeGenericData(initialCoordinates=[0.0] * 4, numberOfDataCoordinates=4))
    contact = mbs.AddObject(
        items.ObjectContactSphereSphere(
            markerNumbers=[
                mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=frame, localPosition=[0.0, 0.0, 1.0])),
                depression,
            ],
            nodeNumber=contact_node,
            spheresRadii=[HOLLOW - 1.0, HOLLOW],
            isHollowSphere1=True,
            dynamicFriction=friction,
            frictionProportionalZone=threshold,
        )
    )
    ground = SymbolicGround(scene, units)
    expressions = _inertial_loads(mbs, ground, masses, depression, nodes)
    recorders = _recorders(mbs, nodes, contact_node, contact if contact_force else None)
    mbs.Assemble()

    bodies = np.array([[0, 1, 2]] + [[PLATFORM + 2 * i, PLATFORM + 2 * i + 1, 2] for i in range(len(masses) - 1)])

    def stiffen(penetration: float) -> None:
        # closer by the static penetration, so that the pendulum at rest has length rho whatever the stiffness
        mbs.SetObjectParameter(contact, "spheresRadii", [HOLLOW - (1.0 - penetration), HOLLOW])
        mbs.SetObjectParameter(contact, "contactStiffness", 1.0 / penetration)
        mbs.SetObjectParameter(contact, "contactDamping", 2.0 * DAMPING / np.sqrt(penetration))

    def start(initial: State | None, ground_acceleration: Array, penetration: float) -> EngineState:
        return _start(initial, ground_acceleration / units.acceleration, bodies, units, penetration)

    def settle(state: EngineState, gap_rate: Array, penetration: float) -> EngineState:
        return _settled(state, float(gap_rate[0]), penetration)

    corner = np.inf if scene.lubricated or friction == 0.0 else threshold
    return EngineModel(
        mbs, units, ground, recorders, bodies, stiffen, start, settle, 1.0, corner, (container, expressions)
    )


def _law(scene: Scene, regularization: float | None, units: Units) -> tuple[float, float]:
    """Friction coefficient of the contact, and the speed in units of velocity under which it is reduced linearly."""
    if scene.lubricated:
        return scene.friction_coefficient * units.velocity * ALWAYS_LINEAR, ALWAYS_LINEAR
    if regularization is None:
        return scene.friction_coefficient, 1.0
    return scene.friction_coefficient, regularization / units.velocity


def _chain(mbs: Any, platform_node: Any, masses: Array, stiffness: Array) -> Any:
    """Bodies 2..N as one linear object on their x, y and the platform's x, y, z. Returns their node."""
    count = 2 * (len(masses) - 1)
    node = mbs.AddNode(
        items.NodeGenericODE2(
            referenceCoordinates=[0.0] * count,
            initialCoordinates=[0.0] * count,
            initialCoordinates_t=[0.0] * count,
            numberOfODE2Coordinates=count,
        )
    )
    mass_matrix = np.zeros((PLATFORM + count, PLATFORM + count))
    stiffness_matrix = np.zeros_like(mass_matrix)
    mass_matrix[2, 2] = masses[1:].sum()
    for link in range(len(masses) - 1):
        for axis in range(2):
            upper = PLATFORM + 2 * link + axis
            lower = upper - 2 if link > 0 else axis
            mass_matrix[upper, upper] = masses[link + 1]
            pair = np.ix_([lower, upper], [lower, upper])
            stiffness_matrix[pair] += stiffness[link, axis] * np.array([[1.0, -1.0], [-1.0, 1.0]])
    mbs.AddObject(
        items.ObjectGenericODE2(
            nodeNumbers=[platform_node, node], massMatrix=mass_matrix, stiffnessMatrix=stiffness_matrix
        )
    )
    return node


def _inertial_loads(mbs: Any, ground: SymbolicGround, masses: Array, depression: Any, nodes: list[Any]) -> list[Any]:
    """Weight and -m times the plate's acceleration on every body. Returns the expressions."""

    def on_platform(mbs: Any, t: Any, loadVector: Any) -> list[Any]:
        return [-masses[0] * ground.along(0, t), -masses[0] * ground.along(1, t), -1.0 - ground.along(2, t)]

    def on_body(i: int, axis: int) -> Any:
        return lambda mbs, t, load: -masses[i] * ground.along(axis, t)

    load = mbs.AddLoad(items.LoadForceVector(markerNumber=depression, loadVector=[0.0, 0.0, -1.0]))
    expressions = [symbolic_load(mbs, load, "loadVectorUserFunction", on_platform)]
    for i in range(1, len(masses)):
        for axis in range(2):
            coordinate = items.MarkerNodeCoordinate(nodeNumber=nodes[1], coordinate=2 * (i - 1) + axis)
            load = mbs.AddLoad(items.LoadCoordinate(markerNumber=mbs.AddMarker(coordinate)))
            expressions.append(symbolic_load(mbs, load, "loadUserFunction", on_body(i, axis)))
    return expressions


def _recorders(mbs: Any, nodes: list[Any], contact_node: Any, contact: Any | None) -> Recorders:
    kind = exudyn.OutputVariableType

    def at(node: Any, quantity: Any) -> Any:
        sensor = items.SensorNode(nodeNumber=node, outputVariableType=quantity, storeInternal=True, writeToFile=False)
        return mbs.AddSensor(sensor)

    def of_contact(quantity: Any) -> Any:
        sensor = items.SensorObject(
            objectNumber=contact, outputVariableType=quantity, storeInternal=True, writeToFile=False
        )
        return mbs.AddSensor(sensor)

    return Recorders(
        coordinates=[at(node, kind.Coordinates) for node in nodes],
        velocities=[at(node, kind.Coordinates_t) for node in nodes],
        accelerations=[at(node, kind.Coordinates_tt) for node in nodes],
        contact=[at(contact_node, kind.Coordinates)],
        contact_force=[] if contact is None else [of_contact(kind.Force), of_contact(kind.Director1)],
    )


def _start(
    initial: State | None, ground: Array, bodies: NDArray[np.int_], units: Units, penetration: float
) -> EngineState:
    """
    The engine's state on the sphere, moving along it, pressed in by as much as a single body would be.

    For several bodies off the vertical the penetration is not exact; the contact damps the difference out within
    a few of its own time constants.
    """
    count = PLATFORM + 2 * (len(bodies) - 1)
    coordinates, velocities = np.zeros(count), np.zeros(count)
    if initial is not None:
        coordinates[bodies[:, :2]] = np.asarray(initial.position, float) / units.length
        velocities[bodies[:, :2]] = np.asarray(initial.velocity, float) / units.velocity
    offset, speed = coordinates[:2], velocities[:2]
    height = float(np.sqrt(max(1.0 - float(offset @ offset), 0.0)))
    normal = np.array([-offset[0], -offset[1], height])
    vertical = offset @ speed / height if height > 0.0 else np.inf
    slip = np.sqrt(speed @ speed + vertical**2)
    pressed = penetration * (normal @ ground + normal[2] + slip**2)
    coordinates[:3] = np.array([0.0, 0.0, 1.0]) - normal * (1.0 + pressed - penetration)
    velocities[2] = vertical
    return EngineState(coordinates, velocities, np.array([-pressed, slip, 0.0, 0.0]))


def _settled(state: EngineState, gap_rate: float, penetration: float) -> EngineState:
    """
    The same state with the same contact force, carried by the gap alone and not by a leftover of normal velocity.

    At a given step the engine's position and velocity disagree along the normal by O(h^2), and the contact's damper
    turns that into a force which the gap makes up for. A smaller step would start with that balance upset and ring.
    """
    coordinates, velocities, contact = state.coordinates.copy(), state.velocities.copy(), state.contact.copy()
    normal = np.array([0.0, 0.0, 1.0]) - coordinates[:3]
    normal /= np.linalg.norm(normal)
    damping = 2.0 * DAMPING / np.sqrt(penetration)
    excess = float(normal @ velocities[:3]) - gap_rate
    lift = -penetration * damping * excess
    velocities[:3] -= normal * excess
    coordinates[:3] -= normal * lift
    contact[0] -= lift
    return EngineState(coordinates, velocities, contact)
