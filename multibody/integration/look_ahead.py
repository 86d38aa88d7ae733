"""
Run to the end of the motion that takes accurate steps only as long as large accelerations can come.

If no value came near its largest for a period of the pendulum, the later motion is scanned in steps four times as
large, from the state that the run has reached. If no value comes near its largest in the scan either, the later motion
is left out. Otherwise the run continues from its own state up to a period beyond the large value, and scans the motion
again. If a contact opens, runs with different steps are different motions, so that the run goes to the end in accurate
steps.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial

import numpy as np

from multibody.integration.adaptive import TIME_ROUNDING, Checkpoint, Integration, continue_run
from multibody.integration.constant_step import EngineSolver
from multibody.integration.engine_run import EngineRun, begin_run
from multibody.integration.level import Level
from multibody.models.state import EngineState
from multibody.models.system import EngineModel
from reference.problem import Outcome

# If a scan stays below this share of the largest value so far, the accurate run has no larger value there either.
NEAR_PEAK_FRACTION = 0.8

# If a contact force of a scan falls below this value, in weights, the contact might open in the accurate run.
NEAR_OPENING_FORCE = 0.2

# Time from the last large value to the scan of later motion, in the model's unit of time: one period of the pendulum
QUIET_TIME_BEFORE_SCAN = 2.0 * math.pi


def can_look_ahead(model: EngineModel, level: Level) -> bool:
    """
    Return whether later motion can be searched in larger steps, and the search saves work.

    It cannot where friction depends on heat, and saves nothing where samples of a record are closer than two steps.
    """
    return (
        not (model.friction is not None and model.friction.law.heat)
        and float(np.diff(model.ground.knots).min(initial=math.inf)) >= 2.0 * level.step
    )


def level_of_longest_steps(model: EngineModel, level: Level, whole: bool) -> Level:
    """
    Return the level with the longest steps that a run at `level` takes: those of its search for late peaks, if any.

    whole: whether the run takes accurate steps to the end of the motion, without such a search.
    """
    return level.coarsen() if can_look_ahead(model, level) and not whole else level


def run_with_look_ahead(integration: Integration, start: EngineState) -> EngineRun:
    """Run the engine with adaptive steps, but leave out late motion in which no value comes near its largest."""
    # The maximum in (5.1) needs no accurate motion where the accelerations are small. A scan takes a quarter of the
    # steps, and its error hides no large value: a value counts as near the largest above NEAR_PEAK_FRACTION of it,
    # while the largest values of scans were 0.96 of those in accurate steps at worst (measured on 200 random scenes:
    # docs/records/multibody.md). The scan has a separate result, which starts with that fraction of the largest values,
    # so that every change of this result is a value near the largest. The scan stops at a large value, an opening or a
    # failure. The run then continues from its own checkpoint to a period of the pendulum beyond that instant.
    model, end = integration.solver.model, integration.end
    run, checkpoint = begin_run(model), Checkpoint(start)
    coarse = integration.level.coarsen()
    if not integration.budget.has_work_left_for(end, coarse):
        return run.terminate(Outcome.STEP_LIMIT, 0.0)
    scan = replace(integration, solver=EngineSolver(model, coarse.newton, coarse.residual), level=coarse)
    large_at = 0.0

    def is_quiet(time: float) -> bool:
        """Return whether run and scans had no large value for a period of the pendulum before `time`."""
        return time >= max(large_at, run.last_large_at) + QUIET_TIME_BEFORE_SCAN and not run.has_opened

    while True:
        checkpoint = continue_run(integration, run, checkpoint, pause=is_quiet)
        if run.outcome != Outcome.OK or checkpoint.time >= end * (1.0 - TIME_ROUNDING):
            return run
        ahead = _begin_scan(run, model)
        is_large = partial(_comes_near_largest, ahead, run)
        reached = continue_run(scan, ahead, checkpoint, pause=is_large)
        if ahead.outcome == Outcome.STEP_LIMIT:
            return run.terminate(Outcome.STEP_LIMIT, checkpoint.time)
        if ahead.outcome == Outcome.OK and not is_large(reached.time):
            run.scanned_from = checkpoint.time
            return run
        large_at = reached.time


def _begin_scan(run: EngineRun, model: EngineModel) -> EngineRun:
    """Return an empty result for a search for later peaks, which count above NEAR_PEAK_FRACTION of those of `run`."""
    ahead = begin_run(model)
    ahead.peaks.value[:] = NEAR_PEAK_FRACTION * run.peaks.value
    ahead.max_displacement = NEAR_PEAK_FRACTION * run.max_displacement
    return ahead


def _comes_near_largest(ahead: EngineRun, run: EngineRun, time: float) -> bool:
    """Return whether scan `ahead` nears `run`'s largest accelerations or displacement, or a contact nearly opens."""
    return bool(
        (ahead.peaks.value > NEAR_PEAK_FRACTION * run.peaks.value).any()
        or ahead.max_displacement > NEAR_PEAK_FRACTION * run.max_displacement
        or ahead.has_opened
        or ahead.min_load < NEAR_OPENING_FORCE
    )
