"""What `--tolerance` chooses: the cheapest that meets the accuracy; and what a study is predicted to cost."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from conftest import Run

from comparison.study import costs as cost_of
from comparison.study import planning as planning
from comparison.study.accuracy_record import HARDLY_MORE, SHARE, SHIPPED, AccuracyRecord, recorded
from comparison.study.batches import imported
from comparison.study.models import EXACT, MODEL_HIERARCHY, REGULARIZED, SPATIAL, TRANSLATIONAL, Model
from comparison.study.planning import StudyRequest, plan_study, tightest
from reference.problem import Scene, load_scene

SCENE = load_scene("fig3-I")
NEW = SCENE.with_values({"duration": 5.0})  # not in the record
TOLERANCES = (1e-2, 5e-3, 1e-3, 3e-4, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8)


@pytest.mark.parametrize("tolerance", TOLERANCES)
@pytest.mark.parametrize("model", MODEL_HIERARCHY, ids=lambda model: model.key)
def test_no_recorded_setting_that_meets_the_tolerance_is_cheaper(model: object, tolerance: float) -> None:
    record = recorded().accuracy[model.key]
    able = [cost for asked, cost, met in zip(record.tolerances, record.costs, record.met) if met and asked <= tolerance]
    if tolerance < record.tightest:
        assert not able
        return
    chosen = record.setting(tolerance)
    assert chosen <= tolerance
    assert record.cost(chosen) <= HARDLY_MORE * min(able, default=record.cost(tolerance))


def test_the_cheapest_wins_and_a_tighter_one_for_nearly_the_same_is_taken() -> None:
    record = AccuracyRecord((1e-2, 1e-3, 1e-4), (1.0, 1.04, 2.0), (True, True, True))
    assert record.setting(1e-2) == 1e-3
    assert record.setting(5e-4) == 5e-4, "between two, at a cost between theirs"
    looser_is_dearer = AccuracyRecord((1e-2, 1e-3, 1e-4), (3.0, 1.0, 2.0), (True, True, True))
    assert looser_is_dearer.setting(1e-2) == 1e-3


def test_a_setting_that_missed_its_tolerance_in_the_record_is_not_taken() -> None:
    record = AccuracyRecord((1e-2, 1e-3, 1e-4), (1.5, 1.0, 2.0), (True, False, True))
    assert record.setting(1e-2) == 1e-2


def test_between_recorded_tolerances_the_cost_lies_between_theirs() -> None:
    record = AccuracyRecord((1e-2, 1e-4), (1.0, 4.0), (True, True))
    assert record.cost(1e-3) == pytest.approx(2.0)
    assert (record.cost(1e-1), record.cost(1e-9)) == pytest.approx((1.0, 4.0))


def test_what_is_recorded_as_met_was_met_at_99_percent_in_truth_and_by_the_estimates() -> None:
    models = json.loads(SHIPPED.read_text(encoding="utf-8"))["models"]
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
    def forbidden(*rest: object) -> None:
        raise AssertionError("nothing should be measured")

    monkeypatch.setattr(cost_of, "_trial_run", forbidden)
    plan = plan_study(StudyRequest((SCENE, NEW.with_values({"name": "new"}))))
    assert plan.study.grid == 48
    assert [(model.key, model.tolerance(1e-3), model.most) for model in plan.study.hierarchy] == [
        (model.key, 1e-6 if model.side == "reference" else 1e-3, model.most) for model in MODEL_HIERARCHY
    ]


def test_a_scene_that_is_not_in_the_record_is_tried_and_others_of_its_family_go_by_that(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(cost_of, "_trial_run", lambda *rest: 0.1)
    family = tuple(NEW.with_values({"name": f"new[{n}]", "duration": 5.0 + n}) for n in range(4))
    seconds = cost_of.tried_costs((SCENE, *family), MODEL_HIERARCHY)
    assert (SCENE.name, "exact") not in seconds, "it is in the record"
    assert seconds["new[0]", "translational"] == seconds["new[3]", "translational"] == 0.1
    assert seconds["new[0]", "exact"] == 0.1
    # the two that were tried cost 0.1 s for 5 and 8 s of motion: between them in proportion to the duration
    assert seconds["new[2]", "translational"] == pytest.approx(0.5 * (0.1 / 5.0 + 0.1 / 8.0) * 7.0)


def test_models_under_another_name_are_not_tried(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cost_of, "_trial_run", lambda *rest: 0.1)
    other = replace(TRANSLATIONAL, amplification="somewhere:else")
    assert set(cost_of.tried_costs((NEW,), (EXACT, other))) == {(NEW.name, "exact")}


@pytest.mark.parametrize(("seconds", "most"), [(1e-3, 98), (0.1, 41), (1.5, 3), (60.0, 2)])
def test_a_trial_takes_as_many_pairs_as_it_may_or_the_first_alone(
    seconds: float, most: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Links of 10 us take seconds for every phase pair: 96 of them would take minutes of a plan."""
    pairs = [0]

    def answer(scene: Scene, phases: np.ndarray, **asked: Any) -> None:
        pairs[0] += len(phases)

    monkeypatch.setattr(cost_of, "imported", lambda function: answer)
    monkeypatch.setattr(cost_of, "time", SimpleNamespace(process_time=lambda: seconds * pairs[0]))
    assert cost_of.tried_costs((NEW,), (EXACT,))[NEW.name, "exact"] == pytest.approx(seconds)
    assert pairs[0] <= most, "one of them in a short motion, so that nothing is compiled"


