"""
The matrix form (3.9)-(3.13), (3.15) as the paper prints it, erratum by erratum, to measure what each erratum costs.

Written from the print and not from the reference, whose equations it must give once every erratum is corrected.
Friction grows linearly with the speed below V_REG (a lubricated contact needs no such limit), so that an
ordinary integrator can follow it; this is for the size of an effect, not for surfaces.
"""

import math
from collections.abc import Collection
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reference.problem import GRAVITY, Scene, ground_peak
from reference.problem.excitation import acceleration_of_ground

Array = NDArray[np.float64]
V_REG = 1e-3  # m/s: below it friction grows linearly with the slip velocity
WRONG_SPRING = "(3.12) c_24 with k^x"
WRONG_DAMPING = "(3.15) h_12, h_21 without rho, h_22 with xi''"
RELATIVE, ABSOLUTE = 1e-6, 1e-9
LARGE = 0.8  # of the largest acceleration at the integrator's steps: beside a smaller one no peak is looked for
PARTS = 8  # of a step, between which peaks are read there: a change of friction lasts a millisecond


def printed_amplification(scene: Scene, phases: ArrayLike, errata: Collection[str] = ()) -> Array:
    """
    mu_i (5.1), (M, N), for the phases (M, 2), rad, with the `errata` named left as printed and all others mended.

    NaN where the motion leaves the sphere's lower half or grows without bound. Good to 1e-4.
    """
    pairs = np.asarray(phases, float)
    return np.array([_peaks(scene, phase, errata) for phase in pairs]) / ground_peak(scene, pairs)[:, None]


class _Fixed(NamedTuple):
    """What does not change along a motion."""

    scene: Scene
    rho: float
    friction: float
    lubricated: bool
    varies: bool  # whether the friction depends on the speed
    total: float
    masses: Array  # (2 N,), each twice
    links: Array  # (2 N, 2 N), C but for Delta, the factor of its first two rows, and their diagonal
    dampers: Array  # (2 N, 2 N), of the links, as `links`; the paper has none
    errata: Collection[str]


def _fixed(scene: Scene, errata: Collection[str]) -> _Fixed:
    masses = np.repeat(scene.masses, 2)
    links, dampers = _between(scene.stiffness), _between(scene.damping)
    if WRONG_SPRING in errata and len(scene.stiffness):
        links[1, 3] = links[0, 2]
    law = scene.friction_coefficient, scene.lubricated, scene.dry_friction.varies, float(scene.total_mass)
    return _Fixed(scene, scene.radius, *law, masses, links, dampers, errata)


def _between(links: Array) -> Array:
    """Coefficients of links, (N - 1, 2), as a matrix of the bodies, (2 N, 2 N)."""
    matrix = np.zeros((2 * len(links) + 2,) * 2)
    for low, coefficient in enumerate(links.ravel()):
        matrix[low : low + 3 : 2, low : low + 3 : 2] += coefficient * np.array([[1.0, -1.0], [-1.0, 1.0]])
    return matrix


