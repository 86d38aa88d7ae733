"""
Largest absolute acceleration of each body, also between recorded instants, with the error of the interpolation.

The regularized law has a corner where the slip speed passes v_reg: accelerations are continuous there and their slopes
jump. The largest acceleration of a platform that comes to a stop is often that corner, between two samples, so it is
read from each side by itself, at the instant at which the slip speed passes v_reg. Recorded loading has kinks, too, but
at samples: nothing is read across them.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from multibody.integration.chunk import has_larger_entry

Array = NDArray[np.float64]
Rows = NDArray[np.intp]  # row numbers of samples

# Empty arrays: instants of a loading without kinks, and row numbers where no row is found.
NO_KNOTS, NO_ROWS = np.empty(0), np.empty(0, np.intp)

# Number of samples carried over to the next chunk: as many as the extrapolations from both sides of an instant need.
CARRIED_SAMPLES = 6

# Largest ratio of neighboring steps across which a parabola is fitted: step control alone makes no larger ratio.
MAX_STEP_CHANGE = 20.0

# Largest number of steps by which samples are extrapolated beyond the last one, to an instant of impact.
MAX_STEPS_EXTRAPOLATED = 1.5

# Number of samples behind a corner of the friction law that are needed to extrapolate the acceleration back to it.
SAMPLES_BEHIND_CORNER = 3

# Ratio of the last step to the one before beyond which the samples do not count as equally spaced.
MIN_LONGER_STEP_RATIO = 1.5

# Share of the largest value so far: where steps resolve the motion, no maximum beside a sample below it is larger.
CANDIDATE_FRACTION = 0.97


class _AccelerationSamples(NamedTuple):
    """
    Samples of the absolute acceleration of each body, and the rows at which their slopes jump.

    time: (T,). size: (T, N). slip: speeds (T, K). corners: rows behind which a slip speed passes the threshold. bends:
    rows on kinks of the loading, and between steps one of which is much longer. ready: corners to read now.
    """

    time: Array
    size: Array
    slip: Array
    corners: list[int]
    bends: list[int]
    ready: list[int]


class PeakReader:
    """
    Running maximum over time of the absolute acceleration of each body, updated with every chunk of a motion.

    Parameters:
    - bodies: Number N of bodies.
    - threshold: Slip speed v_reg at which the friction law has its corner; inf if it has none.
    - knots: Rising instants at which the loading has a kink, each a sample within `near`, (K,).

    Attributes:
    - value, sampling_error, instant: Largest value of each body, estimated error of its interpolation, and instant,
      (N,).
    - first_sample: Values of the first sample, (N,).
    """

    def __init__(self, bodies: int, threshold: float, knots: Array = NO_KNOTS, near: float = 0.0) -> None:
        """Start without samples, all largest values being zero."""
        self.value = np.zeros(bodies)
        self.sampling_error = np.zeros(bodies)
        self.instant = np.zeros(bodies)
        self.first_sample: Array | None = None
        self._threshold, self._knots, self._near = threshold, knots, near
        self._last_read_corner = -np.inf
        self._time = np.empty(0)
        self._size = np.empty((0, bodies))
        self._slip = np.empty((0, 0))

    def add(self, time: Array, size: Array, slip: Array) -> None:
        """Add acceleration sizes (T, N) and slip speeds (T, K) at times (T,); the first row repeats the last sample."""
        if self.first_sample is None:
            self.first_sample = size[0]
        carried = len(self._time)
        least = CANDIDATE_FRACTION * self.value
        candidate = has_larger_entry(size, 1 if carried else 0, least) or has_larger_entry(self._size, 0, least)
        if carried and (candidate or len(time) <= CARRIED_SAMPLES):
            time = np.concatenate([self._time, time[1:]])
            size = np.concatenate([self._size, size[1:]])
            slip = np.concatenate([self._slip, slip[1:]])
        if candidate:
            self._read_between(time, size, slip)
        self._time, self._size, self._slip = time[-CARRIED_SAMPLES:], size[-CARRIED_SAMPLES:], slip[-CARRIED_SAMPLES:]

    def _read_between(self, time: Array, size: Array, slip: Array) -> None:
        """Update the largest values from the samples, and from interpolation between them."""
        # The largest acceleration lies between two samples. In smooth motion the maximum of a parabola through the
        # highest sample and its neighbors is of fourth order. No parabola may be fitted across three kinds of rows.
        # Where the slip speed passes v_reg, the corner of the friction law, the slope of the acceleration jumps within
        # the step. At kinks of a recorded loading, and at steps much longer than their neighbor, it jumps at the
        # sample. At a stop the corner itself is often the peak. Its acceleration is extrapolated from each side alone,
        # to the instant at which the slip speed of that side passes v_reg, once, as soon as there are samples behind
        # the corner.
        corners = self._find_corners(slip)
        ready = [
            left for left in corners if left + SAMPLES_BEHIND_CORNER < len(time) and time[left] > self._last_read_corner
        ]
        bends = sorted({*find_kinks(time, self._knots, self._near).tolist(), *_find_step_jumps(time).tolist()})
        samples = _AccelerationSamples(time, size, slip, corners, bends, ready)
        for body in range(size.shape[1]):
            self._scan_body(body, samples)
        if ready:
            self._last_read_corner = float(time[ready[-1]])

    def _find_corners(self, slip: Array) -> list[int]:
        """Find the rows after which a slip speed (T, C) passes the threshold v_reg before the next row."""
        beyond = slip > self._threshold
        rows: list[int] = np.flatnonzero((beyond[1:] != beyond[:-1]).any(axis=1)).tolist()
        return rows

    def read_until(self, instant: float) -> None:
        """Extrapolate the last samples to `instant`, at which velocities jump, if the samples resolve the motion."""
        time, size, last = self._time, self._size, len(self._time) - 1
        if last < 2 or instant - time[-1] > MAX_STEPS_EXTRAPOLATED * np.diff(time[-3:]).min():
            return
        corners = self._find_corners(self._slip)
        bends: list[int] = find_kinks(time, self._knots, self._near).tolist()
        if max(_find_smooth_side(last, len(time), corners)[0], *bends, 0) > last - 2:
            return
        for body, values in enumerate(size.T):
            linear, curved = (_extrapolate(time[-count:], values[-count:], instant) for count in (2, 3))
            if abs(curved - linear) < abs(linear - values[-1]):
                self._update_largest(body, curved, abs(curved - linear), instant)

    def restart(self) -> None:
        """Forget the samples, so that no value is interpolated across this instant, at which velocities jump."""
        self._time, self._size, self._slip = self._time[:0], self._size[:0], self._slip[:0]

    def _scan_body(self, body: int, samples: _AccelerationSamples) -> None:
        """Update the largest value of one body from the samples."""
        time, slip, corners = samples.time, samples.slip, samples.corners
        size = samples.size[:, body]
        row = int(size.argmax())
        if size[row] <= CANDIDATE_FRACTION * self.value[body]:
            return
        unresolved = _error_of_lone_sample(time, size, row, corners)
        for stretch in _list_smooth_stretches(row, len(size), corners, samples.bends):
            value, error, instant = _read_parabola_maximum(time, size, row, *stretch)
            self._update_largest(body, value, max(error, unresolved), instant)
        for left in samples.ready:
            if max(size[left], size[left + 1]) > CANDIDATE_FRACTION * self.value[body]:
                self._update_largest(body, *_read_corner(time, size, slip, left, self._threshold, corners))

    def _update_largest(self, body: int, value: float, error: float, instant: float) -> None:
        """Keep a value if it is a body's largest so far; the error covers the largest sum of value and error so far."""
        possible = max(value + error, self.value[body] + self.sampling_error[body])
        if value > self.value[body]:
            self.value[body], self.instant[body] = value, instant
            self.sampling_error[body] = max(error, possible - value)
        else:
            self.sampling_error[body] = possible - self.value[body]


