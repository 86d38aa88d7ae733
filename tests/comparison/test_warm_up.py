"""The reference is compiled by one worker; the engine's points go on meanwhile, the reference's wait for it."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor

from fake_models import fake_hierarchy

from comparison.runner.sweep import sweep
from comparison.runner.warm_up import WARM_UP, warm_up
from comparison.study.study import Study
from reference.problem import Outcome, load_scene


def _lost(task: str, outcome: Outcome, error_message: str) -> str:
    return f"{outcome}: {error_message}"


def test_what_is_not_ready_lets_others_pass_and_starts_as_soon_as_it_is() -> None:
    compiled = threading.Event()
    began: list[str] = []

    def solve(task: str) -> str:
        began.append(task)
        if task == "compile":
            assert compiled.wait(timeout=300.0), "the engine's tasks ran meanwhile"
        if task == "engine 2":
            compiled.set()
        return task

    done: list[str] = []
    results = sweep(
        ["compile", "reference 1", "reference 2", "engine 1", "engine 2"],
        solve,
        _lost,
        lambda task, result: done.append(task),
        2,
        ThreadPoolExecutor,
        lambda task: (task != "reference 1" and task != "reference 2") or "compile" in done,
    )
    assert began[:3] == ["compile", "engine 1", "engine 2"]
    assert sorted(began[3:]) == ["reference 1", "reference 2"]
    assert results == ["compile", "reference 1", "reference 2", "engine 1", "engine 2"], "in the order of the tasks"


def test_what_is_never_ready_runs_when_nothing_else_is_left() -> None:
    results = sweep(
        ["a", "b"], str.upper, _lost, lambda task, result: None, 2, ThreadPoolExecutor, lambda task: task == "a"
    )
    assert results == ["A", "B"]


def test_the_first_call_is_one_short_point_of_the_reference() -> None:
    study = Study((load_scene("fig3-I"), load_scene("fig4-viscous")), 8, 1e-3, fake_hierarchy())
    batch = warm_up(study)
    assert (batch.model, len(batch.phases), batch.scene.duration) == (WARM_UP, 1, 0.5)
    assert batch.amplification == study.hierarchy[0].amplification
    assert study.scenes[0].duration == 20.0, "the scene itself is not shortened"
