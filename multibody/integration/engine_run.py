"""Result of one run of the engine, and the entry of accepted steps into it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from multibody.integration.chunk import (
    absolute_acceleration_sizes,
    find_last_row_near_peak,
    largest_distance,
    vector_lengths,
)
from multibody.integration.constant_step import EngineMotion
from multibody.integration.level import Level
from multibody.integration.peak import CANDIDATE_FRACTION, PeakReader
from multibody.models.system import EngineModel
from reference.problem import Outcome

Array = NDArray[np.float64]

# Acceleration (T, 3) of the ground plate under the bearings as a function of times (T,), in units of the model.
Ground = Callable[[Array], Array]

# A value of a run below this share of its largest one is not the largest at any other level of accuracy either.
SETTLED_FRACTION = 0.9

# Model time from a closing until the supports' warping has died out and its load is read, over sqrt(warping compliance)
WARPING_RELAXATION = 20.0


@dataclass
class Budget:
    """Number of engine steps that all runs of one phase pair may still take; unlike time, it depends on no machine."""

    steps_left: float

    def has_work_left_for(self, span: float, level: Level) -> bool:
        """Return whether enough steps are left to integrate a time `span` at the largest step of a level."""
        return span / level.step <= self.steps_left


@dataclass
class EngineRun:
    """
    Result of one run from the start of the loading to its end, or to the instant at which the run terminates.

    All values are in units of the model.

    Attributes:
    - peaks: Largest absolute acceleration of each body.
    - stop: Time at which the run was to stop.
    - outcome, instant: How the run ended, and when it terminated.
    - work: Steps as the budget counts them.
    - warping_load: Largest load that warping of the supports takes so far, in shares of the weight.
    - last_open_at: The latest instant at which a support carried no load.
    - max_displacement: Largest horizontal displacement of the platform.
    - max_vertical: Largest vertical acceleration of the platform, relative to the plate.
    - last_large_at: The last instant at which an acceleration or the displacement of the platform came within
      `SETTLED_FRACTION` of its largest value.
    - peaks_count_from: Instant at which contact forces have settled after the last impact: peaks are read from here on.
    - impacts: Number of times that supports closed again.
    - min_load: Smallest contact force in weights, of a model that ends where the contact opens.
    - has_opened: Whether any contact carried no load.
    - scanned_from: Instant from which the motion was only scanned in larger steps.
    - chunks: The motion, if it is kept.
    """

    peaks: PeakReader
    stop: float
    outcome: Outcome = Outcome.OK
    instant: float = math.nan
    work: float = 0.0
    warping_load: float = 0.0
    last_open_at: float = -math.inf
    max_displacement: float = 0.0
    max_vertical: float = 0.0
    last_large_at: float = 0.0
    peaks_count_from: float = -math.inf
    impacts: int = 0
    min_load: float = math.inf
    has_opened: bool = False
    scanned_from: float = math.inf
    chunks: list[EngineMotion] = field(default_factory=list)

    @property
    def lifts_off(self) -> bool:
        """True if any of the supports that share the load opened."""
        return self.last_open_at > -math.inf

    def terminate(self, outcome: Outcome, instant: float) -> EngineRun:
        """End this run with `outcome` at `instant`, and return it."""
        self.outcome, self.instant = outcome, instant
        return self


def begin_run(model: EngineModel, stop: float = math.inf) -> EngineRun:
    """Return the result of a run that has taken no step yet."""
    peaks = PeakReader(len(model.bodies), model.corner, model.ground.knots, model.ground.near)
    return EngineRun(peaks, stop)


def absolute_accelerations(model: EngineModel, motion: EngineMotion, ground: Ground) -> Array:
    """Return the sizes (T, N) of the bodies' absolute accelerations, in units of the model."""
    sizes: Array = absolute_acceleration_sizes(motion.accelerations, model.bodies, ground(motion.time))
    return sizes


def record_steps(
    run: EngineRun, motion: EngineMotion, size: Array, model: EngineModel, level: Level, read: bool = True
) -> None:
    """Enter accepted steps with accelerations `size` (T, N) in the result of a run; read: whether peaks count."""
    _record_warping(run, motion, model, level)
    axes = model.bodies[0, :2]
    distance = vector_lengths(motion.coordinates, axes)
    if distance.max() > CANDIDATE_FRACTION * run.max_displacement:
        displacement = largest_distance(motion.time, motion.coordinates, motion.velocities, axes)
        run.max_displacement = max(run.max_displacement, displacement)
    time, slip = motion.time, motion.slip
    if run.peaks_count_from > time[0]:
        time, slip, size, distance = _cut_rows_before(run.peaks_count_from, time, slip, size, distance)
    vertical = float(np.abs(motion.accelerations[:, model.bodies[0, 2]]).max())
    run.max_vertical = max(run.max_vertical, vertical)
    if read and len(time):
        run.peaks.add(time, size, slip)
        _record_last_large(run, time, size, distance)
    gap = float(motion.gap.max())
    run.has_opened |= gap >= 0.0
    if not model.allows_liftoff:
        run.min_load = min(run.min_load, -gap / level.penetration)


def _cut_rows_before(instant: float, time: Array, *columns: Array) -> list[Array]:
    """Return times (T,) and columns from `instant` on: an interpolated row there, then all later rows."""
    first = int(np.searchsorted(time, instant, side="right"))
    if first == len(time):
        return [time[first:], *(column[first:] for column in columns)]
    share = (instant - time[first - 1]) / (time[first] - time[first - 1])
    begin = [column[first - 1] + share * (column[first] - column[first - 1]) for column in columns]
    rows = [np.concatenate([value[None], column[first:]]) for value, column in zip(begin, columns)]
    return [np.append(instant, time[first:]), *rows]


def _record_last_large(run: EngineRun, time: Array, size: Array, displacement: Array) -> None:
    """Record the last instant at which an acceleration or the displacement came near its largest value so far."""
    large, far = SETTLED_FRACTION * run.peaks.value, SETTLED_FRACTION * run.max_displacement
    row = find_last_row_near_peak(size, large, displacement, far)
    if row >= 0:
        run.last_large_at = float(time[row])


def _record_warping(run: EngineRun, motion: EngineMotion, model: EngineModel, level: Level) -> None:
    """Record the largest warping load, the part of support forces without resultant, while all contacts are closed."""
    if model.warping_displacement is None:
        return
    displacement = model.warping_displacement(motion.coordinates)
    if run.lifts_off or motion.gap.max() >= 0.0:
        is_open = (motion.gap >= 0.0).any(axis=1)
        last_open = np.maximum.accumulate(np.where(is_open, motion.time, run.last_open_at))
        displacement = displacement[motion.time - last_open > WARPING_RELAXATION * math.sqrt(level.warping_compliance)]
        run.last_open_at = float(last_open[-1])
    run.warping_load = max(run.warping_load, float(displacement.max(initial=0.0)) / level.warping_compliance)
