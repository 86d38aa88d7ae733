"""Every level of a study is part of the next and has a whole report; grids are nested."""

import itertools
import math
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr
from fake_models import fake_hierarchy
from report_texts import page_of, summary_of
from rich.console import Console
from runs import Run

from comparison import registry
from comparison import run as command_module
from comparison.cli import reports
from comparison.runner.cache import Cache
from comparison.runner.progress import Deadline, Display, TimeUpError, show_progress
from comparison.runner.runner import Runner
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study import levels
from comparison.study.batches import execute_batch
from comparison.study.levels import make_levels
from comparison.study.models import MODEL_HIERARCHY
from comparison.study.study import Study, levels_of_phases, nested_grids
from comparison.study.user_models import make_user_model
from comparison.surfaces.surfaces import make_surface_tasks
from reference.problem import load_scene
from reference.support.command import StoppedError

SCENES = (load_scene("fig3-I"), load_scene("synthetic-pair"))
WORDS = ("fig3-I", "--grid", "24", "--only", "differences,effective,motions")
STOP = 60  # results stored within the second level: the first has 20


@pytest.fixture
def command(command: Callable[..., Run], monkeypatch: pytest.MonkeyPatch) -> Callable[..., Run]:
    """The command with a few large batches; every level gets a report, however soon it is done."""
    monkeypatch.setattr(reports, "MIN_REPORT_INTERVAL", 0.0)
    return partial(command, hierarchy=fake_hierarchy(batch=36))


@pytest.mark.parametrize("grid", [1, 2, 7, 12, 16, 45, 48, 96])
def test_every_grid_and_every_level_is_part_of_the_next(grid: int) -> None:
    chain, level = nested_grids(grid), levels_of_phases(grid)
    assert chain[-1] == grid
    assert all(fine % coarse == 0 and fine > coarse for coarse, fine in itertools.pairwise(chain))
    assert [(level <= number).sum() for number in range(len(chain))] == list(chain)
    study = Study(SCENES, grid, 1e-3, MODEL_HIERARCHY)
    found = make_levels(study, {"motions": 3})
    assert found[-1].study is study
    asked = [{task.key for task in make_surface_tasks(level.study)} for level in found]
    assert all(coarse <= fine for coarse, fine in itertools.pairwise(asked))
    for level in found:
        axis = {model.key: len(level.study.phase_indices(model)) for model in level.study.hierarchy}
        assert axis["small"] == axis["regularised"] == level.study.grid


def test_levels_of_one_side_alone_have_its_own_grids() -> None:
    for models, grid, grids in ((MODEL_HIERARCHY[:6], 48, [16, 48]), (MODEL_HIERARCHY[6:], 50, [50])):
        assert [level.study.grid for level in make_levels(Study(SCENES[:1], grid, 1e-3, models), {})] == grids


def test_the_first_level_is_coarse_and_the_last_is_whole() -> None:
    models = [*MODEL_HIERARCHY, make_user_model("mine", {"function": "user_engines:plain"})]
    study = Study((load_scene("fig3-I"),), 48, 1e-3, models, selection=registry.EVERYTHING)
    first, second, last = (level.study for level in registry.make_study_levels(study))
    grids = [[len(study.phase_indices(model)) for model in study.hierarchy[5:]] for study in (first, second, last)]
    assert grids == [[16, 8, 4, 8], [48, 16, 8, 8], [48, 16, 16, 8]]
    why = "follows at a later level of the study"
    later = [{key for key in study.absent if study.absent[key] == why} for study in (first, second)]
    assert later[0] > later[1] > set()
    assert set(first.absent) - later[0] == set(second.absent) - later[1] == set(last.absent) == {"demands"}


