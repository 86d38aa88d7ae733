"""
Run independent tasks on worker processes and lose none: one that raises or kills its worker is answered for.

Results come back in the order of the tasks, whatever the scheduling was.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, ProcessPoolExecutor, wait
from typing import TypeVar

import numba

from reference.problem import Outcome

Task = TypeVar("Task")
Result = TypeVar("Result")


def process_pool(jobs: int) -> Executor:
    """`jobs` fresh processes, each with one thread: the tasks are the parallelism."""
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(name, "1")  # read by the libraries of the worker when it starts
    context = multiprocessing.get_context("spawn")
    return ProcessPoolExecutor(jobs, mp_context=context, initializer=_begin_worker)


def _begin_worker() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C goes to the whole group; the parent alone decides
    numba.set_num_threads(1)


def at_once(task: object) -> bool:
    return True


def sweep(
    tasks: Sequence[Task],
    solve: Callable[[Task], Result],
    lost: Callable[[Task, Outcome, str], Result],
    done: Callable[[Task, Result], None],
    jobs: int,
    executor: Callable[[int], Executor] = process_pool,
    ready: Callable[[Task], bool] = at_once,
) -> list[Result]:
    """
    `solve` every task on `executor(jobs)`; `done` is called as results arrive, in any order.

    A task that is not `ready` lets others pass; it is asked again whenever a result has arrived, and starts in any
    case when nothing else is left to wait for.

    When a worker dies, the tasks then in flight run once more, each alone in a fresh process; one that dies again is
    answered by `lost(task, Outcome.WORKER_DIED, message)`, so that only the culprit is given up.
    """
    results: dict[int, Result] = {}

    def keep(index: int, result: Result) -> None:
        results[index] = result
        done(tasks[index], result)

    queue = deque(range(len(tasks)))
    while queue:
        for index in _drain(tasks, queue, solve, lost, keep, executor, jobs, ready):
            if _drain(tasks, deque([index]), solve, lost, keep, executor, 1, at_once):
                keep(index, lost(tasks[index], Outcome.WORKER_DIED, "the worker process died, twice"))
    return [results[index] for index in range(len(tasks))]


def _drain(
    tasks: Sequence[Task],
    queue: deque[int],
    solve: Callable[[Task], Result],
    lost: Callable[[Task, Outcome, str], Result],
    keep: Callable[[int, Result], None],
    executor: Callable[[int], Executor],
    jobs: int,
    ready: Callable[[Task], bool],
) -> list[int]:
    """Work through the queue until it is empty or a worker dies; the tasks in flight at that moment."""
    flying: dict[Future[Result], int] = {}
    pool = executor(min(jobs, len(queue)))
    try:
        while queue or flying:
            while queue and len(flying) < jobs:  # no more in flight than workers: few suspects when one dies
                index = next((index for index in queue if ready(tasks[index])), None if flying else queue[0])
                if index is None:
                    break
                queue.remove(index)
                try:
                    flying[pool.submit(solve, tasks[index])] = index
                except BrokenExecutor:
                    if flying:
                        queue.appendleft(index)
                    return sorted(flying.values()) or [index]
            for future in wait(flying, return_when=FIRST_COMPLETED).done:
                try:
                    result = future.result()
                except BrokenExecutor:
                    return sorted(flying.values())
                except Exception as fault:
                    index = flying.pop(future)
                    keep(index, lost(tasks[index], Outcome.SOLVER_FAILED, f"{type(fault).__name__}: {fault}"))
                else:
                    keep(flying.pop(future), result)
        return []
    except BaseException:
        _end_workers()
        raise
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def _end_workers() -> None:
    """Stop the processes started here, so that Ctrl-C does not wait for the tasks they are in."""
    for process in multiprocessing.active_children():
        process.terminate()
