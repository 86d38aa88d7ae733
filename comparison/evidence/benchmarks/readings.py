"""
What a benchmark publishes, read from a motion.

Between its instants a motion is the cubic with its positions and velocities, so that a reading does not depend on where
the instants are.
"""

import numpy as np
from numpy.typing import ArrayLike

from comparison.evidence.sides import spline_along
from comparison.result_types import Array
from reference.problem import Trajectory

PARTS = 16  # parts into which the time between two instants is cut, to read extremes and lengths of the path
ROUNDING = 1e-12  # relative, of the last instant
STILL = 1e-3  # share of the largest speed: slower turns are creep, not swings


def positions_at(motion: Trajectory, times: ArrayLike) -> Array:
    """Position of the platform along x at some instants, s; NaN behind the end of the motion."""
    instants = np.asarray(times, dtype=float)
    values: Array = spline_along(motion, 0)(instants)
    return np.where(instants <= motion.time[-1] * (1.0 + ROUNDING), values, np.nan)


def turning_points(motion: Trajectory) -> Array:
    """Return where the platform's velocity along x changes sign, m; at last where a swing ends in rest or creep."""
    speed = motion.velocity[:, 0, 0]
    moving = np.flatnonzero(np.abs(speed) > STILL * np.abs(speed).max())
    sign = np.sign(speed[moving])
    last = np.flatnonzero(np.diff(sign))  # last sample of every swing but the last one, among the moving samples
    place = spline_along(motion, 0)
    turns = []
    for end, begin in [*zip(moving[last], moving[last + 1]), (moving[-1], len(speed) - 1)]:
        dense = place(_dense_instants(motion, float(motion.time[end]), float(motion.time[begin])))
        turns.append(dense[np.argmax(np.sign(speed[end]) * dense)])
    return np.array(turns)


def path_length(motion: Trajectory, begin: float, end: float) -> float:
    """Way that the platform slides between two instants."""
    dense = np.stack([spline_along(motion, axis)(_dense_instants(motion, begin, end)) for axis in (0, 1)])
    return float(np.hypot(*np.diff(dense)).sum())


def extreme_positions(motion: Trajectory, axis: int, begin: float = 0.0) -> tuple[float, float]:
    """Smallest and largest position of the platform along x (0) or y (1) from an instant on."""
    dense = spline_along(motion, axis)(_dense_instants(motion, begin, float(motion.time[-1])))
    return float(dense.min()), float(dense.max())


def position_ranges(motion: Trajectory) -> list[float]:
    """Smallest and largest position of the platform along x, then along y."""
    return [*extreme_positions(motion, 0), *extreme_positions(motion, 1)]


def half_range(motion: Trajectory, begin: float) -> float:
    """Amplitude of the platform's oscillation along x from an instant on: a whole period."""
    lowest, highest = extreme_positions(motion, 0, begin)
    return 0.5 * (highest - lowest)


def mean_period(motion: Trajectory) -> float:
    """Mean time between two passages of the platform through x = 0 in the same direction."""
    passages = spline_along(motion, 0).roots(extrapolate=False)
    return float(np.diff(passages[::2]).mean())


def natural_periods(motion: Trajectory) -> Array:
    """Natural periods, s, longest first, of a chain that moves freely along x: accelerations are -A x with one A."""
    place, acceleration = motion.position[:, :, 0], motion.absolute_acceleration[:, :, 0]
    moving = np.abs(place).max(axis=0) > STILL * np.abs(place).max()
    fitted = np.linalg.lstsq(place[:, moving], -acceleration[:, moving], rcond=None)[0]
    squared = np.sort(np.linalg.eigvals(fitted.T).real)
    periods: Array = 2.0 * np.pi / np.sqrt(np.where(squared > 0.0, squared, np.nan))
    return periods


def _dense_instants(motion: Trajectory, begin: float, end: float) -> Array:
    """Instants from `begin` to `end`: those of the motion, and PARTS between any two of them."""
    inner = motion.time[(motion.time > begin) & (motion.time < end)]
    knots = np.concatenate([[begin], inner, [end]])
    parts = np.arange(PARTS) / PARTS
    dense: Array = np.append((knots[:-1, None] + np.diff(knots)[:, None] * parts).ravel(), end)
    return dense
