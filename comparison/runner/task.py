"""The unit of work: a function of a module with its argument, run in a worker process and found again by its key."""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from enum import Enum
from functools import cached_property
from typing import Any

import numpy as np
import xarray as xr

from comparison.runner.cache import CacheKey
from comparison.runner.environment import environment_fingerprint, task_environment_fingerprint
from comparison.study.batches import Batch
from comparison.study.models import Model
from reference.problem import Outcome, Scene

BATCH, RESULT = "batch", "result"  # kinds of stored results: of phase pairs, and all others
GIVEN_UP_AFTER = 2  # batches of one group that hang or end their process: the engine is not asked again
GIVEN_UP = f"{GIVEN_UP_AFTER} calls hung or ended their process: not asked for the other phase pairs"


@dataclass(frozen=True)
class Task:
    """`function(argument)`, in a worker process, pure and picklable; cached by `key` as the type that it declares."""

    function: Callable[[Any], Any]
    argument: Any
    stage: str  # its name on the terminal and in the table of costs
    seconds: float = 1.0  # its weight among the tasks of its stage
    about: Any = None  # what its directory in the cache belongs to
    needs_compiled_reference: bool = True  # on a new installation it waits until one worker has compiled the reference
    timeout: float | None = None  # most processor time, s, rounded up; what takes longer is ended: Outcome.TIME_LIMIT
    group: str = ""  # workers are shared within a group only: an engine of the user may spoil the process it runs in
    model: str = ""  # "package:name" of the only model that it asks: no other source changes its value

    @cached_property
    def key(self) -> CacheKey:
        """
        Return what it is found by: the function, all that its argument holds, versions and the source that computes it.
        """
        function = name_of_function(self.function)
        about = {
            "function": function,
            "about": fingerprint(self.about),
            "environment": environment_fingerprint(self.model)
            if self.model
            else task_environment_fingerprint(self.function.__module__),
        }
        item = json.dumps([function, fingerprint(self.argument)])
        digest = hashlib.sha256(item.encode()).hexdigest()
        return CacheKey(json.dumps(about, indent=1, sort_keys=True), digest, BATCH if self.batch else RESULT)

    @cached_property
    def batch(self) -> Batch | None:
        """Its argument, if that is some phase pairs, which are cut in two where a worker dies of them."""
        return self.argument if isinstance(self.argument, Batch) else None

    @property
    def points(self) -> int:
        """Return what it counts for on the terminal."""
        return self.batch.points if self.batch else 1

    def halves(self) -> list[Task]:
        """The two tasks into which it can be cut; none if it cannot."""
        return [replace(self, argument=half) for half in self.batch.halves()] if self.batch else []

    def join(self, results: Sequence[TaskResult]) -> TaskResult:
        """Its result from those of its halves."""
        assert self.batch is not None, "only a batch has halves"
        values = [
            result.value if result.value is not None else half.without_result(result.outcome, result.error_message)
            for half, result in zip(self.batch.halves(), results)
        ]
        lost = next((result for result in results if result.outcome != Outcome.OK), TaskResult(None, 0.0))
        cost = sum(result.cost for result in results)
        return TaskResult(self.batch.join(values), cost, lost.outcome, lost.error_message)


@dataclass(frozen=True)
class TaskResult:
    """Value that a task returned, or the reason why it returned nothing."""

    value: Any  # for a batch also where a part of its points is lost; otherwise None unless `outcome` is OK
    cost: float  # s of processor time
    outcome: Outcome = Outcome.OK
    error_message: str = ""

    @property
    def reason(self) -> str:
        """Why there is no value, in one line."""
        return f"{self.outcome}: {self.error_message}"


def execute(task: Task) -> TaskResult:
    """Call the function of a task, inside a worker process. What it raises is not caught: the sweep answers for it."""
    clock = time.process_time()
    value = task.function(task.argument)
    return TaskResult(value, time.process_time() - clock)


def result_without_value(outcome: Outcome, error_message: str) -> TaskResult:
    """The result of a task that raised, took too long or whose worker died; the message is one line."""
    return TaskResult(None, 0.0, outcome, error_message)


def name_of_function(function: Callable[..., Any]) -> str:
    """ "module:name" of a function."""
    return f"{function.__module__}:{function.__qualname__}"


def fingerprint(value: Any) -> Any:
    """
    Return all that a value holds, as plain JSON: what distinguishes one task from another.

    Numbers, texts, scenes, arrays (by hash), models (also by their source), functions (by name), what states its
    `identity`, and lists, mappings and dataclasses of these. Raises TypeError for anything else.

    Examples
    --------
    >>> fingerprint({"b": (1, 2.5), "a": None})
    [['a', None], ['b', [1, 2.5]]]
    """
    if value is None or isinstance(value, bool | int | str | float):
        return value.value if isinstance(value, Enum) else value
    if isinstance(value, Scene):
        return ["scene", value.digest(), value.name, value.title]
    if isinstance(value, np.ndarray):
        content = hashlib.sha256(np.ascontiguousarray(value).tobytes()).hexdigest()
        return ["array", str(value.dtype), value.shape, content]
    if isinstance(value, xr.Dataset):
        return ["data", fingerprint(_arrays_of(value))]
    if isinstance(value, tuple | list):
        return [fingerprint(part) for part in value]
    if hasattr(value, "identity"):
        return fingerprint(value.identity())
    if isinstance(value, Mapping):
        return [[key, fingerprint(part)] for key, part in sorted(value.items())]
    if is_dataclass(value) and not isinstance(value, type):
        return _fingerprint_of_dataclass(value)
    if callable(value):
        return name_of_function(value)
    raise TypeError(f"a task that holds {type(value).__name__} has no name in the store")


def _arrays_of(data: xr.Dataset) -> dict[str, Any]:
    return {str(name): variable.values for name, variable in data.variables.items()}


def _fingerprint_of_dataclass(value: Any) -> Any:
    """Return the type of a dataclass and all that it holds; a model also depends on its source."""
    held, source = {part.name: getattr(value, part.name) for part in fields(value)}, {}
    if isinstance(value, Model):
        del held["most"]  # at which phases a model is asked does not change what it answers
        source = environment_fingerprint(value.amplification)
    return [type(value).__qualname__, fingerprint(source), fingerprint(held)]
