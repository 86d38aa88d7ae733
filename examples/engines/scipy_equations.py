"""
SciPy on equations written out by hand: a chain on a sphere, friction linear below v_reg. Needs nothing more.

    python -m comparison.run fig3-I --grid 4 --model SciPy=examples.engines.scipy_equations:amplification@regularised

Newton-Euler; the vertical motion of the platform follows from the sphere and carries the mass of all bodies.
`method` and `rtol` are for trying.
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp

from reference.problem import GRAVITY, ground_acceleration, ground_peak

BETWEEN = 5  # instants per step of the solver at which the acceleration is read: its peaks are far shorter than a wave


def amplification(scene, phases, regularization=1e-3, tolerance=1e-3, method="LSODA", rtol=None):
    mu = [_peaks(scene, phase, regularization, method, rtol or 1e-2 * tolerance) for phase in phases]
    return np.array(mu) / ground_peak(scene, phases)[:, None]


def _peaks(scene, phase, v_reg, method, rtol):
    """Largest absolute acceleration of every body, m/s^2."""
    half = 2 * len(scene.masses)

    def slope(t, y):
        return np.append(y[half:], _accelerations(scene, phase, v_reg, t, y)[0])

    span, start = (0.0, scene.duration), np.zeros(2 * half)
    run = solve_ivp(slope, span, start, method, rtol=rtol, atol=1e-2 * rtol, dense_output=True)
    if not run.success:
        return np.full(len(scene.masses), np.nan)
    times = np.interp(np.arange(0, len(run.t) - 1, 1 / BETWEEN), np.arange(len(run.t)), run.t)
    absolute = [_accelerations(scene, phase, v_reg, t, run.sol(t))[1] for t in times]
    return np.linalg.norm(absolute, axis=2).max(axis=0)


def _accelerations(scene, phase, v_reg, t, y):
    """Relative to the ground, (N, 2), and absolute, (N, 3), m/s^2."""
    x, v = y.reshape(2, -1, 2)
    ground, mass, total, radius = (
        ground_acceleration(scene, phase, [t])[0],
        scene.masses,
        scene.total_mass,
        scene.radius,
    )
    links = scene.stiffness * np.diff(x, axis=0) + scene.damping * np.diff(v, axis=0)
    force = np.diff(links, axis=0, prepend=0.0, append=0.0)
    a = force / mass[:, None] - ground[:2]
    height = -np.sqrt(radius**2 - x[0] @ x[0])  # above the center of the sphere
    normal = np.append(-x[0], -height) / radius
    velocity = np.append(v[0], -(x[0] @ v[0]) / height)  # along the sphere
    speed = np.linalg.norm(velocity)
    push = normal - scene.friction_coefficient * velocity / max(speed, v_reg)
    free = np.append(a[0], -GRAVITY - ground[2])  # of the platform without contact; its inertia upward is that of all
    inverse = 1.0 / np.array([mass[0], mass[0], total])
    contact = (speed**2 / radius - normal @ free) / (normal @ (inverse * push))
    platform = free + contact * inverse * push
    a[0] = platform[:2]
    absolute = np.column_stack([a + ground[:2], np.full(len(mass), platform[2] + ground[2])])
    return a.ravel(), absolute
