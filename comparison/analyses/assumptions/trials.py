"""Trials of the assumptions: the engine's two models for a variation, or along the worst direction of one."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from typing import Annotated

import numpy as np

from comparison.analyses.assumptions.variations import (
    FIRST_SIZE,
    LARGEST_SIZE,
    SMALLEST_SIZE,
    Axis,
    Variation,
    blind_by_symmetry,
    trials_of,
    with_size,
)
from comparison.result_types import Array, Number, Phases, Text, result
from comparison.runner.task import TaskResult
from comparison.study.batches import import_function
from comparison.study.models import Model
from reference.problem import Scene, SceneError
from reference.problem.reductions import body_cannot_tilt

DURATION = 6.0  # s, duration of motion: the loading is strongest in its first seconds
CHANGE_LIMITS = (0.01, 0.05)  # limits on the relative change of mu_i within which an assumption holds
SUFFICIENT_ERROR = 0.2 * CHANGE_LIMITS[0]  # relative error of mu_i that suffices to compare it with these limits
DIRECTION_PHASES = ((2.0, 0.7),)  # rad, phase pair at which the directions are compared
DIRECTION_V_REG = 1e-2  # m/s, ten times that of the study at a third of its cost: the worst direction is the same
# The search stops when the smallest failing size is within this factor of the largest passing one.
BISECTION_RATIO = 1.25


@dataclass(frozen=True)
class Trial:
    """mu of N bodies at M phase pairs (M, N) under a variation (None: translational model), errors, cost in s."""

    variation: Variation | None
    mu: Array
    error: Array
    status: tuple[str, ...]
    error_message: str
    cost: float

    def __post_init__(self) -> None:
        """Refuse arrays and statuses whose sizes disagree."""
        if self.mu.ndim != 2 or self.error.shape != self.mu.shape or len(self.status) != len(self.mu):
            raise ValueError(f"mu {self.mu.shape}, error {self.error.shape}, {len(self.status)} statuses")


@result
class DirectionTrial:
    """Change of mu by a variation in one direction, at one phase pair with a larger v_reg: to find the worst one."""

    scene: Annotated[Text, "name of the scene"]
    key: Annotated[Axis, "what varies"]
    variation: Annotated[Variation, "what is varied, in which direction"]
    change: Annotated[tuple[Number, ...], "relative change of mu against the stated spatial model, by body"]
    uncertainty: Annotated[tuple[Number, ...], "of the change, the two error estimates together, by body"]
    no_effect: Annotated[Text, "why symmetry leaves the trial without effect, so that it is no evidence; else empty"]
    worst: Annotated[bool, "whether the sizes of the variation are tried in this direction"]


@dataclass(frozen=True)
class TaskTrials:
    """Findings of one task: variations tried, the worst directions sought first, and an error message, or ""."""

    trials: tuple[Trial, ...]
    directions: tuple[DirectionTrial, ...] = ()
    error_message: str = ""


# Arguments of a task: scene, both models, what is tried, relative tolerance, phase pairs, largest number of sizes tried
Arguments = tuple[Scene, tuple[Model, Model], Variation | tuple[Axis, ...] | None, float, tuple[Phases, ...], int]


def answer_trials(task: Arguments) -> TaskTrials:
    """Compute mu under one variation, or under several sizes along the worst directions, in a worker process."""
    scene, (translational, spatial), what, tolerance, phases, sizes = task
    short = scene.with_values({"duration": min(scene.duration, DURATION), "name": scene.name})  # results go by name
    pairs = np.array(phases)
    if what is None:
        return TaskTrials((amplification_of(short, translational, None, tolerance, pairs),))
    if isinstance(what, Variation):
        # One phase pair verifies that symmetry leaves the amplification mu unchanged.
        checked = pairs[:1] if blind_by_symmetry(short, what) else pairs
        return TaskTrials((amplification_of(short, spatial, what, tolerance, checked),))
    plain = amplification_of(short, translational, None, tolerance, pairs)
    directions = find_worst_directions(short, spatial, what)
    trials: list[Trial] = []
    for key, worst in ((each.key, each.variation) for each in directions if each.worst):
        trials += follow_direction(short, spatial, key, worst, plain, tolerance, pairs, sizes)
    return TaskTrials(
        tuple(trials), directions, next((each.error_message for each in trials if each.error_message), "")
    )


def amplification_of(
    scene: Scene, model: Model, variation: Variation | None, tolerance: float, phases: Array, **settings: object
) -> Trial:
    """
    Return mu of a model for a scene with a variation, or as stated for None; settings replace the model's own.

    A variation that makes no valid scene, such as one whose support would carry nothing, has the status "refused".
    """
    try:
        varied = scene if variation is None else variation.of(scene)
    except SceneError as error:
        nothing = np.full((len(phases), len(scene.bodies)), np.nan)
        return Trial(variation, nothing, nothing, ("refused",) * len(phases), str(error), 0.0)
    whole = {"full": True} if body_cannot_tilt(varied) else {}  # no reduction: it would presume assumption (vi)
    asked = {**model.settings, **{key: value for key, value in settings.items() if key in model.settings}}
    found = import_function(model.amplification)(varied, phases, **asked, tolerance=tolerance, **whole)
    return Trial(variation, found.mu, found.error, tuple(map(str, found.status)), "", float(found.cost))


def find_worst_directions(scene: Scene, spatial: Model, keys: Sequence[Axis]) -> tuple[DirectionTrial, ...]:
    """
    Return a trial of mu for every direction of each varied quantity; the one with the largest change is marked worst.

    A direction without effect by symmetry is listed and not computed.
    """
    ask = partial(amplification_of, scene, spatial, tolerance=SUFFICIENT_ERROR, phases=np.array(DIRECTION_PHASES),
                  regularization=DIRECTION_V_REG)  # fmt: skip
    stated, found = None, []
    for key in keys:
        of_key = []
        for variation in trials_of(scene, key):
            reason = blind_by_symmetry(scene, variation)
            change: tuple[float, ...] = ()
            uncertainty: tuple[float, ...] = ()
            if not reason:
                stated = stated or ask(variation=None)
                change, uncertainty = (
                    tuple(rows[0].tolist()) for rows in compute_relative_change(ask(variation=variation), stated)
                )
            of_key.append(DirectionTrial(scene.name, key, variation, change, uncertainty, reason, False))
        telling = [trial for trial in of_key if not trial.no_effect]
        worst = max(telling, key=lambda trial: np.nan_to_num(np.abs(trial.change), nan=np.inf).max(), default=None)
        found += [replace(trial, worst=trial is worst) for trial in of_key]
    return tuple(found)


def follow_direction(
    scene: Scene, spatial: Model, key: Axis, worst: Variation, plain: Trial, tolerance: float, phases: Array, sizes: int
) -> Iterator[Trial]:
    """Yield trials of growing or shrinking sizes in one direction until each limit on the change of mu is bracketed."""
    tried: list[tuple[float, Array]] = []
    size: float | None = FIRST_SIZE[key]
    while size is not None and len(tried) < sizes:
        variation = with_size(worst, key, size)
        trial = amplification_of(scene, spatial, variation, tolerance, phases)
        if trial.error_message and tried:
            return  # At a larger size a support would carry nothing.
        change, uncertainty = compute_relative_change(trial, plain)
        tried.append((size, (np.abs(change) + uncertainty).max(axis=0)))
        yield trial
        size = next_size(tried, SMALLEST_SIZE[key], LARGEST_SIZE[key])


def next_size(tried: Sequence[tuple[float, Array]], smallest: float, largest: float) -> float | None:
    """
    Return the next size of a variation to try: smaller until a limit on mu is met, then between, then larger; or None.

    tried: sizes, each with the largest change of mu of every body, uncertainty included, NaN for no value.
    """
    between, smaller, larger = [], [], []
    for body, share in product(range(len(tried[0][1])), CHANGE_LIMITS):
        fails = min((size for size, change in tried if not change[body] <= share), default=math.inf)
        holds = max((size for size, change in tried if change[body] <= share and size < fails), default=0.0)
        if fails == math.inf:
            larger.append(min(2.0 * holds, largest))
        elif holds == 0.0:
            smaller.append(0.5 * fails)
        elif fails > BISECTION_RATIO * holds:
            between.append((fails / holds, math.sqrt(fails * holds)))
    if smaller and max(smaller) >= smallest:
        return max(smaller)
    if between:
        return max(between)[1]
    return next((size for size in sorted(larger) if size > max(tried)[0]), None) if larger else None


def compute_relative_change(trial: Trial, plain: Trial) -> tuple[Array, Array]:
    """Return the relative change (M, N) of mu from the trial `plain`, at its first M phase pairs, and the error."""
    base, error = plain.mu[: len(trial.mu)], plain.error[: len(trial.mu)]
    return trial.mu / base - 1.0, np.hypot(trial.error, error) / base


def without_answer(task: Arguments, failed: TaskResult) -> TaskTrials:
    """Return trials of NaN for a task that failed, with its outcome and message."""
    scene, _, what, _, phases, _ = task
    tried = [trials_of(scene, key)[-1] for key in what] if isinstance(what, tuple) else [what]
    nothing, statuses = np.full((len(phases), len(scene.bodies)), np.nan), (failed.outcome.value,) * len(phases)
    lost = (Trial(each, nothing, nothing, statuses, failed.error_message, 0.0) for each in tried)
    return TaskTrials(tuple(lost), (), failed.error_message)
