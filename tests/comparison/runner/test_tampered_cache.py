"""Whatever stands in the cache, it costs a recomputation at most: nothing is unpickled, imported or believed unseen."""

from __future__ import annotations

import hashlib
import json
import os
import pickle
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from enum import Enum
from pathlib import Path
from typing import Any, Literal, get_args, get_origin, get_type_hints

import numpy as np
import pytest
from fake_models import fake_hierarchy
from numpy.typing import NDArray

from comparison.analyses.assumptions.variations import varied
from comparison.analyses.claims.evidence import Evidence, gathered
from comparison.analyses.claims.smoothness import Bend
from comparison.analyses.convergence.analysis import limit_trends
from comparison.analyses.effective_values.analysis import read_back
from comparison.analyses.errata.analysis import measured
from comparison.analyses.motions.analysis import moved
from comparison.analyses.scaling.analysis import scene_trends
from comparison.runner.cache import LENGTH, MAGIC, Cache, Key
from comparison.runner.encoding import array_of
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.batches import BatchResult, execute_batch
from comparison.study.study import Study
from comparison.surfaces.figures.pictures import drawn
from comparison.surfaces.tasks import surface_tasks
from reference.problem import load_scene

KEY = Key('{"a": 1}', "0" * 64, "result")


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


def head_of(file: bytes) -> tuple[dict[str, Any], bytes]:
    content = file[len(MAGIC) + 32 :]
    length = int.from_bytes(content[:LENGTH], "little")
    return json.loads(content[LENGTH : LENGTH + length]), content[LENGTH + length :]


def forged(key: Key, head: Any, arrays: bytes, length: int | None = None) -> bytes:
    """A file with a right checksum."""
    text = head if isinstance(head, bytes) else json.dumps(head).encode()
    content = (len(text) if length is None else length).to_bytes(LENGTH, "little") + text + arrays
    return MAGIC + hashlib.sha256(key.name.encode() + b"\0" + content).digest() + content


def test_every_kind_of_value_comes_back_to_the_last_bit(tmp_path: Path) -> None:
    Cache(tmp_path).put(KEY, VALUE)
    value = Cache(tmp_path).get(KEY, Outer)
    assert pickle.dumps(value) == pickle.dumps(VALUE)
    assert value.array.flags.writeable


class Evil:
    def __reduce__(self) -> tuple[Callable[..., object], tuple[str, ...]]:
        return __import__, ("evil_module",)


def _changed(**changes: Any) -> Callable[[dict[str, Any]], dict[str, Any]]:
    return lambda head: {**head, "value": {**head["value"], **changes}}


def _arrays(*arrays: Any) -> Callable[[dict[str, Any]], dict[str, Any]]:
    return lambda head: {**head, "arrays": [*arrays, *head["arrays"][len(arrays) :]]}


FORGERIES: dict[str, Callable[[dict[str, Any]], Any]] = {
    "an array of objects": _arrays(["|O", [4]]),
    "an array of texts": _arrays(["<U1", [8]]),
    "an array of another type": _arrays(["<i8", [2, 2]]),
    "structured": _arrays(["<f8,<f8", [2]]),
    "no size": _arrays(["<f0", [4]]),
    "a shape too large": _arrays(["<f8", [10**18, 10**18]]),
    "a shape too small": _arrays(["<f8", [2]]),
    "a negative shape": _arrays(["<f8", [-2, -2]]),
    "a shape of words": _arrays(["<f8", ["2", "2"]]),
    "arrays missing": lambda head: {**head, "arrays": []},
    "an array that is not there": _changed(array={"array": 7}),
    "an array counted from the end": _changed(array={"array": -1}),
    "a number for an array": _changed(array=1.0),
    "a text for a number": _changed(rows=["1"]),
    "a number beyond any": _changed(pair=["a", 10**400]),
    "true for a whole number": _changed(rows=[True]),
    "a field too many": _changed(more=1),
    "a field too few": lambda head: {**head, "value": {"array": {"array": 0}}},
    "an unknown member": _changed(color="blue"),
    "an unknown word": _changed(inner=[{"number": 1.0, "word": "perhaps"}]),
    "deeply nested": lambda head: b'{"about": 1, "arrays": [], "value": ' + b"[" * 100000 + b"]" * 100000 + b"}",
    "no JSON": lambda head: b"\xff\xfe",
    "another form": lambda head: [1, 2],
    "a pickle": lambda head: pickle.dumps(Evil()),
}


