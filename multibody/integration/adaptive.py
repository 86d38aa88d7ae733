"""
Adaptive integration: one run of the engine in chunks, each with the step that the motion needs there.

The engine's own control of the step answers to failed Newton iterations, not to wrong results. What a constant step
gets wrong here is the stop. While the slip speed is small, the slip direction turns and the regularized friction
relaxes within milliseconds. So the velocity of the platform may change in one step by no more than a fraction of the
slip speed (of v_reg, where the slip is slower than that). A chunk is accepted up to the first step that breaks this.
The run starts again from the stored state there with a smaller step. The step grows again once the motion allows it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from multibody.integration.chunk import (
    absolute_acceleration_sizes,
    distances,
    find_first_ends,
    largest_distance,
    find_last_near,
    slowest_loaded_slip,
    slip_changes,
)
from multibody.integration.constant_step import EngineSolver, EngineMotion
from multibody.integration.level import STEP_RATIO, Level
from multibody.integration.openings import FIRST_STEP, Event, Openings
from multibody.integration.peak import CANDIDATE_FRACTION, PeakReader, find_kinks
from multibody.integration.travel import find_travel_end
from multibody.models.recorded import align_steps
from multibody.models.state import EngineState
from multibody.models.system import EngineModel
from reference.problem import Outcome

Array = NDArray[np.float64]

FIRST_DIVISIONS = 2  # of the largest step in the first chunk: the contact settles
MIN_CHUNK_STEPS, MAX_CHUNK_STEPS = 32, 256  # steps in a chunk at the largest step
# steps in a chunk at smaller steps, times the allowed change of the slip velocity: the chunks of all levels then end,
# and their steps grow, at the same instants; within bounds for levels that no model has by itself
DIVIDED_CHUNK_CHANGE = 4.48
MIN_DIVIDED_CHUNK_STEPS, MAX_DIVIDED_CHUNK_STEPS = 8, 4096
CHUNK_GROWTH = 2  # of the steps in a chunk at the largest step over those of the one before
FREE_ITERATIONS = 2  # of Newton's method in a step; further ones count as steps
GAP_RATE_STEPS = 4  # over which the rate of a gap is taken
KINK_STEP_RATIO = 4.0  # first step behind a kink of the loading over slip_change times the relaxation of friction
# step times the rate at which friction that depends on the slip speed acts back on it (SpeedFriction), over the allowed
# change of the slip velocity; at most, as well below the 2/3 at which steps of alternating friction begin to grow
FEEDBACK_PER_SLIP_CHANGE, MAX_FEEDBACK = 2.0, 0.3
RIM = 1.0  # largest rise of the platform, in units of length, which is rho
RECENT_ROWS = 8  # at the end of a chunk: they decide whether the step may grow
SETTLED_FRACTION = 0.9  # of a largest value: later values below it do not reach it in a run of another level either
WARPING_RELAXATION = 20.0  # time until warping has relaxed, in square roots of the warping compliance


@dataclass
class Budget:
    """Steps of the engine left to all runs of one point: the answer does not depend on the machine."""

    left: float

    def allows(self, span: float, level: Level) -> bool:
        """Whether what is left is enough for `span` at the largest step of a level."""
        return span / level.step <= self.left


@dataclass
class Checkpoint:
    """Where a run is, and how it goes on from there."""

    state: EngineState
    time: float = 0.0  # in units of time
    divisions: int = FIRST_DIVISIONS  # of the largest step
    next_count: int = MAX_CHUNK_STEPS  # steps of the next chunk at the largest step


@dataclass
class EngineRun:
    """The result of one run from the start of the loading to its end, or to where the run terminates."""

    peaks: PeakReader  # of each body
    stop: float  # when it was to stop, in units of time
    outcome: Outcome = Outcome.OK
    instant: float = math.nan  # of a termination, in units of time
    work: float = 0.0  # steps as the budget counts them
    warping_load: float = 0.0  # largest load that warping of the supports takes so far, in shares of the weight
    last_open: float = -math.inf  # the latest instant at which a support carried no load, in units of time
    max_displacement: float = 0.0  # horizontal, of the platform, in units of length
    max_vertical: float = 0.0  # acceleration of any body, relative to the plate
    # the last instant at which an acceleration or the displacement of the platform came within SETTLED_FRACTION of its
    # largest value, in units of time
    settled: float = 0.0
    peaks_count_from: float = (
        -math.inf
    )  # contact forces have settled after the last impact: peaks are read from here on
    impacts: int = 0  # of supports that closed again
    min_load: float = math.inf  # smallest contact force, in weights, of a model that ends where the contact opens
    opened: bool = False  # whether any contact carried no load
    scanned_from: float = math.inf  # from here on the motion was only looked over in larger steps, in units of time
    chunks: list[EngineMotion] = field(default_factory=list)  # the motion, if it is kept

    @property
    def lifts_off(self) -> bool:
        """Whether a support of those that share the load opened."""
        return self.last_open > -math.inf

    def terminate(self, outcome: Outcome, instant: float) -> EngineRun:
        """This run, which ends with `outcome` at `instant`."""
        self.outcome, self.instant = outcome, instant
        return self


def run_adaptively(
    engine: EngineSolver,
    start: EngineState,
    end: float,
    ground: Callable[[Array], Array],
    level: Level,
    budget: Budget,
    *,
    stop: float = math.inf,
    keep: bool = False,
) -> EngineRun:
    """Run from `start` at 0 to `end`, not beyond `stop`; ground: plate's acceleration (T, 3) at times (T,)."""
    result = begin_run(engine.model, stop)
    if not budget.allows(min(end, stop), level):
        return result.terminate(Outcome.STEP_LIMIT, 0.0)
    continue_run(result, Checkpoint(start), engine, end, ground, level, budget, keep=keep)
    return result


