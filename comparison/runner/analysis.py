"""Analysis: the one form of all computations in addition to the surfaces."""

from abc import abstractmethod
from typing import ClassVar, Protocol, TypeVar

import xarray as xr

from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.study import Study

LAST_LEVEL = 3  # number of the last and finest step of a study, in which all phases and analyses are computed
Result = TypeVar("Result", covariant=True)  # type of the result of an analysis


class Analysis(Protocol[Result]):
    """
    Computation of a study beside its amplification surfaces: its tasks, and the result made from what they return.

    No task is executed here. `tasks` lists them, a runner executes those that the cache lacks, and `collect` looks the
    results up by the same tasks.
    """

    key: ClassVar[str]  # name of the analysis in options, and key of its result
    stage: ClassVar[str]  # name under which the terminal shows the progress of its tasks
    seconds: ClassVar[float] = 1.0  # s, rough processor time for one scene
    needs_surfaces: ClassVar[bool] = False  # whether its tasks depend on the amplification, which is computed first
    level: ClassVar[int] = LAST_LEVEL  # number of the study's step, from coarse to full grid, that first computes it

    def estimate_seconds(self, study: Study) -> float:
        """Return the rough processor time of this analysis in a study, s."""
        return self.seconds * len(study.scenes)

    @abstractmethod
    def tasks(self, study: Study, surfaces: xr.Dataset | None = None) -> list[Task]:
        """Return the tasks to compute for a study; surfaces: its amplification, None if the tasks need none."""

    @abstractmethod
    def collect(self, study: Study, surfaces: xr.Dataset | None, results: TaskResults) -> Result | None:
        """
        Return the analysis's result, made from the results of its tasks; None if it does not apply to the study.

        Where a task failed, the result says why a value is missing.
        """
