"""
One phase pair to a tolerance: the whole run at successive levels of accuracy, and an error from their differences.

The difference of two levels, at the rate that is seen or at two, is the error of the finer one from step, contact and
Newton's iteration together. Where rounding forbids a stiffer contact the levels share one. One more run with a softer
contact then shows the error that its compliance leaves.

The first run shows when the last large value comes (`look_ahead`). Runs at further levels stop soon after it, as long
as they differ from the run before by much less than what separates later values from the largest.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from multibody.integration.adaptive import SETTLED_FRACTION, Budget, EngineRun
from multibody.integration.estimate import (
    ERROR_PER_WARPING_LOAD,
    SAFETY_OF_ROUNDING,
    from_compliance,
    from_levels,
    from_rounding,
    from_sharing,
    measured_per_load,
    share_of_change,
    widened_by_impacts,
    widened_without_convergence,
)
from multibody.integration.level import (
    COMPLIANCE_RATIO,
    MAX_COMPLIANCE_OF_CLOSED,
    REAL_WARPING_COMPLIANCE,
    Level,
    for_small_peaks,
    levels_of,
)
from multibody.integration.look_ahead import longest_steps
from multibody.integration.one_run import PhasePair
from multibody.integration.peak import Peaks
from multibody.models.system import EngineModel
from reference.problem import Outcome, Scene, State
from reference.problem.ranges import Range

Array = NDArray[np.float64]

MAX_WORK = 2e6  # steps of the engine in all runs of one point, where the caller says nothing else
WORK = Range(1.0, 1e12, "steps")
UNFINISHED = (Outcome.STEP_LIMIT, Outcome.SOLVER_FAILED)
MAX_WARPING_ERROR_SHARE = 0.2  # of the tolerance, that the load of warped supports may take as an error
MAX_FIRST_SHARE = 0.2  # of the work of a point, that its first run may take where supports may rattle
MAX_WORK_GROWTH = 2.0  # steps of a level over those of the level before
STEPS_AFTER_SETTLING = 20.0  # largest steps from the last large value of a run to the end of the next
# change between two levels over what separates later values from the largest: beyond it a run goes to the end after all
MAX_EARLY_CHANGE = 0.2
MAX_DIFFERENT_MOTIONS = 3  # successive levels with impacts that are another motion than the level before
# of the first run from the rim, in rho, and the end of its travel, and contact force, in weights: closer, all go to the
# end
MIN_END_MARGIN = 0.1


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

    levels: those of `levels_of` if None. keep: the motions of the last run and of `coarser`. whole: every run goes to
    the end of the motion, as it does where motions are kept. max_work: steps that all runs together may take.
    """
    pair = PhasePair(scene, model, phase, initial, whole)
    budget = Budget(max_work)
    remaining = levels_of(scene, model, tolerance) if levels is None else list(levels)
    if not budget.allows(pair.end, longest_steps(model, remaining[0], keep or whole)):
        no_run = EngineRun(Peaks(len(model.bodies), model.corner), math.inf, Outcome.STEP_LIMIT, 0.0)
        return _no_answer(model, no_run, Outcome.STEP_LIMIT, 0.0)
    runs: list[EngineRun] = []
    different = 0  # how many of the last levels with impacts were another motion
    softest = MAX_COMPLIANCE_OF_CLOSED  # compliance against warping that supports may have
    per_load: Array | None = None  # see `measured_per_load`, once it is measured
    # change of the peaks, (N,), on springs of real bearings, once supports opened on stiffer ones
    of_springs: Array | None = None
    stop = math.inf  # of the next run, where nothing later can matter
    candidate: _Candidate | None = None
    complete: _Candidate | None = None  # the last candidate whose error lacks nothing
    best: _Candidate | None = None  # the last candidate before rounding takes over
    for number in range(len(remaining)):
        level = remaining[number]
        shared = number > 0 and level.penetration >= remaining[number - 1].penetration
        # a run more completes the error of a contact that stays the same
        if runs and budget.left < _work_of_next(runs[-1], stop, pair.end) * (1.0 + shared):
            break
        rattles = number == 0 and model.warping_displacement is not None
        run = _trial_run(pair, level, budget, keep) if rattles else pair.at_level(level, budget, stop, keep=keep)
        if stop < pair.end and not _stays_settled(run, runs[-1]):
            stop = math.inf
            run = pair.at_level(level, budget, keep=keep)
        rattles = rattles and run.outcome == Outcome.STEP_LIMIT
        if (rattles or run.lifts_off) and level.warping_compliance != REAL_WARPING_COMPLIANCE and of_springs is None:
            real, of_springs = _run_on_real_bearings(pair, level, run, budget, keep)
            stiff = level.warping_compliance < REAL_WARPING_COMPLIANCE
            # stiff springs also lift supports off by the misfit of the platform alone
            if not (stiff and real.lifts_off) or (of_springs > tolerance * run.peaks.value).any():
                softest = softest if stiff else REAL_WARPING_COMPLIANCE
                remaining[number:] = [_on_real_bearings(later) for later in remaining[number:]]
                run, level, stop, of_springs = real, remaining[number], math.inf, None
        if level.warping_compliance == REAL_WARPING_COMPLIANCE:
            of_springs = None
        runs.append(run)
        if run.outcome == Outcome.OK and run.stop == math.inf and not (keep or whole):
            stop = _settled(run, model, remaining[0].step)
        if run.outcome in UNFINISHED:
            if candidate is not None or sum(other.outcome in UNFINISHED for other in runs) > 1:
                break
            continue
        candidate = None
        if run.lifts_off:
            softest = REAL_WARPING_COMPLIANCE
        remaining[number + 1 :] = [
            _sharing(later, run.warping_load, tolerance, softest) for later in remaining[number + 1 :]
        ]
        # a softer contact would let a platform that turns tilt
        if levels is None and run.outcome == Outcome.OK and model.depressions is None:
            smallest = float(run.peaks.value.min())
            remaining[number + 1 :] = [for_small_peaks(later, smallest, tolerance) for later in remaining[number + 1 :]]
        if number == 0 or runs[-2].outcome != run.outcome:
            continue
        for earlier in runs[:-2]:
            earlier.chunks.clear()
        if run.outcome != Outcome.OK:
            break
        finished = [other.peaks for other in runs[-3:] if other.outcome == Outcome.OK]
        compliances = [other.warping_compliance for other in remaining[max(number - 2, 0) : number + 1]]
        if softest == REAL_WARPING_COMPLIANCE and compliances[0] != compliances[-2]:
            finished = finished[-2:]
        errors = from_levels(finished, remaining[: number + 1], model)
        rounding = from_rounding(run.peaks, level, runs[-2].peaks, remaining[number - 1])
        rounding = widened_by_impacts(errors + rounding, run, number)
        errors = widened_by_impacts(errors, run, number)
        rounding -= errors
        if not run.lifts_off:
            allowed = tolerance * run.peaks.value - errors
            # no softer springs are left, and sharing alone misses the tolerance
            capped = level.warping_compliance >= softest and (allowed >= 0.0).all()
            if per_load is None and capped and (from_sharing(run, None) > allowed).any():
                per_load = _measured_sharing(pair, level, run, budget)
            errors = errors + from_sharing(run, per_load)
        if of_springs is not None and (errors + of_springs <= tolerance * run.peaks.value).all():
            real, change = _run_on_real_bearings(pair, level, run, budget, keep)
            of_springs = np.maximum(of_springs, change)
            if real.outcome not in UNFINISHED and (of_springs > tolerance * run.peaks.value).any():
                remaining[number:] = [_on_real_bearings(later) for later in remaining[number:]]
                runs[-1], stop, of_springs = real, math.inf, None
                continue
        if of_springs is not None:
            errors = errors + of_springs
        before = (runs[-2], share_of_change(remaining[number - 1], model))
        candidate = _Candidate(run, errors, rounding, level, (before,), lacks_compliance=shared)
        different = different + 1 if run.impacts and (candidate.errors >= run.peaks.value).all() else 0
        if different == MAX_DIFFERENT_MOTIONS:
            break  # impacts take every level elsewhere: a further one would, too
        if (errors <= tolerance * run.peaks.value).all():
            candidate = candidate.completed(pair, budget, keep)
        complete = candidate if candidate.is_complete else complete
        if candidate.meets(tolerance):
            return _answer(model, candidate, Outcome.OK)
        rounded = level.rounding > np.maximum(tolerance * run.peaks.value, candidate.errors / COMPLIANCE_RATIO)
        if rounded.any() and shared:
            break  # hardly more than rounding is left, and no further level rounds less or shows how little it does
        if rounded.any() and best is not None and best.relative_error <= candidate.relative_error:
            return _answer(model, best, Outcome.TOLERANCE_NOT_MET)  # rounding takes over at this level
        best = candidate if candidate.is_complete else None
    if candidate is not None:
        return _beyond_tolerance(pair, candidate.completed(pair, budget, keep), complete)
    return _unfinished(pair, runs)