def begin_run(model: EngineModel, stop: float = math.inf) -> EngineRun:
    """The result of a run that has taken no step yet."""
    peaks = PeakReader(len(model.bodies), model.corner, model.ground.knots, model.ground.near)
    return EngineRun(peaks, stop)


def continue_run(
    result: EngineRun,
    place: Checkpoint,
    engine: EngineSolver,
    end: float,
    ground: Callable[[Array], Array],
    level: Level,
    budget: Budget,
    *,
    keep: bool = False,
    pause: Callable[[float], bool] = lambda time: False,
) -> Checkpoint:
    """Go on with a run from `place`; where it ends. Before every chunk `pause` says whether to end at its instant."""
    model = engine.model
    openings = None if model.impact is None else Openings(engine, model.impact, level.penetration)
    state, time, divisions, next_count = place.state, place.time, place.divisions, place.next_count
    while time < min(end, result.stop) * (1.0 - 1e-12) and not pause(time):
        divisions = max(divisions, level.min_divisions(time))
        step = level.step / STEP_RATIO**divisions
        asked = next_count if divisions == 0 else _count_small_steps(level)
        asked = min(asked, math.ceil((end - time) / step * (1.0 - 1e-12)))
        step, count = align_steps(model.ground.knots, model.ground.near, time, min(step, (end - time) / asked), asked)
        motion = engine.run(state, time, step, count)
        work = max(count, engine.iterations / FREE_ITERATIONS)
        result.work += work
        budget.left -= work
        if budget.left < 0.0:
            result.terminate(Outcome.STEP_LIMIT, time)
            break
        if motion is None or not np.isfinite(motion.accelerations).all():
            if divisions == level.max_divisions:
                result.terminate(Outcome.SOLVER_FAILED, time)
                break
            divisions += 1
            continue
        if openings is not None:
            motion = openings.fill_gaps_of_open_contacts(motion)
        size = absolute_accelerations(model, motion, ground)
        step_ratio = _step_ratio(motion, engine, size, result.peaks.value, step, level)
        last = len(motion.time) - 1
        failing = _first_row(step_ratio > 1.0)
        rejected = divisions < level.max_divisions and failing <= last
        if rejected:
            last = max(failing - 1, 0)
        event = None if openings is None else openings.find_first_event(motion.cut_at(last))
        if openings is not None and event is not None:
            last, rejected = event.row, False
        if last > 0:
            accepted = motion.cut_at(last)
            if not _record_chunk(result, accepted, size[: last + 1], model, level, keep):
                break
            state, time = accepted.state_at(last), float(accepted.time[last])
            if rejected:
                state = model.settle(state, _gap_rate(accepted), level.penetration)
        if openings is not None and event is not None:
            passed = _pass_event(event, openings, state, time, step, result, ground, level, keep)
            budget.left -= 1.0
            if passed is None:
                break
            state, time = passed
            if event.closes:
                divisions = max(divisions, _divisions_behind_impact(level))
            next_count = MIN_CHUNK_STEPS
        elif rejected:
            divisions += 1 if step_ratio[failing] < STEP_RATIO else 2
            divisions = min(divisions, level.max_divisions)
        else:
            # not what a knot left of it: restarts cost accuracy, and a chunk of one step up to a knot would make the
            # next ones as short
            before = asked if divisions == 0 else min(asked, MIN_CHUNK_STEPS)
            if divisions > 0 and step_ratio[-RECENT_ROWS:].max() * STEP_RATIO < 1.0:
                divisions -= 1
            if divisions == 0:
                next_count = min(_count_largest_steps(motion, engine, level), CHUNK_GROWTH * before)
    return Checkpoint(state, time, divisions, next_count)


