"""
Equations (4.3)-(4.4) integrated a second time, by other methods and other code than the reference's.

`stepped`: the set-valued law by Moreau's time stepping (the impulse of friction is implicit in every step). `by_scipy`:
laws without a corner at v = 0 by SciPy's DOP853, all phase pairs
as one system. Vectors x, y are complex numbers x + i y. The denominators are those of the reference.
"""

import math
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.integrate import DOP853

from reference.problem import GRAVITY, Scene, ground_peak

Array = NDArray[np.float64]
compiled = njit(cache=True)


def system(scene: Scene) -> tuple[Any, ...]:
    """Of the loading: amplitudes and rates (2,); of the chain: links (N-1, 2), masses; and R_N, mu or f_c, 1 / rho."""
    load = scene.excitation
    loading = [1.0, 1.0j] @ scene.amplitudes[:2], 2.0j * np.pi / np.array(load.periods) - np.array(load.decay)
    support = GRAVITY * scene.total_mass / scene.masses[0]
    return loading, (scene.stiffness, scene.masses), (support, scene.friction_coefficient, 1.0 / scene.radius)


@compiled
def ground(t, phase, amplitudes, rates):
    first, second = np.exp(rates[0] * t + 1j * phase[0]), np.exp(rates[1] * t + 1j * phase[1])
    return amplitudes[0] * first.real + amplitudes[1] * second.real


@compiled
def forces(x, u, links, masses):
    """Accelerations (N, ...) by springs and ground alone."""
    a = 0.0 * x - u
    for i in range(len(links)):
        apart = x[i + 1] - x[i]
        pull = links[i, 0] * apart.real + 1j * links[i, 1] * apart.imag
        a[i] += pull / masses[i]
        a[i + 1] -= pull / masses[i + 1]
    return a


@compiled
def friction(x, u, w, support, mu, curvature):
    """What friction against w takes of the platform's acceleration."""
    return mu * (support * w - u * curvature * (x * np.conj(w)).real)


@compiled
def facts_of(x):
    """|x_1|^2, then |x - y| of each body, then the larger of |x| and |y|."""
    return np.concatenate((np.abs(x[:1]) ** 2, np.abs(x.real - x.imag), np.maximum(np.abs(x.real), np.abs(x.imag))))


@compiled
def _run(phase, loading, chain, contact, h, steps, cutoff):
    """Largest |absolute acceleration|^2 of each body, and largest facts."""
    support, mu, curvature = contact
    x, top = np.zeros(len(chain[1]), np.complex128), np.zeros(len(chain[1]))
    v, facts = np.zeros_like(x), facts_of(x)
    for number in range(steps):
        u = ground(number * h, phase, loading[0], loading[1])
        a = forces(x, u, chain[0], chain[1])
        drive = a[0] - support * curvature * x[0]  # F_3 as it should be
        speed, w, counts, sticks = abs(v[0]), 0.0j, True, False
        if speed > 0.0:
            w, counts = v[0] / speed, speed > cutoff
        else:  # where slip begins there is neither rest nor a speed beyond the cutoff
            sticks = abs(drive) <= mu * support
            counts = sticks
        a[0] = 0.0j if sticks else drive - friction(x[0], u, w, support, mu, curvature)
        for i in range(len(x)):
            if i > 0 or counts:
                top[i] = max(top[i], abs(a[i] + u) ** 2)
        facts = np.maximum(facts, facts_of(x))
        middle = x + 0.5 * h * v  # explicit to the middle of the step
        u = ground((number + 0.5) * h, phase, loading[0], loading[1])
        a = forces(middle, u, chain[0], chain[1])
        new = v[0] + h * (a[0] - support * curvature * middle[0])
        limit, impulse = h * mu * support, new  # friction takes what of the impulse it can
        for _ in range(8):
            if abs(impulse) == 0.0:
                break
            w = impulse / max(abs(impulse), limit)
            impulse = new + h * mu * u * curvature * (middle[0] * np.conj(w)).real
        new = impulse * (1.0 - limit / abs(impulse)) if abs(impulse) > limit else 0.0j
        change = h * a
        change[0] = new - v[0]
        x += h * (v + 0.5 * change)
        v += change
    return top, facts


def stepped(scene: Scene, phases: Array, step: float, cutoff: float) -> tuple[Array, Array]:
    """mu (M, N) and facts (M, 1 + 2 N) of motions from rest by fixed steps, s; cutoff: v_c, m/s."""
    steps, parts = round(scene.duration / step), system(scene)
    runs = [_run(phase, *parts, step, steps, cutoff) for phase in np.asarray(phases)]
    tops, facts = (np.array(part) for part in zip(*runs))
    return np.sqrt(tops) / ground_peak(scene, phases)[:, None], facts


def by_scipy(scene: Scene, phases: Array, corner: float | None) -> tuple[Array, Array]:
    """mu (M, N) and facts (M, 1 + 2 N). corner: v_reg, m/s; None for lubricated and frictionless contacts."""
    loading, chain, contact = system(scene)
    given, shape = np.asarray(phases).T, (len(chain[1]), len(phases))

    def accelerations(u: Any, x: Any, v: Any) -> Any:
        a = forces.py_func(x, u, *chain)
        w = v[0] if corner is None else v[0] / np.maximum(np.abs(v[0]), corner)
        a[0] -= contact[0] * contact[2] * x[0] + friction.py_func(x[0], u, w, *contact)
        return a

    def slope(t: float, y: Any) -> Any:
        x, v = y.reshape(2, *shape)
        return np.concatenate([v, accelerations(ground.py_func(t, given, *loading), x, v)]).ravel()

    solver = DOP853(slope, 0.0, np.zeros(2 * shape[0] * shape[1], complex), scene.duration, 0.04, 1e-6, 1e-9)
    top, facts = np.zeros(shape), np.zeros((1 + 2 * shape[0], shape[1]))
    while solver.status == "running":
        solver.step()
        times = np.linspace(solver.t_old, solver.t, max(4, math.ceil((solver.t - solver.t_old) / 2e-3)), endpoint=False)
        x, v = solver.dense_output()(times).reshape(2, *shape, len(times))
        u = ground.py_func(times, given[:, :, None], *loading)
        top = np.maximum(top, (np.abs(accelerations(u, x, v) + u) ** 2).max(axis=-1))
        facts = np.maximum(facts, facts_of.py_func(x).max(axis=-1))
    assert solver.status == "finished", "DOP853 reached the end"
    return np.sqrt(top.T) / ground_peak(scene, phases)[:, None], facts.T