def find_kinks(time: Array, knots: Array, near: float) -> Rows:
    """Find the rows of `time` that lie within `near` of one of the knots (kinks of the loading); both arrays rise."""
    if not len(knots):
        return NO_ROWS
    return np.flatnonzero(np.abs(knots[np.searchsorted(knots[:-1], time - near)] - time) <= near)


def _find_step_jumps(time: Array) -> Rows:
    """Find the rows between two steps one of which is much longer, across which no parabola is fitted."""
    steps = np.diff(time)
    longer, shorter = np.maximum(steps[1:], steps[:-1]), np.minimum(steps[1:], steps[:-1])
    return np.flatnonzero(longer > MAX_STEP_CHANGE * shorter) + 1


def _read_parabola_maximum(
    time: Array, size: Array, row: int, first: int, last: int, others: tuple[int, int]
) -> tuple[float, float, float]:
    """
    Return the maximum of a parabola through the highest sample and two others, or the sample if slopes jump nearby.

    row: the highest sample. first, last: first and last sample of the smooth stretch that contains it. others: the two
    other samples. The result is value, error and instant.
    """
    # A fourth sample shows the error of the parabola: the third divided difference times the cubic that vanishes at the
    # three samples is the error at the maximum. Samples that alternate from step to step are ringing of the integrator
    # and no motion, and the alternating part is an error, too.
    alternating = 0.0
    if last - first >= 4:
        begin = min(max(row - 2, first), last - 4)
        alternating = _alternating_part(time[begin : begin + 5], size[begin : begin + 5])
    sample = float(size[row]), alternating, float(time[row])
    if not (first <= min(others) and max(others) <= last):
        return sample
    # parabola: size[row] + slope t + curvature t^2, with the time t from the highest sample
    t = [float(time[other] - time[row]) for other in others]
    left, right = (float(size[other] - size[row]) / apart for other, apart in zip(others, t))
    curvature = (right - left) / (t[1] - t[0])
    slope = left - curvature * t[0]
    if curvature >= 0.0:
        return sample
    around = others[0] < row < others[1]
    summit = min(max(-0.5 * slope / curvature, min(t[0], 0.0)), t[1] if around else max(t[0], 0.0))
    rise = (slope + curvature * summit) * summit
    error = alternating
    for extra in (row - 2, row + 2) if around else (2 * others[1] - others[0],):
        if first <= extra <= last:
            s = float(time[extra] - time[row])
            third = (float(size[extra] - size[row]) - (slope + curvature * s) * s) / (s * (s - t[0]) * (s - t[1]))
            error = max(error, abs(third * summit * (summit - t[0]) * (summit - t[1])))
    return float(size[row]) + rise, error, float(time[row]) + summit


