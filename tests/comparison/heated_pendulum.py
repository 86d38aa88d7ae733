"""
MASTODON's friction pendulum as a planar oscillator, with the published law of friction and heating.

mu = 0.06 k_v k_p k_T: k_v = 1 - 0.5 exp(-100 v), k_p = 0.7^(0.02 (p - 50)), p in MPa, k_T = 0.789 (0.7^(0.02 T) + 0.4),
T in degrees C. The temperature at the center of a half space with the heat flux q while the contact covers it is
T = 20 + sqrt(D / pi) / k * integral of q(t - s) / sqrt(s), as MASTODON sums it. Below `elastic` the bearing is
elastic with a constant stiffness. Heated, it has MASTODON's restoring force N y / sqrt(R^2 - y^2), otherwise N y / R.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

MASS, RADIUS, CONTACT = 640745.0, 2.2352, 0.2  # kg, m, m
DIFFUSIVITY, CONDUCTIVITY = 4.4e-6, 18.0  # m^2/s, W/(m K)
GRAVITY = 9.81  # m/s^2


@njit
def ranges(
    ground: NDArray[np.float64], step: float, parts: int, elastic: float, heated: bool
) -> tuple[NDArray[np.float64], float]:
    """
    Smallest and largest displacement, mm, x then y, and the highest temperature.

    ground: (T, 3) every `step` s. parts: of a step. elastic: displacement up to which the bearing is elastic, m.
    """
    place, speed, plastic = np.zeros(2), np.zeros(2), np.zeros(2)
    found, flux = np.zeros(4), np.zeros(len(ground))
    area, part = np.pi * CONTACT**2, step / parts
    temperature, highest = 20.0, 20.0
    for i in range(len(ground) - 1):
        heat = 0.0
        for k in range(parts):
            a = ground[i] + (ground[i + 1] - ground[i]) * (k / parts)
            normal = MASS * (GRAVITY + a[2])
            v = np.sqrt(speed[0] ** 2 + speed[1] ** 2)
            mu, arm = 0.06 * (1.0 - 0.5 * np.exp(-100.0 * v)), np.full(2, RADIUS)
            if heated:
                mu *= 0.7 ** (0.02 * (normal / area / 1e6 - 50.0)) * 0.789 * (0.7 ** (0.02 * temperature) + 0.4)
                arm = np.sqrt(RADIUS**2 - place**2)
            heat = mu * normal / area * v
            stiffness = 0.06 * 50e6 * area / elastic - normal / RADIUS
            force = stiffness * (place - plastic)
            size = np.sqrt(force[0] ** 2 + force[1] ** 2)
            if size > mu * normal:
                force *= mu * normal / size
                plastic = place - force / stiffness
            speed = speed - part * ((force + normal * place / arm) / MASS + a[:2])
            place = place + part * speed
            for axis in range(2):
                found[2 * axis] = min(found[2 * axis], 1e3 * place[axis])
                found[2 * axis + 1] = max(found[2 * axis + 1], 1e3 * place[axis])
        if heated:
            if np.sqrt(place[0] ** 2 + place[1] ** 2) <= 0.5 * np.sqrt(np.pi) * CONTACT:
                flux[i] = heat
            total = 0.0
            for j in range(i + 1):
                total += flux[j] * step / np.sqrt((i + 1 - j) * step)
            temperature = 20.0 + np.sqrt(DIFFUSIVITY / np.pi) / CONDUCTIVITY * total
            highest = max(highest, temperature)
    return found, highest
