"""A motion under regularized friction that its own heat lowers, by constant steps: no code shared with the solver."""

import math
from typing import Any

import numpy as np
from oracle_law import Law
from scipy.signal import fftconvolve

from reference.problem import Scene

Array = np.ndarray


def weights(count: int) -> Array:
    """Of P at equal steps back from now, in the integral of P(t - s) / sqrt(s), P linear between; over sqrt(step)."""
    m = np.arange(count, dtype=float)
    return 4.0 / 3.0 * np.where(m == 0.0, 1.0, (m + 1.0) ** 1.5 - 2.0 * m**1.5 + np.abs(m - 1.0) ** 1.5)


def rise(table: Any, supports: int) -> float:
    """Temperature over that integral of the power of friction of all supports, K / (W s^0.5)."""
    area = supports * math.pi * table["contact_radius"] ** 2
    return math.sqrt(table["diffusivity"]) / (table["conductivity"] * math.sqrt(math.pi) * area)


def temperature_rise(table: Any, supports: int, power: Array, step: float) -> Array:
    """Above the first, at every one of equal steps (T,), K; from a power (T,), W, that is zero at the first."""
    return rise(table, supports) * math.sqrt(step) * fftconvolve(power, weights(len(power)))[: len(power)]


def heated_motion(
    scene: Scene, phase: tuple[float, float], equations: str, v_reg: float, step: float
) -> tuple[Array, Array, Array]:
    """
    Instants (T,), positions (T, 2N) and temperatures (T,), degrees C, with an error of second order in the step.

    Runge-Kutta of fourth order with a coefficient that is linear in a step, from a first pass with that of its start.
    """
    table = scene.isolator.friction.heating
    law = Law(scene, phase, equations)
    slow, fast = law.slow, law.fast
    count, bodies = round(scene.duration / step), law.count
    backward = rise(table.model_dump(), len(scene.support_places)) * math.sqrt(step) * weights(count + 1)[::-1]

    def slope(t: float, state: Array, k_t: float) -> tuple[Array, float]:
        q, v = state[: 2 * bodies].tolist(), state[2 * bodies :].tolist()
        law.slow = law.mu = k_t * slow
        law.fast = k_t * fast
        force, ground = law.link_forces(q, v), law.ground(t)
        speed = math.sqrt(law.speed_square(q[0], q[1], v[0], v[1]))
        ax, ay, _, normal = law.smooth(t, q, force, v[0], v[1], v_reg, speed < v_reg)
        above = [force[k] / law.mass[k // 2] - ground[k % 2] for k in range(2, 2 * bodies)]
        covers = math.hypot(q[0], q[1]) < 0.5 * math.sqrt(math.pi) * table.contact_radius
        friction = law.coefficient(speed) * law.share(normal) * normal * min(1.0, speed / v_reg)
        return np.array([*v, ax, ay, *above]), friction * speed if covers else 0.0

    def k_t_at(temperature: float) -> float:
        return 0.79 * (0.7 ** (0.02 * temperature) + 0.4)

    states, power = np.zeros((count + 1, 4 * bodies)), np.zeros(count + 1)
    heat = np.full(count + 1, table.initial_temperature)
    for n in range(count):
        t, start, begin = n * step, states[n], k_t_at(heat[n])
        end = begin
        for _ in range(2):
            middle = 0.5 * (begin + end)
            a, _ = slope(t, start, begin)
            b, _ = slope(t + 0.5 * step, start + 0.5 * step * a, middle)
            c, _ = slope(t + 0.5 * step, start + 0.5 * step * b, middle)
            d, _ = slope(t + step, start + step * c, end)
            states[n + 1] = start + step / 6.0 * (a + 2.0 * b + 2.0 * c + d)
            _, power[n + 1] = slope(t + step, states[n + 1], end)
            heat[n + 1] = table.initial_temperature + float(backward[count - n - 1 :] @ power[: n + 2])
            end = k_t_at(heat[n + 1])
    return step * np.arange(count + 1), states[:, : 2 * bodies], heat
