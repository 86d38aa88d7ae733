"""The workers of a command: processes of this machine, a cluster, or an executor that a program lends."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager

from comparison.runner.dask import cluster
from comparison.runner.executors import Pool, factory
from comparison.runner.processes import process_pool


@contextmanager
def workers(
    jobs: int, scheduler: str | None, models: set[str], executor: Pool = process_pool
) -> Iterator[tuple[int, Callable[[int], Executor]]]:
    """
    Workers for as long as the block lasts, started once for all that the command computes.

    Parameters
    ----------
    jobs : int
        Worker processes of this machine.
    scheduler : str or None
        Address of a Dask scheduler whose workers are taken instead.
    models : set of str
        Functions that the workers of a cluster must have in the same versions, as "package:name".
    executor : Executor or callable
        What makes the processes of this machine, or an executor in their place.

    Yields
    ------
    tuple
        Number of workers, and what makes an executor for a number of jobs.

    Raises
    ------
    SceneError
        If the cluster does not answer or would compute with other code.
    """
    if scheduler is not None:
        with cluster(scheduler, models) as remote:
            yield remote.width, factory(remote)
    elif executor is process_pool:
        with process_pool(jobs) as pool:
            yield jobs, factory(pool)
    else:
        yield jobs, factory(executor)
