"""
Free decay under dry friction: x'' + omega^2 x = -omega^2 x_f sign(x'), released at rest.

Half cycle k is a cosine about +-x_f of half period pi / omega exactly. In each the amplitude falls by 2 x_f, and the
body stays where it first stops within x_f of the middle (Den Hartog, Mechanical Vibrations). For one body on the
isolator in small vibration (4.3) omega^2 = g / rho and x_f = mu rho, so each whole cycle costs 4 mu rho.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def coulomb_rest(amplitude: float, dead_zone: float, frequency: float) -> tuple[float, float]:
    """
    Return time, s, and position, m, of the final rest after a release at `amplitude`, m.

    `dead_zone` is x_f, m, where friction just holds the spring; `frequency` is omega, rad/s.
    """
    halves = _half_cycles(amplitude, dead_zone)
    position = (-1.0) ** halves * np.sign(amplitude) * (abs(amplitude) - 2.0 * dead_zone * halves)
    return halves * np.pi / frequency, float(position)


def coulomb_decay(time: ArrayLike, amplitude: float, dead_zone: float, frequency: float) -> tuple[Array, Array]:
    """Return position, m, and velocity, m/s, (T,) each, at `time` (T,), s; other arguments as of `coulomb_rest`."""
    angle = frequency * np.asarray(time, dtype=float)
    half = np.minimum(np.floor(angle / np.pi), _half_cycles(amplitude, dead_zone))
    moving = half < _half_cycles(amplitude, dead_zone)
    # In half cycle k the body swings from (-1)^k (A - 2 k x_f) about (-1)^k x_f; cos(angle) contains the sign (-1)^k.
    swing = abs(amplitude) - (2.0 * half + 1.0) * dead_zone
    middle = (-1.0) ** half * dead_zone
    _, rest = coulomb_rest(abs(amplitude), dead_zone, frequency)
    position = np.where(moving, middle + swing * np.cos(angle), rest)
    velocity = np.where(moving, -frequency * swing * np.sin(angle), 0.0)
    return np.sign(amplitude) * position, np.sign(amplitude) * velocity


def _half_cycles(amplitude: float, dead_zone: float) -> int:
    """Return the number of half cycles until a turning point lies within the dead zone."""
    return max(0, int(np.ceil((abs(amplitude) / dead_zone - 1.0) / 2.0)))
