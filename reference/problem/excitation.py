"""
Two-frequency damped ground motion (5.2)-(5.4), in closed form.

Row k of the plate's acceleration is u_k(t) = sum_i a_ki exp(-lambda_i t) cos(nu_i t + alpha_i), the real part of
sum_i a_ki exp(s_i t + i alpha_i) with s_i = -lambda_i + i nu_i; velocity and displacement integrate it from a plate
at rest at t = 0.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reference.problem.scene import Scene

Array = NDArray[np.float64]


def exponents(scene: Scene) -> NDArray[np.complex128]:
    """Complex exponents s_i = -lambda_i + i nu_i of the harmonics, (2,), 1/s."""
    return np.array(
        [
            complex(-decay, 2.0 * np.pi / period)
            for decay, period in zip(scene.excitation.decay, scene.excitation.periods)
        ]
    )


def ground_acceleration(scene: Scene, phase: ArrayLike, time: ArrayLike) -> Array:
    """Plate acceleration (xi'', eta'', zeta'') (5.3) at `time` (T,), s, for one phase pair (2,), rad: (T, 3), m/s^2."""
    return _superpose(scene, phase, np.exp(np.multiply.outer(np.asarray(time, float), exponents(scene))))


def ground_velocity(scene: Scene, phase: ArrayLike, time: ArrayLike) -> Array:
    """Plate velocity, (T, 3), m/s, zero at t = 0: the first integral of `ground_acceleration`."""
    s = exponents(scene)
    return _superpose(scene, phase, np.expm1(np.multiply.outer(np.asarray(time, float), s)) / s)


def ground_displacement(scene: Scene, phase: ArrayLike, time: ArrayLike) -> Array:
    """Plate displacement, (T, 3), m, zero with zero velocity at t = 0: the second integral."""
    t = np.asarray(time, float)
    s = exponents(scene)
    st = np.multiply.outer(t, s)
    # (exp(st) - 1 - st) / s^2; the series where the subtraction would cancel
    series = st**2 * (0.5 + st / 6.0 * (1.0 + st / 4.0 * (1.0 + st / 5.0 * (1.0 + st / 6.0 * (1.0 + st / 7.0)))))
    return _superpose(scene, phase, np.where(np.abs(st) < 1e-2, series, np.expm1(st) - st) / s**2)


def _superpose(scene: Scene, phase: ArrayLike, harmonics: NDArray[np.complex128]) -> Array:
    """Real part of sum_i a_ki exp(i alpha_i) harmonics_i, rows x, y, z."""
    turned = harmonics * np.exp(1j * np.asarray(phase, float))
    result: Array = np.real(turned @ scene.amplitudes.T)
    return result
