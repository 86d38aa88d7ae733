"""Single runs of equations or engine at a given numerical parameter; without a second run there is no error."""

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

DISCONTINUOUS_TOLERANCE = 1.0  # Exudyn's default error at which it stops iterating on contacts that open in a step
DEFAULT_ENGINE_LEVEL = 1  # index of the accuracy level with which Exudyn usually reaches the default tolerance


def run_reference_once(
    scene: Scene,
    phases: ArrayLike,
    step_tolerance: float,
    equations: str = "exact",
    regularization: float | None = None,
) -> tuple[Array, float]:
    """
    Return the amplification, (phase pairs, bodies), and the mean step, s, by one run of the reference equations.

    step_tolerance: error allowed within a step; nothing controls the error of the amplification.
    """
    pairs = check_phases(phases)
    system, demand = prepare_run(
        scene, equations, regularization, tolerance=1e-6, cutoff=None, rest_condition="consistent"
    )
    peaks = peaks_at(system, pairs, demand, step_tolerance)
    mu = np.where((peaks.code == SOLVED)[:, None], peaks.value, np.nan) / ground_peak(scene, pairs)[:, None]
    return mu, float(scene.duration / peaks.steps.mean())


def run_engine_once(
    scene: Scene, phases: ArrayLike, model: str, regularization: float, step: float = 1.0, **level: Any
) -> Array:
    """
    Return the amplification, (phase pairs, bodies), by one run of Exudyn at each phase pair.

    The run is at one accuracy level, a set of numerical parameters, with its steps multiplied by `step`. level:
    parameters that are changed, by name of the field of `multibody.Level`.
    """
    usual = multibody.levels(scene, model, regularization=regularization)[DEFAULT_ENGINE_LEVEL]
    changed = replace(usual, step=usual.step * step, slip_change=usual.slip_change * step, **level)
    return _compute_factors(scene, phases, lambda run: run.peak, model, regularization, level=changed)


def run_at_constant_step(scene: Scene, phases: ArrayLike, solver: str, step: float, v_reg: float) -> Array:
    """
    Return the amplification of the translational model, (phase pairs, bodies), by Exudyn at a constant step, s.

    solver: name of Exudyn's integrator. A run that fails has NaN.
    """

    def largest(run: Any) -> Array:
        """Return the largest absolute acceleration of every body over its motion, m/s^2."""
        size: Array = np.linalg.norm(run.absolute_acceleration, axis=-1).max(axis=0)
        return size

    how = {"step": step, "integrator": solver, "discontinuous": DISCONTINUOUS_TOLERANCE}
    return _compute_factors(scene, phases, largest, "translational", v_reg, **how)


def _compute_factors(
    scene: Scene, phases: ArrayLike, peak: Callable[[Any], Array], model: str, v_reg: float, **how: Any
) -> Array:
    """
    Return the amplification, (phase pairs, bodies), by one run of Exudyn at each phase pair; NaN where it ends early.

    peak: returns the largest acceleration of each body from a run. how: numerical parameters of the run.
    """
    pairs = check_phases(phases)
    runs = [multibody.single_run(scene, phase, model, v_reg, **how) for phase in pairs]
    nothing = np.full(len(scene.bodies), np.nan)
    return (
        np.array([peak(run) if run.status == Outcome.OK else nothing for run in runs])
        / ground_peak(scene, pairs)[:, None]
    )
