"""Ctrl-C and kill: at once, one line with the command that goes on, the old report untouched, no process left."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest
from places import HELPERS, ROOT

from comparison.runner.output import publish
from comparison.study.models import MODEL_HIERARCHY

HANGS = 300.0  # s: nothing here takes that long, however busy the machine
SCRIPT = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)  # what runs in the background inherits it ignored
sys.path[:0] = [{here!r}, {root!r}]
from comparison.runner.cache import Cache
from comparison.run import main
from fake_models import fake_hierarchy
put = Cache.put
def counted(cache, *words):
    put(cache, *words)
    with open("stored.txt", "a") as file:
        file.write("x")
Cache.put = counted
if __name__ == "__main__":
    sys.exit(main(["fig3-I", "--grid", "8", "--jobs", "2", "--out", "report"], fake_hierarchy("endless", batch=1)))
"""


def _wait_for_the_end_of(workers: list[psutil.Process]) -> None:
    deadline = time.monotonic() + HANGS
    while left := [worker for worker in workers if _runs(worker)]:
        assert time.monotonic() < deadline, left
        time.sleep(0.1)


def _runs(process: psutil.Process) -> bool:
    """Neither gone nor dead and waiting to be collected."""
    try:
        return process.is_running() and process.status() != psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return False


def _wait_for_the_equations(place: Path, process: subprocess.Popen[str]) -> None:
    """Until the last of the equations' 256 results is stored; models under several names share 64 files."""
    log = place / "stored.txt"
    while process.poll() is None and (not log.exists() or log.read_text("utf-8").count("x") < 256):
        time.sleep(0.05)


@pytest.mark.skipif(sys.platform == "win32", reason="signals of a process group")
@pytest.mark.parametrize(
    ("number", "code"),
    [(signal.SIGINT, 130), pytest.param(signal.SIGTERM, 143, marks=pytest.mark.long)],
    ids=["Ctrl-C", "SIGTERM"],
)
def test_a_stopped_run_keeps_what_is_finished(tmp_path: Path, number: int, code: int) -> None:
    old = tmp_path / "report"
    publish(old, {"summary.json": b'{"schema": "phase-resonance/summary"}'}, "comparison.run")
    script = SCRIPT.format(here=str(HELPERS), root=str(ROOT))
    process = subprocess.Popen(
        [sys.executable, "-c", script],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,  # Ctrl-C reaches the whole group, as on a terminal
    )
    _wait_for_the_equations(tmp_path, process)  # the engine is next, which never ends
    workers = psutil.Process(process.pid).children()
    assert workers
    os.killpg(process.pid, number) if number == signal.SIGINT else os.kill(process.pid, number)
    _, err = process.communicate(timeout=HANGS)  # does not wait for the points under way
    assert process.returncode == code
    stopped = re.fullmatch(
        r"interrupted: (\d+) of (\d+) batches are kept in 'report.tiles'; "
        r"go on with: python -m comparison.run fig3-I --grid 8 --jobs 2 --out report\n",
        err,
    )
    assert stopped, err
    assert int(stopped[1]) == 64 * sum(model.side == "reference" for model in MODEL_HIERARCHY) < int(stopped[2])
    assert len(list(tmp_path.glob("report.tiles/*/*.batch"))) == 64, "one model under several names is stored once"
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["report", "report.tiles", "stored.txt"]
    assert sorted(entry.name for entry in old.iterdir()) == ["manifest.json", "summary.json"]
    _wait_for_the_end_of(workers)


@pytest.mark.long
@pytest.mark.skipif(sys.platform == "win32", reason="SIGKILL")
def test_the_workers_of_a_killed_run_end_with_it(tmp_path: Path) -> None:
    script = SCRIPT.format(here=str(HELPERS), root=str(ROOT))
    process = subprocess.Popen(
        [sys.executable, "-c", script], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    )
    _wait_for_the_equations(tmp_path, process)
    workers = psutil.Process(process.pid).children()
    assert workers
    process.kill()
    process.communicate(timeout=HANGS)
    _wait_for_the_end_of(workers)
