"""What ends a command early is one line; what is finished is kept, and the line says how to go on."""

import errno
import io
import os
import re
import signal
import subprocess
import sys
import time
from argparse import Namespace
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import psutil
import pytest
from fake_models import fake_hierarchy
from known_results import PLAIN, fake
from light_tasks import doubled
from places import HELPERS, ROOT
from report_texts import summary_of
from rich.console import Console
from runs import Run, no_executor

from comparison.cli.computing import compute_tasks
from comparison.evidence.extremes import command as extremes
from comparison.evidence.extremes.matrix import STORED
from comparison.runner.cache import Cache, locate_store
from comparison.runner.output import publish_files
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.models import MODEL_HIERARCHY
from comparison.study.study import Study
from comparison.surfaces.surfaces import make_surface_tasks
from reference.problem import load_scene
from reference.support.command import StoppedError

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
    sys.exit(main(["fig3-I", "--grid", "4", "--jobs", "2", "--out", "report"], fake_hierarchy("endless", batch=1)))
"""


@pytest.mark.skipif(sys.platform == "win32", reason="signals of a process group")
@pytest.mark.parametrize("number", [signal.SIGINT, pytest.param(signal.SIGKILL, marks=pytest.mark.long)])
def test_a_stopped_run_keeps_what_is_finished(tmp_path: Path, number: signal.Signals) -> None:
    old = tmp_path / "report"
    publish_files(old, {"summary.json": b'{"schema": "phase-resonance/summary"}'}, "comparison.run")
    script = SCRIPT.format(here=str(HELPERS), root=str(ROOT))
    process = subprocess.Popen(
        [sys.executable, "-c", script],
        cwd=tmp_path,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,  # Ctrl-C reaches the whole group, as on a terminal
    )
    log, end = tmp_path / "stored.txt", time.monotonic() + HANGS
    kept = 16 * sum(model.side == "reference" for model in MODEL_HIERARCHY)  # results of the equations
    while process.poll() is None and (not log.exists() or len(log.read_bytes()) < kept):
        time.sleep(0.05)
    workers = psutil.Process(process.pid).children()  # at work for the engine, which never ends
    assert workers
    os.killpg(process.pid, number) if number == signal.SIGINT else os.kill(process.pid, number)
    _, err = process.communicate(timeout=HANGS)  # does not wait for the points under way
    while any(map(still_runs, workers)):
        assert time.monotonic() < end
        time.sleep(0.1)
    tasks = make_surface_tasks(Study((load_scene("fig3-I"),), 4, 1e-3, fake_hierarchy("endless", batch=1)))
    missing = TaskResults(Cache(tmp_path / "report.tiles")).find_missing(tasks)
    assert {task.argument.model for task in missing} == {"translational", "spatial"}, "the others are whole"
    if number == signal.SIGKILL:
        return
    assert process.returncode == 130
    stopped = re.fullmatch(
        r"interrupted: (\d+) of (\d+) batches are kept in 'report.tiles'; "
        r"go on with: python -m comparison.run fig3-I --grid 4 --jobs 2 --out report\n",
        err,
    )
    assert stopped, err
    assert int(stopped[1]) == kept < int(stopped[2])
    assert len(list(tmp_path.glob("report.tiles/*/*.batch"))) == 16, "one model under several names is stored once"
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["report", "report.tiles", "stored.txt"]
    assert sorted(entry.name for entry in old.iterdir()) == ["manifest.json", "summary.json"]


def still_runs(process: psutil.Process) -> bool:
    """Neither gone nor dead and waiting to be collected."""
    with suppress(psutil.NoSuchProcess):
        return bool(process.is_running() and process.status() != psutil.STATUS_ZOMBIE)
    return False


COUNT = 40  # cells


class Interrupted(ThreadPoolExecutor):
    """A signal comes while the eleventh task is handed out."""

    count = 0
    stop: BaseException = KeyboardInterrupt()

    def submit(self, *words: Any, **options: Any) -> Future[Any]:
        self.count += 1
        if self.count > 10:
            raise self.stop
        return super().submit(*words, **options)


@pytest.mark.parametrize(
    ("stop", "code"), [(KeyboardInterrupt(), 130), (StoppedError(signal.SIGTERM), 143)], ids=["Ctrl-C", "SIGTERM"]
)
def test_a_signal_ends_the_extremes_with_the_command_that_goes_on(
    stop: BaseException,
    code: int,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """COUNT extremes for models of known answer, of which one lies and fails."""
    models = "honest", "lies_about_its_error"
    rows = [replace(PLAIN, title=str(number), columns=models) for number in range(COUNT // len(models))]
    monkeypatch.setattr(extremes, "COLUMNS", tuple(replace(fake(model), key=model) for model in models))
    monkeypatch.setattr(extremes, "list_extreme_cases", lambda: iter(rows))
    monkeypatch.chdir(tmp_path)
    words = ["--jobs", "2", "--out", "report"]
    monkeypatch.setattr(Interrupted, "stop", stop)
    assert extremes.main(words, Interrupted) == code
    stopped = re.fullmatch(
        r"interrupted: (\d+) results are kept in 'report.tiles'; "
        r"go on with: phase-resonance extremes --jobs 2 --out report\n",
        capsys.readouterr().err,
    )
    assert stopped
    assert 0 < int(stopped[1]) == len(list(tmp_path.glob("report.tiles/*/*.result"))) < COUNT
    assert not (tmp_path / "report").exists()
    assert extremes.main(words, ThreadPoolExecutor) == 1
    said = capsys.readouterr().out
    assert f"{stopped[1]} of {COUNT} tasks are in report.tiles: only the others are computed." in said
    found = STORED.load(Path("report"))
    verdicts = [row.entries[model].verdict for row in found.rows for model in models]
    assert verdicts == ["converged", "FAILED"] * len(rows)
    assert found.run["stored_before"] == int(stopped[1])
    assert found.run["command"] == "phase-resonance extremes --jobs 2 --out report"
    assert extremes.main(words, no_executor) == 1, "nothing is computed twice"
    with pytest.raises(AssertionError, match="computed"):
        extremes.main([*words, "--fresh"], no_executor)


def test_nothing_is_computed_twice_and_fresh_computes_all(command: Callable[..., Run]) -> None:
    def stored(grid: int, *words: str) -> tuple[str, int, int, dict[str, tuple[int, int]]]:
        run = command("fig3-I", "--grid", str(grid), *words)
        about = summary_of(run.report)["run"]
        parts = {stage: (part["tasks"], part["stored_before"]) for stage, part in about["parts"].items()}
        return " ".join(run.out.split()), about["tiles_stored_before"], about["tiles"], parts

    first, again = stored(4), stored(4)
    assert (first[1], again[1]) == (0, again[2])
    assert (first[3]["pictures"], again[3]["pictures"]) == ((3, 0), (3, 3))
    assert first[3].keys().isdisjoint(model.title for model in MODEL_HIERARCHY), "parts are what is beside the surfaces"
    line = f"{again[2]} of {again[2]} batches, 6 of 11 analyses are in "  # the models have no motions for the others
    assert line in again[0], again[0][:400]
    assert "are in " not in first[0]
    planned = command("fig3-I", "--grid", "4", "--plan").out
    assert line in " ".join(planned.split())
    alone = command("fig3-I", "--grid", "4", "--only", "budget", "--plan").out
    assert line.replace(", 6 of 11 analyses", "") in " ".join(alone.split())
    assert "batches are in" not in command("fig3-I", "--grid", "4", "--fresh", "--plan").out
    fresh = stored(4, "--fresh")
    assert ("only the others are computed" in fresh[0], fresh[1]) == (False, 0)
    hierarchy, scenes = fake_hierarchy(), (load_scene("fig3-I"),)
    coarse, fine = ([task.key for task in make_surface_tasks(Study(scenes, n, 1e-3, hierarchy))] for n in (4, 8))
    out, before, *_ = stored(8)
    assert before == sum(key in coarse for key in fine) > 0
    assert "Level 1 of" not in out, "a level that is done at once has no report of its own"


def test_fresh_computes_also_what_follows_from_the_first_tasks(tmp_path: Path) -> None:
    first, second = (Task(doubled, str(tmp_path / name), "test", needs_compiled_reference=False) for name in "ab")

    def calls(fresh: bool) -> list[str]:
        before = {*tmp_path.iterdir()}
        options = Namespace(jobs="1", scheduler=None, out=tmp_path / "report", fresh=fresh)
        compute_tasks("test", options, [], [first], set(), Console(), ThreadPoolExecutor, lambda *rest: [second])
        return sorted(mark.name[0] for mark in {*tmp_path.iterdir()} - before if mark.is_file())

    assert [calls(fresh) for fresh in (False, False, True)] == [["a", "b"], [], ["a", "b"]]


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
        patch.setattr("reference.support.files.os.fdopen", lambda handle, mode: Full(handle, mode))
        run = command(*words)
    assert run.code == 3
    assert run.err.count("\n") == 1
    assert "a result could not be stored: No space left on device; 3 of " in run.err
    assert "go on with: python -m comparison.run fig3-I --grid 4 " in run.err
    store = locate_store(run.report)
    assert len(list(store.glob("*/*.batch"))) == 3
    assert not list(store.glob("*/.phase*"))
    assert not run.report.exists()
    again = command(*words)
    assert again.code == 0
    assert "only the others are computed" in again.out
