"""What `--tolerance` and `--budget` choose: the cheapest that meets the accuracy, the most ambitious that fits."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace

import pytest
from conftest import Run

from comparison.study import costs as cost_of
from comparison.study import planning as planning
from comparison.study.accuracy_record import FILE, SHARE, AccuracyRecord, RecordedModels, recorded
from comparison.study.models import EXACT, MODEL_HIERARCHY, TRANSLATIONAL
from comparison.study.planning import (
    DEFAULT_PRESET,
    STUDY_PRESETS,
    BudgetError,
    StudyRequest,
    plan_study,
    setting,
    tightest,
)
from comparison.study.speedup import speedup
from comparison.study.study import Study
from reference.problem import load_scene

SCENE = load_scene("fig3-I")
NEW = SCENE.with_values({"duration": 5.0})  # not in the record
TOLERANCES = (1e-2, 5e-3, 1e-3, 3e-4, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8)


@pytest.fixture(autouse=True)
def unmeasured(monkeypatch: pytest.MonkeyPatch) -> None:
    """This machine is as fast as that of the record, and a pilot costs a tenth of a second a point."""
    monkeypatch.setattr(cost_of, "machine_benchmark", lambda: recorded().machine_benchmark)
    monkeypatch.setattr(cost_of, "_trial_run", lambda *rest: 0.1)


def accuracy(tolerances: tuple[float, ...], costs: tuple[float, ...], met: tuple[bool, ...]) -> RecordedModels:
    return RecordedModels("here", {}, {"exact": AccuracyRecord(tolerances, costs, met)}, {})


@pytest.mark.parametrize("tolerance", TOLERANCES)
@pytest.mark.parametrize("model", MODEL_HIERARCHY, ids=lambda model: model.key)
def test_no_recorded_setting_that_meets_the_tolerance_is_cheaper(model: object, tolerance: float) -> None:
    record = recorded().accuracy[model.key]
    able = [cost for asked, cost, met in zip(record.tolerances, record.costs, record.met) if met and asked <= tolerance]
    if tolerance < record.tightest:
        assert not able
        return
    chosen = setting(model, tolerance)
    assert chosen <= tolerance
    assert record.cost(chosen) <= planning.HARDLY_MORE * min(able, default=record.cost(tolerance))


def test_the_cheapest_wins_and_a_tighter_one_for_nearly_the_same_is_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    met = (True, True, True)
    monkeypatch.setattr(planning, "recorded", lambda: accuracy((1e-2, 1e-3, 1e-4), (1.0, 1.04, 2.0), met))
    assert setting(EXACT, 1e-2) == 1e-3
    assert setting(EXACT, 5e-4) == 5e-4, "between two, at a cost between theirs"
    monkeypatch.setattr(planning, "recorded", lambda: accuracy((1e-2, 1e-3, 1e-4), (3.0, 1.0, 2.0), met))
    assert setting(EXACT, 1e-2) == 1e-3, "looser may be dearer"


def test_a_setting_that_missed_its_tolerance_in_the_record_is_not_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        planning, "recorded", lambda: accuracy((1e-2, 1e-3, 1e-4), (1.5, 1.0, 2.0), (True, False, True))
    )
    assert setting(EXACT, 1e-2) == 1e-2


def test_between_recorded_tolerances_the_cost_lies_between_theirs() -> None:
    record = AccuracyRecord((1e-2, 1e-4), (1.0, 4.0), (True, True))
    assert record.cost(1e-3) == pytest.approx(2.0)
    assert (record.cost(1e-1), record.cost(1e-9)) == pytest.approx((1.0, 4.0))


def test_what_is_recorded_as_met_was_met_at_99_percent_in_truth_and_by_the_estimates() -> None:
    models = json.loads(FILE.read_text(encoding="utf-8"))["models"]
    assert set(models) == {model.key for model in MODEL_HIERARCHY}
    for key, model in models.items():
        assert any(recorded().accuracy[key].met)
        for row, met in zip(model["tolerances"], recorded().accuracy[key].met, strict=True):
            assert met <= (row["met"] >= SHARE and row["met_by_estimate"] >= SHARE)
            assert met <= (10.0 * row["reference_tolerance"] <= 1.001 * row["tolerance"]), (
                "nothing is its own reference solution"
            )


def test_models_that_cannot_meet_the_tolerance_are_omitted_and_named() -> None:
    plan = plan_study(StudyRequest((SCENE,), tolerance=1e-6))
    assert [model.key for model in plan.study.hierarchy] == ["small", "exact", "resolved", "regularised"]
    assert len(plan.omitted) == 2
    assert plan.omitted[0].startswith("translational engine: cannot meet 1e-06, the tightest it is known to meet is")


def test_without_an_option_the_study_is_the_default_one_and_nothing_is_measured(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def forbidden() -> None:
        raise AssertionError("nothing should be measured")

    monkeypatch.setattr(cost_of, "machine_benchmark", forbidden)
    plan = plan_study(StudyRequest((SCENE, NEW.with_values({"name": "new"}))))
    assert plan.study.grid == 48
    assert [(model.key, model.tolerance(1e-3), model.most) for model in plan.study.hierarchy] == [
        (model.key, 1e-6 if model.side == "reference" else 1e-3, model.most) for model in MODEL_HIERARCHY
    ]
    assert plan.with_analyses


def analysis_cost(study: Study, with_analyses: bool) -> float:
    """A report without all that it may have takes 10 s of the workers, all of it 40 s."""
    return 40.0 if with_analyses else 10.0


def test_no_preset_asks_for_what_a_model_cannot_do() -> None:
    measured = cost_of.costs((SCENE,), MODEL_HIERARCHY, False)
    assert len(STUDY_PRESETS) > DEFAULT_PRESET
    for preset in STUDY_PRESETS[DEFAULT_PRESET:]:
        assert planning._plan(preset, StudyRequest((SCENE,), budget=1.0), measured).omitted == ()


def test_every_preset_costs_more_than_the_one_before() -> None:
    scenes = tuple(load_scene(name) for name in ("fig3-I", "fig4-viscous"))
    measured = cost_of.costs(scenes, MODEL_HIERARCHY, False)
    wall = [
        planning._plan(preset, StudyRequest(scenes, budget=1.0, analysis_cost=analysis_cost), measured).wall
        for preset in STUDY_PRESETS
    ]
    assert wall == sorted(wall)
    assert len(set(wall)) == len(wall)


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_budget_takes_the_last_study_that_fits(jobs: int) -> None:
    asked = StudyRequest((SCENE,), budget=1e6, jobs=jobs, analysis_cost=analysis_cost)
    measured = cost_of.costs(asked.scenes, MODEL_HIERARCHY, True)
    walls = [planning._plan(preset, asked, measured).wall for preset in STUDY_PRESETS]
    for number, wall in enumerate(walls):
        plan = plan_study(replace(asked, budget=1.001 * wall + 0.5))
        last = max(planning for planning, other in enumerate(walls) if other <= 1.001 * wall + 0.5)
        assert last >= number
        assert plan.wall == pytest.approx(walls[last])
        assert plan.wall <= 1.001 * wall + 0.5


def test_a_budget_that_nothing_fits_says_what_the_least_costs() -> None:
    with pytest.raises(BudgetError, match=r"the smallest study of fig3-I takes about \d+ s here with 1 worker: give"):
        plan_study(StudyRequest((SCENE,), budget=1.0))


def test_tolerance_and_grid_that_are_given_stay_as_they_are_under_a_budget() -> None:
    plan = plan_study(StudyRequest((SCENE,), tolerance=1e-4, budget=1e6, grid=20))
    assert (plan.study.grid, plan.study.tolerance) == (20, 1e-4)
    assert {model.key: model.asks for model in plan.study.hierarchy}["translational"] == pytest.approx(1e-4)
    assert plan_study(StudyRequest((SCENE,), budget=1e6)).study.tolerance == STUDY_PRESETS[-1].tolerance


def test_a_slower_machine_and_a_longer_motion_are_expected_to_take_longer(monkeypatch: pytest.MonkeyPatch) -> None:
    usual = plan_study(StudyRequest((SCENE,), tolerance=1e-3)).compute
    monkeypatch.setattr(
        cost_of, "machine_benchmark", lambda: {key: 2.0 * s for key, s in recorded().machine_benchmark.items()}
    )
    assert plan_study(StudyRequest((SCENE,), tolerance=1e-3)).compute == pytest.approx(2.0 * usual)


def test_a_scene_that_is_not_in_the_record_is_tried_and_others_of_its_family_go_by_that() -> None:
    family = tuple(NEW.with_values({"name": f"new[{n}]", "duration": 5.0 + n}) for n in range(4))
    seconds = cost_of.costs(family, MODEL_HIERARCHY, True).seconds
    assert seconds["new[0]", "translational"] == seconds["new[3]", "translational"] == 0.1
    assert seconds["new[0]", "exact"] == 0.1
    # the two that were tried cost 0.1 s for 5 and 8 s of motion: between them in proportion to the duration
    assert seconds["new[2]", "translational"] == pytest.approx(0.5 * (0.1 / 5.0 + 0.1 / 8.0) * 7.0)


def test_models_under_another_name_keep_their_own_cost() -> None:
    other = replace(TRANSLATIONAL, amplification="somewhere:else", seconds_per_point=3.0)
    plan = plan_study(StudyRequest((SCENE,), (EXACT, other), tolerance=1e-7))
    assert plan.study.hierarchy[1] is other
    assert plan.study.seconds_of(SCENE, other) == pytest.approx(
        3.0 * len(plan.study.solved(SCENE, other)) / speedup(SCENE, other)
    )


def test_the_run_says_what_it_chose_and_what_it_got(command: Callable[..., Run]) -> None:
    run = command("fig3-I", "--grid", "2", "--tolerance", "1e-2", "--jobs", "1")
    assert run.code == 0, run.err
    assert "Chosen for --tolerance 0.01" in run.out
    assert "small equations: 0.01 met at 100 % of 4 points by the error estimates" in run.out
    kept = json.loads((run.report / "summary.json").read_text(encoding="utf-8"))["run"]["choice"]
    assert kept["tolerance"] == 0.01
    assert [model["met"] for model in kept["models"]] == [1.0] * 6
    assert "0.01 met at" in (run.report / "index.html").read_text(encoding="utf-8")


def test_without_the_options_nothing_is_chosen_or_said(command: Callable[..., Run]) -> None:
    run = command("fig3-I", "--grid", "2")
    assert "Chosen for" not in run.out
    assert json.loads((run.report / "summary.json").read_text(encoding="utf-8"))["run"]["choice"] is None


def test_an_impossible_budget_is_one_line(command: Callable[..., Run]) -> None:
    run = command("fig3-I", "--budget", "1")
    assert run.code == 2
    assert run.err.startswith("command line: --budget = 1.0: the smallest study of fig3-I takes about ")
    assert run.err.count("\n") == 1
    assert not run.report.exists()


def test_a_budget_leaves_out_what_a_report_can_do_without(command: Callable[..., Run]) -> None:
    """Fake models cost what their models say; the smallest study is without motions, claims and assumptions."""
    run = command("fig3-I", "--budget", "40", "--grid", "2", "--jobs", "1")
    assert run.code == 0, run.err
    assert "they do not fit the budget" in run.out
    page = (run.report / "index.html").read_text(encoding="utf-8")
    assert "assumptions carry: " in page.split('id="absent"')[1]


def test_the_tightest_tolerance_is_one_that_some_model_meets() -> None:
    assert tightest() == min(record.tightest for record in recorded().accuracy.values())


def test_the_default_preset_is_the_default_hierarchy() -> None:
    most = {model.key: model.most for model in MODEL_HIERARCHY}
    assert (STUDY_PRESETS[DEFAULT_PRESET].translational, STUDY_PRESETS[DEFAULT_PRESET].spatial) == (
        most["translational"],
        most["spatial"],
    )