def _work_of_next(run: EngineRun, stop: float, end: float) -> float:
    """Steps of the run at the level after that of `run`, up to `stop`."""
    own = min(run.looked_over, end)  # both runs look over what comes later
    shorter = min(stop, own) / min(run.stop, own) if run.outcome == Outcome.OK else 1.0
    return MAX_WORK_GROWTH * shorter * run.steps


def _settled(run: EngineRun, model: EngineModel, step: float) -> float:
    """When runs at further levels may stop, after one to the end of the motion; step: the largest of any level."""
    limit = (1.0 - MIN_END_MARGIN) * min(model.rim, model.travel)
    if run.max_displacement > limit or run.min_load < MIN_END_MARGIN:
        return math.inf
    return run.settled + STEPS_AFTER_SETTLING * step


def _stays_settled(run: EngineRun, before: EngineRun) -> bool:
    """Whether a run that stopped early agrees so well with the one before that nothing later can matter."""
    if run.outcome != Outcome.OK:
        return False
    largest = np.array([*run.peaks.value, run.max_displacement])
    change = np.abs(largest - [*before.peaks.value, before.max_displacement])
    return bool((change <= MAX_EARLY_CHANGE * (1.0 - SETTLED_FRACTION) * largest).all())


@dataclass(frozen=True)
class _Candidate:
    """The answer of one level."""

    run: EngineRun
    level_errors: Array  # (N,), errors that other levels and the load of warping show, in units of the model
    rounding: Array  # likewise, that rounding of the contact forces leaves
    level: Level
    coarser: tuple[tuple[EngineRun, float], ...]  # other runs, and the share of their difference to this one
    lacks_compliance: bool  # whether the error that the contact's compliance leaves is still missing
    compliance: float | Array = 0.0  # that error, (N,)

    @property
    def errors(self) -> Array:
        """Errors (N,), in units of the model."""
        return widened_without_convergence(self.level_errors + self.rounding, self.run) + self.compliance

    @property
    def is_complete(self) -> bool:
        """Whether the error lacks nothing."""
        return not self.lacks_compliance and bool(np.isfinite(self.errors).all())

    @property
    def relative_error(self) -> float:
        return float((self.errors / self.run.peaks.value).max())

    def meets(self, tolerance: float) -> bool:
        return bool((self.errors <= tolerance * self.run.peaks.value).all())

    def completed(self, pair: PhasePair, budget: Budget, keep: bool) -> _Candidate:
        """With the error that the compliance leaves, from a run in which nothing but the contact is softer."""
        if not self.lacks_compliance:
            return self
        level, softer = self.level, replace(self.level, penetration=COMPLIANCE_RATIO * self.level.penetration)
        run = pair.at_level(softer, budget, self.run.stop, keep=keep, residual=level.residual)
        completed = replace(
            self,
            compliance=from_compliance(self.run.peaks, run, softer, pair.model),
            coarser=(*self.coarser, (run, share_of_change(softer, pair.model))),
            lacks_compliance=False,
        )
        if run.outcome != Outcome.OK:
            return completed
        rounding = from_rounding(self.run.peaks, level, run.peaks, softer, SAFETY_OF_ROUNDING)
        return replace(completed, rounding=np.minimum(self.rounding, rounding))


