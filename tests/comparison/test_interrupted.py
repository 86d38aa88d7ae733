"""Ctrl-C: exit code 130, one line, the report that was there untouched, no process and no file left behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

HERE = Path(__file__).parent
SCRIPT = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)  # what runs in the background inherits it ignored
sys.path[:0] = [{here!r}, {root!r}]
from comparison.run import main
from fake_models import fake_ladder
if __name__ == "__main__":
    sys.exit(main(["fig3-I", "--grid", "16", "--jobs", "2", "--out", "report"], fake_ladder("slow", tile=1)))
"""


def _children(pid: int) -> list[int]:
    found = subprocess.run(["ps", "-o", "pid=", "--ppid", str(pid)], capture_output=True, text=True, check=False)
    return [int(word) for word in found.stdout.split()]


def _runs(pid: int) -> bool:
    """Neither gone nor dead and waiting to be collected."""
    found = subprocess.run(["ps", "-o", "stat=", "-p", str(pid)], capture_output=True, text=True, check=False)
    return found.stdout.strip()[:1] not in ("", "Z")


@pytest.mark.skipif(sys.platform == "win32", reason="signals of a process group")
def test_ctrl_c_loses_nothing_and_leaves_nothing(tmp_path: Path) -> None:
    old = tmp_path / "report"
    old.mkdir()
    (old / "summary.json").write_text('{"schema": "phase-resonance/summary"}', encoding="utf-8")
    script = SCRIPT.format(here=str(HERE), root=str(HERE.parents[1]))
    process = subprocess.Popen(
        [sys.executable, "-c", script],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,  # Ctrl-C reaches the whole group, as on a terminal
    )
    assert process.stdout is not None
    for line in process.stdout:
        if "exact equations, v_reg: 256 of 256" in line:  # the slow engine is next, a minute for each point
            break
    time.sleep(1.0)
    workers = _children(process.pid)
    assert workers
    begin = time.monotonic()
    os.killpg(process.pid, signal.SIGINT)
    _, err = process.communicate(timeout=30)
    assert process.returncode == 130
    assert time.monotonic() - begin < 10.0, "does not wait for the points under way"
    assert err == "interrupted: nothing was written; the same command starts again\n"
    assert [entry.name for entry in tmp_path.iterdir()] == ["report"]
    assert [entry.name for entry in old.iterdir()] == ["summary.json"]
    deadline = time.monotonic() + 5.0
    while (left := [worker for worker in workers if _runs(worker)]) and time.monotonic() < deadline:
        time.sleep(0.1)
    assert left == []
