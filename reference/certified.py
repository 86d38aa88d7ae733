"""Peaks with an error that holds: every run is made twice, and again while the two disagree by too much."""

from __future__ import annotations

from math import sqrt

import numpy as np

from reference.compiled import compiled
from reference.march import march
from reference.system import SOLVED, STEPS, TIME, Array, Demand, Record, System, Work, workspace

RATIO = 30.0  # between the tolerances of the two runs
SHARE = 0.3  # of their difference that may be left in the finer run; its error is expected to be 1 / RATIO of it
ROUNDING = 1e-12  # relative error that no tolerance removes: some hundred steps, some ten operations each
LOOSEST = 1e-4  # tolerance of accelerations inside a step, of the first finer run
TIGHTEST = 1e-11
# accelerations inside a step are resolved to so much less than the peaks made of all steps: their errors are local
EASE = 30.0

NOT_MET = 100  # code of a run whose error stays above what was asked; the others are those of system.py


@compiled
def peaks_at(
    system: System, phase: Array, work: Work, demand: Demand, record: Record, tolerance: float, peaks: Array
) -> int:
    """Peak absolute accelerations (N,), m/s^2, of one run from rest with this tolerance; how it ended."""
    work.x[:] = 0.0
    work.v[:] = 0.0
    code = march(
        system, phase, work,
        Demand(tolerance, demand.unit, demand.period, demand.cutoff, demand.step_limit), record,
    )  # fmt: skip
    for i in range(peaks.shape[0]):
        peaks[i] = sqrt(work.best[i])
    return code


@compiled
def certified_peaks(
    system: System, phase: Array, work: Work, demand: Demand, record: Record, peaks: Array, error: Array
) -> tuple[int, float]:
    """
    Peaks (N,) and their estimated errors (N,), m/s^2, to the relative tolerance of `demand`: (how it ended, when in s).

    The tolerance is tightened until two runs agree; a run that cannot be finished is tried with a tighter one as well.
    """
    before = np.empty_like(peaks)
    tolerance = min(LOOSEST, max(EASE * demand.tolerance, TIGHTEST))
    earlier = peaks_at(system, phase, work, demand, record, RATIO * tolerance, before)
    while True:
        code = peaks_at(system, phase, work, demand, record, tolerance, peaks)
        worst = 0.0
        for i in range(peaks.shape[0]):
            error[i] = ROUNDING * peaks[i] + SHARE * abs(peaks[i] - before[i])
            if error[i] > demand.tolerance * peaks[i]:
                worst = max(worst, error[i])
        if code == SOLVED and earlier == SOLVED and worst == 0.0:
            return SOLVED, work.run[TIME]
        if code == earlier and code != SOLVED:
            return code, work.run[TIME]
        if tolerance <= TIGHTEST:
            return (NOT_MET if code == SOLVED and earlier == SOLVED else code), work.run[TIME]
        earlier = code
        before[:] = peaks
        tolerance = max(tolerance / RATIO, TIGHTEST)


@compiled
def certify(
    system: System, phases: Array, demand: Demand, record: Record,
    peaks: Array, errors: Array, codes: Array, instants: Array, steps: Array,
) -> None:  # fmt: skip
    """`certified_peaks` for phases (M, 2): fills peaks, errors (M, N), codes, instants, steps (M,)."""
    work = workspace(peaks.shape[1])
    for m in range(phases.shape[0]):
        codes[m], instants[m] = certified_peaks(system, phases[m], work, demand, record, peaks[m], errors[m])
        steps[m] = work.run[STEPS]
