"""
Equations (4.3)-(4.4) integrated a second time, by other methods and other code than the reference's.

`stepped`: the set-valued law by Moreau's time stepping (the impulse of friction is implicit in every step), or the
literal (4.6) by explicit midpoint steps. `by_scipy`: laws without a corner at v = 0 by SciPy's DOP853, all phase pairs
as one system. Plain Python; `fast` compiles the loops.
"""

import math
from collections.abc import Callable
from functools import cache
from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.integrate import DOP853

from reference.problem import GRAVITY, Scene

Array = NDArray[np.float64]

SET_VALUED, LITERAL = 0, 1


def system(scene: Scene) -> tuple[Any, ...]:
    """Amplitudes (2, 2), decay and frequency (2,), stiffness over mass seen from each body, R_N, mu or f_c, 1 / rho."""
    load = scene.excitation
    n = len(scene.bodies)
    below, above = np.zeros((n, 2)), np.zeros((n, 2))
    for i, k in enumerate(scene.stiffness):
        below[i + 1], above[i] = k / scene.masses[i + 1], k / scene.masses[i]
    decay, frequency = np.array(load.decay), 2.0 * np.pi / np.array(load.periods)
    support = GRAVITY * scene.total_mass / scene.masses[0]
    return (
        scene.amplitudes[:2].copy(),
        decay,
        frequency,
        below,
        above,
        support,
        scene.friction_coefficient,
        1 / scene.radius,
    )


def ground(t: float, phase: Array, amplitudes: Array, decay: Array, frequency: Array) -> tuple[float, float]:
    first = math.exp(-decay[0] * t) * math.cos(frequency[0] * t + phase[0])
    second = math.exp(-decay[1] * t) * math.cos(frequency[1] * t + phase[1])
    return (
        amplitudes[0, 0] * first + amplitudes[0, 1] * second,
        amplitudes[1, 0] * first + amplitudes[1, 1] * second,
    )


def forces(x: Array, ux: float, uy: float, below: Array, above: Array, a: Array) -> None:
    """Accelerations by springs and ground alone."""
    n = len(x)
    for i in range(n):
        a[i, 0], a[i, 1] = -ux, -uy
        for axis in range(2):
            if i > 0:
                a[i, axis] += below[i, axis] * (x[i - 1, axis] - x[i, axis])
            if i + 1 < n:
                a[i, axis] += above[i, axis] * (x[i + 1, axis] - x[i, axis])


