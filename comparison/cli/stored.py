"""Where a command keeps the results of its tasks, so that the same command goes on where it stopped."""

from __future__ import annotations

from pathlib import Path

from comparison.execution.cache import Cache, refuse_foreign_store, store_beside
from comparison.execution.output import destination
from comparison.execution.task_results import TaskResults

OUT_HELP = "report whose stored results, in DIR.tiles, are used and added to (default %(default)s)"


def results_beside(out: Path) -> TaskResults:
    """
    The results kept beside the report `out`, as the command line names it.

    Raises
    ------
    SceneError
        One line, if there is no place for them.
    """
    place = destination(out)
    refuse_foreign_store(place)
    return TaskResults(Cache(store_beside(place)))
