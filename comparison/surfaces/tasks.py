"""The tasks of a study's surfaces: its batches of phase pairs."""

from __future__ import annotations

from collections.abc import Sequence

from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.batches import BatchResult, execute_batch
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
            needs_compiled_reference=batch.amplification.startswith("reference:"),
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
