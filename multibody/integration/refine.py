"""
Refinement of one phase pair to a tolerance: runs at successive levels, and an error from their differences.

The difference of two levels gives the error of the finer one by step, contact and Newton's iteration together, at the
rate of convergence that three levels show or at a rate of two. Where rounding forbids a stiffer contact, levels share
one stiffness, and one more run on a softer contact shows the error by the contact's compliance.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from multibody.integration.candidate import Candidate
from multibody.integration.engine_run import Budget, EngineRun
from multibody.integration.level import Level, plan_levels
from multibody.integration.level_runs import UNFINISHED_OUTCOMES, LevelRuns
from multibody.integration.look_ahead import level_of_longest_steps
from multibody.integration.one_run import PhasePair
from multibody.integration.peak import PeakReader
from multibody.models.system import EngineModel
from reference.problem import Outcome
from reference.support.arguments import Range

Array = NDArray[np.float64]

# Default limit of engine steps in all runs of a phase pair: beyond it the pair misses the tolerance or has no values.
MAX_WORK = 2e6
WORK_RANGE = Range(1.0, 1e12, "steps")  # admissible values of max_work, the limit of steps that a caller may give

# Refinement ends after so many successive levels whose motions, because of impacts, differ from the level before.
MAX_DIFFERENT_MOTIONS = 3

# Smallest number of levels for an error estimate where friction yields. How the platform oscillates on its springs
# depends on short slides, which may occur at one level and not at the next: levels 0 and 1 may agree and both be wrong
# (measured: by seven times the error that their difference shows; the error of level 2 was 17 times smaller).
MIN_LEVELS_OF_YIELDING = 3


@dataclass(frozen=True)
class Refinement:
    """
    Peaks, errors and outcome of one phase pair, with the runs that they come from.

    Attributes:
    - peaks, errors: Largest absolute accelerations and their errors, m/s^2, (N,); NaN without an answer.
    - outcome, instant: Outcome, and the instant, s, at which an outcome other than ok arose.
    - finest: The run at the last level.
    - coarser: Other runs, each with the share of its difference to the last run that is an error.
    - floor: Lower bound of the relative error of any number of the run.
    """

    peaks: Array
    errors: Array
    outcome: Outcome
    instant: float
    finest: EngineRun
    coarser: tuple[tuple[EngineRun, float], ...] = ()
    floor: float = math.nan


def refine(
    pair: PhasePair,
    tolerance: float,
    *,
    keep: bool = False,
    levels: Sequence[Level] | None = None,
    max_work: float = MAX_WORK,
) -> Refinement:
    """
    Compute the peaks of the absolute accelerations for one phase pair with a relative error below `tolerance`.

    keep: whether the motions of the last run and of `coarser` are kept; every run then goes to the end of the motion.
    levels: levels of accuracy; None takes those of `plan_levels`. max_work: steps that all runs together may take.
    """
    model, budget, whole = pair.model, Budget(max_work), keep or pair.in_full
    planned = plan_levels(pair.scene, model, tolerance) if levels is None else list(levels)
    if not budget.has_work_left_for(pair.end, level_of_longest_steps(model, planned[0], whole)):
        no_peaks = PeakReader(len(model.bodies), model.corner)
        no_run = EngineRun(peaks=no_peaks, stop=math.inf, outcome=Outcome.STEP_LIMIT, instant=0.0)
        return _make_no_answer(model, no_run, Outcome.STEP_LIMIT, 0.0)
    search = _AnswerSearch(LevelRuns(pair, tolerance, budget, planned, may_soften_contact=levels is None, keep=keep))
    while not search.has_ended and search.runs.can_run_next():
        search.add_level()
    return search.answer or search.make_last_answer()


class _AnswerSearch:
    """
    Search among the levels of accuracy for peaks of one phase pair that meet the tolerance.

    candidate: answer of the last level, if it has one. complete: the last answer whose error misses no part. best: the
    complete answer with the smallest error. different_motions: number of the last levels with impacts that were another
    motion than the level before. answer: final answer, if the search ends before the levels do.
    """

    # Levels are added until one meets the tolerance, or until no further level can help. Three cases end the search
    # early. Two runs do not reach their end, or one run does not after an answer: a finer run takes even more steps.
    # Three levels in a row are different motions because of impacts: the order in which supports close depends on
    # rounding, at any step. Rounding exceeds both the tolerance and the error that the next level would leave: a
    # stiffer contact rounds more. The best complete answer with its error is then returned, with the outcome "tolerance
    # not met". Other springs under the supports make another model, so that the answers before a change of springs are
    # forgotten.

    def __init__(self, runs: LevelRuns) -> None:
        """Start a search without an answer among the levels of `runs`."""
        self.runs, self.tolerance = runs, runs.tolerance
        self.candidate: Candidate | None = None
        self.complete: Candidate | None = None
        self.best: Candidate | None = None
        self.answer: Refinement | None = None
        self.different_motions = 0
        self.has_ended = False

    def add_level(self) -> None:
        """Run the next level, and decide by its peaks and errors, if any, whether the search ends."""
        run = self.runs.run_next_level()
        done = self.runs.runs
        if run.outcome in UNFINISHED_OUTCOMES:
            unfinished = sum(other.outcome in UNFINISHED_OUTCOMES for other in done)
            self.has_ended = self.candidate is not None or unfinished > 1
            return
        self.candidate = None
        if len(done) == 1 or done[-2].outcome != run.outcome:
            return
        self._forget_motions()
        if run.outcome != Outcome.OK:
            self.has_ended = True
            return
        if self.runs.pair.model.springs is not None and len(done) < MIN_LEVELS_OF_YIELDING:
            return
        self.candidate = self.runs.make_candidate()
        if done[-1] is not run:  # a run on supports as stiff as real bearings has replaced `run`
            self.complete = self.best = None
        if self.candidate is not None:
            self._judge(self.candidate)

    def make_last_answer(self) -> Refinement:
        """Return peaks that miss the tolerance, or a result without values and with the outcome that says why."""
        pair = self.runs.pair
        if self.candidate is None:
            return _refuse_unfinished(pair, self.runs.runs)
        candidate = self._complete(self.candidate)
        if self.best is not None and candidate.is_worse_by_rounding(self.best):
            return _make_answer(pair.model, self.best, Outcome.TOLERANCE_NOT_MET)
        return _answer_beyond_tolerance(pair, candidate, self.complete)

    def _judge(self, candidate: Candidate) -> None:
        """Decide whether the answer of the last level ends the search, and which one is best so far."""
        run, model, best = candidate.run, self.runs.pair.model, self.best
        differs = bool(run.impacts) and bool((candidate.errors >= run.peaks.value).all())
        self.different_motions = self.different_motions + 1 if differs else 0
        if self.different_motions == MAX_DIFFERENT_MOTIONS:
            self.has_ended = True
            return
        if candidate.may_meet(self.tolerance):
            self.candidate = candidate = self._complete(candidate)
        self.complete = candidate if candidate.is_complete else self.complete
        if candidate.meets(self.tolerance):
            self._end_with(_make_answer(model, candidate, Outcome.OK))
            return
        if candidate.is_limited_by_rounding(self.tolerance):
            if candidate.shares_contact:
                self.has_ended = True
                return
            if best is not None and best.relative_error <= candidate.relative_error:
                self._end_with(_make_answer(model, best, Outcome.TOLERANCE_NOT_MET))
                return
        if candidate.is_complete and (best is None or candidate.relative_error < best.relative_error):
            self.best = candidate

    def _end_with(self, answer: Refinement) -> None:
        """End the search with this answer: no further level runs."""
        self.answer, self.has_ended = answer, True

    def _complete(self, candidate: Candidate) -> Candidate:
        """Return a candidate with the error by the contact's compliance, which may take one more run."""
        return candidate.add_compliance_error(self.runs.pair, self.runs.budget, self.runs.keep)

    def _forget_motions(self) -> None:
        """Delete the stored motions of all runs but the last two and those of the best answer."""
        needed = [] if self.best is None else [self.best.run, *(other for other, _ in self.best.coarser)]
        for earlier in self.runs.runs[:-2]:
            if not any(earlier is other for other in needed):
                earlier.chunks.clear()


