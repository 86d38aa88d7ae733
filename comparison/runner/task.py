"""Task, the unit of work: a function of a module with its argument, run in a worker process and cached by its key."""

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
from comparison.runner.environment import fingerprint_environment, fingerprint_task_environment
from comparison.study.batches import Batch
from comparison.study.models import Model
from reference.problem import Outcome, Scene

BATCH_KIND, RESULT_KIND = "batch", "result"  # kinds of stored results: those of phase pairs, and all others
# After so many batches of a group of workers that hung or ended their process, no further batch of it is computed.
MAX_FAILED_BATCHES = 2
# error message of a batch that is not computed because too many batches of its group failed
GIVEN_UP_MESSAGE = f"{MAX_FAILED_BATCHES} calls hung or ended their process: not asked for the other phase pairs"


@dataclass(frozen=True)
class Task:
    """Call of a pure `function` with one argument in a worker process; its result is stored by `key`."""

    function: Callable[[Any], Any]
    argument: Any
    stage: str  # name of its stage on the terminal and in the table of costs
    seconds: float = 1.0  # s, rough processor time: the weight among the tasks of its stage
    about: Any = None  # contents that all tasks of a group share: their results share a directory in the cache
    # Whether the task waits, on a new installation, until a worker has compiled the reference
    needs_compiled_reference: bool = True
    # Largest processor time, s, rounded up; a task that takes longer ends with Outcome.TIME_LIMIT
    timeout: float | None = None
    group: str = ""  # group of workers that it may use: a user's engine may spoil the process it runs in
    model: str = ""  # "package:name" of the only model it calls: other sources do not change its value

    @cached_property
    def key(self) -> CacheKey:
        """
        Return the key of its stored result, from function, argument, package versions and the source that computes it.
        """
        function = name_function(self.function)
        about = {
            "function": function,
            "about": describe_contents(self.about),
            "environment": fingerprint_environment(self.model)
            if self.model
            else fingerprint_task_environment(self.function.__module__),
        }
        item = json.dumps([function, describe_contents(self.argument)])
        digest = hashlib.sha256(item.encode()).hexdigest()
        return CacheKey(json.dumps(about, indent=1, sort_keys=True), digest, BATCH_KIND if self.batch else RESULT_KIND)

    @cached_property
    def batch(self) -> Batch | None:
        """Return the task's argument if it is a batch of phase pairs, otherwise None."""
        return self.argument if isinstance(self.argument, Batch) else None

    @property
    def points(self) -> int:
        """Return the number of points that the terminal counts: phase pairs of a batch, 1 for any other task."""
        return self.batch.points if self.batch else 1

    def halves(self) -> list[Task]:
        """Return the two tasks into which a batch of several phase pairs can be cut; none for any other task."""
        return [replace(self, argument=half) for half in self.batch.halves()] if self.batch else []

    def join(self, results: Sequence[TaskResult]) -> TaskResult:
        """Return the task's result joined from the results of its halves."""
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
    """Value that a task returned, or the reason why it returned none."""

    value: Any  # a batch also has one if a part of its points is lost; otherwise None unless `outcome` is OK
    cost: float  # s of processor time
    outcome: Outcome = Outcome.OK
    error_message: str = ""

    @property
    def reason(self) -> str:
        """Return why there is no value, in one line."""
        return f"{self.outcome}: {self.error_message}"


def execute_task(task: Task) -> TaskResult:
    """Call the function of a task inside a worker process. Its errors are raised: the runner handles them."""
    clock = time.process_time()
    value = task.function(task.argument)
    return TaskResult(value, time.process_time() - clock)


def make_failed_result(outcome: Outcome, error_message: str) -> TaskResult:
    """Return the result of a task that raised, took too long or whose worker died; the message is one line."""
    return TaskResult(None, 0.0, outcome, error_message)


def name_function(function: Callable[..., Any]) -> str:
    """Return "module:name" of a function."""
    return f"{function.__module__}:{function.__qualname__}"


def describe_contents(value: Any) -> Any:
    """
    Return everything that a value contains as plain JSON, which distinguishes one task from another.

    Numbers, texts, scenes, arrays (by hash), models (also by their source), functions (by name), what states its
    `identity`, and lists, mappings and dataclasses of these. Raises TypeError for anything else.

    Examples
    --------
    >>> describe_contents({"b": (1, 2.5), "a": None})
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
        return ["data", describe_contents(_describe_arrays(value))]
    if isinstance(value, tuple | list):
        return [describe_contents(part) for part in value]
    if hasattr(value, "identity"):
        return describe_contents(value.identity())
    if isinstance(value, Mapping):
        return [[key, describe_contents(part)] for key, part in sorted(value.items())]
    if is_dataclass(value) and not isinstance(value, type):
        return _describe_dataclass(value)
    if callable(value):
        return name_function(value)
    raise TypeError(f"a task that holds {type(value).__name__} has no name in the store")


def _describe_arrays(data: xr.Dataset) -> dict[str, Any]:
    """Return the arrays of a data set by name."""
    return {str(name): variable.values for name, variable in data.variables.items()}


def _describe_dataclass(value: Any) -> Any:
    """Return the type of a dataclass and its contents; a model also depends on its source."""
    held, source = {part.name: getattr(value, part.name) for part in fields(value)}, {}
    if isinstance(value, Model):
        del held["most"]  # The number of phases that a model is asked for does not change its answers.
        source = fingerprint_environment(value.amplification)
    return [type(value).__qualname__, describe_contents(source), describe_contents(held)]
