"""Peaks with an error that holds: every run is made twice, and again while the two disagree by too much."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from reference.solver.run import runs
from reference.solver.step_control import MIN_SCALE_FRACTION
from reference.solver.system import SOLVED, Array, Demand, System, record_of

TOLERANCE_RATIO = 30.0  # tolerance inside a step of the coarser run over that of the finer run
# Share of the runs' difference that counts as error of the finer run. 1 / TOLERANCE_RATIO is expected.
DIFFERENCE_FRACTION = 0.4
# Lower bound on the error, in units of the tolerance inside a step: closer agreement is treated as accidental.
MIN_ERROR_PER_STEP_TOLERANCE = 5e-4
# Lower bound on the error, in units of the tolerance asked for: closer agreement is treated as accidental.
MIN_ERROR_FRACTION = 0.007
READING_ERROR_FACTOR = 2.0  # times the interpolation error at the peak: the step before may add as much
ROUNDING_ERROR = 1e-12  # relative error that no tolerance removes: some hundred steps of some ten operations
# Bounds on the tolerance inside a step, relative to the accelerations; a looser one saves few steps.
MAX_STEP_TOLERANCE = 1e-5
MIN_STEP_TOLERANCE = 1e-11
# Tolerance inside a step over the tolerance of the peak: errors inside a step are local, a peak comes from all steps.
STEP_TOLERANCE_FACTOR = 10.0

NOT_MET = 100  # code of a run whose error stays above the tolerance; system.py has the other codes


class Peaks(NamedTuple):
    """Largest absolute accelerations and their estimated errors, and how, when and at what cost the runs ended."""

    value: Array  # (M, N) m/s^2
    error: Array  # (M, N) m/s^2
    code: Array  # (M,)
    instant: Array  # (M,) s
    steps: Array  # (M,) of the last run
    reach: Array  # (M,) m, largest horizontal displacement of the platform


def peaks_at(system: System, phases: Array, demand: Demand, tolerance: float) -> Peaks:
    """One run from rest for every phase pair (M, 2), this tolerance inside the steps; errors are those of reading."""
    count, bodies = len(phases), len(system.below)
    rest = np.zeros((bodies, 2))
    peaks = Peaks(np.empty((count, bodies)), np.empty((count, bodies)), *(np.empty(count) for _ in range(4)))
    asked = demand._replace(tolerance=tolerance)
    runs(system, phases, rest, rest, asked, record_of(0, bodies), *peaks)
    return peaks


def peaks_with_error(system: System, phases: Array, demand: Demand) -> Peaks:
    """
    Peaks to the relative tolerance of `demand`, with errors.

    The tolerance inside the steps is tightened until two runs agree; one that cannot be finished is tried again, too.
    """
    tolerance = min(MAX_STEP_TOLERANCE, max(STEP_TOLERANCE_FACTOR * demand.tolerance, MIN_STEP_TOLERANCE))
    before = peaks_at(system, phases, demand, TOLERANCE_RATIO * tolerance)
    peaks = Peaks(*(part.copy() for part in before))
    unfinished = np.arange(len(phases))
    while len(unfinished):
        after = peaks_at(system, phases[unfinished], demand, tolerance)
        error = _error(before, after, tolerance, demand.unit)
        error_or_minimum = np.maximum(error, MIN_ERROR_FRACTION * demand.tolerance * after.value)
        for total, part in zip(peaks, after._replace(error=error_or_minimum)):
            total[unfinished] = part
        solved = (before.code == SOLVED) & (after.code == SOLVED)
        met = solved & (error <= demand.tolerance * after.value).all(axis=1)
        refused = (before.code == after.code) & (after.code != SOLVED)
        again = ~(met | refused)
        if tolerance <= MIN_STEP_TOLERANCE:
            peaks.code[unfinished[again & (after.code == SOLVED)]] = NOT_MET
            break
        before = Peaks(*(part[again] for part in after))
        unfinished = unfinished[again]
        tolerance = max(tolerance / TOLERANCE_RATIO, MIN_STEP_TOLERANCE)
    return peaks


def _error(before: Peaks, after: Peaks, tolerance: float, unit: float) -> Array:
    """
    Estimated error of `after`, (M, N): what reading the peak leaves, and what the runs' states leave.

    Below what rounding may do the two runs differ by chance: there the error is that of rounding, however they differ.
    """
    share = np.where(
        after.value < MIN_SCALE_FRACTION * unit, 1.0, DIFFERENCE_FRACTION
    )  # steps do not resolve less than that
    between = share * np.abs(after.value - before.value)
    rounding = ROUNDING_ERROR * np.maximum(after.value, unit)  # small accelerations are differences of large ones
    return (
        np.maximum(READING_ERROR_FACTOR * after.error + between, rounding)
        + MIN_ERROR_PER_STEP_TOLERANCE * tolerance * after.value
    )
