"""The engine as its tutorials use it: one run at constant step, peaks read at the steps, no error estimate."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

import multibody
from reference.problem import Outcome, Scene, checked_phases, ground_peak

Array = NDArray[np.float64]

DISCONTINUOUS = 1.0  # the engine's own default


def factors_at_constant_step(scene: Scene, phases: ArrayLike, solver: str, step: float, v_reg: float) -> Array:
    """
    mu (M, N) of the translational model by an integrator of `multibody.single_run`; NaN where the engine gives up.
    """
    pairs = checked_phases(phases)
    peaks = np.full((len(pairs), len(scene.bodies)), np.nan)
    for row, phase in enumerate(pairs):
        run = multibody.single_run(
            scene, phase, "translational", v_reg, step=step, integrator=solver, discontinuous=DISCONTINUOUS
        )
        if run.status == Outcome.OK:
            peaks[row] = np.linalg.norm(run.absolute_acceleration, axis=-1).max(axis=0)
    return peaks / ground_peak(scene, pairs)[:, None]
