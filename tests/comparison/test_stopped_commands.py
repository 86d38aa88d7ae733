"""Extremes that are killed or interrupted at any moment go on where they stopped, and end with the same matrix."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import pytest
from test_extremes import PLAIN, fake

from comparison.analyses.extremes import command as extremes
from comparison.analyses.extremes.matrix import PICTURE, STORED

HERE = Path(__file__).parent
COUNT, INSTANTS = 40, 12  # cells, and runs that are killed
WORDS = ["--jobs", "2", "--out", "report"]

# One process imports everything, then forks a run for every instant: a start of Python would take most of the time.
KILLED = """
import os, random, signal, sys
sys.path[:0] = [{here!r}, {root!r}]
from pathlib import Path
from ending import end_after
from test_stopped_commands import COUNT, INSTANTS, run

draw, count = random.Random(3), 0
while count < INSTANTS:
    place = Path(f"killed{{count}}")
    place.mkdir(exist_ok=True)
    results, seconds = draw.randrange(COUNT), draw.uniform(0.0, 0.003)
    child = os.fork()
    if child == 0:
        os.chdir(place)
        sys.stdout = open(os.devnull, "w")
        end_after(results, seconds)
        run()
        os._exit(0)
    if os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == -signal.SIGKILL and not (place / "report").exists():
        count += 1
"""
STOPPED = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)  # what runs in the background inherits it ignored
sys.path[:0] = [{here!r}, {root!r}]
from test_stopped_commands import run
from comparison.runner.processes import process_pool
if __name__ == "__main__":
    sys.exit(run(process_pool, ("honest", "waits_for_ever")))
"""


def run(executor: object = ThreadPoolExecutor, models: tuple[str, ...] = ("honest", "lies_about_its_error")) -> int:
    """The command with COUNT extremes for models of known answer."""
    columns = tuple(replace(fake(model), key=model) for model in models)
    rows = [replace(PLAIN, title=str(number), columns=models) for number in range(COUNT // len(models))]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(extremes, "COLUMNS", columns)
        patch.setattr(extremes, "rows", lambda: iter(rows))
        patch.setattr(extremes, "made_by", lambda draw: {PICTURE: b"a picture"})
        return int(extremes.main(WORDS, executor))


def forbidden(jobs: int) -> Executor:
    raise AssertionError("nothing should have been computed")


@pytest.mark.skipif(not hasattr(os, "fork"), reason="fork")
@pytest.mark.long
def test_extremes_killed_at_random_instants_go_on_to_the_same_matrix(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    script = KILLED.format(here=str(HERE), root=str(HERE.parents[1]))
    subprocess.run([sys.executable, "-c", script], cwd=tmp_path, check=True)
    (tmp_path / "whole").mkdir()
    matrices = {}
    for name in ("whole", *(f"killed{number}" for number in range(INSTANTS))):
        monkeypatch.chdir(tmp_path / name)
        assert run() == 1, "a model that lies fails"
        matrices[name] = STORED.load(Path("report"))
        assert run(forbidden) == 1, "nothing is computed twice"
        assert STORED.load(Path("report")).rows == matrices[name].rows

    def judged(name: str) -> list[object]:
        return [(e.verdict, e.reason, e.status, e.error) for row in matrices[name].rows for e in row.entries.values()]

    assert len(judged("whole")) == COUNT
    assert all(judged(name) == judged("whole") for name in matrices)
    stored = {matrix.run["stored_before"] for matrix in matrices.values()}
    assert min(stored) == 0
    assert len(stored) > 4, "killed at different stages"


@pytest.mark.skipif(sys.platform == "win32", reason="signals of a process group")
@pytest.mark.long
def test_ctrl_c_ends_the_extremes_at_once_with_the_command_that_goes_on(tmp_path: Path) -> None:
    process = subprocess.Popen(
        [sys.executable, "-c", STOPPED.format(here=str(HERE), root=str(HERE.parents[1]))],
        cwd=tmp_path,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,  # Ctrl-C reaches the whole group, as on a terminal
    )
    while not list(tmp_path.glob("report.tiles/*/*.result")) and process.poll() is None:
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGINT)
    _, err = process.communicate(timeout=300)  # does not wait for the cells under way, which never end
    assert process.returncode == 130, err
    stopped = re.fullmatch(
        r"interrupted: (\d+) results are kept in 'report.tiles'; "
        r"go on with: python -m comparison.extremes --jobs 2 --out report\n",
        err,
    )
    assert stopped, err
    assert int(stopped[1]) == len(list(tmp_path.glob("report.tiles/*/*.result")))
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["report.tiles"]
