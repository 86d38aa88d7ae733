"""Every level of a study is part of the next and has a whole report; grids are nested."""

import itertools
import math
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from fake_models import fake_hierarchy
from report_texts import page_of, summary_of
from runs import Run

from comparison import registry
from comparison import run as command_module
from comparison.cli import reports
from comparison.runner.cache import Cache
from comparison.runner.progress import Deadline, Display, TimeUpError
from comparison.runner.runner import Runner
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.levels import levels_of
from comparison.study.models import MODEL_HIERARCHY
from comparison.study.study import Study, levels, nested_grids
from comparison.surfaces.surfaces import surface_tasks
from reference.command import StoppedError
from reference.problem import load_scene, phase_grid

SCENES = (load_scene("fig3-I"), load_scene("synthetic-pair"))
WORDS = ("fig3-I", "--grid", "24", "--only", "differences,effective,motions")
STOP = 60  # results stored within the second level: the first has 20


@pytest.fixture
def command(command: Callable[..., Run]) -> Callable[..., Run]:
    """The command with a few large batches."""
    return partial(command, hierarchy=fake_hierarchy(batch=36))


@pytest.fixture
def every_level(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every level gets a report, however soon it is done."""
    monkeypatch.setattr(reports, "PATIENCE", 0.0)


@pytest.mark.parametrize("grid", [1, 2, 3, 7, 12, 16, 24, 47, 48])
@pytest.mark.parametrize("hierarchy", [MODEL_HIERARCHY, fake_hierarchy(batch=24)], ids=["real", "fake"])
def test_every_level_begins_with_what_the_level_before_has(grid: int, hierarchy: Any) -> None:
    study = Study(SCENES, grid, 1e-3, hierarchy)
    found = levels_of(study, {"motions": 3})
    assert found[-1].study is study
    asked = [{task.key for task in surface_tasks(level.study)} for level in found]
    assert all(coarse <= fine for coarse, fine in itertools.pairwise(asked))
    for level in found:
        axis = {model.key: len(level.study.axis(model)) for model in level.study.hierarchy}
        assert axis["small"] == axis["regularised"] == level.study.grid


def test_the_first_level_is_coarse_and_the_last_is_whole() -> None:
    first, second, last = registry.levels(Study((load_scene("fig3-I"),), 48, 1e-3))

    def grids(study: Study) -> list[int]:
        return [len(study.axis(model)) for model in study.hierarchy[3:]]

    assert [grids(level.study) for level in (first, second, last)] == [[16, 8, 4], [48, 16, 8], [48, 16, 16]]
    assert set(first.study.absent) - {"demands"} > set(second.study.absent) - {"demands"} > set()
    assert set(last.study.absent) == {"demands"}


def _copied(place: Path, at: Path) -> None:
    at.mkdir(exist_ok=True)
    for name in ("summary.json", "surfaces.nc", "index.html"):
        (at / name).write_bytes((place / name).read_bytes())


@pytest.mark.usefixtures("every_level")
def test_each_level_has_a_whole_report_that_names_it(
    command: Callable[..., Run], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write, seen = reports.Reports.write, []

    def copying(self: reports.Reports, complete: reports.Complete, *rest: Any, **more: Any) -> Any:
        said = write(self, complete, *rest, **more)
        seen.append(tmp_path / f"level{complete.level.number}")
        _copied(self.place, seen[-1])
        return said

    monkeypatch.setattr(reports.Reports, "write", copying)
    run = command(*WORDS)
    assert run.code == 0
    assert len(seen) == 3
    for number, place in enumerate(seen, start=1):
        summary = summary_of(place)
        assert (summary["run"]["level"], summary["run"]["levels"]) == (number, 3)
        with xr.open_dataset(place / "surfaces.nc") as surfaces:
            assert surfaces.sizes["alpha1"] == summary["grid"] == (8, 24, 24)[number - 1]
            assert np.isfinite(surfaces["mu"].sel(model="small", scene="fig3-I")).all()
        page = page_of(place)
        assert (f"This is level {number} of 3" in page) == (number < 3)
        assert (f"{summary['grid']} × {summary['grid']} phases of the equations" in page) == (number < 3)
    first = run.out.index("Level 1 of 3: ")
    assert "fig3-I, platform" in run.out[first : run.out.index("Level 2 of 3: ")]


@pytest.mark.usefixtures("every_level")
def test_a_repeated_run_writes_the_last_level_alone(command: Callable[..., Run]) -> None:
    assert "Level 2 of 3: " in command(*WORDS).out
    again = command(*WORDS)
    assert again.code == 0
    assert "of 3: " not in again.out


class Ends:
    """Ends a run by `error` when the result of some number is stored."""

    def __init__(self, patch: pytest.MonkeyPatch, number: int, error: type[BaseException]) -> None:
        put, count = Cache.put, itertools.count(1)

        def stored(cache: Cache, *words: Any) -> None:
            put(cache, *words)
            if next(count) == number:
                raise error

        patch.setattr(Cache, "put", stored)


def _whole(command: Callable[..., Run], place: Path) -> xr.Dataset:
    assert command(*WORDS, "--out", str(place)).code == 0
    return xr.load_dataset(place / "surfaces.nc")


@pytest.mark.usefixtures("every_level")
@pytest.mark.parametrize(("number", "level"), [(5, None), (STOP, 1)])
def test_a_stopped_run_has_its_last_level_and_goes_on_alike(
    command: Callable[..., Run], tmp_path: Path, number: int, level: int | None
) -> None:
    with pytest.MonkeyPatch.context() as patch:
        Ends(patch, number, StoppedError)
        run = command(*WORDS, "--out", str(tmp_path / "a"))
    assert run.code == 130
    assert "go on with: python -m comparison.run fig3-I" in run.err
    if level is None:
        assert not (tmp_path / "a").exists()
        return
    assert summary_of(tmp_path / "a")["run"]["level"] == level
    assert f"This is level {level} of 3" in run.out
    stopped, undisturbed = _whole(command, tmp_path / "a"), _whole(command, tmp_path / "b")
    xr.testing.assert_identical(stopped.drop_attrs(), undisturbed.drop_attrs())


@pytest.mark.usefixtures("every_level")
def test_a_deadline_keeps_the_last_complete_level_and_exits_0(command: Callable[..., Run], tmp_path: Path) -> None:
    with pytest.MonkeyPatch.context() as patch:
        Ends(patch, STOP, TimeUpError)
        run = command(*WORDS, "--budget", "1000")
    assert run.code == 0
    assert summary_of(run.report)["run"]["level"] == 1
    assert "This is level 1 of 3: the same command goes on with it." in run.out


def test_a_deadline_before_the_first_level_is_one_line(command: Callable[..., Run]) -> None:
    with pytest.MonkeyPatch.context() as patch:
        Ends(patch, 3, TimeUpError)
        run = command(*WORDS, "--budget", "1000")
    assert run.code == 3
    assert run.err.count("\n") == 1
    assert "--budget = 1000: no level of the study was complete by then" in run.err
    assert not run.report.exists()


@pytest.mark.usefixtures("every_level")
def test_finished_analyses_are_in_the_report_of_a_stopped_run(
    command: Callable[..., Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    finished = command_module.computed_level

    def computed(level: Any, runner: Any) -> Any:
        complete = finished(level, runner)
        if level.number == 2:
            raise TimeUpError  # everything of the second level is computed, but it is not taken for complete
        return complete

    monkeypatch.setattr(command_module, "computed_level", computed)
    run = command(*WORDS, "--budget", "1000")
    summary = summary_of(run.report)
    assert summary["run"]["level"] == 1
    assert "effective" not in summary["absent"]
    assert "motions" in summary["absent"]


def test_the_time_is_up_at_the_deadline_less_what_is_kept_free(monkeypatch: pytest.MonkeyPatch) -> None:
    armed: list[float] = []
    monkeypatch.setattr("comparison.runner.progress.signal.setitimer", lambda which, seconds: armed.append(seconds))
    monkeypatch.setattr("comparison.runner.progress.time.monotonic", lambda: 100.0)
    with Deadline(90.0, 30.0) as deadline:
        deadline.keep_free(4.0)
    assert armed == pytest.approx([19.7, 15.7, 0.0])
    armed.clear()
    with Deadline(90.0, None) as deadline:
        deadline.keep_free(4.0)
    assert armed == []


def test_the_alarm_ends_what_the_main_thread_does() -> None:
    with Deadline(time.monotonic(), 0.0), pytest.raises(TimeUpError):
        threading.Event().wait(60.0)


def test_the_time_left_follows_from_the_work_so_far(monkeypatch: pytest.MonkeyPatch) -> None:
    now = iter([0.0, 20.0, 40.0])
    monkeypatch.setattr("comparison.runner.progress.time.monotonic", lambda: next(now))
    display = Display(100.0, 2)
    display.advance("compiling", "1 of 1 tasks", 0.0)  # at 20 s: does not count
    display.advance("engine", "1 of 9 tasks", 30.0)
    display.skip(20.0)
    assert display.left == pytest.approx(50.0 * (20.0 + 4.0) / (30.0 + 8.0))  # 30 in 20 s, and a tenth in half its cost


def test_work_of_an_earlier_level_is_not_skipped_twice() -> None:
    display, tasks = Display(100.0, 1), [Task(math.sqrt, number, "roots") for number in (1.0, 4.0)]
    runner = Runner(TaskResults(), 1, ThreadPoolExecutor, display, {"roots": 10.0})
    for _ in range(2):
        runner.run(tasks)
    assert (display.total, display.done) == (100.0, 10.0)


@pytest.mark.parametrize("grid", [1, 2, 3, 7, 12, 16, 20, 45, 48, 96, 512])
def test_each_grid_is_part_of_the_next(grid: int) -> None:
    chain = nested_grids(grid)
    assert chain[-1] == grid
    assert all(fine % coarse == 0 and fine > coarse for coarse, fine in pairwise(chain))
    level = levels(grid)
    for number, coarse in enumerate(chain):
        assert (level <= number).sum() == coarse


def test_every_phase_pair_is_in_one_batch() -> None:
    study = Study(SCENES[:1], 12, 1e-3, fake_hierarchy(batch=5))
    for model in study.hierarchy:
        phases = np.concatenate([batch.phases for batch in study.batches() if batch.model == model.key])
        expected = phase_grid(12)[study.places(model)]
        np.testing.assert_array_equal(phases[np.lexsort(phases.T[::-1])], expected)
