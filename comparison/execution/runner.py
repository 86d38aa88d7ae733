"""
The batches and tasks of a study, each from the cache if it is there, else computed, stored at once, shown as progress.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from rich.console import Console

from comparison.execution.cache import Cache
from comparison.execution.executors import Pool
from comparison.execution.keys import batch_key, cached_batch
from comparison.execution.progress import Stage, progress
from comparison.execution.splitting import merge, split_batch
from comparison.execution.sweep import sweep
from comparison.execution.task import Task, TaskResult, execute
from comparison.execution.task_cache import TaskCache
from comparison.execution.warm_up import WARM_UP, warm_up
from comparison.study.batches import Batch, BatchResult, execute_batch, unanswered
from comparison.study.overhead import COMPILED_ONCE, START_UP
from comparison.study.study import Study
from reference.problem import Outcome

COMPILING = "compiling the reference"


@dataclass(frozen=True)
class Computed:
    """`answers` to `batches`, in their order. stored: how many were there before."""

    batches: Sequence[Batch]
    answers: Sequence[BatchResult]
    stored: int


def computed(
    study: Study,
    cache: Cache,
    console: Console,
    jobs: int,
    executor: Pool,
    tasks: Sequence[Task] = (),
    answers: TaskCache | None = None,
) -> Computed:
    """
    Every batch of the study and every task, the missing ones computed on `executor` in one sweep.

    What tasks gave is in `answers`. Raises StoreError and ExecutorLostError.
    """
    answers = TaskCache(cache) if answers is None else answers
    batches = study.batches()
    found = {place: answer for place, batch in enumerate(batches) if (answer := cached_batch(cache, batch)) is not None}
    missing = [place for place in range(len(batches)) if place not in found]
    open_ = answers.missing(tasks)
    stages = _stages(study, batches, missing, tasks, open_)
    if found:
        others = f", {len(tasks) - len(open_)} of {len(tasks)} analyses" if tasks else ""
        stored = f"{len(found)} of {len(batches)} batches{others} are in {cache.folder}: only the others are computed."
        console.print(stored, soft_wrap=True)  # a path is copied whole
    if missing or open_:
        rest = [batches[place] for place in missing]
        found |= zip(missing, _solved(study, rest, open_, cache, answers, console, stages, jobs, executor))
    return Computed(batches, [found[place] for place in range(len(batches))], len(batches) - len(missing))


def fetched(tasks: Sequence[Task], answers: TaskCache, console: Console, jobs: int, executor: Pool) -> None:
    """Every task, the missing ones computed on `executor`; what they gave is in `answers`. Raises as `computed`."""
    open_ = sorted(answers.missing(tasks), key=lambda task: -task.seconds)
    if not open_:
        return
    with progress(console, _task_stages(tasks, open_), jobs) as display:

        def done(task: Task, found: TaskResult | None) -> None:
            answers.put(task, found)
            display.advance(task.stage, 1)

        sweep(open_, execute, _nothing, done, jobs, executor)


def _stages(
    study: Study, batches: Sequence[Batch], missing: Sequence[int], tasks: Sequence[Task], open_: Sequence[Task]
) -> dict[str, Stage]:
    stages = {COMPILING: Stage(1, START_UP)} if missing or open_ else {}
    for model in study.hierarchy:
        own = {place: len(batch.phases) for place, batch in enumerate(batches) if batch.model == model.key}
        if own:
            points = sum(own.values())
            left = sum(own[place] for place in missing if place in own)
            stages[model.title] = Stage(points, study.seconds(model), points - left)
    return stages | _task_stages(tasks, open_)


def _task_stages(tasks: Sequence[Task], open_: Sequence[Task]) -> dict[str, Stage]:
    stages = {}
    for name in dict.fromkeys(task.stage for task in tasks):
        own = [task.seconds for task in tasks if task.stage == name]
        left = sum(task.stage == name for task in open_)
        stages[name] = Stage(len(own), sum(own), len(own) - left)
    return stages


def _solved(
    study: Study,
    batches: Sequence[Batch],
    tasks: Sequence[Task],
    cache: Cache,
    answers: TaskCache,
    console: Console,
    stages: dict[str, Stage],
    jobs: int,
    executor: Pool,
) -> list[BatchResult]:
    titles = {WARM_UP: COMPILING, **{model.key: model.title for model in study.hierarchy}}
    compiled = {model.key for model in study.hierarchy if model.side == "reference"}
    pending = {WARM_UP}
    console.print(COMPILED_ONCE)
    with progress(console, stages, jobs) as display:

        def done(piece: Piece, answer: BatchResult | TaskResult | None) -> None:
            if isinstance(piece, Task):
                assert not isinstance(answer, BatchResult)
                answers.put(piece, answer)
                display.advance(piece.stage, 1)
                return
            assert isinstance(answer, BatchResult)
            if piece.model != WARM_UP:
                cache.put(batch_key(piece), answer)
            pending.discard(piece.model)
            display.advance(titles[piece.model], len(piece.phases))

        def ready(piece: Piece) -> bool:
            needs = piece.compiled if isinstance(piece, Task) else piece.model in compiled
            return not (pending and needs)

        # the longest tasks first: no worker is left with one when the others are done
        asked: list[Piece] = [warm_up(study), *batches, *sorted(tasks, key=lambda task: -task.seconds)]
        found = sweep(asked, _run, _lost, done, jobs, executor, ready, _split, _join)
        return [answer for answer in found if isinstance(answer, BatchResult)][1:]  # without the warm-up


Piece = Batch | Task


def _run(piece: Piece) -> BatchResult | TaskResult | None:
    return execute(piece) if isinstance(piece, Task) else execute_batch(piece)


def _lost(piece: Piece, outcome: Outcome, error_message: str) -> BatchResult | TaskResult | None:
    return None if isinstance(piece, Task) else unanswered(piece, outcome, error_message)


def _nothing(task: Task, outcome: Outcome, error_message: str) -> TaskResult | None:
    """The analysis asks again by itself and says in its own way that there is no answer."""
    return None


def _split(piece: Piece) -> Sequence[Piece]:
    return () if isinstance(piece, Task) else split_batch(piece)


def _join(piece: Piece, answers: Sequence[BatchResult | TaskResult | None]) -> BatchResult | TaskResult | None:
    assert isinstance(piece, Batch), "tasks are not split"
    return merge(piece, [answer for answer in answers if isinstance(answer, BatchResult)])
