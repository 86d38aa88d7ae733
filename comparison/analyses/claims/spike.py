"""What the step of the integration does to the spike of the literal (4.6)."""

from __future__ import annotations

import numpy as np

import reference
from comparison.analyses.claims.cases import CASES
from comparison.analyses.claims.literal import literal_peaks
from comparison.analyses.claims.readings import LITERAL, SPEED, Reading
from comparison.result_types import Number, result
from comparison.runner.task import TaskResult

STEPS = (8e-3, 4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4, 1.25e-4)  # s
CASE = "fig3-I"
PHASES = ((0.3, 1.1), (2.0, 0.7), (4.0, 5.5))  # rad


@result
class Spike:
    """mu_1 of the literal integration of (4.6) over its step."""

    steps: tuple[float, ...] = ()
    """steps, s; none where it could not be computed"""
    counted: tuple[tuple[Number, ...], ...] = ()
    """for each step mu_1 at each phase pair, with the instants at which slip begins"""
    left_out: tuple[tuple[Number, ...], ...] = ()
    """the same without these instants"""
    starts: tuple[tuple[int, ...], ...] = ()
    """how many these are"""
    limit: tuple[Number, ...] = ()
    """mu_1 of the reference at each phase pair, with (4.6) as its condition of rest alone"""


def spike_over_the_step(reading: Reading = LITERAL) -> Spike:
    """The spike under a reading. Runs inside a worker process."""
    scene, phases = CASES[CASE](reading), np.array(PHASES)
    runs = [[literal_peaks(scene, phases, step, spike) for step in STEPS] for spike in (True, False)]
    limit = reference.amplification(scene, phases, "small", cutoff=SPEED, tolerance=1e-4, rest_condition="printed")
    counted, left_out = (tuple(tuple(map(float, run.mu[:, 0])) for run in each) for each in runs)
    starts = tuple(tuple(map(int, run.spikes)) for run in runs[0])
    return Spike(STEPS, counted, left_out, starts, tuple(map(float, limit.mu[:, 0])))


def no_spike(reading: Reading, failed: TaskResult) -> Spike:
    """In place of what a task did not return."""
    return Spike()