def _beyond_tolerance(pair: PhasePair, finest: _Candidate, complete: _Candidate | None) -> Refinement:
    """The finest answer, whose error misses the tolerance, or the last one whose error is known."""
    if np.isfinite(finest.errors).all():
        return _answer(pair.model, finest, Outcome.TOLERANCE_NOT_MET)
    # the run that shows what the compliance leaves has no answer
    if complete is not None:
        answer = _answer(pair.model, complete, Outcome.TOLERANCE_NOT_MET)
        return replace(answer, finest=finest.run, coarser=finest.coarser[:1], floor=finest.level.error_floor)
    return _no_answer(pair.model, finest.run, Outcome.SOLVER_FAILED, pair.scene.duration)


def _unfinished(pair: PhasePair, runs: list[EngineRun]) -> Refinement:
    """No two levels agree, or both end alike: by how the first of the last two that has no answer ends."""
    failed = next((run for run in runs[:-3:-1] if run.outcome != Outcome.OK), None)
    if failed is None:  # one level has an answer, and no steps are left for another that shows its error
        return _no_answer(pair.model, runs[-1], Outcome.STEP_LIMIT, pair.scene.duration)
    return _no_answer(pair.model, failed, failed.outcome, failed.instant * pair.model.units.time)


def _on_real_bearings(level: Level) -> Level:
    """A level whose supports give way against warping as real bearings do."""
    return replace(level, warping_compliance=REAL_WARPING_COMPLIANCE)


