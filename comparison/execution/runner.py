"""
The one way in which anything is computed: batches and tasks, each from the cache if it is there, else executed.

Everything that is missing goes through the workers in one sweep, is stored as soon as it arrives, and is shown as
progress.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from rich.console import Console

from comparison.execution.deadline import Deadline
from comparison.execution.executors import Pool
from comparison.execution.keys import batch_key, cached_batch
from comparison.execution.progress import Stage, progress
from comparison.execution.splitting import merge, split_batch
from comparison.execution.sweep import sweep
from comparison.execution.task import Task, TaskResult, execute, unfinished
from comparison.execution.task_results import TaskResults
from comparison.execution.warm_up import WARM_UP, compiling_task, warm_up
from comparison.study.batches import Batch, BatchResult, execute_batch, unanswered
from comparison.study.overhead import COMPILED_ONCE, START_UP
from comparison.study.study import Study
from reference.problem import Outcome

COMPILING = "compiling the reference"
GIVEN_UP_AFTER = 2  # calls of one of the user's engines that hang or end their process: it is not asked again

Piece = Batch | Task


def longest_first(piece: Piece) -> float:
    """The order in which no worker is left with a long task when the others are done."""
    return -piece.seconds


def surfaces_first(piece: Piece) -> float:
    """The order of the study, then tasks, the longest first."""
    return -piece.seconds if isinstance(piece, Task) else -math.inf


@dataclass(frozen=True)
class Computed:
    """
    What a sweep has computed of a study. stored: how many batches were there before. batches, answers: in the order of
    the study; all of them, unless the deadline came first.
    """

    batches: Sequence[Batch]
    answers: Sequence[BatchResult]
    stored: int


@dataclass(frozen=True)
class Runner:
    """
    Runs batches and tasks on `executor`, or on what it makes for `jobs` workers, and keeps what they return.

    deadline: what would end after it is not computed.
    """

    results: TaskResults  # of all tasks, with the cache of both
    console: Console
    jobs: int
    executor: Pool
    deadline: Deadline | None = None

    def run_study(
        self, study: Study, tasks: Sequence[Task] = (), order: Callable[[Piece], float] = surfaces_first
    ) -> Computed:
        """
        Every batch of the study and every task, in one sweep.

        Parameters
        ----------
        study : Study
            What the surfaces are made of.
        tasks : sequence of Task
            What is computed beside them; `results` has what they return.
        order : callable
            Of a batch or task: those with the smallest value come first.

        Returns
        -------
        Computed
            The batches and their answers.

        Raises
        ------
        StoreError, ExecutorLostError
            If the cache cannot be written, or the executor cannot go on.
        """
        cache, batches = self.results.cache, study.batches()
        stored = [None if cache is None else cached_batch(cache, batch) for batch in batches]
        answers = {place: answer for place, answer in enumerate(stored) if answer is not None}
        missing = [place for place in range(len(batches)) if place not in answers]
        left = self.results.missing(tasks)
        if answers and cache is not None:
            others = f", {len(tasks) - len(left)} of {len(tasks)} analyses" if tasks else ""
            count = f"{len(answers)} of {len(batches)} batches{others}"
            # a path is copied whole
            self.console.print(f"{count} are in {cache.folder}: only the others are computed.", soft_wrap=True)
        if missing or left:
            stages = (
                {COMPILING: Stage(1, START_UP)} | _batch_stages(study, batches, missing) | _task_stages(tasks, left)
            )
            titles = {WARM_UP: COMPILING, **{model.key: model.title for model in study.hierarchy}}
            compiled = {model.key for model in study.hierarchy if model.side == "reference"}
            self.console.print(COMPILED_ONCE)
            pieces: list[Piece] = [*(batches[place] for place in missing), *left]
            done = self._sweep([warm_up(study), *sorted(pieces, key=order)], stages, titles, compiled, pending=True)
            computed = {id(piece): answer for piece, answer in done}
            answers |= {place: computed[id(batches[place])] for place in missing if id(batches[place]) in computed}
        places = sorted(answers)
        return Computed([batches[n] for n in places], [answers[n] for n in places], len(batches) - len(missing))

    def run_tasks(
        self, tasks: Sequence[Task], compile_first: bool = False, order: Callable[[Piece], float] = longest_first
    ) -> None:
        """
        Every task; `results` has what they return. Raises as `run_study`.

        compile_first: nothing has compiled the reference yet, so one worker does before the tasks that need it. A task
        that the deadline leaves out has a result that says so.
        """
        left = sorted(self.results.missing(tasks), key=order)
        if not left:
            return
        stages, pieces = _task_stages(tasks, left), list[Piece](left)
        pending = compile_first and any(task.needs_compiled_reference for task in left)
        if pending:
            stages = {COMPILING: Stage(1, START_UP)} | stages
            pieces.insert(0, compiling_task(COMPILING))
        self._sweep(pieces, stages, {}, set(), pending)
        for task in left:
            if task not in self.results:
                self.results.leave_out(task)

    def _sweep(
        self,
        pieces: Sequence[Piece],
        stages: Mapping[str, Stage],
        titles: Mapping[str, str],
        compiled: set[str],
        pending: bool,
    ) -> list[tuple[Batch, BatchResult]]:
        """
        Run the pieces in one sweep; the first of them compiles the reference if that is `pending`.

        titles: stages by the models of batches. compiled: the models that wait for the compiled reference. Returns the
        batches that were computed.
        """
        first = pieces[0] if pending else None
        waiting = {id(first)} if pending else set()
        computed: list[tuple[Batch, BatchResult]] = []
        lost: Counter[str] = Counter()  # calls by lane
        with progress(self.console, stages, self.jobs, self.deadline) as display:

            def done(piece: Piece, answer: BatchResult | TaskResult) -> None:
                waiting.discard(id(piece))
                if self.deadline is not None and piece is not first:
                    self.deadline.learn(piece.kind, piece.seconds, answer.cost)
                if isinstance(piece, Task):
                    assert isinstance(answer, TaskResult)
                    if piece is not first:
                        self.results.put(piece, answer)
                    display.advance(piece.stage, 1, piece.seconds)
                    return
                assert isinstance(answer, BatchResult)
                if piece.lane and {Outcome.TIME_LIMIT.value, Outcome.WORKER_DIED.value} & {*answer.status}:
                    lost[piece.lane] += 1
                if piece is not first:
                    computed.append((piece, answer))
                    if self.results.cache is not None:
                        self.results.cache.put(batch_key(piece), answer)
                display.advance(titles[piece.model], len(piece.phases), piece.seconds)

            def ready(piece: Piece) -> bool:
                needs = piece.needs_compiled_reference if isinstance(piece, Task) else piece.model in compiled
                return not (waiting and needs)

            def seconds_left(piece: Piece) -> float:
                if isinstance(piece, Batch) and lost[piece.lane] >= GIVEN_UP_AFTER:
                    return 0.0
                if self.deadline is None:
                    return math.inf
                return self.deadline.left if self.deadline.allows(piece.kind, piece.seconds) else 0.0

            execution = self.jobs, self.executor, ready, _split, _merge, seconds_left
            sweep(pieces, _execute, _unfinished, done, *execution)
        asked = {id(batch) for batch, _ in computed}
        given_up = [piece for piece in pieces if isinstance(piece, Batch) and lost[piece.lane] >= GIVEN_UP_AFTER]
        message = f"{GIVEN_UP_AFTER} calls hung or ended their process: not asked for the other phase pairs"
        computed += [
            (piece, unanswered(piece, Outcome.TIME_LIMIT, message)) for piece in given_up if id(piece) not in asked
        ]
        return computed


def _batch_stages(study: Study, batches: Sequence[Batch], missing: Sequence[int]) -> dict[str, Stage]:
    stages = {}
    for model in study.hierarchy:
        points_by_place = {place: len(batch.phases) for place, batch in enumerate(batches) if batch.model == model.key}
        if points_by_place:
            points = sum(points_by_place.values())
            left = sum(points_by_place[place] for place in missing if place in points_by_place)
            seconds = sum(batches[place].seconds for place in missing if place in points_by_place)
            stages[model.title] = Stage(points, seconds, points - left)
    return stages


def _task_stages(tasks: Sequence[Task], left: Sequence[Task]) -> dict[str, Stage]:
    stages = {}
    for name in dict.fromkeys(task.stage for task in tasks):
        count = sum(task.stage == name for task in tasks)
        seconds = [task.seconds for task in left if task.stage == name]
        stages[name] = Stage(count, sum(seconds), count - len(seconds))
    return stages


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
