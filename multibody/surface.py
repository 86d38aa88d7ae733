"""Amplification factors over the phases with the engine."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from multibody.integrate import Engine, Motion, silence
from multibody.system import EngineModel
from multibody.translational import translational
from reference.problem import Amplification, Outcome, Scene, checked_phases, ground_acceleration, ground_peak

Array = NDArray[np.float64]

BUILDERS = {"translational": translational}


def builder_of(model: str) -> Callable[..., EngineModel]:
    """The function that assembles `model`. Raises ValueError for an unknown name."""
    if model not in BUILDERS:
        raise ValueError(f"model: {model!r}: must be one of {', '.join(sorted(BUILDERS))}")
    return BUILDERS[model]


def checked(name: str, value: float) -> float:
    """`value` if it is finite and positive. Raises ValueError."""
    if not (np.isfinite(value) and value > 0.0):
        raise ValueError(f"{name}: {value!r}: must be finite and greater than 0")
    return float(value)


COARSEST = 2e-3 / 0.159  # first step in units of sqrt(rho / g)
LEVELS = 6  # halvings before a point is given up
PENETRATION = 1e-5  # of rho
NEWTON = 1e-6


def amplification(
    scene: Scene,
    phases: ArrayLike,
    model: str = "translational",
    regularization: float = 1e-3,
    tolerance: float = 1e-3,
) -> Amplification:
    """
    Dynamic amplification factors mu_i of (5.1) for each phase pair, from the engine.

    phases: (M, 2), rad. regularization: v_reg in m/s, below which dry friction is linear in the slip velocity.
    tolerance: relative error asked of every mu.
    """
    pairs = checked_phases(phases)
    checked("tolerance", tolerance)
    build = builder_of(model)
    clock = time.process_time()
    shape = (len(pairs), len(scene.bodies))
    mu, error = np.full(shape, np.nan), np.full(shape, np.nan)
    status, instant = np.full(len(pairs), Outcome.OK.value, dtype="U32"), np.full(len(pairs), np.nan)
    ground = ground_peak(scene, pairs)
    with silence():
        engine = Engine(build(scene, checked("regularization", regularization), PENETRATION), NEWTON)
        for m, phase in enumerate(pairs):
            if ground[m] == 0.0:
                status[m], instant[m] = Outcome.NO_GROUND_MOTION, 0.0
                continue
            peaks, errors, status[m], instant[m] = _point(scene, engine, phase, tolerance)
            mu[m], error[m] = peaks / ground[m], errors / ground[m]
    return Amplification(mu, error, status, instant, time.process_time() - clock)


def _point(scene: Scene, engine: Engine, phase: Array, tolerance: float) -> tuple[Array, Array, str, float]:
    model = engine.model
    model.ground.set_phase(phase)
    begin = model.start(None, ground_acceleration(scene, phase, [0.0])[0])
    nothing = np.full(len(model.bodies), np.nan)
    before = nothing
    for level in range(LEVELS):
        count = int(np.ceil(scene.duration / model.units.time / COARSEST)) * 2**level
        motion = engine.run(begin, 0.0, scene.duration / model.units.time / count, count)
        if motion is None:
            continue
        outcome, when = _fate(motion, model)
        if outcome != Outcome.OK:
            return nothing, nothing, outcome, when
        peaks = _peaks(scene, phase, motion, model)
        errors = 1.25 * np.abs(peaks - before) + 1e-5 * peaks
        if (errors <= tolerance * peaks).all():
            return peaks, errors, Outcome.OK, np.nan
        before = peaks
    if np.isnan(before).any():
        return nothing, nothing, Outcome.SOLVER_FAILED, 0.0
    return peaks, errors, Outcome.TOLERANCE_NOT_MET, scene.duration


def _fate(motion: Motion, model: EngineModel) -> tuple[Outcome, float]:
    """The first thing in a run that ends the model's validity, and when, s."""
    offset = np.hypot(*motion.coordinates[:, model.bodies[0, :2]].T)
    ends = [
        (Outcome.NON_FINITE_LOAD, ~np.isfinite(offset)),
        (Outcome.RIM_REACHED, offset >= 1.0),
        (Outcome.CONTACT_LOST, motion.contact[:, 0] >= 0.0),
    ]
    first = [(motion.time[happens.argmax()] * model.units.time, outcome) for outcome, happens in ends if happens.any()]
    return (min(first)[1], min(first)[0]) if first else (Outcome.OK, np.nan)


def _peaks(scene: Scene, phase: Array, motion: Motion, model: EngineModel) -> Array:
    ground = ground_acceleration(scene, phase, motion.time * model.units.time)
    absolute = motion.accelerations[:, model.bodies] * model.units.acceleration + ground[:, None, :]
    peak: Array = np.sqrt((absolute**2).sum(axis=-1)).max(axis=0)
    return peak
