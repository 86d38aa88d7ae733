"""Where a motion ends because the platform needs a larger displacement than the isolator permits."""

from __future__ import annotations

import math

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from multibody.integration.constant_step import EngineMotion
from multibody.models.system import EngineModel
from reference.measures.demands import squares_and_summits

BISECTIONS = 50


def find_travel_end(motion: EngineMotion, model: EngineModel) -> tuple[float, int]:
    """When the displacement passes the travel, in units of time, infinite if never, and the last row before."""
    time, axes, limit = motion.time, model.bodies[0, :2], model.travel**2
    if model.travel == math.inf:
        return math.inf, len(time) - 1
    place, velocity = motion.coordinates[:, axes], motion.velocities[:, axes]
    square, summits = squares_and_summits(time, place, velocity)
    beyond = np.flatnonzero((summits > limit) | (square[1:] > limit))
    if not len(beyond):
        return math.inf, len(time) - 1
    row = int(beyond[0])
    ends = slice(row, row + 2)
    before, after = (2.0 * (place[ends] * velocity[ends]).sum(axis=1)).tolist()
    path = CubicHermiteSpline(time[ends], square[ends], [before, after])
    share = before / (before - after) if before > 0.0 > after else 1.0  # of the step, to its summit
    low = float(time[row])
    high = low + share * float(time[row + 1] - low)
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if path(middle) > limit else (middle, high)
    return high, row
