"""Where a motion ends because the platform needs a larger displacement than the isolator permits."""

from __future__ import annotations

import math

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from multibody.integration.constant_step import Motion
from multibody.models.system import EngineModel

BISECTIONS = 50


def travel_reached(motion: Motion, model: EngineModel) -> tuple[float, int]:
    """
    When the platform's displacement passes the travel, in units of time, and the last row before.

    Infinite and the last row if it does not. Between two rows the rate of its square is taken as linear, as for the
    largest displacement (`reference.problem.demands.largest_displacement`).
    """
    time, axes, limit = motion.time, model.bodies[0, :2], model.travel**2
    if model.travel == math.inf:
        return math.inf, len(time) - 1
    place, velocity = motion.coordinates[:, axes], motion.velocities[:, axes]
    square, rate = (place**2).sum(axis=1), 2.0 * (place * velocity).sum(axis=1)
    before, after = rate[:-1], rate[1:]
    turns = (before > 0.0) & (after < 0.0)
    share = np.divide(before, before - after, where=turns, out=np.ones_like(before))  # of the step, to its summit
    summit = np.where(turns, square[:-1] + 0.5 * before * share * np.diff(time), square[1:])
    beyond = np.flatnonzero((summit > limit) | (square[1:] > limit))
    if not len(beyond):
        return math.inf, len(time) - 1
    row = int(beyond[0])
    path = CubicHermiteSpline(time[row : row + 2], square[row : row + 2], rate[row : row + 2])
    low = float(time[row])
    high = low + float(share[row]) * float(time[row + 1] - low)
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if path(middle) > limit else (middle, high)
    return high, row
