"""The one way in which anything is computed: a task whose result is stored is looked up, any other is executed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from comparison.runner.executors import Pool, executing
from comparison.runner.progress import Display
from comparison.runner.sweep import Sweep
from comparison.runner.task import GIVEN_UP, GIVEN_UP_AFTER, Task, TaskResult, unfinished
from comparison.runner.task_results import TaskResults
from reference.problem import Outcome


@dataclass
class Runner:
    """
    Runs tasks on `executor`, or on what it makes for `jobs` workers, and stores every result as it arrives.

    display: what is told of finished work. stages: rough s of processor time of the stages of tasks; a stage that is
    not listed takes what its tasks weigh.
    """

    results: TaskResults
    jobs: int
    executor: Pool
    display: Display = field(default_factory=lambda: Display(0.0, 1))
    stages: Mapping[str, float] = field(default_factory=dict)
    lost: Counter[str] = field(default_factory=Counter)  # batches that hung or ended their process, by worker group
    compiled: bool = False  # whether a worker has compiled the reference

    def run(self, tasks: Sequence[Task], compiling: Callable[[], Task] | None = None) -> None:
        """
        Every task in one sweep: batches in their order, then the others, the longest first.

        compiling: makes a short task that compiles the reference; the tasks that need it wait for that one.
        Raises StoreError or ExecutorLostError if the cache cannot be written, or the executor cannot go on.
        """
        weights = self._weights(tasks)
        new = [task for task in tasks if task not in self.results]
        missing = self.results.missing(new)
        self.display.skip(sum(weights[id(task)] for task in new) - sum(weights[id(task)] for task in missing))
        if not missing:
            return
        missing.sort(key=lambda task: (task.batch is None, 0.0 if task.batch else -task.seconds))
        needed = not self.compiled and any(task.needs_compiled_reference for task in missing)
        first = compiling() if compiling and needed else None
        self._sweep(missing, weights, first)
        self.compiled = self.compiled or first is not None

    def _weights(self, tasks: Sequence[Task]) -> dict[int, float]:
        """Rough s of processor time of the tasks, from what their stages take."""
        sums: Counter[str] = Counter()
        for task in tasks:
            sums[task.stage] += task.seconds  # type: ignore[assignment]
        return {
            id(task): task.seconds * self.stages.get(task.stage, sums[task.stage]) / sums[task.stage] for task in tasks
        }

    def _sweep(self, missing: Sequence[Task], weights: Mapping[int, float], first: Task | None) -> None:
        """Run the tasks; `first`, whose result is not kept, before those that need the compiled reference."""
        tasks = [*([first] if first else []), *missing]
        waiting = first is not None
        total: Counter[str] = Counter()
        for task in tasks:
            total[task.stage] += task.points
        so_far: Counter[str] = Counter()
        with executing(self.executor, min(self.jobs, len(tasks))) as executor:

            def done(task: Task, result: TaskResult) -> None:
                nonlocal waiting
                if task is first:
                    waiting = False
                else:
                    self._keep(task, result)
                so_far[task.stage] += task.points
                unit = "phase pairs" if task.batch else "tasks"
                count = f"{so_far[task.stage]} of {total[task.stage]} {unit}"
                self.display.advance(task.stage, count, weights.get(id(task), 0.0))

            def ready(task: Task) -> bool:
                return not (waiting and task.needs_compiled_reference)

            Sweep(tasks, executor, self.jobs, done, ready, self._given_up).run()

    def _keep(self, task: Task, result: TaskResult) -> None:
        if task.batch and task.group and result.outcome in (Outcome.TIME_LIMIT, Outcome.WORKER_DIED):
            self.lost[task.group] += 1
        self.results.put(task, result)

    def _given_up(self, task: Task) -> TaskResult | None:
        """The result of a batch whose engine is not asked any more."""
        if task.batch and self.lost[task.group] >= GIVEN_UP_AFTER:
            return unfinished(Outcome.TIME_LIMIT, GIVEN_UP)
        return None
