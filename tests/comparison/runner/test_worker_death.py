"""A worker that dies costs its task one retry, then the points that kill it and no other."""

from __future__ import annotations

import gc
import signal
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from threading import Barrier

import numpy as np
import pytest
from fake_models import fake_hierarchy
from light_tasks import counted

from comparison.runner.cache import Cache
from comparison.runner.executors import ExecutorLostError, Pool, executing
from comparison.runner.processes import process_pool
from comparison.runner.runner import Runner
from comparison.runner.sweep import Sweep
from comparison.runner.task import Task, TaskResult
from comparison.runner.task_results import TaskResults
from comparison.study.batches import execute_batch
from comparison.study.study import Study
from comparison.surfaces.tasks import batch_results, surface_tasks
from reference.problem import load_scene

pytestmark = pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="SIGKILL")


def _tasks(folder: Path, *names: str) -> list[Task]:
    return [Task(counted, str(folder / name), "test", needs_compiled_reference=False) for name in names]


def _run(tasks: list[Task], executor: Pool, jobs: int = 2) -> list[TaskResult]:
    results = TaskResults()
    Runner(results, jobs, executor).run(tasks)
    return [results[task] for task in tasks]


def _calls(folder: Path) -> dict[str, int]:
    names = [mark.name.rsplit("-", 1)[0] for mark in folder.iterdir()]
    return {name: names.count(name) for name in names}


def test_a_death_costs_its_own_task_one_retry_and_no_other(tmp_path: Path) -> None:
    names = "one", "kills", "two", "kills always", "three", "four"
    results = _run(_tasks(tmp_path, *names), process_pool)
    assert [result.value for result in results] == ["one", "kills", "two", None, "three", "four"]
    assert results[3].reason == "worker died: the worker process died 2 times (exit code -9)"
    assert _calls(tmp_path) == {"one": 1, "kills": 2, "two": 1, "kills always": 2, "three": 1, "four": 1}


def test_a_worker_collects_garbage_as_seldom_as_its_parent() -> None:
    before = gc.get_threshold()
    gc.set_threshold(1234, 20, 30)
    try:
        with process_pool(1) as pool:
            assert pool.submit(gc.get_threshold).result() == (1234, 20, 30)
    finally:
        gc.set_threshold(*before)


@pytest.mark.long
@pytest.mark.parametrize("batch", [2, 16])
def test_splitting_finds_the_one_point_that_kills(tmp_path: Path, batch: int) -> None:
    hierarchy = [model for model in fake_hierarchy("killing", batch=batch) if model.key == "translational"]
    tasks, results = surface_tasks(Study((load_scene("fig3-I"),), 4, 1e-3, hierarchy)), TaskResults(Cache(tmp_path))
    Runner(results, 2, process_pool).run(tasks)
    found = batch_results(tasks, results)
    assert [outcome for result in found for outcome in result.status] == ["ok"] * 15 + ["worker died"]
    whole = Study((load_scene("fig3-I"),), 4, 1e-3, fake_hierarchy(gap=0.0)).batches()
    expected = np.concatenate([execute_batch(batch).mu for batch in whole])
    np.testing.assert_array_equal(np.concatenate([result.mu for result in found])[:15], expected[:15])
    assert found[-1].error_message == "the worker process died 2 times (exit code -9)"
    assert TaskResults(Cache(tmp_path)).missing(tasks) == tasks[-1:], "only the batch that lost a point is tried again"


def test_halves_of_a_batch_are_its_points_in_order() -> None:
    batch = Study((load_scene("fig3-I"),), 3, 1e-3, fake_hierarchy(batch=7)).batches()[1]
    early, late = batch.halves()
    np.testing.assert_array_equal(np.concatenate([early.phases, late.phases]), batch.phases)
    assert (early.first, late.first) == (batch.first, batch.first + len(early.phases))
    assert early.halves() == []
    whole, halves = execute_batch(batch), [execute_batch(half) for half in (early, late)]
    together = batch.join(halves)
    np.testing.assert_array_equal(together.mu, whole.mu)
    assert (together.status, together.error_message) == (whole.status, "")
    assert together.cost == pytest.approx(whole.cost, rel=1e-12)  # a sum in another order


def test_a_lent_executor_states_its_width_and_stays_open(tmp_path: Path) -> None:
    class Three(ThreadPoolExecutor):
        width = 3

    together, places = Barrier(3), []
    with Three(3) as lent:
        tasks = [Task(together.wait, 60.0, "test")] * 3
        Sweep(tasks, lent, 1, lambda task, result: places.append(result.value)).run()
        assert sorted(places) == [0, 1, 2], "each waited for the other two"
        assert [result.value for result in _run(_tasks(tmp_path, "one"), lent)] == ["one"]
        assert lent.submit(str.upper, "c").result() == "C"


@pytest.mark.parametrize("broken_before", [True, False])
def test_a_lent_executor_that_breaks_ends_the_run_in_one_line(tmp_path: Path, broken_before: bool) -> None:
    tasks, results = _tasks(tmp_path, "one", "kills always", "two"), TaskResults()
    with ProcessPoolExecutor(1, get_context("spawn")) as lent:
        if broken_before:
            assert lent.submit(counted, str(tmp_path / "kills always")).exception() is not None
        with pytest.raises(ExecutorLostError, match=r"^the executor is broken: ") as error_message:
            Runner(results, 1, lent).run(tasks)
    assert "\n" not in str(error_message.value)
    assert results.missing(tasks) == tasks[0 if broken_before else 1 :], "what had arrived was kept"


def test_an_executor_ends_with_the_block_that_it_was_made_for() -> None:
    ended: list[tuple[bool, bool]] = []

    class Told(ThreadPoolExecutor):
        def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
            ended.append((wait, cancel_futures))
            super().shutdown(wait, cancel_futures=cancel_futures)

    with executing(Told, 1) as made:
        assert made.submit(len, "abc").result() == 3
    with pytest.raises(ZeroDivisionError), executing(Told, 1):
        raise ZeroDivisionError
    assert ended == [(True, False), (False, True)], "without waiting after an exception"


def test_a_run_that_is_stopped_abandons_its_workers() -> None:
    abandoned = []

    class Told(ThreadPoolExecutor):
        def abandon(self) -> None:
            abandoned.append(True)

    def stopped(task: Task, result: TaskResult) -> None:
        raise KeyboardInterrupt

    with Told(1) as workers, pytest.raises(KeyboardInterrupt):
        Sweep([Task(len, "abc", "test")], workers, 1, stopped).run()
    assert abandoned == [True]