def _pass_event(
    event: Event,
    openings: Openings,
    state: EngineState,
    time: float,
    step: float,
    result: EngineRun,
    ground: Callable[[Array], Array],
    level: Level,
    keep: bool,
) -> tuple[EngineState, float] | None:
    """State and instant behind an opening or closing of supports; None if the run ends before."""
    model = openings.engine.model
    motion = openings.locate_event(state, time, step, event)
    if motion is not None:
        size = absolute_accelerations(model, motion, ground)
        motion = (
            openings.close_contacts(motion, event.which)
            if event.closes
            else openings.fill_gaps_of_open_contacts(motion)
        )
        # so short a step tells nothing about a peak that may lie in it: forces have not settled at its end
        if not _record_chunk(result, motion, size, model, level, keep, read=False):
            return None
        state, time = motion.state_at(-1), float(motion.time[-1])
    if not event.closes:
        openings.open_contacts(event)
        return state, time
    if time > result.peaks_count_from:
        result.peaks.read_until(time)
    state = openings.apply_impact(state, time, event.which)
    result.peaks_count_from, result.impacts = openings.settled, openings.impacts
    result.peaks.restart()
    return state, time


def _divisions_behind_impact(level: Level) -> int:
    """How often the largest step is divided while contact forces settle."""
    wanted = math.ceil(math.log(level.step / (FIRST_STEP * math.sqrt(level.penetration)), STEP_RATIO))
    return min(max(wanted, 0), level.max_divisions)


def absolute_accelerations(model: EngineModel, motion: EngineMotion, ground: Callable[[Array], Array]) -> Array:
    """Sizes of the bodies' accelerations with that of the plate, (T, N), in units of the model."""
    plate = motion.plate[:, 2] if model.moving_plate else ground(motion.time)
    sizes: Array = absolute_acceleration_sizes(motion.accelerations, model.bodies, plate)
    return sizes


def _record_chunk(
    result: EngineRun,
    motion: EngineMotion,
    size: Array,
    model: EngineModel,
    level: Level,
    keep: bool,
    read: bool = True,
) -> bool:
    """Add an accepted chunk, read for peaks or not, up to where the model's validity ends; whether the run goes on."""
    outcome, row, instant = find_termination(motion, model)
    if keep:
        result.chunks.append(motion.cut_at(row))
    if outcome != Outcome.OK:
        result.terminate(outcome, instant)
        return False
    _record_warping(result, motion, model, level)
    axes = model.bodies[0, :2]
    distance = distances(motion.coordinates, axes)
    if distance.max() > CANDIDATE_FRACTION * result.max_displacement:
        displacement = largest_distance(motion.time, motion.coordinates, motion.velocities, axes)
        result.max_displacement = max(result.max_displacement, displacement)
    time, slip = motion.time, motion.slip
    if result.peaks_count_from > time[0]:
        time, slip, size, distance = _rows_from(result.peaks_count_from, time, slip, size, distance)
    vertical = float(np.abs(motion.accelerations[:, model.bodies[:, 2]]).max())
    result.max_vertical = max(result.max_vertical, vertical)
    if read and len(time):
        result.peaks.add(time, size, slip)
        _record_last_large(result, time, size, distance)
    gap = float(motion.gap.max())
    result.opened |= gap >= 0.0
    if not model.allows_liftoff:
        result.min_load = min(result.min_load, -gap / level.penetration)
    return True


