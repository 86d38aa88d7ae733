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

# Kinds of stored results: those of batches, which are tasks of several phase pairs, and those of all other tasks
BATCH_KIND, RESULT_KIND = "batch", "result"
# Number of calls of a user's own engine that may time out or end their process; then no further phase pair is computed
MAX_FAILED_BATCHES = 2
# Error message of a batch (several phase pairs) that is not computed because MAX_FAILED_BATCHES others failed
GIVEN_UP_MESSAGE = f"{MAX_FAILED_BATCHES} calls hung or ended their process: not asked for the other phase pairs"


@dataclass(frozen=True)
class Task:
    """Unit of work: a function with one argument, to be called in a worker process; its result is stored by `key`."""

    function: Callable[[Any], Any]
    argument: Any
    stage: str  # name of the kind of work to which it belongs, for the terminal and the report's table of times
    seconds: float = 1.0  # s, rough processor time; within a stage it weights the task in the progress that is shown
    about: Any = None  # object in common with other tasks, such as the scene: their results are stored in one directory
    # Whether the task must wait until a worker has compiled the reference equations, if that has not been done yet
    needs_compiled_reference: bool = True
    # s, processor time (rounded up) after which the task is ended, with Outcome.TIME_LIMIT as outcome; None: no limit
    timeout: float | None = None
    group: str = ""  # name of the worker processes that run it: an engine of the user has its own, as it may crash them
    model: str = ""  # "package:name" of a model if it calls no other: changes of other code then keep its result valid

    @cached_property
    def key(self) -> CacheKey:
        """
        Return the cache key of the task's result, from its function, argument, package versions and source code.
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
        """Return the task's argument if it is a batch (several phase pairs of a scene and model), else None."""
        return self.argument if isinstance(self.argument, Batch) else None

    @property
    def points(self) -> int:
        """Return the task's share of the count in the progress shown: its phase pairs if it is a batch, else 1."""
        return self.batch.points if self.batch else 1

    def halves(self) -> list[Task]:
        """Return the two halves of a task of several phase pairs as tasks; [] for any other task."""
        return [replace(self, argument=half) for half in self.batch.halves()] if self.batch else []

    def join(self, results: Sequence[TaskResult]) -> TaskResult:
        """Return the result of a task of several phase pairs, joined from the results of its two halves."""
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

    value: Any  # None if the task failed; if only some phase pairs of a batch failed, a result with NaN at these
    cost: float  # s, processor time of the task
    outcome: Outcome = Outcome.OK
    error_message: str = ""

    @property
    def reason(self) -> str:
        """Return in one line why the task has no value: outcome and error message."""
        return f"{self.outcome}: {self.error_message}"


def execute_task(task: Task) -> TaskResult:
    """Return the result of a task's function with its processor time; raise its errors. Runs in a worker process."""
    clock = time.process_time()
    value = task.function(task.argument)
    return TaskResult(value, time.process_time() - clock)


def make_failed_result(outcome: Outcome, error_message: str) -> TaskResult:
    """Return the result of a task that failed: no value, the outcome, and an error message of one line."""
    return TaskResult(None, 0.0, outcome, error_message)


def name_function(function: Callable[..., Any]) -> str:
    """Return the name of a function as "module:name"."""
    return f"{function.__module__}:{function.__qualname__}"


def describe_contents(value: Any) -> Any:
    """
    Return all that a task's argument contains as plain JSON, from which the key of its result is made.

    It may be a number, text, scene, array (hashed), model (with its source code), function (by name), an object with a
    method `identity`, or a list, mapping or dataclass of these. Raises TypeError for anything else.

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
    """Return the arrays of an xarray data set (labeled arrays) by name."""
    return {str(name): variable.values for name, variable in data.variables.items()}


def _describe_dataclass(value: Any) -> Any:
    """Return the type and contents of a dataclass as plain JSON; for a model also the hashes of its source code."""
    held, source = {part.name: getattr(value, part.name) for part in fields(value)}, {}
    if isinstance(value, Model):
        del held["most"]  # this limit on the phases of a study changes no result, so results are stored without it
        source = fingerprint_environment(value.amplification)
    return [type(value).__qualname__, describe_contents(source), describe_contents(held)]
