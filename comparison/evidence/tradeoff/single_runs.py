"""One run of either side with a numerical parameter at a given value: no second run, hence no error estimate."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

import multibody
from comparison.result_types import Array
from reference.problem import Outcome, Scene, ground_peak
from reference.problem.phases import check_phases
from reference.solver.error_estimate import peaks_at
from reference.solver.system import SOLVED
from reference.surface import prepare_run

DISCONTINUOUS = 1.0  # the engine's own default
USUAL_LEVEL = 1  # level of the engine: it usually answers at the default tolerance


def reference_run(
    scene: Scene,
    phases: ArrayLike,
    step_tolerance: float,
    equations: str = "exact",
    regularization: float | None = None,
) -> tuple[Array, float]:
    """Return mu of one run of the reference by phase pair, each step to `step_tolerance`; and the mean step, s."""
    pairs = check_phases(phases)
    system, demand = prepare_run(scene, equations, regularization, 1e-6, None, "consistent")
    peaks = peaks_at(system, pairs, demand, step_tolerance)
    mu = np.where((peaks.code == SOLVED)[:, None], peaks.value, np.nan) / ground_peak(scene, pairs)[:, None]
    return mu, float(scene.duration / peaks.steps.mean())


def engine_run(
    scene: Scene, phases: ArrayLike, model: str, regularization: float, step: float = 1.0, **level: Any
) -> Array:
    """mu of one run of the engine for each phase pair at USUAL_LEVEL; step: a factor; level: fields of the level."""
    usual = multibody.levels(scene, model, regularization=regularization)[USUAL_LEVEL]
    changed = replace(usual, step=usual.step * step, slip_change=usual.slip_change * step, **level)
    return _factors_of_runs(scene, phases, lambda run: run.peak, model, regularization, level=changed)


def constant_step_run(scene: Scene, phases: ArrayLike, solver: str, step: float, v_reg: float) -> Array:
    """mu (M, N) of the translational model by an integrator of `multibody.single_run`; NaN where it gives up."""

    def largest(run: Any) -> Array:
        size: Array = np.linalg.norm(run.absolute_acceleration, axis=-1).max(axis=0)
        return size

    how = {"step": step, "integrator": solver, "discontinuous": DISCONTINUOUS}
    return _factors_of_runs(scene, phases, largest, "translational", v_reg, **how)


def _factors_of_runs(
    scene: Scene, phases: ArrayLike, peak: Callable[[Any], Array], model: str, v_reg: float, **how: Any
) -> Array:
    """mu (M, N) of one run for each phase pair; NaN where it ends early."""
    pairs = check_phases(phases)
    runs = [multibody.single_run(scene, phase, model, v_reg, **how) for phase in pairs]
    nothing = np.full(len(scene.bodies), np.nan)
    return (
        np.array([peak(run) if run.status == Outcome.OK else nothing for run in runs])
        / ground_peak(scene, pairs)[:, None]
    )
