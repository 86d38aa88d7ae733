"""The unit of work: some phases of one scene under one model. Runs inside a worker process."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comparison.study.models import Model
from comparison.wording import exception_line
from reference.problem import Outcome, Scene

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Batch:
    """Phase pairs number `first` ... `first` + len(phases) - 1 of those the model solves, phases (M, 2), rad."""

    scene: Scene
    model: str
    amplification: str
    settings: Mapping[str, object]
    first: int
    phases: Array
    level: int = 0  # of the nested grids, the first that has these phases
    timeout: float | None = None  # most processor time of the call, s; what takes longer is ended: Outcome.TIME_LIMIT
    lane: str = ""  # workers are shared within a lane only: an engine of the user may spoil the process it runs in


@dataclass(frozen=True)
class BatchResult:
    """What a batch gave, as `reference.problem.Amplification`; error_message: what the solver reported, or ""."""

    mu: Array
    error: Array
    status: list[str]
    instant: Array
    cost: float
    error_message: str = ""
    displacement: Array = field(default_factory=lambda: np.empty(0))

    def __post_init__(self) -> None:
        if not len(self.displacement):
            object.__setattr__(self, "displacement", np.full(len(self.mu), np.nan))


def imported(path: str) -> Any:
    """
    An object by its name.

    Parameters
    ----------
    path : str
        "package.module:name".

    Returns
    -------
    object
    """
    module, name = path.split(":")
    return getattr(import_module(module), name)


def refusal_of(scene: Scene, model: Model, tolerance: float, full: bool = False) -> str:
    """
    Why a model would refuse every phase pair of a scene, told without computing one.

    Parameters
    ----------
    scene : Scene
    model : Model
    tolerance : float
        Relative error asked of every mu.
    full : bool
        Whether nothing is reduced.

    Returns
    -------
    str
        Empty if it would not.
    """
    if model.refusal is None or not model.applies(scene):
        return ""
    asked = {"full": True} if full else {}
    return str(imported(model.refusal)(scene, **model.settings, tolerance=tolerance, **asked))


def execute_batch(batch: Batch) -> BatchResult:
    """
    Ask the batch's model. Runs inside a worker process.

    Parameters
    ----------
    batch : Batch

    Returns
    -------
    BatchResult
        What raises or answers in a wrong shape becomes points without an answer, and is named.
    """
    points, bodies = len(batch.phases), len(batch.scene.bodies)
    try:
        result = imported(batch.amplification)(batch.scene, batch.phases, **batch.settings)
        parts = (result.mu, result.error, result.instant, result.displacement)
        mu, error, instant, displacement = (np.array(part, dtype=float) for part in parts)
        status = [str(outcome) for outcome in result.status]
        shapes = mu.shape, error.shape, (len(status),), instant.shape, displacement.shape
        if shapes != ((points, bodies), (points, bodies), (points,), (points,), (points,)):
            raise ValueError(f"{batch.amplification} answered {mu.shape} for {points} phases and {bodies} bodies")
    except Exception as exception:
        return unanswered(batch, Outcome.SOLVER_FAILED, exception_line(exception))
    named = ""
    for index in ok_without_numbers(batch, mu, error, status):
        status[index] = Outcome.SOLVER_FAILED.value
        named = f"{batch.amplification} called a non-finite answer ok"
    return BatchResult(mu, error, status, instant, float(result.cost), named, displacement)


def ok_without_numbers(batch: Batch, mu: Array, error: Array, status: Sequence[str]) -> list[int]:
    """The phase pairs of a batch that are ok without a number for every body: no number that is none is an answer."""
    error_may_be_unknown = bool(batch.lane)
    finite = (np.isfinite(mu) & (np.isfinite(error) | error_may_be_unknown)).all(axis=1)
    return [index for index in np.flatnonzero(~finite).tolist() if status[index] == Outcome.OK]


def unanswered(batch: Batch, outcome: Outcome, error_message: str) -> BatchResult:
    """
    NaN for every point of a batch.

    Parameters
    ----------
    batch : Batch
    outcome : Outcome
        Why, for every point.
    error_message : str
        One line.

    Returns
    -------
    BatchResult
    """
    points, bodies = len(batch.phases), len(batch.scene.bodies)
    nothing = np.full((points, bodies), np.nan)
    return BatchResult(nothing, nothing.copy(), [outcome.value] * points, np.full(points, np.nan), 0.0, error_message)
