# ruff: noqa: E501 (a sentence stands on one line where it can)
"""Whatever a reader must know before trusting a number is an alert, and nothing else is."""

from collections.abc import Callable
from xml.etree import ElementTree

import numpy as np
import pytest
from fake_models import errors_in
from report_texts import summary_of
from runs import Run
from studies import solved

import reference
from comparison.study.study import Study
from comparison.surfaces.alerts import list_alerts
from comparison.surfaces.missing_values import MissingValues, OutcomeNote
from reference.problem import Outcome, load_scene


def test_a_sound_run_has_no_alert_and_its_limits_hold(command: Callable[..., Run]) -> None:
    words = ["fig3-I", "--grid", "4", "--only", "differences"]
    report = command(*words, hierarchy=errors_in({"small": 0.02})).report
    assert summary_of(report)["alerts"] == []
    assert "**5 acceptance limits hold. Not checked, as no limit is stated: total, " in (
        report / "summary.md"
    ).read_text(encoding="utf-8")
    suites = ElementTree.parse(report / "junit.xml").getroot()
    assert (suites.get("tests"), suites.get("failures")) == ("7", "0")
    for error, found in ((0.4, []), (0.6, [("red", "refused"), ("red", "limit")])):  # more than half of a value is none
        worthless = command(*words, hierarchy=errors_in({}, {"spatial": error})).report
        assert [(each["level"], each["kind"]) for each in summary_of(worthless)["alerts"]] == found


PHASES = np.array([(0.3, 1.1), (2.0, 0.7), (4.0, 5.5)])
STRONG = load_scene("fig3-I", amplitude=2.5).with_values({"isolator.friction": 0.05, "duration": 8.0})


@pytest.mark.parametrize(
    ("scene", "equations", "regularization"),
    [
        (STRONG, "exact", None),
        (STRONG, "small", 1e-3),
        (load_scene("fig4-viscous"), "exact", None),
        (load_scene("fig3-I").with_values({"isolator.friction": 0.0}), "small", None),
        (load_scene("synthetic-pair"), "exact", None),
    ],
    ids=["set-valued", "v_reg", "lubricated", "a sum of harmonics", "record"],
)
def test_the_share_of_the_equations_is_that_of_a_dense_motion(scene, equations, regularization):
    times = np.linspace(0.0, scene.duration, 40_001)
    motions = [reference.trajectory(scene, phase, equations, regularization, 1e-9, times=times) for phase in PHASES]
    expected = [np.hypot(*motion.position[:, 0, :2].T).max() / scene.radius for motion in motions]
    found = reference.amplification(scene, PHASES, equations, regularization)
    np.testing.assert_allclose(found.cap_share, expected, rtol=2e-4)


def test_a_motion_close_to_the_rim_is_seen():
    scene = load_scene("fig3-I").with_values({"isolator.friction": 0.0, "duration": 3.0})
    shares = [reference.amplification(scene.with_amplitude(a), PHASES[:1]).cap_share[0] for a in (4.0, 5.0)]
    assert 0.5 < shares[0] < shares[1] < 1.0
    lost = reference.amplification(scene.with_amplitude(100.0), PHASES[:1])
    assert lost.status[0] != Outcome.OK
    assert np.isnan(lost.cap_share).all()


@pytest.mark.parametrize(
    ("share", "said"),  # of rho; the travel is half of it
    [
        (0.449, []),
        (0.452, [("travel", "uses up to 90.4 % of the isolator's travel")]),
        (0.498, [("travel", "uses up to 99.6 % of the isolator's travel")]),
        (0.501, [("swing", "moves up to 50.1 % of rho from the middle"), ("travel", "uses up to 100.2 % of the isolator's travel")]),
    ],
)  # fmt: skip
def test_a_far_motion_is_told_with_its_model_share_and_base(share: float, said: list[tuple[str, str]]) -> None:
    scene = load_scene("fig3-I")
    scene = scene.with_values({"isolator.travel": 0.5 * scene.radius})
    study = Study((scene,), 2, 1e-3, errors_in({}))
    surfaces = solved(study)
    place = {"model": "spatial", "alpha1": surfaces["alpha1"][1], "alpha2": surfaces["alpha2"][0]}
    surfaces["cap_share"].loc[place] = share
    surfaces["displacement"].loc[place] = share * scene.radius
    found = list_alerts(study, surfaces, [], [], [])
    assert [(each.kind, each.text) for each in found] == [
        (kind, f"spatial engine: the platform {text}") for kind, text in said
    ]
    assert {each.level for each in found} <= {"amber"}


@pytest.mark.parametrize(
    ("points", "unusable", "outcomes", "used", "said"),
    [
        (4, 0, {"rim reached": 4}, False, "red refused: no value at any of 4 phase pairs: rim reached; comparisons leave this model out"),
        (3, 1, {"rim reached": 2, "step limit": 1}, False, "red refused: no value at 3 of 4 phase pairs, only values with errors above "
         "half of them at 1 of 4 phase pairs: 2 × rim reached, 1 × step limit; comparisons leave this model out"),
        (1, 0, {"rim reached": 1}, True, "amber lacking: no value at 1 of 4 phase pairs: 1 × rim reached"),
        (0, 1, {}, True, "amber lacking: only values with errors above half of them at 1 of 4 phase pairs"),
    ],
)  # fmt: skip
def test_a_gap_is_told_with_its_counts_and_outcomes(
    points: int, unusable: int, outcomes: dict[str, int], used: bool, said: str
) -> None:
    notes = tuple(OutcomeNote(outcome, count, f"help for {outcome}") for outcome, count in outcomes.items())
    lacking = MissingValues("fig3-I", "spatial", "spatial engine", points, unusable, 4, used, notes)
    study = Study((load_scene("fig3-I"),), 2, 1e-3, errors_in({}))
    (found,) = list_alerts(study, solved(study), [lacking], [], [])
    assert f"{found.level} {found.kind}: {found.text}" == said.replace(": ", ": spatial engine: ", 1)
    assert found.help == "; ".join(f"help for {outcome}" for outcome in outcomes)
