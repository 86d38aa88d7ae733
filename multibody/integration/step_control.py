"""
Control of the step: how large each step is against what the motion allows there, and how many to try next.

What a constant step gets wrong is the stop. While the slip speed is small, the slip direction turns and the regularized
friction relaxes within milliseconds. So the velocity of the platform may change in one step by no more than a fraction
of the slip speed (of v_reg, where the slip is slower than that). Friction that depends on the slip speed and kinks of a
recorded loading bound the step as well.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from multibody.integration.chunk import slip_changes, slowest_loaded_slip
from multibody.integration.constant_step import EngineMotion
from multibody.integration.level import STEP_RATIO, Level
from multibody.integration.openings import FIRST_STEP_OVER_RESPONSE
from multibody.integration.peak import CANDIDATE_FRACTION, find_kinks
from multibody.models.state import EngineState
from multibody.models.system import EngineModel

Array = NDArray[np.float64]

# Bounds of the number of steps in a chunk at the largest step.
MIN_CHUNK_STEPS, MAX_CHUNK_STEPS = 32, 256

# Number of steps in a chunk at smaller steps, times the allowed change of the slip velocity. The chunks of all levels
# then end, and their steps grow, at the same instants. The bounds are for levels that no model has by itself.
SMALL_CHUNK_CHANGE = 4.48
MIN_SMALL_CHUNK_STEPS, MAX_SMALL_CHUNK_STEPS = 8, 4096

# First step behind a kink of the loading, over slip_change times the relaxation of friction.
KINK_STEP_RATIO = 4.0

# Step times the rate at which friction that depends on the slip speed acts back on it (`SpeedFriction`), over the
# allowed change of the slip velocity. The maximum is well below the 2/3 at which steps of alternating friction begin to
# grow.
FEEDBACK_PER_SLIP_CHANGE, MAX_FEEDBACK = 2.0, 0.3

# Number of steps over which the rate of a gap is taken.
GAP_RATE_STEPS = 4


@dataclass(frozen=True)
class StepControl:
    """The steps that a model may take at a level of accuracy."""

    model: EngineModel
    level: Level

    def step_ratio(self, motion: EngineMotion, size: Array, peaks: Array, step: float, state: EngineState) -> Array:
        """Each step from `state` over what is allowed there, (T,), from accelerations (T, N) and peaks so far, (N,)."""
        model, level = self.model, self.level
        per_change = step / level.slip_change
        if model.springs is None:
            step_ratio = self._slip_step_ratio(motion, per_change)
        else:
            step_ratio = model.springs.step_ratio(motion, state, level.slide_end) / level.slip_change
        if model.friction is not None:
            allowed = min(FEEDBACK_PER_SLIP_CHANGE * level.slip_change, MAX_FEEDBACK)
            step_ratio = np.maximum(step_ratio, step / allowed * model.friction.feedback(motion.slip))
        if len(model.ground.knots):
            step_ratio = np.maximum(step_ratio, self._kink_step_ratio(motion, size, peaks, per_change))
        return step_ratio

    def _slip_step_ratio(self, motion: EngineMotion, per_change: float) -> Array:
        """Change of the slip velocity in one step over what is allowed, (T,)."""
        corner = self.model.corner
        if not math.isfinite(corner):
            return np.zeros(len(motion.time))
        changes: Array = slip_changes(motion.accelerations, self.model.bodies[0], motion.contact, per_change, corner)
        return changes

    def _kink_step_ratio(self, motion: EngineMotion, size: Array, peaks: Array, per_change: float) -> Array:
        """First step behind a kink of the loading over what is allowed, (T,), where a peak may be; zero elsewhere."""
        # While the platform creeps, its acceleration follows the ground's with the relaxation of regularized friction.
        # Behind a kink its slope changes within that time, which longer steps would take for a swing. Bodies that turn
        # with the platform and dampers follow it. So the first step behind a kink is bounded, but only where it counts:
        # the platform creeps, a body is near its peak, and its samples show the kink. Samples whose third difference is
        # within the error floor of the peak lie on one parabola and follow no kink.
        step_ratio, model, last = np.zeros(len(motion.time)), self.model, len(motion.time) - 1
        rows = find_kinks(motion.time, model.ground.knots, model.ground.near)
        rows = rows[rows < last]
        if len(rows) and np.isfinite(model.corner):
            largest = np.maximum(peaks, size.max(axis=0))
            third = np.abs(np.diff(size[np.minimum(rows + np.arange(4)[:, None], last)], 3, axis=0)[0])
            bent = third > self.level.error_floor * largest
            rows = rows[
                (bent & (size[rows] > CANDIDATE_FRACTION * largest)).any(axis=1)
                & (motion.slip[rows].min(axis=1) < model.corner)
            ]
            step_ratio[rows + 1] = per_change / (KINK_STEP_RATIO * model.relaxation)
        return step_ratio

    def count_small_steps(self) -> int:
        """Number of steps in a chunk of smaller steps than the largest."""
        steps = SMALL_CHUNK_CHANGE / self.level.slip_change
        return round(min(max(steps, MIN_SMALL_CHUNK_STEPS), MAX_SMALL_CHUNK_STEPS))

    def count_largest_steps(self, motion: EngineMotion) -> int:
        """Number of largest steps to try behind `motion`: until the slip speed, going on as now, asks for smaller."""
        corner, level = self.model.corner, self.level
        if len(motion.time) < 2 or not math.isfinite(corner):
            return MAX_CHUNK_STEPS
        before, slip = slowest_loaded_slip(motion.contact, -2), slowest_loaded_slip(motion.contact, -1)
        if not math.isfinite(before + slip):
            return MAX_CHUNK_STEPS
        rate = (slip - before) / float(motion.time[-1] - motion.time[-2])
        target = corner
        if slip > corner:
            size = float(np.linalg.norm(motion.accelerations[-1, self.model.bodies[0]]))
            target = max(corner, size * level.step / level.slip_change)
        if (target - slip) * rate <= 0.0:
            return MAX_CHUNK_STEPS
        return int(min(max((target - slip) / rate / level.step, MIN_CHUNK_STEPS), MAX_CHUNK_STEPS))

    def divisions_behind_impact(self) -> int:
        """Number of divisions of the largest step by `STEP_RATIO` while contact forces settle behind an impact."""
        first_step = FIRST_STEP_OVER_RESPONSE * math.sqrt(self.level.penetration)
        wanted = math.ceil(math.log(self.level.step / first_step, STEP_RATIO))
        return min(max(wanted, 0), self.level.max_divisions)


def gap_rate_at_end(motion: EngineMotion) -> Array:
    """Rate of each gap at the end of a chunk, (K,), over an even number of steps: the contact may alternate."""
    rows = min(GAP_RATE_STEPS, (len(motion.time) - 1) // 2 * 2)
    if rows == 0:
        return np.zeros(motion.gap.shape[1])
    rate: Array = (motion.gap[-1] - motion.gap[-1 - rows]) / (motion.time[-1] - motion.time[-1 - rows])
    return rate
