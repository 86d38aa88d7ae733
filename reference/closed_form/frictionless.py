"""
Frictionless small vibration (4.3)-(4.4), mu = 0, from rest, under the damped cosines (5.3): the whole chain, exact.

Per axis and natural mode, eta'' + omega^2 eta = -Gamma Re(sum_k a_k exp(i alpha_k) exp(s_k t)): a particular part
-Gamma exp(s t)/(s^2 + omega^2) and the free vibration that starts it from rest. The response is linear in
exp(i alpha_k), so a whole surface over the phases follows from one complex response per harmonic.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reference.natural_modes import modes
from reference.problem import Scene, checked_phases, exponents, ground_peak

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

SAMPLES = 48  # per shortest period
NEAR = 0.97  # of the highest sample: |a|^2 sampled so falls short of its maximum by less than 1 %
ZOOM = np.linspace(-1.0, 1.0, 33)


def frictionless_motion(scene: Scene, phase: ArrayLike, time: ArrayLike) -> tuple[Array, Array, Array]:
    """
    Position, velocity and horizontal absolute acceleration at `time` (T,), s, for one phase pair (2,), rad.

    (T, N, 2) each, m, m/s, m/s^2; displacement and velocity relative to the plate. Raises ValueError for a scene with
    friction or with vertical loading, under which the pendulum's stiffness varies in time.
    """
    _check(scene)
    turn = np.exp(1j * np.asarray(phase, dtype=float))
    time = np.asarray(time, dtype=float)
    position, velocity, acceleration = ((_response(scene, time, order) @ turn).real for order in range(3))
    return position, velocity, acceleration + (_ground(scene, time) @ turn).real[:, None, :]


def frictionless_amplification(scene: Scene, phases: ArrayLike) -> Array:
    """mu_i of (5.1) for phase pairs (M, 2), rad: (M, N), to about 1e-12. Raises as `frictionless_motion`."""
    _check(scene)
    pairs = checked_phases(phases)
    shortest = min(*scene.excitation.periods, 2.0 * np.pi / float(modes(scene).frequency.max()))
    count = int(np.ceil(scene.duration / shortest * SAMPLES)) + 1
    time = np.linspace(0.0, scene.duration, count)
    sampled = _absolute(scene, time)
    peaks = np.empty((len(pairs), len(scene.masses)))
    for m, turn in enumerate(np.exp(1j * pairs)):
        squares = ((sampled @ turn).real ** 2).sum(axis=-1)
        for body in range(squares.shape[1]):
            column = squares[:, body]
            around = np.pad(column, 1)
            tops = (column >= around[:-2]) & (column >= around[2:]) & (column >= NEAR * column.max())
            centres, half = time[tops], time[1]
            for _ in range(5):  # each zooms in 16 times, past where |a|^2 is flat to rounding
                local = np.clip(centres[:, None] + half * ZOOM, 0.0, scene.duration)
                values = ((_absolute(scene, local.ravel())[:, body] @ turn).real ** 2).sum(axis=-1).reshape(local.shape)
                centres, half = local[np.arange(len(local)), values.argmax(axis=1)], half / 16.0
            peaks[m, body] = np.sqrt(values.max())
    result: Array = peaks / ground_peak(scene, pairs)[:, None]
    return result


def _check(scene: Scene) -> None:
    if scene.friction_coefficient > 0.0:
        raise ValueError("the scene has friction: no closed form")
    if scene.amplitudes[2].any():
        raise ValueError("vertical loading makes the pendulum's stiffness vary: no closed form")


def _ground(scene: Scene, time: Array) -> Complex:
    """Complex ground acceleration per harmonic, (T, 2 axes, 2 harmonics), m/s^2."""
    harmonics: Complex = np.exp(np.multiply.outer(time, exponents(scene)))
    result: Complex = harmonics[:, None, :] * scene.amplitudes[:2].astype(complex)
    return result


def _absolute(scene: Scene, time: Array) -> Complex:
    result: Complex = _response(scene, time, 2) + _ground(scene, time)[:, None]
    return result


def _response(scene: Scene, time: Array, order: int) -> Complex:
    """Derivative `order` of the complex displacement per harmonic, (T, N, 2 axes, 2 harmonics)."""
    natural = modes(scene)
    result = np.empty((len(time), len(scene.masses), 2, 2), dtype=complex)
    for axis in range(2):
        omega = 1j * natural.frequency[axis]
        for k, s in enumerate(exponents(scene)):
            particular = -natural.participation[axis] / (s * s - omega * omega)
            rising, falling = -0.5 * particular * (1.0 + s / omega), -0.5 * particular * (1.0 - s / omega)
            modal = particular * (s**order * np.exp(s * time))[:, None]
            modal = modal + rising * omega**order * np.exp(np.multiply.outer(time, omega))
            modal = modal + falling * (-omega) ** order * np.exp(np.multiply.outer(time, -omega))
            result[:, :, axis, k] = modal @ natural.shape[axis].T * scene.amplitudes[axis, k]
    return result
