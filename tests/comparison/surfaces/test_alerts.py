# ruff: noqa: E501 (a sentence stands on one line where it can)
"""Whatever a reader must know before trusting a number is an alert, and nothing else is."""

from collections.abc import Callable
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
from fake_models import errors_in, fake_hierarchy
from report_texts import summary_of
from runs import RUN, Run
from studies import solved

import reference
from comparison.registry import make_report
from comparison.study.models import MODEL_HIERARCHY
from comparison.study.study import Study
from comparison.surfaces.acceptance import check_limits
from comparison.surfaces.alerts import list_alerts
from comparison.surfaces.body_comparison import compare_bodies
from comparison.surfaces.missing_values import MissingValues, OutcomeNote, advise_on_outcome, list_missing_values
from reference.problem import Outcome, load_scene
from reference.problem.outcome import ADVICE


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


def test_a_broken_limit_of_any_scene_is_an_alert() -> None:
    study = Study((load_scene("fig3-I"), load_scene("fig3-II")), 4, 1e-3, fake_hierarchy())
    results = make_report(study, solved(study), {}, [], RUN, families=()).results
    broken = [(scene.name, limit.key) for scene in results.scenes for limit in scene.limits if limit.breaches]
    assert {(each.scene, each.text.split(":")[1]) for each in results.alerts if each.kind == "limit"} == {
        (scene, f" acceptance.{key}") for scene, key in broken
    }
    assert len({scene for scene, _ in broken}) == 2


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
    other = replace(lacking, title="another", points=0, unusable=2, used=True, outcomes=())
    found, second = (
        next(
            each for each in list_alerts(study, solved(study), [other, lacking], [], []) if each.text.startswith(title)
        )
        for title in ("spatial", "another")
    )
    assert second.text == "another: only values with errors above half of them at 2 of 4 phase pairs"
    assert f"{found.level} {found.kind}: {found.text}" == said.replace(": ", ": spatial engine: ", 1)
    assert found.help == "; ".join(f"help for {outcome}" for outcome in outcomes)


def test_points_of_every_model_and_unusable_ones_count_as_failed() -> None:
    scene = load_scene("fig3-I").with_values({"acceptance.failed": 3})
    study = Study((scene,), 2, 1e-3, errors_in({}))
    gaps = [
        MissingValues("fig3-I", key, key, points, unusable, 4, True, ())
        for key, points, unusable in (("small", 1, 0), ("translational", 0, 1), ("spatial", 1, 1))
    ]
    limits = {limit.key: limit for limit in check_limits(compare_bodies(study, solved(study), scene), gaps)}
    assert limits["failed"].breach_texts == [
        "acceptance.failed: 4 points without an answer (small 1 of 4, translational 1 of 4, spatial 2 of 4), 3 allowed",
    ]


def test_the_advice_is_that_of_the_outcome_and_for_an_engine_of_the_user_what_it_reported() -> None:
    scene, model = load_scene("fig3-I"), MODEL_HIERARCHY[-1]
    study = Study((scene,), 2, 1e-3, MODEL_HIERARCHY)
    reported = {Outcome.SOLVER_FAILED, Outcome.TIME_LIMIT, Outcome.WORKER_DIED}
    for outcome in Outcome:
        assert advise_on_outcome(study, scene, model, outcome) == ADVICE[outcome]
        own = advise_on_outcome(study, scene, replace(model, side="user"), outcome)
        assert own == ("see what the solvers reported" if outcome in reported else ADVICE[outcome])


def test_a_pair_counts_the_phases_at_which_either_model_is_not_ok() -> None:
    scene = load_scene("fig3-I")
    study = Study((scene,), 2, 1e-3, errors_in({}))
    surfaces = solved(study)
    for model, places in (("small-resolved", [(0, 0), (0, 1)]), ("spatial", [(0, 1), (1, 0), (1, 1)])):
        for a, b in places:
            status = surfaces["status"].sel(scene="fig3-I", model=model)
            status[{"alpha1": a, "alpha2": b}] = Outcome.TOLERANCE_NOT_MET.value
    total = compare_bodies(study, surfaces, scene)[0].total
    assert (total.first, total.second, total.not_ok) == ("small-resolved", "spatial", 4)


def test_a_phase_pair_where_one_body_has_no_value_is_one_without_an_answer() -> None:
    scene = load_scene("fig3-I")
    study = Study((scene,), 2, 1e-3, errors_in({}))
    surfaces = solved(study)
    place = {"model": "spatial", "alpha1": surfaces["alpha1"][1], "alpha2": surfaces["alpha2"][0]}
    surfaces["mu"].loc[{**place, "body": 2}] = np.nan
    (gap,) = list_missing_values(study, surfaces)
    assert (gap.model, gap.points, gap.unusable, gap.asked) == ("spatial", 1, 0, 4)
