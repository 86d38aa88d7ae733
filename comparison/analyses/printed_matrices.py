"""
The matrix form (3.9)-(3.13), (3.15) as it stands in the paper, slip by slip, so that what a slip costs can be measured.

Written from the print and not from the reference, whose equations it must give once every slip is mended. Friction
grows linearly with the speed below V_REG (a lubricated contact needs no such limit), so that an ordinary integrator
can follow it; this is for the size of an effect, not for surfaces.
"""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import solve_ivp

from comparison.plan.ladder import V_REG
from reference.problem import GRAVITY, Scene, ground_acceleration, ground_peak

Array = NDArray[np.float64]

WRONG_SPRING = "(3.12) c_24 with k^x"
WRONG_DAMPING = "(3.15) h_12, h_21 without rho, h_22 with xi''"
RELATIVE, ABSOLUTE = 1e-7, 1e-10
SAMPLES = 2e-3  # s between the instants at which peaks are read


def printed_amplification(scene: Scene, phases: ArrayLike, slips: Collection[str] = ()) -> Array:
    """
    mu_i (5.1), (M, N), for the phases (M, 2), rad, with the `slips` named left as printed and all others mended.

    NaN where the motion leaves the sphere's lower half or grows without bound. Good to about 1e-4.
    """
    pairs = np.asarray(phases, float)
    return np.array([_peaks(scene, phase, slips) for phase in pairs]) / ground_peak(scene, pairs)[:, None]


def _peaks(scene: Scene, phase: Array, slips: Collection[str]) -> Array:
    bodies = len(scene.bodies)
    count = 2 * bodies

    def ground(t: float) -> Array:
        vector: Array = ground_acceleration(scene, phase, [t])[0]
        return vector

    def slope(t: float, state: Array) -> Array:
        return np.concatenate([state[count:], _accelerations(scene, state[:count], state[count:], ground(t), slips)])

    def rim(t: float, state: Array) -> float:
        return float(0.999 - np.hypot(*state[:2]) / scene.radius)

    rim.terminal = True  # type: ignore[attr-defined]  # the way solve_ivp is told
    times = np.linspace(0.0, scene.duration, int(np.ceil(scene.duration / SAMPLES)) + 1)
    motion = solve_ivp(slope, (0.0, scene.duration), np.zeros(2 * count), "LSODA", times, False, rim, rtol=RELATIVE,
                       atol=ABSOLUTE, max_step=scene.duration / 200.0)  # fmt: skip
    if motion.status != 0:
        return np.full(bodies, np.nan)
    peak = np.zeros(bodies)
    for t, state in zip(motion.t, motion.y.T):
        u, q, v = ground(t), state[:count], state[count:]
        a = _accelerations(scene, q, v, u, slips)
        delta = -np.sqrt(scene.radius**2 - q[0] ** 2 - q[1] ** 2)
        climb = -(a[0] * q[0] + a[1] * q[1]) / delta - _w(q, v, delta)  # (3.4)
        total = np.column_stack([a.reshape(-1, 2) + u[:2], np.full(bodies, climb + u[2])])
        peak = np.maximum(peak, np.linalg.norm(total, axis=1))
    return peak


def _w(q: Array, v: Array, delta: float) -> float:
    """W of (3.5)."""
    return float((v[0] ** 2 + v[1] ** 2) / delta + (q[0] * v[0] + q[1] * v[1]) ** 2 / delta**3)


def _accelerations(scene: Scene, q: Array, v: Array, ground: Array, slips: Collection[str]) -> Array:
    """q'' = M^-1 (E - H q' - C q), (3.9)."""
    rho, m, total = scene.radius, scene.masses, scene.total_mass
    x, y, vx, vy = *q[:2], *v[:2]
    xi, eta, zeta = ground
    delta = -np.sqrt(rho**2 - x**2 - y**2)
    p, r = x / delta, y / delta  # P and Q of (3.4)
    speed = np.sqrt(vx**2 + vy**2 + (vx * p + vy * r) ** 2)  # (3.8)
    w = _w(q, v, delta)
    over_speed = scene.friction_coefficient if scene.lubricated else scene.friction_coefficient / max(speed, V_REG)
    s = over_speed * rho  # mu rho / v, (3.14) included

    inertia = np.diag(np.repeat(m, 2))
    own = m[0] * (delta - s * (vx * p + vy * r))
    inertia[0, :2] = own + total * p * (x + s * vx), total * r * (x + s * vx)
    inertia[1, :2] = total * p * (y + s * vy), own + total * r * (y + s * vy)

    damping = np.zeros_like(inertia)
    main, cross = -total * (GRAVITY + zeta - w) * s, s
    last = eta
    if WRONG_DAMPING in slips:
        cross, last = over_speed, xi
    damping[0, :2] = main - m[0] * xi * p * s, -m[0] * xi * r * cross
    damping[1, :2] = -m[0] * eta * p * cross, main - m[0] * last * r * s

    stiffness = np.zeros_like(inertia)
    load = -np.repeat(m, 2) * np.tile([xi, eta], len(m))
    load[:2] *= delta
    for link, pair in enumerate(scene.stiffness):
        for axis, k in enumerate(pair):
            low, high = 2 * link + axis, 2 * link + 2 + axis
            factor = delta if link == 0 else 1.0
            stiffness[low, low] += factor * k
            stiffness[low, high] -= factor * (pair[0] if link == 0 and WRONG_SPRING in slips else k)
            stiffness[high, high] += k
            stiffness[high, low] -= k
            if link == 0:
                load[axis] -= s * (vx * p + vy * r) * k * (q[high] - q[low])
    stiffness[[0, 1], [0, 1]] -= total * (zeta + GRAVITY - w)
    solution: Array = np.linalg.solve(inertia, load - damping @ v - stiffness @ q)
    return solution
