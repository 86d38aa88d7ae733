"""The one shape of everything that is computed in addition to the surfaces."""

from abc import abstractmethod
from typing import ClassVar, Protocol, TypeVar

import xarray as xr

from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.study import Study

LAST = 3  # level of a study: the whole of it
Result = TypeVar("Result", covariant=True)


class Analysis(Protocol[Result]):
    """
    Something that a study finds out: which tasks it takes, and what their results say.

    No task is executed here. `tasks` lists them, a runner executes those that the cache lacks, and `collect` looks the
    results up by the same tasks.
    """

    key: ClassVar[str]  # its name for a selection, and its field of the findings
    stage: ClassVar[str]  # the stage of its tasks, on the terminal
    seconds: ClassVar[float] = 1.0  # rough s of processor time for one scene
    needs_surfaces: ClassVar[bool] = False  # whether the surfaces choose its tasks
    level: ClassVar[int] = LAST  # the first level of the study whose report has it

    def estimate_seconds(self, study: Study) -> float:
        """Return the rough processor time of a study, s."""
        return self.seconds * len(study.scenes)

    @abstractmethod
    def tasks(self, study: Study, surfaces: xr.Dataset | None = None) -> list[Task]:
        """Return what has to be computed. An analysis that does not need the surfaces ignores them."""

    @abstractmethod
    def collect(self, study: Study, surfaces: xr.Dataset | None, results: TaskResults) -> Result | None:
        """
        Return what the results of `tasks(study, surfaces)` say.

        A task that returned nothing leaves a gap that says why. None: the analysis does not apply to the study.
        """
