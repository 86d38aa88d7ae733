"""
A run to the end of the motion that integrates in full only as long as anything large can come.

Once nothing came near a largest value for a while, the rest of the motion is scanned in steps four times as large, from
the state that the run has reached. If nothing comes near a largest value there either, the rest is left out. Otherwise
the run goes on from where it was, for a while beyond the instant that was found, and looks ahead again. Where a contact
opens, motions of different steps are different motions: such a run goes to the end in full.
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

# Share of a largest value: in larger steps later values below it are no larger ones of the run either.
NEAR_FRACTION = 0.8

# Share of the weight: with less on the contact in larger steps it might open in the run.
NEAR_LOAD = 0.2

# Time from the last large value to a look ahead, in units of time: a period of the pendulum.
WAIT = 2.0 * math.pi


def can_look_ahead(model: EngineModel, level: Level) -> bool:
    """Return whether larger steps save work: they end at knots of a record in any case, and heat remembers one run."""
    return (
        not (model.friction is not None and model.friction.law.heat)
        and float(np.diff(model.ground.knots).min(initial=math.inf)) >= 2.0 * level.step
    )


def level_of_longest_steps(model: EngineModel, level: Level, whole: bool) -> Level:
    """Return the level of the longest steps in a run; whole: it takes its own steps to the end of the motion."""
    return level.coarsen() if can_look_ahead(model, level) and not whole else level


def run_with_look_ahead(integration: Integration, start: EngineState) -> EngineRun:
    """Run as `run_adaptively` does, without the steps of a part in which nothing comes near a largest value."""
    # The maximum in (5.1) needs no accurate motion where the accelerations are small. A scan costs a quarter of the
    # steps, and its error hides no large value: values count as near from NEAR_FRACTION of the largest on, and the
    # largest values of scans fell to 0.96 of those of the level's own steps at worst (measured on 200 random scenes:
    # docs/records/multibody.md). The scan has a result of its own, which starts with that fraction, so that whatever it
    # changes came near. It stops where something large comes, opens or fails. The run then goes on from its own
    # checkpoint, up to a period of the pendulum behind that instant, and the question is put again.
    model, end = integration.solver.model, integration.end
    run, checkpoint = begin_run(model), Checkpoint(start)
    coarse = integration.level.coarsen()
    if not integration.budget.allows(end, coarse):
        return run.terminate(Outcome.STEP_LIMIT, 0.0)
    scan = replace(integration, solver=EngineSolver(model, coarse.newton, coarse.residual), level=coarse)
    large_at = 0.0

    def is_quiet(time: float) -> bool:
        """Return whether nothing large came for a while, in the run or in a scan."""
        return time >= max(large_at, run.last_large) + WAIT and not run.opened

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
    """Return a run that starts with what is nearly as large as in `run`: what it changes came near that."""
    ahead = begin_run(model)
    ahead.peaks.value[:] = NEAR_FRACTION * run.peaks.value
    ahead.max_displacement = NEAR_FRACTION * run.max_displacement
    return ahead


def _comes_near_largest(ahead: EngineRun, run: EngineRun, time: float) -> bool:
    """Return whether a run ahead, at `time`, came near a largest value of `run`, or near the opening of a contact."""
    return bool(
        (ahead.peaks.value > NEAR_FRACTION * run.peaks.value).any()
        or ahead.max_displacement > NEAR_FRACTION * run.max_displacement
        or ahead.opened
        or ahead.min_load < NEAR_LOAD
    )
