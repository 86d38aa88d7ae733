"""
The supports of the spatial model: they share the load as elastic bearings do, however stiff the contacts are.

Rigid supports leave the forces of more than three of them undetermined, and a rigid platform that has yawed and tilted
fits three spheres only, by about 3e-8 rho: contacts stiffer than that make it rock on two diagonals. Real bearings give
way by far more, so that the vertical forces are c0 + c1 x_k + c2 y_k. Here every sphere can move vertically. Against
the three patterns of such forces (heave, tilt about x, tilt about y) the spheres are held ten times as stiffly as by
contacts. Against the K - 3 other patterns, which warp the ring, they give way by a stated share of rho under the
weight. That is more than the misfit. Where all supports stay closed it is so much more that warping takes no load;
where one opens, less than what would let it hit the platform as it closes again. The stiffness of the contacts, and
with it the time in which the total force follows, does not change.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from multibody.models.engine import BODY_COORDINATES, items
from multibody.models.friction_springs import TurningSpheres
from multibody.models.plate import LOCKED_INERTIA, Plate

Array = NDArray[np.float64]

# Number of supports whose forces follow from statics.
DETERMINATE = 3

# Stiffness of the springs against heave and tilt over that of the contacts.
SPHERE_STIFFNESS_RATIO = 10.0

# Compliance against warping in units of rho under the weight, where no level of accuracy says more.
MIN_WARPING_COMPLIANCE = 2e-5

# Mass of all spheres together: much less than that of the bodies.
SPHERES_MASS = 1e-2

# Rotation that turns the axis of a 1-D mass, x, upwards.
UPRIGHT = [[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]

# Function that sets the stiffness against heave and tilt and against warping, and the damping against these two.
SetSprings = Callable[[float, float, float, float], None]


@dataclass(frozen=True)
class Supports:
    """
    Spheres under the platform.

    Attributes:
    - markers: Markers at the spheres' centers.
    - nodes: Nodes of the spheres' own coordinates; empty where the spheres are fixed.
    - springs: An object on all of these coordinates and no others, in place of the nodes.
    - coordinates: Number of these coordinates.
    - vertical: Index of each sphere's vertical coordinate; empty where the spheres are fixed, (K,).
    - carried: Index of the coordinates that a moving plate carries along; empty without such coordinates, (K, 3).
    - warping: `warping_projection` of the supports, (K, K).
    - set_stiffness: Sets the springs under the spheres for the contacts' penetration and the compliance against
      warping.
    """

    markers: list[Any]
    nodes: list[Any]
    springs: list[Any]
    coordinates: int
    vertical: NDArray[np.int_]
    carried: NDArray[np.int_]
    warping: Array
    set_stiffness: Callable[[float, float], None]

    def sinking(self, penetration: float) -> float:
        """Sinking of the spheres under the weight, for the contacts' penetration; 0 for fixed ones."""
        return penetration / SPHERE_STIFFNESS_RATIO if len(self.vertical) else 0.0


def warping_projection(ring: Array) -> Array:
    """Projection (K, K) of K forces at places (K, 2) onto the part that neither heave nor tilt contains."""
    patterns, _ = np.linalg.qr(np.column_stack([np.ones(len(ring)), ring]))
    projection: Array = np.eye(len(ring)) - patterns @ patterns.T
    return projection


def add_sphere_nodes(mbs: Any, ring: Array, moving: bool) -> list[Any]:
    """Add nodes of spheres that share the load at places (K, 2): one vertical coordinate, or six on a moving plate."""
    if moving:
        places = [[*place, 1.0, 0.0, 0.0, 0.0] for place in ring]
        return [mbs.AddNode(items.NodeRigidBodyRxyz(referenceCoordinates=place)) for place in places]
    return [mbs.AddNode(items.Node1D(referenceCoordinates=[0.0])) for _ in ring]


def add_fixed_supports(mbs: Any, plate: Plate, ring: Array) -> Supports:
    """Add spheres fixed to the plate at places (K, 2), a length of one above the plane of the depressions."""
    markers = [
        mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=plate.body, localPosition=[*place, 1.0])) for place in ring
    ]
    none, count = np.empty(0, np.int_), len(ring)
    return Supports(markers, [], [], 0, none, none.reshape(0, 3), np.zeros((0, count)), lambda penetration, share: None)


