"""
One phase pair to a tolerance: the whole run at successive levels of accuracy, and an error from their differences.

The difference of two levels, at the rate that is seen or at two, is the error of the finer one from step, contact and
Newton's iteration together. Where rounding forbids a stiffer contact the levels share one. One more run with a softer
contact then shows the error that its compliance leaves.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from multibody.integration.adaptive import Budget, EngineRun
from multibody.integration.candidate import Candidate
from multibody.integration.level import COMPLIANCE_RATIO, Level, plan_levels
from multibody.integration.level_runs import UNFINISHED, LevelRuns
from multibody.integration.look_ahead import level_of_longest_steps
from multibody.integration.one_run import PhasePair
from multibody.integration.peak import PeakReader
from multibody.models.system import EngineModel
from reference.problem import Outcome, Scene, State
from reference.problem.ranges import Range

Array = NDArray[np.float64]

MAX_WORK = 2e6  # steps of the engine in all runs of one point, where the caller says nothing else
WORK = Range(1.0, 1e12, "steps")
MAX_DIFFERENT_MOTIONS = 3  # successive levels with impacts that are another motion than the level before


@dataclass(frozen=True)
class Refinement:
    """The result of refinement for one phase pair."""

    peaks: Array  # (N,), m/s^2, NaN without an answer
    errors: Array  # (N,), m/s^2, NaN without an answer
    outcome: Outcome
    instant: float  # s, when an outcome other than ok arose
    finest: EngineRun  # the last run
    coarser: tuple[tuple[EngineRun, float], ...] = ()  # runs whose differences to the last, in these shares, are errors
    floor: float = math.nan  # lower bound of a relative error


def refine(
    scene: Scene,
    model: EngineModel,
    phase: Array,
    tolerance: float,
    *,
    initial: State | None = None,
    keep: bool = False,
    whole: bool = False,
    levels: Sequence[Level] | None = None,
    max_work: float = MAX_WORK,
) -> Refinement:
    """
    Peaks of the absolute accelerations for one phase pair (2,), rad, with a relative error below `tolerance`.

    levels: those of `plan_levels` if None. keep: the motions of the last run and of `coarser`. whole: every run goes to
    the end of the motion, as it does where motions are kept. max_work: steps that all runs together may take.
    """
    pair = PhasePair(scene, model, phase, initial, whole)
    budget, whole = Budget(max_work), keep or whole
    planned = plan_levels(scene, model, tolerance) if levels is None else list(levels)
    if not budget.allows(pair.end, level_of_longest_steps(model, planned[0], whole)):
        no_run = EngineRun(PeakReader(len(model.bodies), model.corner), math.inf, Outcome.STEP_LIMIT, 0.0)
        return _make_no_answer(model, no_run, Outcome.STEP_LIMIT, 0.0)
    done = LevelRuns(pair, tolerance, budget, planned, softens=levels is None, whole=whole, keep=keep)
    different = 0  # how many of the last levels with impacts were another motion
    candidate: Candidate | None = None
    complete: Candidate | None = None  # the last candidate whose error lacks nothing
    best: Candidate | None = None  # the complete candidate whose error is least
    while done.can_go_on():
        run = done.run_next()
        if run.outcome in UNFINISHED:
            if candidate is not None or sum(other.outcome in UNFINISHED for other in done.runs) > 1:
                break
            continue
        candidate = None
        if len(done.runs) == 1 or done.runs[-2].outcome != run.outcome:
            continue
        answered = [] if best is None else [best.run, *(other for other, _ in best.coarser)]
        for earlier in done.runs[:-2]:
            if not any(earlier is other for other in answered):
                earlier.chunks.clear()
        if run.outcome != Outcome.OK:
            break
        candidate = done.make_candidate()
        if done.runs[-1] is not run:  # springs of real bearings change the answer: none before holds
            complete = best = None
        if candidate is None:
            continue
        run = candidate.run
        different = different + 1 if run.impacts and (candidate.errors >= run.peaks.value).all() else 0
        if different == MAX_DIFFERENT_MOTIONS:
            break  # impacts take every level elsewhere: a further one would, too
        if candidate.may_meet(tolerance):
            candidate = candidate.add_compliance_error(pair, budget, keep)
        complete = candidate if candidate.is_complete else complete
        if candidate.meets(tolerance):
            return _make_answer(model, candidate, Outcome.OK)
        rounding = candidate.level.rounding
        if (rounding > np.maximum(tolerance * run.peaks.value, candidate.errors / COMPLIANCE_RATIO)).any():
            if candidate.shares_contact:
                break  # hardly more than rounding is left, and no further level rounds less or shows how little it does
            if best is not None and best.relative_error <= candidate.relative_error:
                return _make_answer(model, best, Outcome.TOLERANCE_NOT_MET)  # rounding takes over at this level
        if candidate.is_complete and (best is None or candidate.relative_error < best.relative_error):
            best = candidate
    if candidate is not None:
        candidate = candidate.add_compliance_error(pair, budget, keep)
        if best is not None and candidate.rounds_more_than(best):
            return _make_answer(model, best, Outcome.TOLERANCE_NOT_MET)
        return _answer_beyond_tolerance(pair, candidate, complete)
    return _refuse_unfinished(pair, done.runs)


def _answer_beyond_tolerance(pair: PhasePair, finest: Candidate, complete: Candidate | None) -> Refinement:
    """The finest answer, whose error misses the tolerance, or the last one whose error is known."""
    if np.isfinite(finest.errors).all():
        return _make_answer(pair.model, finest, Outcome.TOLERANCE_NOT_MET)
    # the run that shows what the compliance leaves has no answer
    if complete is not None:
        answer = _make_answer(pair.model, complete, Outcome.TOLERANCE_NOT_MET)
        return replace(answer, finest=finest.run, coarser=finest.coarser[:-1], floor=finest.floor)
    why = next((run.outcome for run, _ in finest.coarser if run.outcome in UNFINISHED), Outcome.SOLVER_FAILED)
    return _make_no_answer(pair.model, finest.run, why, pair.scene.duration)


def _refuse_unfinished(pair: PhasePair, runs: list[EngineRun]) -> Refinement:
    """No two levels agree, or both end alike: by how the first of the last two that has no answer ends."""
    failed = next((run for run in runs[:-3:-1] if run.outcome != Outcome.OK), None)
    if failed is None:  # one level has an answer, and no steps are left for another that shows its error
        return _make_no_answer(pair.model, runs[-1], Outcome.STEP_LIMIT, pair.scene.duration)
    return _make_no_answer(pair.model, failed, failed.outcome, failed.instant * pair.model.units.time)


def _make_answer(model: EngineModel, candidate: Candidate, outcome: Outcome) -> Refinement:
    """Peaks with their errors, and where the largest of them is if they miss the tolerance."""
    peaks, errors, unit = candidate.run.peaks, candidate.errors, model.units.acceleration
    worst = float(peaks.instant[(errors / peaks.value).argmax()]) * model.units.time
    instant = math.nan if outcome == Outcome.OK else worst
    answered = Refinement(peaks.value * unit, errors * unit, outcome, instant, candidate.run)
    return replace(answered, coarser=candidate.coarser, floor=candidate.floor)


def _make_no_answer(model: EngineModel, run: EngineRun, outcome: Outcome, instant: float) -> Refinement:
    nothing = np.full(len(model.bodies), np.nan)
    return Refinement(nothing, nothing, outcome, instant, run)
