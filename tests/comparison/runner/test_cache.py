"""
A result comes back to the last bit, for its own question and no other; the cache stays bounded.

Whatever stands in it costs a recomputation at most: nothing is unpickled, imported or believed unseen.
"""

import hashlib
import os
import pickle
import platform
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import dataclass, replace
from enum import Enum
from io import BytesIO
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pytest
import xarray as xr
from fake_models import fake_hierarchy
from light_tasks import doubled, raises
from numpy.typing import NDArray
from places import ROOT
from runs import no_executor

from comparison.analyses.motions.analysis import MotionPlace, StoredMotion
from comparison.evidence.claims.table import has_every_paper_scene
from comparison.registry import ANALYSES, EVERYTHING, list_first_tasks
from comparison.runner import environment
from comparison.runner.cache import FILE_SIGNATURE, Cache, CacheKey
from comparison.runner.environment import (
    describe_provenance,
    fingerprint_environment,
    fingerprint_task_environment,
    hash_source,
)
from comparison.runner.runner import Runner
from comparison.runner.task import Task, TaskResult, describe_contents, execute_task
from comparison.runner.task_results import TaskResults
from comparison.study.batches import execute_batch
from comparison.study.study import Study
from comparison.surfaces.surfaces import make_surface_tasks
from reference.problem import Outcome, Scene, builtin_scenes, load_scene

SCENE = load_scene("fig3-I")


def _batch_task(**changed: Any) -> Task:
    return make_surface_tasks(replace(Study((SCENE,), 4, 1e-3, fake_hierarchy(batch=1)), **changed))[0]


def _task(scene: Scene = SCENE, *rest: Any) -> Task:
    return Task(motion, (scene, *(rest or (1, 0.5, np.arange(3.0)))), "motions", 0.1, scene)


def test_a_key_has_all_that_a_result_depends_on(monkeypatch: pytest.MonkeyPatch) -> None:
    task, batch = _task(), _batch_task()
    array, model = np.arange(3.0), fake_hierarchy(batch=1)[0]
    shorter, renamed = SCENE.with_values({"duration": 3.0}), SCENE.with_values({"name": "other"})
    tasks = {
        "it": task,
        "function": replace(task, function=another_motion),
        "scene": _task(shorter),
        "name, which the answer may hold": _task(renamed),
        "title, which the answer may hold": _task(SCENE.with_values({"name": SCENE.name, "title": "another"})),
        "last bit": _task(SCENE, 1, np.nextafter(0.5, 1.0), array),
        "array": _task(SCENE, 1, 0.5, array + 1e-16 * (array == 0.0)),
        "shape": _task(SCENE, 1, 0.5, array[None]),
        "data": _task(SCENE, 1, 0.5, xr.Dataset({"one": ("x", array), "other": ("x", array)})),
        "the last of the data": _task(SCENE, 1, 0.5, xr.Dataset({"one": ("x", array), "other": ("x", array[::-1])})),
        "kind": _task(SCENE, 1, 0.5, array.view(int)),
        "model": replace(task, argument=model),
        "settings of a model": replace(task, argument=replace(model, settings={"gap": 2.0})),
        "batch": batch,
        "scene of a batch": _batch_task(scenes=(shorter,)),
        "model of a batch": _batch_task(hierarchy=[replace(model, amplification="fake_models:uneven")]),
        "settings of a batch": _batch_task(hierarchy=[replace(model, settings={"gap": 2.0})]),
        "tolerance of a batch": _batch_task(tolerance=1e-7),
        "phases of a batch": _batch_task(hierarchy=[replace(model, batch=2)]),
    }
    keys = {name: other.key for name, other in tasks.items()}
    assert len(set(keys.values())) == len(keys)
    assert _batch_task(scenes=(renamed,)).key == batch.key, "a name is no number"
    assert describe_contents(replace(model, most=8)) == describe_contents(model), (
        "a study with another grid asks it the same"
    )
    assert describe_provenance()["exudyn module"] == os.environ.get("EXUDYN_MODULE", "default")
    monkeypatch.delenv("EXUDYN_MODULE", raising=False)
    with monkeypatch.context() as patch:
        patch.setenv("EXUDYN_MODULE", "fast")
        assert {_batch_task().key, _task().key}.isdisjoint(keys.values())
    before = describe_contents(model)
    for name in ("_read_version", "hash_source"):
        with monkeypatch.context() as patch:
            patch.setattr(f"comparison.runner.environment.{name}", lambda package: "changed")
            assert {_batch_task().key, _task().key}.isdisjoint(keys.values()), name
            assert describe_contents(model) != before


