"""Run independent tasks on an executor and lose none: one that raises or ends its worker is answered for."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Executor, Future, wait
from dataclasses import dataclass
from functools import partial

from comparison.runner.executors import ExecutorLostError, TimeLimitError, WorkerDiedError
from comparison.runner.task import Task, TaskResult, execute, unfinished
from reference.problem import Outcome

LOOK = 1.0  # s: how often an executor is asked for its width while no result arrives
LOST = BrokenExecutor, ExecutorLostError, CancelledError


@dataclass(eq=False)  # found in the queue by what it is, not by comparing scenes and arrays
class _Work:
    """A task, or a half of the task of `parent`."""

    task: Task
    parent: _Work | None = None
    deaths: int = 0
    halves: Sequence[_Work] = ()
    result: TaskResult | None = None


@dataclass
class Sweep:
    """
    Tasks that are run on an executor. Each is told to `done` with its result as that arrives, in any order.

    A task that raises has the outcome SOLVER_FAILED, and one that takes longer than its `timeout` TIME_LIMIT. One whose
    worker dies is tried once more, then cut in halves, until a part that cannot be cut has killed two workers: that one
    alone has the outcome WORKER_DIED, and the task is joined again.

    jobs: number of workers, for an executor that does not state its `width`. ready: whether a task may start; others
    pass it meanwhile, and it starts in any case when nothing else is left to wait for. given_up: the result of a task
    that is not started any more.
    """

    tasks: Sequence[Task]
    executor: Executor
    jobs: int
    done: Callable[[Task, TaskResult], None]
    ready: Callable[[Task], bool] = lambda task: True
    given_up: Callable[[Task], TaskResult | None] = lambda task: None

    def __post_init__(self) -> None:
        self._queue = deque(map(_Work, self.tasks))
        self._at_work: dict[Future[TaskResult], _Work] = {}

    def run(self) -> None:
        """Run every task. Raises ExecutorLostError if the executor cannot go on; what `done` has seen is kept."""
        try:
            while self._queue or self._at_work:
                self._fill()
                finished = wait(self._at_work, LOOK, return_when=FIRST_COMPLETED).done
                arrived = [(self._at_work.pop(future), future) for future in finished]
                try:
                    self._fill(arriving=True)  # workers go on while results are stored
                finally:
                    for work, future in sorted(arrived, key=lambda pair: isinstance(_error(pair[1]), LOST)):
                        self._take(work, future)
        except BaseException:
            for future in self._at_work:
                future.cancel()
            if hasattr(self.executor, "abandon"):
                self.executor.abandon()
            raise

    def _fill(self, arriving: bool = False) -> None:
        """As many tasks at work as there are workers; arriving: results that may make tasks ready are not told yet."""
        while len(self._at_work) < getattr(self.executor, "width", self.jobs) and (work := self._next(arriving)):
            given_up = self.given_up(work.task)
            if given_up is not None:
                self._keep(work, given_up)
            else:
                self._at_work[self._start(work.task)] = work

    def _next(self, arriving: bool) -> _Work | None:
        """What starts now, taken from the queue: the first that is ready, or the first of all if nothing is at work."""
        candidates = list(self._queue)[:1] if arriving else self._queue
        work = next((work for work in candidates if self.ready(work.task)), None)
        if work is None and self._queue and not (self._at_work or arriving):
            work = self._queue[0]
        if work is not None:
            self._queue.remove(work)
        return work

    def _start(self, task: Task) -> Future[TaskResult]:
        start: Callable[..., Future[TaskResult]] | None = getattr(self.executor, "start", None)
        try:
            if start is None:  # such as threads: they keep no limit of time
                return self.executor.submit(execute, task)
            return start(partial(execute, task), task.timeout, task.group)
        except BrokenExecutor as error:
            raise ExecutorLostError(f"the executor is broken: {error}") from None

    def _take(self, work: _Work, future: Future[TaskResult]) -> None:
        error = _error(future)
        if error is None:
            self._keep(work, future.result())
        elif isinstance(error, WorkerDiedError):
            self._died(work, error)
        elif isinstance(error, TimeLimitError):
            self._keep(work, unfinished(Outcome.TIME_LIMIT, str(error)))
        elif isinstance(error, ExecutorLostError):
            raise error
        elif isinstance(error, LOST):
            raise ExecutorLostError(f"the executor is broken: {error}")
        else:
            self._keep(work, unfinished(Outcome.SOLVER_FAILED, f"{type(error).__name__}: {error}"))

    def _died(self, work: _Work, error: WorkerDiedError) -> None:
        work.deaths += error.times
        halves = work.task.halves()
        if work.deaths < 2 and (work.parent is None or not halves):
            self._queue.appendleft(work)
        elif halves:
            work.halves = [_Work(half, work) for half in halves]
            self._queue.extendleft(reversed(work.halves))
        else:
            ending = "" if error.exit_code is None else f" (exit code {error.exit_code})"
            self._keep(work, unfinished(Outcome.WORKER_DIED, f"the worker process died {work.deaths} times{ending}"))

    def _keep(self, work: _Work, result: TaskResult) -> None:
        work.result, parent = result, work.parent
        if parent is None:
            self.done(work.task, result)
            return
        results = [half.result for half in parent.halves if half.result is not None]
        if len(results) == len(parent.halves):
            self._keep(parent, parent.task.join(results))


def _error(future: Future[TaskResult]) -> BaseException | None:
    """What the task raised, None if nothing."""
    try:
        return future.exception()
    except CancelledError as cancelled:
        return cancelled
