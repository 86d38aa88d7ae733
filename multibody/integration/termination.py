"""Instant at which a motion ends: at the rim, at the isolator's travel, by loss of contact or by overturning."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline

from multibody.integration.chunk import find_rim_exit_rows
from multibody.integration.constant_step import EngineMotion
from multibody.models.system import EngineModel
from reference.measures.demand_reader import squared_lengths_and_interval_maxima
from reference.problem import Outcome

Array = NDArray[np.float64]

# Rise of the platform in the translational model, in units of the pendulum radius rho, at which it reaches the rim.
RIM_HEIGHT = 1.0

# Number of bisections for the instant at which the travel is passed: they exhaust the digits of a time.
BISECTIONS = 50


def find_termination(motion: EngineMotion, model: EngineModel) -> tuple[Outcome, int, float]:
    """Find outcome, row and instant of the first event that ends the motion; OK and the last row if there is none."""
    outcome, row = _find_end_of_validity(motion, model)
    instant, before = find_travel_end(motion, model)
    if instant <= motion.time[row]:
        return Outcome.TRAVEL_REACHED, before, instant
    return outcome, row, float(motion.time[row])


def find_travel_end(motion: EngineMotion, model: EngineModel) -> tuple[float, int]:
    """
    Find the instant at which the displacement passes the travel of the isolator, and the last row before it.

    The instant is in units of time. It is infinite, with the last row of the motion, if the travel is never passed.
    """
    time, axes, limit = motion.time, model.bodies[0, :2], model.travel**2
    if model.travel == math.inf:
        return math.inf, len(time) - 1
    place, velocity = motion.coordinates[:, axes], motion.velocities[:, axes]
    square, summits = squared_lengths_and_interval_maxima(time, place, velocity)
    beyond = np.flatnonzero((summits > limit) | (square[1:] > limit))
    if not len(beyond):
        return math.inf, len(time) - 1
    row = int(beyond[0])
    ends = slice(row, row + 2)
    before, after = (2.0 * (place[ends] * velocity[ends]).sum(axis=1)).tolist()
    path = CubicHermiteSpline(time[ends], square[ends], [before, after])
    # A displacement that is beyond the travel in a part of a step passes it twice, first before its maximum. The
    # position of that maximum in the step follows from the rates at both ends.
    share = before / (before - after) if before > 0.0 > after else 1.0
    low = float(time[row])
    high = low + share * float(time[row + 1] - low)
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if path(middle) > limit else (middle, high)
    return high, row


def _find_end_of_validity(motion: EngineMotion, model: EngineModel) -> tuple[Outcome, int]:
    """Find outcome and row of the first event that ends the model's validity; OK and the last row if there is none."""
    count = len(motion.time)
    if model.depressions is not None:
        if model.depressions.is_near_rest(motion.coordinates):
            return Outcome.OK, count - 1
        tilt = _compute_tilt(motion, model)
        row = find_first_row(model.depressions.rows_beyond_rim(motion.coordinates) | (tilt >= 0.5 * math.pi))
        if row == count:
            return Outcome.OK, count - 1
        return Outcome.OVERTURNED if tilt[row] > model.critical_tilt else Outcome.RIM_REACHED, row
    # The height shows the rim: the horizontal distance only touches rho at the rim and falls again beyond it.
    rim, contact_lost = find_rim_exit_rows(motion.coordinates, model.bodies[0, 2], RIM_HEIGHT, motion.contact)
    contact_lost = count if model.allows_liftoff else contact_lost
    if min(rim, contact_lost) == count:
        return Outcome.OK, count - 1
    return (Outcome.RIM_REACHED, rim) if rim <= contact_lost else (Outcome.CONTACT_LOST, contact_lost)


def _compute_tilt(motion: EngineMotion, model: EngineModel) -> Array:
    """Return the angle (T,), rad, between the platform's axis and the vertical."""
    about_x, about_y = (motion.coordinates[:, axis] for axis in model.bodies[0, :2] + 3)
    tilt: Array = np.arccos(np.cos(about_x) * np.cos(about_y))
    return tilt


def find_first_row(holds: Any) -> int:
    """Return the first true row of a mask (T,); T if there is none."""
    row = int(holds.argmax())
    return row if holds[row] else len(holds)
