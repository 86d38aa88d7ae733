"""Trials of the assumptions: amplifications of a varied scene by the engine, and the search for worst directions."""

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

DURATION = 6.0  # s, longest duration of motion computed: the loading is strongest in the first seconds
CHANGE_LIMITS = (0.01, 0.05)  # an assumption holds up to these relative changes of amplification: strictly, loosely
SUFFICIENT_ERROR = 0.2 * CHANGE_LIMITS[0]  # relative error of the amplification small enough for these limits
DIRECTION_PHASES = ((2.0, 0.7),)  # rad, phase pair at which the directions of a variation are compared
# m/s, slip speed below which friction is linear where the worst direction of a variation is searched
DIRECTION_V_REG = 1e-2  # ten times the study's: a third of its cost, the same worst direction is found
# The search for the variation size at which a limit is exceeded ends when its bounds differ by at most this factor.
BISECTION_RATIO = 1.25


@dataclass(frozen=True)
class Trial:
    """
    Amplification of a varied scene, by one of the engine's models.

    variation: None for the scene as stated. mu, error: amplification and its estimated absolute error, (M, N) for M
    phase pairs and N bodies. status: outcome of each pair. error_message: why the scene was refused, or "". cost:
    processor time, s.
    """

    variation: Variation | None
    mu: Array
    error: Array
    status: tuple[str, ...]
    error_message: str
    cost: float

    def __post_init__(self) -> None:
        """Raise ValueError if the sizes of mu, error and status disagree."""
        if self.mu.ndim != 2 or self.error.shape != self.mu.shape or len(self.status) != len(self.mu):
            raise ValueError(f"mu {self.mu.shape}, error {self.error.shape}, {len(self.status)} statuses")


@result
class DirectionTrial:
    """
    Change of amplification by a variation in one direction, computed to find the direction with the largest change.

    It is of one phase pair, and of friction that is linear below a slip speed of 1 cm/s.
    """

    scene: Annotated[Text, "name of the scene"]
    key: Annotated[Axis, "what varies"]
    variation: Annotated[Variation, "what is varied, in which direction"]
    change: Annotated[tuple[Number, ...], "relative change of mu against the stated spatial model, by body"]
    uncertainty: Annotated[tuple[Number, ...], "of the change, the two error estimates together, by body"]
    no_effect: Annotated[Text, "why symmetry leaves the trial without effect, so that it is no evidence; else empty"]
    worst: Annotated[bool, "whether the sizes of the variation are tried in this direction"]


@dataclass(frozen=True)
class TaskTrials:
    """Results of one task: its trials, the directions tried to find the worst one, and an error message or ""."""

    trials: tuple[Trial, ...]
    directions: tuple[DirectionTrial, ...] = ()
    error_message: str = ""


# Arguments of a task: the scene; the translational and the spatial model of the engine; one variation, or the
# quantities to vary in their worst directions, or None for the scene as stated; the relative error asked; the phase
# pairs; the largest number of sizes to try for each quantity
Arguments = tuple[Scene, tuple[Model, Model], Variation | tuple[Axis, ...] | None, float, tuple[Phases, ...], int]


