"""What a study computes beside its surfaces: functions of a task that a worker process can run by itself."""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, is_dataclass
from enum import Enum
from functools import cached_property
from typing import Any

import numpy as np
import xarray as xr

from comparison.runner.environment import environment_fingerprint
from comparison.study.models import Model
from reference.problem import Outcome, Scene


@dataclass(frozen=True)
class Task:
    """
    `function(argument)`, in a worker process. Pure and picklable; cached by `key`.

    function: importable by its name; the type that it declares to return is what the cache reads back.
    """

    function: Callable[[Any], Any]
    argument: Any
    stage: str  # its name on the terminal and in the table of costs
    seconds: float = 1.0  # what it weighs beside other tasks of its stage
    about: Any = None  # what its directory in the cache belongs to
    needs_compiled_reference: bool = True  # on a new installation it waits until one worker has compiled the reference
    timeout: float | None = None  # most processor time, s, rounded up; what takes longer is ended: Outcome.TIME_LIMIT
    lane: str = ""  # as `study.batches.Batch`

    @cached_property
    def key(self) -> str:
        """Hash of the function and all that its argument holds."""
        text = json.dumps([named(self.function), fingerprint(self.argument)])
        return hashlib.sha256(text.encode()).hexdigest()


@dataclass(frozen=True)
class TaskResult:
    """What a task returned, or why it returned nothing."""

    value: Any  # None unless `outcome` is OK
    cost: float  # s of processor time
    outcome: Outcome = Outcome.OK
    error_message: str = ""

    @property
    def reason(self) -> str:
        """Why there is no value, in one line."""
        return f"{self.outcome}: {self.error_message}"


def execute(task: Task) -> TaskResult:
    """
    Call the function of a task. Runs inside a worker process.

    Parameters
    ----------
    task : Task

    Returns
    -------
    TaskResult
        With processor time. What the function raises is not caught here: the sweep answers for it.
    """
    clock = time.process_time()
    value = task.function(task.argument)
    return TaskResult(value, time.process_time() - clock)


def unfinished(task: Task, outcome: Outcome, error_message: str) -> TaskResult:
    """
    The result of a task that raised, took too long or whose worker died.

    Parameters
    ----------
    task : Task
    outcome : Outcome
    error_message : str
        One line.

    Returns
    -------
    TaskResult
    """
    return TaskResult(None, 0.0, outcome, error_message)


def named(function: Callable[..., Any]) -> str:
    """ "module:name" of a function."""
    return f"{function.__module__}:{function.__qualname__}"


def fingerprint(value: Any) -> Any:
    """
    All that a value holds, as plain JSON: what distinguishes one task from another.

    Parameters
    ----------
    value : object
        Numbers, texts, scenes, arrays (by hash), models (also by their source), functions (by name), and lists,
        mappings and dataclasses of these.

    Returns
    -------
    object
        What `json.dumps` takes.

    Raises
    ------
    TypeError
        For anything else.

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
        return [
            "array",
            str(value.dtype),
            value.shape,
            hashlib.sha256(np.ascontiguousarray(value).tobytes()).hexdigest(),
        ]
    if isinstance(value, xr.Dataset):
        return ["data", [[str(name), fingerprint(value[name].values)] for name in sorted(map(str, value.variables))]]
    if isinstance(value, tuple | list):
        return [fingerprint(part) for part in value]
    if isinstance(value, Mapping):
        return [[key, fingerprint(part)] for key, part in sorted(value.items())]
    if is_dataclass(value) and not isinstance(value, type):
        held = {part.name: getattr(value, part.name) for part in fields(value)}
        if isinstance(value, Model):
            del held["most"]  # at which phases a model is asked does not change what it answers
        source = environment_fingerprint(value.amplification) if isinstance(value, Model) else {}
        return [type(value).__qualname__, fingerprint(source), fingerprint(held)]
    if callable(value):
        return named(value)
    raise TypeError(f"a task that holds {type(value).__name__} has no name in the store")
