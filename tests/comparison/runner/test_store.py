"""A report is written aside and takes the place of the old one only when it is complete."""

import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from places import ROOT
from runs import Run

from comparison.report import page
from comparison.runner.output import clear_dead, replace_report

SMALL = ["fig3-I", "--grid", "2"]


def test_a_second_run_replaces_the_first(command: Callable[..., Run]) -> None:
    first = command(*SMALL)
    before = (first.report / "summary.json").read_text(encoding="utf-8")
    second = command(*SMALL, "--tolerance", "2e-3")
    assert second.code == 0
    after = (second.report / "summary.json").read_text(encoding="utf-8")
    assert '"tolerance": 0.001' in before
    assert '"tolerance": 0.002' in after
    assert sorted(entry.name for entry in first.report.parent.iterdir()) == ["report", "report.tiles"]


@pytest.mark.parametrize(
    "error_message", [OSError("No space left on device"), KeyboardInterrupt()], ids=["disk full", "Ctrl-C"]
)
def test_a_report_that_cannot_be_finished_leaves_the_old_one(
    command: Callable[..., Run], monkeypatch: pytest.MonkeyPatch, error_message: BaseException
) -> None:
    first = command(*SMALL)
    before = {entry: entry.read_bytes() for entry in first.report.rglob("*") if entry.is_file()}

    def breaks(*rest: object) -> str:
        raise error_message  # the surfaces, the summary and the figures are written by then

    monkeypatch.setattr(page, "page_data", breaks)
    run = command(*SMALL, "--tolerance", "2e-3")
    assert run.code == (130 if isinstance(error_message, KeyboardInterrupt) else 3)
    assert run.err.count("\n") == 1
    assert {entry: entry.read_bytes() for entry in first.report.rglob("*") if entry.is_file()} == before
    assert sorted(entry.name for entry in first.report.parent.iterdir()) == ["report", "report.tiles"]


def test_nothing_is_left_of_a_first_report_that_fails(tmp_path: Path) -> None:
    def half() -> None:
        with replace_report(tmp_path / "a" / "b" / "report") as report:
            (report.folder / "index.html").write_text("half", encoding="utf-8")
            raise RuntimeError("the second half")

    with pytest.raises(RuntimeError, match="the second half"):
        half()
    assert list(tmp_path.iterdir()) == []


KILLED = """
import sys
from pathlib import Path
sys.path.insert(0, {root!r})
from comparison.runner import output as store
with store.replace_report(Path("report")) as report:
    (report.folder / "index.html").write_text("half")
    print("writing", flush=True)
    sys.stdin.read()
"""


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="kill -9")
def test_what_a_killed_run_left_is_cleared_of_a_living_one_not(tmp_path: Path) -> None:
    (tmp_path / ".report-someone-else").mkdir()
    script = KILLED.format(root=str(ROOT))
    process = subprocess.Popen(
        [sys.executable, "-c", script], cwd=tmp_path, stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    with process:
        assert process.stdout is not None
        process.stdout.readline()
        clear_dead(tmp_path / "report")
        assert len(list(tmp_path.iterdir())) == 2, "it lives"
        process.kill()
    assert len(list(tmp_path.iterdir())) == 2
    clear_dead(tmp_path / "report")
    assert [entry.name for entry in tmp_path.iterdir()] == [".report-someone-else"]
