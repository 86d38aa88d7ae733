"""The results of tasks, looked up by task: in memory, and in the cache of earlier runs."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, get_type_hints

from comparison.runner.cache import Cache
from comparison.runner.keys import task_key
from comparison.runner.task import Task, TaskResult, unfinished
from reference.problem import Outcome


@dataclass
class Part:
    """What one stage cost: its tasks, how many of them an earlier run had stored, s of processor time of all."""

    tasks: int = 0
    stored: int = 0
    seconds: float = 0.0


@dataclass(frozen=True)
class Overrun:
    """Stored in place of a result: the task took longer than its timeout, s of processor time; how it ended."""

    timeout: float
    ending: str  # in words


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

    def __contains__(self, task: Task) -> bool:
        return task.key in self._results

    def value(self, task: Task, on_failure: Callable[[Any, TaskResult], Any]) -> Any:
        """
        What a task returned, or what stands in its place.

        Parameters
        ----------
        task : Task
            One that was executed or read.
        on_failure : callable
            Makes the value of a task that returned nothing, from its argument and the result that says why.

        Returns
        -------
        object
        """
        result = self[task]
        return result.value if result.outcome == Outcome.OK else on_failure(task.argument, result)

    def missing(self, tasks: Iterable[Task]) -> list[Task]:
        """The tasks that must be computed; the results of the others are read."""
        return [task for task in tasks if not (task.key in self._results or self._read(task))]

    def holds(self, task: Task) -> bool:
        """Whether the cache has a file for the task, whatever its state."""
        return self.cache is not None and not self._fresh and self.cache.holds(task_key(task))

    def put(self, task: Task, result: TaskResult) -> None:
        """
        Keep a result. Raises StoreError.

        One that names an error is not stored in the cache: the next run tries it again. That a task took longer than
        its `timeout` is stored: only a run that allows more tries it again.
        """
        self._remember(task, result)
        if self.cache is None:
            return
        if result.outcome == Outcome.TIME_LIMIT and task.timeout is not None:
            self.cache.put(task_key(task), Overrun(task.timeout, result.error_message))
        elif not result.error_message:
            self.cache.put(task_key(task), (result.value, result.cost))

    def _remember(self, task: Task, result: TaskResult) -> None:
        self._results[task.key] = result
        self.parts[task.stage].tasks += 1
        self.parts[task.stage].seconds += result.cost

    def _read(self, task: Task) -> bool:
        if self.cache is None or self._fresh:
            return False
        declared: Any = get_type_hints(task.function)["return"]
        stored = self.cache.get(task_key(task), tuple[declared, float] | Overrun)
        if isinstance(stored, Overrun):
            if task.timeout is None or task.timeout > stored.timeout:
                return False
            self._remember(task, unfinished(task, Outcome.TIME_LIMIT, stored.ending))
        elif stored is not None:
            self._remember(task, TaskResult(*stored))
        else:
            return False
        self.parts[task.stage].stored += 1
        return True
