"""Whatever a reader must know before trusting a number is an alert, and nothing else is."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from fake_models import errors_in, fake_hierarchy, silenced
from report_texts import page_of, summary_of
from runs import Run

from comparison.study.models import MODEL_HIERARCHY
from reference import amplification
from reference.problem import load_scene, phase_grid
from reference.problem.scene_file import scene_text

GRID = ["fig3-I", "--grid", "4"]


def listed(run: Run) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = summary_of(run.report)["alerts"]
    return found


def test_a_sound_run_has_no_alert(command: Callable[..., Run]) -> None:
    assert listed(command(*GRID, hierarchy=errors_in({}))) == []


def test_a_refused_model_is_red_and_says_what_helps(command: Callable[..., Run]) -> None:
    run = command(*GRID, hierarchy=silenced("spatial"))
    refused = next(alert for alert in listed(run) if alert["kind"] == "refused")
    assert (refused["level"], refused["scene"]) == ("red", "fig3-I")
    assert refused["text"].startswith("spatial engine: no value at any of 16 phase pairs")
    assert "shorten the duration to 7 s" in refused["help"]
    assert refused["text"] in run.out
    assert "shorten the duration to 7 s" in run.out


def test_a_missing_point_is_amber_behind_a_broken_limit(command: Callable[..., Run]) -> None:
    run = command(*GRID, hierarchy=fake_hierarchy("failing_point"))
    alerts = listed(run)
    assert {(alert["kind"], alert["level"]) for alert in alerts} == {("limit", "red"), ("lacking", "amber")}
    assert [alert["level"] for alert in alerts] == sorted((alert["level"] for alert in alerts), reverse=True)
    assert any("1 of 16 phase pairs: 1 × rim reached" in alert["text"] for alert in alerts)
    assert "Limit broken: fig3-I: acceptance.failed: 2 points without an answer" in run.out


def test_a_travel_that_is_nearly_used_up_is_said_with_its_share(command: Callable[..., Run], tmp_path: Path) -> None:
    share = amplification(load_scene("fig3-I"), phase_grid(2)).cap_share.max()
    file = tmp_path / "limited.toml"
    travel = float(share * load_scene("fig3-I").radius / 0.95)
    text = scene_text("fig3-I").decode()
    file.write_text(text.replace("[isolator]", f"[isolator]\ntravel = {travel!r}"), encoding="utf-8")
    run = command(str(file), "--grid", "2", hierarchy=MODEL_HIERARCHY[:2])
    assert run.code == 0, run.err
    texts = [alert["text"] for alert in listed(run) if alert["kind"] == "travel"]
    assert any("uses up to 95.0 % of the isolator's travel" in text for text in texts)
    summary = summary_of(run.report)
    assert summary["scenes"][0]["models"]["exact"]["travel_share"] == pytest.approx(0.95, rel=1e-3)
    assert "% of the travel" in page_of(run.report)
