"""
Supports of the spatial model, which share the load as elastic bearings do, however stiff the contacts are.

Rigid supports leave the forces of more than three of them undetermined, and a rigid platform that has yawed and tilted
fits three spheres only, by about 3e-8 rho: contacts stiffer than that make it rock on two diagonals. Real bearings give
way by far more, so that the vertical forces are c0 + c1 x_k + c2 y_k. Here every sphere can move vertically. Against
the three patterns of such forces (heave, tilt about x, tilt about y) the spheres are held ten times as stiffly as by
contacts. Against the K - 3 other patterns, which warp the ring, they give way by a stated share of rho under the
weight, which is more than the misfit. Where all supports stay closed, this share is so large that warping carries no
load. Where a support opens, it is so small that the sphere does not hit the platform as it closes again. The stiffness
of the contacts, and with it the time in which the total force follows, does not change.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from multibody.models.engine import BODY_COORDINATES, items
from multibody.models.friction_springs import TurningSpheres

Array = NDArray[np.float64]

# Largest number of supports whose vertical forces follow from statics alone.
MAX_DETERMINATE_SUPPORTS = 3

# Stiffness of the springs under the spheres, against heave and tilt, divided by the stiffness of the contacts.
SPHERE_STIFFNESS_RATIO = 10.0

# Displacement of a support out of the plane of all (warping) under its share of the weight, over pendulum length rho:
# the first and smallest value. Later accuracy levels may set larger ones.
MIN_WARPING_COMPLIANCE = 2e-5

# Mass of all spheres together as a share of the total mass: so small that it hardly affects the motion.
SPHERES_MASS = 1e-2

# Rotation matrix that turns the x axis, along which a 1-D mass moves, upwards.
UPRIGHT_ROTATION = [[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]


@dataclass(frozen=True)
class Supports:
    """
    Spheres on which the platform slides, fixed or on springs.

    Attributes:
    - markers: Markers at the spheres' centers.
    - springs: The engine's object on all coordinates of the spheres and no others; empty where the spheres are fixed.
    - coordinates: Number of these coordinates.
    - vertical: Index of each sphere's vertical coordinate; empty where the spheres are fixed, (K,).
    - warping: `warping_projection` of the supports, (K, K).
    - set_stiffness: Sets the springs under the spheres for the contacts' penetration and the compliance against
      warping.
    """

    markers: list[Any]
    springs: list[Any]
    coordinates: int
    vertical: NDArray[np.int_]
    warping: Array
    set_stiffness: Callable[[float, float], None]

    def static_settlement(self, penetration: float) -> float:
        """Return how far the weight lowers spheres on springs, 0 for fixed ones; penetration: of the contacts."""
        return penetration / SPHERE_STIFFNESS_RATIO if len(self.vertical) else 0.0


def warping_projection(ring: Array) -> Array:
    """Return the projection (K, K) of vertical forces at places (K, 2) onto warping: no resultant force or moment."""
    patterns, _ = np.linalg.qr(np.column_stack([np.ones(len(ring)), ring]))
    projection: Array = np.eye(len(ring)) - patterns @ patterns.T
    return projection


def add_fixed_supports(mbs: Any, ring: Array) -> Supports:
    """Add spheres fixed to the ground at horizontal places (K, 2), centers at height 1 in model units of length."""
    plate = mbs.AddObject(items.ObjectGround())
    markers = [mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=plate, localPosition=[*place, 1.0])) for place in ring]

    def set_stiffness(penetration: float, warping_compliance: float) -> None:
        """Do nothing, as fixed spheres have no springs."""

    return Supports(
        markers=markers,
        springs=[],
        coordinates=0,
        vertical=np.empty(0, np.int_),
        warping=np.zeros((0, len(ring))),
        set_stiffness=set_stiffness,
    )


def add_sharing_supports(mbs: Any, ring: Array) -> Supports:
    """Add spheres at horizontal places (K, 2) on vertical springs, by which they share the load elastically."""
    # K vertical forces at places (x_k, y_k) can be split into the patterns 1, x_k, y_k, which balance heave and tilt,
    # and K - 3 others, which balance nothing: only the stiffness of the supports decides them. `warping_projection` is
    # the projection onto these. The springs are stiff against its complement, so that the contact alone decides how the
    # total force follows, and as soft as elastic bearings against warping, so that a rigid platform does not rock on
    # two diagonals (docs/decisions/0007-elastic-sharing.md). Each part is damped critically as the platform's share of
    # the mass on the same springs, so that neither rings.
    count = len(ring)
    warped = warping_projection(ring)
    nodes = [mbs.AddNode(items.Node1D(referenceCoordinates=[0.0])) for _ in ring]
    spheres = [
        items.ObjectMass1D(
            mass=SPHERES_MASS / count,
            nodeNumber=node,
            referencePosition=[*place, 1.0],
            referenceRotation=UPRIGHT_ROTATION,
        )
        for node, place in zip(nodes, ring)
    ]
    springs = mbs.AddObject(items.ObjectGenericODE2(nodeNumbers=nodes, forceVector=np.full(count, 1.0 / count)))
    markers = [mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=mbs.AddObject(sphere))) for sphere in spheres]

    def set_stiffness(penetration: float, warping_compliance: float) -> None:
        """Set the springs for the penetration of the contacts, and the warping of the supports, under the weight."""
        stiffness, damping = _sharing_springs(count, penetration, warping_compliance)
        mbs.SetObjectParameter(springs, "stiffnessMatrix", _combine_tilt_and_warping(warped, *stiffness))
        mbs.SetObjectParameter(springs, "dampingMatrix", _combine_tilt_and_warping(warped, *damping))

    return Supports(
        markers=markers,
        springs=[springs],
        coordinates=count,
        vertical=np.arange(count),
        warping=warped,
        set_stiffness=set_stiffness,
    )


def _sharing_springs(
    count: int, penetration: float, warping_compliance: float
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return (stiffness, critical damping) of the springs, each a pair: (against heave and tilt, against warping)."""
    stiff, soft = SPHERE_STIFFNESS_RATIO / (count * penetration), 1.0 / (count * warping_compliance)
    return (stiff, soft), (2.0 * np.sqrt(stiff / count), 2.0 * np.sqrt(soft / count))


