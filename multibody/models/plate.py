"""
The two ways of the loading: inertial forces in the plate's frame, or the motion of a plate that carries the supports.

The moving plate is a rigid body far heavier than all others together. Its own mass times the loading's acceleration
pushes it. Its coordinates are the system's last. `EngineSolver` returns motion relative to it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from multibody.models.engine import BODY_COORDINATES, items
from multibody.models.loading import Ground, attach_symbolic_load

LOADINGS = ("inertial", "plate")
# Mass of the plate over that of all bodies: they move it by a millionth of what it moves them.
PLATE_MASS_RATIO = 1e6

# Moment of inertia in units of mass * length^2: the body turns by 1e-11 rad in 20 s under the largest torque.
LOCKED_INERTIA = 1e15


@dataclass(frozen=True)
class Plate:
    """The engine's body that carries the supports; if it moves, its node and the expressions of its load."""

    body: Any
    moves: bool
    node: Any = None
    expressions: tuple[Any, ...] = ()


def add_plate(mbs: Any, loading: str, ground: Ground) -> Plate:
    """Add the plate, after all other coordinates, at the origin."""
    if loading == "inertial":
        return Plate(mbs.AddObject(items.ObjectGround()), moves=False)
    node = mbs.AddNode(items.NodeRigidBodyRxyz(referenceCoordinates=[0.0] * BODY_COORDINATES))
    body = mbs.AddObject(
        items.ObjectRigidBody(nodeNumber=node, mass=PLATE_MASS_RATIO, inertia=[LOCKED_INERTIA] * 3 + [0.0] * 3)
    )

    def drive(mbs: Any, t: Any, loadVector: Any) -> list[Any]:
        return [PLATE_MASS_RATIO * ground.acceleration_along(axis, t) for axis in range(3)]

    center = mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body))
    load = mbs.AddLoad(items.LoadForceVector(markerNumber=center, loadVector=[0.0, 0.0, 0.0]))
    return Plate(body, True, node, (attach_symbolic_load(mbs, load, "loadVectorUserFunction", drive),))


def carrying_axes(carried: np.ndarray[Any, Any], count: int) -> np.ndarray[Any, Any]:
    """Direction of the plate that each of `count` coordinates goes along with, (count,); 3 where there is none."""
    axes = np.full(count, 3)
    axes[carried] = np.arange(3)
    return axes
