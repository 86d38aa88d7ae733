"""Batch: phase pairs of one scene under one model, the question that a worker process answers for the surfaces."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from importlib import import_module
from typing import Any

import numpy as np

from comparison.result_types import Array
from comparison.study.models import Model
from comparison.wording import word_exception
from reference.problem import Amplification, Outcome, Scene, Trajectory

MAX_MU = 1e12  # largest amplification accepted as an answer: far above any building's, but its square stays finite
# Outcome, besides ok, with which amplifications of this project's models are used: the error exceeds the tolerance
USABLE_WITH_ERROR = Outcome.TOLERANCE_NOT_MET


@dataclass(frozen=True)
class Batch:
    """Consecutive phase pairs of one scene and model, which one call of the model's function computes."""

    scene: Scene
    model: str  # key of the model
    amplification: str  # its function, "package:name"
    settings: Mapping[str, object]  # further arguments of the function
    first: int  # number of phase pairs of this scene and model in earlier batches
    phases: Array  # the phase pairs, (M, 2), rad
    timeout: float | None = None  # s, limit on the processor time of the call that computes the batch
    group: str = ""  # key of a user's engine, which has its own workers and need not state errors of amplifications

    @property
    def points(self) -> int:
        """Return the number of phase pairs."""
        return len(self.phases)

    @property
    def question(self) -> dict[str, object]:
        """Return all that decides the numbers of every batch of a scene and model; the names of both do not count."""
        return {"scene": self.scene.digest(), "model": self.amplification, "settings": self.settings}

    def identity(self) -> dict[str, object]:
        """Return everything, besides the code, that determines the numbers of the batch."""
        return {**self.question, "phases": self.phases}

    def halves(self) -> list[Batch]:
        """Return the batches of the first and the second half of the phase pairs; none for a single pair."""
        middle = self.points // 2
        if not middle:
            return []
        late = replace(self, first=self.first + middle, phases=self.phases[middle:])
        return [replace(self, phases=self.phases[:middle]), late]

    def join(self, results: Sequence[BatchResult]) -> BatchResult:
        """Return the result of the batch joined from those of its halves: costs added up, each error message once."""
        mu, error, instant, displacement = (
            np.concatenate([getattr(result, name) for result in results])
            for name in ("mu", "error", "instant", "displacement")
        )
        status = [outcome for result in results for outcome in result.status]
        error_message = "; ".join(dict.fromkeys(result.error_message for result in results if result.error_message))
        return BatchResult(
            mu=mu,
            error=error,
            status=status,
            instant=instant,
            cost=sum(result.cost for result in results),
            error_message=error_message,
            displacement=displacement,
        )

    def without_result(self, outcome: Outcome, error_message: str) -> BatchResult:
        """Return a result with NaN and the same outcome at every phase pair, and with the error message."""
        nothing, none = np.full((self.points, len(self.scene.bodies)), np.nan), np.full(self.points, np.nan)
        status = [outcome.value] * self.points
        return BatchResult(
            mu=nothing,
            error=nothing.copy(),
            status=status,
            instant=none,
            cost=0.0,
            error_message=error_message,
            displacement=none.copy(),
        )

    def accepts(self, result: BatchResult) -> bool:
        """Return whether a result has the batch's numbers of phase pairs and bodies, and values where status is ok."""
        return self.fits(result) and not self.ok_without_numbers(result.mu, result.error, result.status)

    def fits(self, result: BatchResult) -> bool:
        """Return whether the arrays of a result have the batch's numbers of phase pairs and bodies."""
        points, plane = (self.points,), (self.points, len(self.scene.bodies))
        shapes = result.mu.shape, result.error.shape, result.instant.shape, result.displacement.shape
        return shapes == (plane, plane, points, points) and len(result.status) == self.points

    def ok_without_numbers(self, mu: Array, error: Array, status: Sequence[str]) -> list[int]:
        """Return the indices of phase pairs whose status is ok although a number is missing for some body."""
        finite = (np.isfinite(mu) & (np.isfinite(error) | bool(self.group))).all(axis=1)
        return [index for index in np.flatnonzero(~finite).tolist() if status[index] == Outcome.OK]