def _combine_tilt_and_warping(warped: Array, stiff: float, soft: float) -> Array:
    """Return a stiffness or damping matrix (K, K): `stiff` against heave and tilt, `soft` against warping."""
    return stiff * (np.eye(len(warped)) - warped) + soft * warped


def make_turning_supports(mbs: Any, ring: Array, turning: TurningSpheres, shared: bool) -> Supports:
    """Return supports at places (K, 2) whose spheres can turn; shared: whether they share the load elastically."""
    count, size = len(ring), turning.coordinates
    vertical = 2 + BODY_COORDINATES * np.arange(count) if shared else np.empty(0, np.int_)
    warped = warping_projection(ring) if shared else np.zeros((0, count))

    def set_stiffness(penetration: float, warping_compliance: float) -> None:
        """Set the springs for the penetration of the contacts, and the warping of the supports, under the weight."""
        if not shared:
            return
        block = np.ix_(vertical, vertical)
        stiffness, damping = _sharing_springs(count, penetration, warping_compliance)
        for name, held, parts in (
            ("stiffnessMatrix", turning.stiffness, stiffness),
            ("dampingMatrix", turning.damping, damping),
        ):
            matrix = held.copy()
            matrix[block] = _combine_tilt_and_warping(warped, *parts)
            mbs.SetObjectParameter(turning.bodies[0], name, matrix)

    return Supports(
        markers=turning.markers,
        springs=turning.bodies,
        coordinates=size,
        vertical=vertical,
        warping=warped,
        set_stiffness=set_stiffness,
    )
