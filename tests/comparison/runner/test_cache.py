"""A cached batch comes back to the last bit, for its own question and no other; the cache stays bounded."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import pytest
from fake_models import fake_hierarchy

import multibody.models.engine
from comparison.runner.cache import MAGIC, Cache, Key
from comparison.runner.environment import source_digest
from comparison.runner.provenance import provenance
from comparison.runner.task import Task, execute
from comparison.runner.task_results import TaskResults
from comparison.study.study import Study
from comparison.surfaces.tasks import surface_tasks
from reference.problem import load_scene


def _task(**changed: object) -> Task:
    study = Study((load_scene("fig3-I"),), 4, 1e-3, fake_hierarchy(batch=1))
    (task, *_) = surface_tasks(replace(study, **changed))  # type: ignore[arg-type]
    return task


def test_a_batch_belongs_to_scene_model_versions_and_source(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def is_stored(**changed: object) -> bool:
        return not TaskResults(Cache(tmp_path)).missing([_task(**changed)])

    task = _task()
    scene, model = task.argument.scene, fake_hierarchy(batch=1)[0]
    TaskResults(Cache(tmp_path)).put(task, execute(task))
    assert is_stored()
    others: dict[str, dict[str, object]] = {
        "scene": {"scenes": (scene.with_values({"duration": 3.0}),)},
        "model": {"hierarchy": [replace(model, amplification="fake_models:uneven")]},
        "settings": {"hierarchy": [replace(model, settings={"gap": 2.0})]},
        "phases": {"hierarchy": [replace(model, batch=2)]},
    }
    for name, changed in others.items():
        assert not is_stored(**changed), name
    assert is_stored(scenes=(scene.with_values({"name": "other", "title": "another title"}),)), "a name is no number"
    for name, value in (("_version", "9.9"), ("source_digest", "changed")):
        with monkeypatch.context() as patch:
            patch.setattr(f"comparison.runner.environment.{name}", lambda package, value=value: value)
            assert not is_stored(), name


def test_results_of_the_fast_engine_module_are_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("EXUDYN_MODULE", raising=False)
    usual = _task().key
    monkeypatch.setenv("EXUDYN_MODULE", "fast")
    assert _task().key != usual
    assert provenance()["exudyn module"] == multibody.models.engine.MODULE


def test_changed_source_is_another_source(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / "some_model"
    package.mkdir()
    (package / "__init__.py").write_text("a = 1\n", encoding="utf-8")
    (package / "inner.py").write_text("b = 1\n", encoding="utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    source_digest.cache_clear()
    before = source_digest("some_model")
    (package / "inner.py").write_text("b = 2\n", encoding="utf-8")
    source_digest.cache_clear()
    assert source_digest("some_model") != before != "absent"
    assert source_digest("no_such_package") == "absent"


def _on_disk(folder: Path) -> int:
    """Bytes, in whole blocks of the file system."""
    states = [file.stat() for file in folder.iterdir()]
    return sum(max(512 * getattr(state, "st_blocks", 0), state.st_size) for state in states)


def test_the_store_is_bounded_and_keeps_what_the_study_needs(tmp_path: Path) -> None:
    needed, old, new = (Key(f'"{name}"', "0" * 64, "batch") for name in ("needed", "old", "new"))
    store = Cache(tmp_path)
    for age, key in enumerate((needed, old, new)):
        store.put(key, 1.5)
        os.utime(tmp_path / key.group, (1000.0 + age, 1000.0 + age))
    sizes = [_on_disk(tmp_path / key.group) for key in (needed, old, new)]
    aside = tmp_path / new.group / ".phase-resonance-1-x"
    aside.write_bytes(MAGIC + b"torn")
    os.utime(aside, (1000.0, 1000.0))
    store.trim([needed], limit=sum(sizes))
    assert len(list(tmp_path.iterdir())) == 3, "within the limit nothing goes"
    assert not aside.exists(), "except what a killed run left long ago"
    store.trim([needed], limit=sizes[0] + sizes[2])
    assert {entry.name for entry in tmp_path.iterdir()} == {needed.group, new.group}
    store.trim([needed], limit=0)
    assert {entry.name for entry in tmp_path.iterdir()} == {needed.group}
