"""Killed at any moment, or with a full disk, a run goes on from what is stored, and its numbers are the same bytes."""

import errno
import io
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from fake_models import fake_hierarchy
from places import HELPERS, ROOT
from report_texts import summary_of
from runs import Run
from whole_runs import whole_run

from comparison.runner.cache import store_beside
from comparison.study.batches import BatchResult
from comparison.study.study import Study
from comparison.surfaces.surfaces import surface_tasks
from reference.problem import load_scene

INSTANTS = 24

# One process imports everything, then forks a run for every instant: a start of Python would take most of the time.
# An instant is a random number of stored results and a random time after. The run counts and kills itself: another
# process, which a busy machine may keep waiting, would meet the late stages only.
SCRIPT = """
import os, random, shutil, signal, sys
sys.path[:0] = [{here!r}, {root!r}]
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from whole_runs import end_after, whole_run

def killed(place, results, seconds):
    child = os.fork()
    if child == 0:
        end_after(results, seconds)
        whole_run(place)
        os._exit(0)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == -signal.SIGKILL

whole_run(Path("whole"))
draw, count = random.Random(7), 0
while count < {instants}:
    place = Path(f"killed{{count}}")
    late = count % 3 == 0  # a third of them after the surfaces
    if killed(place, 96 + draw.randrange(24) if late else draw.randrange(96), draw.uniform(0.0, 0.003)):
        count += 1
    else:  # it was done before its end
        shutil.rmtree(place, ignore_errors=True)
"""


def _bytes(answers: list[BatchResult]) -> list[object]:
    return [(a.mu.tobytes(), a.error.tobytes(), a.instant.tobytes(), a.status) for a in answers]


@pytest.mark.long
@pytest.mark.skipif(not hasattr(os, "fork"), reason="fork")
def test_a_run_killed_at_random_goes_on_to_the_same_bytes(tmp_path: Path) -> None:
    script = SCRIPT.format(here=str(HELPERS), root=str(ROOT), instants=INSTANTS)
    subprocess.run([sys.executable, "-c", script], cwd=tmp_path, check=True)
    whole, motions, *stored = whole_run(tmp_path / "whole")
    assert stored == [len(whole), len(motions)] == [72, 48], "the run that was not killed"
    anew, same, *stored = whole_run(tmp_path / "new")
    assert (_bytes(anew), same, stored) == (_bytes(whole), motions, [0, 0])
    before = []
    for count in range(INSTANTS):
        resumed, same, *stored = whole_run(tmp_path / f"killed{count}")
        assert (_bytes(resumed), same) == (_bytes(whole), motions)
        before.append(tuple(stored))
    assert len({batches for batches, _ in before}) > 8, "killed at different stages"
    assert sum(batches == 72 and 0 < others < 48 for batches, others in before) > 3, "of these some after the surfaces"


def test_nothing_is_computed_twice_and_fresh_computes_all(command: Callable[..., Run]) -> None:
    def stored(grid: int, *words: str) -> tuple[str, int, int, dict[str, tuple[int, int]]]:
        run = command("fig3-I", "--grid", str(grid), *words)
        about = summary_of(run.report)["run"]
        parts = {stage: (part["tasks"], part["stored_before"]) for stage, part in about["parts"].items()}
        return " ".join(run.out.split()), about["tiles_stored_before"], about["tiles"], parts

    first, again = stored(4), stored(4)
    assert (first[1], again[1]) == (0, again[2])
    assert (first[3]["pictures"], again[3]["pictures"]) == ((9, 0), (9, 9))
    line = f"{again[2]} of {again[2]} batches, 7 of 15 analyses are in "  # the models have no motions for the others
    assert (line in again[0], "are in " in first[0]) == (True, False)
    planned = command("fig3-I", "--grid", "4", "--plan").out
    assert line in " ".join(planned.split())
    assert "batches are in" not in command("fig3-I", "--grid", "4", "--fresh", "--plan").out
    fresh = stored(4, "--fresh")
    assert ("only the others are computed" in fresh[0], fresh[1]) == (False, 0)
    hierarchy, scenes = fake_hierarchy(), (load_scene("fig3-I"),)
    coarse, fine = ([task.key for task in surface_tasks(Study(scenes, n, 1e-3, hierarchy))] for n in (4, 8))
    assert stored(8)[1] == sum(key in coarse for key in fine) > 0


def test_a_full_disk_is_exit_3_and_the_run_goes_on_later(
    command: Callable[..., Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    written: list[str] = []

    class Full(io.FileIO):
        def write(self, content: Any) -> int:
            written.append(str(self.name))
            if len(written) > 3:
                super().write(content[:100])  # as much as there was room for
                raise OSError(errno.ENOSPC, "No space left on device")
            return super().write(content)

    words = ["fig3-I", "--grid", "4"]
    with monkeypatch.context() as patch:
        patch.setattr("reference.problem.files.os.fdopen", lambda handle, mode: Full(handle, mode))
        run = command(*words)
    assert run.code == 3
    assert run.err.count("\n") == 1
    assert "a result could not be stored: No space left on device; 3 of " in run.err
    assert "go on with: python -m comparison.run fig3-I --grid 4 " in run.err
    store = store_beside(run.report)
    assert len(list(store.glob("*/*.batch"))) == 3
    assert not list(store.glob("*/.phase*"))
    assert not run.report.exists()
    again = command(*words)
    assert again.code == 0
    assert "only the others are computed" in again.out
