"""A cached batch comes back to the last bit, for its own question and no other; the cache stays bounded."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import pytest
from conftest import Run
from fake_models import fake_hierarchy
from rich.console import Console

import multibody.models.engine
from comparison.runner.cache import MAGIC, Cache
from comparison.runner.environment import source_digest
from comparison.runner.keys import batch_key, cached_batch
from comparison.runner.provenance import provenance
from comparison.runner.runner import Runner
from comparison.runner.task_results import TaskResults
from comparison.study.batches import BatchResult, execute_batch, unanswered
from comparison.study.study import Study
from reference.problem import Outcome, load_scene


def _study(grid: int = 4) -> Study:
    return Study((load_scene("fig3-I"),), grid, 1e-3, fake_hierarchy(batch=1))


def _computed(study: Study, store: Cache) -> tuple[list[BatchResult], int]:
    """The answers, and how many batches were there before."""
    computed = Runner(TaskResults(store), Console(quiet=True), 2, ThreadPoolExecutor).run_study(study)
    return list(computed.answers), computed.stored


def _bytes(answers: list[BatchResult]) -> list[object]:
    return [(a.mu.tobytes(), a.error.tobytes(), a.instant.tobytes(), a.status) for a in answers]


def test_a_tile_belongs_to_scene_model_settings_versions_and_source(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    batch = _study().batches()[0]
    store = Cache(tmp_path)
    store.put(batch_key(batch), execute_batch(batch))
    assert cached_batch(store, batch) is not None
    others = {
        "scene": replace(batch, scene=batch.scene.with_values({"duration": 3.0})),
        "model": replace(batch, amplification="fake_models:uneven"),
        "settings": replace(batch, settings={**batch.settings, "tolerance": 2e-6}),
        "phases": replace(batch, phases=batch.phases + 1e-15),
    }
    for name, other in others.items():
        assert cached_batch(store, other) is None, name
    renamed = batch.scene.with_values({"name": "other", "title": "another title"})
    assert cached_batch(store, replace(batch, scene=renamed)) is not None, "a name changes no number"
    for name, value in (("_version", "9.9"), ("source_digest", "changed")):
        with monkeypatch.context() as patch:
            patch.setattr(f"comparison.runner.environment.{name}", lambda package, value=value: value)
            assert cached_batch(store, batch) is None, name


def test_results_of_the_fast_module_of_exudyn_are_not_those_of_the_default(monkeypatch: pytest.MonkeyPatch) -> None:
    batch = _study().batches()[0]
    monkeypatch.delenv("EXUDYN_MODULE", raising=False)
    usual = batch_key(batch)
    monkeypatch.setenv("EXUDYN_MODULE", "fast")
    assert batch_key(batch) != usual
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


@pytest.mark.parametrize(
    "damage",
    [lambda text: b"", lambda text: text[: len(text) // 2], lambda text: text[:-1] + bytes([text[-1] ^ 1])],
    ids=["empty", "truncated", "one bit"],
)
def test_a_damaged_tile_is_computed_again(tmp_path: Path, damage: Callable[[bytes], bytes]) -> None:
    study, store = _study(), Cache(tmp_path)
    whole, _ = _computed(study, store)
    files = sorted(tmp_path.glob("*/*.tile"))
    files[0].write_bytes(damage(files[0].read_bytes()))
    assert sum(cached_batch(Cache(tmp_path), batch) is None for batch in study.batches()) > 0
    again, stored = _computed(study, Cache(tmp_path))
    assert stored < len(whole)
    assert _bytes(again) == _bytes(whole)
    assert all(cached_batch(Cache(tmp_path), batch) is not None for batch in study.batches()), "and mended"


def test_the_file_of_another_tile_is_not_taken_for_this_one(tmp_path: Path) -> None:
    stored, other = _study().batches()[:2]
    store = Cache(tmp_path)
    store.put(batch_key(stored), execute_batch(stored))
    (tmp_path / batch_key(stored).name).rename(tmp_path / batch_key(other).name)
    assert cached_batch(store, other) is None


def test_what_raised_or_died_is_tried_again(tmp_path: Path) -> None:
    batch = _study().batches()[0]
    store = Cache(tmp_path)
    store.put(batch_key(batch), unanswered(batch, Outcome.WORKER_DIED, "the worker process died 2 times"))
    assert cached_batch(store, batch) is None


def _on_disk(folder: Path) -> int:
    """Bytes, in whole blocks of the file system."""
    states = [file.stat() for file in folder.iterdir()]
    return sum(max(512 * getattr(state, "st_blocks", 0), state.st_size) for state in states)


def test_the_store_is_bounded_and_keeps_what_the_study_needs(tmp_path: Path) -> None:
    needed = _study().batches()
    keys = [batch_key(batch) for batch in needed]
    old, new = (replace(needed[0], settings={"tolerance": tolerance}) for tolerance in (0.01, 0.02))
    store = Cache(tmp_path)
    for age, batch in enumerate((needed[0], old, new)):
        store.put(batch_key(batch), execute_batch(batch))
        os.utime(tmp_path / batch_key(batch).group, (1000.0 + age, 1000.0 + age))
    sizes = [_on_disk(tmp_path / batch_key(batch).group) for batch in (needed[0], old, new)]
    aside = tmp_path / batch_key(new).group / ".phase-resonance-1-x"
    aside.write_bytes(MAGIC + b"torn")
    os.utime(aside, (1000.0, 1000.0))
    store.trim(keys, limit=sum(sizes))
    assert len(list(tmp_path.iterdir())) == 3, "within the limit nothing goes"
    assert not aside.exists(), "except what a killed run left long ago"
    store.trim(keys, limit=sizes[0] + sizes[2])
    assert {entry.name for entry in tmp_path.iterdir()} == {batch_key(needed[0]).group, batch_key(new).group}
    store.trim(keys, limit=0)
    assert {entry.name for entry in tmp_path.iterdir()} == {batch_key(needed[0]).group}


def test_what_is_no_store_is_left_alone(command: Callable[..., Run], tmp_path: Path) -> None:
    foreign = tmp_path / "report.tiles"
    foreign.mkdir()
    (foreign / "bathroom.txt").write_text("terracotta", encoding="utf-8")
    run = command("fig3-I", hierarchy=fake_hierarchy("forbidden"))
    assert run.code == 2
    assert (
        "'report.tiles' beside it is not a store of results of this study, it holds 'bathroom.txt': move it away"
        in run.err
    )
    assert [entry.name for entry in foreign.iterdir()] == ["bathroom.txt"]
