"""
Where tasks run: what `sweep` asks of an executor beyond `concurrent.futures`, all of it optional.

`width`: how many tasks to keep at work. `submit_within`: a call with a limit on its processor time, which ends as
`TimeLimitError`. `WorkerDiedError` from a future: the death of a process is known to be the doing of that task and
harmed no other. `ExecutorLostError`: there is no going on. `abandon`: end at once.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future
from typing import Any, TypeVar

Pool = Executor | Callable[[int], Executor]  # an executor that somebody else ends, or what makes one for N jobs

Task = TypeVar("Task")
Result = TypeVar("Result")


class WorkerDiedError(Exception):
    """The process that ran this task died, `times` in a row. The executor goes on, and no other task was harmed."""

    def __init__(self, message: str, times: int = 1, exit_code: int | None = None) -> None:
        super().__init__(message)
        self.times, self.exit_code = times, exit_code


class TimeLimitError(Exception):
    """The process that ran this task was ended, because the task took longer than it may. `str(error)`: how long."""


class ExecutorLostError(RuntimeError):
    """No task can be computed any more. `str(error)` is one line that says why."""


def cores() -> int:
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def factory(pool: Pool) -> Callable[[int], Executor]:
    """
    What makes an executor for a number of workers.

    Parameters
    ----------
    pool : Executor or callable
        One that was lent is given every time, and not shut down.

    Returns
    -------
    callable
    """
    return (lambda jobs: Lent(pool)) if isinstance(pool, Executor) else pool


def width(executor: Executor, jobs: int) -> int:
    """
    How many tasks to keep at work: no more than workers, so that few are suspected when one dies.

    Parameters
    ----------
    executor : Executor
    jobs : int
        For an executor that does not state its `width`.

    Returns
    -------
    int
    """
    return int(getattr(executor, "width", jobs))


def start(executor: Executor, solve: Callable[[Task], Result], task: Task, seconds: float | None) -> Future[Result]:
    """
    `solve(task)` on the executor.

    Parameters
    ----------
    executor : Executor
        Where it runs.
    solve : callable
        Function of the task.
    task : object
        Its argument.
    seconds : float or None
        Most processor time, s. An executor without `submit_within`, such as threads, cannot keep to it.

    Returns
    -------
    Future
    """
    within: Callable[..., Future[Result]] | None = getattr(executor, "submit_within", None)
    if seconds is None or within is None:
        return executor.submit(solve, task)
    return within(seconds, solve, task)


def abandon(executor: Executor) -> None:
    """Shut down without waiting for what is under way, and end it where the executor can."""
    end: Callable[[], None] | None = getattr(executor, "abandon", None)
    if end is not None:
        end()
    else:
        executor.shutdown(wait=False, cancel_futures=True)


class Lent(Executor):
    """An executor that outlives the sweep."""

    def __init__(self, executor: Executor) -> None:
        self._executor = executor

    def submit(self, solve: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Compute a task on the executor that was lent. Raises ExecutorLostError if it is broken."""
        try:
            return self._executor.submit(solve, *args, **kwargs)
        except BrokenExecutor as error:  # nobody here can make another one
            raise ExecutorLostError(f"the executor is broken: {error}") from None

    def __getattr__(self, name: str) -> Any:
        """What the executor has beyond the usual, if it has it."""
        if name in ("abandon", "submit_within", "width"):
            return getattr(self._executor, name)
        raise AttributeError(name)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Nothing: whoever lent it ends it."""
