"""Peaks with an error that holds: every run is made twice, and again while the two disagree by too much."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from reference.solver.advance import FLOOR
from reference.solver.runs import runs
from reference.solver.system import SOLVED, Array, Demand, System, record_of

RATIO = 30.0  # between the tolerances of the two runs
SHARE = 0.4  # of their difference that may be left in the finer run; its error is expected to be 1 / RATIO of it
LUCK = 5e-4  # of the tolerance inside a step: two runs that agree better do so by luck
READING = 2.0  # of the interpolation error where the peak was read: the step before may have left as much
RESERVE = 0.007  # of the tolerance asked: two runs that agree better than that may do so by luck
ROUNDING = 1e-12  # relative error that no tolerance removes: some hundred steps, some ten operations each
LOOSEST = 1e-5  # tolerance of accelerations inside a step, of the first finer run: looser ones save few steps
TIGHTEST = 1e-11
# accelerations inside a step are resolved to so much less than the peaks made of all steps: their errors are local
EASE = 10.0

NOT_MET = 100  # code of a run whose error stays above what was asked; the others are those of system.py


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


def certified_peaks(system: System, phases: Array, demand: Demand) -> Peaks:
    """
    Peaks to the relative tolerance of `demand`, with errors.

    The tolerance inside the steps is tightened until two runs agree; one that cannot be finished is tried again, too.
    """
    tolerance = min(LOOSEST, max(EASE * demand.tolerance, TIGHTEST))
    before = peaks_at(system, phases, demand, RATIO * tolerance)
    found = Peaks(*(part.copy() for part in before))
    open_ = np.arange(len(phases))
    while len(open_):
        after = peaks_at(system, phases[open_], demand, tolerance)
        error = _error(before, after, tolerance, demand.unit)
        stated = np.maximum(error, RESERVE * demand.tolerance * after.value)
        for total, part in zip(found, after._replace(error=stated)):
            total[open_] = part
        solved = (before.code == SOLVED) & (after.code == SOLVED)
        met = solved & (error <= demand.tolerance * after.value).all(axis=1)
        refused = (before.code == after.code) & (after.code != SOLVED)
        again = ~(met | refused)
        if tolerance <= TIGHTEST:
            found.code[open_[again & (after.code == SOLVED)]] = NOT_MET
            break
        before = Peaks(*(part[again] for part in after))
        open_ = open_[again]
        tolerance = max(tolerance / RATIO, TIGHTEST)
    return found


def _error(before: Peaks, after: Peaks, tolerance: float, unit: float) -> Array:
    """
    Estimated error of `after`, (M, N): what reading the peak leaves, and what the runs' states leave.

    Below what rounding may do the two runs differ by chance: there the error is that of rounding, however they differ.
    """
    share = np.where(after.value < FLOOR * unit, 1.0, SHARE)  # steps do not resolve less than that
    between = share * np.abs(after.value - before.value)
    rounding = ROUNDING * np.maximum(after.value, unit)  # small accelerations are differences of large ones
    return np.maximum(READING * after.error + between, rounding) + LUCK * tolerance * after.value
