"""
Where tasks run: what the runner asks of an executor beyond `concurrent.futures`, all of it optional.

`width`: how many tasks to keep at work. `start(call, seconds, group)`: a call in a process of its group, with a limit
of processor time. `WorkerDiedError` and `TimeLimitError` from a future: the call has ended its process, and no other
was harmed. `ExecutorLostError`: there is no going on. `abandon`: end at once.
"""

import os
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager

Pool = Executor | Callable[[int], Executor]  # an executor that somebody else ends, or what makes one for N jobs


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


@contextmanager
def executing(pool: Pool, jobs: int) -> Iterator[Executor]:
    """The executor; one that is made for the block ends with it, and without waiting if the block raises."""
    if isinstance(pool, Executor):
        yield pool
        return
    made = pool(jobs)
    try:
        yield made
    except BaseException:
        made.shutdown(wait=False, cancel_futures=True)
        raise
    made.shutdown()
