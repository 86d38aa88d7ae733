"""The reference is compiled by one worker; the engine's points go on meanwhile, the reference's wait for it."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor

from fake_models import fake_hierarchy
from rich.console import Console

from comparison.runner.runner import Runner
from comparison.runner.sweep import Sweep
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.study import Study
from comparison.surfaces.tasks import surface_tasks, warm_up
from reference.problem import load_scene

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
    Runner(results, Console(quiet=True), 2, ThreadPoolExecutor).run(tasks, lambda: _task("compile"))
    assert BEGAN[:3] == ["compile", "engine 1", "engine 2"]
    assert sorted(BEGAN[3:]) == ["reference 1", "reference 2"]
    assert [results[task].value for task in tasks] == [task.argument for task in tasks]


def test_what_is_never_ready_runs_when_nothing_else_is_left() -> None:
    done: list[str] = []
    with ThreadPoolExecutor(2) as threads:
        tasks = [Task(str.upper, name, "test") for name in "ab"]
        Sweep(tasks, threads, 2, lambda task, result: done.append(result.value), lambda task: task is tasks[0]).run()
    assert done == ["A", "B"]


def test_the_first_call_is_one_short_point_of_the_reference() -> None:
    study = Study((load_scene("fig3-I"), load_scene("fig4-viscous")), 8, 1e-3, fake_hierarchy())
    task = warm_up(surface_tasks(study))
    batch = task.argument
    assert (batch.model, len(batch.phases), batch.scene.duration) == ("exact", 1, 0.5)
    assert not task.needs_compiled_reference
    assert study.scenes[0].duration == 20.0, "the scene itself is not shortened"
