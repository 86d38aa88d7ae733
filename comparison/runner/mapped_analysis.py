"""Mapped analyses: one function over arguments, with a task for each of them."""

from collections.abc import Iterable
from typing import Any, ClassVar

import xarray as xr

from comparison.runner.analysis import Analysis, Result
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.study import Study


class MappedAnalysis(Analysis[Result]):
    """Analysis with one task for each argument, a tuple that begins with its scene."""

    function: ClassVar[Any]  # function of one argument, which runs inside a worker process
    without_value: ClassVar[Any]  # function of argument and result; returns the value for a task that returned none
    needs_compiled_reference: ClassVar[bool] = True

    def task_arguments(self, study: Study, surfaces: xr.Dataset | None = None) -> Iterable[tuple[Any, ...]]:
        """Return the arguments of the tasks."""
        raise NotImplementedError

    def tasks(self, study: Study, surfaces: xr.Dataset | None = None) -> list[Task]:
        """Return one task for each argument."""
        compiled, arguments = self.needs_compiled_reference, self.task_arguments(study, surfaces)
        return [Task(self.function, each, self.stage, 1.0, each[0], compiled) for each in arguments]

    def values(self, study: Study, surfaces: xr.Dataset | None, results: TaskResults) -> list[Any]:
        """Return the values of the tasks, in the order of the arguments."""
        return [results.value(task, self.without_value) for task in self.tasks(study, surfaces)]

    def collect(self, study: Study, surfaces: xr.Dataset | None, results: TaskResults) -> Any:
        """Return all values that the tasks listed; None if they listed none."""
        return [each for listed in self.values(study, surfaces, results) for each in listed] or None