def _rows_from(instant: float, time: Array, *columns: Array) -> list[Array]:
    """Times (T,) and columns from `instant` on, interpolated there: it is behind the first row."""
    first = int(np.searchsorted(time, instant, side="right"))
    if first == len(time):
        return [time[first:], *(column[first:] for column in columns)]
    share = (instant - time[first - 1]) / (time[first] - time[first - 1])
    begin = [column[first - 1] + share * (column[first] - column[first - 1]) for column in columns]
    rows = [np.concatenate([value[None], column[first:]]) for value, column in zip(begin, columns)]
    return [np.append(instant, time[first:]), *rows]


def _record_last_large(result: EngineRun, time: Array, size: Array, displacement: Array) -> None:
    """Record when something that is asked for last came near its largest value so far."""
    large, far = SETTLED_FRACTION * result.peaks.value, SETTLED_FRACTION * result.max_displacement
    row = find_last_near(size, large, displacement, far)
    if row >= 0:
        result.settled = float(time[row])


def _step_ratio(
    motion: EngineMotion, engine: EngineSolver, size: Array, peaks: Array, step: float, level: Level
) -> Array:
    """Each step over what is allowed there, (T,), from accelerations (T, N) and the peaks so far, (N,)."""
    per_change = step / level.slip_change
    step_ratio = _slip_step_ratio(motion, engine, per_change)
    if engine.model.friction is not None:
        allowed = min(FEEDBACK_PER_SLIP_CHANGE * level.slip_change, MAX_FEEDBACK)
        step_ratio = np.maximum(step_ratio, step / allowed * engine.model.friction.feedback(motion.slip))
    if len(engine.model.ground.knots):
        step_ratio = np.maximum(
            step_ratio, _kink_step_ratio(motion, size, engine, peaks, per_change, level.error_floor)
        )
    return step_ratio


def _slip_step_ratio(motion: EngineMotion, engine: EngineSolver, per_change: float) -> Array:
    """Change of the slip velocity in one step over what is allowed, (T,)."""
    corner = engine.model.corner
    if not math.isfinite(corner):
        return np.zeros(len(motion.time))
    changes: Array = slip_changes(motion.accelerations, engine.model.bodies[0], motion.contact, per_change, corner)
    return changes


def _kink_step_ratio(
    motion: EngineMotion, size: Array, engine: EngineSolver, peaks: Array, per_change: float, floor: float
) -> Array:
    """
    First step behind a kink of the loading over what is allowed, (T,), where a body's peak may be: zero elsewhere.

    While the platform creeps, its acceleration follows the ground's with the relaxation of regularized friction. Behind
    a kink its slope changes, which longer steps would take for a swing. Bodies that turn with it and dampers follow.
    Samples on one parabola, within `floor` of the peak, follow no kink.
    """
    step_ratio, model, last = np.zeros(len(motion.time)), engine.model, len(motion.time) - 1
    rows = find_kinks(motion.time, model.ground.knots, model.ground.near)
    rows = rows[rows < last]
    if len(rows) and np.isfinite(model.corner):
        largest = np.maximum(peaks, size.max(axis=0))
        bent = np.abs(np.diff(size[np.minimum(rows + np.arange(4)[:, None], last)], 3, axis=0)[0]) > floor * largest
        rows = rows[
            (bent & (size[rows] > CANDIDATE_FRACTION * largest)).any(axis=1)
            & (motion.slip[rows].min(axis=1) < model.corner)
        ]
        step_ratio[rows + 1] = per_change / (KINK_STEP_RATIO * model.relaxation)
    return step_ratio


def _record_warping(result: EngineRun, motion: EngineMotion, model: EngineModel, level: Level) -> None:
    """Record the largest load that warping takes while all contacts are closed: elastic supports would take none."""
    if model.warping_displacement is None:
        return
    displacement = model.warping_displacement(motion.coordinates)
    if result.lifts_off or motion.gap.max() >= 0.0:
        is_open = (motion.gap >= 0.0).any(axis=1)
        last_open = np.maximum.accumulate(np.where(is_open, motion.time, result.last_open))
        displacement = displacement[motion.time - last_open > WARPING_RELAXATION * math.sqrt(level.warping_compliance)]
        result.last_open = float(last_open[-1])
    result.warping_load = max(result.warping_load, float(displacement.max(initial=0.0)) / level.warping_compliance)


