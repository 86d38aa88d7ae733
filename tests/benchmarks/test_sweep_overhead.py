"""
What store, sweep and executor cost beside the work they carry.

Batches that only wait keep the processors free, so that the pause of a worker between two of them is what handing them
out takes; its median, beside the known length of a batch, does not mind a busy machine.
"""

import os
import sys
import time
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

sys.path.insert(0, str(Path(__file__).parents[1] / "comparison"))

from fake_models import fake_hierarchy
from local_cluster import LocalCluster

from comparison.runner.cache import Cache
from comparison.runner.dask import cluster
from comparison.runner.processes import Pool, process_pool
from comparison.runner.runner import Runner
from comparison.runner.task_results import TaskResults
from comparison.study.study import Study
from comparison.surfaces.surfaces import batch_results, surface_tasks
from reference.problem import Amplification, Scene, load_scene

DURATION = 0.5  # s a batch takes; the study's take about one
BATCHES = 16
WORKERS = 2


def timed(scene: Scene, phases: NDArray[np.float64], tolerance: float) -> Amplification:
    """Takes DURATION and says when it began and ended, s of the machine's clock, and in which process."""
    begin = time.monotonic()
    time.sleep(DURATION)
    where = np.array([[float(os.getpid()), 0.0]])
    return Amplification(np.array([[begin, time.monotonic()]]), where, np.full(1, "ok"), np.full(1, np.nan), DURATION)


@dataclass(frozen=True)
class Measured:
    """s: what a worker waits between two batches in the median, and processor time of this process per batch."""

    waiting: float
    handing_out: float

    @property
    def overhead(self) -> float:
        """Share of the sweep. The two overlap: this is more than what is lost."""
        return (self.waiting + self.handing_out / WORKERS) / DURATION


def measured(folder: Path, executor: Pool) -> Measured:
    """A stored sweep of BATCHES batches."""
    model = replace(fake_hierarchy(batch=1)[0], amplification="test_sweep_overhead:timed")
    study = Study((load_scene("fig3-I"),), 4, 1e-3, [model])
    begin = time.process_time()
    results, tasks = TaskResults(Cache(folder)), surface_tasks(study)
    Runner(results, WORKERS, executor).run(tasks)
    spent = time.process_time() - begin
    answers = batch_results(tasks, results)
    assert len(list(folder.glob("*/*.batch"))) == len(answers) == BATCHES
    waits = []
    for process in {answer.error[0, 0] for answer in answers}:
        spans = sorted(tuple(answer.mu[0]) for answer in answers if answer.error[0, 0] == process)
        waits += [after[0] - before[1] for before, after in pairwise(spans)]
    assert len(waits) == BATCHES - WORKERS
    return Measured(float(np.median(waits)), spent / BATCHES)


@pytest.fixture(scope="module")
def pool(tmp_path_factory: pytest.TempPathFactory) -> Measured:
    return measured(tmp_path_factory.mktemp("pool") / "tiles", process_pool)


@pytest.mark.long
def test_store_and_executor_take_at_most_3_percent_of_the_sweep(pool: Measured) -> None:
    assert pool.overhead <= 0.03, pool


@pytest.mark.long
def test_two_workers_of_a_dask_cluster_are_within_10_percent_of_the_process_pool(
    pool: Measured, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parent))  # where the workers find the batches' model
    workers = LocalCluster(tmp_path, WORKERS)
    try:
        with cluster(workers.address, {"test_sweep_overhead:timed"}) as there:
            dask = measured(tmp_path / "tiles", there)
    finally:
        workers.end()
    assert DURATION + dask.waiting <= 1.1 * (DURATION + pool.waiting), (dask, pool)
