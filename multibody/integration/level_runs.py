"""
Runs of one phase pair at successive levels of accuracy: how far each run goes, and on which springs its supports stand.

The first run gives the instant of the last large value (`look_ahead`). Runs at further levels stop soon after that
instant, if they differ from the run before by much less than later values differ from the largest.

While all supports are closed, their springs against warping are so soft that they carry no load. Once a support opens,
the springs of real bearings are part of the model. Stiffer springs remain if springs of real bearings change no peak by
more than the tolerance; the change is then a part of the error.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from multibody.integration.balance import follows_decay
from multibody.integration.candidate import Candidate
from multibody.integration.engine_run import SETTLED_FRACTION, Budget, EngineRun
from multibody.integration.estimate import (
    ERROR_PER_WARPING_LOAD,
    SAFETY_OF_BEARINGS,
    SMALLEST_MEASURED_ERROR,
    contact_noise_error,
    error_between_levels,
    error_share_of_change,
    impact_error_floor,
    load_sharing_error,
    rounding_error,
    widen_by_impacts,
)
from multibody.integration.level import (
    COMPLIANCE_OF_CLOSED_SUPPORTS,
    PHYSICAL_WARPING_COMPLIANCE,
    Level,
    soften_for_small_peaks,
)
from multibody.integration.one_run import PhasePair
from multibody.models.system import EngineModel
from reference.problem import Outcome

Array = NDArray[np.float64]

# Outcomes of a run that stops before the end of the motion without an event, such as a platform at the rim.
UNFINISHED_OUTCOMES = (Outcome.STEP_LIMIT, Outcome.SOLVER_FAILED)

# Largest error by the warping load (part without resultant of closed supports' forces), as a share of the tolerance
MAX_WARPING_ERROR_SHARE = 0.2

# Largest share of the engine steps allowed for a phase pair that the first run may take if supports may rattle, that is
# open and close again and again.
MAX_WORK_SHARE_OF_TRIAL = 0.2

# Largest ratio of the numbers of steps of two successive levels, to predict the work: steps become half as long.
MAX_WORK_GROWTH = 2.0

# Time from the last value near its largest in a run to the early stop of the next run, over the first level's step
STEPS_AFTER_SETTLING = 20.0

# Largest change of a peak between two levels at which a run may stop early, as a share of its excess over later values.
MAX_CHANGE_FOR_EARLY_STOP = 0.2

# Later runs may stop early only if the first run keeps this margin: a share of the distance to the rim or of the
# travel, and a contact force in weights. Otherwise all runs go to the end.
MIN_END_MARGIN = 0.1


@dataclass
class LevelRuns:
    """
    Runs of one phase pair so far, and its levels of accuracy, which adapt to the results of the runs.

    Attributes:
    - tolerance: Largest relative error that the answer may have.
    - budget: Steps left to all runs.
    - levels: Levels of the runs so far, and the levels to come.
    - may_soften_contact: Whether small peaks may soften the contact of the levels to come.
    - keep: Whether the motions of the last two runs are kept; every run then goes to the end.
    - stop: Time at which the next run stops, where nothing later can matter.
    - max_warping_compliance: Largest compliance against warping that supports may have.
    - real_bearings_run: The last run on springs of real bearings that ended, and the change (N,) of the peaks on them,
      once supports opened on stiffer springs.
    """

    pair: PhasePair
    tolerance: float
    budget: Budget
    levels: list[Level]
    may_soften_contact: bool
    keep: bool
    runs: list[EngineRun] = field(default_factory=list)
    stop: float = math.inf
    max_warping_compliance: float = COMPLIANCE_OF_CLOSED_SUPPORTS
    real_bearings_run: tuple[EngineRun, Array] | None = None

    @property
    def runs_to_end(self) -> bool:
        """True if every run goes to the end of the motion in accurate steps."""
        return self.keep or self.pair.in_full

    def can_run_next(self) -> bool:
        """Return whether there is another level of accuracy, and enough engine steps are left for its runs."""
        number = len(self.runs)
        if number == len(self.levels):
            return False
        # one run, one more for the error of a contact no stiffer than before, one more for that of stiff supports
        runs = 1.0 + self.shares_contact(number) + (self.real_bearings_run is not None)
        # one level alone has no error estimate, so that a second level is tried even if it may not end
        growth = 1.0 if number == 1 else MAX_WORK_GROWTH
        return not self.runs or self.budget.steps_left >= runs * growth * _compute_work_until(
            self.runs[-1], self.stop, self.pair.end
        )

    def shares_contact(self, number: int) -> bool:
        """Return whether the contact of level `number` is no stiffer than that of the level before."""
        return number > 0 and self.levels[number].penetration >= self.levels[number - 1].penetration

    def run_next_level(self) -> EngineRun:
        """Run the model at the next level of accuracy; by its result, adapt supports and contact of later levels."""
        # The run at the level may be replaced in three cases. 1. If supports may rattle, the first run is a trial with
        # a share of the work, and fails: rattling on stiff springs would use up all work. 2. The run stopped early,
        # and its largest values do not confirm those of the run before, so that a later value may be larger: the level
        # is run to the end. 3. A support opens. In cases 1 and 3 supports as stiff as real bearings are tried, because
        # the misfit of a platform alone lifts it off rigid supports (docs/records/multibody.md, supports).
        number, level = len(self.runs), self.levels[len(self.runs)]
        trial = number == 0 and self.pair.model.warping_displacement is not None
        run = self._run_trial(level) if trial else self._run_level(level, self.stop)
        if self.stop < self.pair.end and not _confirms_early_stop(run, self.runs[-1]):
            self.stop = math.inf
            run = self._run_level(level)
        rattles = trial and run.outcome == Outcome.STEP_LIMIT
        if rattles or run.lifts_off:
            run = self._choose_springs_for_opening(run)
        if self.levels[number].warping_compliance == PHYSICAL_WARPING_COMPLIANCE:
            self.real_bearings_run = None
        self.runs.append(run)
        if run.outcome == Outcome.OK and run.stop == math.inf and not self.runs_to_end:
            self.stop = _choose_early_stop(run, self.pair.model, self.levels[0].step)
        if run.outcome not in UNFINISHED_OUTCOMES:
            self._adapt_levels(run)
        return run

    def make_candidate(self) -> Candidate | None:
        """Return the last level's peaks and errors; None if a run on supports as stiff as real bearings failed."""
        # The error is a sum of parts that different comparisons show: step, iteration and contact from the levels
        # before, rounding of contact forces from the stiffness of two levels, load sharing from the load that warping
        # takes, and the springs of real bearings from a run on them. Two rules keep the parts from hiding each other.
        # Levels on other springs are other models, so they show no rate of convergence and confirm nothing. And behind
        # impacts, whose order depends on rounding, levels agree by chance: both the sum and the part of rounding are
        # widened, and rounding counts as the difference of the two widened errors.
        number, run, model = len(self.runs) - 1, self.runs[-1], self.pair.model
        level, before = self.levels[number], self.levels[number - 1]
        finished = [other.peaks for other in self.runs[-3:] if other.outcome == Outcome.OK]
        compliances = [other.warping_compliance for other in self.levels[max(number - 2, 0) : number + 1]]
        if compliances[0] != compliances[-2]:
            finished = finished[-2:]
        errors = error_between_levels(finished, self.levels[: number + 1], model)
        rounding = rounding_error(run.peaks, level, self.runs[-2].peaks, before)
        alike = self._count_levels_on_same_springs()
        rounding = widen_by_impacts(errors + rounding, finished, run, alike)
        errors = widen_by_impacts(errors, finished, run, alike)
        rounding -= errors
        if not run.lifts_off:
            errors = errors + load_sharing_error(run)
        confirmed = True
        if self.real_bearings_run is not None:
            _, change = self.real_bearings_run
            if (errors + change <= self.tolerance * run.peaks.value).all():
                change, confirmed = self._repeat_on_real_bearings(change)
                level, run = self.levels[number], self.runs[-1]
            if run.outcome != Outcome.OK:
                return None
            errors = widen_by_impacts(errors + change, [], run, self._count_levels_on_same_springs())
        # after impacts a level before level 0 has other contact forces, so that it confirms no answer
        confirmed = confirmed and not (run.impacts and before.precedes_level_0)
        if model.kinematics is not None and not (model.bearing_penetration or follows_decay(model, level.penetration)):
            # no level transmits the vertical loading at the start, so that the levels cannot show what it would add
            errors = errors + abs(self.pair.ground(np.zeros(1))[0, 2])
        coarser = [(self.runs[-2], error_share_of_change(before, model))]
        if self.real_bearings_run is not None:
            coarser.append((self.real_bearings_run[0], 1.0))
        noise = contact_noise_error(run, level, self.pair.scene, model)
        floor = max(level.error_floor, impact_error_floor(self._count_levels_on_same_springs()) if run.impacts else 0.0)
        floor = max(floor, 0.0 if run.lifts_off else run.warping_load)
        return Candidate(
            run=run,
            level=level,
            shares_contact=self.shares_contact(number),
            level_errors=errors,
            rounding=rounding,
            noise_errors=noise,
            compliance=None,
            coarser=tuple(coarser),
            confirmed=confirmed,
            floor=floor,
        )

    def _count_levels_on_same_springs(self) -> int:
        """Return how many earlier levels, from level 0 on, have the last level's warping compliance of supports."""
        *before, last = self.levels[: len(self.runs)]
        springs = last.warping_compliance
        return sum(level.warping_compliance == springs and not level.precedes_level_0 for level in before)

    def _run_level(self, level: Level, stop: float = math.inf) -> EngineRun:
        """Run the model at one level of accuracy, up to `stop`, within the engine steps that are left."""
        return self.pair.run_level(level, self.budget, stop, keep=self.keep)

    def _run_trial(self, level: Level) -> EngineRun:
        """Run the first level of a model whose supports may rattle, with a part of the engine steps that are left."""
        trial = Budget(MAX_WORK_SHARE_OF_TRIAL * self.budget.steps_left)
        self.budget.steps_left -= trial.steps_left
        run = self.pair.run_level(level, trial, keep=self.keep)
        self.budget.steps_left += trial.steps_left
        return run

    def _choose_springs_for_opening(self, run: EngineRun) -> EngineRun:
        """Return `run`, in which a support opens, or a run in its place on supports as stiff as real bearings."""
        # A support on stiff springs may open only because of the misfit of the platform, which real bearings
        # compensate. So the level is repeated on the springs of real bearings. If a support opens in this run, too, and
        # no peak changes by more than the tolerance, the stiff run stays the answer and the change becomes a part of
        # its error. Otherwise real bearings are part of the model, and this level and all later ones have their
        # springs.
        number = len(self.runs)
        level = self.levels[number]
        if level.warping_compliance == PHYSICAL_WARPING_COMPLIANCE:
            return self._run_level(level) if number == 0 and run.outcome == Outcome.STEP_LIMIT else run
        if self.real_bearings_run is not None:
            return run
        real, change = self._run_on_real_bearings(level, run)
        stiff = level.warping_compliance < PHYSICAL_WARPING_COMPLIANCE
        if stiff and real.lifts_off and (change <= self.tolerance * run.peaks.value).all():
            self.real_bearings_run = real, change
            return run
        self.max_warping_compliance = self.max_warping_compliance if stiff else PHYSICAL_WARPING_COMPLIANCE
        self._use_real_bearings(number)
        return real

    def _run_on_real_bearings(self, level: Level, run: EngineRun) -> tuple[EngineRun, Array]:
        """Run a level on supports as stiff as real bearings; return it and the changes (N,) of peaks from `run`."""
        real = self._run_level(_with_physical_warping_compliance(level))
        if real.outcome in UNFINISHED_OUTCOMES or real.outcome != run.outcome:
            return real, np.full_like(run.peaks.value, np.inf)
        return real, np.abs(run.peaks.value - real.peaks.value)

    def _repeat_on_real_bearings(self, earlier: Array) -> tuple[Array, bool]:
        """
        Repeat the last level on supports as stiff as real bearings.

        Returns the changes (N,) of the peaks, at least those of an `earlier` level, and whether the run ended.
        """
        number, run = len(self.runs) - 1, self.runs[-1]
        real, change = self._run_on_real_bearings(self.levels[number], run)
        if real.outcome in UNFINISHED_OUTCOMES:
            # the peaks of a run that did not end may still grow
            return np.fmax(SAFETY_OF_BEARINGS * earlier, real.peaks.value - run.peaks.value), False
        change = np.maximum(earlier, change)
        if (change <= self.tolerance * run.peaks.value).all():
            self.real_bearings_run = real, change
        else:
            self.runs[-1] = real
            self._use_real_bearings(number)
        return change, True

    def _use_real_bearings(self, number: int) -> None:
        """Make supports as stiff as real bearings at all levels from `number` on."""
        self.levels[number:] = [_with_physical_warping_compliance(level) for level in self.levels[number:]]
        self.stop, self.real_bearings_run = math.inf, None

    def _adapt_levels(self, run: EngineRun) -> None:
        """Soften the supports of later levels as the warping load of `run` requires, and contacts for small peaks."""
        done = len(self.runs)
        if run.lifts_off:
            self.max_warping_compliance = PHYSICAL_WARPING_COMPLIANCE
        coming = [
            _adapt_warping_compliance(level, run, self.tolerance, self.max_warping_compliance)
            for level in self.levels[done:]
        ]
        # a softer contact would tilt a platform that can rotate
        if self.may_soften_contact and run.outcome == Outcome.OK and self.pair.model.depressions is None:
            smallest = float(run.peaks.value.min())
            coming = [soften_for_small_peaks(level, smallest, self.tolerance) for level in coming]
        self.levels[done:] = coming


