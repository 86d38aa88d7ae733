"""
Compiled loops over the rows of a chunk of steps: chunks are short, and array operations would take longer.

The arrays are those of a `EngineMotion`: accelerations and coordinates (T, n), contact (T, 4 K).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from reference.support.build_cache import cache_on_disk

Array = NDArray[np.float64]


@cache_on_disk(__file__, nogil=True)
def absolute_acceleration_sizes(accelerations: Array, bodies: NDArray[np.int_], plate: Array) -> Array:
    """Return sizes (T, N) of absolute accelerations: those of coordinates `bodies` (N, 3) plus the plate's (T, 3)."""
    steps, count = len(accelerations), len(bodies)
    size = np.empty((steps, count))
    for row in range(steps):
        for body in range(count):
            x = accelerations[row, bodies[body, 0]] + plate[row, 0]
            y = accelerations[row, bodies[body, 1]] + plate[row, 1]
            z = accelerations[row, bodies[body, 2]] + plate[row, 2]
            size[row, body] = math.sqrt(x * x + y * y + z * z)
    return size


@cache_on_disk(__file__, nogil=True)
def smallest_loaded_slip(contact: Array, row: int) -> float:
    """Return the smallest slip speed of the contacts that carry load in a row; inf if no contact carries load."""
    slip = math.inf
    for place in range(0, contact.shape[1], 4):
        if contact[row, place] < 0.0:
            slip = min(slip, contact[row, place + 1])
    return slip


@cache_on_disk(__file__, nogil=True)
def slip_change_ratios(
    accelerations: Array, platform: NDArray[np.int_], contact: Array, per_change: float, corner: float
) -> Array:
    """
    Return the ratio (T,) of the change of slip velocity in each step to the allowed change, at the slowest contact.

    platform: index of the platform's coordinates, (3,). per_change: step divided by the allowed relative change.
    corner: slip speed that counts for slower contacts.
    """
    step_ratio = np.empty(len(accelerations))
    before_x = before_y = before_z = 0.0
    for row in range(len(accelerations)):
        x, y, z = accelerations[row, platform[0]], accelerations[row, platform[1]], accelerations[row, platform[2]]
        size = math.sqrt(x * x + y * y + z * z)
        if row > 0:
            # twice the change of the acceleration in this step counts, if larger: the next steps change it by as much
            dx, dy, dz = x - before_x, y - before_y, z - before_z
            size = max(size, 2.0 * math.sqrt(dx * dx + dy * dy + dz * dz))
        step_ratio[row] = per_change * size / max(smallest_loaded_slip(contact, row), corner)
        before_x, before_y, before_z = x, y, z
    return step_ratio


@cache_on_disk(__file__, nogil=True)
def find_rim_exit_rows(coordinates: Array, height: int, rim: float, contact: Array) -> tuple[int, int]:
    """Find the first row where coordinate `height` reaches `rim`, and the first with all contacts open; T if none."""
    steps = len(coordinates)
    beyond, lost = steps, steps
    for row in range(steps):
        if beyond == steps and coordinates[row, height] >= rim:
            beyond = row
        if lost == steps:
            carries = False
            for place in range(0, contact.shape[1], 4):
                carries |= not contact[row, place] >= 0.0
            if not carries:
                lost = row
    return beyond, lost


@cache_on_disk(__file__, nogil=True)
def vector_lengths(coordinates: Array, axes: NDArray[np.int_]) -> Array:
    """Return the length, in each row, of the vector of the two coordinates `axes`, (T,)."""
    length = np.empty(len(coordinates))
    for row in range(len(coordinates)):
        x, y = coordinates[row, axes[0]], coordinates[row, axes[1]]
        length[row] = math.sqrt(x * x + y * y)
    return length


@cache_on_disk(__file__, nogil=True)
def largest_distance(time: Array, coordinates: Array, velocities: Array, axes: NDArray[np.int_]) -> float:
    """Return the largest length of the vector of two coordinates `axes`, also between the instants (T,) of the rows."""
    largest = before_square = before = 0.0
    for row in range(len(time)):
        x, y = coordinates[row, axes[0]], coordinates[row, axes[1]]
        square, rate = x * x + y * y, x * velocities[row, axes[0]] + y * velocities[row, axes[1]]
        largest = max(largest, square)
        if row > 0 and before > 0.0 > rate:
            # half the derivative of the square falls linearly from `before` to `rate`, through zero at the maximum
            rise = before * before / (before - rate) * (time[row] - time[row - 1])
            largest = max(largest, before_square + rise)
        before_square, before = square, rate
    return math.sqrt(largest)


@cache_on_disk(__file__, nogil=True)
def find_last_row_near_peak(size: Array, sizes: Array, distance: Array, far: float) -> int:
    """Find the last row in which a `size` (T, N) reaches `sizes` (N,), or `distance` (T,) reaches `far`; -1 if none."""
    for row in range(len(size) - 1, -1, -1):
        if distance[row] >= far:
            return row
        for body in range(size.shape[1]):
            if size[row, body] >= sizes[body]:
                return row
    return -1


@cache_on_disk(__file__, nogil=True)
def has_larger_entry(size: Array, first: int, least: Array) -> bool:
    """Return whether any `size` (T, N) from row `first` on is larger than the entry of `least` (N,) of its column."""
    for row in range(first, len(size)):
        for body in range(size.shape[1]):
            if size[row, body] > least[body]:
                return True
    return False
