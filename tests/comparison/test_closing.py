"""The terminal ends with the sentences of the page, and with commands that work as they are printed."""

from __future__ import annotations

import json
import shlex
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from conftest import Run
from fake_models import errors_in, fake_hierarchy

from comparison.run import main

SCENES = Path(__file__).parents[2] / "reference/problem/scenes"


def after_report(run: Run) -> list[str]:
    lines = run.out.splitlines()
    return lines[next(number for number, line in enumerate(lines) if line.startswith("Report: ")) :]


def test_the_last_lines_are_the_sentences_of_the_results(command: Callable[..., Run]) -> None:
    run = command("fig3-I", "fig4-viscous", "--grid", "4", hierarchy=fake_hierarchy(gap=0.01))
    summary = json.loads((run.report / "summary.json").read_text(encoding="utf-8"))
    sentences = [headline["sentence"] for scene in summary["scenes"] for headline in scene["headlines"]]
    assert len(sentences) == 4
    lines = run.out.splitlines()
    last = next(number for number, line in enumerate(lines) if line.startswith("Report: "))
    assert lines[last - 4 : last] == sentences
    text = (run.report / "summary.md").read_text(encoding="utf-8")
    assert all(sentence.split("(")[0].split(": ", 1)[1] in text for sentence in sentences)


def test_the_next_commands_work_as_they_are_printed(
    command: Callable[..., Run], capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    run = command("fig3-I", "--grid", "2", hierarchy=errors_in({"translational": 0.01, "spatial": 0.1}))
    film, finer = after_report(run)[2:]
    words = shlex.split(film.split("difference: ")[1])
    assert words[:3] == ["python", "-m", "multibody.animate"]
    assert (words[3], words[4], words[7:]) == ("fig3-I", "--phases", ["--model", "spatial"])
    assert all(0.0 <= float(phase) < 6.2832 for phase in words[5:7])
    words = shlex.split(finer.split("costs: ")[1])
    assert words[:3] == ["python", "-m", "comparison.run"]
    assert words.count("--grid") == 1
    assert main([*words[3:], "--out", str(tmp_path / "other")], fake_hierarchy(), ThreadPoolExecutor) == 0
    assert "4 x 4 phases" in capfd.readouterr().out.replace("\n", " ")


def test_a_command_that_changed_the_loading_offers_no_film_of_another(command: Callable[..., Run]) -> None:
    run = command("fig3-I", "--grid", "2", "--amplitude", "0.5", hierarchy=errors_in({"spatial": 0.1}))
    assert not any("multibody.animate" in line for line in after_report(run))


def test_a_scene_of_a_file_is_filmed_from_its_file(command: Callable[..., Run], tmp_path: Path) -> None:
    place = tmp_path / "my scene.toml"
    place.write_text((SCENES / "fig3-I.toml").read_text(encoding="utf-8"), encoding="utf-8")
    run = command(str(place), "--grid", "2", hierarchy=errors_in({"spatial": 0.1}))
    assert f"multibody.animate '{place}' --phases" in run.out


def test_a_record_has_no_grid_to_refine(command: Callable[..., Run]) -> None:
    assert after_report(command("synthetic-pair", hierarchy=fake_hierarchy()))[2:] == []