def test_a_key_names_versions_and_sources_and_a_report_the_commit(monkeypatch: pytest.MonkeyPatch) -> None:
    everywhere = {"python", "machine", "exudyn module", "exudyn", "llvmlite", "numba", "numpy", "scipy"}
    shared = {"source of reference.problem", "source of comparison.study.batches"}
    engine = fingerprint_environment("multibody:amplification")
    assert set(engine) == everywhere | shared | {"source of multibody"}
    assert (engine["python"], engine["numpy"]) == (platform.python_version(), np.__version__)
    of_user = set(fingerprint_environment("comparison.study.user_models:amplification"))
    assert of_user == everywhere | shared | {"source of comparison.study.user_models"}
    sources = "reference", "multibody", "comparison.study", "comparison.analyses", "comparison.wording"
    assert set(fingerprint_task_environment("comparison.surfaces.figures.pictures")) == (
        everywhere | {"matplotlib", "pillow", "xarray"} | {f"source of {name}" for name in sources}
        | {"source of comparison.surfaces.figures"}
    )  # fmt: skip
    with monkeypatch.context() as patched:
        patched.setattr(environment, "_read_processor_name", lambda: "a processor")
        assert describe_provenance()["processor"] == "a processor"
    said = {"--show-toplevel": str(ROOT), "HEAD": "0123abc"}
    for changed, commit in (("", "0123abc"), (" M a.py", "0123abc with uncommitted changes")):
        monkeypatch.setattr(
            "comparison.runner.environment.ask_git", lambda folder, *words, now=changed: said.get(words[1], now)
        )
        about = describe_provenance()
        assert (about["commit"], about["processors"]) == (commit, str(os.cpu_count()))
    names = {"processor : 0\nmodel name : A: 1\nmodel name : B": "A: 1", "Features : fp": platform.machine()}
    for text, name in names.items():
        monkeypatch.setattr(Path, "read_text", lambda *rest, text=text, **more: text)
        assert environment._read_processor_name() == name


