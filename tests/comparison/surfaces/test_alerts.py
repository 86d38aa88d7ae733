"""Whatever a reader must know before trusting a number is an alert, and nothing else is."""

from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from fake_models import errors_in
from report_texts import summary_of
from runs import Run

import reference
from comparison.runner.cache import Cache
from comparison.runner.task import TaskResult
from comparison.runner.task_results import TaskResults
from comparison.study.batches import execute_batch
from comparison.study.models import MODEL_HIERARCHY
from comparison.study.study import Study
from comparison.surfaces.surfaces import labeled_surfaces, largest_cap_share, surface_tasks
from reference.problem import Outcome, Scene, load_scene


def test_a_sound_run_has_no_alert_and_its_limits_hold(command: Callable[..., Run]) -> None:
    words = ["fig3-I", "--grid", "4", "--only", "differences"]
    report = command(*words, hierarchy=errors_in({"small": 0.02})).report
    assert summary_of(report)["alerts"] == []
    assert "**Every acceptance limit holds.**" in (report / "summary.md").read_text(encoding="utf-8")
    suites = ElementTree.parse(report / "junit.xml").getroot()
    assert (suites.get("tests"), suites.get("failures")) == ("5", "0")
    for error, found in (
        (0.4, []),
        (0.6, [("red", "refused"), ("red", "limit")]),
    ):  # of the value: more than half of it is none
        worthless = command(*words, hierarchy=errors_in({}, {"spatial": error})).report
        assert [(each["level"], each["kind"]) for each in summary_of(worthless)["alerts"]] == found


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


def test_the_share_is_stored_and_joined(tmp_path: Path) -> None:
    scene = load_scene("fig3-I").with_values({"isolator.friction": 0.0, "duration": 2.0}).with_amplitude(5.0)
    study = Study((scene,), 2, 1e-3, MODEL_HIERARCHY[:1], full=True)
    [task] = surface_tasks(study)
    answer = execute_batch(task.argument)
    TaskResults(Cache(tmp_path)).put(task, TaskResult(answer, 0.0))
    again = TaskResults(Cache(tmp_path))
    assert again.missing([task]) == []
    np.testing.assert_array_equal(again[task].value.displacement, answer.displacement)
    joined = task.argument.join([*map(execute_batch, task.argument.halves())])
    np.testing.assert_allclose(joined.displacement, answer.displacement, rtol=1e-9)
    surfaces = labeled_surfaces(study, [task.argument], [answer])
    assert largest_cap_share(surfaces, scene.name, "small") == answer.displacement.max() / scene.radius > 0.5