def _with_physical_warping_compliance(level: Level) -> Level:
    """Return `level` with the compliance of real bearings against out-of-plane warping of the ring of supports."""
    return replace(level, warping_compliance=PHYSICAL_WARPING_COMPLIANCE)


def _adapt_warping_compliance(level: Level, run: EngineRun, tolerance: float, softest: float) -> Level:
    """
    Return `level` with supports that give way to warping as far as the warping load of `run` requires.

    Warping load is the part of the support forces that has no resultant. softest: largest compliance against warping.
    """
    wanted = level.warping_compliance
    if run.lifts_off:
        wanted *= max(run.warping_load * ERROR_PER_WARPING_LOAD / (MAX_WARPING_ERROR_SHARE * tolerance), 1.0)
    elif run.warping_load > SMALLEST_MEASURED_ERROR:
        wanted = softest
    return replace(level, warping_compliance=min(wanted, softest))


def _compute_work_until(run: EngineRun, stop: float, end: float) -> float:
    """Return the number of engine steps that `run` would have taken up to `stop`, without searching later motion."""
    own = min(run.scanned_from, end)
    shorter = min(stop, own) / min(run.stop, own) if run.outcome == Outcome.OK else 1.0
    return shorter * run.work


def _choose_early_stop(run: EngineRun, model: EngineModel, step: float) -> float:
    """Return the time at which runs at further levels may stop; `run` went to the end, `step` is the largest step."""
    limit = (1.0 - MIN_END_MARGIN) * min(model.rim, model.travel)
    if run.max_displacement > limit or run.min_load < MIN_END_MARGIN:
        return math.inf
    return run.last_large_at + STEPS_AFTER_SETTLING * step


def _confirms_early_stop(run: EngineRun, before: EngineRun) -> bool:
    """Return whether a run that stopped early agrees so well with `before` that no later value can be larger."""
    if run.outcome != Outcome.OK:
        return False
    largest = np.array([*run.peaks.value, run.max_displacement])
    change = np.abs(largest - [*before.peaks.value, before.max_displacement])
    return bool((change <= MAX_CHANGE_FOR_EARLY_STOP * (1.0 - SETTLED_FRACTION) * largest).all())
