"""The results of tasks, looked up by task: in memory, and in the cache of earlier runs."""

from collections import defaultdict
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, get_type_hints

from comparison.runner.cache import Cache, CacheKey
from comparison.runner.task import Task, TaskResult, make_failed_result
from reference.problem import Outcome


@dataclass
class StageCost:
    """Cost of one stage of a run, which is the work of one kind."""

    tasks: int = 0  # number of its tasks
    stored: int = 0  # number of tasks whose results an earlier run stored
    seconds: float = 0.0  # s, processor time of all its tasks


@dataclass(frozen=True)
class Overrun:
    """Record that is stored in place of a result for a task that was stopped at its time limit."""

    timeout: float  # s, the limit of its processor time
    ending: str  # how the task ended, in words


class TaskResults:
    """
    Results of tasks, looked up by task and stored in `cache` for later runs.

    fresh: whether results that earlier runs stored are left unread. parts: cost of each stage, by its name. stored:
    keys of the tasks whose results were read from the cache.
    """

    def __init__(self, cache: Cache | None = None, fresh: bool = False) -> None:
        """Start without any result in memory."""
        self.cache, self._fresh = cache, fresh
        self._results: dict[CacheKey, TaskResult] = {}
        self.parts: dict[str, StageCost] = defaultdict(StageCost)
        self.stored: set[CacheKey] = set()

    def __getitem__(self, task: Task) -> TaskResult:
        """Return the result of a task."""
        return self._results[task.key]

    def __contains__(self, task: Task) -> bool:
        """Return whether there is a result of the task."""
        return task.key in self._results

    def value(self, task: Task, on_failure: Callable[[Any, TaskResult], Any]) -> Any:
        """
        Return what a task's function returned; if it failed, what `on_failure` returns for its argument and result.
        """
        result = self[task]
        failed = result.value is None and result.outcome != Outcome.OK
        return on_failure(task.argument, result) if failed else result.value

    def find_missing(self, tasks: Iterable[Task]) -> list[Task]:
        """Return the tasks that must be computed, after reading the stored results of the others."""
        return [task for task in tasks if not (task.key in self._results or self._read(task))]

    def holds(self, task: Task) -> bool:
        """Return whether the cache may be read and has a file for the task, even one that proves invalid."""
        return self.cache is not None and not self._fresh and self.cache.holds(task.key)

    def put(self, task: Task, result: TaskResult) -> None:
        """
        Keep the result of a task, and store it in the cache. Raises StoreError.

        One that names an error is not stored in the cache: the next run tries it again. That a task took longer than
        its `timeout` is stored: only a run that allows more tries it again.
        """
        self._remember(task, result)
        if self.cache is None:
            return
        overrun = result.outcome == Outcome.TIME_LIMIT and result.value is None
        if overrun and task.timeout is not None:
            self.cache.put(task.key, Overrun(task.timeout, result.error_message))
        elif not result.error_message:
            self.cache.put(task.key, (result.value, result.cost))

    def _remember(self, task: Task, result: TaskResult) -> None:
        """Keep the result of a task in memory, and add it to the task count and cost of its stage."""
        self._results[task.key] = result
        self.parts[task.stage].tasks += 1
        self.parts[task.stage].seconds += result.cost

    def _read(self, task: Task) -> bool:
        """Take a stored result of a task from the cache; return whether there is a valid one."""
        if self.cache is None or self._fresh:
            return False
        declared: Any = get_type_hints(task.function)["return"]
        stored = self.cache.get(task.key, tuple[declared, float] | Overrun)
        if isinstance(stored, Overrun):
            if task.timeout is None or task.timeout > stored.timeout:
                return False
            self._remember(task, make_failed_result(Outcome.TIME_LIMIT, stored.ending))
        elif stored is not None and (task.batch is None or task.batch.accepts(stored[0])):
            self._remember(task, TaskResult(*stored))
        else:
            return False
        self.parts[task.stage].stored += 1
        self.stored.add(task.key)
        return True