def _gap_rate(motion: EngineMotion) -> Array:
    """Rate of each gap at the end of a chunk, (K,), over an even number of steps: the contact may alternate."""
    rows = min(GAP_RATE_STEPS, (len(motion.time) - 1) // 2 * 2)
    if rows == 0:
        return np.zeros(motion.gap.shape[1])
    rate: Array = (motion.gap[-1] - motion.gap[-1 - rows]) / (motion.time[-1] - motion.time[-1 - rows])
    return rate


def _count_small_steps(level: Level) -> int:
    """Steps in a chunk of smaller steps than the largest."""
    steps = DIVIDED_CHUNK_CHANGE / level.slip_change
    return round(min(max(steps, MIN_DIVIDED_CHUNK_STEPS), MAX_DIVIDED_CHUNK_STEPS))


def _count_largest_steps(motion: EngineMotion, engine: EngineSolver, level: Level) -> int:
    """How many of the largest steps to try: up to where the slip speed, going on as now, asks for smaller ones."""
    corner = engine.model.corner
    if len(motion.time) < 2 or not math.isfinite(corner):
        return MAX_CHUNK_STEPS
    before, slip = slowest_loaded_slip(motion.contact, -2), slowest_loaded_slip(motion.contact, -1)
    if not math.isfinite(before + slip):
        return MAX_CHUNK_STEPS
    rate = (slip - before) / float(motion.time[-1] - motion.time[-2])
    target = corner
    if slip > corner:
        size = float(np.linalg.norm(motion.accelerations[-1, engine.model.bodies[0]]))
        target = max(corner, size * level.step / level.slip_change)
    if (target - slip) * rate <= 0.0:
        return MAX_CHUNK_STEPS
    return int(min(max((target - slip) / rate / level.step, MIN_CHUNK_STEPS), MAX_CHUNK_STEPS))


def find_termination(motion: EngineMotion, model: EngineModel) -> tuple[Outcome, int, float]:
    """The first event that ends the motion, its row and its instant; OK and the last row if there is none."""
    outcome, row = _find_end_of_validity(motion, model)
    instant, before = find_travel_end(motion, model)
    if instant <= motion.time[row]:
        return Outcome.TRAVEL_REACHED, before, instant
    return outcome, row, float(motion.time[row])


def _find_end_of_validity(motion: EngineMotion, model: EngineModel) -> tuple[Outcome, int]:
    """The first event that ends the model's validity and its row; OK and the last row if there is none."""
    count = len(motion.time)
    if model.depressions is not None:
        if model.depressions.is_near_rest(motion.coordinates):
            return Outcome.OK, count - 1
        tilt = _tilt(motion, model)
        row = _first_row(model.depressions.rows_beyond_rim(motion.coordinates) | (tilt >= 0.5 * math.pi))
        if row == count:
            return Outcome.OK, count - 1
        return Outcome.OVERTURNED if tilt[row] > model.critical_tilt else Outcome.RIM_REACHED, row
    # by height: the horizontal offset only touches rho at the rim and falls again beyond
    rim, contact_lost = find_first_ends(motion.coordinates, model.bodies[0, 2], RIM, motion.contact)
    contact_lost = count if model.allows_liftoff else contact_lost
    if min(rim, contact_lost) == count:
        return Outcome.OK, count - 1
    return (Outcome.RIM_REACHED, rim) if rim <= contact_lost else (Outcome.CONTACT_LOST, contact_lost)


def _tilt(motion: EngineMotion, model: EngineModel) -> Array:
    """Angle of the platform's axis to the vertical, (T,), rad."""
    about_x, about_y = (motion.coordinates[:, axis] for axis in model.bodies[0, :2] + 3)
    tilt: Array = np.arccos(np.cos(about_x) * np.cos(about_y))
    return tilt


def _first_row(holds: Any) -> int:
    """The first row of (T,) in which something holds; T if there is none."""
    row = int(holds.argmax())
    return row if holds[row] else len(holds)
