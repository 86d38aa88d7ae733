"""The worst phases in a study: what is searched, what the engine has there, and what a failed search leaves."""

from __future__ import annotations

import math

import pytest

import reference
from comparison.analysis.worst_phases import NOWHERE, Worst, WorstPhases, _engine_beside, worst_of
from comparison.execution.task import unfinished
from comparison.execution.task_results import TaskResults
from comparison.study.models import EXACT, MODEL_HIERARCHY, REGULARIZED, TRANSLATIONAL
from comparison.study.study import Study
from reference.problem import Outcome, Scene

SHORT = reference.load_scene("fig3-I").with_values({"duration": 3.0})


def study_of(*scenes: Scene) -> Study:
    return Study(scenes, 4, 1e-3, MODEL_HIERARCHY)


def test_exact_equations_and_the_counterpart_of_the_engine_are_searched_for_every_body() -> None:
    searched = [task.argument[1:5] for task in WorstPhases().tasks(study_of(SHORT))]
    assert [(model.key, body) for model, _, quantity, body in searched if quantity == "amplification"] == [
        (key, body) for key in ("exact", "regularised") for body in (1, 2)
    ]
    assert [(model.key, body) for model, _, quantity, body in searched if quantity == "displacement"] == [("exact", 1)]
    engines = {engine.key for model, engine, _, _ in searched if engine is not None and model.key == "regularised"}
    assert engines == {"translational"}


def test_a_record_has_no_worst_phases() -> None:
    study = study_of(reference.load_scene("synthetic-pair"))
    assert WorstPhases().tasks(study) == []
    assert WorstPhases().collect(study, None, TaskResults()) is None


@pytest.mark.long
def test_the_engine_confirms_the_maximum_of_the_equations_within_both_errors() -> None:
    equations, engine = worst_of((SHORT, REGULARIZED, TRANSLATIONAL, "amplification", 2, 1e-3, None))
    assert engine.model == "translational"
    assert abs(engine.at_start - equations.value) <= engine.start_error + equations.error
    assert engine.value >= engine.at_start
    assert math.dist(engine.phases, equations.phases) <= 0.03


def test_an_engine_without_an_answer_there_says_why(monkeypatch: pytest.MonkeyPatch) -> None:
    def refusing(scene, phases, **settings):  # type: ignore[no-untyped-def]
        answer = reference.amplification(SHORT, phases, tolerance=1e-2)
        answer.mu[:], answer.error[:], answer.status[:] = math.nan, math.nan, Outcome.STEP_LIMIT.value
        return answer

    monkeypatch.setattr("comparison.analysis.worst_phases.imported", lambda path: refusing)
    worst = Worst(SHORT.name, REGULARIZED.key, "amplification", 1, 2.0, 1e-6, (1.0, 2.0), "smooth")
    engine = _engine_beside(worst, SHORT, TRANSLATIONAL, 1e-3)
    assert math.isnan(engine.value)
    assert engine.reason == Outcome.STEP_LIMIT.value


def test_a_search_that_failed_leaves_a_row_with_the_reason() -> None:
    study, results = study_of(SHORT), TaskResults()
    tasks = WorstPhases().tasks(study)
    for task in tasks:
        results.put(task, unfinished(task, Outcome.TIME_LIMIT, "took too long"))
    rows = WorstPhases().collect(study, None, results)
    assert rows is not None
    assert len(rows) == len(tasks) + 2  # the engine's rows
    assert all(row.reason == f"{Outcome.TIME_LIMIT}: took too long" and row.phases == NOWHERE for row in rows)
    assert EXACT.key in {row.model for row in rows}
