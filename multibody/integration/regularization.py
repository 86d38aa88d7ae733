"""
A v_reg so small that no contact follows the friction within it: a larger one answers, and its effect is an error.

At a stop the contact force changes while regularized friction relaxes, in a time in proportion to v_reg. Rounding of
the contact force limits how stiff a contact can be, and with it how fast it follows. Peaks approach those of the
set-valued law in proportion to v_reg (measured: 2e-6 at 1e-6 m/s, 2e-5 at 1e-5, 2e-4 at 1e-4). So a run at a v_reg
that the contact follows, and one at four times that, show what is left.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from multibody.integration.estimate import SAFETY_TWO_LEVELS, lag
from multibody.integration.level import levels_of
from multibody.integration.refine import Refinement
from multibody.models.system import EngineModel
from reference.problem import Outcome, Scene

MAX_LAG = 2.0  # of the stiffest contact: beyond it v_reg is not resolved
RESOLVED_LAG = 0.1  # of the stiffest contact at the speed that answers: runs at it need no more steps than others
REGULARIZATION_RATIO = 4.0  # of the two speeds that show the effect


def resolved_regularization(scene: Scene, model: EngineModel, regularization: float, tolerance: float) -> float:
    """`regularization`, m/s, of `model`, or the larger one that its stiffest contact follows."""
    smallest_lag = min(lag(level, model) for level in levels_of(scene, model, tolerance))
    return regularization if smallest_lag <= MAX_LAG else regularization * smallest_lag / RESOLVED_LAG


def with_regularization(point: Refinement, smoother: Refinement, tolerance: float) -> Refinement:
    """`point` with the error that its v_reg leaves, from `smoother` at `REGULARIZATION_RATIO` times that."""
    if np.isnan(point.peaks).any():
        return point
    if np.isnan(smoother.peaks).any():
        nothing = np.full_like(point.peaks, np.nan)
        return replace(point, peaks=nothing, errors=nothing, outcome=smoother.outcome, instant=smoother.instant)
    change = np.abs(point.peaks - smoother.peaks)
    errors = point.errors + SAFETY_TWO_LEVELS * change / (REGULARIZATION_RATIO - 1.0)
    if point.outcome == Outcome.OK and (errors > tolerance * point.peaks).any():
        return replace(point, errors=errors, outcome=Outcome.TOLERANCE_NOT_MET, instant=smoother.instant)
    return replace(point, errors=errors)
