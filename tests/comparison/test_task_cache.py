"""What a study computes beside its surfaces is kept like these: for the very question, to the last bit, mended."""

from __future__ import annotations

import hashlib
import pickle
from collections.abc import Callable
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fake_models import fake_hierarchy
from rich.console import Console

from comparison.analysis.effective import Effective
from comparison.analysis.errata import Effect
from comparison.analysis.tasks import analysis_tasks, paper_complete
from comparison.analysis.trajectories import Place, StoredMotion
from comparison.execution.cache import Cache
from comparison.execution.runner import fetched
from comparison.execution.sweep import sweep
from comparison.execution.task import Task, TaskResult, fingerprint
from comparison.execution.task_cache import TaskCache
from comparison.study.study import Study
from reference.problem import Outcome, builtin_scenes, load_scene

QUIET = Console(quiet=True)
calls: list[object] = []


def motion(task: tuple[object, ...]) -> StoredMotion:
    calls.append(task)
    numbers, two = np.array([0.1, np.nan, -0.0, 1e-300]), np.array([0.0, 1e300])
    return StoredMotion(Place("s", 1, 2, ""), "small", two, numbers.reshape(2, 1, 2), numbers.reshape(2, 1, 2))


def another(task: tuple[object, ...]) -> StoredMotion:
    return motion(task)


def broken(task: object) -> tuple[Effect, ...]:
    calls.append(task)
    return Effect("s", 0), Effect("s", 1, error_message="it broke")


def forbidden(jobs: int) -> Executor:
    raise AssertionError("nothing should have been computed")


def _task(task: tuple[Any, ...] = (load_scene("fig3-I"), 1, 0.5, np.arange(3.0))) -> Task:
    return Task("motions", motion, task, 0.1, task[0])


def _fetched(task: Task, folder: Path, make: Callable[[int], Executor] = ThreadPoolExecutor) -> TaskCache:
    answers = TaskCache(Cache(folder))
    fetched([task], answers, QUIET, 1, make)
    return answers


def test_an_answer_comes_back_to_the_last_bit_and_is_not_computed_twice(tmp_path: Path) -> None:
    task = _task()
    found = [_fetched(task, tmp_path), _fetched(task, tmp_path, forbidden)]
    assert [answers.parts["motions"].stored for answers in found] == [0, 1]
    first, second = (answers.on(forbidden)(1).submit(motion, task.argument).result() for answers in found)
    assert pickle.dumps(first) == pickle.dumps(second) == pickle.dumps(motion(task.argument))
    assert TaskCache(Cache(tmp_path)).holds(task)
    assert not TaskCache(Cache(tmp_path), fresh=True).holds(task)
    assert TaskCache(Cache(tmp_path), fresh=True).missing([task]) == [task]


def test_it_belongs_to_function_task_versions_and_source(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    task = _task()
    _fetched(task, tmp_path)
    scene, *rest = task.argument
    others = {
        "function": replace(task, function=another),
        "scene": _task((scene.with_values({"duration": 3.0}), *rest)),
        "name, which the answer may hold": _task((scene.with_values({"name": "other"}), *rest)),
        "number": _task((scene, 2, *rest[1:])),
        "last bit": _task((scene, 1, np.nextafter(0.5, 1.0), rest[2])),
        "array": _task((scene, 1, 0.5, np.arange(3.0) + 1e-16 * np.array([1.0, 0.0, 0.0]))),
        "shape": _task((scene, 1, 0.5, np.arange(3.0)[None])),
    }
    for name, other in others.items():
        assert TaskCache(Cache(tmp_path)).missing([other]), name
    for name in ("_version", "source_digest"):
        with monkeypatch.context() as patch:
            patch.setattr(f"comparison.execution.environment.{name}", lambda package: "changed")
            assert TaskCache(Cache(tmp_path)).missing([task]), name
    assert not TaskCache(Cache(tmp_path)).missing([task])


def test_a_model_is_known_by_its_source_too(monkeypatch: pytest.MonkeyPatch) -> None:
    model = fake_hierarchy()[0]
    before = fingerprint(model)
    assert fingerprint(replace(model, settings={"gap": 2.0})) != before
    monkeypatch.setattr("comparison.execution.environment.source_digest", lambda name: "changed")
    assert fingerprint(model) != before


def test_what_names_a_fault_serves_the_run_and_is_tried_again_by_the_next(tmp_path: Path) -> None:
    task = Task("errata", broken, 1, 0.1)
    calls.clear()
    answers = _fetched(task, tmp_path)
    assert answers.on(forbidden)(1).submit(broken, 1).result()[1].error_message == "it broke"
    _fetched(task, tmp_path)
    assert calls == [1, 1]


@pytest.mark.parametrize("damage", ["torn", "one bit", "a foreign class"])
def test_what_is_damaged_or_would_run_foreign_code_is_computed_again(tmp_path: Path, damage: str) -> None:
    task = _task()
    _fetched(task, tmp_path)
    (file,) = tmp_path.glob("*/*.answer")
    text = file.read_bytes()
    if damage == "a foreign class":
        content = pickle.dumps(Path("reports"), protocol=4)
        text = hashlib.sha256(f"{file.parent.name}/{file.name}".encode() + content).digest() + content
    file.write_bytes({"torn": text[:-9], "one bit": text[:-1] + bytes([text[-1] ^ 1])}.get(damage, text))
    assert _fetched(task, tmp_path).parts["motions"].stored == 0
    assert _fetched(task, tmp_path, forbidden).parts["motions"].stored == 1, "and mended"


def test_an_analysis_asks_itself_for_what_was_not_fetched(tmp_path: Path) -> None:
    answers = _fetched(_task(), tmp_path)
    calls.clear()
    tasks = [_task().argument, (1,)]
    found = sweep(tasks, motion, lambda *rest: None, lambda *rest: None, 2, answers.on(ThreadPoolExecutor))
    assert len(found) == 2
    assert calls == [(1,)]


def test_an_errand_whose_worker_died_is_left_to_its_analysis() -> None:
    answers = TaskCache(Cache(Path("unused")))
    answers.put(_task(), None)
    assert answers.missing([_task()])
    answers.put(Task("errata", broken, 1, 0.1), TaskResult(Effect("s", 1, error_message=str(Outcome.WORKER_DIED)), 0.0))
    assert answers.parts["errata"].tasks == 1


def test_every_errand_of_a_study_has_a_place_of_its_own() -> None:
    study = Study(tuple(map(load_scene, builtin_scenes())), 6, 1e-3)
    found = analysis_tasks(study)
    assert paper_complete(study)
    assert len({task.key for task in found}) == len(found)
    assert {task.stage for task in found} == {
        "effective values", "errata", "scaling test", "convergence", "claims", "assumptions",
    }  # fmt: skip
    assert not paper_complete(Study(study.scenes[:1], 6, 1e-3))


def test_effective_values_without_a_motion_are_not_kept_for_good(tmp_path: Path) -> None:
    answers = TaskCache(Cache(tmp_path))
    answers.put(
        Task("effective values", broken, 1, 0.1), TaskResult(Effective("s", "small", error_message="it ended"), 0.1)
    )
    assert not list(tmp_path.glob("*/*"))
