"""`--budget`: from coarse to fine until the time is up, never without both sides, and never computed twice."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from itertools import pairwise

import pytest
from conftest import Run
from fake_models import busy, fake_hierarchy

from comparison.cli import budgeted
from comparison.execution.cache import Cache, store_beside
from comparison.execution.deadline import Deadline
from comparison.execution.keys import batch_key
from comparison.execution.processes import process_pool
from comparison.execution.sweep import sweep
from comparison.run import main
from comparison.study.planning import StudyRequest, plan_study
from comparison.study.refinement import EQUATIONS, FINEST, Step, reached, steps
from comparison.study.study import Study
from reference.problem import Outcome, builtin_scenes, load_scene

SCENE = load_scene("fig3-I")


def finest(grid: int | None = None) -> Study:
    return plan_study(StudyRequest((SCENE,), grid=grid, budgeted=True)).study


def test_the_steps_lead_from_both_sides_at_their_coarsest_to_the_finest_study() -> None:
    study = finest()
    listed = steps(study, {"claims": 5.0})
    assert [(step.key, step.grid) for step in listed[:2]] == [(EQUATIONS, 2), ("translational", 2)]
    assert {step.key: step.grid for step in listed} == {**FINEST, "claims": 0}
    assert [step.grid for step in listed if step.key == "spatial"] == [2, 4, 8, 24]
    costs = [step.seconds for step in listed[2:]]
    assert sum(later < before for before, later in pairwise(costs)) <= 2, "a grid may have to wait for another"


def test_no_model_has_a_finer_grid_than_the_one_before() -> None:
    finer = {EQUATIONS: 0, "translational": 0, "spatial": 0}
    for step in steps(finest(), {}):
        finer[step.key] = step.grid
        assert finer[EQUATIONS] >= finer["translational"] >= finer["spatial"]


@pytest.mark.parametrize("count", [2, 5, 9, 14])
def test_every_beginning_of_the_steps_is_a_study_of_both_sides(count: int) -> None:
    study = finest()
    listed = steps(study, {})[:count]
    best = reached(study, listed)
    assert best is not None
    for key in {step.key for step in listed}:
        model = next(model for model in best.hierarchy if key in (EQUATIONS, model.key))
        assert len(best.axis(model)) == max(step.grid for step in listed if step.key == key)


def test_without_both_sides_there_is_no_study() -> None:
    study = finest()
    assert reached(study, [Step(EQUATIONS, 2, 0.0), Step("spatial", 2, 0.0)]) is None
    assert reached(study, [Step("translational", 2, 0.0)]) is None


def test_a_grid_with_a_gap_below_it_does_not_count() -> None:
    both = [Step(EQUATIONS, 2, 0.0), Step("translational", 2, 0.0)]
    best = reached(finest(), [*both, Step(EQUATIONS, 8, 0.0), Step("translational", 4, 0.0)])
    assert best is not None
    assert [(model.key, len(best.axis(model))) for model in best.hierarchy][-2:] == [
        ("regularised", 2),
        ("translational", 2),
    ]


def test_a_grid_that_is_given_is_the_finest() -> None:
    listed = steps(finest(20), {})
    assert {step.key: step.grid for step in listed} == {EQUATIONS: 20, "translational": 20, "spatial": 4}


def test_after_the_deadline_nothing_starts_and_what_runs_is_ended() -> None:
    deadline, done = Deadline(5.0), []  # a busy machine takes seconds to start a worker
    results = sweep(
        [0.0, 60.0, 0.0],
        busy,
        lambda task, outcome, message: (outcome, message),
        lambda task, result: done.append(task),
        1,
        process_pool,
        seconds_left=lambda task: deadline.left,
    )
    late = Outcome.TIME_LIMIT, "not computed before the deadline"
    assert results == ["done", late, late]
    assert done == [0.0], "what has no result is not kept"


def test_a_task_that_would_cross_the_deadline_is_not_started() -> None:
    deadline = Deadline(10.0)
    assert deadline.allows("engine", 6.0)
    deadline.learn("engine", 1.0, 3.0)
    assert not deadline.allows("engine", 6.0), "others took three times as long as predicted"
    assert deadline.allows("reference", 6.0)


def test_a_budget_is_kept_and_says_what_it_reached_and_what_more_would_buy(command: Callable[..., Run]) -> None:
    run = command("fig3-I", "--budget", "3000", "--grid", "4", "--jobs", "1")
    assert run.code == 0, run.err
    kept = json.loads((run.report / "summary.json").read_text(encoding="utf-8"))["run"]["choice"]
    assert (kept["budget"], kept["next_steps"]) == (3000.0, [])
    assert {model["key"]: model["phases_per_axis"] for model in kept["models"]}["exact"] == 4
    assert "best complete study" in (run.report / "index.html").read_text(encoding="utf-8")
    assert "exact equations, 4 x 4 phases: 0.001 met at 100 %" in run.out


def test_what_is_not_complete_when_the_time_is_up_is_left_out_and_kept_for_the_next_run(
    command: Callable[..., Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Only six batches fit: those of both sides at 2 x 2, of the equations at 4 x 4, and parts of a step."""
    allowed = [True] * 11

    def few(self: Deadline, kind: object, predicted: float) -> bool:
        return kind == "pictures" or bool(allowed and allowed.pop())

    monkeypatch.setattr(Deadline, "allows", few)
    run = command("fig3-I", "--budget", "3000", "--skip", "assumptions", "--jobs", "1")
    assert run.code == 0, run.err
    choice = json.loads((run.report / "summary.json").read_text(encoding="utf-8"))["run"]["choice"]
    grids = {model["key"]: model["phases_per_axis"] for model in choice["models"]}
    assert grids["translational"] == 2
    assert {grids[key] for key in ("small", "exact", "resolved", "regularised")} <= {2, 4, 8}
    assert "More time would buy" in run.out
    assert choice["next_steps"]
    cache = Cache(store_beside(run.report))
    coarse = Study((SCENE,), 2, 1e-3, fake_hierarchy()).batches()
    assert all(cache.holds(batch_key(batch)) for batch in coarse), "a study of another grid goes on with them"