def _alternating_part(time: Array, size: Array) -> float:
    """Return the part of five samples that alternates from step to step; near zero where steps resolve the motion."""
    # The fourth divided difference of the samples vanishes for a cubic. Divided by the sum of its weights' sizes it is
    # the amplitude of samples that alternate; if the last step is longer, that of the last sample alone is taken.
    apart = time[:, None] - time
    np.fill_diagonal(apart, 1.0)
    weights = 1.0 / apart.prod(axis=1)
    longer = time[-1] - time[-2] > MIN_LONGER_STEP_RATIO * (time[-2] - time[-3])
    return float(abs(weights @ size) / (abs(weights[-1]) if longer else np.abs(weights).sum()))


def _error_of_lone_sample(time: Array, size: Array, row: int, corners: list[int]) -> float:
    """
    Return the error of a sample that is alone between two instants at which the slip speed passes v_reg (corners).

    It is the difference from the extrapolation of earlier samples. It is zero at the beginning of the motion, and if
    there are other samples between the corners.
    """
    if row - 1 not in corners or row not in corners:
        return 0.0
    last = row - 1
    while last - 1 in corners:
        last -= 1
    first = max(_find_smooth_side(last, len(size), corners)[0], last - 2)
    if first == last:
        return 0.0
    before = slice(first, last + 1)
    return abs(_extrapolate(time[before], size[before], float(time[row])) - float(size[row]))


