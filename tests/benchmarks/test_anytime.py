"""The default study as a user sees it: its pages, its deadline, its second run. For an idle machine with two cores."""

import json
import os
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import pytest

PROJECT = Path(__file__).parents[2]
FIRST, REPEATED, OVER = 60.0, 5.0, 1.0  # s: most to the first page, of a repeated run, and after a deadline


def recorded(folder: Path, *options: str, **environment: str) -> tuple[int, float, list[tuple[float, int]]]:
    """Run the command with its report in `folder`: exit code, s, and for each of its pages after how many s it came."""
    summary, begin, last, pages = folder / "report" / "summary.json", time.monotonic(), "", []
    if summary.exists():
        last = summary.read_text("utf-8")
    command = [sys.executable, "-m", "comparison.run", "--out", str(folder / "report"), *options]
    environment = {**os.environ, "PYTHONPATH": str(PROJECT), **environment}
    process, goes_on = subprocess.Popen(command, cwd=folder, env=environment), True
    while goes_on:
        goes_on = process.poll() is None
        with suppress(FileNotFoundError):  # before the first report, and while one takes the place of another
            if (now := summary.read_text("utf-8")) != last:
                last = now
                pages.append((time.monotonic() - begin, json.loads(now)["run"]["level"]))
        time.sleep(0.05)
    took = time.monotonic() - begin
    print(f"{pages} s to its pages and their levels, {took:.1f} s, {process.returncode}")
    return process.returncode, took, pages


@pytest.mark.long
def test_the_first_command_has_three_pages_and_its_second_run_is_short(tmp_path: Path) -> None:
    caches = {"XDG_CACHE_HOME": str(tmp_path / "cache"), "NUMBA_CACHE_DIR": str(tmp_path / "numba")}
    code, _, pages = recorded(tmp_path, **caches)
    assert (code, [level for _, level in pages]) == (0, [1, 2, 3])
    assert pages[0][0] <= FIRST
    code, took, _ = recorded(tmp_path, **caches)
    assert code == 0
    assert took <= REPEATED


@pytest.mark.long
@pytest.mark.parametrize("seconds", [20.0, 40.0, 80.0])
def test_a_deadline_is_overrun_by_a_second_at_most(seconds: float, tmp_path: Path) -> None:
    code, took, pages = recorded(tmp_path, "--budget", str(seconds))
    assert took <= seconds + OVER
    assert code == (0 if pages else 3)
