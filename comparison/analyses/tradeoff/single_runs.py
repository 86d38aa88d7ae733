"""One run of either side with a numerical parameter at a given value: no second run, hence no error estimate."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

import multibody
from comparison.result_types import Array
from reference.problem import Outcome, Scene, checked_phases, ground_peak
from reference.solver.error_estimate import peaks_at
from reference.solver.system import SOLVED
from reference.surface import checked_demand

DISCONTINUOUS = 1.0  # the engine's own default
USUAL_LEVEL = 1  # of the engine: it usually answers at a tolerance of 1e-3


def reference_run(
    scene: Scene, phases: ArrayLike, inside: float, equations: str = "exact", regularization: float | None = None
) -> tuple[Array, float]:
    """mu of one run of the reference for each phase pair at a tolerance inside a step, and the mean step, s."""
    pairs = checked_phases(phases)
    system, demand = checked_demand(scene, equations, regularization, 1e-6, None, "consistent")
    peaks = peaks_at(system, pairs, demand, inside)
    mu = np.where((peaks.code == SOLVED)[:, None], peaks.value, np.nan) / ground_peak(scene, pairs)[:, None]
    return mu, float(scene.duration / peaks.steps.mean())


def engine_run(
    scene: Scene,
    phases: ArrayLike,
    model: str,
    regularization: float,
    step: float = 1.0,
    penetration: float | None = None,
    newton: float | None = None,
) -> Array:
    """mu of one run of the engine for each phase pair at USUAL_LEVEL; step: a factor; penetration: over rho."""
    pairs = checked_phases(phases)
    usual = multibody.levels(scene, model, 1e-3, regularization)[USUAL_LEVEL]
    level = replace(
        usual,
        step=usual.step * step,
        slip_change=usual.slip_change * step,
        penetration=usual.penetration if penetration is None else penetration,
        newton=usual.newton if newton is None else newton,
    )
    runs = [multibody.single_run(scene, phase, model, regularization, level=level) for phase in pairs]
    peaks = [run.peak if run.status == Outcome.OK else np.full(len(scene.bodies), np.nan) for run in runs]
    return np.array(peaks) / ground_peak(scene, pairs)[:, None]


def constant_step_run(scene: Scene, phases: ArrayLike, solver: str, step: float, v_reg: float) -> Array:
    """mu (M, N) of the translational model by an integrator of `multibody.single_run`; NaN where it gives up."""
    pairs = checked_phases(phases)
    peaks = np.full((len(pairs), len(scene.bodies)), np.nan)
    for row, phase in enumerate(pairs):
        run = multibody.single_run(
            scene, phase, "translational", v_reg, step=step, integrator=solver, discontinuous=DISCONTINUOUS
        )
        if run.status == Outcome.OK:
            peaks[row] = np.linalg.norm(run.absolute_acceleration, axis=-1).max(axis=0)
    return peaks / ground_peak(scene, pairs)[:, None]
