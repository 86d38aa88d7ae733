"""The tasks of a study's surfaces: its batches of phase pairs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.runner.warm_up import COMPILING, DURATION
from comparison.study.batches import Batch, BatchResult, execute_batch
from comparison.study.costs import seconds_per_point
from comparison.study.study import Study


def surface_tasks(study: Study) -> list[Task]:
    """A task for every batch of the study, in the same order."""
    models = {model.key: model for model in study.hierarchy}
    return [
        Task(
            execute_batch,
            batch,
            models[batch.model].title,
            batch.points * seconds_per_point(batch.scene, models[batch.model]),
            batch.question,
            needs_compiled_reference=models[batch.model].side == "reference",
            timeout=batch.timeout,
            group=batch.group,
            model=batch.amplification,
        )
        for batch in study.batches()
    ]


def batch_results(tasks: Sequence[Task], results: TaskResults) -> list[BatchResult]:
    """What the models answered to the batches; NaN with the reason where a task ended without a result."""
    return [
        results.value(task, lambda batch, failed: batch.without_result(failed.outcome, failed.error_message))
        for task in tasks
    ]


def warm_up(tasks: Sequence[Task]) -> Task:
    """
    A task that compiles the reference: one phase pair of the first scene under the exact equations, which no reduction
    solves without stepping, or under the first model. Over so short a time its numbers mean nothing.
    """
    task = next((task for task in tasks if task.argument.model == "exact"), tasks[0])
    batch: Batch = task.argument
    scene = batch.scene.with_values({"duration": DURATION})
    short = replace(batch, scene=scene, phases=batch.phases[:1])
    return replace(task, argument=short, stage=COMPILING, needs_compiled_reference=False)
