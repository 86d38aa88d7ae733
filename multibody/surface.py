"""Amplification factors over the phases with the engine."""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import ArrayLike

from multibody.integration.constant_step import silence
from multibody.integration.refine import refine
from multibody.models.assembly import assembled
from reference.problem import (
    Amplification,
    Outcome,
    Scene,
    checked_phases,
    ground_peak,
    in_plane,
    planar_chain,
    untilted,
)
from reference.problem.ranges import LEAST_ACCELERATION, TOLERANCE, checked_number


def amplification(
    scene: Scene,
    phases: ArrayLike,
    model: str = "translational",
    regularization: float | None = 1e-3,
    tolerance: float = 1e-3,
    loading: str = "inertial",
    full: bool = False,
) -> Amplification:
    """
    Dynamic amplification factors mu_i of (5.1) for each phase pair, from the engine.

    phases: (M, 2), rad. regularization: v_reg in m/s, below which dry friction is linear in the slip velocity; may be
    None where the contact is lubricated or frictionless. tolerance: relative error asked of every mu. loading:
    "inertial" forces in the plate's frame, or motion of the "plate", which carries the supports. full: the model asked
    for, even where the scene does not require it (reference.problem.reductions).

    A point without an answer is NaN, with status "rim reached", "contact lost", "solver failed", "step limit" or "no
    ground motion"; "tolerance not met" keeps its mu with the error reached. Raises ValueError for wrong arguments.
    """
    pairs = checked_phases(phases)
    tolerance = checked_number("tolerance", tolerance, TOLERANCE)
    clock = time.process_time()
    shape = (len(pairs), len(scene.bodies))
    mu, error = np.full(shape, np.nan), np.full(shape, np.nan)
    status, instant = np.full(len(pairs), Outcome.OK.value, dtype="U32"), np.full(len(pairs), np.nan)
    cap_share = np.full(len(pairs), np.nan)
    ground = ground_peak(scene, pairs)
    level = model == "spatial" and not full and untilted(scene).allowed
    chosen = "translational" if level else model
    flat = chosen == "translational" and not full and planar_chain(scene).allowed
    moving = in_plane(scene) if flat else scene
    with silence():
        more = {"axes": 1} if flat else {}
        built = assembled(moving, chosen, regularization, loading=loading, contact_force=False, **more)
        for m, phase in enumerate(pairs):
            if ground[m] < LEAST_ACCELERATION:
                status[m], instant[m] = Outcome.NO_GROUND_MOTION, 0.0
            elif not np.isfinite(ground[m]):
                status[m], instant[m] = Outcome.NON_FINITE_LOAD, 0.0
            else:
                point = refine(moving, built, phase, tolerance)
                if level and np.isnan(point.peaks).any():  # off its supports the model asked for goes on
                    whole = assembled(scene, model, regularization, loading=loading)
                    point = refine(scene, whole, phase, tolerance)
                status[m], instant[m] = point.outcome, point.instant
                mu[m], error[m] = point.peaks / ground[m], point.errors / ground[m]
                if np.isfinite(point.peaks).all():
                    cap_share[m] = point.finest.reach
    return Amplification(mu, error, status, instant, time.process_time() - clock, cap_share)
