"""Whatever stands in the cache, it costs a recomputation at most: nothing is unpickled, imported or believed unseen."""

import hashlib
import pickle
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from enum import Enum
from io import BytesIO
from pathlib import Path
from typing import Literal

import numpy as np
import pytest
from fake_models import fake_hierarchy
from numpy.typing import NDArray

from comparison.runner.cache import MAGIC, Cache, Key
from comparison.runner.task_results import TaskResults
from comparison.study.batches import execute_batch
from comparison.study.study import Study
from comparison.surfaces.surfaces import surface_tasks
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


def forged(key: Key, content: bytes) -> bytes:
    """A file with a right checksum."""
    return MAGIC + hashlib.sha256(key.name.encode() + b"\0" + content).digest() + content


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
    text, _, arrays = file.read_bytes()[len(MAGIC) + 32 :].partition(b"\n")
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
    other = Key(KEY.about, "1" * 64, "result")
    (tmp_path / KEY.name).rename(tmp_path / other.name)
    assert cache.get(other, Outer) is None


def test_a_batch_of_another_shape_or_ok_without_numbers_is_computed_again(tmp_path: Path) -> None:
    task = surface_tasks(Study((load_scene("fig3-I"),), 2, 1e-3, fake_hierarchy()))[0]
    whole = execute_batch(task.argument)

    def is_taken(**changed: object) -> bool:
        Cache(tmp_path).put(task.key, (replace(whole, **changed), 0.0))
        return TaskResults(Cache(tmp_path)).missing([task]) == []

    assert is_taken()
    for name in ("mu", "error", "status", "instant", "displacement"):
        assert not is_taken(**{name: getattr(whole, name)[:1]}), name
    for name in ("mu", "error"):
        damaged = getattr(whole, name).copy()
        damaged[0, 0] = np.nan
        assert not is_taken(**{name: damaged})
        assert is_taken(**{name: damaged}, status=["step limit", *whole.status[1:]]), "no result, no numbers"
