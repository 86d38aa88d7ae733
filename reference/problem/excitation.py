"""
Ground motion: two damped frequencies (5.2)-(5.4), in closed form, or a record, linear between its samples.

Row k of the plate's acceleration is u_k(t) = sum_i a_ki exp(-lambda_i t) cos(nu_i t + alpha_i), the real part of
sum_i a_ki exp(s_i t + i alpha_i) with s_i = -lambda_i + i nu_i; velocity and displacement integrate it from a plate
at rest at t = 0.

A recorded acceleration is linear from sample to sample in each direction and zero after its last knot
(`Scene.record`); velocity and displacement are its exact integrals. It has no phases: those given are not looked at.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reference.problem.phases import check_phase
from reference.problem.scene import Scene, require_scene
from reference.problem.tables import Excitation
from reference.support.arguments import check_array

Array = NDArray[np.float64]


@require_scene
def exponents(scene: Scene) -> NDArray[np.complex128]:
    """
    Return the complex exponents s_i = -lambda_i + i nu_i of the two harmonics: decay rate and angular frequency.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    ndarray of complex, (2,), 1/s

    Raises
    ------
    ValueError
        For a recorded motion, which has no harmonics.

    Examples
    --------
    >>> from reference.problem import load_scene
    >>> exponents(load_scene("fig3-I")).imag.round(3).tolist()  # rad/s
    [6.981, 5.712]
    """
    load = scene.excitation
    if not isinstance(load, Excitation):
        raise ValueError(f"{scene.name}: a recorded motion has no harmonics")
    return np.array([complex(-decay, 2.0 * np.pi / period) for decay, period in zip(load.decay, load.periods)])


@require_scene
def loading_period(scene: Scene) -> float:
    """
    Return the shortest period of the ground acceleration, s.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    float, s
        The shorter of the two periods. Of a record, 2 pi times its largest acceleration over its largest rate; the
        duration if a record is zero throughout.

    Examples
    --------
    >>> from reference.problem import load_scene
    >>> loading_period(load_scene("fig3-I"))
    0.9
    """
    if isinstance(scene.excitation, Excitation):
        return min(scene.excitation.periods)
    time, samples = scene.record[:, 0], scene.record[:, 1:]
    with np.errstate(over="ignore"):
        rate = np.abs(np.diff(samples, axis=0) / np.diff(time)[:, None]).max()
    largest = np.abs(samples).max()
    return float(2.0 * np.pi * largest / rate) if rate > 0.0 and np.isfinite(rate) else scene.duration


@require_scene
def ground_acceleration(scene: Scene, phase: ArrayLike, time: ArrayLike) -> Array:
    """
    Return the ground acceleration along x, y and z: (xi'', eta'', zeta'') of (5.3), or that of the record.

    Parameters
    ----------
    scene : Scene
    phase : array_like, (2,), rad
        A recorded motion has no phases: they change nothing.
    time : array_like, (T,), s

    Returns
    -------
    ndarray, (T, 3), m/s^2

    Examples
    --------
    >>> from reference.problem import load_scene
    >>> ground_acceleration(load_scene("fig3-I"), (0.0, 0.0), [0.0])[0].tolist()
    [1.0, 1.0, 0.0]
    """
    return acceleration_of_ground(scene, phase)(_check_instants(time))


def acceleration_of_ground(scene: Scene, phase: ArrayLike) -> Callable[[Array], Array]:
    """Return ground acceleration for one pair of initial phases as a function of time (T,), s, for repeated calls."""
    if scene.recorded:
        return lambda time: _integrate_record(scene.record, time, 0)
    powers, amplitudes = exponents(scene), _phase_factors(phase)[:, None] * scene.amplitudes.T
    return lambda time: (np.exp(time[..., None] * powers) @ amplitudes).real


@require_scene
def ground_velocity(scene: Scene, phase: ArrayLike, time: ArrayLike) -> Array:
    """
    Return the velocity of the ground, the first integral of `ground_acceleration` from rest at t = 0.

    Parameters
    ----------
    scene : Scene
    phase : array_like, (2,), rad
        A recorded motion has no phases: they change nothing.
    time : array_like, (T,), s

    Returns
    -------
    ndarray, (T, 3), m/s

    Examples
    --------
    >>> from reference.problem import load_scene
    >>> ground_velocity(load_scene("fig3-I"), (0.0, 0.0), [0.0])[0].tolist()
    [0.0, 0.0, 0.0]
    """
    if scene.recorded:
        return _integrate_record(scene.record, _check_instants(time), 1)
    s = exponents(scene)
    return _superpose(scene, phase, np.expm1(np.multiply.outer(_check_instants(time), s)) / s)


@require_scene
def ground_displacement(scene: Scene, phase: ArrayLike, time: ArrayLike) -> Array:
    """
    Return the displacement of the ground, the second integral of `ground_acceleration` from rest at t = 0.

    Parameters
    ----------
    scene : Scene
    phase : array_like, (2,), rad
        A recorded motion has no phases: they change nothing.
    time : array_like, (T,), s

    Returns
    -------
    ndarray, (T, 3), m

    Examples
    --------
    >>> from reference.problem import load_scene
    >>> ground_displacement(load_scene("fig3-I"), (0.0, 0.0), [0.0])[0].tolist()
    [0.0, 0.0, 0.0]
    """
    if scene.recorded:
        return _integrate_record(scene.record, _check_instants(time), 2)
    t = _check_instants(time)
    s = exponents(scene)
    st = np.multiply.outer(t, s)
    # (exp(st) - 1 - st) / s^2 is summed as a series where the subtraction would cancel digits
    series = st**2 * (0.5 + st / 6.0 * (1.0 + st / 4.0 * (1.0 + st / 5.0 * (1.0 + st / 6.0 * (1.0 + st / 7.0)))))
    return _superpose(scene, phase, np.where(np.abs(st) < 1e-2, series, np.expm1(st) - st) / s**2)


def _superpose(scene: Scene, phase: ArrayLike, harmonics: NDArray[np.complex128]) -> Array:
    """
    Return the ground motion (T, 3) along x, y and z as the sum of both harmonics times their amplitudes.

    harmonics: (T, 2), exp(s_i t) or its integral, for a phase of zero and an amplitude of 1.
    """
    result: Array = np.real((harmonics * _phase_factors(phase)) @ scene.amplitudes.T)
    return result


def _phase_factors(phase: ArrayLike) -> NDArray[np.complex128]:
    """Return the complex factors exp(i alpha_1) and exp(i alpha_2) of a phase pair."""
    factors: NDArray[np.complex128] = np.exp(1j * check_phase(phase))
    return factors


def _check_instants(time: ArrayLike) -> Array:
    """Return instants, s, as an array of the given shape. Raises ValueError, a one-line message, if not finite."""
    return check_array("time", time, "must be instants (T,), s").reshape(np.shape(time))


def _integrate_record(knots: Array, time: ArrayLike, order: int) -> Array:
    """
    Return a record's acceleration along x, y and z at instants (T,), s, integrated `order` times from rest, (T, 3).

    knots: (K, 4), as `Scene.record`. Between two samples the acceleration is linear, so that velocity and displacement
    are polynomials of second and third degree: Taylor series about the earlier sample give them exactly.
    """
    t = np.asarray(time, float)
    instant, start = knots[:, 0], knots[:, 1:]
    span = np.diff(instant)[:, None]
    slope = np.vstack([np.diff(start, axis=0) / span, np.zeros(3)])  # zero after the last sample
    at_samples = [start]  # acceleration, then velocity and displacement at the samples
    if order > 0:
        at_samples.append(_cumulative_sums(span * (start[:-1] + 0.5 * span * slope[:-1])))
    if order > 1:
        velocity = at_samples[1][:-1]
        at_samples.append(_cumulative_sums(span * (velocity + span * (0.5 * start[:-1] + span / 6.0 * slope[:-1]))))
    k = np.clip(np.searchsorted(instant, t, side="right") - 1, 0, len(instant) - 1)
    since = (t - instant[k])[..., None]
    result: Array = at_samples[-1][k]
    power = np.ones_like(since)
    for exponent, derivative in enumerate([*at_samples[-2::-1], slope], start=1):
        power = power * since / exponent
        result = result + power * derivative[k]
    return np.where(t[..., None] < instant[0], 0.0, result)


def _cumulative_sums(gains: Array) -> Array:
    """Return the sums (K + 1, 3) of the first 0, 1, ..., K of the gains (K, 3), which belong to K intervals."""
    return np.vstack([np.zeros(3), np.cumsum(gains, axis=0)])
