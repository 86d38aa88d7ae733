"""A worker that dies costs its task one retry, then the points that kill it and no other, on any executor."""

from __future__ import annotations

import gc
import signal
from collections.abc import Callable
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from threading import Barrier

import numpy as np
import pytest
from fake_models import fake_hierarchy
from light_tasks import counted

from comparison.runner.executors import ExecutorLostError
from comparison.runner.processes import process_pool
from comparison.runner.splitting import merge, split_batch
from comparison.runner.sweep import sweep
from comparison.study.batches import Batch, BatchResult, execute_batch, unanswered
from comparison.study.study import Study
from reference.problem import Outcome, load_scene

pytestmark = pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="SIGKILL")


def common_pool(jobs: int) -> Executor:
    """As a user may bring it: a death ends every task in flight."""
    return ProcessPoolExecutor(jobs, get_context("spawn"))


def _lost(task: Path, outcome: Outcome, error_message: str) -> str:
    return f"{outcome}: {error_message}"


def _done(task: object, result: object) -> None:
    pass


def _calls(folder: Path) -> dict[str, int]:
    names = [mark.name.rsplit("-", 1)[0] for mark in folder.iterdir()]
    return {name: names.count(name) for name in names}


def test_a_death_costs_its_own_task_one_retry_and_no_other(tmp_path: Path) -> None:
    tasks = [tmp_path / name for name in ("one", "kills", "two", "kills always", "three", "four")]
    results = sweep(tasks, counted, _lost, _done, 2, process_pool)
    died = "worker died: the worker process died 2 times (exit code -9)"
    assert results == ["one", "kills", "two", died, "three", "four"]
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
def test_in_a_common_pool_of_processes_the_culprit_is_found_too(tmp_path: Path) -> None:
    tasks = [tmp_path / name for name in ("one", "kills always", "two")]
    results = sweep(tasks, counted, _lost, _done, 2, common_pool)
    assert [results[0], results[2]] == ["one", "two"]
    assert str(results[1]).startswith("worker died: ")
    assert _calls(tmp_path)["kills always"] <= 3, "once among others, then alone"


@pytest.mark.long
@pytest.mark.parametrize("batch", [2, 16])
def test_splitting_finds_the_one_point_that_kills(batch: int) -> None:
    hierarchy = [model for model in fake_hierarchy("killing", batch=batch) if model.key == "translational"]
    batches = Study((load_scene("fig3-I"),), 4, 1e-3, hierarchy).batches()
    seen: list[Batch] = []

    def done(piece: Batch, answer: BatchResult) -> None:
        seen.append(piece)

    answers = sweep(batches, execute_batch, unanswered, done, 2, process_pool, split=split_batch, join=merge)
    assert [outcome for answer in answers for outcome in answer.status] == ["ok"] * 15 + ["worker died"]
    mu = np.concatenate([answer.mu for answer in answers])
    whole = Study((load_scene("fig3-I"),), 4, 1e-3, fake_hierarchy(gap=0.0)).batches()
    expected = np.concatenate([execute_batch(batch).mu for batch in whole])
    np.testing.assert_array_equal(mu[:15], expected[:15])
    assert len(seen) == len(batches), "told of whole batches, once each"
    assert [answer.error_message for answer in answers][-1] == "the worker process died 2 times (exit code -9)"


def test_halves_of_a_tile_are_its_points_in_order() -> None:
    batch = Study((load_scene("fig3-I"),), 3, 1e-3, fake_hierarchy(batch=7)).batches()[1]
    early, late = split_batch(batch)
    np.testing.assert_array_equal(np.concatenate([early.phases, late.phases]), batch.phases)
    assert (early.first, late.first) == (batch.first, batch.first + len(early.phases))
    assert split_batch(split_batch(batch)[0]) == []
    whole, parts = execute_batch(batch), [execute_batch(part) for part in (early, late)]
    together = merge(batch, parts)
    np.testing.assert_array_equal(together.mu, whole.mu)
    assert (together.status, together.error_message) == (whole.status, "")
    assert together.cost == pytest.approx(whole.cost, rel=1e-12)  # a sum in another order


def test_any_executor_will_do_and_one_that_is_lent_stays_open() -> None:
    with ThreadPoolExecutor(2) as lent:
        assert sweep(["a", "b"], str.upper, lambda *rest: "lost", _done, 2, lent) == ["A", "B"]
        assert lent.submit(str.upper, "c").result() == "C"


def test_a_lent_executor_says_how_many_tasks_it_takes() -> None:
    class Three(ThreadPoolExecutor):
        width = 3

    together = Barrier(3)
    with Three(3) as lent:
        places = sweep([60.0] * 3, together.wait, lambda *rest: -1, _done, 1, lent)
    assert sorted(places) == [0, 1, 2], "each waited for the other two"


@pytest.mark.parametrize("broken_before", [True, False])
def test_a_lent_executor_that_breaks_ends_the_sweep_in_one_line(tmp_path: Path, broken_before: bool) -> None:
    arrived: list[str] = []
    tasks = [tmp_path / name for name in ("one", "kills always", "two")]
    done: Callable[[Path, str], None] = lambda task, result: arrived.append(result)  # noqa: E731
    with common_pool(1) as lent:
        if broken_before:
            assert lent.submit(counted, tmp_path / "kills always").exception() is not None
        with pytest.raises(ExecutorLostError, match=r"^the executor is broken: ") as error_message:
            sweep(tasks, counted, _lost, done, 1, lent)
    assert "\n" not in str(error_message.value)
    assert arrived == ([] if broken_before else ["one"]), "what had arrived was told"
