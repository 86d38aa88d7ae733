"""One run of either side with a numerical parameter at a given value: no second run, hence no error estimate."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from multibody.integration.adaptive import Budget, march
from multibody.integration.balance import balanced
from multibody.integration.constant_step import Engine, silence
from multibody.integration.level import Level, levels
from multibody.integration.refine import WORK
from multibody.models.assembly import assembled
from multibody.models.system import EngineModel
from reference.problem import Outcome, Scene, checked_phases, ground_acceleration, ground_peak
from reference.solver.certified import peaks_at
from reference.solver.system import SOLVED
from reference.surface import checked_demand

Array = NDArray[np.float64]

USUAL = 1  # level of the engine that answers at a tolerance of 1e-3


def reference_run(
    scene: Scene,
    phases: ArrayLike,
    inside: float,
    equations: str = "exact",
    regularization: float | None = None,
) -> tuple[Array, float]:
    """
    mu (M, N) of one run each with the tolerance `inside` its steps, NaN without an answer, and its mean step, s.

    The solver has no largest step to be given: events and this tolerance alone make its steps.
    """
    pairs = checked_phases(phases)
    system, demand = checked_demand(scene, equations, regularization, 1e-6, None, "consistent")
    found = peaks_at(system, pairs, demand, inside)
    mu = np.where((found.code == SOLVED)[:, None], found.value, np.nan) / ground_peak(scene, pairs)[:, None]
    return mu, float(scene.duration / found.steps.mean())


def engine_run(
    scene: Scene,
    phases: ArrayLike,
    model: str,
    regularization: float,
    step: float = 1.0,
    penetration: float | None = None,
    newton: float | None = None,
) -> Array:
    """
    mu (M, N) of one run of the engine each at its USUAL level, but for what is given; NaN without an answer.

    step: factor on the largest step and on the turn allowed in one. penetration: of the contact under the weight,
    in rho: the inverse of its stiffness. newton: relative tolerance of Newton's iteration.
    """
    pairs, mu = checked_phases(phases), []
    with silence():
        built = assembled(scene, model, regularization)
        usual = levels(scene, built, 1e-3)[USUAL]
        softness = usual.penetration if penetration is None else penetration
        level = replace(
            usual,
            step=usual.step * step,
            turn=usual.turn * step,
            penetration=softness,
            newton=usual.newton if newton is None else newton,
            rounding=built.rounding / softness,
        )
        for phase in pairs:
            mu.append(_peaks(scene, built, level, phase))
    return np.array(mu) / ground_peak(scene, pairs)[:, None]


def _peaks(scene: Scene, model: EngineModel, level: Level, phase: Array) -> Array:
    """Peaks (N,), m/s^2, of one march; NaN if it does not reach the end."""
    units = model.units
    model.ground.set_phase(phase)

    def ground(time: Array) -> Array:
        return ground_acceleration(scene, phase, time * units.time) / units.acceleration

    model.stiffen(level.penetration)
    engine = Engine(model, level.newton, level.absolute)
    begin = model.start(None, ground_acceleration(scene, phase, [0.0])[0], level.penetration)
    begin = balanced(engine, begin, level)
    budget = Budget.of(10.0 * WORK, model.coordinates)  # one run in place of all that refine a point
    found = march(engine, begin, scene.duration / units.time, ground, level, budget)
    if found.outcome != Outcome.OK:
        return np.full(len(scene.bodies), np.nan)
    peaks: Array = found.peaks.value * units.acceleration
    return peaks
