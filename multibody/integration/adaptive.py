"""
One run of the engine in chunks, each with the step that the motion asks for there.

The engine's own control of the step answers to failed Newton iterations, not to wrong results. What a constant step
gets wrong here is the stop: while the slip speed is small, the slip direction turns and the regularised friction
relaxes within milliseconds. So the velocity of the platform may change in one step by no more than a fraction of the
slip speed (of v_reg, where the slip is slower than that). A chunk is kept up to the first step that breaks this, and
the run starts again from the stored state there with a smaller step; the step grows again once the motion allows it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from multibody.integration.constant_step import Engine, Motion
from multibody.integration.level import RATIO, Level
from multibody.integration.peak import NEAR, Peaks, kinks
from multibody.models.recorded import aligned
from multibody.models.system import EngineState
from reference.problem import Outcome

Array = NDArray[np.float64]

SETTLING = 2  # depth of the first chunk: the contact settles
LONG, SHORT = 256, 32  # steps in a chunk at the largest step at most, at smaller ones
ITERATIONS = 2  # of Newton's method in a step that costs what `Budget` says
STEPS_OF_RATE = 4  # over which the rate of a gap is taken
BEHIND = 4.0  # allowed turns times the relaxation of friction: first step behind a kink of the loading
LATEST = 8  # rows at the end of a chunk that decide whether the step may grow


@dataclass
class Budget:
    """
    Work left to all runs of one point: nominal microseconds, so that the answer does not depend on the machine.

    step, run: what a step costs, and what a run costs before its first step.
    """

    left: float
    step: float
    run: float

    @staticmethod
    def of(work: float, coordinates: int) -> Budget:
        """`work` for a model with so many coordinates, whose matrices are dense; coefficients measured."""
        return Budget(work, 8.0 + 0.6 * coordinates + 0.02 * coordinates**2, 2e-3 * coordinates**3)

    def cost(self, steps: float, runs: float) -> float:
        """Of so many steps in so many runs."""
        return self.step * steps + self.run * runs

    def allows(self, span: float, level: Level) -> bool:
        """Whether what is left is enough for `span` at the largest step of a level."""
        return self.cost(span / level.step, span / level.step / LONG) <= self.left


@dataclass
class March:
    """What a march found: peaks of each body, how it ended, the work, and its chunks if they were kept."""

    peaks: Peaks
    outcome: Outcome = Outcome.OK
    instant: float = math.nan  # in units of the model
    steps: int = 0
    runs: int = 0
    warping: float = 0.0  # largest load that supports on a plane would not carry, in shares of the weight
    reach: float = 0.0  # largest horizontal displacement of the platform, in units of length
    chunks: list[Motion] = field(default_factory=list)


def march(
    engine: Engine,
    start: EngineState,
    end: float,
    ground: Callable[[Array], Array],
    level: Level,
    budget: Budget,
    *,
    keep: bool = False,
) -> March:
    """Run from `start` at time 0 to `end`; ground: plate's acceleration (T, 3) at times (T,), in units of the model."""
    model = engine.model
    result = March(Peaks(len(model.bodies), model.corner, model.ground.knots, model.ground.near))
    if not budget.allows(end, level):
        return _ended(result, Outcome.STEP_LIMIT, 0.0)
    state, time, depth, ahead = start, 0.0, SETTLING, LONG
    while time < end * (1.0 - 1e-12):
        depth = max(depth, level.shallowest(time))
        step = level.step / RATIO**depth
        count = ahead if depth == 0 else SHORT
        count = min(count, math.ceil((end - time) / step * (1.0 - 1e-12)))
        step, count = aligned(model.ground.knots, model.ground.near, time, min(step, (end - time) / count), count)
        motion = engine.run(state, time, step, count)
        result.runs += 1
        result.steps += count if motion is None else len(motion.time) - 1
        budget.left -= budget.cost(max(count, engine.iterations / ITERATIONS), 1)
        if budget.left < 0.0:
            return _ended(result, Outcome.STEP_LIMIT, time)
        if motion is None or not np.isfinite(motion.accelerations).all():
            if depth == level.deepest:
                return _ended(result, Outcome.SOLVER_FAILED, time)
            depth += 1
            continue
        below = motion.plate[:, 2] if model.moving_plate else ground(motion.time)
        absolute = motion.accelerations[:, model.bodies] + below[:, None, :]
        excess = np.maximum(
            _excess(motion, engine, step / level.turn),
            _behind_kinks(motion, absolute[:, 0], engine, float(result.peaks.value[0]), step / level.turn),
        )
        last = len(motion.time) - 1
        failing = np.flatnonzero(excess > 1.0)
        refused = depth < level.deepest and len(failing) > 0
        if refused:
            last = max(int(failing[0]) - 1, 0)
        if last > 0:
            kept = motion.upto(last)
            outcome, row = _fate(kept, engine)
            if keep:
                result.chunks.append(kept.upto(row))
            if outcome != Outcome.OK:
                return _ended(result, outcome, float(kept.time[row]))
            result.warping = max(result.warping, _warping(kept, engine, level))
            result.reach = max(result.reach, _reach(kept, model.bodies[0, :2]))
            result.peaks.add(kept.time, absolute[: last + 1], kept.slip)
            state, time = kept.state(last), float(kept.time[last])
            ahead = _steps_ahead(kept, engine, level)
            if refused:
                state = model.settle(state, _gap_rate(kept), level.penetration)
        if refused:
            depth += 1 if excess[failing[0]] < RATIO else 2
            depth = min(depth, level.deepest)
        elif depth > 0 and excess[-LATEST:].max() * RATIO < 1.0:
            depth -= 1
    return result


