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

import psutil
import pytest
from distinct_models import differences_of, distinct_hierarchy, grid_phases
from fake_models import busy, errors_in, fake_hierarchy
from places import SCENES
from report_texts import summary_of
from rich.console import Console
from runs import Run

import comparison.run
from comparison.cli import reports, terminal
from comparison.cli.arguments import changed, resume_hint
from comparison.cli.closing import print_closing
from comparison.cli.computing import run_facts
from comparison.cli.start import Clock
from comparison.cli.terminal import new_table
from comparison.run import main
from comparison.runner.task import RESULT


def after_report(run: Run) -> list[str]:
    lines = run.out.splitlines()
    return lines[next(number for number, line in enumerate(lines) if line.startswith("Report: ")) :]


def test_the_last_lines_are_the_sentences_of_the_results(command: Callable[..., Run]) -> None:
    run = command("fig3-I", "fig4-viscous", "--grid", "4", hierarchy=fake_hierarchy(gap=0.01))
    sentences = [each["sentence"] for scene in summary_of(run.report)["scenes"] for each in scene["headlines"]]
    lines = run.out.splitlines()
    last = lines.index(f"Report: {run.report / 'index.html'}")
    assert lines[last - 4 : last] == sentences


def test_the_next_command_works_as_it_is_printed(
    command: Callable[..., Run], capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    run = command("fig3-I", "--grid", "2", "--amplitude", "0.5", hierarchy=errors_in({"spatial": 0.1}))
    (finer,) = after_report(run)[2:]  # no film: it would be of another loading
    words = shlex.split(finer.split("costs: ")[1])
    assert (words[:3], words.count("--grid")) == (["python", "-m", "comparison.run"], 1)
    assert main([*words[3:], "--out", str(tmp_path / "other")], fake_hierarchy(), ThreadPoolExecutor) == 0
    assert "4 x 4 phases" in capfd.readouterr().out.replace("\n", " ")
    assert after_report(command("synthetic-pair", hierarchy=fake_hierarchy()))[2:] == [], (
        "a record has no grid to refine"
    )
    timed = command("fig3-I", "--grid", "2", "--budget", "1000", hierarchy=errors_in({}))
    assert not any("finer grid" in line for line in after_report(timed))


def test_printed_options_stand_before_scenes_with_a_dash(
    command: Callable[..., Run], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("-my scene.toml").write_text((SCENES / "fig3-I.toml").read_text(encoding="utf-8"), encoding="utf-8")
    run = command(
        "--grid", "2", "--out", str(tmp_path / "report"), "--", "-my scene.toml", hierarchy=errors_in({"spatial": 0.1})
    )
    film, finer = after_report(run)[2:]
    assert shlex.split(film)[shlex.split(film).index("multibody.animate") + 1] == "./-my scene.toml"
    words = shlex.split(finer.split("costs: ")[1])[3:]
    assert words[-5:] == ["--grid", "4", "--plan", "--", "-my scene.toml"]
    assert main(words, fake_hierarchy(), ThreadPoolExecutor) == 0


def test_a_changed_command_keeps_what_stands_behind_two_dashes() -> None:
    words = ["--grid=4", "--grid", "8", "--fresh", "--out", "r", "--", "--grid", "--fresh", "-a.toml"]
    assert changed(words, ["--plan"], flags=["--fresh"], options=["--grid"]) == [
        "--out", "r", "--plan", "--", "--grid", "--fresh", "-a.toml",
    ]  # fmt: skip
    assert resume_hint(SimpleNamespace(kept={RESULT: 0}, folder="d"), words).endswith(  # type: ignore[arg-type]
        "comparison.run --grid=4 --grid 8 --out r -- --grid --fresh -a.toml"
    )
    words = ["--scheduler", "tcp://a:1", "--", "--scheduler", "b"]
    assert changed(words, options=["--scheduler"]) == ["--", "--scheduler", "b"]


def test_engines_given_in_python_are_used_in_spite_of_two_dashes(command: Callable[..., Run]) -> None:
    words = ["--grid", "2", "--plan", "--", "fig3-I"]
    assert main(words, fake_hierarchy(), ThreadPoolExecutor, models={"mine": "user_engines:plain"}) == 0


def test_a_long_name_of_a_scene_cuts_no_number(capsys: pytest.CaptureFixture[str]) -> None:
    table = new_table("scene", "body", "difference", "mean", "std. dev.", "maximum", "not ok")
    name = "building-" + "x" * 71
    numbers = ("−0.0051 %", "< 0.0001 %", "0.014 %", "12345")
    table.add_row(name, "2", "like for like", *numbers)
    for width in (80, 100, 120):
        Console(width=width).print(table)
        shown = capsys.readouterr().out
        assert all(cell in shown for cell in ("like for like", *numbers)), shown
        assert "".join(line.split()[0] for line in shown.splitlines()[3:] if line.strip()) == name


def test_the_times_of_a_run_are_the_same_in_every_place(
    command: Callable[..., Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    class Told(Clock):
        @classmethod
        def now(cls) -> Clock:
            return Clock(1002.0, 50.0)

    monkeypatch.setattr(reports, "Clock", Told)
    monkeypatch.setattr(comparison.run, "start_time", lambda: Clock(900.0, 20.0))
    run = command("fig3-I", "--grid", "2", hierarchy=fake_hierarchy())
    times = summary_of(run.report)["run"]
    assert (times["wall_seconds"], times["processor_seconds"]) == (102.0, 30.0)
    assert "102.0 s of wall time with" in run.out
    assert abs((datetime.now(UTC) - datetime.fromisoformat(times["began"])).total_seconds() - 102.0) < 60.0
    facts = run_facts("extremes", Namespace(jobs="3", scheduler=None), ["--a"], time.monotonic() - 90.0)
    assert (facts["command"], facts["jobs"]) == ("python -m comparison.extremes --a", 3)
    assert abs((datetime.now(UTC) - datetime.fromisoformat(facts["began"])).total_seconds() - 90.0) < 60.0
    assert 90.0 <= facts["seconds"] < 120.0


def test_an_alert_has_its_label_and_a_value_hardly_meant_its_scene(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    labels = {"refused": "No answer", "lacking": "Values missing", "swing": "Wide swing", "limit": "Limit broken"}
    labels["travel"] = "Travel nearly used up"
    alerts = [SimpleNamespace(kind=kind, level="amber", line=f"about {kind}") for kind in (*labels, "fault")]
    run_of = SimpleNamespace(took="1 s", level=1, levels=1)
    nothing = {"scenes": [], "phased": [], "grid": 4, "no_pdf": "", "of": lambda key: None}
    results = SimpleNamespace(**nothing, run=run_of, alerts=alerts, scenes_with=lambda key: [])
    lines = ["The run took 1 s.", *(f"{label}: about {kind}" for kind, label in labels.items())]
    lines += ["Report: r/index.html", "In print: r/report.pdf"]
    for check in (False, True):
        print_closing(Console(), results, SimpleNamespace(check=check), [], Path("r"))  # type: ignore[arg-type]
        shown = [line for line in lines if not check or "about limit" not in line]
        assert capsys.readouterr().out.splitlines() == shown, "with --check limits are on standard error"
    monkeypatch.setattr(terminal, "implausible_values", lambda scene: ["mass = 1e9: hardly meant"])
    terminal.print_implausible_values(Console(), [SimpleNamespace(name=name) for name in "ab"])  # type: ignore[misc]
    assert capsys.readouterr().out == "Warning: a: mass = 1e9: hardly meant\n", "once, of the first scene"


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
    words = shlex.split(next(line for line in run.out.splitlines() if "multibody.animate" in line))
    phases = grid_phases(4)
    sizes = {
        (key, body, place): abs(size)
        for key in ("translational", "spatial")
        for body in (1, 2)
        for place, size in enumerate(differences_of(key, body, phases))
    }
    model, _, place = max(sizes, key=sizes.__getitem__)
    at = words.index("--phases")
    assert words[at - 4 : at] == ["python", "-m", "multibody.animate", "fig3-I"]
    assert [float(word) for word in words[at + 1 : at + 3]] == pytest.approx(phases[place].tolist(), abs=1e-4)
    assert words[-2:] == ["--model", model]
