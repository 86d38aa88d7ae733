"""
Velocities after an impact of the platform on spheres that had left it.

An impact takes no time: positions stay, velocities jump. The impulses obey Newton's law of restitution along the
normals and Coulomb's law across them, both stated with the velocities after the impact (Moreau 1988). Spheres that
carry load may push, too, and not pull. Bars are rigid in tension and bending, as they are compared with the contacts,
and give way in shear and twist. Bars with an axial stiffness of their own give way in every direction. The result does
not depend on the stiffness of the contacts.

References
----------
Moreau, J. J. (1988). Unilateral contact and dry friction in finite freedom dynamics. In: Nonsmooth Mechanics and
Applications, CISM Courses and Lectures 302, 1-82.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import orth

from multibody.models.depressions import Depressions, angular_velocity_matrix, rotation_matrices
from multibody.models.engine import BODY_COORDINATES
from reference.problem import DryFriction

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

# Slice of the platform's coordinates, the first ones of the bodies.
PLATFORM_SLICE = slice(BODY_COORDINATES)

# Sweeps over the contacts, which solve for the impulses, end at this number, or if no velocity changes in a sweep by
# more than this share of the largest velocity before the impact.
MAX_SWEEPS, SWEEP_TOLERANCE = 2000, 1e-11

# Normal speed after an impact, in the model's unit of velocity, beyond which a contact counts as open.
OPENING_SPEED = 1e-5


@dataclass(frozen=True)
class ImpactLaw:
    """
    Law for the velocities after an impact of a platform that carries bodies on links, in units of the model.

    Attributes:
    - masses: Masses of the bodies, (N,).
    - inertias, axes: Moments of inertia about the axes of each body, (N, 3), and these axes at rest, as columns, (N, 3,
      3).
    - centers: Centers of mass at rest, from the axis on which the links stand, (N, 3).
    - friction: Friction law, evaluated at the slip speed before the impact.
    - corner: Slip speed below which the friction coefficient is reduced linearly.
    - rigid: Mask of the links that are rigid in tension and bending, (N - 1,).
    """

    depressions: Depressions
    masses: Array
    inertias: Array
    axes: Array
    centers: Array
    restitution: float
    friction: DryFriction
    corner: float
    rigid: Mask

    def solve_impact(self, coordinates: Array, velocities: Array, closed: Mask, hit: Mask) -> tuple[Array, Mask]:
        """
        Return the velocities (n,) after an impact, and the mask (K,) of the contacts that are open then.

        hit: mask of the contacts that collide. closed: mask of the others that touch, which may push in the impact.
        """
        # The impulses of all struck contacts act on the bodies at once, through the inverse of the mass matrix with
        # rigid links as constraints (Delassus' operator in the axes of the contacts). Contacts that are hit rebound by
        # Newton's restitution, and closed contacts may push without rebounding. Friction and unilateral contact hold
        # for the velocities after the impact, which sweeps over the contacts find (`_solve_impulses`). The mass of the
        # spheres is negligible: a sphere that springs up does not push the platform, and a sphere that is hit follows
        # it.
        count = BODY_COORDINATES * len(self.masses)
        turning = self._velocity_matrix(coordinates)
        speeds = turning @ velocities[:count]
        normals, jacobian = self.depressions.contact_normals_and_jacobian(coordinates)
        struck = np.flatnonzero(closed | hit)
        axes = _contact_axes(normals[struck])
        rows = np.zeros((len(struck), 3, count))
        rows[:, :, PLATFORM_SLICE] = axes @ jacobian[struck]
        before = rows @ speeds
        if len(self.depressions.vertical):
            upward = velocities[self.depressions.vertical[struck]]
            upward[hit[struck]] = np.minimum(upward[hit[struck]], 0.0)
            before -= axes[:, :, 2] * upward[:, None]
        response = self._impulse_response(coordinates)
        flat = rows.reshape(-1, count)
        delassus = flat @ response @ flat.T
        rebound = np.where(hit[struck], -self.restitution * np.minimum(before[:, 0], 0.0), 0.0)
        impulses = self._solve_impulses(delassus, before, rebound)
        after = speeds + response @ flat.T @ impulses.ravel()
        normal_speed = before[:, 0] + (delassus @ impulses.ravel()).reshape(-1, 3)[:, 0]
        is_open = ~(closed | hit)
        is_open[struck] = normal_speed > OPENING_SPEED
        changed = velocities.copy()
        changed[:count] = np.linalg.solve(turning, after)
        return self.carry_spheres_along(coordinates, changed, hit & ~is_open), is_open

    def carry_spheres_along(self, coordinates: Array, velocities: Array, hit: Mask) -> Array:
        """Return velocities (n,) in which the light spheres `hit` (K,) follow the platform."""
        vertical = self.depressions.vertical
        if not len(vertical):
            return velocities
        normals, _ = self.depressions.contact_normals_and_jacobian(coordinates)
        _, leaving = self.normal_speeds(coordinates, velocities)
        followed = velocities.copy()
        followed[vertical[hit]] += (leaving / normals[:, 2])[hit]
        return followed

    def unload_bar_dampers(self, coordinates: Array, before: Array, after: Array, damping_times: Array) -> Array:
        """
        Return coordinates (n,) after an impact that changed velocities (n,), at which the bars' dampers exert no force.

        The engine's damper of a link sees the speed of its two ends along the bars, and takes the turning of bars with
        an offset for stretching. A small stretch, which jumps with the velocities, compensates for that. damping_times:
        damping over stiffness along the bars, (N - 1,).
        """
        count = BODY_COORDINATES * len(self.masses)
        turned = rotation_matrices(coordinates[:count].reshape(-1, BODY_COORDINATES)[:, 3:])
        jump = (self._velocity_matrix(coordinates) @ (after - before)[:count]).reshape(-1, 2, 3)
        shifted = coordinates.copy()
        for link, damping_time in enumerate(damping_times):
            along, levers = turned[link][:, 2], self._levers_to_link_ends(link, turned)
            ends = [jump[body, 0] + np.cross(jump[body, 1], lever) for body, lever in enumerate(levers, start=link)]
            stretch = damping_time * float(along @ (ends[1] - ends[0]))
            for first in range(BODY_COORDINATES * (link + 1), count, BODY_COORDINATES):
                shifted[first : first + 3] -= stretch * along
        return shifted

    def normal_speeds(self, coordinates: Array, velocities: Array) -> tuple[Array, Array]:
        """
        Return two speeds at which the platform leaves each sphere along the contact normal, both (K,).

        The second is relative to the sphere. For the first, a sphere that moves up counts as standing still.
        """
        platform = (self._velocity_matrix(coordinates) @ velocities[: BODY_COORDINATES * len(self.masses)])[
            PLATFORM_SLICE
        ]
        normals, jacobian = self.depressions.contact_normals_and_jacobian(coordinates)
        leaving: Array = np.einsum("ki,kij,j->k", normals, jacobian, platform)
        if not len(self.depressions.vertical):
            return leaving, leaving
        upward = normals[:, 2] * velocities[self.depressions.vertical]
        return leaving - np.minimum(upward, 0.0), leaving - upward

    def gap_rates(self, coordinates: Array) -> Array:
        """Return the matrix (K, n) from the engine's velocities to the rates of the gaps, at coordinates (n,)."""
        normals, jacobian = self.depressions.contact_normals_and_jacobian(coordinates)
        rates = np.zeros((len(normals), len(coordinates)))
        rates[:, PLATFORM_SLICE] = np.einsum("ki,kij->kj", normals, jacobian)
        rates[:, PLATFORM_SLICE] = (
            rates[:, PLATFORM_SLICE] @ self._velocity_matrix(coordinates)[PLATFORM_SLICE, PLATFORM_SLICE]
        )
        if len(self.depressions.vertical):
            rates[np.arange(len(normals)), self.depressions.vertical] = -normals[:, 2]
        return rates

    def stiff_deformation_rates(self, coordinates: Array, closed: Mask) -> Array:
        """
        Return the matrix (s, 6 N) from velocities of the bodies to rates at which stiff parts deform.

        Its rows are heave and tilt of the closed contacts, then stretching and bending of the rigid links.
        """
        count = BODY_COORDINATES * len(self.masses)
        ring = self.depressions.ring[closed]
        heave_and_tilt = orth(np.column_stack([np.ones(len(ring)), ring])).T if len(ring) else np.empty((0, 0))
        turned = rotation_matrices(coordinates[:count].reshape(-1, BODY_COORDINATES)[:, 3:])
        bars = self._bar_rates(coordinates, turned) @ self._velocity_matrix(coordinates)
        return np.vstack([heave_and_tilt @ self.gap_rates(coordinates)[closed, :count], bars])

    def _velocity_matrix(self, coordinates: Array) -> Array:
        """Return the matrix (6 N, 6 N) from the engine's velocities to velocities and angular velocities of bodies."""
        count = BODY_COORDINATES * len(self.masses)
        turning = np.eye(count)
        for first in range(0, count, BODY_COORDINATES):
            angles = slice(first + 3, first + BODY_COORDINATES)
            turning[angles, angles] = angular_velocity_matrix(coordinates[angles])
        return turning

    def _impulse_response(self, coordinates: Array) -> Array:
        """Return the matrix (6 N, 6 N) from impulses to changes of velocity, with bars that do not stretch or bend."""
        count = BODY_COORDINATES * len(self.masses)
        inverse = np.zeros((count, count))
        turned = rotation_matrices(coordinates[:count].reshape(-1, BODY_COORDINATES)[:, 3:])
        for body, (mass, inertia, axes) in enumerate(zip(self.masses, self.inertias, turned @ self.axes)):
            place = slice(BODY_COORDINATES * body, BODY_COORDINATES * body + 3)
            angles = slice(BODY_COORDINATES * body + 3, BODY_COORDINATES * (body + 1))
            inverse[place, place] = np.eye(3) / mass
            inverse[angles, angles] = axes / inertia @ axes.T
        bars = self._bar_rates(coordinates, turned)
        if not len(bars):
            return inverse
        held = inverse @ bars.T
        response: Array = inverse - held @ np.linalg.solve(bars @ held, held.T)
        return response

    def _bar_rates(self, coordinates: Array, turned: Array) -> Array:
        """
        Return the matrix (3 L, 6 N) from velocities of bodies to rates of stretching and bending of L rigid links.

        turned: rotation matrices of the bodies, (N, 3, 3).
        """
        count = len(self.masses)
        rows = np.zeros((3 * (count - 1), BODY_COORDINATES * count))
        places = coordinates[: BODY_COORDINATES * count].reshape(-1, BODY_COORDINATES)[:, :3].copy()
        places += self.centers
        for link in range(count - 1):
            below, above = BODY_COORDINATES * link, BODY_COORDINATES * (link + 1)
            levers = self._levers_to_link_ends(link, turned)
            shift = places[link + 1] + levers[1] - places[link] - levers[0]
            across, along = turned[link][:, :2].T, turned[link][:, 2]
            stretch = rows[3 * link]
            stretch[below : below + 3], stretch[above : above + 3] = -along, along
            # Stretch rate by an angular velocity w: along . (w x lever) = w . (lever x along). The link's axis turns
            # with the mean w of both bodies, which adds half of shift . (w x along) = -w . (shift x along) for each.
            turn = -0.5 * np.cross(shift, along)
            stretch[below + 3 : below + 6] = -np.cross(levers[0], along) + turn
            stretch[above + 3 : above + 6] = np.cross(levers[1], along) + turn
            rows[3 * link + 1 : 3 * link + 3, below + 3 : below + 6] = -across
            rows[3 * link + 1 : 3 * link + 3, above + 3 : above + 6] = across
        return rows[np.repeat(self.rigid, 3)]

    def _levers_to_link_ends(self, link: int, turned: Array) -> tuple[Array, Array]:
        """
        Return the two vectors (3,) from the centers of neighboring bodies to the ends of their link.

        turned: rotation matrices of the bodies, (N, 3, 3).
        """
        below, above = self.centers[link : link + 2]
        half = 0.5 * (above[2] - below[2])
        return turned[link] @ [-below[0], -below[1], half], turned[link + 1] @ [-above[0], -above[1], -half]

    def _solve_impulses(self, delassus: Array, before: Array, rebound: Array) -> Array:
        """
        Solve for the impulses (K, 3) of the contacts, one normal and two tangential components for each.

        delassus: matrix (3 K, 3 K) from impulses to changes of the contacts' velocities. before: these velocities, (K,
        3), before the impact. rebound: smallest normal speed of each contact after it, (K,).
        """
        # Projected Gauss-Seidel (Jean and Moreau 1992): each contact in turn takes the impulse that satisfies its own
        # law while all other impulses stay fixed. In the tangent plane the block of the contact is replaced by its
        # largest eigenvalue, so that Coulomb's law, linear below the corner, is solved in closed form and sweeps do not
        # overshoot.
        impulses = np.zeros_like(before)
        scale = float(np.abs(before).max(initial=0.0))
        friction = self.friction.at(np.hypot(before[:, 1], before[:, 2])).tolist()
        for _ in range(MAX_SWEEPS):
            change = 0.0
            for k in range(len(before)):
                own = slice(3 * k, 3 * k + 3)
                block, old = delassus[own, own], impulses[k].copy()
                now = before[k] + delassus[own] @ impulses.ravel()
                normal = max(0.0, old[0] - (now[0] - rebound[k]) / block[0, 0])
                across = 0.5 * (block[1, 1] + block[2, 2]) + float(
                    np.hypot(0.5 * (block[1, 1] - block[2, 2]), block[1, 2])
                )
                free = now[1:] - across * old[1:] + block[1:, 0] * (normal - old[0])
                size, limit = float(np.hypot(*free)), friction[k] * normal
                impulses[k, 0] = normal
                impulses[k, 1:] = -limit * free / max(size, self.corner + across * limit)
                change = max(change, float(np.abs(block @ (impulses[k] - old)).max()))
            if change <= SWEEP_TOLERANCE * scale:
                break
        return impulses


def _contact_axes(normals: Array) -> Array:
    """Return the matrices (K, 3, 3) whose rows are each normal (K, 3) and two tangential directions."""
    helper = np.where(np.abs(normals[:, :1]) < 0.5, [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]])
    first = np.cross(normals, helper)
    first /= np.linalg.norm(first, axis=1)[:, None]
    return np.stack([normals, first, np.cross(normals, first)], axis=1)
