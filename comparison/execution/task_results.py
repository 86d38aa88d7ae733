"""The results of tasks, looked up by task: in memory, and in the cache of earlier runs."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, get_type_hints

from comparison.execution.cache import Cache
from comparison.execution.keys import task_key
from comparison.execution.task import Task, TaskResult
from reference.problem import Outcome


@dataclass
class Part:
    """What one stage cost: its tasks, how many of them an earlier run had stored, s of processor time of all."""

    tasks: int = 0
    stored: int = 0
    seconds: float = 0.0


class TaskResults:
    """
    Results by task.

    Parameters
    ----------
    cache : Cache, optional
        Where results are kept for later runs; without it they live as long as this object.
    fresh : bool
        Whether to read nothing from the cache.

    Attributes
    ----------
    parts : dict of str to Part
        What each stage cost.
    """

    def __init__(self, cache: Cache | None = None, fresh: bool = False) -> None:
        self.cache, self._fresh = cache, fresh
        self._results: dict[str, TaskResult] = {}
        self.parts: dict[str, Part] = defaultdict(Part)

    def __getitem__(self, task: Task) -> TaskResult:
        return self._results[task.key]

    def value(self, task: Task, on_failure: Callable[[Any, Outcome, str], Any]) -> Any:
        """What the task returned; `on_failure(argument, outcome, error message)` if it returned nothing."""
        result = self[task]
        if result.outcome == Outcome.OK:
            return result.value
        return on_failure(task.argument, result.outcome, result.error_message)

    def missing(self, tasks: Iterable[Task]) -> list[Task]:
        """The tasks that must be computed; the results of the others are read."""
        return [task for task in tasks if not (task.key in self._results or self._read(task))]

    def holds(self, task: Task) -> bool:
        """Whether the cache has a file for the task, whatever its state."""
        return self.cache is not None and not self._fresh and self.cache.holds(task_key(task))

    def put(self, task: Task, result: TaskResult) -> None:
        """
        Keep a result. Raises StoreError.

        One that names an error is not stored in the cache: the next run tries it again.
        """
        self._remember(task, result)
        if self.cache is not None and not result.error_message:
            self.cache.put(task_key(task), (result.value, result.cost))

    def _remember(self, task: Task, result: TaskResult) -> None:
        self._results[task.key] = result
        self.parts[task.stage].tasks += 1
        self.parts[task.stage].seconds += result.cost

    def _read(self, task: Task) -> bool:
        if self.cache is None or self._fresh:
            return False
        declared: Any = get_type_hints(task.function)["return"]
        stored = self.cache.get(task_key(task), tuple[declared, float])
        if stored is None:
            return False
        self._remember(task, TaskResult(*stored))
        self.parts[task.stage].stored += 1
        return True
