"""
The one way in which anything is computed: batches and tasks, each from the cache if it is there, else executed.

Everything that is missing goes through the workers in one sweep and is stored as soon as it arrives.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field

from rich.console import Console

from comparison.runner.cache import Key
from comparison.runner.executors import Pool
from comparison.runner.keys import batch_key, cached_batch
from comparison.runner.progress import Display, progress
from comparison.runner.splitting import merge, split_batch
from comparison.runner.sweep import sweep
from comparison.runner.task import Task, TaskResult, execute, unfinished
from comparison.runner.task_results import TaskResults
from comparison.runner.warm_up import WARM_UP, compiling_task, warm_up
from comparison.study.batches import Batch, BatchResult, execute_batch, unanswered
from comparison.study.costs import seconds_per_point
from comparison.study.study import Study
from reference.problem import Outcome

COMPILING = "compiling the reference, once"
GIVEN_UP_AFTER = 2  # calls of one of the user's engines that hang or end their process: it is not asked again

Piece = Batch | Task


@dataclass(frozen=True)
class Computed:
    """The batches of a study with their answers, in the order of the study; how many an earlier run had stored."""

    batches: Sequence[Batch]
    answers: Sequence[BatchResult]
    stored: int


@dataclass
class Runner:
    """
    Runs batches and tasks on `executor`, or on what it makes for `jobs` workers, and keeps what they return.

    display: what is told of finished work; without it every call shows its own. stages: rough s of processor time of
    the stages of tasks; a stage that is not listed takes what its tasks weigh.
    """

    results: TaskResults  # of all tasks, with the cache of both
    console: Console
    jobs: int
    executor: Pool
    display: Display | None = None
    stages: Mapping[str, float] = field(default_factory=dict)
    answers: dict[Key, BatchResult] = field(default_factory=dict)  # of all batches so far
    stored: set[Key] = field(default_factory=set)  # of these, read from the cache
    lost: Counter[str] = field(default_factory=Counter)  # calls that hung or ended their process, by lane
    compiled: bool = False  # whether a worker has compiled the reference

    def run_study(self, study: Study, tasks: Sequence[Task] = ()) -> Computed:
        """
        Every batch of the study, then every task, in one sweep.

        Parameters
        ----------
        study : Study
            What the surfaces are made of.
        tasks : sequence of Task
            What is computed beside them; `results` has what they return.

        Returns
        -------
        Computed
            The batches and their answers.

        Raises
        ------
        StoreError, ExecutorLostError
            If the cache cannot be written, or the executor cannot go on.
        """
        batches = study.batches()
        keys = [batch_key(batch) for batch in batches]
        cache = self.results.cache
        weights = self._weights(study, batches) | self._task_weights(tasks)
        for key, batch in zip(keys, batches):
            if key not in self.answers and cache and (stored := cached_batch(cache, batch)):
                self.answers[key] = stored
                self.stored.add(key)
                self._skip([batch], weights)
        missing = [batch for key, batch in zip(keys, batches) if key not in self.answers]
        left = self.results.missing(tasks)
        self._skip(tasks, weights, left)
        if missing or left:
            titles = {model.key: model.title for model in study.hierarchy}
            waiting = {model.key for model in study.hierarchy if model.side == "reference"}
            first: list[Piece] = [] if self.compiled else [warm_up(study)]
            self._sweep([*first, *missing, *left], weights, titles, waiting, pending=not self.compiled)
            self.compiled = True
        return Computed(batches, [self.answers[key] for key in keys], sum(key in self.stored for key in keys))

    def run_tasks(self, tasks: Sequence[Task], compile_first: bool = False) -> None:
        """
        Every task, the longest first; `results` has what they return. Raises as `run_study`.

        compile_first: nothing has compiled the reference yet, so one worker does before the tasks that need it.
        """
        left = sorted(self.results.missing(tasks), key=lambda task: -task.seconds)
        weights = self._task_weights(tasks)
        self._skip(tasks, weights, left)
        if left:
            pending = compile_first and any(task.needs_compiled_reference for task in left)
            first = [compiling_task(COMPILING)] if pending else []
            self._sweep([*first, *left], weights, {}, set(), pending)

    def _weights(self, study: Study, batches: Sequence[Batch]) -> dict[int, float]:
        """Rough s of processor time of the batches."""
        models = {model.key: model for model in study.hierarchy}
        return {id(batch): len(batch.phases) * seconds_per_point(batch.scene, models[batch.model]) for batch in batches}

    def _task_weights(self, tasks: Sequence[Task]) -> dict[int, float]:
        """The same of tasks, from what their stages take."""
        sums: Counter[str] = Counter()
        for task in tasks:
            sums[task.stage] += task.seconds  # type: ignore[assignment]
        return {
            id(task): task.seconds * self.stages.get(task.stage, sums[task.stage]) / sums[task.stage] for task in tasks
        }

    def _skip(self, pieces: Sequence[Piece], weights: Mapping[int, float], left: Sequence[Piece] = ()) -> None:
        """The pieces need no work, but for those that are left."""
        missing = set(map(id, left))
        if self.display is not None:
            self.display.skip(sum(weights[id(piece)] for piece in pieces if id(piece) not in missing))

    @contextmanager
    def _shown(self, weights: Mapping[int, float]) -> Iterator[Display]:
        if self.display is not None:
            yield self.display
        else:
            with progress(self.console, sum(weights.values()), self.jobs) as display:
                yield display

    def _sweep(
        self,
        pieces: Sequence[Piece],
        weights: Mapping[int, float],
        titles: Mapping[str, str],
        compiled: set[str],
        pending: bool,
    ) -> None:
        """
        Run the pieces in one sweep; the first of them compiles the reference if that is `pending`.

        titles: of the models of batches. compiled: the models that wait for the compiled reference.
        """
        first = pieces[0] if pending else None
        waiting = {id(first)} if pending else set()
        total = Counter(_name(piece, titles) for piece in pieces for _ in range(_points(piece)))
        done_so_far: Counter[str] = Counter()
        with self._shown(weights) as display:

            def done(piece: Piece, answer: BatchResult | TaskResult) -> None:
                waiting.discard(id(piece))
                if piece is not first:
                    self._keep(piece, answer)
                name = _name(piece, titles)
                done_so_far[name] += _points(piece)
                unit = "phase pairs" if isinstance(piece, Batch) else "tasks"
                display.advance(name, f"{done_so_far[name]} of {total[name]} {unit}", weights.get(id(piece), 0.0))

            def ready(piece: Piece) -> bool:
                needs = piece.needs_compiled_reference if isinstance(piece, Task) else piece.model in compiled
                return not (waiting and needs)

            def given_up(piece: Piece) -> bool:
                return isinstance(piece, Batch) and self.lost[piece.lane] >= GIVEN_UP_AFTER

            sweep(pieces, _execute, _unfinished, done, self.jobs, self.executor, ready, _split, _merge, given_up)
        message = f"{GIVEN_UP_AFTER} calls hung or ended their process: not asked for the other phase pairs"
        for piece in pieces:
            if isinstance(piece, Batch) and given_up(piece):
                self.answers.setdefault(batch_key(piece), unanswered(piece, Outcome.TIME_LIMIT, message))

    def _keep(self, piece: Piece, answer: BatchResult | TaskResult) -> None:
        if isinstance(piece, Task):
            assert isinstance(answer, TaskResult)
            self.results.put(piece, answer)
            return
        assert isinstance(answer, BatchResult)
        if piece.lane and {Outcome.TIME_LIMIT.value, Outcome.WORKER_DIED.value} & {*answer.status}:
            self.lost[piece.lane] += 1
        key = batch_key(piece)
        self.answers[key] = answer
        if self.results.cache is not None:
            self.results.cache.put(key, answer)


def _name(piece: Piece, titles: Mapping[str, str]) -> str:
    """What the terminal calls a piece of work."""
    if isinstance(piece, Task):
        return piece.stage
    return COMPILING if piece.model == WARM_UP else titles[piece.model]


def _points(piece: Piece) -> int:
    return len(piece.phases) if isinstance(piece, Batch) else 1


def _execute(piece: Piece) -> BatchResult | TaskResult:
    return execute(piece) if isinstance(piece, Task) else execute_batch(piece)


def _unfinished(piece: Piece, outcome: Outcome, error_message: str) -> BatchResult | TaskResult:
    failed = unfinished if isinstance(piece, Task) else unanswered
    return failed(piece, outcome, error_message)  # type: ignore[arg-type]


def _split(piece: Piece) -> Sequence[Piece]:
    return () if isinstance(piece, Task) else split_batch(piece)


def _merge(piece: Piece, answers: Sequence[BatchResult | TaskResult]) -> BatchResult:
    assert isinstance(piece, Batch), "tasks are not split"
    return merge(piece, [answer for answer in answers if isinstance(answer, BatchResult)])
