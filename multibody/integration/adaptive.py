"""
Run of the engine with adaptive steps, in chunks, each with the step that the motion needs there.

The engine's own control of the step answers to failed Newton iterations, not to wrong results. Here a chunk is accepted
up to the first step that is larger than `step_control` allows. The run starts again from the stored state there with a
smaller step. The step grows again once the motion allows it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from multibody.integration.constant_step import EngineMotion, EngineSolver
from multibody.integration.engine_run import (
    Budget,
    EngineRun,
    Ground,
    absolute_accelerations,
    begin_run,
    record_steps,
)
from multibody.integration.level import STEP_RATIO, Level
from multibody.integration.openings import Event, Openings
from multibody.integration.step_control import (
    MAX_CHUNK_STEPS,
    MIN_CHUNK_STEPS,
    StepControl,
    gap_rate_at_end,
)
from multibody.integration.termination import find_first_row, find_termination
from multibody.models.friction_springs import ContactChange, FrictionSprings
from multibody.models.recorded import align_steps
from multibody.models.state import EngineState
from reference.problem import Outcome

Array = NDArray[np.float64]

# The largest step is divided so many times by `STEP_RATIO` in the first chunk, in which the contact force settles.
FIRST_DIVISIONS = 2

# Largest ratio of the numbers of steps in a chunk and in the one before, at the largest step or where friction yields.
MAX_CHUNK_GROWTH = 2

# Number of Newton iterations that count as one step of the budget: a step that needs more counts as several.
ITERATIONS_PER_STEP_OF_WORK = 2

# Number of steps at the end of a chunk, on whose accuracy it depends whether the next step may be larger.
RECENT_ROWS = 8

# If a step from sliding fails after DIVISIONS_BEFORE_REST divisions of the largest step, all contacts are put to rest,
# and the run goes on with DIVISIONS_AT_REST: in shorter steps, noise of the contact force makes a larger slip.
DIVISIONS_BEFORE_REST, DIVISIONS_AT_REST = 3, 1

# Number of steps in the first chunk after a contact begins or ends to slide: another contact may change soon after it.
STEPS_AFTER_SLIDING_CHANGE = 4

# Smallest share of a step that is integrated before a contact begins or ends to slide: a shorter one is left out.
MIN_STEP_SHARE = 1e-4

# Relative rounding of time: a run that is within this share of its end has reached it.
TIME_ROUNDING = 1e-12


@dataclass(frozen=True)
class Integration:
    """
    Everything that a run needs: solver, ground motion, duration, level of accuracy and step budget.

    ground: acceleration of the plate. end: duration of the motion, in units of time. budget: steps left to all runs of
    the phase pair. keep: whether the run keeps its motion.
    """

    solver: EngineSolver
    ground: Ground
    end: float
    level: Level
    budget: Budget
    keep: bool = False


@dataclass
class Checkpoint:
    """
    State and step size from which a run continues.

    time: instant, in units of time. divisions: number of divisions of the largest step by `STEP_RATIO`. next_count:
    number of steps in the next chunk at the largest step. rested_at: the instant at which a failed step last put all
    contacts to rest.
    """

    state: EngineState
    time: float = 0.0
    divisions: int = FIRST_DIVISIONS
    next_count: int = MAX_CHUNK_STEPS
    rested_at: float = -1.0


def run_adaptively(integration: Integration, start: EngineState, stop: float = math.inf) -> EngineRun:
    """Run the engine with adaptive steps from the state `start` at time 0 to the end of the motion or to `stop`."""
    run = begin_run(integration.solver.model, stop)
    if not integration.budget.has_work_left_for(min(integration.end, stop), integration.level):
        return run.terminate(Outcome.STEP_LIMIT, 0.0)
    continue_run(integration, run, Checkpoint(start))
    return run


def continue_run(
    integration: Integration,
    run: EngineRun,
    checkpoint: Checkpoint,
    pause: Callable[[float], bool] = lambda time: False,
) -> Checkpoint:
    """Continue a run from a checkpoint to its end, or until `pause(time)` is true; return the last checkpoint."""
    progress = _AdaptiveRun(integration, run, replace(checkpoint))
    end = min(integration.end, run.stop) * (1.0 - TIME_ROUNDING)
    while progress.at.time < end and not pause(progress.at.time):
        if not progress.advance():
            break
    return progress.at


class _AdaptiveRun:
    """Run in progress, which integrates the motion in chunks of equal steps and accepts the accurate steps of each."""

    # A chunk can end in four ways. If the engine cannot solve a step, the chunk is repeated in smaller steps. If a step
    # is larger than the motion allows, the rows before it are accepted, and the run continues there in smaller steps,
    # with the contact force set by the gap alone. If a support opens or closes, the rows before the event are accepted,
    # the event is located, and the run continues behind it. Otherwise all rows are accepted, and the step may grow by
    # one division if the last rows would have allowed that. Every step size is the largest one divided by a power of
    # STEP_RATIO, so that runs of successive levels take comparable steps at the same instants, which their error
    # estimate needs.

    def __init__(self, integration: Integration, run: EngineRun, at: Checkpoint) -> None:
        """Prepare a run that continues from the checkpoint `at` and enters its results in `run`."""
        self.integration, self.run, self.at = integration, run, at
        solver, level = integration.solver, integration.level
        self.model, self.level = solver.model, level
        self.control = StepControl(self.model, level)
        impact = self.model.impact
        self.openings = None if impact is None else Openings(solver, impact, level.penetration)

    def advance(self) -> bool:
        """Integrate one chunk of steps and accept those that are accurate; return whether the run goes on."""
        at, level, springs = self.at, self.level, self.model.springs
        asked, step, count = self._choose_steps()
        motion = self._integrate(step, count)
        if motion is None:
            return self._divide_after_failure()
        size = absolute_accelerations(self.model, motion, self.integration.ground)
        step_ratio = self.control.step_ratio(motion, size, self.run.peaks.value, step, at.state)
        last, failing, event, change = self._find_last_accurate_row(motion, step_ratio)
        before, settle = at.state, failing is not None or change is not None
        if last > 0 and not self._accept_steps(motion.cut_at(last), size[: last + 1], settle=settle):
            return False
        if event is not None:
            return self._pass_event(event, step)
        if springs is not None:
            rates = self._fit_rates_of_limits(springs, motion, last)
            at.state = springs.restart_state(at.state, before, motion.accelerations[last], rates, level.slide_end)
            if change is not None:
                return self._pass_sliding_change(springs, change, step, rates)
        if failing is not None:
            at.divisions += 1 if step_ratio[failing] < STEP_RATIO else 2
            at.divisions = min(at.divisions, level.max_divisions)
        elif not self.integration.solver.stopped:
            self._enlarge_steps(motion, step_ratio, asked)
        return True

    def _find_last_accurate_row(
        self, motion: EngineMotion, step_ratio: Array
    ) -> tuple[int, int | None, Event | None, ContactChange | None]:
        """
        Find the last row up to which a motion is accurate, and what ends the accurate part.

        Returns that row; then the row of a step that is too large, the opening or closing of a contact, and the begin
        or end of a slide, at most one of which is not None.
        """
        failing, last = find_first_row(step_ratio > 1.0), len(motion.time) - 1
        if self.at.divisions >= self.level.max_divisions or failing > last:
            too_large = None
        else:
            too_large, last = failing, max(failing - 1, 0)
        rows = motion.cut_at(last)
        event = None if self.openings is None else self.openings.find_first_event(rows)
        if event is not None:
            return event.row, None, event, None
        change = self._find_sliding_change(rows)
        return (last, too_large, None, None) if change is None else (change.row, None, None, change)

    def _choose_steps(self) -> tuple[int, float, int]:
        """Return the number of steps wanted, and length and number of those to take, which end at record samples."""
        at, level, end, ground = self.at, self.level, self.integration.end, self.model.ground
        at.divisions = max(at.divisions, level.min_divisions(at.time))
        step = level.step / STEP_RATIO**at.divisions
        asked = at.next_count if at.divisions == 0 else self.control.count_small_steps()
        if self.model.springs is not None:
            asked = min(asked, at.next_count)
        asked = min(asked, math.ceil((end - at.time) / step * (1.0 - TIME_ROUNDING)))
        longest = min(step, (end - at.time) / asked)
        return asked, *align_steps(ground.knots, ground.near, at.time, longest, asked)

    def _integrate(self, step: float, count: int) -> EngineMotion | None:
        """Integrate `count` steps and count their work; return None if the engine fails or the budget is exceeded."""
        solver, budget = self.integration.solver, self.integration.budget
        motion = solver.run(self.at.state, self.at.time, step, count)
        work = max(count, solver.newton_iterations / ITERATIONS_PER_STEP_OF_WORK)
        self.run.work += work
        budget.steps_left -= work
        if budget.steps_left < 0.0:
            self.run.terminate(Outcome.STEP_LIMIT, self.at.time)
            return None
        if motion is None or not np.isfinite(motion.accelerations).all():
            return None
        return motion if self.openings is None else self.openings.fill_gaps_of_open_contacts(motion)

    def _divide_after_failure(self) -> bool:
        """Divide the step that the engine could not solve; return whether the run goes on."""
        if self.run.outcome != Outcome.OK:
            return False
        if self.at.divisions >= DIVISIONS_BEFORE_REST and any(self.at.state.sliding):
            # Newton's iteration fails where a slide ends within a step of any length, so the run continues from rest
            springs, state = self.model.springs, self.at.state
            assert springs is not None
            self.at.state = springs.state_at_rest(state)
            self.at.rested_at, self.at.divisions = self.at.time, DIVISIONS_AT_REST
            return True
        if self.at.divisions == self.level.max_divisions:
            self.run.terminate(Outcome.SOLVER_FAILED, self.at.time)
            return False
        self.at.divisions += 1
        return True

    def _accept_steps(self, motion: EngineMotion, size: Array, *, settle: bool = False, read: bool = True) -> bool:
        """
        Accept steps as far as the model is valid, and put the checkpoint there; return whether the run goes on.

        size: absolute accelerations of the bodies, (T, N). settle: whether the contact force is made by the gap alone,
        as smaller steps follow. read: whether peaks are read in these steps.
        """
        outcome, row, instant = find_termination(motion, self.model)
        motion, size = motion.cut_at(row), size[: row + 1]
        if self.integration.keep:
            self.run.chunks.append(motion)
        record_steps(self.run, motion, size, self.model, self.level, read)
        if outcome != Outcome.OK:
            self.run.terminate(outcome, instant)
            return False
        self.at.state, self.at.time = motion.state_at(-1), float(motion.time[-1])
        if settle:
            self.at.state = self.model.settle(self.at.state, gap_rate_at_end(motion), self.level.penetration)
        return True

    def _pass_event(self, event: Event, step: float) -> bool:
        """Integrate to the instant at which a contact opens or closes, and apply it; return whether the run goes on."""
        at, run, openings = self.at, self.run, self.openings
        assert openings is not None
        motion = openings.locate_event(at.state, at.time, step, event)
        self.integration.budget.steps_left -= 1.0
        if motion is not None:
            size = absolute_accelerations(self.model, motion, self.integration.ground)
            if event.closes:
                motion = openings.close_contacts(motion, event.contacts)
            else:
                motion = openings.fill_gaps_of_open_contacts(motion)
            # no peak is read in so short a step, because contact forces have not settled at its end
            if not self._accept_steps(motion, size, read=False):
                return False
        if event.closes:
            run.peaks.read_until(at.time)
            at.state = openings.apply_impact(at.state, at.time, event.contacts)
            run.peaks_count_from, run.impacts = openings.settled_at, openings.impacts
            run.peaks.restart()
            at.divisions = max(at.divisions, self.control.count_divisions_behind_impact())
        else:
            openings.open_contacts(event)
        at.next_count = MIN_CHUNK_STEPS
        return True

    def _find_sliding_change(self, motion: EngineMotion) -> ContactChange | None:
        """Find the first contact that begins or ends to slide; return None if there is none or friction is rigid."""
        springs = self.model.springs
        if springs is None:
            return None
        end = math.inf if self.at.rested_at == self.at.time else self.level.slide_end
        return springs.find_sliding_change(motion, self.at.state, self.level.slide_end, end)

    def _fit_rates_of_limits(self, springs: FrictionSprings, motion: EngineMotion, row: int) -> Array:
        """Return the rates of change (K,), at `row`, of the elastic displacements at which the contacts slide."""
        near = motion.cut_at(max(row, 1))
        recent = EngineMotion(*[column[-RECENT_ROWS:] for column in near])
        slope: Array = np.polyfit(recent.time - recent.time[-1], springs.limits(recent), 1)[0]
        return slope

    def _pass_sliding_change(self, springs: FrictionSprings, change: ContactChange, step: float, rates: Array) -> bool:
        """Integrate up to the instant at which a contact begins or ends to slide; return whether the run goes on."""
        at, solver, before = self.at, self.integration.solver, self.at.state
        self.integration.budget.steps_left -= 1.0
        length = change.step_share * step
        motion = solver.run(before, at.time, length, 1) if length > MIN_STEP_SHARE * step else None
        if motion is not None and np.isfinite(motion.accelerations).all():
            # no peak is read in this step: the next chunk reads the acceleration just after the change of sliding
            size = absolute_accelerations(self.model, motion, self.integration.ground)
            if not self._accept_steps(motion, size, settle=True, read=False):
                return False
            at.state = springs.restart_state(at.state, before, motion.accelerations[-1], rates, self.level.slide_end)
            if change.slides:
                change = change._replace(limits=springs.limits(motion)[-1])
        reached = at.state
        assert reached.accelerations is not None  # set by restart_state, here or at an earlier change of sliding
        at.state = springs.restart_state(reached, reached, reached.accelerations, rates, self.level.slide_end, change)
        self.run.peaks.restart()
        at.next_count = STEPS_AFTER_SLIDING_CHANGE
        return True

    def _enlarge_steps(self, motion: EngineMotion, step_ratio: Array, asked: int) -> None:
        """
        Enlarge the step if recent steps allow it; at its largest size, choose the number of steps in the next chunk.

        asked: number of steps that were wanted for this chunk.
        """
        # The next chunk grows from the number of steps asked for, not from a smaller one that ended at a sample of the
        # record: otherwise one short chunk would make the next ones short, and restarts cost accuracy.
        at = self.at
        before = asked if at.divisions == 0 else min(asked, MIN_CHUNK_STEPS)
        if at.divisions > 0 and step_ratio[-RECENT_ROWS:].max() * STEP_RATIO < 1.0:
            at.divisions -= 1
        if at.divisions == 0 or self.model.springs is not None:
            at.next_count = min(self.control.count_largest_steps(motion), MAX_CHUNK_GROWTH * before)