def run(
    phase: Array, system: Any, h: float, steps: int, law: int, cutoff: float, facts: Array, ground: Any, forces: Any
) -> Array:
    """
    Largest |absolute acceleration|^2 of each body; facts: max (x_1^2 + y_1^2), then for each body max |x - y|, max |x|.
    """
    amplitudes, decay, frequency, below, above, support, mu, curvature = system
    n = len(below)
    x, v, a, middle, half = np.zeros((n, 2)), np.zeros((n, 2)), np.zeros((n, 2)), np.zeros((n, 2)), np.zeros((n, 2))
    top = np.zeros(n)
    for number in range(steps):
        t = number * h
        ux, uy = ground(t, phase, amplitudes, decay, frequency)
        forces(x, ux, uy, below, above, a)
        p, q = curvature * x[0, 0], curvature * x[0, 1]
        fx, fy = a[0, 0] - support * p, a[0, 1] - support * q  # F_3 as it should be
        vx, vy = v[0, 0], v[0, 1]
        speed = math.sqrt(vx * vx + vy * vy)
        counts, wx, wy, starts = True, 0.0, 0.0, False
        if speed > 0.0:
            wx, wy = vx / speed, vy / speed
            counts = law == LITERAL or speed > cutoff
        elif law == LITERAL:
            ex = -(ux - support * p + (a[0, 0] + ux))  # minus k (x1 - x2) / m1 is a + u
            ey = -(uy - support * q + (a[0, 1] + uy))
            pull = math.sqrt(ex * ex + ey * ey)
            limit = mu * math.sqrt((support - (p + q) * ux) ** 2 + (support - (p + q) * uy) ** 2)
            starts = limit < pull
            if starts:
                wx, wy = ex / pull, ey / pull
        elif math.sqrt(fx * fx + fy * fy) > mu * support:  # slip begins: neither rest nor faster than the cutoff
            counts, starts = False, True
        sticks = speed == 0.0 and not starts
        ax = 0.0 if sticks else fx - mu * (support * wx - ux * (p * wx + q * wy))
        ay = 0.0 if sticks else fy - mu * (support * wy - uy * (p * wx + q * wy))
        if counts:
            top[0] = max(top[0], (ax + ux) ** 2 + (ay + uy) ** 2)
        for i in range(1, n):
            top[i] = max(top[i], (a[i, 0] + ux) ** 2 + (a[i, 1] + uy) ** 2)
        facts[0] = max(facts[0], x[0, 0] ** 2 + x[0, 1] ** 2)
        for i in range(n):
            facts[1 + i] = max(facts[1 + i], abs(x[i, 0] - x[i, 1]))
            facts[1 + n + i] = max(facts[1 + n + i], abs(x[i, 0]), abs(x[i, 1]))
        a[0, 0], a[0, 1] = ax, ay
        for i in range(n):  # explicit to the middle of the step
            for axis in range(2):
                middle[i, axis] = x[i, axis] + 0.5 * h * v[i, axis]
                half[i, axis] = v[i, axis] + 0.5 * h * a[i, axis]
        ux, uy = ground(t + 0.5 * h, phase, amplitudes, decay, frequency)
        forces(middle, ux, uy, below, above, a)
        p, q = curvature * middle[0, 0], curvature * middle[0, 1]
        fx, fy = a[0, 0] - support * p, a[0, 1] - support * q
        if law == LITERAL:
            if not starts and not sticks:
                size = math.sqrt(half[0, 0] ** 2 + half[0, 1] ** 2)
                wx, wy = half[0, 0] / size, half[0, 1] / size
            if sticks:
                newx = newy = 0.0
            else:
                newx = vx + h * (fx - mu * (support * wx - ux * (p * wx + q * wy)))
                newy = vy + h * (fy - mu * (support * wy - uy * (p * wx + q * wy)))
            if speed > 0.0 and newx * vx + newy * vy <= 0.0:
                newx = newy = 0.0
        else:  # friction takes what of the impulse b it can
            bx, by = vx + h * fx, vy + h * fy
            newx = newy = 0.0
            cx, cy = bx, by
            limit = h * mu * support
            for _ in range(8):
                size = math.sqrt(cx * cx + cy * cy)
                if size == 0.0:
                    break
                share = min(1.0, size / limit) if limit > 0.0 else 1.0
                wx, wy = share * cx / size, share * cy / size
                cx = bx + h * mu * ux * (p * wx + q * wy)
                cy = by + h * mu * uy * (p * wx + q * wy)
            size = math.sqrt(cx * cx + cy * cy)
            if size > limit:
                newx, newy = cx * (1.0 - limit / size), cy * (1.0 - limit / size)
        for i in range(n):
            for axis in range(2):
                before = v[i, axis]
                if i > 0:
                    v[i, axis] = before + h * a[i, axis]
                elif axis == 0:
                    v[i, axis] = newx
                else:
                    v[i, axis] = newy
                x[i, axis] += 0.5 * h * (before + v[i, axis])
    return top


@cache
def fast() -> Callable[..., Any]:
    """`run` compiled, with what it calls."""
    compiled, parts = numba.njit(run), (numba.njit(ground), numba.njit(forces))
    return lambda *arguments: compiled(*arguments, *parts)


def slow(*arguments: Any) -> Array:
    """`run` as plain Python."""
    return run(*arguments, ground, forces)


def stepped(
    scene: Scene, phases: Array, law: int, step: float, cutoff: float = 1e-3, runner: Callable[..., Any] | None = None
) -> tuple[Array, Array]:
    """mu (M, N) and facts (M, 1 + 2 N) of motions from rest by fixed steps, s; cutoff: v_c, m/s."""
    steps, parts = round(scene.duration / step), system(scene)
    n = len(scene.bodies)
    facts = np.zeros((len(phases), 1 + 2 * n))
    tops = [
        (runner or slow)(phase, parts, step, steps, law, cutoff, fact) for phase, fact in zip(np.asarray(phases), facts)
    ]
    return np.sqrt(np.array(tops)) / ground_tops(scene, phases)[:, None], facts


