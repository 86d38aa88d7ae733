"""
Translational model: the degrees of freedom of the paper, with the bodies and the contact of the engine.

The platform is a rigid body whose moments of inertia are so large that it does not turn: the contact item needs a
body with an orientation, and locking the rotations by constraints would cost more coordinates. The bodies above
share its vertical motion, so they are a linear chain in the plane whose mass is added to the platform's vertical
coordinate only. The contact is a sphere inside a hollow sphere, in the plate's frame, with inertial loads. Under a
flat slider it is a sphere on a plane.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix

from multibody.models.contact import (
    POSITION_ROUNDING,
    ContactLaw,
    contact_law,
    corner_and_relaxation,
    set_contact_parameters,
    settle_contact,
)
from multibody.models.depressions import Depressions, FlatUnderside
from multibody.models.engine import BODY_COORDINATES, MAX_DENSE_COORDINATES, exudyn, items
from multibody.models.friction_springs import TurningSpheres, add_turning_spheres, make_friction_springs
from multibody.models.loading import LoadedCoordinate, load_coordinates, make_ground
from multibody.models.plane import make_plane_contact, set_plane_extent, start_platform
from multibody.models.recorders import add_recorders
from multibody.models.speed_friction import SpeedFriction
from multibody.models.state import EngineState
from multibody.models.system import EngineModel
from multibody.models.units import Units, link_damping, link_stiffness, units_of
from reference.problem import Scene, State

Array = NDArray[np.float64]

# Stiffness matrix of a spring of stiffness 1 between two coordinates.
UNIT_SPRING_MATRIX = np.array([[1.0, -1.0], [-1.0, 1.0]])

# Moment of inertia of a platform that must not turn, in units of mass times length^2: the largest torque turns it by
# 1e-11 rad in 20 s.
LOCKED_INERTIA = 1e15

# Radius R of the hollow sphere, in units of rho, chosen freely: in translation only R - r = rho has an effect.
HOLLOW_RADIUS = 2.0

# Radius r of the sphere, in the model's unit of length (pendulum length rho = R - r, if the slider is not flat).
SPHERE_RADIUS = HOLLOW_RADIUS - 1.0


def assemble_translational(
    scene: Scene,
    regularization: float | None,
    *,
    contact_force: bool = False,
    axes: int = 2,
) -> EngineModel:
    """
    Assemble the translational model of a scene, whose bodies do not rotate, in the engine.

    regularization: v_reg, m/s, of dry friction; None where the contact is lubricated or frictionless. contact_force:
    whether to record it. axes: 1 for a motion in the plane of x and z, in which the bodies above the platform have no
    coordinate along y (their y is the platform's, which stays zero).
    """
    units = units_of(scene)
    masses = scene.masses / units.mass
    container = exudyn.SystemContainer()
    mbs = container.AddSystem()
    platform_node = mbs.AddNode(items.NodeRigidBodyRxyz(referenceCoordinates=[0.0] * BODY_COORDINATES))
    depression = mbs.AddMarker(items.MarkerNodeRigid(nodeNumber=platform_node))
    links = (link_stiffness(scene, units)[:, :axes], link_damping(scene, units)[:, :axes])
    nodes, chain = _add_chain(mbs, platform_node, masses, *links)

    ground = make_ground(mbs, scene, units)
    plate = mbs.AddObject(items.ObjectGround())
    law = contact_law(scene, regularization, units)
    turning = add_turning_spheres(mbs, scene, units, np.zeros((1, 2)), SPHERE_RADIUS)
    contact, contact_node, height = _add_contact(mbs, plate, depression, law, turning, scene.flat)
    expressions = load_coordinates(mbs, ground, _list_loaded_coordinates(masses, nodes, axes))
    recorders = add_recorders(
        mbs,
        nodes=[],
        linear=[chain, *turning.bodies],
        contact_nodes=[contact_node],
        contacts=[contact] if contact_force or scene.dry_friction.needs_load else [],
    )
    mbs.Assemble()

    constant = scene.dry_friction.constant
    varying = None if constant else SpeedFriction(mbs, scene, units, law.threshold, [contact], ground)
    count = BODY_COORDINATES + axes * (len(masses) - 1)
    flat_or_hollow = FlatUnderside if scene.flat else Depressions
    under_platform = flat_or_hollow(np.zeros((1, 2)), np.zeros(3), SPHERE_RADIUS, np.empty(0, np.int_))
    springs = make_friction_springs(mbs, scene, units, [contact], count, under_platform)
    bodies = np.tile(np.arange(3), (len(masses), 1))
    bodies[1:, :axes] = np.arange(BODY_COORDINATES, count).reshape(-1, axes)
    parts = _TranslationalSystem(
        scene=scene,
        mbs=mbs,
        units=units,
        bodies=bodies,
        contact=contact,
        height=height,
        coordinates=count + turning.coordinates,
    )

    corner, relaxation = corner_and_relaxation(scene, regularization, units)
    return EngineModel(
        mbs=mbs,
        units=units,
        ground=ground,
        recorders=recorders,
        bodies=bodies,
        set_contact=parts.set_contact,
        start=parts.start,
        settle=parts.settle,
        corner=corner,
        relaxation=relaxation,
        rounding=POSITION_ROUNDING,
        references=(container, expressions),
        friction=varying,
        rim=np.inf if scene.flat else 1.0,
        springs=springs,
    )


@dataclass(frozen=True)
class _TranslationalSystem:
    """
    Assembled translational model, which sets its contact and gives its initial state, in its own units.

    bodies: index of the coordinates that move the bodies, (N, 3). height: height of the plane of a flat slider.
    coordinates: number of coordinates of the system.
    """

    scene: Scene
    mbs: Any
    units: Units
    bodies: NDArray[np.int_]
    contact: Any
    height: float
    coordinates: int

    def set_contact(self, penetration: float, warping_compliance: float = 0.0) -> None:
        """Set the penetration of the contact under the weight; `warping_compliance` has no effect on one contact."""
        # the static penetration reduces the distance of the centers, so that the pendulum at rest always has length rho
        sphere, hollow = SPHERE_RADIUS + penetration, [HOLLOW_RADIUS - (1.0 - penetration), HOLLOW_RADIUS]
        set_contact_parameters(self.mbs, self.contact, sphere if self.scene.flat else hollow, penetration)

    def start(self, initial: State | None, ground_acceleration: Array, penetration: float) -> EngineState:
        """Return the engine's state for an initial state (None: at rest) and the ground's acceleration, m/s^2."""
        coordinates, velocities, gap, slip = start_platform(
            self.scene, self.units, self.bodies, self.coordinates, initial, ground_acceleration, penetration,
            lambda distance: set_plane_extent(self.mbs, self.contact, distance, self.height),
        )  # fmt: skip
        contact_data, load = np.array([gap, slip, 0.0, 0.0]), np.array([-gap / penetration])
        return EngineState(coordinates, velocities, contact_data, load=load)

    def settle(self, state: EngineState, gap_rate: Array, penetration: float) -> EngineState:
        """Return `state` with the same contact force, made by the penetration alone (see `settle_contact`)."""
        x, y, z = (0.0, 0.0, 0.0) if self.scene.flat else state.coordinates[:3].tolist()
        to_center_of_hollow_sphere = -x, -y, 1.0 - z
        length = math.hypot(*to_center_of_hollow_sphere)
        normal = [part / length for part in to_center_of_hollow_sphere]
        return settle_contact(state, float(gap_rate[0]), penetration, normal)


def _add_contact(
    mbs: Any, plate: Any, platform: Any, law: ContactLaw, turning: TurningSpheres, flat: bool
) -> tuple[Any, Any, float]:
    """
    Add the contact of a sphere in the platform's hollow sphere, and its data node; `set_contact` sets its stiffness.

    Under a flat slider the sphere belongs to the platform and lies on the plane of the plate; a sphere that turns
    belongs to the plate, and the plane to the platform. Returns contact, data node and height of the plane.
    """
    node = mbs.AddNode(items.NodeGenericData(initialCoordinates=[0.0] * 4, numberOfDataCoordinates=4))
    if flat:
        plane = platform if turning.markers else mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=plate))
        sphere, height = (turning.markers[0], 1.0 + SPHERE_RADIUS) if turning.markers else (platform, -SPHERE_RADIUS)
        return mbs.AddObject(make_plane_contact(sphere, plane, node, SPHERE_RADIUS, law)), node, height
    fixed = [] if turning.markers else [items.MarkerBodyRigid(bodyNumber=plate, localPosition=[0.0, 0.0, 1.0])]
    contact = items.ObjectContactSphereSphere(
        markerNumbers=[*turning.markers, *map(mbs.AddMarker, fixed), platform],
        nodeNumber=node,
        spheresRadii=[SPHERE_RADIUS, HOLLOW_RADIUS],
        isHollowSphere1=True,
        dynamicFriction=law.friction,
        frictionProportionalZone=law.threshold,
    )
    return mbs.AddObject(contact), node, 0.0


def _add_chain(mbs: Any, platform_node: Any, masses: Array, stiffness: Array, damping: Array) -> tuple[list[Any], Any]:
    """
    Add bodies and weight as one linear object: its coordinates are the platform's and x, y (or x) of each other body.

    Returns the nodes and the object.

    Its mass matrix is constant, so that the engine does not assemble it again in every iteration.
    """
    axes = stiffness.shape[1]
    count = axes * (len(masses) - 1)
    nodes = [platform_node]
    if count:
        above = items.NodeGenericODE2(
            referenceCoordinates=[0.0] * count,
            initialCoordinates=[0.0] * count,
            initialCoordinates_t=[0.0] * count,
            numberOfODE2Coordinates=count,
        )
        nodes.append(mbs.AddNode(above))
    mass_matrix = np.zeros((BODY_COORDINATES + count, BODY_COORDINATES + count))
    stiffness_matrix, damping_matrix = np.zeros((2, *mass_matrix.shape))
    np.fill_diagonal(mass_matrix[:BODY_COORDINATES], [masses[0]] * 3 + [LOCKED_INERTIA] * 3)
    mass_matrix[2, 2] += masses[1:].sum()
    for link in range(len(masses) - 1):
        for axis in range(axes):
            upper = BODY_COORDINATES + axes * link + axis
            lower = upper - axes if link > 0 else axis
            mass_matrix[upper, upper] = masses[link + 1]
            pair = np.ix_([lower, upper], [lower, upper])
            stiffness_matrix[pair] += stiffness[link, axis] * UNIT_SPRING_MATRIX
            damping_matrix[pair] += damping[link, axis] * UNIT_SPRING_MATRIX
    weight = np.zeros(len(mass_matrix))
    weight[2] = -1.0
    matrices = {"massMatrix": _matrix_container(mass_matrix), "stiffnessMatrix": _matrix_container(stiffness_matrix)}
    if damping.any():
        matrices["dampingMatrix"] = _matrix_container(damping_matrix)
    return nodes, mbs.AddObject(items.ObjectGenericODE2(nodeNumbers=nodes, forceVector=weight, **matrices))


def _matrix_container(matrix: Array) -> Any:
    """Return a matrix (n, n) in the engine's form: dense, or its non-zero entries for the sparse solver."""
    if len(matrix) <= MAX_DENSE_COORDINATES:
        return matrix
    entries = exudyn.MatrixContainer()
    entries.SetWithSparseMatrix(csr_matrix(matrix), useDenseMatrix=False)
    return entries


def _list_loaded_coordinates(masses: Array, nodes: list[Any], axes: int) -> list[LoadedCoordinate]:
    """List the coordinates on which the loading acts; the only vertical one, the platform's, moves the total mass."""
    platform = [LoadedCoordinate(nodes[0], axis, float(masses[0]), axis) for axis in range(2)]
    above = [
        LoadedCoordinate(nodes[1], axes * number + axis, float(mass), axis)
        for number, mass in enumerate(masses[1:])
        for axis in range(axes)
    ]
    return [*platform, LoadedCoordinate(nodes[0], 2, 1.0, 2), *above]
