"""
Run independent tasks on worker processes and lose none: one that raises or kills its worker is answered for.

Results come back in the order of the tasks, whatever the scheduling was.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Executor, Future, wait
from dataclasses import dataclass, field
from typing import Generic, TypeVar

from comparison.runner.executors import (
    ExecutorLostError,
    Pool,
    TimeLimitError,
    WorkerDiedError,
    abandon,
    factory,
    start,
    width,
)
from comparison.runner.processes import process_pool
from reference.problem import Outcome

Task = TypeVar("Task")
Result = TypeVar("Result")

LOOK = 1.0  # s: how often an executor is asked for its width while no result arrives


def at_once(task: object) -> bool:
    """Every task may begin at once."""
    return True


def whole(task: object) -> Sequence[object]:
    """No task is split."""
    return ()


def never(task: object) -> bool:
    """No task is given up."""
    return False


@dataclass(eq=False)  # found in the queue by what it is, not by comparing scenes and arrays
class _Work(Generic[Task, Result]):
    """A task or a part of one. `place`: its index among the tasks, or among the parts of `parent`."""

    task: Task
    place: int
    parent: _Work[Task, Result] | None = None
    deaths: int = 0
    alone: bool = False  # suspected of having ended a pool: nothing else may run beside it
    parts: dict[int, Result] = field(default_factory=dict)
    count: int = 0  # of its parts


def sweep(
    tasks: Sequence[Task],
    solve: Callable[[Task], Result],
    on_failure: Callable[[Task, Outcome, str], Result],
    done: Callable[[Task, Result], None],
    jobs: int,
    executor: Pool = process_pool,
    ready: Callable[[Task], bool] = at_once,
    split: Callable[[Task], Sequence[Task]] = whole,  # type: ignore[assignment]
    join: Callable[[Task, Sequence[Result]], Result] | None = None,
    given_up: Callable[[Task], bool] = never,
) -> list[Result]:
    """
    Run every task on an executor and lose none.

    A task that raises is answered by `on_failure(task, Outcome.SOLVER_FAILED, message)`. One that has a `timeout`, s of
    processor time, and takes longer, by `on_failure(task, Outcome.TIME_LIMIT, message)`. One whose worker dies is tried
    once more, then `split` into parts, until a part that cannot be split has killed two workers: that one alone is
    answered by `on_failure(part, Outcome.WORKER_DIED, message)`, and `join` puts the task together again.

    Parameters
    ----------
    tasks : sequence
        What is computed.
    solve : callable
        Function of a task, importable by its name.
    on_failure : callable
        The result of a task that `solve` gave none, from task, `Outcome` and message.
    done : callable
        Called here with a task and its result as results arrive, in any order.
    jobs : int
        Number of workers, for an executor that does not state its `width`.
    executor : Executor or callable
        What runs the tasks, or what makes it for a number of workers.
    ready : callable
        Whether a task may start. Others pass it meanwhile; it is asked again whenever a result has arrived, and the
        task starts in any case when nothing else is left to wait for.
    split : callable
        The parts of a task; empty if it cannot be split.
    join : callable
        The result of a task from those of its parts.
    given_up : callable
        Whether a task is not started any more. `done` is not called with it; its result is
        `on_failure(task, Outcome.TIME_LIMIT, message)`.

    Returns
    -------
    list
        Results in the order of the tasks.

    Raises
    ------
    ExecutorLostError
        If the executor cannot go on; results that `done` has seen are the caller's to keep.
    """
    return _Sweep(tasks, solve, on_failure, done, ready, split, join, given_up).run(factory(executor), jobs)


class _Sweep(Generic[Task, Result]):
    def __init__(
        self,
        tasks: Sequence[Task],
        solve: Callable[[Task], Result],
        on_failure: Callable[[Task, Outcome, str], Result],
        done: Callable[[Task, Result], None],
        ready: Callable[[Task], bool],
        split: Callable[[Task], Sequence[Task]],
        join: Callable[[Task, Sequence[Result]], Result] | None,
        given_up: Callable[[Task], bool],
    ) -> None:
        self._given_up = given_up
        self._solve, self._on_failure, self._done = solve, on_failure, done
        self._ready, self._split, self._join = ready, split, join
        self._queue: deque[_Work[Task, Result]] = deque(_Work(task, place) for place, task in enumerate(tasks))
        self._at_work: dict[Future[Result], _Work[Task, Result]] = {}
        self._results: dict[int, Result] = {}

    def run(self, make: Callable[[int], Executor], jobs: int) -> list[Result]:
        while self._queue:  # once, unless a pool breaks
            pool = make(min(jobs, len(self._queue)))
            try:
                self._drain(pool, jobs)
            except BaseException:
                abandon(pool)
                raise
            self._at_work.clear()
            pool.shutdown(cancel_futures=True)
        return [self._results[place] for place in range(len(self._results))]

    def _drain(self, pool: Executor, jobs: int) -> None:
        """Work until nothing is left, or until the pool breaks, with its tasks queued again."""
        while self._queue or self._at_work:
            if not self._fill(pool, jobs):
                return
            arrived = [
                (self._at_work.pop(future), future)
                for future in wait(self._at_work, LOOK, return_when=FIRST_COMPLETED).done
            ]
            broken = [work for work, future in arrived if isinstance(_error(future), BrokenExecutor)]
            try:
                unbroken = not broken and self._fill(
                    pool, jobs, arriving=True
                )  # workers go on while results are stored
            finally:
                for work, future in arrived:
                    self._take(work, future)
            for _, future in arrived:
                if isinstance(error := _error(future), ExecutorLostError):
                    raise error
            if broken:
                self._broken(broken)
            if not unbroken:
                return

    def _take(self, work: _Work[Task, Result], future: Future[Result]) -> None:
        error = _error(future)
        if error is None:
            self._keep(work, future.result())
        elif isinstance(error, WorkerDiedError):
            self._died(work, error.times, error.exit_code)
        elif isinstance(error, TimeLimitError):
            self._keep(work, self._on_failure(work.task, Outcome.TIME_LIMIT, str(error)))
        elif not isinstance(error, BrokenExecutor | ExecutorLostError):
            message = f"{type(error).__name__}: {error}"
            self._keep(work, self._on_failure(work.task, Outcome.SOLVER_FAILED, message))

    def _fill(self, pool: Executor, jobs: int, arriving: bool = False) -> bool:
        """
        As many tasks at work as the executor has workers; False if it is found broken.

        arriving: results have arrived that may make tasks ready, so that none is passed over yet.
        """
        while len(self._at_work) < width(pool, jobs) and (work := self._next(arriving)) is not None:
            if self._given_up(work.task):
                self._give_up(work)
                continue
            try:
                future = start(pool, self._solve, work.task, getattr(work.task, "timeout", None))
            except BrokenExecutor:
                if self._at_work:
                    self._queue.appendleft(work)
                self._broken([] if self._at_work else [work])
                return False
            self._at_work[future] = work
        return True

    def _next(self, arriving: bool) -> _Work[Task, Result] | None:
        """What to submit now, taken from the queue; a suspect runs alone."""
        at_work = list(self._at_work.values())
        if any(work.alone for work in at_work):
            return None
        for work in self._queue:
            if not (work.alone and at_work) and self._ready(work.task):
                break
            if arriving:
                return None
        else:
            if at_work or not self._queue:
                return None
            work = self._queue[0]
        self._queue.remove(work)
        return work

    def _broken(self, suspects: Sequence[_Work[Task, Result]]) -> None:
        """The suspects or any task at work did it. If there was only one it did; of several each is tried alone."""
        suspects = sorted([*suspects, *self._at_work.values()], key=lambda work: work.place)
        self._at_work.clear()
        if len(suspects) == 1:
            self._died(suspects[0])
        else:
            for work in reversed(suspects):
                work.alone = True
                self._queue.appendleft(work)

    def _died(self, work: _Work[Task, Result], times: int = 1, exit_code: int | None = None) -> None:
        work.deaths += times
        parts = self._split(work.task)
        if work.deaths < 2 and (work.parent is None or not parts):
            self._queue.appendleft(work)
        elif parts:
            work.count = len(parts)
            children = [_Work(part, place, work, alone=work.alone) for place, part in enumerate(parts)]
            self._queue.extendleft(reversed(children))
        else:
            ending = "" if exit_code is None else f" (exit code {exit_code})"
            message = f"the worker process died {work.deaths} times{ending}"
            self._keep(work, self._on_failure(work.task, Outcome.WORKER_DIED, message))

    def _give_up(self, work: _Work[Task, Result]) -> None:
        """Neither the task nor that of which it is a part is computed."""
        while work.parent is not None:
            work = work.parent
        self._results[work.place] = self._on_failure(work.task, Outcome.TIME_LIMIT, "given up")

    def _keep(self, work: _Work[Task, Result], result: Result) -> None:
        parent = work.parent
        if parent is None:
            self._results[work.place] = result
            self._done(work.task, result)
            return
        parent.parts[work.place] = result
        if len(parent.parts) == parent.count:  # never, where one of them was given up
            assert self._join is not None, "what can be split can be joined"
            self._keep(parent, self._join(parent.task, [parent.parts[place] for place in range(parent.count)]))


def _error(future: Future[Result]) -> BaseException | None:
    """What the task raised, None if nothing."""
    try:
        return future.exception()
    except CancelledError as cancelled:
        return cancelled
