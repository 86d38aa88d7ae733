"""A Dask cluster gives the numbers of this machine, loses none when a worker dies, and can be done without."""

from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from distributed import KilledWorker
from fake_models import fake_hierarchy
from light_tasks import doubled, hangs_in_compiled_code
from local_cluster import LocalCluster
from runs import Run

from comparison.runner import dask
from comparison.runner.cache import Cache, Key
from comparison.runner.dask import cluster
from comparison.runner.processes import Pool, WorkerDiedError
from comparison.runner.progress import Display
from comparison.runner.runner import Runner
from comparison.runner.task import BATCH, Task
from comparison.runner.task_results import TaskResults
from comparison.study.batches import BatchResult
from comparison.study.study import Study
from comparison.surfaces.surfaces import batch_results, surface_tasks
from reference.problem import Outcome, load_scene


def _results(
    model: str, batch: int, executor: Pool, done: Callable[[int], object] = lambda count: None
) -> list[BatchResult]:
    """The engine's surface; `done` is told how many batches are."""
    study = Study((load_scene("fig3-I"),), 4, 1e-3, fake_hierarchy(model, batch=batch))
    tasks = [task for task in surface_tasks(study) if task.argument.model == "translational"]
    results, count = TaskResults(), iter(range(1, len(tasks) + 1))
    Runner(results, 2, executor, Display(1.0, 2, lambda display: done(next(count)))).run(tasks)
    return batch_results(tasks, results)


def _same(results: list[BatchResult], expected: list[BatchResult]) -> None:
    assert len(results) == len(expected) > 0
    for a, b in zip(results, expected):
        for name in ("mu", "error", "instant", "status"):
            np.testing.assert_array_equal(getattr(a, name), getattr(b, name))  # to the last bit


@pytest.fixture
def workers(tmp_path: Path) -> Iterator[LocalCluster]:
    started = LocalCluster(tmp_path)
    yield started
    started.end()


def test_numbers_of_a_cluster_are_those_of_this_machine(workers: LocalCluster) -> None:
    here = _results("uneven", 1, ThreadPoolExecutor)
    with cluster(workers.address, {"fake_models:uneven"}) as there:
        assert there.width == 2
        _same(here, _results("uneven", 1, there))
        _same(here, _results("uneven", 1, there, lambda count: workers.kill_a_worker() if count == 4 else None))
        assert [answer.status for answer in here] == [["ok"]] * 16, "nothing is lost"


@pytest.mark.long
def test_a_scheduler_that_goes_is_one_line_and_the_run_goes_on(
    workers: LocalCluster, command: Callable[..., Run], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    put = Cache.put
    stored: list[Key] = []

    def put_and_kill(cache: Cache, key: Key, answer: object) -> None:
        put(cache, key, answer)
        stored.append(key)
        if len(stored) == 5:
            workers.kill_the_scheduler()

    monkeypatch.setattr(Cache, "put", put_and_kill)
    hierarchy = fake_hierarchy("uneven", batch=1)
    study = Study((load_scene("fig3-I"),), 4, 1e-3, hierarchy)
    run = command("fig3-I", "--grid", "4", "--scheduler", workers.address, hierarchy=hierarchy)
    assert run.code == 4
    start = f"--scheduler {workers.address}: the connection to the scheduler was lost: "
    assert run.err.startswith(start)
    assert run.err.count("\n") == 1
    of_surfaces = sum(key.kind == BATCH for key in stored)
    assert f"{of_surfaces} of " in run.err
    assert of_surfaces == len(stored) or f" and {len(stored) - of_surfaces} analys" in run.err
    assert f"go on with: python -m comparison.run fig3-I --grid 4 --out {run.report}\n" in run.err, (
        "without the cluster"
    )
    assert not run.report.exists()
    before = len(stored)
    again = command("fig3-I", "--grid", "4", "--jobs", "2", hierarchy=hierarchy)
    assert again.code == 0
    names = [key.name for key in stored]
    assert 5 <= before < len(stored)
    assert not set(names[:before]) & set(names[before:]), "only what was missing was computed"
    batches = {key.name for key in stored if key.kind == BATCH}
    assert batches == {task.key.name for task in surface_tasks(study)}


@pytest.mark.long
def test_a_hang_costs_no_worker_of_the_cluster(tmp_path: Path) -> None:
    started = LocalCluster(tmp_path, workers=1, nanny=True)
    tasks = [
        Task(hangs_in_compiled_code, str(tmp_path / "hanging"), "test", 2.0, timeout=4.0),
        Task(doubled, str(tmp_path / "other"), "test", 1.0, timeout=60.0),
        Task(doubled, str(tmp_path / "without a limit"), "test", 0.5),
    ]
    results = TaskResults()
    try:
        with cluster(started.address, {"fake_models:uneven"}) as there:
            Runner(results, 1, there).run(tasks)
    finally:
        started.end()
    assert results[tasks[0]].outcome == Outcome.TIME_LIMIT
    assert [results[task].value for task in tasks[1:]] == [2, 2]
    assert len(list(tmp_path.glob("hanging-*"))) == 1, "not tried again on another worker"


@pytest.mark.parametrize("address", ["nowhere", "tls://127.0.0.1:1", "ucx://127.0.0.1:1"])
def test_no_scheduler_is_a_wrong_option(command: Callable[..., Run], address: str) -> None:
    run = command("fig3-I", "--scheduler", address, hierarchy=fake_hierarchy("forbidden"))
    assert run.code == 2
    assert run.err.startswith(f"command line: --scheduler = {address!r}: no scheduler answers there: ")
    assert run.err.count("\n") == 1
    both = command("fig3-I", "--scheduler", "nowhere", "--jobs", "3")
    assert both.code == 2
    assert both.err.startswith("command line: --jobs = '3': counts processes of this machine")


def test_workers_with_other_code_are_refused(
    workers: LocalCluster, command: Callable[..., Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("comparison.runner.environment._version", lambda name: "9.9")
    run = command("fig3-I", "--scheduler", workers.address, hierarchy=fake_hierarchy("forbidden"))
    assert run.code == 2
    assert "here it is 9.9: install the same" in run.err
    assert run.err.count("\n") == 1


def test_a_task_that_killed_every_worker_it_was_on_has_died_as_often() -> None:
    remote: Future[Any] = Future()
    remote.set_exception(KilledWorker("task", SimpleNamespace(address="tcp://there"), 3))
    answer: Future[Any] = Future()
    dask._arrived(remote, answer)
    error = answer.exception()
    assert isinstance(error, WorkerDiedError)
    assert error.times == 4