def test_each_level_has_a_whole_report_that_names_it(
    command: Callable[..., Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    write, seen, kept_free, longest = reports.ReportWriter.write, [], [], [0.0]
    monkeypatch.setattr(Deadline, "keep_free", lambda self, seconds: kept_free.append(seconds))

    def noting(self: reports.ReportWriter, complete: reports.CompleteLevel, *rest: Any, **more: Any) -> Any:
        begin = time.monotonic()
        said = write(self, complete, *rest, **more)
        longest.append(max(time.monotonic() - begin, *longest))
        seen.append((summary_of(self.place), xr.load_dataset(self.place / "surfaces.nc"), page_of(self.place)))
        return said

    monkeypatch.setattr(reports.ReportWriter, "write", noting)
    run = command(*WORDS)
    assert run.code == 0
    assert [0.0 < seconds <= most for seconds, most in zip(kept_free, longest[1:], strict=True)] == [True] * 3
    for number, grid, (summary, surfaces, page) in zip((1, 2, 3), (8, 24, 24), seen, strict=True):
        assert (summary["run"]["level"], summary["run"]["levels"]) == (number, 3)
        assert surfaces.sizes["alpha1"] == summary["grid"] == grid
        assert np.isfinite(surfaces["mu"].sel(model="small", scene="fig3-I")).all()
        assert (f"This is level {number} of 3" in page) == (number < 3)
        assert (f"{grid} × {grid} phases of the equations" in page) == (number < 3)
    first, second = (run.out.index(f"Level {number} of 3: {run.report / 'index.html'}\n") for number in (1, 2))
    assert "fig3-I, platform" in run.out[first:second]
    assert "goes on with it" not in run.out, "it is complete"
    again = command(*WORDS)
    assert (again.code, "of 3: " in again.out) == (0, False), "a repeated run writes the last level alone"


def ended(run: Callable[[], Run], number: int, error: type[BaseException]) -> Run:
    """A run that ends by `error` when the result of some number is stored."""
    put, count = Cache.put, itertools.count(1)

    def stored(cache: Cache, *words: Any) -> None:
        put(cache, *words)
        if next(count) == number:
            raise error

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Cache, "put", stored)
        return run()


@pytest.mark.parametrize(("error", "code"), [(StoppedError, 130), (TimeUpError, 0)])
def test_a_run_that_ends_early_has_its_last_level_and_goes_on_alike(
    command: Callable[..., Run], tmp_path: Path, error: type[BaseException], code: int
) -> None:
    words = (*WORDS, "--budget", "1000", "--out")
    run = ended(lambda: command(*words, str(tmp_path / "a")), STOP, error)
    assert run.code == code
    assert ("go on with: python -m comparison.run fig3-I" in run.err) == (code == 130)
    assert summary_of(tmp_path / "a")["run"]["level"] == 1
    assert "This is level 1 of 3: the same command goes on with it." in run.out
    if code:
        assert [command(*words, str(tmp_path / name)).code for name in "ab"] == [0, 0]
        stopped, undisturbed = (xr.load_dataset(tmp_path / name / "surfaces.nc").drop_attrs() for name in "ab")
        xr.testing.assert_identical(stopped, undisturbed)


@pytest.mark.parametrize(
    ("error", "code", "said"),
    [
        (StoppedError, 130, "go on with: python -m comparison.run fig3-I"),
        (TimeUpError, 3, "--budget = 1000: no level of the study was complete by then"),
    ],
)
def test_an_end_before_the_first_level_is_one_line(
    command: Callable[..., Run], error: type[BaseException], code: int, said: str
) -> None:
    run = ended(lambda: command(*WORDS, "--budget", "1000"), 3, error)
    assert (run.code, run.err.count("\n"), run.report.exists()) == (code, 1, False)
    assert said in run.err


def test_an_interrupt_before_the_study_is_one_line(
    command: Callable[..., Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    def stop(words: list[str]) -> None:
        raise StoppedError

    monkeypatch.setattr(command_module, "parse_options", stop)
    run = command(*WORDS)
    assert (run.code, run.out, run.err) == (130, "", "interrupted before anything was computed\n")


def test_only_analyses_that_need_the_surfaces_have_tasks_after_them(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[tuple[str, bool]] = []

    def analysis(key: str, needs_surfaces: bool) -> Any:
        def tasks(study: Study, surfaces: xr.Dataset | None = None) -> list[Task]:
            asked.append((key, surfaces is not None))
            return []

        return SimpleNamespace(key=key, needs_surfaces=needs_surfaces, tasks=tasks)

    study = Study(SCENES[:1], 2, 1e-3, fake_hierarchy())
    runner: Any = SimpleNamespace(run=lambda tasks, *rest: None, results=None)
    monkeypatch.setattr(reports, "select_analyses", lambda _: [analysis("first", False), analysis("later", True)])
    monkeypatch.setattr(reports, "collect_batch_results", lambda tasks, _: [execute_batch(t.argument) for t in tasks])
    reports.compute_level(make_levels(study, {})[-1], runner)
    assert asked == [("first", False), ("later", True)]


def test_finished_analyses_are_in_the_report_of_a_stopped_run(
    command: Callable[..., Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    finished = command_module.compute_level

    def compute(level: Any, runner: Any) -> Any:
        complete = finished(level, runner)
        if level.number == 2:
            raise TimeUpError  # everything of the second level is computed, but it is not taken for complete
        return complete

    monkeypatch.setattr(command_module, "compute_level", compute)
    summary = summary_of(command(*WORDS, "--budget", "1000").report)
    assert summary["run"]["level"] == 1
    assert ("effective" in summary["absent"], "motions" in summary["absent"]) == (False, True)


def test_the_time_is_up_at_the_deadline_less_what_is_kept_free(monkeypatch: pytest.MonkeyPatch) -> None:
    armed: list[float] = []
    monkeypatch.setattr("comparison.runner.progress.signal.setitimer", lambda which, seconds: armed.append(seconds))
    monkeypatch.setattr("comparison.runner.progress.time.monotonic", lambda: 100.0)
    with Deadline(90.0, 30.0) as deadline:
        deadline.keep_free(4.0)
    assert armed == pytest.approx([19.7, 15.7, 0.0])


def test_the_alarm_ends_what_the_main_thread_does() -> None:
    with pytest.raises(TimeUpError), Deadline(time.monotonic(), 0.0):
        threading.Event().wait(60.0)


def test_the_time_left_follows_from_the_work_so_far(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    now = [100.0]
    monkeypatch.setattr("comparison.runner.progress.time.monotonic", lambda: now[0])
    with show_progress(Console(), 130.0, 2) as display:
        display.skip(20.0)
        for count, seconds in enumerate((14.0, 16.0, 30.9, 31.4)):  # a line every 15 s
            now[0] = 100.0 + seconds
            display.advance("engine", f"{count} of 9 tasks", 10.0)
    # Of 110 the first 10 do not count: 10 in 2 s, 30 in 17.4 s, and a tenth of all work in half its cost
    left = [f"{90.0 * (2.0 + 5.5) / (10.0 + 11.0):.0f} s left", f"{70.0 * (17.4 + 5.5) / (30.0 + 11.0):.0f} s left"]
    assert capsys.readouterr().out.splitlines() == [
        f"    16 s  engine: 1 of 9 tasks, about {left[0]}",
        f"    31 s  engine: 3 of 9 tasks, about {left[1]}",
    ]


def test_work_is_counted_once_in_phase_pairs_and_tasks_of_its_weight() -> None:
    said: list[tuple[str, float]] = []
    display = Display(100.0, 1, lambda display: said.append((display.text.rsplit(",", 1)[0], display.done)))
    tasks = [Task(math.sqrt, number, "roots", seconds) for number, seconds in ((1.0, 1.0), (4.0, 4.0))]
    batches = make_surface_tasks(Study(SCENES[:1], 2, 1e-3, fake_hierarchy(batch=3)[:1]))
    runner = Runner(
        TaskResults(), 1, ThreadPoolExecutor, display, {"roots": 10.0, "small equations, literal supremum": 40.0}
    )
    for _ in range(2):  # a later level has the work of the earlier one
        runner.run([*tasks, *batches])
    assert display.total == 100.0
    assert runner.results.parts["roots"].seconds == sum(runner.results[task].cost for task in tasks) > 0.0
    assert said == [
        ("small equations, literal supremum: 3 of 4 phase pairs", 30.0),
        ("small equations, literal supremum: 4 of 4 phase pairs", 40.0),
        ("roots: 1 of 2 tasks", 48.0),  # the longest first
        ("roots: 2 of 2 tasks", 50.0),
    ]


@pytest.mark.parametrize("grid", [12, 30, 48, 50, 60])
def test_every_engine_has_its_finest_nested_grid_on_a_coarse_level(grid: int) -> None:
    study = Study((load_scene("fig3-I"),), grid, 1e-3, MODEL_HIERARCHY)
    for most in levels.MAX_PHASES_OF_LEVEL:
        coarse = levels._coarsen_study(study, most)
        thinner = grid // coarse.grid
        for model, same in zip(study.hierarchy, coarse.hierarchy, strict=True):
            stride = levels._find_stride(study, model, most["spatial" if model.is_spatial else model.side])
            if model.side == "reference":  # all phases of the thinner grid
                stride = thinner
            assert (thinner * coarse.phase_indices(same)).tolist() == [*range(0, grid, stride)], model.key
