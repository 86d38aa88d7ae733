"""Every task has its result: one that kills or hangs its worker costs its own points, in any order of the others."""

import itertools
import os
import signal
import threading
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from threading import Barrier
from types import SimpleNamespace

import numpy as np
import pytest
from fake_models import deadly, fake_hierarchy
from light_tasks import counted, doubled, hangs_in_compiled_code
from runs import no_executor

from comparison.runner import processes
from comparison.runner.cache import Cache
from comparison.runner.processes import (
    ExecutorLostError,
    Pool,
    TimeLimitError,
    WorkerDiedError,
    limit_child_threads,
    make_process_pool,
    open_executor,
)
from comparison.runner.runner import Runner
from comparison.runner.task import GIVEN_UP_MESSAGE, Task, TaskResult
from comparison.runner.task_results import TaskResults
from comparison.study.batches import BatchResult, execute_batch
from comparison.study.study import Study
from comparison.study.user_models import make_user_model
from comparison.surfaces.surfaces import collect_batch_results, make_surface_tasks
from reference.problem import Outcome, load_scene

pytestmark = pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="SIGKILL")


def _tasks(folder: Path, *names: str) -> list[Task]:
    return [Task(counted, str(folder / name), "test", needs_compiled_reference=False) for name in names]


def _run(
    tasks: list[Task], make: Pool = make_process_pool, jobs: int = 2, folder: Path | None = None
) -> list[TaskResult]:
    results = TaskResults(folder and Cache(folder / "cache"))
    Runner(results, jobs, make).run(tasks)
    return [results[task] for task in tasks]


def _calls(folder: Path) -> dict[str, int]:
    names = [mark.name.split("-")[0] for mark in folder.iterdir() if mark.is_file()]
    return {name: names.count(name) for name in names}


def test_a_death_costs_its_own_task_one_retry_and_no_other(tmp_path: Path) -> None:
    names = "one", "kills", "two", "kills always", "three", "four"
    results = _run(_tasks(tmp_path, *names))
    assert [result.value for result in results] == ["one", "kills", "two", None, "three", "four"]
    assert results[3].reason == "worker died: the worker process died 2 times (exit code -9)"
    assert _calls(tmp_path) == {"one": 1, "kills": 2, "two": 1, "kills always": 2, "three": 1, "four": 1}


