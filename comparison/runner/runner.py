"""
Runner of tasks, the one way in which anything is computed: a stored result is read, any other task is executed.

No task is lost: one that raises, hangs or ends its worker is answered for.
"""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Executor, Future, wait
from dataclasses import dataclass, field
from functools import partial

import numpy as np

import reference
from comparison.runner.processes import ExecutorLostError, Pool, TimeLimitError, WorkerDiedError, open_executor
from comparison.runner.progress import Display
from comparison.runner.task import (
    GIVEN_UP_MESSAGE,
    MAX_FAILED_BATCHES,
    Task,
    TaskResult,
    execute_task,
    make_failed_result,
)
from comparison.runner.task_results import TaskResults
from comparison.wording import word_exception
from reference.problem import Outcome, Scene, load_scene

WIDTH_CHECK_INTERVAL = 1.0  # s, longest wait for a result before the executor's number of workers is read again
LOST_ERRORS = BrokenExecutor, ExecutorLostError, CancelledError  # errors of a task that mean that all workers are lost
COMPILING_DURATION = 0.5  # s, duration of the motion that compiles the reference equations: it needs every function


@dataclass(eq=False)  # no comparison by content: comparing scenes and arrays would be slow
class _WorkItem:
    """A task in the queue, or half of the task of `parent`, with its result and how often its worker died."""

    task: Task
    parent: _WorkItem | None = None
    deaths: int = 0
    halves: Sequence[_WorkItem] = ()
    result: TaskResult | None = None


