"""Clamped bars under the weight of a body by the theory of beam-columns and by the engine's beam elements."""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from multibody.models.engine import exudyn, items
from reference.problem import GRAVITY

Array = NDArray[np.float64]

ELEMENTS = 8  # of a bar
BARS_MASS = 1e-4  # of a group of bars over that of the body: none would leave the elements without inertia
ALONG_THE_BAR = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])  # x of an element points up


@dataclass(frozen=True)
class Tower:
    """A rigid body on `count` massless upright bars that are clamped to the ground and to the body."""

    count: int
    bending_stiffness: float  # of a bar, N m^2
    length: float  # m
    axial_stiffness: float  # of a bar, N
    spread: float  # root mean square distance of the bars from the axis, m
    mass: float  # kg
    inertia: float  # about a horizontal axis through the center of mass, kg m^2
    center: float  # height of the center of mass above the upper ends, m

    @property
    def weight(self) -> float:
        return self.mass * GRAVITY

    def frequencies(self) -> Array:
        """Angular frequencies of sway and rocking in a vertical plane."""
        return np.sqrt(self.squares())

    def squares(self) -> Array:
        """Their squares, by the stability functions of a beam; negative where the body topples."""
        flexibility, length = self.count * self.bending_stiffness, self.length
        # w = a + b z + c cos(p z) + d sin(p z) under the axial load P, p^2 = P / EJ
        p = math.sqrt(self.weight / flexibility)
        cosine, sine = math.cos(p * length), math.sin(p * length)
        clamped = np.array(
            [[1.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, p], [1.0, length, cosine, sine], [0.0, 1.0, -p * sine, p * cosine]]
        )
        # the third derivative and P w' give the lateral force -P b at the upper end, the second the moment EJ w"
        forces = np.array([[0.0, -1.0, 0.0, 0.0], [0.0, 0.0, -cosine, -sine]])
        top = self.weight * forces @ np.linalg.inv(clamped)[:, 2:]
        top[1, 1] += self.count * self.axial_stiffness / length * 0.5 * self.spread**2
        # u of the upper end = x - center theta, w' = theta for a rotation theta that tilts the body towards x
        moved = np.array([[1.0, -self.center], [0.0, 1.0]])
        stiffness = moved.T @ top @ moved
        stiffness[1, 1] -= self.weight * self.center
        squares: Array = eigh(stiffness, np.diag([self.mass, self.inertia]), eigvals_only=True)
        return squares


def tower_of_beams(tower: Tower, force: float = 0.0) -> tuple[exudyn.SystemContainer, exudyn.MainSystem, int]:
    """
    The same in a vertical plane with the engine's cable elements: container, system and number of the body's node.

    Every bar stands at its place along x; the body is tied to their upper ends. force: along x, in weights of the body.
    """
    container = exudyn.SystemContainer()
    mbs = container.AddSystem()
    ground = mbs.AddObject(items.ObjectGround())
    body_node = mbs.AddNode(items.NodeRigidBody2D(referenceCoordinates=[0.0, tower.length + tower.center, 0.0]))
    body = mbs.AddObject(items.ObjectRigidBody2D(mass=tower.mass, inertia=tower.inertia, nodeNumber=body_node))
    center = mbs.AddMarker(items.MarkerBodyPosition(bodyNumber=body))
    mbs.AddLoad(items.LoadForceVector(markerNumber=center, loadVector=[force * tower.weight, -tower.weight, 0.0]))
    # two groups of bars stand as far from the axis as they all do in the mean along one axis
    for place in (-tower.spread / math.sqrt(2.0), tower.spread / math.sqrt(2.0)):
        nodes = [
            mbs.AddNode(items.NodePoint2DSlope1(referenceCoordinates=[place, height, 0.0, 1.0]))
            for height in np.linspace(0.0, tower.length, ELEMENTS + 1)
        ]
        for pair in pairwise(nodes):
            mbs.AddObject(
                items.ObjectANCFCable2D(
                    length=tower.length / ELEMENTS,
                    massPerLength=BARS_MASS * tower.mass / tower.length,
                    bendingStiffness=0.5 * tower.count * tower.bending_stiffness,
                    axialStiffness=0.5 * tower.count * tower.axial_stiffness,
                    nodeNumbers=list(pair),
                )
            )
        held = mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=ground, localHT=_clamp(place, 0.0)))
        top = mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localHT=_clamp(place, -tower.center)))
        for fixed, node in ((held, nodes[0]), (top, nodes[-1])):
            end = mbs.AddMarker(items.MarkerNodeRigid(nodeNumber=node))
            mbs.AddObject(items.ObjectJointGeneric(markerNumbers=[fixed, end], constrainedAxes=[1, 1, 0, 0, 0, 1]))
    mbs.Assemble()
    return container, mbs, body_node


def _clamp(along: float, up: float) -> Array:
    transformation = np.eye(4)
    transformation[:3, :3], transformation[:2, 3] = ALONG_THE_BAR, [along, up]
    return transformation