def test_a_budget_that_ends_before_both_sides_have_values_is_one_line(
    command: Callable[..., Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Deadline, "allows", lambda self, kind, predicted: False)
    run = command("fig3-I", "--budget", "3000", "--jobs", "1")
    assert run.code == 2
    assert "ended before both sides had a value" in run.err
    assert run.err.count("\n") == 1
    assert not run.report.exists()


def test_an_impossible_budget_is_one_line(command: Callable[..., Run]) -> None:
    run = command("fig3-I", "--budget", "1")
    assert run.code == 2
    assert run.err.startswith("command line: --budget = 1.0: the smallest study of fig3-I takes about ")
    assert run.err.count("\n") == 1
    assert not run.report.exists()


def test_a_slow_or_busy_machine_keeps_more_time_for_the_report(monkeypatch: pytest.MonkeyPatch) -> None:
    shares = []
    for slow in (1.0, 3.0):
        monkeypatch.setattr(budgeted, "slowness", lambda slow=slow: slow)
        shares.append(budgeted.allotment(finest(), 300.0, 2))
    assert shares[1].writing > 2.0 * shares[0].writing
    assert shares[1].surfaces < shares[0].surfaces


def test_the_plan_of_a_budget_lists_the_steps_in_their_order(command: Callable[..., Run]) -> None:
    run = command("fig3-I", "--budget", "3000", "--plan")
    assert run.code == 0, run.err
    assert run.out.index("equations: 2 x 2 phases") < run.out.index("translational engine: 2 x 2 phases")
    assert run.out.index("translational engine: 2 x 2 phases") < run.out.index("equations: 96 x 96 phases")
    assert not run.report.exists()


def test_what_the_surfaces_choose_is_left_out_of_a_short_budget(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(budgeted, "slowness", lambda: 1.0)
    study = plan_study(StudyRequest(tuple(map(load_scene, builtin_scenes())), budgeted=True)).study
    assert "motions" in budgeted.allotment(study, 45.0, 2).dropped
    assert budgeted.allotment(study, 600.0, 2).dropped == ()
    assert "pictures" not in budgeted.allotment(study, 45.0, 2).dropped


@pytest.mark.long
@pytest.mark.parametrize("budget", [40.0, 60.0, 120.0])
def test_a_budget_is_not_overrun_by_more_than_a_tenth_on_an_idle_machine(budget: float, tmp_path: object) -> None:
    begin = time.monotonic()
    assert main(["fig3-I", "fig4-viscous", "--budget", f"{budget:g}", "--out", f"{tmp_path}/report"]) == 0
    seconds = time.monotonic() - begin
    print(f"{budget:g} s: {seconds:.1f} s")
    assert seconds <= 1.1 * budget
