"""Amplification factors over the phases, by the engine."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from multibody.defaults import DEFAULT_TOLERANCE, DEFAULT_V_REG
from multibody.integration.constant_step import silence_engine
from multibody.integration.level import Level, check_levels
from multibody.integration.one_run import PhasePair
from multibody.integration.refine import MAX_WORK, WORK_RANGE, Refinement, refine
from multibody.models.assembly import assemble, choose_model
from multibody.models.system import EngineModel
from reference.problem import Amplification, Outcome, Scene, ground_peak
from reference.problem.phases import flat_phases
from reference.problem.ranges import LEAST_ACCELERATION, TOLERANCE_RANGE
from reference.problem.readings import SECOND_V_REG_RATIO, describe_law, reading_of
from reference.problem.reductions import has_planar_chain, turn_loading_to_x
from reference.problem.scene import require_scene
from reference.support.arguments import check_number

Array = NDArray[np.float64]


@require_scene
def amplification(
    scene: Scene,
    phases: ArrayLike,
    model: str = "translational",
    regularization: float | None = DEFAULT_V_REG,
    tolerance: float = DEFAULT_TOLERANCE,
    full: bool = False,
    levels: Sequence[Level] | None = None,
    max_work: float = MAX_WORK,
    softened: bool = False,
    regularization_effect: bool = False,
) -> Amplification:
    """
    Compute with the engine the amplification mu_i of each body: its largest acceleration over the ground's, (5.1).

    Parameters
    ----------
    scene : Scene
    phases : array_like, shape (..., 2)
        Initial phases of the two harmonics, rad, in any shape: one pair, a list of pairs, a grid.
    model : {"translational", "spatial"}
        The paper's degrees of freedom, or bodies that turn on supports that may open.
    regularization : float or None
        v_reg, m/s, below which dry friction is linear in the slip velocity; 0.001 (`DEFAULT_V_REG`) if not given. None
        only where the contact is lubricated or frictionless.
    tolerance : float
        Relative error that is asked of every amplification; 0.001 (`DEFAULT_TOLERANCE`) if not given.
    full : bool
        Compute the model that is asked for, even where the scene does not require it (reference.problem.reductions),
        and every run to the end of the motion.
    levels : sequence of Level, optional
        Levels of accuracy to go through, the coarsest first, in place of those of `multibody.levels`.
    max_work : float
        Steps of the engine that a point may take. A scene that needs more is refused before any step (`refusal`).
    softened : bool
        Take links given by `bars` as soft as the weight that they carry makes them (`Scene.softened`).
    regularization_effect : bool
        Compute every point with a tenth of v_reg, too, and give the change of amplification and displacement:
        `regularization_effect` (..., N) and `displacement_effect` (...), m, of the result, estimates of what
        regularization does. The amplification itself stays that of v_reg.

    Returns
    -------
    Amplification
        `mu` and its estimated absolute error `error`, both (..., N); `status` (...,); `instant` (...,), s, at which a
        status other than "ok" arose; `cost`, s; `cap_share` (...,) and `displacement` (...,), m. A point without an
        answer is NaN, with status "rim reached", "travel reached", "contact lost", "overturned", "solver failed",
        "step limit", "no ground motion" or "non-finite load". "tolerance not met" keeps its amplification with the
        error that was reached.

    Raises
    ------
    ValueError
        For wrong arguments, and for softened bars that buckle.

    Notes
    -----
    Where a support of the spatial model closes again, velocities jump. Accelerations count from 0.04 sqrt(rho / g)
    after such an impact on.

    The error is estimated from runs at two or more levels. It covers step, contact stiffness, iteration, reading of the
    peaks and rounding, and not what the model itself leaves out. That is first of all the law of friction, which `law`
    of the result names: dry friction is linear below v_reg, so the amplification is "as integrated" (`reading`),
    and a platform just below the limit of friction creeps. `regularization_effect` estimates what this changes.

    Examples
    --------
    >>> import multibody, reference
    >>> scene = reference.load_scene("fig3-I").with_values({"duration": 1.0})
    >>> multibody.amplification(scene, [(0.3, 1.1)]).status.tolist()
    ['ok']
    """
    stated, scene = scene, scene.softened() if softened else scene
    pairs, leading = flat_phases(phases)
    tolerance = check_number("tolerance", tolerance, TOLERANCE_RANGE)
    max_work = check_number("max_work", max_work, WORK_RANGE)
    levels = None if levels is None else check_levels(levels)
    clock = time.process_time()
    ground = ground_peak(scene, pairs)
    with silence_engine():
        reduced = _reduce_model(scene, model, regularization, full)
        mu, error, status, instant, displacement = reduced.answer(pairs, ground, tolerance, levels, max_work)
    cost, cap_share = time.process_time() - clock, displacement / scene.radius
    found = Amplification(
        mu,
        error,
        status,
        instant,
        cost,
        cap_share,
        pairs,
        displacement,
        scene_name=stated.name,
        model=f"Exudyn, {model} model",
        reading=reading_of(scene, regularization),
        law=describe_law(scene, regularization),
    ).reshaped(leading)
    if not regularization_effect:
        return found
    if not found.reading:  # without rigid dry friction regularization speed v_reg has no effect: both changes are 0
        nothing = np.where(np.isfinite(found.mu), 0.0, np.nan)
        return replace(found, regularization_effect=nothing, displacement_effect=nothing[..., 0])
    assert regularization is not None  # `assemble` refuses dry friction without a regularization speed
    v_reg = SECOND_V_REG_RATIO * regularization
    finer = amplification(scene, phases, model, v_reg, tolerance, full=full, levels=levels, max_work=max_work)
    effect, slip = finer.mu - found.mu, finer.displacement - found.displacement
    return replace(
        found,
        cost=found.cost + finer.cost,
        law=describe_law(scene, regularization, effect=(effect, slip)),
        regularization_effect=effect,
        displacement_effect=slip,
    )


@dataclass(frozen=True)
class _ReducedModel:
    """
    Smallest model with the same amplification mu as the model that the caller names.

    complete: assembles the model that the caller names, for pairs where the reduced model has no answer; None where it
    is not reduced. in_full: whether every run goes to the end of the motion.
    """

    scene: Scene
    built: EngineModel
    complete: Callable[[], tuple[Scene, EngineModel]] | None
    in_full: bool

    def answer(
        self, pairs: Array, ground: Array, tolerance: float, levels: Sequence[Level] | None, max_work: float
    ) -> tuple[Array, Array, NDArray[np.str_], Array, Array]:
        """
        Compute the amplification at phase pairs (M, 2), rad, to a relative error of `tolerance`.

        ground: largest ground accelerations, the denominators of (5.1), (M,), m/s^2. Returns amplifications and their
        errors, both (M, N), then statuses, the instants, s, at which a status other than ok arose, and the largest
        displacements of the platform, m, all three (M,).
        """
        count = len(pairs)
        mu, error = np.full((2, count, len(self.scene.bodies)), np.nan)
        status, (instant, displacement) = np.full(count, Outcome.OK.value, dtype="U32"), np.full((2, count), np.nan)
        for m, phase in enumerate(pairs):
            if ground[m] < LEAST_ACCELERATION:
                status[m], instant[m] = Outcome.NO_GROUND_MOTION, 0.0
            elif not np.isfinite(ground[m]):
                status[m], instant[m] = Outcome.NON_FINITE_LOAD, 0.0
            else:
                point = self.refine_point(phase, tolerance, levels, max_work)
                status[m], instant[m] = point.outcome, point.instant
                mu[m], error[m] = point.peaks / ground[m], point.errors / ground[m]
                if np.isfinite(point.peaks).all():
                    displacement[m] = point.finest.max_displacement * self.built.units.length
        return mu, error, status, instant, displacement

    def refine_point(
        self, phase: Array, tolerance: float, levels: Sequence[Level] | None, max_work: float
    ) -> Refinement:
        """
        Run levels of accuracy at one phase pair until the peaks meet the tolerance.

        If the reduced model has no answer, the model that the caller named is run.
        """
        pair = PhasePair(self.scene, self.built, phase, in_full=self.in_full)
        point = refine(pair, tolerance, levels=levels, max_work=max_work)
        if self.complete is not None and np.isnan(point.peaks).any():
            pair = PhasePair(*self.complete(), phase, in_full=self.in_full)
            point = refine(pair, tolerance, levels=levels, max_work=max_work)
        return point


def _reduce_model(scene: Scene, model: str, regularization: float | None, full: bool) -> _ReducedModel:
    """
    Assemble the cheapest model with the same amplification: a planar motion needs no coordinate normal to its plane.

    `complete` of the result assembles the model that the caller names.
    """
    chosen = choose_model(scene, model, full)
    planar = chosen == "translational" and not full and has_planar_chain(scene).allowed
    moving = turn_loading_to_x(scene) if planar else scene
    axes: dict[str, Any] = {"axes": 1} if planar else {}
    built = assemble(moving, chosen, regularization, **axes)

    def complete() -> tuple[Scene, EngineModel]:
        """Assemble the unreduced model named by the caller, for loading phases where the reduced one has no result."""
        return scene, assemble(scene, model, regularization)

    return _ReducedModel(scene=moving, built=built, complete=complete if chosen != model else None, in_full=full)