def _answer_beyond_tolerance(pair: PhasePair, finest: Candidate, complete: Candidate | None) -> Refinement:
    """Return the peaks of the finest level, whose error misses the tolerance, or the last whose error is known."""
    if np.isfinite(finest.errors).all():
        return _make_answer(pair.model, finest, Outcome.TOLERANCE_NOT_MET)
    # the run that would show the error by the contact's compliance has no answer
    if complete is not None:
        answer = _make_answer(pair.model, complete, Outcome.TOLERANCE_NOT_MET)
        return replace(answer, finest=finest.run, coarser=finest.coarser[:-1], floor=finest.floor)
    why = next((run.outcome for run, _ in finest.coarser if run.outcome in UNFINISHED_OUTCOMES), Outcome.SOLVER_FAILED)
    return _make_no_answer(pair.model, finest.run, why, pair.scene.duration)


def _refuse_unfinished(pair: PhasePair, runs: list[EngineRun]) -> Refinement:
    """Return a result without values, with the outcome of the last run, or of the one before if the last is OK."""
    failed = next((run for run in runs[:-3:-1] if run.outcome != Outcome.OK), None)
    if failed is None:  # one level has an answer, and no steps are left for another that shows its error
        return _make_no_answer(pair.model, runs[-1], Outcome.STEP_LIMIT, pair.scene.duration)
    return _make_no_answer(pair.model, failed, failed.outcome, failed.instant * pair.model.units.time)


def _make_answer(model: EngineModel, candidate: Candidate, outcome: Outcome) -> Refinement:
    """Return peaks with their errors; if they miss the tolerance, also the instant of the least accurate peak."""
    peaks, errors, unit = candidate.run.peaks, candidate.errors, model.units.acceleration
    worst = float(peaks.instant[(errors / peaks.value).argmax()]) * model.units.time
    instant = math.nan if outcome == Outcome.OK else worst
    answer = Refinement(peaks.value * unit, errors * unit, outcome, instant, candidate.run)
    return replace(answer, coarser=candidate.coarser, floor=candidate.floor)


def _make_no_answer(model: EngineModel, run: EngineRun, outcome: Outcome, instant: float) -> Refinement:
    """Return a refinement without peaks (NaN), with the outcome and the instant that ended it."""
    nothing = np.full(len(model.bodies), np.nan)
    return Refinement(nothing, nothing, outcome, instant, run)