def test_git_is_asked_about_the_folder_and_not_about_where_the_command_began(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("one", "two"):
        (tmp_path / name / "inner").mkdir(parents=True)
        subprocess.run(["git", "init", "-q", str(tmp_path / name)], check=True)
    monkeypatch.chdir(tmp_path / "one")
    told = environment.ask_git(tmp_path / "two" / "inner", "rev-parse", "--show-toplevel")
    assert Path(told).resolve() == (tmp_path / "two").resolve()


def test_changed_source_is_another_source(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    inner = tmp_path / "some_model" / "below" / "inner.py"
    inner.parent.mkdir(parents=True)
    for file in (inner, inner.parent / "__init__.py", tmp_path / "some_model" / "__init__.py"):
        file.write_text("a = 1\n", encoding="utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    hash_source.cache_clear()
    before = hash_source("some_model")
    inner.write_text("a = 2\n", encoding="utf-8")
    hash_source.cache_clear()
    assert (changed := hash_source("some_model")) != before != "absent"
    inner.rename(inner.parents[1] / "inner.py")
    hash_source.cache_clear()
    assert hash_source("some_model") != changed, "the same file in another folder"
    assert hash_source("no_such_package") == "absent"


def _on_disk(folder: Path) -> int:
    """Bytes, in whole blocks of the file system."""
    states = [file.stat() for file in folder.iterdir()]
    return sum(max(512 * getattr(state, "st_blocks", 0), state.st_size) for state in states)


def test_the_store_is_bounded_and_keeps_what_the_study_needs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def trim(limit: int) -> None:
        monkeypatch.setattr("comparison.runner.cache.MAX_CACHE_BYTES", limit)
        store.trim([needed])

    needed, old, new = (CacheKey(f'"{name}"', "0" * 64, "batch") for name in ("needed", "old", "new"))
    store = Cache(tmp_path)
    for age, key in enumerate((needed, old, new)):
        store.put(key, 1.5)
        os.utime(tmp_path / key.group, (1000.0 + age, 1000.0 + age))
    sizes = [_on_disk(tmp_path / key.group) for key in (needed, old, new)]
    aside, young = (tmp_path / new.group / f".phase-resonance-{name}" for name in ("1-x", "2-y"))
    for file, age in ((aside, 4000.0), (young, 3000.0)):
        file.write_bytes(FILE_SIGNATURE + b"torn")
        os.utime(file, (time.time() - age,) * 2)
    trim(2 * sum(sizes))
    assert (aside.exists(), young.exists()) == (False, True), "what a killed run left long ago goes"
    young.unlink()
    for content, stays in ((b"mine", True), (b"", False)):
        aside.write_bytes(content)
        os.utime(aside, (time.time() - 4000.0,) * 2)
        trim(2 * sum(sizes))
        assert aside.exists() == stays, "another's file stays, one into which nothing was written is of this program"
    trim(sum(sizes))
    assert len(list(tmp_path.iterdir())) == 3, "within the limit nothing else goes"
    trim(sizes[0] + sizes[2])
    assert {entry.name for entry in tmp_path.iterdir()} == {needed.group, new.group}
    store.put(old, 1.5)
    os.utime(tmp_path / old.group, (1000.0, 1000.0))
    assert store.get(old, float) == 1.5
    trim(sizes[0] + sizes[1])
    assert {entry.name for entry in tmp_path.iterdir()} == {needed.group, old.group}, "what was read lately stays"
    trim(0)
    assert {entry.name for entry in tmp_path.iterdir()} == {needed.group}
    store.put(old, 1.5)
    for size, kept in ((2**30 - 2**16, True), (2**30, False)):  # with the blocks of the other group beyond it
        os.truncate(tmp_path / old.name, size)
        trim(2**30)
        assert (tmp_path / old.name).exists() == kept


calls: list[object] = []


def motion(task: tuple[object, ...]) -> StoredMotion:
    calls.append(task)
    numbers, two = np.array([0.1, np.nan, -0.0, 1e-300]), np.array([0.0, 1e300])
    return StoredMotion(MotionPlace("s", 1, 2, ""), "small", two, numbers.reshape(2, 1, 2), numbers.reshape(2, 1, 2))


def another_motion(task: tuple[object, ...]) -> StoredMotion:
    return motion(task)


@dataclass(frozen=True)
class Finding:
    """A result that may name a fault."""

    scene: str
    error_message: str = ""


def broken(task: object) -> tuple[Finding, ...]:
    calls.append(task)
    return Finding("s"), Finding("s", "it broke")


def _run(task: Task, folder: Path, make: Callable[[int], Executor] = ThreadPoolExecutor) -> TaskResults:
    results = TaskResults(Cache(folder))
    Runner(results, 1, make).run([task])
    return results


def test_an_answer_is_kept_to_the_last_bit_and_a_damaged_one_is_mended(tmp_path: Path) -> None:
    task = _task()
    first, second = _run(task, tmp_path), _run(task, tmp_path, no_executor)
    assert [(results.parts["motions"].tasks, results.parts["motions"].stored) for results in (first, second)] == [
        (1, 0), (1, 1),
    ]  # fmt: skip
    assert pickle.dumps(second[task].value) == pickle.dumps(first[task].value) == pickle.dumps(motion(task.argument))
    assert TaskResults(Cache(tmp_path)).holds(task)
    fresh = TaskResults(Cache(tmp_path), fresh=True)
    assert (fresh.holds(task), fresh.find_missing([task])) == (False, [task])
    (file,) = tmp_path.glob("*/*.result")
    content, number = file.read_bytes(), np.float64(0.1).tobytes()
    assert number in content
    file.write_bytes(content.replace(number, bytes([number[0] ^ 1]) + number[1:], 1))
    assert _run(task, tmp_path).parts["motions"].stored == 0
    assert _run(task, tmp_path, no_executor).parts["motions"].stored == 1, "and mended"


def test_what_names_a_fault_is_tried_again_by_the_next_run(tmp_path: Path) -> None:
    task = Task(broken, 1, "scaling test", 0.1)
    calls.clear()
    results = _run(task, tmp_path)
    assert results[task].value[1].error_message == "it broke"
    _run(task, tmp_path)
    assert calls == [1, 1]


def test_a_task_that_fails_has_its_reason_and_costs_no_other(tmp_path: Path) -> None:
    def on_failure(argument: object, failed: TaskResult) -> object:
        return argument, failed.outcome, failed.error_message

    tasks = [Task(raises, "1", "scaling test", 0.3), Task(doubled, str(tmp_path / "2"), "scaling test", 0.1)]
    results = TaskResults(Cache(tmp_path))
    Runner(results, 2, ThreadPoolExecutor).run(tasks)
    failed = "1", Outcome.SOLVER_FAILED, "RuntimeError: singular"
    assert [results.value(task, on_failure) for task in tasks] == [failed, 2]
    assert TaskResults(Cache(tmp_path)).find_missing(tasks) == tasks[:1], "the next run tries them again"
    assert len(list(tmp_path.glob("*/*.result"))) == 1, "no file is left of them"
    assert results.parts["scaling test"].tasks == 2


def test_every_task_of_a_study_has_a_place_of_its_own() -> None:
    study = Study(tuple(map(load_scene, builtin_scenes())), 6, 1e-3, selection=EVERYTHING)
    tasks = list_first_tasks(study, ANALYSES)
    assert has_every_paper_scene(study)
    assert len({task.key for task in tasks}) == len(tasks)
    assert {task.stage for task in tasks} == {
        "effective values", "conditioning", "scaling test", "convergence", "assumptions",
    }  # fmt: skip
    assert not has_every_paper_scene(Study(study.scenes[:1], 6, 1e-3))


def test_the_cost_of_a_task_is_its_own_processor_time() -> None:
    assert 0.0 <= execute_task(Task(len, "abc", "test")).cost < 0.1 < time.process_time()


KEY = CacheKey('{"a": 1}', "0" * 64, "result")


class Color(Enum):
    RED = "red"


@dataclass(frozen=True)
class Inner:
    number: float
    word: Literal["yes", "no"] = "yes"


@dataclass(frozen=True)
class Outer:
    """One of everything."""

    array: NDArray[np.float64]
    flags: NDArray[np.bool_]
    picture: bytes
    inner: tuple[Inner, ...]
    pair: tuple[str, float] | None
    color: Color
    rows: list[int]
    table: Mapping[str, float]


VALUE = Outer(
    np.array([[0.1, np.nan], [-0.0, 1e-300]]),
    np.array([True, False]),
    b"\x89PNG\0",
    (Inner(0.1 + 0.2), Inner(float("-inf"), "no")),
    ("μ", 1e308),
    Color.RED,
    [1, -2],
    {"a": 1.5},
)


def forged(key: CacheKey, content: bytes) -> bytes:
    """A file with a right checksum."""
    return FILE_SIGNATURE + hashlib.sha256(key.name.encode() + b"\0" + content).digest() + content


def test_every_kind_of_value_comes_back_to_the_last_bit(tmp_path: Path) -> None:
    Cache(tmp_path).put(KEY, VALUE)
    value = Cache(tmp_path).get(KEY, Outer)
    assert pickle.dumps(value) == pickle.dumps(VALUE)
    assert value.array.flags.writeable


class Evil:
    def __reduce__(self) -> tuple[Callable[..., object], tuple[str, ...]]:
        return __import__, ("evil_module",)


def objects() -> bytes:
    """An array of objects, which only pickle can hold."""
    stream = BytesIO()
    np.save(stream, np.array([Evil()], dtype=object), allow_pickle=True)
    return stream.getvalue()


FORGERIES: dict[str, Callable[[bytes, bytes], bytes]] = {
    "an array of objects": lambda text, arrays: text + b"\n" + objects() + arrays,
    "an array torn": lambda text, arrays: text + b"\n" + arrays[:-1],
    "more than arrays": lambda text, arrays: text + b"\n" + arrays + b"more",
    "an array that is not there": lambda text, arrays: text.replace(b'array": 0', b'array": 7') + b"\n" + arrays,
    "a number for an array": lambda text, arrays: text.replace(b'{"\\u0000array": 0}', b"1.0") + b"\n" + arrays,
    "a text for a number": lambda text, arrays: text.replace(b"[1, -2]", b'["one"]') + b"\n" + arrays,
    "a field too few": lambda text, arrays: text.replace(b'"color": "red", ', b"") + b"\n" + arrays,
    "an unknown member": lambda text, arrays: text.replace(b"red", b"blue") + b"\n" + arrays,
    "deeply nested": lambda text, arrays: b'{"about": 1, "value": ' + b"[" * 100000 + b"]" * 100000 + b"}",
    "a pickle": lambda text, arrays: pickle.dumps(Evil()),
}


@pytest.mark.parametrize("forge", FORGERIES.values(), ids=FORGERIES.keys())
def test_a_forged_file_with_a_right_checksum_is_not_taken(
    tmp_path: Path, forge: Callable[[bytes, bytes], bytes], monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "evil_module.py").write_text("raise SystemExit('it was run')\n", encoding="utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    cache = Cache(tmp_path)
    cache.put(KEY, VALUE)
    file = tmp_path / KEY.name
    text, _, arrays = file.read_bytes()[len(FILE_SIGNATURE) + 32 :].partition(b"\n")
    file.write_bytes(forged(KEY, text + b"\n" + arrays))
    assert cache.get(KEY, Outer) is not None, "unchanged, a forgery is as good as the original"
    content = forge(text, arrays)
    assert content != text + b"\n" + arrays
    file.write_bytes(forged(KEY, content))
    assert cache.get(KEY, Outer) is None
    assert "evil_module" not in sys.modules


def test_no_file_of_another_result_is_taken(tmp_path: Path) -> None:
    cache = Cache(tmp_path)
    cache.put(KEY, VALUE)
    other = CacheKey(KEY.about, "1" * 64, "result")
    (tmp_path / KEY.name).rename(tmp_path / other.name)
    assert cache.get(other, Outer) is None


def test_a_batch_of_another_shape_or_ok_without_numbers_is_computed_again(tmp_path: Path) -> None:
    task = make_surface_tasks(Study((SCENE,), 2, 1e-3, fake_hierarchy()))[0]
    whole = execute_batch(task.argument)

    def is_taken(**changed: object) -> bool:
        Cache(tmp_path).put(task.key, (replace(whole, **changed), 0.0))
        return TaskResults(Cache(tmp_path)).find_missing([task]) == []

    assert is_taken()
    for name in ("mu", "error", "status", "instant", "displacement"):
        assert not is_taken(**{name: getattr(whole, name)[:1]}), name
    for name in ("mu", "error"):
        damaged = getattr(whole, name).copy()
        damaged[0, 0] = np.nan
        assert not is_taken(**{name: damaged})
        assert is_taken(**{name: damaged}, status=["step limit", *whole.status[1:]]), "no result, no numbers"
