"""
Step control: ratio of each step to the largest one that the motion allows, and number of steps to try next.

A constant step is inaccurate at stops. While the slip speed is small, the slip direction turns and the regularized
friction relaxes within milliseconds. So the velocity of the platform may change in one step by no more than a fraction
of the slip speed (of v_reg, where the slip is slower than that). Friction that depends on the slip speed and kinks of a
recorded loading bound the step as well.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from multibody.integration.chunk import slip_change_ratios, smallest_loaded_slip
from multibody.integration.constant_step import EngineMotion
from multibody.integration.level import STEP_RATIO, Level
from multibody.integration.openings import FIRST_STEP_OVER_RESPONSE
from multibody.integration.peak import CANDIDATE_FRACTION, find_kinks
from multibody.models.state import EngineState
from multibody.models.system import EngineModel

Array = NDArray[np.float64]

# Smallest and largest number of steps in a chunk at the largest step.
MIN_CHUNK_STEPS, MAX_CHUNK_STEPS = 32, 256

# Number of steps in a chunk whose steps are below the largest, times the allowed change of the slip velocity: chunks of
# all levels then end, and steps grow, at the same instants.
SLIP_CHANGE_PER_SMALL_CHUNK = 4.48
MIN_SMALL_CHUNK_STEPS, MAX_SMALL_CHUNK_STEPS = 8, 4096  # bounds of the steps in a chunk of small steps

# Largest first step after a kink of the loading, divided by the relaxation time of friction and by the allowed change
# of the slip velocity (`Level.slip_change`).
KINK_STEP_RATIO = 4.0

# Step times the rate at which friction that depends on the slip speed changes this speed: at most the first constant
# times the level's slip_change, and at most the second. At products from 2/3 on, errors of friction alternate and grow.
FEEDBACK_PER_SLIP_CHANGE, MAX_STEP_TIMES_FEEDBACK = 2.0, 0.3

# Largest number of steps, an even one, over which the rate of a gap is averaged.
GAP_RATE_STEPS = 4


@dataclass(frozen=True)
class StepControl:
    """Bounds of the steps that a model may take at a level of accuracy."""

    model: EngineModel
    level: Level

    def step_ratio(self, motion: EngineMotion, size: Array, peaks: Array, step: float, state: EngineState) -> Array:
        """
        Return the ratio of each step of a motion to the largest one that is allowed there, (T,).

        size: absolute accelerations of the bodies, (T, N). peaks: their largest values so far, (N,). step: length of
        the steps. state: state from which the motion starts.
        """
        model, level = self.model, self.level
        per_change = step / level.slip_change
        if model.springs is None:
            step_ratio = self._slip_step_ratio(motion, per_change)
        else:
            step_ratio = model.springs.step_ratio(motion, state, level.slide_end) / level.slip_change
        if model.friction is not None:
            allowed = min(FEEDBACK_PER_SLIP_CHANGE * level.slip_change, MAX_STEP_TIMES_FEEDBACK)
            step_ratio = np.maximum(step_ratio, step / allowed * model.friction.friction_feedback_rate(motion.slip))
        if len(model.ground.knots):
            step_ratio = np.maximum(step_ratio, self._kink_step_ratio(motion, size, peaks, per_change))
        return step_ratio

    def _slip_step_ratio(self, motion: EngineMotion, per_change: float) -> Array:
        """Return the ratio (T,) of the change of the slip velocity in each step to the allowed change."""
        corner = self.model.corner
        if not math.isfinite(corner):
            return np.zeros(len(motion.time))
        changes: Array = slip_change_ratios(
            motion.accelerations, self.model.bodies[0], motion.contact, per_change, corner
        )
        return changes

    def _kink_step_ratio(self, motion: EngineMotion, size: Array, peaks: Array, per_change: float) -> Array:
        """Return the ratio (T,) of first steps after kinks of the loading to those allowed near peaks; 0 for others."""
        # While the platform creeps, its acceleration follows that of the ground within the relaxation time of friction.
        # Behind a kink the slope changes within that time, and longer steps would show an oscillation. Bodies that turn
        # with the platform, and dampers, follow the acceleration of the platform. So the first step behind a kink is
        # bounded, but only if the platform creeps, a body is near its peak, and its samples show the kink. Samples
        # whose third difference is within the error floor of the peak lie on one parabola and show no kink.
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
        """Return how many steps a chunk has if they are smaller than the largest step."""
        steps = SLIP_CHANGE_PER_SMALL_CHUNK / self.level.slip_change
        return round(min(max(steps, MIN_SMALL_CHUNK_STEPS), MAX_SMALL_CHUNK_STEPS))

    def count_largest_steps(self, motion: EngineMotion) -> int:
        """Return how many steps of the largest size to try after `motion`, until its slip speed needs smaller ones."""
        corner, level = self.model.corner, self.level
        if not math.isfinite(corner):
            return MAX_CHUNK_STEPS
        before, slip = smallest_loaded_slip(motion.contact, -2), smallest_loaded_slip(motion.contact, -1)
        if not math.isfinite(before + slip):
            return MAX_CHUNK_STEPS
        # the slip speed is extrapolated linearly to the speed at which the largest step is no longer allowed
        rate = (slip - before) / float(motion.time[-1] - motion.time[-2])
        target = corner
        if slip > corner:
            size = float(np.linalg.norm(motion.accelerations[-1, self.model.bodies[0]]))
            target = max(corner, size * level.step / level.slip_change)
        if (target - slip) * rate <= 0.0:
            return MAX_CHUNK_STEPS
        return int(min(max((target - slip) / rate / level.step, MIN_CHUNK_STEPS), MAX_CHUNK_STEPS))

    def count_divisions_behind_impact(self) -> int:
        """Return the number of divisions of the largest step by `STEP_RATIO` for the first step after an impact."""
        first_step = FIRST_STEP_OVER_RESPONSE * math.sqrt(self.level.penetration)
        wanted = math.ceil(math.log(self.level.step / first_step, STEP_RATIO))
        return min(max(wanted, 0), self.level.max_divisions)


def gap_rate_at_end(motion: EngineMotion) -> Array:
    """Return the rates (K,) of the gaps at the end of a chunk, over an even number of steps: gaps may alternate."""
    rows = min(GAP_RATE_STEPS, (len(motion.time) - 1) // 2 * 2)
    if rows == 0:
        return np.zeros(motion.gap.shape[1])
    rate: Array = (motion.gap[-1] - motion.gap[-1 - rows]) / (motion.time[-1] - motion.time[-1 - rows])
    return rate
