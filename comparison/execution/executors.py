"""
Where tasks run: processes of this machine, or any executor that is lent.

`sweep` asks three things of an executor beyond `concurrent.futures`, all optional: `width`, how many tasks to keep in
flight; `WorkerDiedError` from a future, when the death of a process is known to be the doing of that task and harmed no
other; `ExecutorLostError` when there is no going on.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import resource_tracker
from multiprocessing.process import BaseProcess
from typing import Any

import numba

Pool = Executor | Callable[[int], Executor]  # an executor that somebody else ends, or what makes one for N jobs


class WorkerDiedError(Exception):
    """The process that ran this task died, `times` in a row. The executor goes on, and no other task was harmed."""

    def __init__(self, message: str, times: int = 1) -> None:
        super().__init__(message)
        self.times = times


class ExecutorLostError(RuntimeError):
    """No task can be computed any more. `str(error)` is one line that says why."""


def cores() -> int:
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def factory(pool: Pool) -> Callable[[int], Executor]:
    """What makes an executor for N jobs. One that was lent is given every time, and not shut down."""
    return (lambda jobs: Lent(pool)) if isinstance(pool, Executor) else pool


def width(executor: Executor, jobs: int) -> int:
    """How many tasks to keep in flight: no more than workers, so that few are in doubt when one dies."""
    return int(getattr(executor, "width", jobs))


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
        try:
            return self._executor.submit(solve, *args, **kwargs)
        except BrokenExecutor as error:  # nobody here can make another one
            raise ExecutorLostError(f"the executor is broken: {error}") from None

    def __getattr__(self, name: str) -> Any:
        """What the executor has beyond the usual, if it has it."""
        if name in ("abandon", "width"):
            return getattr(self._executor, name)
        raise AttributeError(name)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Nothing: whoever lent it ends it."""


class Workers(Executor):
    """
    `jobs` fresh processes, each a pool of its own: one that dies takes its own task along, is replaced, and the rest
    does not notice. In one common pool a single death ends every task in flight.
    """

    def __init__(self, jobs: int) -> None:
        self.width = jobs
        self._idle: list[ProcessPoolExecutor] = []
        self._all: set[ProcessPoolExecutor] = set()
        self._processes: set[BaseProcess] = set()
        self._lock = threading.Lock()

    def submit(self, solve: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        with self._lock:
            pool = self._idle.pop() if self._idle else None
        answer: Future[Any] = Future()
        answer.set_running_or_notify_cancel()
        if pool is None:
            pool = ProcessPoolExecutor(1, multiprocessing.get_context("spawn"), _begin_worker)
            self._all.add(pool)
        before = set(multiprocessing.active_children())
        with _deaf_to_ctrl_c():
            future = pool.submit(solve, *args, **kwargs)
        self._processes |= set(multiprocessing.active_children()) - before
        future.add_done_callback(lambda found: self._arrived(pool, found, answer))
        return answer

    def _arrived(self, pool: ProcessPoolExecutor, found: Future[Any], answer: Future[Any]) -> None:
        if found.cancelled():
            return  # the sweep has been given up, and nobody waits for the answer
        error = found.exception()
        if isinstance(error, BrokenExecutor):
            error = WorkerDiedError(str(error))
        else:
            with self._lock:
                self._idle.append(pool)
        if error is None:
            answer.set_result(found.result())
        else:
            answer.set_exception(error)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        for pool in self._all:
            pool.shutdown(wait=wait, cancel_futures=cancel_futures)

    def abandon(self) -> None:
        """End the processes in the middle of their tasks."""
        for process in self._processes:
            process.kill()
        self.shutdown(wait=False, cancel_futures=True)


def process_pool(jobs: int) -> Executor:
    """`jobs` fresh processes, each with one thread: the tasks are the parallelism."""
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(name, "1")  # read by the libraries of the worker when it starts
    return Workers(jobs)


def _begin_worker() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C goes to the whole group; the parent alone decides
    threading.Thread(target=_end_with_parent, daemon=True).start()
    numba.set_num_threads(1)


def _end_with_parent() -> None:
    """A worker whose parent was killed waits for tasks for ever, unless it looks."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


@contextmanager
def _deaf_to_ctrl_c() -> Iterator[None]:
    """A process started meanwhile does not hear Ctrl-C even while it imports; here it is heard afterwards."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    resource_tracker.ensure_running()  # its own start would end the deafness
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
