"""Extremes that are interrupted go on where they stopped, and end with the same matrix."""

from __future__ import annotations

import re
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from known_results import PLAIN, fake
from runs import no_executor

from comparison.analyses.extremes import command as extremes
from comparison.analyses.extremes.matrix import PICTURE, STORED

COUNT = 40  # cells


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch) -> Callable[..., int]:
    """The command with COUNT extremes for models of known answer."""
    models = "honest", "lies_about_its_error"
    columns = tuple(replace(fake(model), key=model) for model in models)
    rows = [replace(PLAIN, title=str(number), columns=models) for number in range(COUNT // len(models))]
    monkeypatch.setattr(extremes, "COLUMNS", columns)
    monkeypatch.setattr(extremes, "rows", lambda: iter(rows))
    monkeypatch.setattr(extremes, "made_by", lambda draw: {PICTURE: b"a picture"})
    return lambda executor: int(extremes.main(["--jobs", "2", "--out", "report"], executor))


class Interrupted(ThreadPoolExecutor):
    """Ctrl-C comes while the eleventh task is handed out."""

    count = 0

    def submit(self, *words: Any, **options: Any) -> Future[Any]:
        self.count += 1
        if self.count > 10:
            raise KeyboardInterrupt
        return super().submit(*words, **options)


def test_ctrl_c_ends_the_extremes_with_the_command_that_goes_on(
    tmp_path: Path, run: Callable[..., int], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def judged() -> list[object]:
        found = STORED.load(Path("report")).rows
        return [(e.verdict, e.reason, e.status, e.error) for row in found for e in row.entries.values()]

    (tmp_path / "whole").mkdir()
    monkeypatch.chdir(tmp_path / "whole")
    assert run(ThreadPoolExecutor) == 1, "a model that lies fails"
    whole = judged()
    monkeypatch.chdir(tmp_path)
    assert run(Interrupted) == 130
    stopped = re.fullmatch(
        r"interrupted: (\d+) results are kept in 'report.tiles'; "
        r"go on with: python -m comparison.extremes --jobs 2 --out report\n",
        capsys.readouterr().err,
    )
    assert stopped
    assert 0 < int(stopped[1]) == len(list(tmp_path.glob("report.tiles/*/*.result"))) < COUNT
    assert not (tmp_path / "report").exists()
    assert run(ThreadPoolExecutor) == 1
    assert judged() == whole
    assert STORED.load(Path("report")).run["stored_before"] == int(stopped[1])
    assert run(no_executor) == 1, "nothing is computed twice"
