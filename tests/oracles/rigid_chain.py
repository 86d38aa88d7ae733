"""
An independent calculation of the spatial model: Newton-Euler with constraints, integrated by SciPy's Radau.

Bodies and links are those of elastic_chain.py, in relative coordinates that project Newton-Euler; the supports are
rigid. The platform's depressions stay on the fixed spheres in the mean that elastic supports demand: bearings give way
vertically, so their vertical forces are c0 + c1 x_k + c2 y_k, of which the normal forces follow. Constraints are the
three moments of the vertical gaps that these forces work on. With three supports that is every gap by itself.
"""

import math
from dataclasses import dataclass

import numpy as np
from elastic_chain import ALONG, ElasticBuilding, exponential
from numpy.typing import NDArray
from sliding_plate import Ground

from reference.problem import Scene

Array = NDArray[np.float64]

STABILIZATION = 40.0  # 1/s, rate at which a violated constraint returns to zero (Baumgarte)


class RigidBuilding(ElasticBuilding):
    """A building on supports that do not give way; one that would have to pull carries nothing, if three are left."""

    def solved(self, q: Array, rates: Array, ground: Array) -> tuple[Array, Array]:
        """Changes of the rates (n,), and normal forces (K,)."""
        force, mass = self.bodies(q, rates, ground)
        pushes, gap_rates, penetrations, upright = self.supports(q, rates)
        later, before = (self.supports(q + sign * ALONG * rates, rates)[1] for sign in (1.0, -1.0))
        gap_changes = STABILIZATION**2 * penetrations - 2.0 * STABILIZATION * (gap_rates @ rates)
        wanted = gap_changes - (later - before) @ rates / (2.0 * ALONG)
        patterns, closed = np.column_stack([np.ones(len(self.ring)), self.ring]), np.ones(len(self.ring))
        while True:
            gaps, normals = ((closed / vertical)[:, None] * patterns for vertical in upright.T)
            matrix = np.block([[mass, -pushes.T @ normals], [gaps.T @ gap_rates, np.zeros((3, 3))]])
            solved = np.linalg.solve(matrix, np.concatenate([force, gaps.T @ wanted]))
            carried: Array = normals @ solved[len(q) :]
            if carried.min() >= 0.0 or closed.sum() <= 3.0:
                return solved[: len(q)], carried
            closed[carried.argmin()] = 0.0

    def changes(self, q: Array, rates: Array, ground: Array) -> Array:
        return self.solved(q, rates, ground)[0]


@dataclass(frozen=True)
class SpatialMotion:
    """mu (N,), and samples of the motion."""

    mu: Array
    support_force: Array  # (T, K), N
    yaw: Array  # (T,), of the platform, rad: the last of three angles about x, y and z, each in the axes turned so far


def spatial_motion(
    scene: Scene, phase: tuple[float, float], regularization: float, tolerance: float = 1e-6
) -> SpatialMotion:
    """The motion from rest for one phase pair; the supports must stay loaded (RuntimeError otherwise)."""
    table = scene.model_dump(exclude_none=True)
    table["excitation"]["amplitudes"] = scene.amplitudes
    building, ground = RigidBuilding(table, regularization), Ground(table, phase)
    peak, forces, yaws = np.zeros(len(scene.bodies)), [], []
    for q, rates, acceleration in building.motion(np.zeros(6 * len(scene.bodies)), ground, tolerance):
        changes, normals = building.solved(q, rates, acceleration)
        if normals.min() < 0.0:
            raise RuntimeError("a support lifts off")
        peak = np.maximum(peak, building.sizes(q, rates, changes, acceleration))
        forces.append(normals)
        turned = exponential(q[3:6])[0]
        yaws.append(math.atan2(-turned[0, 1], turned[0, 0]))
    return SpatialMotion(peak / ground.largest(), np.array(forces), np.array(yaws))