def _peaks(scene: Scene, phase: Array, errata: Collection[str]) -> Array:
    from scipy.integrate import solve_ivp  # loaded where it is needed: a repeated report is written in seconds

    fixed = _fixed(scene, errata)
    bodies = len(scene.bodies)
    count = 2 * bodies

    ground_at = acceleration_of_ground(scene, phase)

    def slope(t: float, state: Array) -> Array:
        ground = ground_at(np.array([t]))[0]
        return np.concatenate([state[count:], _accelerations(fixed, state[:count], state[count:], ground)])

    def rim(t: float, state: Array) -> float:
        return float(0.999 - np.hypot(*state[:2]) / scene.radius)

    rim.terminal = True  # type: ignore[attr-defined]  # the way solve_ivp is told
    motion = solve_ivp(slope, (0.0, scene.duration), np.zeros(2 * count), "LSODA", None, True, rim, rtol=RELATIVE,
                       atol=ABSOLUTE, max_step=scene.duration / 200.0)  # fmt: skip
    if motion.status != 0:
        return np.full(bodies, np.nan)

    def sizes(times: Array) -> Array:
        """Of the absolute accelerations, (T, N), at times (T,)."""
        total = np.empty((len(times), bodies, 3))
        for row, (u, state) in enumerate(zip(ground_at(times), motion.sol(times).T)):
            q, v = state[:count], state[count:]
            a = _accelerations(fixed, q, v, u)
            delta = -math.sqrt(scene.radius**2 - q[0] ** 2 - q[1] ** 2)
            az = -(a[0] * q[0] + a[1] * q[1]) / delta - _w(q[0], q[1], v[0], v[1], delta)  # (3.4)
            total[row, :, :2] = a.reshape(-1, 2) + u[:2]
            total[row, :, 2] = az + u[2]
        size: Array = np.linalg.norm(total, axis=2)
        return size

    at_steps = sizes(motion.t)
    large = (at_steps >= LARGE * at_steps.max(axis=0)).any(axis=1)
    beside = np.flatnonzero(large[:-1] | large[1:])  # steps in which a peak may lie
    places = beside[:, None] + np.arange(1, PARTS) / PARTS
    between = sizes(np.interp(places.ravel(), np.arange(len(motion.t)), motion.t))
    peaks: Array = np.concatenate([at_steps, between]).max(axis=0)
    return peaks


def _w(x: float, y: float, vx: float, vy: float, delta: float) -> float:
    """W of (3.5)."""
    return (vx**2 + vy**2) / delta + (x * vx + y * vy) ** 2 / delta**3


def _accelerations(fixed: _Fixed, q: Array, v: Array, ground: Array) -> Array:
    """q'' = M^-1 (E - H q' - C q), (3.9)."""
    rho, total, m = fixed.rho, fixed.total, float(fixed.masses[0])
    (x, y), (vx, vy) = q[:2].tolist(), v[:2].tolist()  # plain numbers: arrays of two cost more than they save
    xi, eta, zeta = ground.tolist()
    delta = -math.sqrt(rho**2 - x**2 - y**2)
    p, r = x / delta, y / delta  # P and Q of (3.4)
    speed = math.sqrt(vx**2 + vy**2 + (vx * p + vy * r) ** 2)  # (3.8)
    w = _w(x, y, vx, vy, delta)
    friction = float(fixed.scene.dry_friction.at(speed)) if fixed.varies else fixed.friction
    over_speed = friction if fixed.lubricated else friction / max(speed, V_REG)
    s = over_speed * rho  # mu rho / v, (3.14) included

    own = m * (delta - s * (vx * p + vy * r))  # the first two rows of M, which is diagonal but for them
    m_xx, m_xy = own + total * p * (x + s * vx), total * r * (x + s * vx)
    m_yx, m_yy = total * p * (y + s * vy), own + total * r * (y + s * vy)

    main, cross, last = -total * (GRAVITY + zeta - w) * s, s, eta
    if WRONG_DAMPING in fixed.errata:
        cross, last = over_speed, xi
    damped = (
        (main - m * xi * p * s) * vx - m * xi * r * cross * vy,
        -m * eta * p * cross * vx + (main - m * last * r * s) * vy,
    )  # H q': zero but for its first two rows

    sprung = fixed.links @ q + fixed.dampers @ v  # C q
    load: Array = -fixed.masses
    load[0::2] *= xi
    load[1::2] *= eta
    for axis, (place, rate, ground_axis) in enumerate(((x, vx, xi), (y, vy, eta))):
        sprung[axis] = delta * sprung[axis] - total * (zeta + GRAVITY - w) * place
        load[axis] = -m * ground_axis * delta - damped[axis]
        if len(q) > 2:
            link, damper = fixed.links[axis + 2, axis], fixed.dampers[axis + 2, axis]  # minus those of the lowest link
            load[axis] += s * (vx * p + vy * r) * (link * (q[axis + 2] - place) + damper * (v[axis + 2] - rate))
    load -= sprung
    acceleration: Array = load / fixed.masses
    along_x, along_y = load[:2].tolist()
    determinant = m_xx * m_yy - m_xy * m_yx
    acceleration[0] = (m_yy * along_x - m_xy * along_y) / determinant
    acceleration[1] = (m_xx * along_y - m_yx * along_x) / determinant
    return acceleration
