"""
The tasks of a study, each from the cache if it is there, else computed and stored at once.

The analyses ask an executor, see `sweep`; one made by `TaskCache.on` knows what has been fetched before. So everything
that a study can ask at once goes through the workers in one sweep, without a pause between one analysis and the next.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable
from concurrent.futures import Executor, Future
from dataclasses import dataclass
from typing import Any, get_type_hints

from comparison.execution.cache import Cache
from comparison.execution.keys import task_key
from comparison.execution.task import Task, TaskResult


@dataclass
class Part:
    """What one stage cost: its tasks, how many of them an earlier run had stored, s of processor time of all."""

    tasks: int = 0
    stored: int = 0
    seconds: float = 0.0


class TaskCache:
    """
    What tasks gave, in memory and in `cache`; nothing is read from there if `fresh`. parts: what each stage cost.
    """

    def __init__(self, cache: Cache, fresh: bool = False) -> None:
        self._cache, self._fresh = cache, fresh
        self._cached: dict[str, Any] = {}
        self.parts: dict[str, Part] = defaultdict(Part)

    def missing(self, tasks: Iterable[Task]) -> list[Task]:
        """Those that must be computed; the others are read."""
        return [task for task in tasks if not (task.key in self._cached or self._read(task))]

    def holds(self, task: Task) -> bool:
        """Whether there is a file for it, whatever its state."""
        return not self._fresh and self._cache.holds(task_key(task))

    def put(self, task: Task, fetched: TaskResult | None) -> None:
        """
        Keep what came back, None if nothing did. Raises StoreError.

        An answer that says it went wrong is not stored: the next run tries it again.
        """
        if fetched is None:
            return
        self._remember(task, fetched)
        self._cache.put(task_key(task), (fetched.result, fetched.cost))

    def on(self, make: Callable[[int], Executor]) -> Callable[[int], Executor]:
        """An executor for N jobs that answers what is known at once and hands on the rest to that of `make`."""
        return lambda jobs: _CachedExecutor(self._cached, make, jobs)

    def _remember(self, task: Task, fetched: TaskResult) -> None:
        self._cached[task.key] = fetched.result
        self.parts[task.stage].tasks += 1
        self.parts[task.stage].seconds += fetched.cost

    def _read(self, task: Task) -> bool:
        if self._fresh:
            return False
        declared: Any = get_type_hints(task.function)["return"]
        stored = self._cache.get(task_key(task), tuple[declared, float])
        if stored is None:
            return False
        self._remember(task, TaskResult(*stored))
        self.parts[task.stage].stored += 1
        return True


class _CachedExecutor(Executor):
    """Answers what is known; the executor for the rest is made when there is any."""

    def __init__(self, known: dict[str, Any], make: Callable[[int], Executor], jobs: int) -> None:
        self._cached, self._make, self._jobs = known, make, jobs
        self._inner: Executor | None = None

    def submit(self, solve: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        key = Task("", solve, args[0], 0.0).key
        if key not in self._cached:
            return self._executor().submit(solve, *args, **kwargs)
        answer: Future[Any] = Future()
        answer.set_result(self._cached[key])
        return answer

    def _executor(self) -> Executor:
        if self._inner is None:
            self._inner = self._make(self._jobs)
        return self._inner

    def __getattr__(self, name: str) -> Any:
        """What the executor has beyond the usual, if it has it; all may be known, so none is made to be asked."""
        if name == "width" and self._inner is None:
            return self._jobs
        if name in ("abandon", "width") and self._inner is not None:
            return getattr(self._inner, name)
        raise AttributeError(name)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        if self._inner is not None:
            self._inner.shutdown(wait=wait, cancel_futures=cancel_futures)
