"""
Kinematics of the spheres in the depressions of a platform that turns.

A depression is the upper half of a hollow sphere. The engine's contact is a whole hollow sphere: it would press from
below once the platform has risen by twice rho. So the clearance between platform and spheres is computed here.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Depressions:
    """
    Geometry of the platform's depressions over spheres on the plate, in units of the model: pendulum length rho = 1.

    ring: places of the spheres, (K, 2). center: the platform's center of mass at rest, from the middle of the plane of
    the depressions, (3,). radius: of the spheres. vertical: index of each sphere's vertical coordinate, (K,); empty
    where the spheres are fixed to the plate.
    """

    ring: Array
    center: Array
    radius: float
    vertical: NDArray[np.int_]

    def sphere_positions(self, coordinates: Array) -> tuple[Array, Array]:
        """
        Return the vectors (T, K, 3) from the centers of the depressions to those of the spheres.

        The first array has them in the axes of the plate, the second in those of the platform.
        """
        turned = rotation_matrices(coordinates[:, 3:6])
        local = np.column_stack([self.ring, np.zeros(len(self.ring))]) - self.center
        place = coordinates[:, None, :3] + self.center + np.einsum("tij,kj->tki", turned, local)
        apart = self._sphere_centers(coordinates) - place
        return apart, np.einsum("tij,tki->tkj", turned, apart)

    def clearance(self, coordinates: Array) -> Array:
        """Return the gaps (T, K) between depressions and spheres at coordinates (T, n); negative where they overlap."""
        _, inside = self.sphere_positions(coordinates)
        across, upward = np.hypot(inside[..., 0], inside[..., 1]), inside[..., 2]
        # a sphere below the rim touches nothing until it is back in its depression, or has left it (`rows_beyond_rim`)
        clear: Array = 1.0 - np.where(upward > 0.0, np.hypot(across, upward), 0.0)
        return clear

    def is_near_rest(self, coordinates: Array) -> bool:
        """
        Return whether bounds prove that no sphere leaves its depression and no tilt is 90 degrees; coordinates: (T, n).

        The proof spares `rows_beyond_rim`, which costs more. A platform that is displaced by u and turned by an angle t
        moves a depression at the distance l from its center by |u| + t l at most, and lifts it by |u_z| + t l.
        """
        largest: list[float] = np.abs(coordinates).max(axis=0).tolist()
        shift, lift, turn = sum(largest[:3]), largest[2], sum(largest[3:6])
        sinking = max([largest[place] for place in self.vertical], default=0.0)
        moved = turn * self._farthest
        height_in_rim = 1.0 - sinking - lift - moved - turn * (1.0 + sinking + shift + moved)
        return height_in_rim > 0.0  # if so, the rotation `turn` is also below 1 rad, so that no tilt is 90 degrees

    @cached_property
    def _farthest(self) -> float:
        """Largest distance of a depression from the platform's center of mass."""
        return float(np.hypot(np.hypot(*(self.ring - self.center[:2]).T), self.center[2]).max())

    def rows_beyond_rim(self, coordinates: Array) -> NDArray[np.bool_]:
        """Return a mask (T,) of the rows of coordinates (T, n) in which a sphere has left its depression."""
        _, inside = self.sphere_positions(coordinates)
        outside = (inside[..., 2] <= 0.0) & (np.hypot(inside[..., 0], inside[..., 1]) >= 1.0)
        return np.asarray(outside.any(axis=1))

    def contact_normals_and_jacobian(self, coordinates: Array) -> tuple[Array, Array]:
        """
        Return the normals (K, 3) of the contacts, and the Jacobians (K, 3, 6) of the platform's contact points.

        A Jacobian maps velocity and angular velocity of the platform, (6,), to the velocity of a contact point on it.
        """
        normals = self._platform_normals(coordinates)
        levers = self._sphere_centers(coordinates) + self.radius * normals - coordinates[:3] - self.center
        jacobian = np.concatenate([np.tile(np.eye(3), (len(levers), 1, 1)), -cross_matrix(levers)], axis=2)
        return normals, jacobian

    def _platform_normals(self, coordinates: Array) -> Array:
        """Return the normals (K, 3) of the platform's surface, away from the plate, at its contacts."""
        apart, _ = self.sphere_positions(coordinates[None])
        normals: Array = apart[0] / np.linalg.norm(apart[0], axis=1)[:, None]
        return normals

    def _sphere_centers(self, coordinates: Array) -> Array:
        """Return the centers (..., K, 3) of the spheres in the axes of the plate for coordinates (..., n)."""
        spheres = np.ones((*coordinates.shape[:-1], len(self.ring), 3))
        spheres[..., :2] = self.ring
        if len(self.vertical):
            spheres[..., 2] += coordinates[..., self.vertical]
        return spheres


class FlatUnderside(Depressions):
    """Geometry of a flat slider's plane on spheres, in place of depressions; at rest the plane touches sphere tops."""

    def clearance(self, coordinates: Array) -> Array:
        """Return the gaps (T, K) between plane and spheres at coordinates (T, n); negative where they overlap."""
        _, inside = self.sphere_positions(coordinates)
        clear: Array = 1.0 - inside[..., 2]
        return clear

    def rows_beyond_rim(self, coordinates: Array) -> NDArray[np.bool_]:
        """Return a mask (T,) without any row, since a plane has no rim."""
        return np.zeros(len(coordinates), dtype=bool)

    def _platform_normals(self, coordinates: Array) -> Array:
        """Return the unit vector along the rotated platform's own vertical axis, once for each support, (K, 3)."""
        upright = rotation_matrices(coordinates[3:6])[:, 2]
        return np.tile(upright, (len(self.ring), 1))


def rotation_matrices(angles: Array) -> Array:
    """Return the matrices (..., 3, 3) of the rotations Rx(a) Ry(b) Rz(c) by angles (..., 3), rad."""
    about_x, about_y, about_z = (_axis_rotations(axis, angles[..., axis]) for axis in range(3))
    product: Array = about_x @ about_y @ about_z
    return product


def angular_velocity_matrix(angles: Array) -> Array:
    """Return the matrix (3, 3) that maps rates of the angles (3,), rad, to angular velocity; columns: rotation axes."""
    about_x, about_y = _axis_rotations(0, angles[0]), _axis_rotations(1, angles[1])
    return np.column_stack([[1.0, 0.0, 0.0], about_x[:, 1], (about_x @ about_y)[:, 2]])


def cross_matrix(vectors: Array) -> Array:
    """Return matrices (..., 3, 3) whose product with any vector is the cross product of `vectors` (..., 3) with it."""
    x, y, z = np.moveaxis(vectors, -1, 0)
    zero = np.zeros_like(x)
    rows = [[zero, -z, y], [z, zero, -x], [-y, x, zero]]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def _axis_rotations(axis: int, angle: Array) -> Array:
    """Return the matrices (..., 3, 3) of rotations by `angle`, rad, about `axis` 0, 1 or 2 (x, y, z)."""
    matrix = np.zeros((*np.shape(angle), 3, 3))
    first, second = (axis + 1) % 3, (axis + 2) % 3
    matrix[..., axis, axis] = 1.0
    matrix[..., first, first] = matrix[..., second, second] = np.cos(angle)
    matrix[..., second, first] = np.sin(angle)
    matrix[..., first, second] = -np.sin(angle)
    return matrix
