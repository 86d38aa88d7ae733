"""The accuracy asked is met at 99 % of the points, and the cost is within a factor 1.5 of what was expected."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
import pytest
from fake_models import fake_hierarchy

from comparison.analysis.surfaces import labeled_surfaces
from comparison.analysis.targets import targets_met
from comparison.study.batches import execute_batch, imported
from comparison.study.models import Model
from comparison.study.planning import StudyPlan, StudyRequest, plan_study
from comparison.study.study import Study
from reference.problem import Scene, builtin_scenes, load_scene

TIGHTER = 100.0
TIGHTEST = {"reference": 1e-10, "engine": 1e-5}  # that the models take: the truth of the tightest is less than TIGHTER


def tower() -> Scene:
    """None of the paper's: three bodies, both harmonics along both axes, vertical shaking, longer periods."""
    table = load_scene("fig3-II").model_dump(exclude_none=True)
    table["duration"] = 8.0
    table["bodies"] = [*table["bodies"], {"mass": 0.5, "period": [0.7, 0.6], "height": 2.2, "size": [1.0, 1.0, 0.2]}]
    table["excitation"]["amplitudes"] = [[0.8, 0.3], [-0.2, 0.9], [0.1, 0.2]]
    table["excitation"]["periods"] = [1.3, 0.8]
    return Scene.model_validate({**table, "name": "tower"})


def chosen(scene: Scene, tolerance: float, grid: int, most: int) -> StudyPlan:
    """What is chosen on a small grid, the engine on a smaller one."""
    plan = plan_study(StudyRequest((scene,), tolerance=tolerance, grid=grid, tries=True))
    models = [replace(model, most=most) if model.side == "engine" else model for model in plan.study.hierarchy]
    return replace(plan, study=replace(plan.study, hierarchy=models))


def share_met(plan: StudyPlan, scene: Scene, model: Model) -> tuple[float, int]:
    """Share of the points of one model that are as accurate as asked, against a run TIGHTER; and their number."""
    met, study = [], plan.study
    for batch in study.batches():
        if batch.model == model.key:
            answer = execute_batch(batch)
            asked = max(study.tolerance / TIGHTER, TIGHTEST[model.side])
            if model.side == "reference":
                asked = min(asked, 1e-8)
            truth = imported(batch.amplification)(scene, batch.phases, **{**batch.settings, "tolerance": asked})
            error = np.abs(answer.mu / truth.mu - 1.0).max(axis=1)
            met += list(np.nan_to_num(error, nan=np.inf) <= study.tolerance)
    return float(np.mean(met)), len(met)


def test_a_point_meets_the_tolerance_with_its_worst_body() -> None:
    """Of four points two have one body beyond the 1e-3 asked, each another one; 99 % have 2e-2 or less."""
    study = Study((load_scene("fig3-I"),), 2, 1e-3, fake_hierarchy()[:1])
    batches = study.batches()
    surfaces = labeled_surfaces(study, batches, [execute_batch(batch) for batch in batches])
    relative = np.full(surfaces["mu"].shape, 1e-6)
    relative[0, 0, 0, 0, 0], relative[0, 0, 1, 1, 1] = 1e-2, 2e-2
    surfaces["error"].values[:] = relative * surfaces["mu"].values
    plan = plan_study(StudyRequest((load_scene("fig3-I"),), grid=2))
    (model,) = targets_met(plan, study, 1e-3, None, [], surfaces)["models"]
    assert (model["points"], model["met"]) == (4, 0.5)
    assert model["error99"] == pytest.approx(2e-2)


@pytest.mark.long
def test_the_accuracy_asked_is_met_on_a_scene_that_was_never_recorded() -> None:
    scene = tower().with_values({"duration": 3.0})
    plan = chosen(scene, 1e-3, 6, 2)
    assert {model.side for model in plan.study.hierarchy} == {"reference", "engine"}
    for model in plan.study.hierarchy:
        if model.key != "spatial":
            share, points = share_met(plan, scene, model)
            assert share >= 0.99, (model.key, points)


@pytest.mark.long
@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-4, 1e-7])
@pytest.mark.parametrize("name", [*builtin_scenes(), "tower"])
def test_the_accuracy_asked_is_met_at_99_percent_of_the_points(name: str, tolerance: float) -> None:
    scene = tower() if name == "tower" else load_scene(name)
    # the engine is held against runs a hundred times tighter: few phases but at the usual tolerance
    plan = chosen(scene, tolerance, 16, 4 if tolerance == 1e-3 else 2)
    assert plan.study.hierarchy
    for model in plan.study.hierarchy:
        if model.applies(scene):
            share, points = share_met(plan, scene, model)
            print(f"{name} {model.key} {tolerance:.0e}: {100.0 * share:.1f} % of {points}")
            assert share >= 0.99, (model.key, points)


@pytest.mark.long
@pytest.mark.parametrize("tolerance", [1e-3, 1e-4, 1e-7])
@pytest.mark.parametrize("names", [builtin_scenes(), ["tower"]], ids=["the paper's scenes", "tower"])
def test_the_cost_is_within_a_factor_1_5_of_what_was_expected(names: list[str], tolerance: float) -> None:
    """
    What the record says: a test for the machine of the record.

    It has one cost per tolerance, a mean over the paper's scenes: it holds for them together, within a factor 2
    for each.
    """

    def foreseen(scene: Scene) -> StudyPlan:
        return chosen(scene, tolerance, 24, 4)

    def seconds(plan: StudyPlan) -> float:
        return sum(plan.study.seconds(model) for model in plan.study.hierarchy)

    expected, spent = [], []
    for name in names:
        scene = tower() if name == "tower" else load_scene(name)
        expected_plan = foreseen(scene)
        begin = time.process_time()
        for batch in expected_plan.study.batches():
            execute_batch(batch)
        spent.append(time.process_time() - begin)
        expected.append(seconds(expected_plan))
        print(f"{name} {tolerance:.0e}: {spent[-1]:.2f} s where {expected[-1]:.2f} s were expected")
    ratio = np.divide(spent, expected)
    assert 1.0 / 1.5 <= sum(spent) / sum(expected) <= 1.5
    assert ((ratio >= 0.5) & (ratio <= 2.0)).all(), ratio
