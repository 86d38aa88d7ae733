"""
The engine at a contact stiffness or a step that is given, as nobody would choose it.

The engine of the study chooses both by itself. Here the levels of refinement start at the step given, or keep the
stiffness given, so that it shows whether the error estimate knows what a bad choice costs.
"""

from __future__ import annotations

import math
import time
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from multibody.integration.constant_step import silence
from multibody.integration.level import RATIO, Level, levels
from multibody.integration.refine import refine
from multibody.models.assembly import assembled
from multibody.models.system import EngineModel
from reference.problem import GRAVITY, Amplification, Outcome, Scene, checked_phases, ground_peak

LEVELS = 4  # few: what is wanted is the answer at this choice, not the way from it to a good one


def amplification(
    scene: Scene,
    phases: ArrayLike,
    model: str = "translational",
    regularization: float | None = 1e-3,
    tolerance: float = 1e-2,
    contact_stiffness: float | None = None,
    step: float | None = None,
) -> Amplification:
    """
    As `multibody.amplification`. contact_stiffness: N/m, the same at all levels. step: s,
    the largest at the first level, halved from level to level.
    """
    pairs = checked_phases(phases)
    clock = time.process_time()
    shape = len(pairs), len(scene.bodies)
    mu, error = np.full(shape, np.nan), np.full(shape, np.nan)
    status, instant = np.full(len(pairs), Outcome.OK.value, dtype="U32"), np.full(len(pairs), np.nan)
    ground = ground_peak(scene, pairs)
    with silence():
        built = assembled(scene, model, regularization)
        plan = _levels(scene, built, tolerance, contact_stiffness, step)
        for m, phase in enumerate(pairs):
            point = refine(scene, built, phase, tolerance, plan=plan)
            status[m], instant[m] = point.outcome, point.instant
            mu[m], error[m] = point.peaks / ground[m], point.errors / ground[m]
    return Amplification(mu, error, status, instant, time.process_time() - clock)


def _levels(
    scene: Scene, model: EngineModel, tolerance: float, contact_stiffness: float | None, step: float | None
) -> list[Level]:
    plan = levels(scene, model, tolerance)[:LEVELS]
    if contact_stiffness is not None:
        penetration = scene.total_mass * GRAVITY / (contact_stiffness * model.units.length)
        rounding = model.rounding / penetration
        plan = [replace(level, penetration=penetration, rounding=rounding) for level in plan]
    if step is not None:
        longer = step / model.units.time / plan[0].step
        deeper = math.ceil(math.log(longer, RATIO))  # the smallest step stays what it is
        plan = [
            replace(
                level,
                step=level.step * longer,
                deepest=max(level.deepest + deeper, 0),
                chance=level.chance * max(longer, 1.0) ** 2,  # the method is of second order
            )
            for level in plan
        ]
    return plan
