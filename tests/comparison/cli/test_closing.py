"""The terminal ends with the sentences of the page, and with commands that work as they are printed."""

import multiprocessing
import shlex
import subprocess
import sys
import time
from argparse import Namespace
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import psutil
import pytest
from distinct_models import differences_of, distinct_hierarchy, grid_phases
from fake_models import busy, errors_in, fake_hierarchy
from places import scene_text
from report_texts import summary_of
from rich.console import Console
from runs import Run

import comparison.run
from comparison.cli import closing, reports, terminal
from comparison.cli.computing import collect_run_facts
from comparison.cli.start import Clock
from comparison.cli.terminal import make_table
from comparison.run import main
from reference.problem import load_scene


def next_commands(run: Run) -> list[list[str]]:
    """The words of the commands that the last lines name."""
    return [shlex.split(line.rpartition(": ")[2]) for line in run.out.splitlines() if line.startswith("Next: ")]


def test_the_next_command_works_as_it_is_printed(
    command: Callable[..., Run], capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    run = command("fig3-I", "--grid=2", "--amplitude", "0.5", hierarchy=errors_in({"spatial": 0.1}))
    (words,) = next_commands(run)  # no film: it would be of another loading
    assert (words[:3], "--grid=2" in words) == (["python", "-m", "comparison.run"], False)
    assert main([*words[3:], "--out", str(tmp_path / "other")], fake_hierarchy(), ThreadPoolExecutor) == 0
    assert "4 x 4 phases" in capfd.readouterr().out.replace("\n", " ")
    assert next_commands(command("synthetic-pair", hierarchy=fake_hierarchy())) == [], "a record has no grid to refine"
    timed = command("fig3-I", "--grid", "2", "--budget", "1000", hierarchy=errors_in({}))
    assert not any("comparison.run" in words for words in next_commands(timed))


def test_printed_options_stand_before_scenes_with_a_dash(
    command: Callable[..., Run], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("-my scene.toml").write_text(scene_text(), encoding="utf-8")
    words = ["--grid", "2", "--out", "report", "--", "-my scene.toml"]
    film, finer = next_commands(run := command(*words, hierarchy=errors_in({"spatial": 0.1})))
    assert "Report: report/index.html\n" in run.out, "as it was typed"
    assert film[film.index("multibody.animate") + 1] == "./-my scene.toml"
    assert finer[-5:] == ["--grid", "4", "--plan", "--", "-my scene.toml"]
    assert main(finer[3:], fake_hierarchy(), ThreadPoolExecutor, models={"mine": "user_engines:plain"}) == 0


def test_a_long_name_of_a_scene_cuts_no_number(capsys: pytest.CaptureFixture[str]) -> None:
    table = make_table("scene", "body", "difference", "mean", "std. dev.", "maximum", "not ok")
    cells = ("like for like", "−0.0051 %", "< 0.0001 %", "0.014 %", "12345")
    table.add_row("building-" + "x" * 71, "2", *cells)
    Console(width=80).print(table)
    shown = capsys.readouterr().out
    assert all(cell in shown for cell in cells), shown


def test_the_times_of_a_run_are_the_same_in_every_place(
    command: Callable[..., Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    class Told(Clock):
        @classmethod
        def now(cls) -> Clock:
            return Clock(1002.0, 50.0)

    def ago(began: str) -> float:
        return (datetime.now(UTC) - datetime.fromisoformat(began)).total_seconds()

    monkeypatch.setattr(reports, "Clock", Told)
    monkeypatch.setattr(comparison.run, "find_command_start", lambda: Clock(900.0, 20.0))
    run = command("fig3-I", "--grid", "2", hierarchy=fake_hierarchy())
    times = summary_of(run.report)["run"]
    assert (times["wall_seconds"], times["processor_seconds"]) == (102.0, 30.0)
    assert "102.0 s of wall time with" in run.out
    assert ago(times["began"]) == pytest.approx(102.0, abs=60.0)
    facts = collect_run_facts("extremes", Namespace(jobs="3", scheduler=None), ["--a"], time.monotonic() - 90.0)
    assert (facts["command"], facts["jobs"]) == ("phase-resonance extremes --a", 3)
    assert ago(facts["began"]) == pytest.approx(90.0, abs=60.0)
    assert 90.0 <= facts["seconds"] < 120.0


def test_a_value_hardly_meant_is_named_once_with_its_first_scene(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(terminal, "implausible_values", lambda scene, building: ["mass = 1e9: hardly meant"])
    terminal.print_buildings(Console(), [(name, load_scene("fig3-I")) for name in "ab"])
    *building, warning = capsys.readouterr().out.splitlines()
    assert warning == "Warning: a: mass = 1e9: hardly meant"
    assert building[0].startswith("Building a, b: 2 bodies, weight 19.62 N"), "once what is alike"
    assert len(building) == 8


def test_the_warning_of_a_building_is_that_of_its_strongest_motion(capsys: pytest.CaptureFixture[str]) -> None:
    pair = load_scene("synthetic-pair")
    scales = (1.0, 20.0, 2.0)
    terminal.print_buildings(Console(), [("pair", pair.with_values({"excitation.scale": scale})) for scale in scales])
    *building, warning = capsys.readouterr().out.splitlines()
    assert warning == "Warning: pair: the peak of the ground is 5.101 g, above 3 g: unit or scale?"
    assert building[-1] == "  peak of the ground: 2.5 to 50 m/s^2 = 0.255 to 5.1 g"


@pytest.mark.skipif(sys.platform == "win32", reason="Windows does not add up the times of processes")
def test_the_processor_time_of_processes_that_run_and_that_ended_is_counted() -> None:
    before = Clock.now()
    burn = "import time\nwhile time.process_time() < 0.5: pass"
    subprocess.run([sys.executable, "-c", burn], check=True)
    ended = Clock.now()
    assert ended.since(before).processor >= 0.45, "processor time is counted in steps"
    if sys.platform == "linux":  # other systems do not tell
        process = multiprocessing.get_context("spawn").Process(target=busy, args=(1e9,), daemon=True)
        process.start()
        child = psutil.Process(process.pid)  # this process spends time, too
        while (spent := sum(child.cpu_times()[:2])) < 0.45 and Clock.now().since(ended).wall < 300.0:
            time.sleep(0.05)
        seconds = Clock.now().since(ended).processor  # a difference of large sums of hundredths
        assert round(seconds, 6) >= round(spent, 6) > 0.4
        process.kill()
        process.join()


def test_the_film_is_of_the_largest_difference(command: Callable[..., Run]) -> None:
    run = command("fig3-I", "--grid", "4", "--only", "surfaces", hierarchy=distinct_hierarchy())
    (words,) = (words for words in next_commands(run) if "multibody.animate" in words)
    phases = grid_phases(4)
    sizes = {
        (key, body, place): abs(size)
        for key in ("translational", "spatial")
        for body in (1, 2)
        for place, size in enumerate(differences_of(key, body, phases))
    }
    model, _, place = max(sizes, key=sizes.__getitem__)
    assert words[:5] == ["python", "-m", "multibody.animate", "fig3-I", "--phases"]
    assert [float(word) for word in words[5:7]] == pytest.approx(phases[place].tolist(), abs=1e-4)
    assert words[7:] == ["--model", model]


@pytest.mark.parametrize(("before", "more"), [(0, 3), (3, 0), (2, 1)])
def test_a_level_prints_eight_new_sentences_and_counts_the_others(
    before: int, more: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    said: Any = [f"sentence {number}" for number in range(11)]
    monkeypatch.setattr(closing, "_headline_sentences", lambda results: results)
    level: Any = SimpleNamespace(title="level 1 of 3")
    closing.print_level(Console(width=200), said, said[:before], level, Path("report"))
    shown = [f"  {sentence}" for sentence in said[before : before + 8]]
    rest = [f"  and {more} more on the page."] * (more > 0)
    assert capsys.readouterr().out.splitlines() == [f"Level 1 of 3: {Path('report/index.html')}", *shown, *rest]


@pytest.mark.parametrize("words", [["--amplitude", "2"], ["--amplitude=2"]])
def test_a_scene_whose_loading_was_changed_has_no_command_for_its_film(words: list[str]) -> None:
    scene: Any = SimpleNamespace(name="fig3-I")
    assert closing._find_source(scene, ["fig3-I", *words]) == ""
    assert closing._find_source(scene, ["fig3-I", "--grid", "4"]) == "fig3-I"


def test_every_model_with_a_message_is_named_once(monkeypatch: pytest.MonkeyPatch) -> None:
    def task(stage: str) -> Any:
        return SimpleNamespace(stage=stage, argument=SimpleNamespace(scene=SimpleNamespace(name="fig3-I")))

    tasks = [task("exact"), task("spatial"), task("spatial"), task("small")]
    said = [SimpleNamespace(error_message=text) for text in ("singular", "singular", "singular", "")]
    monkeypatch.setattr(reports, "collect_batch_results", lambda tasks, results: said)
    alerts = reports._list_solver_messages(tasks, SimpleNamespace())
    assert [(each.scene, each.text) for each in alerts] == [
        ("fig3-I", "exact: singular"),
        ("fig3-I", "spatial: singular"),
    ]
