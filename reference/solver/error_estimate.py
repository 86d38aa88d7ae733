"""Peak accelerations with error estimates: runs at two tolerances, and at finer ones while two differ by too much."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from reference.solver.heating import mean_factor, set_factor_by_heat, set_initial_friction_factor
from reference.solver.run import integrate_runs
from reference.solver.run_yielding import integrate_yielding_runs
from reference.solver.step_control import MIN_SCALE_FRACTION
from reference.solver.system import (
    CONSISTENT,
    SOLVED,
    STEP_LIMIT,
    UNSOLVED,
    YIELDING,
    Array,
    RunSettings,
    StepRecord,
    System,
    allocate_record,
)

# How the constants of the error estimate were measured: docs/decisions/0002-two-run-error.md.
TOLERANCE_RATIO = 30.0  # ratio of the coarser run's tolerance to the finer run's
# Share of the two runs' difference in a peak that counts as error of the finer run (1 / 30 would be expected). Where
# friction yields or depends on the velocity, the error falls by less between two runs, and all of it counts.
DIFFERENCE_FRACTION, DIFFERENCE_FRACTION_VARYING_FRICTION = 0.4, 1.0
# Least relative errors stated for a peak, since closer agreement of two runs is chance. Where friction yields or varies
# with speed, the third replaces MIN_ERROR_FRACTION: stiff creep needs shorter steps (measured: up to 0.015).
MIN_ERROR_PER_STEP_TOLERANCE = 5e-4  # added to a peak's relative error, as share of a step's error tolerance
MIN_ERROR_FRACTION = 0.007  # smallest stated error, as share of the tolerance that the user requests
MIN_ERROR_FRACTION_VARYING_FRICTION = 0.07  # smallest stated error / tolerance if friction yields or varies with speed
READING_ERROR_FACTOR = 2.0  # factor on the interpolation error at a peak, since the step before may add as much
ROUNDING_ERROR = 1e-12  # relative rounding error of a peak at any tolerance: some hundred steps of some ten operations
# Bounds on the relative error of accelerations that the finer run permits in a step; looser ones would save few steps
MAX_STEP_TOLERANCE = 1e-5  # largest tolerance of the finer run for accelerations in a step, a relative error
MIN_STEP_TOLERANCE = 1e-11  # smallest tolerance for accelerations in a step, a relative error: no run has a tighter one
# Ratio of tolerance inside a step to the requested one of a peak: step errors are local, a peak comes from all steps
STEP_TOLERANCE_FACTOR = 10.0
# Factor on a step's tolerance where friction yields elastically: without it, both runs may miss a slide within a step
YIELDING_TOLERANCE_FACTOR = 0.01
# Share of RunSettings.period for which the coarser run goes on after the finer run's last peak: its own may be later
EVENT_MARGIN = 0.01

FIRST_STEP_CAPACITY, STEPS_PER_KNOT = 1024, 2  # steps that memory is first allocated for, plus steps per ground sample
# With heating, a run is repeated with friction's temperature factor k_T from the run before, until peaks and mean k_T
# change by less than MAX_SETTLED_CHANGE of the tolerance. It also ends when a change within the tolerance is more than
# MIN_CONTRACTION_RATIO of the change before: time steps then cause it. Changes of the first runs may grow, since runs
# agree up to an instant that comes later with each run.
MAX_SETTLED_CHANGE, MIN_CONTRACTION_RATIO = 0.02, 0.5
MAX_HEATED_RUNS = 30  # largest number of runs that are repeated to find the temperature factor of friction, k_T
SMALLEST_VALUE = 1e-300  # m/s^2, smallest divisor of relative changes of peaks, so that nothing is divided by zero

NOT_MET = 100  # code of the outcome "error stays above the tolerance"; system.py has the codes of all others


class RunPeaks(NamedTuple):
    """Largest absolute accelerations of M runs with N bodies, their estimated errors, and how each run ended."""

    value: Array  # (M, N) m/s^2, largest absolute acceleration of each body
    error: Array  # (M, N) m/s^2, estimated errors of these largest accelerations
    code: Array  # (M,) outcome of the runs (system.py), or NOT_MET
    instant: Array  # (M,) s, time at which the run ended
    steps: Array  # (M,) number of steps of the last run
    reach: Array  # (M,) m, largest horizontal displacement of the platform
    last_peak: Array  # (M,) s, end of the last step with acceleration >= 0.9 of the largest: the coarser run ends later


def peaks_at(
    system: System, phases: Array, settings: RunSettings, tolerance: float, until: Array | None = None
) -> RunPeaks:
    """
    Return the peak accelerations of a run from rest for each pair of loading phases (M, 2), rad.

    `tolerance` is the largest relative error of the accelerations inside a step. The errors of the peaks are estimates
    from this run alone: interpolation at the peak, and what the steps before it have missed of fast vibrations. Runs
    that do not end early make no step beyond `until` (M,), s, by default the end of the motion.
    """
    rest = np.zeros((len(system.below), 2))
    settings = settings._replace(tolerance=tolerance)
    if len(system.heat) and len(phases):
        (pair,) = phases  # with heating one pair of loading phases is run at a time: each has its own factor k_T
        return record_run(rest, rest, system, pair, settings)[0]
    return peaks_from(rest, rest, system, phases, settings, allocate_record(0, len(rest)), until)


def peaks_from(
    x: Array,
    v: Array,
    system: System,
    phases: Array,
    settings: RunSettings,
    record: StepRecord,
    until: Array | None = None,
) -> RunPeaks:
    """Return the peak accelerations of M runs, one for each pair of loading phases (M, 2), rad; see `peaks_at`.

    All start with the positions x and velocities v of the bodies, (N, 2). `record` takes the steps if it has room.
    """
    count, bodies = len(phases), len(x)
    value, error = np.empty((count, bodies)), np.empty((count, bodies))
    ends = np.empty((len(RunPeaks._fields) - 2, count))
    until = np.full(count, system.duration) if until is None else until
    integrate_all = integrate_yielding_runs if system.law == YIELDING else integrate_runs
    integrate_all(system, phases, x, v, settings, record, until, value, error, ends)
    return RunPeaks(value, error, *ends)


def record_run(
    x: Array, v: Array, system: System, phase: Array, settings: RunSettings
) -> tuple[RunPeaks, StepRecord, System]:
    """
    Return the peak accelerations of one run, the record of its steps, and its system.

    The run starts with positions x and velocities v, (N, 2); `phase` (2,) are the loading's phases, rad. With heating,
    it is repeated until friction's temperature factor k_T(t), which the system then has, no longer changes; the last
    change of the peaks counts as error.
    """
    # The number of steps is known only afterwards: a run that outgrows its record is made again with a larger one.
    # With heating, k_T as a function of time follows from the heat of the run before. The first run has the k_T of
    # `system`, or that of the initial temperature. This is a fixed-point iteration on whole motions (waveform
    # relaxation): runs agree from the start up to an instant that comes later with each run, so a change may grow
    # before it falls.
    capacity = FIRST_STEP_CAPACITY + STEPS_PER_KNOT * len(system.record)
    known, before, made = np.array(np.inf), np.inf, 0
    if len(system.heat) and not len(system.k_t):
        system = set_initial_friction_factor(system)
    while True:
        record = allocate_record(capacity, len(x))
        peaks = peaks_from(x, v, system, phase[None], settings, record)
        if record.counts.max() > capacity:
            capacity = int(record.counts.max())
            continue
        if not len(system.heat) or peaks.code[0] in (UNSOLVED, STEP_LIMIT) or record.counts[0] == 0:
            return peaks, record, system
        system, made = set_factor_by_heat(system, record, peaks.instant[0]), made + 1
        now = np.array([*peaks.value[0], mean_factor(system)])
        change = np.abs(now - known)
        known, worst = now, (change / np.maximum(now, SMALLEST_VALUE)).max() / settings.tolerance
        if not worst > MAX_SETTLED_CHANGE or MIN_CONTRACTION_RATIO * before < worst <= 1.0 or made == MAX_HEATED_RUNS:
            return peaks._replace(error=peaks.error + change[:-1]), record, system
        before = worst


def peaks_with_error(system: System, phases: Array, settings: RunSettings, whole: bool = False) -> RunPeaks:
    """
    Return peak accelerations and error estimates for pairs of loading phases, to the relative tolerance of `settings`.

    With `whole` all runs go to the end of the motion; otherwise they end where no peak, displacement or outcome can
    change any more (look_ahead.py).
    """
    # Two runs with tolerances TOLERANCE_RATIO apart; their difference estimates the error of the finer one
    # (docs/decisions/0002-two-run-error.md). The coarser run serves the error alone and ends just beyond the last peak.
    # Where the error misses the tolerance, the finer run becomes the coarser one of the next pair. A run that cannot be
    # finished is tried again, too, with a tighter tolerance: it may pass where a looser one stumbled. If the tighter
    # one fails instead, the peaks of the pair before remain, with their error and the status "tolerance not met".
    # Runs can end early (look_ahead.py) only with the friction-cone condition for rest, no heat, no yielding friction.
    early = not whole and system.rest_condition == CONSISTENT and not len(system.heat) and system.law != YIELDING
    settings = settings._replace(early=early)
    tolerance = min(MAX_STEP_TOLERANCE, max(STEP_TOLERANCE_FACTOR * settings.tolerance, MIN_STEP_TOLERANCE))
    if system.law == YIELDING:
        tolerance = max(YIELDING_TOLERANCE_FACTOR * tolerance, MIN_STEP_TOLERANCE)
    # Every phase pair has its own temperature factor of friction, k_T(t), which a coarse run estimates first
    if len(system.heat) and len(phases) and not len(system.k_t):
        rest, coarse = np.zeros((len(system.below), 2)), settings._replace(tolerance=TOLERANCE_RATIO * tolerance)
        heated = [record_run(rest, rest, system, pair, coarse)[2] for pair in phases]
        each = [peaks_with_error(own, pair[None], settings, whole) for own, pair in zip(heated, phases)]
        return RunPeaks(*map(np.concatenate, zip(*each)))
    after = peaks_at(system, phases, settings, tolerance)
    ends_early = settings.early & (after.code == SOLVED)
    until = np.where(ends_early, after.last_peak + EVENT_MARGIN * settings.period, system.duration)
    coarser = settings._replace(early=False, damped_weight=1.0)
    before = peaks_at(system, phases, coarser, TOLERANCE_RATIO * tolerance, until)
    peaks, disagree = _compare_runs(before, after, tolerance, system, settings)
    unfinished = np.flatnonzero(disagree)
    known = ~_where_unfinished(before, after)
    while len(unfinished) and tolerance > MIN_STEP_TOLERANCE:
        tolerance = max(tolerance / TOLERANCE_RATIO, MIN_STEP_TOLERANCE)
        before = RunPeaks(*(part[disagree] for part in after))
        after = peaks_at(system, phases[unfinished], settings, tolerance)
        finer, disagree = _compare_runs(before, after, tolerance, system, settings)
        given_up = _where_unfinished(before, after)
        better = ~(given_up & known[unfinished])  # all other pairs keep their known peaks and errors
        for values, found in zip(peaks, finer):
            values[unfinished[better]] = found[better]
        peaks.code[unfinished[~better]] = NOT_MET
        known[unfinished] |= ~given_up
        unfinished = unfinished[disagree]
    peaks.code[unfinished[peaks.code[unfinished] == SOLVED]] = NOT_MET
    return peaks


def _where_unfinished(before: RunPeaks, after: RunPeaks) -> npt.NDArray[np.bool_]:
    """Return, for M phase pairs, True where the run `before` or `after` could not be finished."""
    return np.isin(before.code, (UNSOLVED, STEP_LIMIT)) | np.isin(after.code, (UNSOLVED, STEP_LIMIT))


def _compare_runs(
    before: RunPeaks, after: RunPeaks, tolerance: float, system: System, settings: RunSettings
) -> tuple[RunPeaks, Array]:
    """Return the peaks of the finer runs, `after`, with their errors, and a mask (M,) of those that need finer ones."""
    plain = system.rate == 0.0 and system.law != YIELDING
    share = DIFFERENCE_FRACTION if plain else DIFFERENCE_FRACTION_VARYING_FRICTION
    error = _estimate_error(before, after, share, tolerance, settings.unit)
    permitted = settings.tolerance * after.value
    solved = (before.code == SOLVED) & (after.code == SOLVED)
    met = solved & (error <= permitted).all(axis=1)
    refused = (before.code == after.code) & (after.code != SOLVED)
    fraction = MIN_ERROR_FRACTION if plain else MIN_ERROR_FRACTION_VARYING_FRICTION
    return after._replace(error=np.maximum(error, fraction * permitted)), ~(met | refused)


def _estimate_error(before: RunPeaks, after: RunPeaks, share: float, tolerance: float, unit: float) -> Array:
    """
    Return the errors (M, N) of the finer runs' peaks: their own estimates plus `share` of the runs' difference.

    Two runs that differ by less than rounding agree by chance: there the error is that of rounding. `tolerance` is that
    of the finer runs inside a step, and `unit`, m/s^2, the size of the loading.
    """
    # Steps do not resolve peaks below MIN_SCALE_FRACTION of the loading: their whole difference counts. Small
    # accelerations are differences of large ones, so their rounding is relative to the loading.
    between = np.where(after.value < MIN_SCALE_FRACTION * unit, 1.0, share) * np.abs(after.value - before.value)
    rounding = ROUNDING_ERROR * np.maximum(after.value, unit)
    return (
        np.maximum(READING_ERROR_FACTOR * after.error + between, rounding)
        + MIN_ERROR_PER_STEP_TOLERANCE * tolerance * after.value
    )