def _run_on_real_bearings(
    pair: PhasePair, level: Level, run: EngineRun, budget: Budget, keep: bool
) -> tuple[EngineRun, Array]:
    """The run of a level on springs of real bearings, and by how much its peaks, (N,), differ from those of `run`."""
    real = pair.at_level(_on_real_bearings(level), budget, keep=keep)
    if real.outcome in UNFINISHED:
        return real, run.peaks.value  # nothing is known
    if real.outcome != run.outcome:
        return real, np.full_like(run.peaks.value, np.inf)
    return real, np.abs(run.peaks.value - real.peaks.value)


def _trial_run(pair: PhasePair, level: Level, budget: Budget, keep: bool) -> EngineRun:
    """The first run of a model whose supports may rattle, with a share of the work."""
    trial = Budget(MAX_FIRST_SHARE * budget.left)
    budget.left -= trial.left
    run = pair.at_level(level, trial, keep=keep)
    budget.left += trial.left
    return run


def _measured_sharing(pair: PhasePair, level: Level, run: EngineRun, budget: Budget) -> Array:
    """What the load of warping does to the peaks of `run`, (N,), from a run that warps less easily."""
    stiffer = replace(level, warping_compliance=level.warping_compliance / COMPLIANCE_RATIO)
    return measured_per_load(run, pair.at_level(stiffer, budget, run.stop))


def _sharing(level: Level, load: float, tolerance: float, softest: float) -> Level:
    """A level whose supports give way enough against warping, which took `load` of the weight in the run before."""
    wanted = level.warping_compliance * load * ERROR_PER_WARPING_LOAD / (MAX_WARPING_ERROR_SHARE * tolerance)
    return replace(level, warping_compliance=min(max(wanted, level.warping_compliance), softest))


def _answer(model: EngineModel, candidate: _Candidate, outcome: Outcome) -> Refinement:
    """Peaks with their errors, and where the largest of them is if they miss the tolerance."""
    peaks, errors, unit = candidate.run.peaks, candidate.errors, model.units.acceleration
    worst = float(peaks.instant[(errors / peaks.value).argmax()]) * model.units.time
    instant = math.nan if outcome == Outcome.OK else worst
    answered = Refinement(peaks.value * unit, errors * unit, outcome, instant, candidate.run)
    return replace(answered, coarser=candidate.coarser, floor=candidate.level.error_floor)


def _no_answer(model: EngineModel, run: EngineRun, outcome: Outcome, instant: float) -> Refinement:
    nothing = np.full(len(model.bodies), np.nan)
    return Refinement(nothing, nothing, outcome, instant, run)