@dataclass(frozen=True)
class BatchResult:
    """Answer of a model to a batch of M phase pairs of a scene with N bodies."""

    mu: Array  # amplification, (M, N)
    error: Array  # its estimated absolute error, (M, N)
    status: list[str]  # outcome of every phase pair, (M,)
    instant: Array  # s, instant at which a status other than ok arose, (M,)
    cost: float  # s, processor time
    error_message: str  # what the call raised; "" without an error
    displacement: Array  # m, largest displacement of the platform, (M,)


def import_function(path: str) -> Any:
    """Import and return the object named `path`, in the form "package.module:name"."""
    module, name = path.split(":")
    return getattr(import_module(module), name)


def compute_amplification(scene: Scene, model: Model, phases: Any, **settings: object) -> Amplification:
    """
    Return the amplification that a model computes for a scene. Runs in a worker process.

    settings: arguments of the model's function that are added to those of the model, or replace them.
    """
    asked = {**model.settings, **settings}
    answer: Amplification = import_function(model.amplification)(model.scene_of(scene), phases, **asked)
    return answer


def compute_motion(scene: Scene, model: Model, phases: Any, **settings: object) -> Trajectory:
    """
    Return one motion that a model computes for a scene. Runs in a worker process.

    settings: arguments of the model's function that are added to those of the model, or replace them.
    """
    asked = {**model.motion_settings, **settings}
    motion: Trajectory = import_function(model.trajectory)(model.scene_of(scene), phases, **asked)
    return motion


def drop_unusable(mu: Array, error: Array, status: list[str], own: bool) -> None:
    """
    Set amplification mu and its error, both (M, N), to NaN at phase pairs whose answer cannot be used.

    An answer counts if its status begins with "ok". If it is of a model of this project (`own`), it counts, too, where
    the tolerance is not met and the error is stated. No answer counts with a value that is negative, or with a value or
    an error that is infinite or above MAX_MU: its status (M,) becomes "value out of range". All changes are made in
    place.
    """
    with np.errstate(invalid="ignore"):
        absurd = np.any((mu < 0.0) | (mu > MAX_MU) | (error > MAX_MU), axis=1).tolist()
    for point, outcome in enumerate(status):
        stated = own and outcome == USABLE_WITH_ERROR and np.isfinite(error[point]).all()
        usable = outcome.startswith(Outcome.OK) or stated
        if usable and absurd[point]:
            status[point] = Outcome.VALUE_OUT_OF_RANGE.value
        if absurd[point] or not usable:
            mu[point] = error[point] = np.nan


def find_refusal(scene: Scene, model: Model, tolerance: float, full: bool = False) -> str:
    """Return why a model would refuse every phase pair of a scene, without computing any; "" if it would not."""
    if model.refusal is None or not model.applies(scene):
        return ""
    asked = {"full": True} if full else {}
    return str(import_function(model.refusal)(scene, **model.settings, tolerance=tolerance, **asked))


def execute_batch(batch: Batch) -> BatchResult:
    """Return the model's result for a batch, without values if the call fails. Runs inside a worker process."""
    try:
        found = import_function(batch.amplification)(batch.scene, batch.phases, **batch.settings)
        parts = (found.mu, found.error, found.instant, found.displacement)
        mu, error, instant, displacement = (np.array(part, dtype=float) for part in parts)
        status = [str(outcome) for outcome in found.status]
        error_message = str(getattr(found, "error_message", ""))
        result = BatchResult(
            mu=mu,
            error=error,
            status=status,
            instant=instant,
            cost=float(found.cost),
            error_message=error_message,
            displacement=displacement,
        )
        if not batch.fits(result):
            points, bodies = batch.points, len(batch.scene.bodies)
            raise ValueError(f"{batch.amplification} answered {mu.shape} for {points} phases and {bodies} bodies")
    except Exception as exception:
        return batch.without_result(Outcome.SOLVER_FAILED, word_exception(exception))
    drop_unusable(mu, error, status, own=not batch.group)
    wrong = batch.ok_without_numbers(mu, error, status)
    for index in wrong:
        status[index] = Outcome.SOLVER_FAILED.value
    return replace(result, error_message=f"{batch.amplification} called a non-finite answer ok") if wrong else result
