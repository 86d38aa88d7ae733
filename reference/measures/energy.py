"""Energy of a motion: work of the ground, energy dissipated by friction and dampers, energy stored."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from reference.problem.result import Array, Trajectory
from reference.problem.scene import Scene
from reference.support.constants import GRAVITY


class Energy(NamedTuple):
    """Powers and stored energies at T instants; NaN where the motion does not determine them."""

    time: Array  # (T,) s
    friction: Array  # (T,) W, power of friction, dissipated except for what goes into `sheared`
    dampers: Array  # (T,) W, power that the dampers of the links dissipate
    ground: Array  # (T,) W, power of inertial forces on the motion relative to the ground
    stored: Array  # (T,) J, kinetic, elastic and gravitational energy of the bodies
    sheared: Array  # (T,) J, energy that friction stores which is elastic before it slides; 0 for rigid friction

    def friction_energy(self) -> float:
        """Return the energy that friction has dissipated by the end of the motion, J."""
        return float(np.trapezoid(self.friction, self.time)) - float(self.sheared[-1] - self.sheared[0])

    def damping_energy(self) -> float:
        """Return the energy that the dampers of the links have dissipated by the end of the motion, J."""
        return float(np.trapezoid(self.dampers, self.time))

    def imbalance(self) -> float:
        """Return the work of the ground less dissipated and stored energy, J, which is zero in an exact motion."""
        power = self.ground - self.friction - self.dampers
        return float(np.trapezoid(power, self.time) - (self.stored[-1] - self.stored[0]))

    def split_into_subsamples(self, step: int) -> list[Energy]:
        """Return `step` subsamples: each has every `step`-th instant, from another start, and both end instants."""
        last = len(self.time) - 1
        kept = [np.unique(np.r_[0, first:last:step, last]) for first in range(step)]
        return [Energy(*(history[rows] for history in self)) for rows in kept]


def friction_force(scene: Scene, place: Array, total: Array, contact: Array) -> Array:
    """
    Return the friction force on the platform, (T, 3), N: the force of the contact on all bodies less its normal force.

    place: (T, 3), m, of the platform. total: (T, N, 3), m/s^2, absolute accelerations. contact: (T,), N, normal force.
    """
    force = np.einsum("i,tia->ta", scene.masses, total)
    force[:, 2] += scene.total_mass * GRAVITY
    normal = np.array([0.0, 0.0, 1.0]) - place / scene.radius
    friction: Array = force - contact[:, None] * normal
    return friction


def compute_energy(motion: Trajectory) -> Energy:
    """
    Return powers and stored energies of a motion.

    If bodies turn, what needs their rotation is NaN: stored energy and the powers of the ground and of the dampers.
    """
    # Motions by the small-displacement equations have no height. Their restoring force is a paraboloid's: its height
    # p^2 / 2 rho and its slope take part in the energies of gravity and of the vertical ground motion.
    scene, place, velocity = motion.scene, motion.position, motion.velocity
    masses = scene.masses
    height, upward = place[:, :, 2], velocity[:, :, 2]
    if not height.any():
        height = np.broadcast_to((place[:, :1, :2] ** 2).sum(axis=2) / (2.0 * scene.radius), height.shape)
        upward = np.broadcast_to((place[:, :1, :2] * velocity[:, :1, :2]).sum(axis=2) / scene.radius, upward.shape)
    kinetic = 0.5 * (masses[:, None] * velocity**2).sum(axis=(1, 2))
    elastic = 0.5 * (scene.stiffness * np.diff(place[:, :, :2], axis=1) ** 2).sum(axis=(1, 2))
    dampers = (scene.damping * np.diff(velocity[:, :, :2], axis=1) ** 2).sum(axis=(1, 2))
    stored = kinetic + elastic + GRAVITY * height @ masses
    shaking = np.concatenate([velocity[:, :, :2], upward[:, :, None]], axis=2)
    ground = -np.einsum("i,tia,ta->t", masses, shaking, motion.ground)
    if "turns" in motion.extra:
        stored, ground, dampers = np.full((3, len(motion.time)), np.nan)
    sheared = np.zeros(len(motion.time))
    if scene.dry_friction.elastic:
        force = friction_force(scene, place[:, 0], motion.absolute_acceleration, motion.contact_force)
        sheared = (force**2).sum(axis=1) / (2.0 * scene.dry_friction.stiffness)
    return Energy(
        time=motion.time,
        friction=motion.friction_power,
        dampers=dampers,
        ground=ground,
        stored=stored,
        sheared=sheared,
    )