def _reach(motion: Motion, axes: NDArray[np.int_]) -> float:
    """Largest displacement along two coordinates: where its rate changes sign, that is linear in between."""
    place = motion.coordinates[:, axes]
    square, rate = (place**2).sum(axis=1), (place * motion.velocities[:, axes]).sum(axis=1)
    before, behind = rate[:-1], rate[1:]
    turns = (before > 0.0) & (behind < 0.0)
    summits = square[:-1] + np.divide(before**2, before - behind, where=turns, out=np.zeros_like(before)) * np.diff(
        motion.time
    )
    return float(np.sqrt(max(square.max(), summits.max(initial=0.0, where=turns))))


def _ended(result: March, outcome: Outcome, instant: float) -> March:
    result.outcome, result.instant = outcome, instant
    return result


def _excess(motion: Motion, engine: Engine, per_turn: float) -> Array:
    """Change of the slip velocity in one step over what is allowed, (T,)."""
    corner = engine.model.corner
    if not np.isfinite(corner):
        return np.zeros(len(motion.time))
    acceleration = motion.accelerations[:, engine.model.bodies[0]]
    size = np.linalg.norm(acceleration, axis=-1)
    # an acceleration that changes within a step counts twice: it says more about the steps that follow
    size[1:] = np.maximum(size[1:], 2.0 * np.linalg.norm(np.diff(acceleration, axis=0), axis=-1))
    excess: Array = per_turn * size / np.maximum(motion.slip.min(axis=1), corner)
    return excess


def _behind_kinks(motion: Motion, platform: Array, engine: Engine, peak: float, per_turn: float) -> Array:
    """
    First step behind a kink of the loading over what is allowed, (T,), where the peak may be: zero elsewhere.

    While the platform creeps its acceleration follows the ground's with the relaxation of regularised friction, whose
    change of slope behind a kink longer steps would take for a swing.
    """
    excess, model = np.zeros(len(motion.time)), engine.model
    rows = kinks(motion.time, model.ground.knots, model.ground.near)
    if len(rows) and np.isfinite(model.corner):
        size = np.linalg.norm(platform, axis=-1)
        rows = rows[(size[rows] > NEAR * max(peak, float(size.max()))) & (motion.slip[rows].min(axis=1) < model.corner)]
        excess[np.minimum(rows + 1, len(excess) - 1)] = per_turn / (BEHIND * model.relaxation)
    return excess


def _warping(motion: Motion, engine: Engine, level: Level) -> float:
    """Largest load that warping takes while all contacts are closed: what keeps the supports from elastic sharing."""
    if engine.model.warped is None:
        return 0.0
    closed = (motion.gap < 0.0).all(axis=1)
    return float(engine.model.warped(motion.coordinates)[closed].max(initial=0.0)) / level.gives_way


def _gap_rate(motion: Motion) -> Array:
    """Rate of each gap at the end of a chunk, (K,), over an even number of steps: the contact may alternate."""
    rows = min(STEPS_OF_RATE, (len(motion.time) - 1) // 2 * 2)
    if rows == 0:
        return np.zeros(motion.gap.shape[1])
    rate: Array = (motion.gap[-1] - motion.gap[-1 - rows]) / (motion.time[-1] - motion.time[-1 - rows])
    return rate


def _steps_ahead(motion: Motion, engine: Engine, level: Level) -> int:
    """How many of the largest steps to try: up to where the slip speed, going on as now, asks for smaller ones."""
    corner = engine.model.corner
    if len(motion.time) < 2 or not np.isfinite(corner):
        return LONG
    slip = motion.slip[-2:].min(axis=1)
    rate = (slip[1] - slip[0]) / (motion.time[-1] - motion.time[-2])
    target = corner
    if slip[1] > corner:
        size = float(np.linalg.norm(motion.accelerations[-1, engine.model.bodies[0]]))
        target = max(corner, size * level.step / level.turn)
    if (target - slip[1]) * rate <= 0.0:
        return LONG
    return int(np.clip((target - slip[1]) / rate / level.step, SHORT, LONG))


def _fate(motion: Motion, engine: Engine) -> tuple[Outcome, int]:
    """The first thing that ends the model's validity and its row; OK and the last row if there is none."""
    # by height: the horizontal offset only touches rho there and falls again beyond
    rise = motion.coordinates[:, engine.model.bodies[0, 2]]
    over = len(motion.time)
    rim = next(iter(np.flatnonzero(rise >= engine.model.rim)), over)
    lost = over if engine.model.liftoff else next(iter(np.flatnonzero((motion.gap >= 0.0).all(axis=1))), over)
    if min(rim, lost) == over:
        return Outcome.OK, over - 1
    return (Outcome.RIM_REACHED, int(rim)) if rim <= lost else (Outcome.CONTACT_LOST, int(lost))
