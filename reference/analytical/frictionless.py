"""
Frictionless small vibration (4.3)-(4.4) from rest, under the damped cosines (5.3), in closed form.

Per axis and natural mode, eta'' + omega^2 eta = -Gamma Re(sum_k a_k exp(i alpha_k) exp(s_k t)), solved from rest by
    eta = -Gamma (D(s, i omega) - D(s, -i omega)) / (2 i omega),   D(s, z) = (exp(s t) - exp(z t)) / (s - z).
D has a limit at resonance, t exp(z t), and D' = z D + exp(s t). On a plane the first mode is a motion of all bodies as
one, omega = 0: nothing holds it, eta = -Gamma (exp(s t) - 1 - s t) / s^2. The modes' participation adds up to a unit
motion of every body, so the absolute acceleration is -sum_j X_j omega_j^2 eta_j, and the ground's need not be added.
The response is linear in exp(i alpha_k): a whole surface follows from one complex response per harmonic.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reference.analytical.phase_peaks import PhaseSeries, largest_lengths, may_reach_bound
from reference.natural_modes import Modes, modes
from reference.problem import Scene, exponents, loading_period

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

# Number of time intervals per shortest period of the loading and the natural modes. On an interval this short, a Taylor
# series of SERIES_TERMS terms is wrong by less than 1e-14 of the motion.
INTERVALS_PER_PERIOD = 12
SERIES_TERMS = 12  # terms of the Taylor series in time on each interval
# Largest |s t| at which (exp(s t) - 1 - s t) / s^2 is summed as a series of DRIFT_TERMS terms, to avoid cancellation
MAX_SERIES_ANGLE, DRIFT_TERMS = 1.0, 20
ROUNDING_ERROR = 1e-13  # relative rounding error of a natural frequency and of each operation


def frictionless_peaks(scene: Scene, phases: Array) -> tuple[Array, Array, Array, NDArray[np.bool_]]:
    """
    Return the peaks of the motions of N bodies at M pairs of loading phases, (M, 2), rad, as four arrays.

    They are the largest absolute accelerations (M, N), m/s^2; their errors (M, N), m/s^2; the largest displacement of
    the platform (M,), m; and a mask (M,), True where the platform may reach the end of its travel, or without one the
    rim (4.1): such a motion has left the range of the small equations. The scene is one that `is_linear` allows.
    """
    natural = modes(scene)
    fastest = max(float(natural.frequency.max()), float(-exponents(scene).real.min()))
    shortest = min(loading_period(scene), 2.0 * np.pi / fastest if fastest > 0.0 else np.inf)
    count = int(np.ceil(scene.duration / shortest * INTERVALS_PER_PERIOD))
    half = 0.5 * scene.duration / count
    centers: Array = half * (2.0 * np.arange(count, dtype=float) + 1.0)
    series = PhaseSeries.from_derivatives(
        _harmonic_responses(scene, natural, centers, SERIES_TERMS, absolute=True), half
    )
    path = PhaseSeries.from_derivatives(
        _harmonic_responses(scene, natural, centers, SERIES_TERMS, absolute=False, bodies=1), half
    )
    peaks, search_error = largest_lengths(series, phases)
    rounding = ROUNDING_ERROR * (10.0 + float(natural.frequency.max()) * scene.duration)
    reach = largest_lengths(path, phases)[0][:, 0]
    return (
        peaks,
        search_error + rounding * series.envelope,
        reach,
        may_reach_bound(path, phases, scene.displacement_limit),
    )


def _harmonic_responses(
    scene: Scene, natural: Modes, time: Array, orders: int, *, absolute: bool, bodies: int | None = None
) -> list[Complex]:
    """
    Return the response to each harmonic alone at the times (T,), s, and its time derivatives up to order `orders` - 1.

    Each array (T, N, axes, harmonics) has the complex amplitudes A_k of Re(A_k exp(i alpha_k)), with alpha_k the
    phase of the harmonic: of displacements relative to the ground, m, or if `absolute` of absolute accelerations.
    """
    # `rising` and `falling` are the quotients D(s, z) of the module's docstring, at z = i omega and z = -i omega; each
    # pass through the loop over the orders differentiates them once more. `swinging` holds the shapes of the modes with
    # omega > 0 and `weight` their factors; `drifting` is the motion of all bodies as one, where omega = 0.
    shape = natural.shape[:, :bodies]
    derivatives = [np.zeros((len(time), shape.shape[1], 2, 2), dtype=complex) for _ in range(orders)]
    for axis in range(2):
        swings = natural.frequency[axis] > 0.0
        omega, swinging = natural.frequency[axis, swings], shape[axis][:, swings]
        weight = natural.participation[axis, swings] / (2j * omega) * (omega**2 if absolute else -1.0)
        drifting = shape[axis][:, ~swings] @ natural.participation[axis, ~swings]
        for k, s in enumerate(exponents(scene)):
            if scene.amplitudes[axis, k] == 0.0:
                continue
            forced = np.exp(s * time)[:, None]
            rising, falling = (_difference_quotient(s, root, time) for root in (1j * omega, -1j * omega))
            for order, derivative in enumerate(derivatives):
                derivative[:, :, axis, k] = (weight * (rising - falling)) @ swinging.T * scene.amplitudes[axis, k]
                if not absolute and not swings.all():
                    derivative[:, :, axis, k] -= (
                        np.outer(_drift_derivative(s, time, order), drifting) * scene.amplitudes[axis, k]
                    )
                rising, falling = 1j * omega * rising + forced, -1j * omega * falling + forced
                forced = s * forced
    return derivatives


def _drift_derivative(s: complex, time: Array, order: int) -> Complex:
    """Return time derivative number `order`, (T,), of a free body's displacement under the acceleration exp(s t).

    From rest, this displacement is (exp(s t) - 1 - s t) / s^2.
    """
    angle = s * time
    if order > 1:
        return np.asarray(s ** (order - 2) * np.exp(angle))
    if order == 1:
        return np.asarray(np.expm1(angle) / s)
    small = np.abs(angle) < MAX_SERIES_ANGLE
    series = np.zeros(len(time), dtype=complex)
    for power in range(DRIFT_TERMS, 1, -1):
        series = (series * angle + 1.0) / power
    # `series` is now (exp(z) - 1 - z) / z^2 = 1/2 + z/6 + ... at the angle z = s t, by Horner's rule.
    direct = (np.expm1(angle) - angle) / s**2
    return np.where(small, series * time**2, direct)


def _difference_quotient(s: complex, roots: Complex, time: Array) -> Complex:
    """Return (exp(s t) - exp(z t)) / (s - z), (T, modes), for times t and the eigenvalues z of the modes, `roots`."""
    gap = s - roots
    same = gap == 0.0
    growth = np.expm1(np.multiply.outer(time, gap)) / np.where(same, 1.0, gap)
    result: Complex = np.exp(np.multiply.outer(time, roots)) * np.where(same, time[:, None], growth)
    return result
