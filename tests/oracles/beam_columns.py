"""Clamped bars under the weight of a body by the theory of beam-columns and by the engine's beam elements."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from reference.problem import GRAVITY

Array = NDArray[np.float64]


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

    def frequencies(self) -> Array:
        """Angular frequencies of sway and rocking in a vertical plane, by the stability functions of a beam."""
        flexibility, length, weight = self.count * self.bending_stiffness, self.length, self.mass * GRAVITY
        # w = a + b z + c cos(p z) + d sin(p z) under the axial load P, p^2 = P / EJ
        p = math.sqrt(weight / flexibility)
        cosine, sine = math.cos(p * length), math.sin(p * length)
        clamped = np.array(
            [[1.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, p], [1.0, length, cosine, sine], [0.0, 1.0, -p * sine, p * cosine]]
        )
        # the third derivative and P w' give the lateral force -P b at the upper end, the second the moment EJ w"
        forces = np.array([[0.0, -1.0, 0.0, 0.0], [0.0, 0.0, -cosine, -sine]])
        top = weight * forces @ np.linalg.inv(clamped)[:, 2:]
        top[1, 1] += self.count * self.axial_stiffness / length * 0.5 * self.spread**2
        # u of the upper end = x - center theta, w' = theta for a rotation theta that tilts the body towards x
        moved = np.array([[1.0, -self.center], [0.0, 1.0]])
        stiffness = moved.T @ top @ moved
        stiffness[1, 1] -= weight * self.center
        return np.sqrt(eigh(stiffness, np.diag([self.mass, self.inertia]), eigvals_only=True))