def add_sharing_supports(mbs: Any, plate: Plate, ring: Array, nodes: list[Any]) -> Supports:
    """Add spheres at places (K, 2) that share the load elastically; on a plate that moves, bodies too heavy to turn."""
    # K vertical forces at places (x_k, y_k) can be split into the patterns 1, x_k, y_k, which balance heave and tilt,
    # and K - 3 others, which balance nothing: only the stiffness of the supports decides them. `warping_projection` is
    # the projection onto these. The springs are stiff against its complement, so that the contact alone decides how the
    # total force follows, and as soft as elastic bearings against warping, so that a rigid platform does not rock on
    # two diagonals (docs/decisions/0007-elastic-sharing.md). Each part is damped critically as the platform's share of
    # the mass on the same springs, so that neither rings.
    count = len(ring)
    warped = warping_projection(ring)
    if plate.moves:
        inertia = [LOCKED_INERTIA] * 3 + [0.0] * 3
        spheres = [items.ObjectRigidBody(nodeNumber=node, mass=SPHERES_MASS / count, inertia=inertia) for node in nodes]
        _, springs = _add_springs_on_plate(mbs, plate, nodes, warped)
        read: tuple[list[Any], list[Any]] = nodes, []
        each, upright = BODY_COORDINATES, 2
    else:
        spheres = [
            items.ObjectMass1D(
                mass=SPHERES_MASS / count, nodeNumber=node, referencePosition=[*place, 1.0], referenceRotation=UPRIGHT
            )
            for node, place in zip(nodes, ring)
        ]
        linear, springs = _add_springs_on_ground(mbs, nodes, warped)
        read = [], [linear]
        each, upright = 1, 0
    markers = [mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=mbs.AddObject(sphere))) for sphere in spheres]
    first = each * np.arange(count)
    carried = first[:, None] + np.arange(3) if plate.moves else np.empty((0, 3), np.int_)

    def set_stiffness(penetration: float, share: float) -> None:
        (stiff, soft), damping = _sharing_springs(count, penetration, share)
        springs(stiff, soft, *damping)

    return Supports(markers, *read, each * count, first + upright, carried, warped, set_stiffness)


def _sharing_springs(count: int, penetration: float, share: float) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return stiffness and critical damping of the springs under the spheres, each against the rest and warping."""
    stiff, soft = SPHERE_STIFFNESS_RATIO / (count * penetration), 1.0 / (count * share)
    return (stiff, soft), (2.0 * np.sqrt(stiff / count), 2.0 * np.sqrt(soft / count))


def _soft_against_warping(warped: Array, stiff: float, soft: float) -> Array:
    """Return a matrix (K, K) that is `stiff` but for warping, against which it is `soft`."""
    return stiff * (np.eye(len(warped)) - warped) + soft * warped


def make_turning_supports(mbs: Any, ring: Array, turning: TurningSpheres, shared: bool) -> Supports:
    """Make supports of spheres that turn at places (K, 2), which share the load elastically or not at all."""
    count, size = len(ring), turning.coordinates
    vertical = 2 + BODY_COORDINATES * np.arange(count) if shared else np.empty(0, np.int_)
    warped = warping_projection(ring) if shared else np.zeros((0, count))

    def set_stiffness(penetration: float, share: float) -> None:
        if not shared:
            return
        block = np.ix_(vertical, vertical)
        stiffness, damping = _sharing_springs(count, penetration, share)
        for name, held, parts in (
            ("stiffnessMatrix", turning.stiffness, stiffness),
            ("dampingMatrix", turning.damping, damping),
        ):
            matrix = held.copy()
            matrix[block] = _soft_against_warping(warped, *parts)
            mbs.SetObjectParameter(turning.bodies[0], name, matrix)

    none = np.empty((0, 3), np.int_)
    return Supports(turning.markers, [], turning.bodies, size, vertical, none, warped, set_stiffness)


def _add_springs_on_ground(mbs: Any, nodes: list[Any], warped: Array) -> tuple[Any, SetSprings]:
    """Add the springs as one object; return it and the function that sets them."""
    count = len(nodes)
    springs = mbs.AddObject(items.ObjectGenericODE2(nodeNumbers=nodes, forceVector=np.full(count, 1.0 / count)))

    return springs, _matrix_setter(mbs, springs, partial(_soft_against_warping, warped))


def _add_springs_on_plate(mbs: Any, plate: Plate, nodes: list[Any], warped: Array) -> tuple[Any, SetSprings]:
    """Add the springs over a plate that moves; return the object and the function that sets them."""
    count = len(nodes)
    sphere_against_plate = np.hstack([np.eye(count), -np.ones((count, 1))])
    index = [BODY_COORDINATES * np.arange(count + 1) + axis for axis in range(3)]
    size = BODY_COORDINATES * (count + 1)
    weight = np.zeros(size)
    weight[index[2]] = [*[1.0 / count] * count, -1.0]
    springs = mbs.AddObject(items.ObjectGenericODE2(nodeNumbers=[*nodes, plate.node], forceVector=weight))

    def matrix(stiff: float, soft: float) -> Array:
        whole, level = np.zeros((size, size)), stiff * np.eye(count)
        for axis, part in zip(index, (level, level, level + (soft - stiff) * warped)):
            whole[np.ix_(axis, axis)] = sphere_against_plate.T @ part @ sphere_against_plate
        return whole

    return springs, _matrix_setter(mbs, springs, matrix)


def _matrix_setter(mbs: Any, springs: Any, matrix: Callable[[float, float], Array]) -> SetSprings:
    """Return the function that sets the matrices of `springs`; matrix: from values of heave and tilt, of warping."""

    def set_matrices(stiff: float, soft: float, stiff_damping: float, soft_damping: float) -> None:
        mbs.SetObjectParameter(springs, "stiffnessMatrix", matrix(stiff, soft))
        mbs.SetObjectParameter(springs, "dampingMatrix", matrix(stiff_damping, soft_damping))

    return set_matrices
