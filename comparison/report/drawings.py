"""Drawings of a report: made by the workers, kept like every result, and drawn here if that failed."""

from collections.abc import Callable
from typing import Any

from comparison.report.section import Report
from comparison.runner.task import Task
from comparison.surfaces.figures.pictures import Files, Pictures


def drawing_task(function: Callable[[Any], Files], argument: object) -> Task:
    """A drawing for a worker."""
    return Task(function, argument, Pictures.stage, needs_compiled_reference=False)


def drawn(report: Report, task: Task) -> Files:
    """The files of a task: from its worker, or drawn now."""
    files: Files = report.drawings.get(task.key) or task.function(task.argument)
    return files
