"""
One phase pair to a tolerance: the whole run at successive levels of accuracy, and an error from their differences.

The difference of two levels, at the factor seen or at two, is the error of the finer one from step, contact and
Newton's iteration together. Where rounding forbids a stiffer contact the levels share one, and what its compliance
leaves is told by one more run with a softer contact.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from multibody.integration.adaptive import LONG, Budget, March, march
from multibody.integration.balance import balanced
from multibody.integration.constant_step import Engine
from multibody.integration.estimate import WARPING, from_compliance, from_levels, from_sharing
from multibody.integration.level import FALL, MOST, Level, levels
from multibody.integration.peak import Peaks
from multibody.models.system import EngineModel
from reference.problem import Outcome, Scene, State, ground_acceleration

Array = NDArray[np.float64]

WORK = 8e6  # nominal microseconds (see `Budget`) of all runs of one point, before it is given up
UNFINISHED = (Outcome.STEP_LIMIT, Outcome.SOLVER_FAILED)
PREDICTED = 3.0  # steps of the first two levels over those of the first: without both there is no answer
SHARING = 0.2  # share of the tolerance that the load of warped supports may take as an error
GROWTH = 2.0  # steps of a level over those of the one before, at most


@dataclass(frozen=True)
class Refined:
    """
    What refinement found for one phase pair.

    peaks, errors: (N,), m/s^2, NaN without an answer. instant: s, when a status other than ok arose. finest: the last
    march.
    """

    peaks: Array
    errors: Array
    outcome: Outcome
    instant: float
    finest: March


def work_needed(model: EngineModel, end: float, largest: float) -> float:
    """
    Least work of a point, two levels without a shorter step, as a share of what it may spend.

    end, largest: duration and largest step of the first level, in units of the model.
    """
    steps = PREDICTED * end / largest
    return Budget.of(WORK, model.coordinates).cost(steps, steps / LONG) / WORK


def refine(
    scene: Scene,
    model: EngineModel,
    phase: Array,
    tolerance: float,
    *,
    initial: State | None = None,
    keep: bool = False,
    plan: Sequence[Level] | None = None,
) -> Refined:
    """
    Peaks of the absolute accelerations for one phase pair (2,), rad, with a relative error below `tolerance`.

    plan: the levels, if others than `levels` gives are to be tried.
    """
    units = model.units
    end = scene.duration / units.time
    model.ground.set_phase(phase)
    first = ground_acceleration(scene, phase, [0.0])[0]
    budget = Budget.of(WORK, model.coordinates)
    plan = levels(scene, model, tolerance) if plan is None else list(plan)
    nothing = np.full(len(model.bodies), np.nan)
    if work_needed(model, end, plan[0].step) > 1.0:
        none = March(Peaks(len(model.bodies), model.corner), Outcome.STEP_LIMIT, 0.0)
        return Refined(nothing, nothing, Outcome.STEP_LIMIT, 0.0, none)

    def ground(time: Array) -> Array:
        return ground_acceleration(scene, phase, time * units.time) / units.acceleration

    def run(level: Level) -> March:
        model.stiffen(level.penetration, level.gives_way)
        engine = Engine(model, level.newton, level.absolute)
        begin = model.start(initial, first, level.penetration)
        if initial is None:
            begin = balanced(engine, begin, level)
        return march(engine, begin, end, ground, level, budget, keep=keep)

    def compliance(stiff: March, level: Level) -> Array:
        softer = replace(level, penetration=FALL * level.penetration)
        return from_compliance(stiff.peaks, run(softer), softer, model)

    marches: list[March] = []
    best: tuple[March, Array] | None = None
    complete: tuple[March, Array] | None = None  # the last answer whose error lacks nothing
    left_out: Level | None = None  # the level of `best`, if what its compliance leaves is not part of the error yet
    for number, level in enumerate(plan):
        shared = number > 0 and level.penetration == plan[number - 1].penetration
        if marches and budget.left < GROWTH * budget.cost(marches[-1].steps, marches[-1].runs) * (1.0 + shared):
            break
        now = run(level)
        marches.append(now)
        if now.outcome in UNFINISHED:
            if best is not None or [past.outcome in UNFINISHED for past in marches].count(True) > 1:
                break
            continue
        best = None
        if now.warping * WARPING > SHARING * tolerance:
            rest = slice(number + 1, len(plan))
            plan[rest] = [_yielding(later, now.warping, tolerance) for later in plan[rest]]
        if number == 0 or marches[-2].outcome != now.outcome:
            continue
        marches[-2].chunks.clear()
        if now.outcome != Outcome.OK:
            break
        finished = [past.peaks for past in marches[-3:] if past.outcome == Outcome.OK]
        errors = from_levels(finished, list(plan[: number + 1]), model) + from_sharing(now)
        left_out = level if shared else None
        if left_out and (errors <= tolerance * now.peaks.value).all():
            errors, left_out = errors + compliance(now, level), None
        best = now, errors
        complete = complete if left_out else best
        if (errors <= tolerance * now.peaks.value).all():
            return _answer(model, now, errors, Outcome.OK)
        if (level.rounding > np.maximum(tolerance * now.peaks.value, errors / FALL)).any():
            break  # hardly more than rounding is left, and no further level rounds less
    if best is not None:
        now, errors = best
        if left_out:
            errors = errors + compliance(now, left_out)
        if np.isfinite(errors).all():
            return _answer(model, now, errors, Outcome.TOLERANCE_NOT_MET)
        # nothing tells what the compliance leaves: the run that should has no answer
        if complete is not None:
            return replace(_answer(model, *complete, Outcome.TOLERANCE_NOT_MET), finest=now)
        return Refined(nothing, nothing, Outcome.SOLVER_FAILED, scene.duration, now)
    # levels that do not agree, or end alike: by how the first of the last two that has no answer ends
    failed = next((past for past in marches[:-3:-1] if past.outcome != Outcome.OK), None)
    if failed is None:  # one level has an answer, and no steps are left for another that tells its error
        return Refined(nothing, nothing, Outcome.STEP_LIMIT, scene.duration, marches[-1])
    return Refined(nothing, nothing, failed.outcome, failed.instant * units.time, failed)


def _yielding(level: Level, load: float, tolerance: float) -> Level:
    """A level whose supports give way enough against warping, which took `load` of the weight in a run before."""
    wanted = level.gives_way * load * WARPING / (SHARING * tolerance)
    return replace(level, gives_way=min(wanted, MOST))


def _answer(model: EngineModel, finest: March, errors: Array, outcome: Outcome) -> Refined:
    """Peaks with their errors, and where the largest of them is if they miss the tolerance."""
    peaks = finest.peaks
    worst = float(peaks.instant[(errors / peaks.value).argmax()]) * model.units.time
    unit = model.units.acceleration
    return Refined(peaks.value * unit, errors * unit, outcome, math.nan if outcome == Outcome.OK else worst, finest)
