"""
Cells solved in processes that can be killed: a model that hangs or crashes costs its cell and nothing else.

A process answers one request after the other over a pipe. The system ends one that computes for longer than the limit,
in its own processor time: what else the machine does makes no model hang. One that dies is replaced; both are answers
about the cell.
"""

from __future__ import annotations

import math
import multiprocessing
import signal
import time
import warnings
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import Any, Generic, TypeVar

Task = TypeVar("Task")
Result = TypeVar("Result")

try:
    import resource
except ImportError:  # Windows limits no process: the wall time has to do
    resource = None  # type: ignore[assignment]

CONTEXT = multiprocessing.get_context("spawn")
STALLED = 20.0  # times the limit: wall time after which a silent process waits for something that never comes


@dataclass(frozen=True)
class NoAnswer:
    """Instead of a result: the time limit passed, or the process ended by itself."""

    why: str


@dataclass
class _Worker(Generic[Task]):
    process: BaseProcess
    pipe: Connection
    index: int = -1
    deadline: float = 0.0  # wall time


def answers(
    tasks: Sequence[Task],
    solve: Callable[[Task], Result],
    limit: float,
    jobs: int,
    done: Callable[[int, Result | NoAnswer], None],
    first: Task | None = None,
) -> list[Result | NoAnswer]:
    """
    `solve(task)` for every task in `jobs` processes, in the order of the tasks; `solve` is importable and never raises.

    limit: s of processor time for one task, rounded up to whole seconds. done: called with a task's index and its
    result as they arrive. first: solved alone and without a limit before all others, such as what compiles a model.
    """
    results: dict[int, Result | NoAnswer] = {}
    queue = deque(range(len(tasks)))
    workers = [_begin(solve) for _ in range(max(1, min(jobs, len(tasks))))]
    try:
        if first is not None:
            workers[0].pipe.send((first, math.inf))
            if isinstance(_received(workers[0], math.inf), NoAnswer):
                _replace(workers[0], solve)
        while len(results) < len(tasks):
            for worker in workers:
                if worker.index < 0 and queue:
                    worker.index = queue.popleft()
                    worker.deadline = time.monotonic() + STALLED * limit
                    worker.pipe.send((tasks[worker.index], limit))
            busy = [worker for worker in workers if worker.index >= 0]
            rest = min(worker.deadline for worker in busy) - time.monotonic()
            ready = wait([worker.pipe for worker in busy], timeout=max(rest, 0.0))
            for worker in busy:
                if worker.pipe in ready:
                    result = _received(worker, limit)
                elif time.monotonic() > worker.deadline:
                    result = NoAnswer(f"hangs: no answer within {STALLED * limit:g} s")
                else:
                    continue
                if isinstance(result, NoAnswer):
                    _replace(worker, solve)
                results[worker.index] = result
                done(worker.index, result)
                worker.index = -1
    finally:
        for worker in workers:
            _end(worker)
    return [results[index] for index in range(len(tasks))]


def _received(worker: _Worker[Any], limit: float) -> Any:
    try:
        return worker.pipe.recv()
    except (EOFError, OSError):
        worker.process.join(5.0)
        if resource is not None and worker.process.exitcode == -signal.SIGXCPU:
            return NoAnswer(f"hangs: no answer within {limit:g} s of processor time")
        return NoAnswer(f"crashes: the process ended with exit code {worker.process.exitcode}")


def _begin(solve: Callable[[Any], Any]) -> _Worker[Any]:
    here, there = CONTEXT.Pipe()
    process = CONTEXT.Process(target=_serve, args=(there, solve), daemon=True)
    process.start()
    there.close()
    return _Worker(process, here)


def _replace(worker: _Worker[Any], solve: Callable[[Any], Any]) -> None:
    _end(worker)
    fresh = _begin(solve)
    worker.process, worker.pipe = fresh.process, fresh.pipe


def _end(worker: _Worker[Any]) -> None:
    worker.process.kill()
    worker.process.join()
    worker.pipe.close()


def _serve(pipe: Connection, solve: Callable[[Any], Any]) -> None:
    """What a process does until it is killed."""
    import numba

    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C goes to the whole group; the parent ends the others
    numba.set_num_threads(1)
    warnings.simplefilter("ignore")  # overflow in an extreme is judged by what comes of it
    while True:
        try:
            task, limit = pipe.recv()
        except EOFError:
            return
        _allow(limit)
        pipe.send(solve(task))


def _allow(limit: float) -> None:
    """Let the system end this process after `limit` more s of processor time."""
    if resource is None:
        return
    resource.setrlimit(resource.RLIMIT_CORE, (0, resource.getrlimit(resource.RLIMIT_CORE)[1]))
    most = resource.getrlimit(resource.RLIMIT_CPU)[1]
    end = most
    if math.isfinite(limit):
        end = math.ceil(time.process_time() + limit)
        end = end if most == resource.RLIM_INFINITY else min(end, most)
    resource.setrlimit(resource.RLIMIT_CPU, (end, most))
