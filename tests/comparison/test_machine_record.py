"""The costs recorded on a machine are the user's own: read where they fit, ignored where they do not."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pytest

import reference
from comparison.cli import record
from comparison.study import accuracy_record
from comparison.study.accuracy_record import SHIPPED, machine_file, recorded
from reference.problem.user_cache import user_cache


@pytest.fixture
def file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Where the record of this machine would be."""
    place = tmp_path / "accuracy_record.json"
    monkeypatch.setattr(accuracy_record, "machine_file", lambda: place)
    recorded.cache_clear()
    yield place
    recorded.cache_clear()


def test_without_a_record_of_the_machine_that_of_the_package_is_read(file: Path) -> None:
    assert recorded() == accuracy_record.load_record(SHIPPED)


def test_the_record_of_the_machine_takes_its_place(file: Path) -> None:
    content = json.loads(SHIPPED.read_text(encoding="utf-8"))
    file.write_text(json.dumps(content | {"machine": "this one"}), encoding="utf-8")
    assert recorded().machine == "this one"


@pytest.mark.parametrize("content", ["", "[]", "null", "{}", '{"machine": "m", "models": {}, "seconds": {}}'])
def test_a_record_that_is_not_whole_or_of_other_models_is_ignored(file: Path, content: str) -> None:
    file.write_text(content, encoding="utf-8")
    assert recorded() == accuracy_record.load_record(SHIPPED)


def test_the_record_of_a_machine_is_kept_by_version_in_the_user_s_cache() -> None:
    place = machine_file()
    assert place is not None
    assert place.parent == user_cache()
    assert reference.__version__ in place.name


def test_a_place_that_cannot_be_written_is_refused_before_anything_is_measured(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(record, "measure", lambda *rest: pytest.fail("measured"))
    for out in (tmp_path / "no such folder" / "record.json", tmp_path):
        assert record.main(["--out", str(out)]) == 2
        err = capsys.readouterr().err
        assert err.startswith("command line: --out = ")
        assert err.endswith(": cannot be written: give another file\n")
