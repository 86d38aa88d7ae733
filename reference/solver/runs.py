"""Runs from one initial state under many phases: what Python calls."""

from __future__ import annotations

from math import sqrt

from reference.solver.compiled import cached_entry_point
from reference.solver.march import integrate
from reference.solver.system import REACH, STEPS, TIME, Array, Demand, Record, System, workspace


@cached_entry_point
def runs(
    system: System, phases: Array, x: Array, v: Array, demand: Demand, record: Record,
    peaks: Array, reading_errors: Array, codes: Array, instants: Array, steps: Array, reach: Array,
) -> None:  # fmt: skip
    """
    Follow the motion from x, v (N, 2) for every phase pair (M, 2), rad.

    Fills peaks (M, N), the largest absolute accelerations, m/s^2, and reading_errors (M, N), their
    errors inside their steps; how (system.py), when (s) and after how many steps each run ended (M,); reach (M,), m,
    the platform's largest displacement.
    """
    work = workspace(peaks.shape[1])
    for m in range(phases.shape[0]):
        for i in range(x.shape[0]):
            for axis in range(2):
                work.x[i, axis] = x[i, axis]
                work.v[i, axis] = v[i, axis]
        codes[m] = integrate(system, phases[m], work, demand, record)
        instants[m] = work.run[TIME]
        steps[m] = work.run[STEPS]
        reach[m] = sqrt(work.run[REACH])
        for i in range(peaks.shape[1]):
            peaks[m, i] = sqrt(work.best[i])
            reading_errors[m, i] = work.reading_error[i]
