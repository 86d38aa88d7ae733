"""A task that takes longer than it may is ended, wherever it hangs, and costs neither another task nor another run."""

from __future__ import annotations

import time
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path

import pytest
from light_tasks import doubled, hangs_in_compiled_code, is_kept_waiting, raises, waits_for_ever
from runs import no_executor

from comparison.runner.cache import Cache
from comparison.runner.executors import TimeLimitError
from comparison.runner.processes import process_pool
from comparison.runner.runner import Runner
from comparison.runner.task import GIVEN_UP, Task, TaskResult
from comparison.runner.task_results import TaskResults
from comparison.study.study import Study
from comparison.study.user_models import user_model
from comparison.surfaces.tasks import surface_tasks
from reference.problem import Outcome, load_scene

pytest.importorskip("resource", reason="the system limits no processor time")


@pytest.fixture
def patient(monkeypatch: pytest.MonkeyPatch) -> None:
    """Only processor time counts, however long the machine keeps a worker waiting."""
    for name in ("STALLED", "SPARE"):
        monkeypatch.setattr(f"comparison.runner.processes.{name}", 1e9)


def _run(tasks: list[Task], folder: Path, make: object = process_pool, jobs: int = 2) -> list[TaskResult]:
    results = TaskResults(Cache(folder / "cache"))
    Runner(results, jobs, make).run(tasks)  # type: ignore[arg-type]
    return [results[task] for task in tasks]


def _calls(folder: Path) -> dict[str, int]:
    names = [mark.name.split("-")[0] for mark in folder.iterdir() if mark.is_file()]
    return {name: names.count(name) for name in names}


@pytest.mark.usefixtures("patient")
def test_a_hang_ends_at_its_limit_and_costs_no_other_task(tmp_path: Path) -> None:
    others = [Task(doubled, str(tmp_path / f"other{number}"), "test", 0.1, timeout=60.0) for number in range(6)]
    task = Task(hangs_in_compiled_code, str(tmp_path / "hanging"), "test", 1.0, timeout=1.0)
    first, *rest = _run([task, *others], tmp_path)
    assert (first.outcome, first.error_message) == (Outcome.TIME_LIMIT, "no answer within 1 s of processor time")
    assert first.reason == "time limit: no answer within 1 s of processor time"
    assert [result.value for result in rest] == [2] * 6
    assert _calls(tmp_path) == {"hanging": 1} | {f"other{number}": 1 for number in range(6)}, "nothing is tried again"


class Limited(ThreadPoolExecutor):
    """Every call takes as long as it may."""

    def start(self, call: object, seconds: float | None, group: str) -> Future[TaskResult]:
        ended: Future[TaskResult] = Future()
        ended.set_exception(TimeLimitError(f"no answer within {seconds:g} s"))
        return ended


def test_a_repeated_run_waits_for_a_hang_only_if_it_allows_more(tmp_path: Path) -> None:
    def task(timeout: float | None) -> Task:
        return Task(doubled, str(tmp_path / "hanging"), "test", 1.0, timeout=timeout)

    (first,) = _run([task(1.0)], tmp_path, Limited)
    (again,) = _run([task(1.0)], tmp_path, no_executor)
    (shorter,) = _run([task(0.5)], tmp_path, no_executor)
    assert first == again == shorter
    (longer,) = _run([task(2.0)], tmp_path, Limited)
    assert longer.error_message == "no answer within 2 s"
    assert TaskResults(Cache(tmp_path / "cache")).missing([task(None)]), "without a limit it may take any time"


@pytest.mark.long
@pytest.mark.usefixtures("patient")
def test_what_a_busy_machine_keeps_waiting_does_not_hang(tmp_path: Path) -> None:
    """2.5 s of waiting, next to no computing, under a limit of 1 s."""
    (result,) = _run([Task(is_kept_waiting, "", "test", 1.0, timeout=1.0)], tmp_path)
    assert result.value == 1


@pytest.mark.long
def test_what_computes_nothing_any_more_is_ended_in_the_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("comparison.runner.processes.STALLED", 4.0)
    (result,) = _run([Task(waits_for_ever, "", "test", 1.0, timeout=1.0)], tmp_path)
    assert result.reason == "time limit: no answer within 4 s"


@pytest.mark.long
@pytest.mark.usefixtures("patient")
def test_the_limit_of_a_task_does_not_reach_the_next_one(tmp_path: Path) -> None:
    short = Task(doubled, str(tmp_path / "short"), "test", 2.0, timeout=1.0)
    endless = Task(is_busy, 2.0, "test", 1.0)
    results = _run([short, endless], tmp_path, jobs=1)
    assert [result.value for result in results] == [2, 2.0]


def is_busy(seconds: float) -> float:
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass
    return seconds


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
        Task(raises, "", "test", 1.5),
        Task(doubled, str(tmp_path / "other"), "test", 1.0),
    ]
    error, value, usual, other = _run(tasks, tmp_path, jobs=1)
    assert "NotFromText: broken at 3" in error.error_message
    assert "lambda" in value.error_message
    assert usual.error_message == "RuntimeError: singular"
    assert other.value == 2


def test_a_batch_that_was_given_up_is_not_stored(tmp_path: Path) -> None:
    """Two calls of an engine that hangs, and the one at work by then, are stored; the last is asked again next time."""
    model = user_model("mine", {"function": "user_engines:plain"})
    tasks = surface_tasks(Study((load_scene("fig3-I"),), 2, 1e-3, [model]))
    results = _run(tasks, tmp_path, Limited, jobs=1)
    assert [result.outcome for result in results] == [Outcome.TIME_LIMIT] * 4
    assert [result.error_message for result in results] == [*["no answer within 60 s"] * 3, GIVEN_UP]
    assert TaskResults(Cache(tmp_path / "cache")).missing(tasks) == tasks[3:]