def test_without_a_trial_cost_grows_with_duration_and_bodies() -> None:
    usual = cost_of.seconds_per_point(NEW, EXACT)
    assert cost_of.seconds_per_point(NEW.with_values({"duration": 10.0}), EXACT) == pytest.approx(2.0 * usual)
    table = NEW.model_dump(exclude_none=True)
    tall = Scene.model_validate({**table, "bodies": [*table["bodies"], *table["bodies"][1:] * 2]})
    assert cost_of.seconds_per_point(tall, EXACT) == pytest.approx(2.0 * usual)


@pytest.mark.parametrize("name", ["six bodies", "a record", "a shorter motion"])
def test_a_trial_predicts_the_cost_of_scenes_that_were_not_recorded_within_a_factor_2(name: str) -> None:
    scene, model, points = unrecorded(name), EXACT, 128
    predicted = cost_of.tried_costs((scene,), [model])[scene.name, model.key]
    phases = np.random.default_rng(1).uniform(0.0, 2.0 * np.pi, (1 if scene.recorded else points, 2))
    took = min(seconds_of(scene, model, phases) for _ in range(2)) / len(phases)
    assert 0.5 <= predicted / took <= 2.0


@pytest.mark.long
@pytest.mark.parametrize("model", [EXACT, REGULARIZED, TRANSLATIONAL, SPATIAL], ids=lambda model: model.key)
@pytest.mark.parametrize("name", ["six bodies", "a record", "a shorter motion"])
def test_every_model_is_predicted_within_a_factor_2(name: str, model: Model) -> None:
    scene, points = unrecorded(name), 64 if model.side == "reference" else 6
    predicted = cost_of.tried_costs((scene,), [model])[scene.name, model.key]
    phases = np.random.default_rng(1).uniform(0.0, 2.0 * np.pi, (1 if scene.recorded else points, 2))
    took = seconds_of(scene, model, phases) / len(phases)
    print(f"{name}, {model.key}: {predicted:.3g} s predicted, {took:.3g} s")
    assert 0.5 <= predicted / took <= 2.0


def unrecorded(name: str) -> Scene:
    """A scene that is not in the record."""
    if name == "a record":
        return load_scene("synthetic-pair")
    if name == "a shorter motion":
        return NEW
    table = load_scene("fig3-II").model_dump(exclude_none=True)
    above = [{**table["bodies"][1], "mass": 0.5, "height": 2.0 + n, "period": [0.3, 0.25]} for n in range(4)]
    isolator = {**table["isolator"], "ring": 4.0}
    changes = {"name": "six", "bodies": [*table["bodies"], *above], "isolator": isolator, "duration": 5.0}
    return Scene.model_validate({**table, **changes})


def seconds_of(scene: Scene, model: Model, phases: np.ndarray) -> float:
    """Processor time of some phase pairs, s."""
    clock = time.process_time()
    imported(model.amplification)(scene, phases, **model.settings, tolerance=cost_of.USUAL[model.side])
    return time.process_time() - clock


def test_the_run_says_what_it_chose_and_what_it_got(command: Callable[..., Run]) -> None:
    run = command("fig3-I", "--grid", "2", "--tolerance", "1e-2", "--jobs", "1")
    assert run.code == 0, run.err
    assert "Chosen for --tolerance 0.01" in run.out
    assert "small equations, 2 x 2 phases: 0.01 met at 100 % of 4 points by the error estimates" in run.out
    kept = json.loads((run.report / "summary.json").read_text(encoding="utf-8"))["run"]["choice"]
    assert kept["tolerance"] == 0.01
    assert [model["met"] for model in kept["models"]] == [1.0] * 6
    assert "0.01 met at" in (run.report / "index.html").read_text(encoding="utf-8")


def test_without_the_options_nothing_is_chosen_or_said(command: Callable[..., Run]) -> None:
    run = command("fig3-I", "--grid", "2")
    assert "Chosen for" not in run.out
    assert json.loads((run.report / "summary.json").read_text(encoding="utf-8"))["run"]["choice"] is None


def test_the_tightest_tolerance_is_one_that_some_model_meets() -> None:
    assert tightest() == min(record.tightest for record in recorded().accuracy.values())
