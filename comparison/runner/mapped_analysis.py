"""Mapped analyses: one function over arguments, with a task for each of them."""

from collections.abc import Iterable
from typing import Any, ClassVar

import xarray as xr

from comparison.runner.analysis import Analysis, Result
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.study import Study


class MappedAnalysis(Analysis[Result]):
    """Base class of an analysis that calls one function for many arguments, one task for each."""

    function: ClassVar[Any]  # function of one argument, which runs inside a worker process
    without_value: ClassVar[Any]  # function of argument and failed result: returns what stands for the missing value
    needs_compiled_reference: ClassVar[bool] = True

    def task_arguments(self, study: Study, surfaces: xr.Dataset | None = None) -> Iterable[tuple[Any, ...]]:
        """Return the arguments of the function, one for each task: tuples that begin with a scene."""
        raise NotImplementedError

    def tasks(self, study: Study, surfaces: xr.Dataset | None = None) -> list[Task]:
        """Return the tasks: one call of the function for each argument."""
        compiled, arguments = self.needs_compiled_reference, self.task_arguments(study, surfaces)
        return [
            Task(
                function=self.function,
                argument=each,
                stage=self.stage,
                seconds=1.0,
                about=each[0],
                needs_compiled_reference=compiled,
            )
            for each in arguments
        ]

    def values(self, study: Study, surfaces: xr.Dataset | None, results: TaskResults) -> list[Any]:
        """Return what the tasks computed, in the order of the arguments; `without_value` stands for a failed task."""
        return [results.value(task, self.without_value) for task in self.tasks(study, surfaces)]

    def collect(self, study: Study, surfaces: xr.Dataset | None, results: TaskResults) -> Any:
        """Return the lists that the tasks returned, joined into one; None if it is empty."""
        return [each for listed in self.values(study, surfaces, results) for each in listed] or None