def test_libraries_of_a_worker_use_one_thread_unless_the_user_says_otherwise(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("MKL_NUM_THREADS", "3")
    limit_child_threads()
    assert [os.environ[f"{name}_NUM_THREADS"] for name in ("OMP", "OPENBLAS", "MKL")] == ["1", "1", "3"]


class Deadly(ThreadPoolExecutor):
    """A phase pair at which every worker dies."""

    def start(self, call: partial[TaskResult], seconds: float | None, group: str) -> Future[TaskResult]:
        if not deadly(call.args[0].argument.phases).any():
            return self.submit(call)
        died: Future[TaskResult] = Future()
        died.set_exception(WorkerDiedError("exit code 7", exit_code=7))
        return died


def test_a_death_that_a_cluster_has_repeated_is_not_repeated_here(tmp_path: Path) -> None:
    class Cluster(ThreadPoolExecutor):
        def start(self, call: object, seconds: float | None, group: str) -> Future[TaskResult]:
            died: Future[TaskResult] = Future()
            died.set_exception(WorkerDiedError("killed", 4))
            return died

    (result,) = _run(_tasks(tmp_path, "one"), Cluster)
    assert result.reason == "worker died: the worker process died 4 times"


@pytest.mark.parametrize("batch", [2, 16])
def test_splitting_finds_the_one_point_that_kills(tmp_path: Path, batch: int) -> None:
    hierarchy = [model for model in fake_hierarchy(batch=batch, gap=0.0) if model.key == "translational"]
    tasks, results = (
        make_surface_tasks(Study((load_scene("fig3-I"),), 4, 1e-3, hierarchy)),
        TaskResults(Cache(tmp_path)),
    )
    Runner(results, 2, Deadly).run(tasks)
    found = collect_batch_results(tasks, results)
    assert [outcome for result in found for outcome in result.status] == ["ok"] * 15 + ["worker died"]
    expected = np.concatenate([execute_batch(task.argument).mu for task in tasks])
    np.testing.assert_array_equal(np.concatenate([result.mu for result in found])[:15], expected[:15])
    assert found[-1].error_message == "the worker process died 2 times (exit code 7)"
    assert TaskResults(Cache(tmp_path)).find_missing(tasks) == tasks[-1:], (
        "only the batch that lost a point is tried again"
    )


def test_halves_of_a_batch_are_its_points_in_order() -> None:
    batch = Study((load_scene("fig3-I"),), 3, 1e-3, fake_hierarchy(batch=7)).batches()[1]
    early, late = batch.halves()
    np.testing.assert_array_equal(np.concatenate([early.phases, late.phases]), batch.phases)
    assert (early.first, late.first) == (batch.first, batch.first + len(early.phases))
    assert early.halves() == []
    mu, (one, two) = batch.phases, (batch.phases[:1], batch.phases[1:])
    parts = [
        BatchResult(part, 0.1 * part, ["ok"] * len(part), 2.0 * part[:, 0], cost, "singular", 3.0 * part[:, 1])
        for part, cost in ((one, 0.25), (two, 0.5))
    ]
    whole = batch.join(parts)
    for found, expected in (
        (whole.mu, mu), (whole.error, 0.1 * mu), (whole.instant, 2.0 * mu[:, 0]), (whole.displacement, 3.0 * mu[:, 1]),
    ):  # fmt: skip
        np.testing.assert_array_equal(found, expected)
    assert (whole.status, whole.cost, whole.error_message) == (["ok", "ok"], 0.75, "singular")
    joined = Task(execute_batch, batch, "test").join([TaskResult(part, cost) for part, cost in zip(parts, (0.5, 2.0))])
    assert (joined.cost, joined.outcome) == (2.5, Outcome.OK)
    lost = batch.without_result(Outcome.RIM_REACHED, "no")
    numbers = [lost.mu, lost.error, lost.instant[:, None], lost.displacement[:, None]]
    assert np.isnan(np.hstack(numbers)).all()
    assert (np.hstack(numbers).shape, lost.status, lost.cost) == ((2, 6), ["rim reached"] * 2, 0.0)


def test_a_lent_executor_states_its_width_and_stays_open() -> None:
    class Three(ThreadPoolExecutor):
        width = 3

    together = Barrier(3)
    with Three(3) as lent:
        results = _run([Task(together.wait, limit, "test") for limit in (60.0, 61.0, 62.0)], lent, jobs=1)
        assert sorted(result.value for result in results) == [0, 1, 2], "each waited for the other two"
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
    assert results.find_missing(tasks) == tasks[0 if broken_before else 1 :], "what had arrived was kept"


def test_an_executor_ends_with_the_block_that_it_was_made_for() -> None:
    ended: list[tuple[bool, bool]] = []

    class Told(ThreadPoolExecutor):
        def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
            ended.append((wait, cancel_futures))
            super().shutdown(wait, cancel_futures=cancel_futures)

    with open_executor(Told, 1) as made:
        assert made.submit(len, "abc").result() == 3
    with pytest.raises(ZeroDivisionError), open_executor(Told, 1):
        raise ZeroDivisionError
    assert ended == [(True, False), (False, True)], "without waiting after an exception"


def test_a_run_that_is_stopped_abandons_its_workers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    abandoned = []

    class Told(ThreadPoolExecutor):
        def abandon(self) -> None:
            abandoned.append(True)

    def stopped(*task_and_result: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(TaskResults, "put", stopped)
    with Told(1) as workers, pytest.raises(KeyboardInterrupt):
        Runner(TaskResults(), 1, workers).run(_tasks(tmp_path, "one"))
    assert abandoned == [True]


pytest.importorskip("resource", reason="the system limits no processor time")


def test_a_hang_ends_at_its_limit_and_costs_no_other_task(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # only processor time counts, however long the machine keeps a worker waiting
    for name in ("STALLED_WALL_RATIO", "SPARE_WALL_SECONDS"):
        monkeypatch.setattr(f"comparison.runner.processes.{name}", 1e9)
    others = [Task(doubled, str(tmp_path / f"other{number}"), "test", 0.1, timeout=60.0) for number in range(6)]
    task = Task(hangs_in_compiled_code, str(tmp_path / "hanging"), "test", 1.0, timeout=1.0)
    first, *rest = _run([task, *others])
    assert first.reason == "time limit: no answer within 1 s of processor time"
    assert [result.value for result in rest] == [2] * 6
    assert _calls(tmp_path) == {"hanging": 1} | {f"other{number}": 1 for number in range(6)}, "nothing is tried again"


class Limited(ThreadPoolExecutor):
    """Every call takes as long as it may, or ends its process."""

    error: type[Exception] = TimeLimitError

    def start(self, call: object, seconds: float | None, group: str) -> Future[TaskResult]:
        ended: Future[TaskResult] = Future()
        ended.set_exception(self.error(f"no answer within {seconds:g} s"))
        return ended


def test_a_repeated_run_waits_for_a_hang_only_if_it_allows_more(tmp_path: Path) -> None:
    def task(timeout: float | None) -> Task:
        return Task(doubled, str(tmp_path / "hanging"), "test", 1.0, timeout=timeout)

    (first,) = _run([task(1.0)], Limited, folder=tmp_path)
    (again,) = _run([task(1.0)], no_executor, folder=tmp_path)
    (shorter,) = _run([task(0.5)], no_executor, folder=tmp_path)
    assert first == again == shorter
    (longer,) = _run([task(2.0)], Limited, folder=tmp_path)
    assert longer.error_message == "no answer within 2 s"
    assert TaskResults(Cache(tmp_path / "cache")).find_missing([task(None)]), "without a limit it may take any time"


def test_a_silent_process_is_waited_for_by_its_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    waits: list[float] = []
    pipe = SimpleNamespace(send=lambda call: None, poll=lambda seconds: waits.append(seconds))
    for limit in (1.0, 60.0, 1e6):
        with pytest.raises(TimeLimitError, match=r"^no answer within "):
            processes._Process.run(SimpleNamespace(_pipe=pipe), str, limit)  # type: ignore[arg-type]
    assert waits == [20.0, 5.0 * 60.0 + 60.0, 1e6]
    limits: list[tuple[int, tuple[float, int]]] = []
    never = processes.resource.RLIM_INFINITY
    system = SimpleNamespace(RLIMIT_CORE=4, RLIMIT_CPU=0, RLIM_INFINITY=never, getrlimit=lambda kind: (7, never))
    monkeypatch.setattr(processes, "resource", system)
    monkeypatch.setattr(system, "setrlimit", lambda kind, pair: limits.append((kind, pair)), raising=False)
    monkeypatch.setattr(processes.time, "process_time", lambda: 100.2)
    for seconds in (1.5, None):
        processes._limit_processor_time(seconds)
    assert limits == [(4, (0, never)), (0, (102, never)), (4, (0, never)), (0, (never, never))], "no dump, 1.5 s, none"
    for most, end in ((101, 101), (200, 102)):
        monkeypatch.setattr(system, "getrlimit", lambda kind, most=most: (7, most))
        processes._limit_processor_time(1.5)
        assert limits[-1] == (0, (end, most)), "no more than the system allows"


def test_a_process_runs_the_tasks_of_one_group(monkeypatch: pytest.MonkeyPatch) -> None:
    made = itertools.count()

    class Numbered:
        def __init__(self) -> None:
            self.number = next(made)

        def run(self, call: object, seconds: float | None) -> tuple[int, None]:
            return self.number, None

        def end(self) -> None: ...

    monkeypatch.setattr(processes, "_Process", Numbered)
    with make_process_pool(1) as pool:
        assert [pool.start(str, group=group).result() for group in ("", "a", "", "b", "a")] == [0, 1, 0, 2, 1]


def test_every_process_ends_with_its_pool_or_is_killed_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    ends: list[str] = []

    class Told:
        def run(self, call: object, seconds: float | None) -> tuple[int, None]:
            return 0, None

        def kill(self) -> None:
            ends.append("killed")

        def end(self) -> None:
            ends.append("ended")

    monkeypatch.setattr(processes, "_Process", Told)
    for abandoned, expected in ((False, ["ended"] * 2), (True, ["killed"] * 2)):
        ends.clear()
        workers = processes.Workers(1)
        for group in ("a", "b"):
            workers.start(str, group=group).result()
        if abandoned:
            workers.abandon()
            with pytest.raises(RuntimeError):
                workers.start(str, group="a")
            assert ends == expected
            workers.shutdown(wait=False)
        else:
            workers.shutdown()
        assert ends == expected


def test_a_process_that_exceeded_its_time_is_ended_and_not_used_again(monkeypatch: pytest.MonkeyPatch) -> None:
    made, ended = itertools.count(), []

    class Numbered:
        def __init__(self) -> None:
            self.number = next(made)

        def run(self, call: object, seconds: float | None) -> tuple[int, None]:
            if seconds is not None and self.number < 2:
                raise [TimeLimitError, WorkerDiedError][self.number]("lost")
            return self.number, None

        def end(self) -> None:
            ended.append(self.number)

    monkeypatch.setattr(processes, "_Process", Numbered)
    with make_process_pool(1) as pool:
        for error in (TimeLimitError, WorkerDiedError):
            with pytest.raises(error):
                pool.start(str, 1.0).result()
        assert (pool.start(str, 1.0).result(), ended) == (2, [0, 1])


def test_a_worker_ends_in_the_middle_of_a_call_when_its_parent_has_ended(monkeypatch: pytest.MonkeyPatch) -> None:
    order: list[object] = []
    parent = SimpleNamespace(join=partial(order.append, "parent"))
    monkeypatch.setattr(processes.multiprocessing, "parent_process", lambda: parent)
    monkeypatch.setattr(processes.os, "_exit", order.append)
    processes._end_with_parent()
    assert order == ["parent", 1]


class NotFromText(Exception):  # noqa: N818
    """An error that cannot be made again from its text."""

    def __init__(self, what: str, where: int) -> None:
        super().__init__(f"{what} at {where}")


def raises_what_cannot_be_sent(place: str) -> int:
    raise NotFromText("broken", 3)


def returns_what_cannot_be_sent(place: str) -> object:
    return lambda: None


def test_what_cannot_be_sent_from_a_worker_is_named(tmp_path: Path) -> None:
    tasks = [
        Task(raises_what_cannot_be_sent, "", "test", 3.0),
        Task(returns_what_cannot_be_sent, "", "test", 2.0),
        Task(doubled, str(tmp_path / "other"), "test", 1.0),
    ]
    error, value, other = _run(tasks, jobs=1)
    assert "NotFromText: broken at 3" in error.error_message
    assert "lambda" in value.error_message
    assert other.value == 2


def test_a_batch_that_was_given_up_is_not_stored(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Two calls of an engine that hangs, and the one at work by then, are stored; the last is asked again next time."""
    model = make_user_model("mine", {"function": "user_engines:plain"})
    tasks = make_surface_tasks(Study((load_scene("fig3-I"),), 2, 1e-3, [model]))
    assert {task.group for task in tasks} == {"mine"}, "no process is shared with another engine"
    results = _run(tasks, Limited, jobs=1, folder=tmp_path)
    assert [result.outcome for result in results] == [*[Outcome.TIME_LIMIT] * 3, Outcome.NOT_ASKED]
    assert [result.error_message for result in results] == [*["no answer within 60 s"] * 3, GIVEN_UP_MESSAGE]
    assert TaskResults(Cache(tmp_path / "cache")).find_missing(tasks) == tasks[3:]
    monkeypatch.setattr(Limited, "error", WorkerDiedError)
    assert _run(tasks, Limited, jobs=1)[-1].error_message == GIVEN_UP_MESSAGE, "also one that ends its process"


COMPILED = threading.Event()
BEGAN: list[str] = []


def solved(task: str) -> str:
    BEGAN.append(task)
    if task == "compile":
        assert COMPILED.wait(timeout=300.0), "the engine's tasks ran meanwhile"
    if task == "engine 2":
        COMPILED.set()
    return task


def test_what_needs_the_reference_waits_for_it_while_others_pass() -> None:
    def task(name: str) -> Task:
        return Task(solved, name, "test", needs_compiled_reference=name.startswith("reference"))

    tasks, results = [task(name) for name in ("reference 1", "reference 2", "engine 1", "engine 2")], TaskResults()
    Runner(results, 2, ThreadPoolExecutor).run(tasks, lambda: task("compile"))
    assert BEGAN[:3] == ["compile", "engine 1", "engine 2"]
    assert sorted(BEGAN[3:]) == ["reference 1", "reference 2"]
    assert [results[task].value for task in tasks] == [task.argument for task in tasks]
