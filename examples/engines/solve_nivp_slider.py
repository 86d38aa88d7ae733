"""
solve_nivp: implicit steps with a projection onto the disk of friction. Needs `pip install solve_nivp`.

    python -m comparison.run fig3-I --grid 2 --model nivp=examples.engines.solve_nivp_slider:amplification@resolved

The law is set-valued and truly sticks: r = P(r - h v), with the force of friction r, the slip velocity v and the
projection P onto the disk whose radius is the coefficient times the contact force. What it cannot express: the
one-sided limits at stops, which no step shows. It is slow: a phase pair takes half a minute.
"""

import math

import numpy as np
from solve_nivp import CompositeMethod, ImplicitEquationSolver, ODESolver, ODESystem
from solve_nivp.projections import Projection

from reference.problem import GRAVITY, ground_acceleration, ground_peak

STUCK, SLIDES = 1e-6, 1e-3  # m/s: between these speeds no acceleration is read, as in `resolved`


def amplification(scene, phases, step=4e-3):
    return np.array([Slider(scene, phase).peaks(step) for phase in phases]) / ground_peak(scene, phases)[:, None]


class Slider(Projection):
    """Unknowns: displacements (N, 2), velocities (N, 2), force of friction over m1 along two tangents (2,)."""

    def __init__(self, scene, phase):
        super().__init__()
        self.scene, self.phase = scene, phase
        self.half = 2 * len(scene.masses)
        # all bodies share the vertical motion of the platform
        self.inverse = np.array([1.0, 1.0, scene.masses[0] / scene.total_mass])

    def peaks(self, step):
        """Largest absolute acceleration of every body, m/s^2."""
        size = 2 * self.half + 2
        solver = ImplicitEquationSolver("semismooth_newton", proj=self, lam=1.0, adaptive_lam=False)
        method = CompositeMethod(solver=solver, A=np.diag(np.repeat([1.0, 0.0], [size - 2, 2])))
        system = ODESystem(self.slope, np.zeros(size), method)
        times, states, *_ = ODESolver(system, (0.0, self.scene.duration), step).solve()
        largest = np.zeros(len(self.scene.masses))
        for t, y in zip(times, states):
            _, total, _, _, velocity = self.accelerations(t, y)
            total[0] *= not STUCK < np.linalg.norm(velocity) < SLIDES
            largest = np.maximum(largest, np.linalg.norm(total, axis=1))
        return largest

    def accelerations(self, t, y):
        """Relative (N, 2), absolute (N, 3); contact force over m1, tangents (2, 3), velocity of the platform (3,)."""
        scene, (x, v), r = self.scene, y[:-2].reshape(2, -1, 2), y[-2:]
        u = ground_acceleration(scene, self.phase, [t])[0]
        links = scene.stiffness * np.diff(x, axis=0) + scene.damping * np.diff(v, axis=0)
        a = np.diff(links, axis=0, prepend=0.0, append=0.0) / scene.masses[:, None] - u[:2]
        height = -math.sqrt(scene.radius**2 - x[0] @ x[0])
        normal = np.append(-x[0], -height) / scene.radius
        first = np.array([normal[2], 0.0, -normal[0]]) / math.hypot(normal[0], normal[2])
        tangents = np.array([first, np.cross(normal, first)])
        velocity = np.append(v[0], -(x[0] @ v[0]) / height)
        free = np.append(a[0], -GRAVITY - u[2]) + self.inverse * (r @ tangents)
        force = (velocity @ velocity / scene.radius - normal @ free) / (normal @ (self.inverse * normal))
        platform = free + force * self.inverse * normal
        a[0] = platform[:2]
        return a, np.column_stack([a + u[:2], np.full(len(a), platform[2] + u[2])]), force, tangents, velocity

    def slope(self, t, y):
        a, _, _, tangents, velocity = self.accelerations(t, y)
        return np.concatenate([y[self.half : -2], a.ravel(), -tangents @ velocity])

    def project(self, current_state, candidate, rhok=None, t=None, Fk_val=None):
        radius, size = self._disk(current_state, t), np.linalg.norm(candidate[-2:])
        projected = candidate.copy()
        projected[-2:] *= min(1.0, radius / size) if size else 1.0
        return projected

    def tangent_cone(self, candidate, current_state, rhok=None, t=None, Fk_val=None):
        radius, r = self._disk(current_state, t), candidate[-2:]
        size, slope = np.linalg.norm(r), np.eye(len(candidate))
        if size > radius:
            slope[-2:, -2:] = radius / size * (np.eye(2) - np.outer(r, r) / size**2)
        return slope

    def _disk(self, state, t):
        return self.scene.friction_coefficient * self.accelerations(t, state)[2]
