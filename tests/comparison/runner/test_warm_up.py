"""The reference is compiled by one worker; the engine's points go on meanwhile, the reference's wait for it."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor

from comparison.runner.runner import Runner
from comparison.runner.sweep import Sweep
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults

COMPILED = threading.Event()
BEGAN: list[str] = []


def solved(task: str) -> str:
    BEGAN.append(task)
    if task == "compile":
        assert COMPILED.wait(timeout=300.0), "the engine's tasks ran meanwhile"
    if task == "engine 2":
        COMPILED.set()
    return task


def _task(name: str, waits: bool = False) -> Task:
    return Task(solved, name, "test", needs_compiled_reference=waits)


def test_what_needs_the_reference_waits_for_it_while_others_pass() -> None:
    tasks = [_task("reference 1", True), _task("reference 2", True), _task("engine 1"), _task("engine 2")]
    results = TaskResults()
    Runner(results, 2, ThreadPoolExecutor).run(tasks, lambda: _task("compile"))
    assert BEGAN[:3] == ["compile", "engine 1", "engine 2"]
    assert sorted(BEGAN[3:]) == ["reference 1", "reference 2"]
    assert [results[task].value for task in tasks] == [task.argument for task in tasks]


def test_what_is_never_ready_runs_when_nothing_else_is_left() -> None:
    done: list[str] = []
    with ThreadPoolExecutor(2) as threads:
        tasks = [Task(str.upper, name, "test") for name in "ab"]
        Sweep(tasks, threads, 2, lambda task, result: done.append(result.value), lambda task: task is tasks[0]).run()
    assert done == ["A", "B"]
