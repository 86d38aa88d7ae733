"""
A run to the end of the motion that integrates in full only as long as anything large can come.

Once nothing came near a largest value for a while, the rest of the motion is looked over in steps four times as large,
from the state that the run has reached. If nothing comes near a largest value there either, the rest is left out.
Otherwise the run goes on from where it was, for a while beyond the instant that was found, and looks ahead again.
Where a contact opens, motions of different steps are different motions: such a run goes to the end in full.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from multibody.integration.adaptive import Budget, EngineRun, Checkpoint, begin_run, continue_run
from multibody.integration.constant_step import EngineSolver
from multibody.integration.level import Level
from multibody.models.state import EngineState
from multibody.models.system import EngineModel
from reference.problem import Outcome

Array = NDArray[np.float64]

NEAR_FRACTION = 0.8  # of a largest value: in larger steps later values below it are no larger ones of the run either
NEAR_LOAD = 0.2  # of the weight: with less on the contact in larger steps it might open in the run
WAIT = 2.0 * math.pi  # units of time from the last large value to a look ahead: a period of the pendulum


def can_look_ahead(model: EngineModel, level: Level) -> bool:
    """Whether larger steps save work: they end at the knots of a record in any case, and heat remembers one run."""
    return (
        not (model.friction is not None and model.friction.law.heat)
        and float(np.diff(model.ground.knots).min(initial=math.inf)) >= 2.0 * level.step
    )


def level_of_longest_steps(model: EngineModel, level: Level, whole: bool) -> Level:
    """The level of the longest steps in a run; whole: it takes its own steps to the end of the motion."""
    return level.coarsen() if can_look_ahead(model, level) and not whole else level


def run_with_look_ahead(
    engine: EngineSolver, start: EngineState, end: float, ground: Callable[[Array], Array], level: Level, budget: Budget
) -> EngineRun:
    """As `run_adaptively`, without the steps of a part in which nothing comes near a largest value."""
    result, place = begin_run(engine.model), Checkpoint(start)
    scan = level.coarsen()
    if not budget.allows(end, scan):
        return result.terminate(Outcome.STEP_LIMIT, 0.0)
    scanning = EngineSolver(engine.model, scan.newton, scan.residual)
    large_at = 0.0  # the last instant at which a look ahead found something large

    def is_quiet(time: float) -> bool:
        return time >= max(large_at, result.settled) + WAIT and not result.opened

    while True:
        place = continue_run(result, place, engine, end, ground, level, budget, pause=is_quiet)
        if result.outcome != Outcome.OK or place.time >= end * (1.0 - 1e-12):
            return result
        ahead = _begin_scan(result, engine.model)
        large = partial(_comes_near_largest, ahead, result)
        reached = continue_run(ahead, place, scanning, end, ground, scan, budget, pause=large)
        if ahead.outcome == Outcome.STEP_LIMIT:
            return result.terminate(Outcome.STEP_LIMIT, place.time)
        if ahead.outcome == Outcome.OK and not large(reached.time):
            result.scanned_from = place.time
            return result
        large_at = reached.time


def _begin_scan(result: EngineRun, model: EngineModel) -> EngineRun:
    """A run that starts with what is nearly as large as in `result`: what it changes came near that."""
    ahead = begin_run(model)
    ahead.peaks.value[:] = NEAR_FRACTION * result.peaks.value
    ahead.max_displacement = NEAR_FRACTION * result.max_displacement
    return ahead


def _comes_near_largest(ahead: EngineRun, result: EngineRun, time: float) -> bool:
    """Whether a run ahead, at `time`, came near a largest value of `result`, or near the opening of a contact."""
    return bool(
        (ahead.peaks.value > NEAR_FRACTION * result.peaks.value).any()
        or ahead.max_displacement > NEAR_FRACTION * result.max_displacement
        or ahead.opened
        or ahead.min_load < NEAR_LOAD
    )