def answer_trials(task: Arguments) -> TaskTrials:
    """
    Compute the amplifications of one task, in a worker process.

    They are those of the scene as stated, of one variation, or of several sizes of each quantity in its worst
    direction.
    """
    scene, (translational, spatial), what, tolerance, phases, sizes = task
    short = scene.with_values({"duration": min(scene.duration, DURATION), "name": scene.name})  # keep its name as key
    pairs = np.array(phases)
    if what is None:
        return TaskTrials((amplification_of(short, translational, None, tolerance, pairs),))
    if isinstance(what, Variation):
        # One phase pair suffices to verify that the amplification is unchanged where symmetry says so.
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
    Return the amplification of the varied scene by a model.

    variation: None for the scene as stated. settings: keyword arguments in place of the model's own of the same names.
    A variation that makes no valid scene, such as one whose support would carry nothing, has the status "refused".
    """
    try:
        varied = scene if variation is None else variation.of(scene)
    except SceneError as error:
        nothing = np.full((len(phases), len(scene.bodies)), np.nan)
        return Trial(
            variation=variation,
            mu=nothing,
            error=nothing,
            status=("refused",) * len(phases),
            error_message=str(error),
            cost=0.0,
        )
    whole = {"full": True} if body_cannot_tilt(varied) else {}  # do not reduce to translation: it is assumption (vi)
    asked = {**model.settings, **{key: value for key, value in settings.items() if key in model.settings}}
    found = import_function(model.amplification)(varied, phases, **asked, tolerance=tolerance, **whole)
    return Trial(
        variation=variation,
        mu=found.mu,
        error=found.error,
        status=tuple(map(str, found.status)),
        error_message="",
        cost=float(found.cost),
    )


def find_worst_directions(scene: Scene, spatial: Model, keys: Sequence[Axis]) -> tuple[DirectionTrial, ...]:
    """
    Return the change of amplification by a variation of each quantity in each of its directions.

    The direction with the largest change of a quantity is marked as its `worst`. A direction without effect by symmetry
    is listed and not computed.
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
            of_key.append(
                DirectionTrial(
                    scene=scene.name,
                    key=key,
                    variation=variation,
                    change=change,
                    uncertainty=uncertainty,
                    no_effect=reason,
                    worst=False,
                )
            )
        telling = [trial for trial in of_key if not trial.no_effect]
        worst = max(telling, key=lambda trial: np.nan_to_num(np.abs(trial.change), nan=np.inf).max(), default=None)
        found += [replace(trial, worst=trial is worst) for trial in of_key]
    return tuple(found)


def follow_direction(
    scene: Scene, spatial: Model, key: Axis, worst: Variation, plain: Trial, tolerance: float, phases: Array, sizes: int
) -> Iterator[Trial]:
    """Yield trials of several sizes in one direction until each limit on the change of amplification is bracketed."""
    tried: list[tuple[float, Array]] = []
    size: float | None = FIRST_SIZE[key]
    while size is not None and len(tried) < sizes:
        variation = with_size(worst, key, size)
        trial = amplification_of(scene, spatial, variation, tolerance, phases)
        if trial.error_message and tried:
            return  # At this larger size a support would carry no load.
        change, uncertainty = compute_relative_change(trial, plain)
        tried.append((size, (np.abs(change) + uncertainty).max(axis=0)))
        yield trial
        size = next_size(tried, SMALLEST_SIZE[key], LARGEST_SIZE[key])


def next_size(tried: Sequence[tuple[float, Array]], smallest: float, largest: float) -> float | None:
    """
    Return the next size of a variation to try, or None if the sizes at which changes exceed CHANGE_LIMITS are known.

    tried: sizes, each with the largest change of amplification of every body plus its uncertainty, NaN for no value.
    """
    # For every body and limit the change is within the limit at the size `holds` and beyond it at `fails`. While one of
    # the two is not known, sizes are halved or doubled. Then the widest bracket is divided at its geometric mean.
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
    """
    Return the relative change of amplification from `plain` to `trial`, and its uncertainty.

    Both are (M, N): the M phase pairs of `trial`, which are the first of `plain`, and N bodies.
    """
    base, error = plain.mu[: len(trial.mu)], plain.error[: len(trial.mu)]
    return trial.mu / base - 1.0, np.hypot(trial.error, error) / base


def without_answer(task: Arguments, failed: TaskResult) -> TaskTrials:
    """Return trials with amplification NaN for a task that failed, with its outcome and error message."""
    scene, _, what, _, phases, _ = task
    tried = [trials_of(scene, key)[-1] for key in what] if isinstance(what, tuple) else [what]
    nothing, statuses = np.full((len(phases), len(scene.bodies)), np.nan), (failed.outcome.value,) * len(phases)
    lost = tuple(
        Trial(variation=each, mu=nothing, error=nothing, status=statuses, error_message=failed.error_message, cost=0.0)
        for each in tried
    )
    return TaskTrials(trials=lost, error_message=failed.error_message)
