"""
Functions that read from a motion the numbers that a benchmark publishes.

Between its instants a motion is the cubic with its positions and velocities, so that a reading does not depend on where
the instants are.
"""

import numpy as np
from numpy.typing import ArrayLike

from comparison.evidence.sides import interpolate_platform
from comparison.result_types import Array
from reference.problem import Trajectory

READING_PARTS = 16  # number of parts into which each interval of a motion's samples is divided to read it more finely
TIME_ROUNDING = 1e-12  # relative rounding error that the last time of a motion may have
CREEP_SPEED_SHARE = 1e-3  # share of the largest speed; slower motion is creep at rest and makes no turning point


def interpolate_positions(motion: Trajectory, times: ArrayLike) -> Array:
    """Return the position of the platform along x at some instants, s; NaN after the end of the motion."""
    instants = np.asarray(times, dtype=float)
    values: Array = interpolate_platform(motion, 0)(instants)
    return np.where(instants <= motion.time[-1] * (1.0 + TIME_ROUNDING), values, np.nan)


def find_turning_points(motion: Trajectory) -> Array:
    """Return the positions, m, at which the platform's velocity along x changes sign, and the end of its last swing."""
    # A swing is a run of samples that move to one side, apart from creep. The turning point is sought between its last
    # sample and the first of the next swing.
    speed = motion.velocity[:, 0, 0]
    moving = np.flatnonzero(np.abs(speed) > CREEP_SPEED_SHARE * np.abs(speed).max())
    sign = np.sign(speed[moving])
    last = np.flatnonzero(np.diff(sign))  # index in `moving` of the last sample of each swing but the final
    place = interpolate_platform(motion, 0)
    turns = []
    for end, begin in [*zip(moving[last], moving[last + 1]), (moving[-1], len(speed) - 1)]:
        dense = place(_dense_instants(motion, float(motion.time[end]), float(motion.time[begin])))
        turns.append(dense[np.argmax(np.sign(speed[end]) * dense)])
    return np.array(turns)


def compute_path_length(motion: Trajectory, begin: float, end: float) -> float:
    """Return the length of the path that the platform slides between two instants, m."""
    dense = np.stack([interpolate_platform(motion, axis)(_dense_instants(motion, begin, end)) for axis in (0, 1)])
    return float(np.hypot(*np.diff(dense)).sum())


def find_extreme_positions(motion: Trajectory, axis: int, begin: float = 0.0) -> tuple[float, float]:
    """Return the smallest and largest position of the platform along x (0) or y (1) from an instant on."""
    dense = interpolate_platform(motion, axis)(_dense_instants(motion, begin, float(motion.time[-1])))
    return float(dense.min()), float(dense.max())


def find_position_ranges(motion: Trajectory) -> list[float]:
    """Return the smallest and largest position of the platform along x, then along y."""
    return [*find_extreme_positions(motion, 0), *find_extreme_positions(motion, 1)]


def compute_half_range(motion: Trajectory, begin: float) -> float:
    """Return half the range of the platform's position along x from an instant on: its amplitude."""
    lowest, highest = find_extreme_positions(motion, 0, begin)
    return 0.5 * (highest - lowest)


def compute_mean_period(motion: Trajectory) -> float:
    """Return the mean time between two passages of the platform through x = 0 in the same direction."""
    passages = interpolate_platform(motion, 0).roots(extrapolate=False)
    return float(np.diff(passages[::2]).mean())


def compute_natural_periods(motion: Trajectory) -> Array:
    """Return the natural periods, s, longest first, of a chain in free vibration, by fitting acceleration = -A x."""
    place, acceleration = motion.position[:, :, 0], motion.absolute_acceleration[:, :, 0]
    moving = np.abs(place).max(axis=0) > CREEP_SPEED_SHARE * np.abs(place).max()
    fitted = np.linalg.lstsq(place[:, moving], -acceleration[:, moving], rcond=None)[0]
    squared = np.sort(np.linalg.eigvals(fitted.T).real)
    periods: Array = 2.0 * np.pi / np.sqrt(np.where(squared > 0.0, squared, np.nan))
    return periods


def _dense_instants(motion: Trajectory, begin: float, end: float) -> Array:
    """Return instants from `begin` to `end`, s, READING_PARTS for every interval between samples of the motion."""
    inner = motion.time[(motion.time > begin) & (motion.time < end)]
    knots = np.concatenate([[begin], inner, [end]])
    parts = np.arange(READING_PARTS) / READING_PARTS
    dense: Array = np.append((knots[:-1, None] + np.diff(knots)[:, None] * parts).ravel(), end)
    return dense