def ground_tops(scene: Scene, phases: Array, samples: int = 1000) -> Array:
    """Denominator of (5.1), (M,), from `samples` a second and the vertex of a parabola through the three highest."""
    load = scene.excitation
    t = np.arange(round(scene.duration * samples) + 1) / samples
    tops = []
    for phase in np.asarray(phases):
        waves = [np.exp(-load.decay[i] * t) * np.cos(2.0 * np.pi / load.periods[i] * t + phase[i]) for i in (0, 1)]
        square = ((scene.amplitudes[:2, :1] * waves[0] + scene.amplitudes[:2, 1:] * waves[1]) ** 2).sum(axis=0)
        k = int(square.argmax())
        top = square[k]
        if 0 < k < len(t) - 1:
            before, after = square[k - 1], square[k + 1]
            top -= (after - before) ** 2 / (8.0 * (before - 2.0 * top + after))
        tops.append(math.sqrt(top))
    return np.array(tops)


def by_scipy(
    scene: Scene,
    phases: Array,
    corner: float | None,
    tolerance: float = 1e-6,
    most: float = 0.04,
    spacing: float = 2e-3,
) -> tuple[Array, Array]:
    """
    mu (M, N) and facts (M, 1 + 2 N) by DOP853. corner: v_reg, m/s; None for lubricated and frictionless contacts. most:
    s, of a step; spacing: s, of the instants that are looked at.
    """
    amplitudes, decay, frequency, below, above, support, mu, curvature = system(scene)
    phases = np.asarray(phases)
    runs, n = len(phases), len(below)

    def loading(t: Array) -> Array:
        waves = np.exp(-decay * t[:, None, None]) * np.cos(frequency * t[:, None, None] + phases)
        return waves @ amplitudes.T

    def accelerations(u: Array, x: Array, v: Array) -> Array:
        a = np.repeat(-u[:, :, None], n, axis=2)
        stretch = x[:, :, 1:] - x[:, :, :-1]
        a[:, :, 1:] -= below[1:] * stretch
        a[:, :, :-1] += above[:-1] * stretch
        if corner is None:
            w = v[:, :, 0] if scene.lubricated else np.zeros_like(u)
        else:
            w = v[:, :, 0] / np.maximum(np.hypot(v[:, :, 0, 0], v[:, :, 0, 1]), corner)[..., None]
        along = curvature * (x[:, :, 0] * w).sum(axis=-1, keepdims=True)
        a[:, :, 0] -= support * curvature * x[:, :, 0] + mu * (support * w - u * along)
        return a

    def slope(t: float, y: Array) -> Array:
        x, v = y.reshape(2, 1, runs, n, 2)
        return np.concatenate([v.ravel(), accelerations(loading(np.array([t])), x, v).ravel()])

    solver = DOP853(slope, 0.0, np.zeros(4 * runs * n), scene.duration, most, tolerance, 1e-3 * tolerance)
    top, facts = np.zeros((runs, n)), np.zeros((runs, 1 + 2 * n))
    while solver.status == "running":
        solver.step()
        parts = max(4, math.ceil((solver.t - solver.t_old) / spacing))
        times = np.linspace(solver.t_old, solver.t, parts, endpoint=False)
        x, v = np.moveaxis(solver.dense_output()(times).reshape(2, runs, n, 2, parts), -1, 1)
        u = loading(times)
        top = np.maximum(top, ((accelerations(u, x, v) + u[:, :, None]) ** 2).sum(axis=-1).max(axis=0))
        facts[:, 0] = np.maximum(facts[:, 0], (x[:, :, 0] ** 2).sum(axis=-1).max(axis=0))
        facts[:, 1 : 1 + n] = np.maximum(facts[:, 1 : 1 + n], np.abs(x[..., 0] - x[..., 1]).max(axis=0))
        facts[:, 1 + n :] = np.maximum(facts[:, 1 + n :], np.abs(x).max(axis=(0, 3)))
    assert solver.status == "finished", "DOP853 reached the end"
    return np.sqrt(top) / ground_tops(scene, phases)[:, None], facts
