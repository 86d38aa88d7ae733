"""The workers of a command: processes of this machine, a cluster, or an executor that a program lends."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from comparison.runner.dask import cluster
from comparison.runner.executors import Pool
from comparison.runner.processes import process_pool


@contextmanager
def workers(
    jobs: int, scheduler: str | None, models: set[str], executor: Pool = process_pool
) -> Iterator[tuple[int, Pool]]:
    """The number of workers and what runs them, for all that a command computes in the block. Raises SceneError."""
    if scheduler is not None:
        with cluster(scheduler, models) as remote:
            yield remote.width, remote
    elif executor is process_pool:
        with process_pool(jobs) as pool:
            yield jobs, pool
    else:
        yield jobs, executor