@pytest.mark.parametrize("forge", FORGERIES.values(), ids=FORGERIES.keys())
def test_a_forged_file_with_a_right_checksum_is_not_taken(
    tmp_path: Path, forge: Callable[[dict[str, Any]], Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "evil_module.py").write_text("raise SystemExit('it was run')\n", encoding="utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    cache = Cache(tmp_path)
    cache.put(KEY, VALUE)
    file = tmp_path / KEY.name
    head, arrays = head_of(file.read_bytes())
    file.write_bytes(forged(KEY, head, arrays))
    assert cache.get(KEY, Outer) is not None, "unchanged, a forgery is as good as the original"
    file.write_bytes(forged(KEY, forge(head), arrays))
    assert cache.get(KEY, Outer) is None
    assert "evil_module" not in sys.modules


@pytest.mark.parametrize("kind", ["|O", "|O8", "<U1", "|S2", "<f8,<f8", "<M8", "|V2", "|b1", 3, None])
def test_an_array_is_of_numbers_alone(kind: object) -> None:
    with pytest.raises(ValueError, match=r"not a type of numbers|neither true nor false"):
        array_of(kind, [1], b"\x02" * 16)


def test_lengths_that_lie_are_not_believed(tmp_path: Path) -> None:
    cache = Cache(tmp_path)
    cache.put(KEY, VALUE)
    file = tmp_path / KEY.name
    head, arrays = head_of(file.read_bytes())
    for content in (
        forged(KEY, head, arrays, length=2**63),
        forged(KEY, head, arrays, length=0),
        forged(KEY, head, arrays + b"more"),
        forged(KEY, head, arrays[:-1]),
        MAGIC,
        pickle.dumps(Evil()),
        file.read_bytes()[:-1],
        b"",
    ):
        file.write_bytes(content)
        assert cache.get(KEY, Outer) is None


def test_no_file_of_another_result_is_taken(tmp_path: Path) -> None:
    cache = Cache(tmp_path)
    cache.put(KEY, VALUE)
    other = Key(KEY.about, "1" * 64, "result")
    (tmp_path / KEY.name).rename(tmp_path / other.name)
    assert cache.get(other, Outer) is None


def is_read_back(folder: Path, task: Task, value: BatchResult) -> bool:
    """Whether a value that stands in the cache is taken for the task's."""
    Cache(folder).put(task.key, (value, 0.0))
    return TaskResults(Cache(folder)).missing([task]) == []


def test_a_batch_of_another_shape_is_computed_again(tmp_path: Path) -> None:
    task = surface_tasks(Study((load_scene("fig3-I"),), 2, 1e-3, fake_hierarchy()))[0]
    whole = execute_batch(task.argument)
    for name in ("mu", "error", "status", "instant", "displacement"):
        assert not is_read_back(tmp_path, task, replace(whole, **{name: getattr(whole, name)[:1]})), name
    assert is_read_back(tmp_path, task, whole)


@pytest.mark.parametrize("name", ["mu", "error"])
def test_a_batch_that_is_ok_without_numbers_is_computed_again(tmp_path: Path, name: str) -> None:
    task = surface_tasks(Study((load_scene("fig3-I"),), 2, 1e-3, fake_hierarchy()))[0]
    whole = execute_batch(task.argument)
    damaged = getattr(whole, name).copy()
    damaged[0, 0] = np.nan
    assert not is_read_back(tmp_path, task, replace(whole, **{name: damaged}))
    status = ["step limit", *whole.status[1:]]
    assert is_read_back(tmp_path, task, replace(whole, **{name: damaged}, status=status)), "no result, no numbers"


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no pipes with names")
def test_what_is_no_regular_file_is_no_result(tmp_path: Path) -> None:
    cache = Cache(tmp_path)
    cache.put(KEY, VALUE)
    (tmp_path / KEY.name).unlink()
    os.mkfifo(tmp_path / KEY.name)
    assert cache.get(KEY, Outer) is None
    (tmp_path / KEY.name).unlink()
    (tmp_path / KEY.name).symlink_to("/dev/zero")
    assert cache.get(KEY, Outer) is None


def _types_in(declared: Any) -> set[Any]:
    if isinstance(declared, type) and is_dataclass(declared):
        hints = get_type_hints(declared)
        return {declared}.union(*(_types_in(hints[part.name]) for part in fields(declared)))
    parts = () if get_origin(declared) is np.ndarray else get_args(declared)
    return {declared}.union(*map(_types_in, parts))


FUNCTIONS = (drawn, gathered, limit_trends, measured, moved, read_back, scene_trends, varied)


@pytest.mark.parametrize("solve", FUNCTIONS)
def test_every_analysis_returns_what_can_be_read_back(solve: Callable[..., Any]) -> None:
    """A result of an undeclared type would be computed again by every run."""
    for declared in _types_in(get_type_hints(solve)["return"]):
        assert declared not in (Any, object, dict, list, tuple, np.ndarray), declared


def test_evidence_of_the_claims_is_read_back(tmp_path: Path) -> None:
    evidence = Evidence(np.ones((2, 2, 1)), 0.1, ("ok",), (Bend(2.0, (0.1, 0.2)),), (0.5,), 0.25)
    Cache(tmp_path).put(KEY, (evidence, 1.5))
    assert pickle.dumps(Cache(tmp_path).get(KEY, tuple[Evidence, float])) == pickle.dumps((evidence, 1.5))
