"""The default study as a user sees it: its pages, its deadline, its second run. For an idle machine with two cores."""

import json
import os
import subprocess
import sys
import time
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

PROJECT = Path(__file__).parents[2]
EVERY = 0.05  # s
FIRST, REPEATED, OVER = 60.0, 5.0, 1.0  # s: most to the first page, of a repeated run, and after a deadline


@dataclass
class Recording:
    """Of one run: its exit code, how long it took, s, and its pages, each with its time, s, and its summary.json."""

    code: int = 0
    seconds: float = 0.0
    pages: list[tuple[float, dict[str, Any]]] = field(default_factory=list)


def recorded(folder: Path, *options: str, compiled: bool = False) -> Recording:
    """Run the command with its report in `folder`; compiled: with the user's compiled code."""
    summary, run, begin, last = folder / "report" / "summary.json", Recording(), time.monotonic(), ""
    apart = {} if compiled else {"XDG_CACHE_HOME": str(folder / "cache"), "NUMBA_CACHE_DIR": str(folder / "numba")}
    environment = {**os.environ, **apart, "PYTHONPATH": str(PROJECT)}
    command = [sys.executable, "-m", "comparison.run", "--out", str(folder / "report"), *options]
    with suppress(FileNotFoundError):
        last = summary.read_text("utf-8")
    process, goes_on = subprocess.Popen(command, cwd=folder, env=environment), True
    while goes_on:
        goes_on = process.poll() is None
        with suppress(FileNotFoundError):  # before the first report, and while one takes the place of another
            if (now := summary.read_text("utf-8")) != last:
                last = now
                run.pages.append((time.monotonic() - begin, json.loads(now)))
        time.sleep(EVERY)
    run.code, run.seconds = process.wait(), time.monotonic() - begin
    print(f"{[round(seconds, 1) for seconds, _ in run.pages]} s to its pages, {run.seconds:.1f} s, {run.code}")
    return run


@pytest.mark.long
def test_the_first_command_has_three_pages_and_its_second_run_is_short(tmp_path: Path) -> None:
    first = recorded(tmp_path)
    assert first.code == 0
    assert [summary["run"]["level"] for _, summary in first.pages] == [1, 2, 3]
    assert first.pages[0][0] <= FIRST
    again = recorded(tmp_path)
    assert again.code == 0
    assert again.seconds <= REPEATED


@pytest.mark.long
@pytest.mark.parametrize("seconds", [20.0, 40.0, 80.0])
def test_a_deadline_is_overrun_by_a_second_at_most(seconds: float, tmp_path: Path) -> None:
    run = recorded(tmp_path, "--budget", str(seconds), compiled=True)
    assert run.seconds <= seconds + OVER
    assert run.code == (0 if run.pages else 3)