@dataclass
class Runner:
    """
    Runs tasks on worker processes or a cluster, and stores every result as it arrives.

    A task that raises has the outcome SOLVER_FAILED, and one that takes longer than its `timeout` TIME_LIMIT. One whose
    worker dies is tried once more, then cut in halves, until a part that cannot be cut has killed two workers: that one
    alone has the outcome WORKER_DIED, and the task is joined again.

    display: what is told of finished work. stages: rough s of processor time of the stages of tasks; a stage that is
    not listed takes what its tasks weigh.
    """

    results: TaskResults
    jobs: int
    executor: Pool
    display: Display = field(default_factory=lambda: Display(0.0, 1))
    stages: Mapping[str, float] = field(default_factory=dict)
    # Number of batches (tasks of several phase pairs) that timed out or ended their process, by group of workers
    hung: Counter[str] = field(default_factory=Counter)
    compiled: bool = False  # whether a worker has compiled the reference equations

    def run(self, tasks: Sequence[Task], compiling: Callable[[], Task] | None = None) -> None:
        """
        Compute and store every task that has no stored result: batches in their order, then the others, longest first.

        compiling: makes a short task that compiles the reference equations; tasks that need these wait for it.
        Raises StoreError or ExecutorLostError if the cache cannot be written, or the executor cannot go on.
        """
        sums: Counter[str] = Counter()
        for task in tasks:
            sums[task.stage] += task.seconds  # type: ignore[assignment]
        self._weights = {  # rough processor time of each task, s
            id(task): task.seconds * self.stages.get(task.stage, sums[task.stage]) / sums[task.stage] for task in tasks
        }
        new = [task for task in tasks if task not in self.results]
        missing = self.results.find_missing(new)
        self.display.skip(
            sum(self._weights[id(task)] for task in new) - sum(self._weights[id(task)] for task in missing)
        )
        if not missing:
            return
        missing.sort(key=lambda task: (task.batch is None, 0.0 if task.batch else -task.seconds))
        needed = not self.compiled and any(task.needs_compiled_reference for task in missing)
        self._first = compiling() if compiling and needed else None  # None again when the compiling task is done
        self._queue = deque(map(_WorkItem, [self._first, *missing] if self._first else missing))
        self._at_work: dict[Future[TaskResult], _WorkItem] = {}
        self._so_far: Counter[str] = Counter()
        self._total: Counter[str] = Counter()
        for work in self._queue:
            self._total[work.task.stage] += work.task.points
        with open_executor(self.executor, min(self.jobs, len(self._queue))) as executor:
            self._run_queue(executor)

    def _run_queue(self, executor: Executor) -> None:
        """Compute all tasks in the queue and store each result as it arrives."""
        try:
            while self._queue or self._at_work:
                self._fill_workers(executor)
                finished = wait(self._at_work, WIDTH_CHECK_INTERVAL, return_when=FIRST_COMPLETED).done
                arrived = [(self._at_work.pop(future), future) for future in finished]
                try:
                    self._fill_workers(executor, arriving=True)  # before results are stored, so that no worker waits
                finally:
                    for work, future in sorted(arrived, key=lambda pair: isinstance(_get_error(pair[1]), LOST_ERRORS)):
                        self._take_result(work, future)
        except BaseException:
            for future in self._at_work:
                future.cancel()
            if hasattr(executor, "abandon"):
                executor.abandon()
            raise

    def _fill_workers(self, executor: Executor, arriving: bool = False) -> None:
        """
        Start tasks until each worker has one.

        arriving: whether results have come that are not read yet, which may free a waiting task. Then only the first
        task of the queue may start, so that none overtakes it.
        """
        while len(self._at_work) < getattr(executor, "width", self.jobs):
            candidates = list(self._queue)[:1] if arriving else self._queue
            ready = (work for work in candidates if not (self._first and work.task.needs_compiled_reference))
            if (work := next(ready, None)) is None:
                return
            self._queue.remove(work)
            if work.task.batch and self.hung[work.task.group] >= MAX_FAILED_BATCHES:
                self._keep_result(work, make_failed_result(Outcome.NOT_ASKED, GIVEN_UP_MESSAGE))
            else:
                self._at_work[_start_task(work.task, executor)] = work

    def _take_result(self, work: _WorkItem, future: Future[TaskResult]) -> None:
        """Store the result of a finished task; handle the death of its worker, a time limit, or another error."""
        error = _get_error(future)
        if error is None:
            self._keep_result(work, future.result())
        elif isinstance(error, WorkerDiedError):
            self._handle_worker_death(work, error)
        elif isinstance(error, TimeLimitError):
            self._keep_result(work, make_failed_result(Outcome.TIME_LIMIT, str(error)))
        elif isinstance(error, ExecutorLostError):
            raise error
        elif isinstance(error, LOST_ERRORS):
            raise ExecutorLostError(f"the executor is broken: {error}")
        else:
            self._keep_result(work, make_failed_result(Outcome.SOLVER_FAILED, word_exception(error)))

    def _handle_worker_death(self, work: _WorkItem, error: WorkerDiedError) -> None:
        """Try a task again if its worker died; the second time halve it, to find the phase pair that is the cause."""
        work.deaths += error.times
        halves = work.task.halves()
        if work.deaths < 2 and (work.parent is None or not halves):
            self._queue.appendleft(work)
        elif halves:
            work.halves = [_WorkItem(half, work) for half in halves]
            self._queue.extendleft(reversed(work.halves))
        else:
            ending = "" if error.exit_code is None else f" (exit code {error.exit_code})"
            self._keep_result(
                work, make_failed_result(Outcome.WORKER_DIED, f"the worker process died {work.deaths} times{ending}")
            )

    def _keep_result(self, work: _WorkItem, result: TaskResult) -> None:
        """Store the result of a task; keep that of a half until the other half has one too, then store both joined."""
        work.result, parent, task = result, work.parent, work.task
        if parent is not None:
            results = [half.result for half in parent.halves if half.result is not None]
            if len(results) == len(parent.halves):
                self._keep_result(parent, parent.task.join(results))
            return
        if task is self._first:
            self._first, self.compiled = None, True
        else:
            if task.batch and task.group and result.outcome in (Outcome.TIME_LIMIT, Outcome.WORKER_DIED):
                self.hung[task.group] += 1
            self.results.put(task, result)
        self._so_far[task.stage] += task.points
        count = f"{self._so_far[task.stage]} of {self._total[task.stage]} {'phase pairs' if task.batch else 'tasks'}"
        self.display.advance(task.stage, count, self._weights.get(id(task), 0.0))


def _start_task(task: Task, executor: Executor) -> Future[TaskResult]:
    """Start a task on the executor, with its time limit if the executor can limit time."""
    start: Callable[..., Future[TaskResult]] | None = getattr(executor, "start", None)
    try:
        if start is None:  # an executor that cannot limit the time of a call, such as one of threads
            return executor.submit(execute_task, task)
        return start(partial(execute_task, task), task.timeout, task.group)
    except BrokenExecutor as error:
        raise ExecutorLostError(f"the executor is broken: {error}") from None


def _get_error(future: Future[TaskResult]) -> BaseException | None:
    """Return the error with which a finished task ended, None if it has a result."""
    try:
        return future.exception()
    except CancelledError as cancelled:
        return cancelled


def make_compiling_task() -> Task:
    """
    Return a task that compiles the reference equations by a short motion; the compiled code is kept on disk.

    One worker does that while the others compute with Exudyn, so that no two of them compile the same code.
    """
    scene = load_scene("fig3-I").with_values({"duration": COMPILING_DURATION})
    return Task(
        function=_compile_reference,
        argument=scene,
        stage="compiling the reference, once",
        seconds=0.0,
        needs_compiled_reference=False,
    )


def _compile_reference(scene: Scene) -> None:
    """Compile the reference equations by computing one short motion."""
    reference.amplification(scene, np.zeros((1, 2)), equations="exact")
