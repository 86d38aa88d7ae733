"""A run goes on from what is stored: nothing is computed twice, also after a full disk."""

import errno
import io
from collections.abc import Callable
from typing import Any

import pytest
from fake_models import fake_hierarchy
from report_texts import summary_of
from runs import Run

from comparison.runner.cache import store_beside
from comparison.study.study import Study
from comparison.surfaces.surfaces import surface_tasks
from reference.problem import load_scene


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
    out, before, *_ = stored(8)
    assert before == sum(key in coarse for key in fine) > 0
    assert "Level 1 of" not in out, "a level that is done at once has no report of its own"


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
