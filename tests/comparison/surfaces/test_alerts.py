"""Whatever a reader must know before trusting a number is an alert, and nothing else is."""

from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from fake_models import errors_in, fake_hierarchy
from report_texts import Tables, page_of, summary_of
from runs import Run

import reference
from comparison.runner.cache import Cache
from comparison.runner.task import TaskResult
from comparison.runner.task_results import TaskResults
from comparison.study.batches import execute_batch
from comparison.study.models import MODEL_HIERARCHY
from comparison.study.study import Study
from comparison.surfaces.alerts import alerts
from comparison.surfaces.surfaces import labeled_surfaces, largest_cap_share, surface_tasks
from reference import amplification
from reference.problem import Outcome, Scene, load_scene, phase_grid
from reference.problem.scene_file import scene_text

GRID = ["fig3-I", "--grid", "4", "--only", "differences"]


def listed(run: Run) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = summary_of(run.report)["alerts"]
    return found


def test_a_sound_run_has_no_alert_and_its_limits_hold(command: Callable[..., Run]) -> None:
    run = command(*GRID, hierarchy=errors_in({"small": 0.02}))
    assert listed(run) == []
    assert "**Every acceptance limit holds.**" in (run.report / "summary.md").read_text(encoding="utf-8")
    suites = ElementTree.parse(run.report / "junit.xml").getroot()
    assert (suites.get("tests"), suites.get("failures")) == ("5", "0")


def test_a_missing_point_is_amber_behind_a_broken_limit(command: Callable[..., Run]) -> None:
    run = command(*GRID, hierarchy=fake_hierarchy("failing_point"))
    alerts = listed(run)
    assert {(alert["kind"], alert["level"]) for alert in alerts} == {("limit", "red"), ("lacking", "amber")}
    assert [alert["level"] for alert in alerts] == sorted((alert["level"] for alert in alerts), reverse=True)
    assert any("1 of 16 phase pairs: 1 × rim reached" in alert["text"] for alert in alerts)
    lost = "- fig3-I, translational engine: 1 × rim reached"
    assert lost in (run.report / "summary.md").read_text(encoding="utf-8")
    assert "Limit broken: fig3-I: acceptance.failed: 2 points without an answer" in run.out


def test_a_travel_that_is_nearly_used_up_is_said_with_its_share(command: Callable[..., Run], tmp_path: Path) -> None:
    shares = amplification(load_scene("fig3-I"), phase_grid(3)).cap_share
    share = shares.max()
    assert share > 1.05 * shares.mean()
    file = tmp_path / "limited.toml"
    travel = float(share * load_scene("fig3-I").radius / 0.95)
    text = scene_text("fig3-I").decode()
    file.write_text(text.replace("[isolator]", f"[isolator]\ntravel = {travel!r}"), encoding="utf-8")
    run = command(str(file), "--grid", "3", hierarchy=MODEL_HIERARCHY[:2])
    assert run.code == 0, run.err
    texts = [alert["text"] for alert in listed(run) if alert["kind"] == "travel"]
    assert any("uses up to 95.0 % of the isolator's travel" in text for text in texts)
    summary = summary_of(run.report)
    assert summary["scenes"][0]["models"]["exact"]["travel_share"] == pytest.approx(0.95, rel=1e-3)
    [row] = [
        row
        for row in Tables(page_of(run.report)).headed("% of the travel", "displacement, % of ρ")
        if row["model"] == "exact equations"
    ]
    assert (row["% of the travel"], float(row["displacement, % of ρ"])) == (
        "95",
        pytest.approx(100.0 * share, rel=5e-3),
    )


PHASES = np.array([(0.3, 1.1), (2.0, 0.7), (4.0, 5.5)])


def strong() -> Scene:
    return load_scene("fig3-I", amplitude=2.5).with_values({"isolator.friction": 0.05, "duration": 8.0})


def sampled(scene: Scene, phase: np.ndarray, equations: str, regularization: float | None) -> float:
    times = np.linspace(0.0, scene.duration, 40_001)
    run = reference.trajectory(scene, phase, equations, regularization, 1e-9, times=times)
    return float(np.hypot(*run.position[:, 0, :2].T).max() / scene.radius)


@pytest.mark.parametrize(
    ("scene", "equations", "regularization"),
    [
        (strong(), "exact", None),
        (strong(), "small", 1e-3),
        (load_scene("fig4-viscous"), "exact", None),
        (load_scene("fig3-I").with_values({"isolator.friction": 0.0}), "small", None),
        (load_scene("synthetic-pair"), "exact", None),
    ],
    ids=["set-valued", "v_reg", "lubricated", "a sum of harmonics", "record"],
)
def test_the_share_of_the_equations_is_that_of_a_dense_motion(scene, equations, regularization):
    found = reference.amplification(scene, PHASES, equations, regularization)
    expected = [sampled(scene, phase, equations, regularization) for phase in PHASES]
    np.testing.assert_allclose(found.cap_share, expected, rtol=2e-4)


def test_a_motion_close_to_the_rim_is_seen():
    scene = load_scene("fig3-I").with_values({"isolator.friction": 0.0, "duration": 3.0})
    shares = [reference.amplification(scene.with_amplitude(a), PHASES[:1]).cap_share[0] for a in (4.0, 5.0)]
    assert 0.5 < shares[0] < shares[1] < 1.0
    lost = reference.amplification(scene.with_amplitude(100.0), PHASES[:1])
    assert lost.status[0] != Outcome.OK
    assert np.isnan(lost.cap_share).all()


def test_the_share_is_stored_joined_labeled_and_said(tmp_path: Path) -> None:
    scene = load_scene("fig3-I").with_values({"isolator.friction": 0.0, "duration": 2.0}).with_amplitude(5.0)
    wider = scene.with_values({"name": "wider", "isolator.period": 2.0 * scene.isolator.period})
    study = Study((scene, wider), 2, 1e-3, MODEL_HIERARCHY[:1])
    batches = study.batches()
    answers = [execute_batch(batch) for batch in batches]
    for task, answer in zip(surface_tasks(study), answers):
        TaskResults(Cache(tmp_path)).put(task, TaskResult(answer, 0.0))
        kept = TaskResults(Cache(tmp_path))
        assert kept.missing([task]) == []
        np.testing.assert_array_equal(kept[task].value.displacement, answer.displacement)
        halves = task.argument.halves()
        if halves:
            joined = task.argument.join([*map(execute_batch, halves)])
            np.testing.assert_allclose(joined.displacement, answer.displacement, rtol=1e-9)
    surfaces = labeled_surfaces(study, batches, answers)
    largest = (
        max(answer.displacement.max() for task, answer in zip(batches, answers) if task.scene == scene) / scene.radius
    )
    units = {name: surfaces[name].attrs["units"] for name in ("displacement", "cap_share", "mu", "instant", "cost")}
    assert units == {"displacement": "m", "cap_share": "1", "mu": "1", "instant": "s", "cost": "s"}
    for each in study.scenes:
        found = surfaces.sel(scene=each.name)
        np.testing.assert_allclose(found["displacement"], each.radius * found["cap_share"], rtol=1e-12)
    assert largest_cap_share(surfaces, scene.name, MODEL_HIERARCHY[0].key) == largest > 0.5
    swings = [alert for alert in alerts(study, surfaces, [], [], []) if alert.kind == "swing"]
    assert [alert.level for alert in swings] == ["amber"]
    assert f"{100.0 * largest:.1f} % of rho" in swings[0].text
