"""Analysis: the one form of all computations in addition to the surfaces."""

from abc import abstractmethod
from typing import ClassVar, Protocol, TypeVar

import xarray as xr

from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.study import Study

LAST_LEVEL = 3  # number of the last level of a study, at which all of it is computed
Result = TypeVar("Result", covariant=True)


class Analysis(Protocol[Result]):
    """
    Computation of a study in addition to the surfaces: the tasks it takes, and the result made of theirs.

    No task is executed here. `tasks` lists them, a runner executes those that the cache lacks, and `collect` looks the
    results up by the same tasks.
    """

    key: ClassVar[str]  # name in a selection, and key of the findings
    stage: ClassVar[str]  # name of its stage of tasks on the terminal
    seconds: ClassVar[float] = 1.0  # s, rough processor time for one scene
    needs_surfaces: ClassVar[bool] = False  # whether its tasks depend on the values of the surfaces
    level: ClassVar[int] = LAST_LEVEL  # first level of the study whose report includes it

    def estimate_seconds(self, study: Study) -> float:
        """Return the rough processor time of this analysis in a study, s."""
        return self.seconds * len(study.scenes)

    @abstractmethod
    def tasks(self, study: Study, surfaces: xr.Dataset | None = None) -> list[Task]:
        """Return the tasks to compute. An analysis that does not need the surfaces ignores them."""

    @abstractmethod
    def collect(self, study: Study, surfaces: xr.Dataset | None, results: TaskResults) -> Result | None:
        """
        Return the result made of the results of `tasks(study, surfaces)`.

        A task that returned nothing leaves a gap that says why. None: the analysis does not apply to the study.
        """