def _read_corner(
    time: Array, size: Array, slip: Array, left: int, threshold: float, corners: list[int]
) -> tuple[float, float, float]:
    """
    Return acceleration, error and instant where the slip speed passes the threshold between rows `left` and `left + 1`.

    Each side alone gives the instant at which the slip speed passes the threshold, since the rate of the slip speed
    jumps there as well. The error is half the difference of the values, and the slope times half that of the instants.
    """
    first, _ = _find_smooth_side(left, len(size), corners)
    _, last = _find_smooth_side(left + 1, len(size), corners)
    before = slice(max(first, left - 2), left + 1)
    after = slice(left + 1, min(last, left + 3) + 1)
    contact = int(((slip[left] > threshold) != (slip[left + 1] > threshold)).argmax())
    ends = float(time[left]), float(time[left + 1])
    instants = [
        _locate_crossing(time[side], slip[side, contact], threshold, ends)
        for side in (before, after)
        if side.stop - side.start > 1
    ]
    if not instants:
        low, high = slip[left, contact], slip[left + 1, contact]
        instants = [ends[0] + (threshold - low) / (high - low) * (ends[1] - ends[0])]
    instant = sum(instants) / len(instants)
    values = [_extrapolate(time[side], size[side], instant) for side in (before, after)]
    slope = max(abs(float(size[left + 1] - size[left])), abs(values[0] - values[1])) / (ends[1] - ends[0])
    error = 0.5 * abs(values[0] - values[1]) + 0.5 * (max(instants) - min(instants)) * slope
    return 0.5 * (values[0] + values[1]), error, instant


def _list_smooth_stretches(
    row: int, count: int, corners: list[int], bends: list[int]
) -> Iterator[tuple[int, int, tuple[int, int]]]:
    """Yield first and last row of every smooth stretch that contains `row`, and the two rows nearest to `row` in it."""
    first, last = _find_smooth_side(row, count, corners)
    place = bisect_left(bends, row)
    before, here = [first, *bends[:place]], place < len(bends) and bends[place] == row
    after = [*bends[place + here :], last]
    if here:
        yield max(first, before[-1]), row, (row - 1, row - 2)
        yield row, min(last, after[0]), (row + 1, row + 2)
    else:
        yield max(first, before[-1]), min(last, after[0]), (row - 1, row + 1)


def _find_smooth_side(row: int, count: int, corners: list[int]) -> tuple[int, int]:
    """Return the first and the last row that no corner of the friction law separates from `row`."""
    place = bisect_left(corners, row)
    first = corners[place - 1] + 1 if place > 0 else 0
    return first, corners[place] if place < len(corners) else count - 1


def _extrapolate(time: Array, values: Array, instant: float) -> float:
    """Extrapolate the polynomial through the given samples (one to three) to `instant` (Neville's algorithm)."""
    nodes, table = time.tolist(), values.tolist()
    for order in range(1, len(nodes)):
        for i in range(len(nodes) - order):
            span = nodes[i + order] - nodes[i]
            table[i] = ((instant - nodes[i]) * table[i + 1] + (nodes[i + order] - instant) * table[i]) / span
    return float(table[0])


def _locate_crossing(time: Array, slip: Array, threshold: float, ends: tuple[float, float]) -> float:
    """Return the instant between `ends` at which a slip speed, extrapolated from 2 or 3 samples, is the threshold."""
    # a line through the two nearest samples gives the instant, and one step with its slope corrects it on the parabola
    near, far = (-1, -2) if time[-1] <= ends[0] else (0, 1)
    rate = float((slip[near] - slip[far]) / (time[near] - time[far]))
    if rate == 0.0:
        return 0.5 * (ends[0] + ends[1])
    instant = min(max(float(time[near]) + (threshold - float(slip[near])) / rate, ends[0]), ends[1])
    return min(max(instant - (_extrapolate(time, slip, instant) - threshold) / rate, ends[0]), ends[1])
