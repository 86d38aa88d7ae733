"""The worst phases in a study: what is searched, what the engine has there, and what a failed search leaves."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr

import reference
from comparison.analyses.worst_phases import analysis
from comparison.analyses.worst_phases.feature import _distribution_curves, _name_reading, _word_kind
from comparison.runner.task import make_failed_result
from comparison.runner.task_results import TaskResults
from comparison.study.models import EXACT, MODEL_HIERARCHY, REGULARIZED, SMALL, SPATIAL, TRANSLATIONAL
from comparison.study.study import Study
from comparison.surfaces.distribution import GridMaximum
from reference.phase_maximum import GRID
from reference.problem import Amplification, Outcome, Scene

SHORT = reference.load_scene("fig3-I").with_values({"duration": 3.0})


def study_of(*scenes: Scene) -> Study:
    return Study(scenes, 4, 1e-3, MODEL_HIERARCHY)


def test_small_equations_in_both_readings_and_like_equations_are_searched_for_every_body() -> None:
    searched = [task.argument[1:6] for task in analysis.WorstPhases().tasks(study_of(SHORT))]
    assert [(model.key, body) for model, _, _, quantity, body in searched if quantity == "amplification"] == [
        (key, body) for key in ("small", "small-resolved", "regularised") for body in (1, 2)
    ]
    others = [(model.key, body) for model, _, _, quantity, body in searched if quantity == "displacement"]
    assert others == [("exact", 1)]
    engines = {engine.key for model, engine, *_ in searched if engine is not None and model.key == "regularised"}
    assert engines == {"translational"}


def test_a_record_has_no_worst_phases() -> None:
    study = study_of(reference.load_scene("synthetic-pair"))
    assert analysis.WorstPhases().tasks(study) == []
    assert analysis.WorstPhases().collect(study, None, TaskResults()) is None


def test_an_engine_without_an_answer_there_says_why(monkeypatch: pytest.MonkeyPatch) -> None:
    def refusing(scene, phases, **settings):  # type: ignore[no-untyped-def]
        answer = reference.amplification(SHORT, phases, tolerance=1e-2)
        answer.mu[:], answer.error[:], answer.status[:] = math.nan, math.nan, Outcome.STEP_LIMIT.value
        return answer

    monkeypatch.setattr("comparison.analyses.worst_phases.analysis.import_function", lambda path: refusing)
    worst = analysis.LargestOverPhases(SHORT.name, REGULARIZED.key, "amplification", 1, 2.0, 1e-6, (1.0, 2.0), "smooth")
    engine = analysis._compute_engine_nearby(worst, SHORT, REGULARIZED, TRANSLATIONAL, 1e-3)
    assert math.isnan(engine.value)
    assert engine.reason == Outcome.STEP_LIMIT.value


def test_the_engine_is_asked_where_its_ratio_says(monkeypatch: pytest.MonkeyPatch) -> None:
    def equations(phases: Any) -> Any:
        return 2.0 - ((phases - [1.004, 2.002]) ** 2).sum(axis=1)

    def engine(phases: Any) -> Any:
        return equations(phases) * (1.0 + 1e-3 * (phases[:, 0] - 1.0))

    def answering(numerator: Any) -> Any:
        def amplification(scene, phases, **settings):  # type: ignore[no-untyped-def]
            mu = np.repeat(numerator(phases)[:, None], 2, axis=1)
            none = np.full(len(phases), math.nan)
            return Amplification(mu, 1e-9 * phases[:, :1] * mu, np.full(len(phases), "ok"), none, 0.0)

        return amplification

    sides = {TRANSLATIONAL.amplification: answering(engine), REGULARIZED.amplification: answering(equations)}
    monkeypatch.setattr("comparison.analyses.worst_phases.analysis.import_function", sides.__getitem__)
    monkeypatch.setattr("reference.measures.local_search.ground_peak", lambda scene, phases: np.full(len(phases), 0.5))
    worst = analysis.LargestOverPhases(SHORT.name, REGULARIZED.key, "amplification", 1, 2.0, 1e-6, (1.0, 2.0), "smooth")
    beside = analysis._compute_engine_nearby(worst, SHORT, REGULARIZED, TRANSLATIONAL, 1e-3)
    assert beside.evaluations == 6, "the middle, the corners, and where it is predicted to be largest"
    assert (beside.value, beside.at_start, beside.start_error) == pytest.approx((2.00001, 1.99998, 2e-9), rel=2e-6)
    assert beside.phases == pytest.approx((1.005, 2.002), abs=1e-4)  # 1e-3 of slope over 2 of curvature


def test_a_largest_value_has_the_reading_of_its_model_or_both_without_dry_friction() -> None:
    report = SimpleNamespace(study=study_of(SHORT, reference.load_scene("fig4-viscous")))
    for scene, model, quantity, reading in (
        (SHORT.name, "small", "amplification", "literal supremum"),
        (SHORT.name, "small-resolved", "amplification", "as integrated"),
        (SHORT.name, "spatial", "amplification", "as integrated"),
        ("fig4-viscous", "exact", "amplification", "both readings"),
        (SHORT.name, "small", "displacement", ""),
    ):
        assert _name_reading(report, analysis.LargestOverPhases(scene, model, quantity, 1)) == reading  # type: ignore[arg-type]


def test_what_a_largest_value_is_stands_beside_it() -> None:
    beside = "beside the worst phases of the equations"
    for known, words in (
        ({"kind": "nearby", "value": 1.5, "at_start": 1.25}, beside),
        ({"kind": "nearby", "value": 1.25, "at_start": 1.25}, "at the worst phases of the equations"),
        ({"kind": "nearby"}, f"{beside}, at which it has none"),
        ({"kind": "grid", "value": 1.5}, "at a phase pair of its grid"),
        ({"reason": "step limit"}, "step limit"),
        ({"kind": "kink"}, "on an edge of the surface"),
        ({"kind": "smooth"}, "on a smooth maximum"),
        ({"kind": "jump", "side": (-0.25, 0.968)}, "beside a jump, approached from (-0.25, +0.97)"),
    ):
        assert _word_kind(analysis.LargestOverPhases("fig3-I", "exact", "amplification", 1, **known)) == words  # type: ignore[arg-type]


def test_a_model_that_was_not_searched_has_the_largest_value_of_the_next_one() -> None:
    found = [
        analysis.LargestOverPhases("fig3-I", model, "amplification", 1, mu)
        for model, mu in (("exact", 1.0), ("regularised", 2.0))
    ]
    found += [
        analysis.LargestOverPhases("fig3-I", "small", "amplification", 1, math.nan),
        analysis.LargestOverPhases("fig3-I", "small", "amplification", 2, 5.0),
        analysis.LargestOverPhases("fig3-I", "resolved", "displacement", 1, 6.0),
        analysis.LargestOverPhases("fig3-II", "spatial", "amplification", 1, 7.0),
    ]
    models = ["small", "exact", "resolved", "regularised", "spatial"]
    largest = [analysis.find_nearest_search(found, models, "fig3-I", model, 1).value for model in models]
    assert largest == [1.0, 1.0, 2.0, 2.0, 2.0]


def test_searches_begin_at_the_hills_of_what_they_search() -> None:
    study = Study((SHORT,), GRID, 1e-3, MODEL_HIERARCHY)
    alpha = 2.0 * np.pi * np.arange(GRID) / GRID
    hill = 2.0 + np.cos(alpha - alpha[5])[:, None] + np.cos(alpha - alpha[9])[None, :]
    of_bodies = np.stack([np.roll(hill, shift, axis=1) for shift in (2, 3)])
    models, scenes = [model.key for model in MODEL_HIERARCHY], [SHORT.name]
    plane, body = ("scene", "model", "alpha1", "alpha2"), ("scene", "model", "body", "alpha1", "alpha2")
    shape = (1, len(models), GRID, GRID)
    surfaces = xr.Dataset(
        {
            "mu": (body, np.broadcast_to(of_bodies, (1, len(models), 2, GRID, GRID))),
            "error": (body, np.zeros((1, len(models), 2, GRID, GRID))),
            "displacement": (plane, np.broadcast_to(hill, shape)),
            "stride": (("scene", "model"), [[study.stride(model) for model in MODEL_HIERARCHY]]),
        },
        coords={"scene": scenes, "model": models, "body": [1, 2]},
    )
    tasks = analysis.WorstPhases().tasks(study, surfaces)
    for task in tasks:
        shift = 0 if task.argument[4] == "displacement" else 1 + task.argument[5]
        assert task.argument[7].tolist() == [[alpha[5], alpha[9 + shift]]]
    step = study.stride(SPATIAL)
    known = [float(mu[::step, ::step].max()) for mu in of_bodies]
    for _, _, engine, on_grid, _, body, *_ in (task.argument for task in tasks):
        assert (on_grid is None) == (engine is None)
        if on_grid is not None:
            assert (on_grid[0].key, on_grid[1].body, on_grid[1].mu) == ("spatial", body, known[body - 1])


def test_a_search_that_failed_leaves_a_row_with_the_reason() -> None:
    study, results = study_of(SHORT), TaskResults()
    tasks = analysis.WorstPhases().tasks(study)
    for task in tasks:
        results.put(task, make_failed_result(Outcome.TIME_LIMIT, "took too long"))
    rows = analysis.WorstPhases().collect(study, None, results)
    assert len(rows) == len(tasks) + 2  # the engine's rows
    assert all(
        row.reason == f"{Outcome.TIME_LIMIT}: took too long" and row.phases == analysis.NO_PHASES for row in rows
    )
    assert EXACT.key in {row.model for row in rows}


def test_a_scene_without_an_answer_at_any_phase_says_why_and_is_no_failure_of_a_solver() -> None:
    scene = SHORT.with_values({"excitation.scale": 60.0})
    asked: Any = (scene, SMALL, TRANSLATIONAL, None, "amplification", 2, 1e-3, None)
    rows = analysis.search_worst_phases(asked)
    assert [(row.model, row.body, row.reason) for row in rows] == [
        (model.key, 2, "no phase pair has an answer: rim reached") for model in (SMALL, TRANSLATIONAL)
    ]


@pytest.mark.parametrize(("grid", "kind", "value"), [(1.9, "nearby", 2.0), (2.1, "grid", 2.1)])
def test_the_spatial_engine_has_the_larger_of_its_grid_and_the_worst_phases(
    grid: float, kind: str, value: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its surface is not smooth, so that no search is made on it."""

    def steady(scene, phases, **settings):  # type: ignore[no-untyped-def]
        mu = np.full((len(phases), 2), 2.0)
        return Amplification(mu, 0.01 * mu, np.full(len(phases), "ok"), np.full(len(phases), math.nan), 0.0)

    monkeypatch.setattr("comparison.analyses.worst_phases.analysis.import_function", lambda path: steady)
    worst = analysis.LargestOverPhases(SHORT.name, REGULARIZED.key, "amplification", 1, 2.2, 1e-6, (1.0, 2.0), "smooth")
    largest = GridMaximum("spatial", 1, grid, 0.03, (0.5, 0.25))
    found = analysis._larger_of_grid_and_worst(worst, SHORT, (SPATIAL, largest), 1e-3)
    assert (found.model, found.kind, found.value) == ("spatial", kind, pytest.approx(value))
    assert found.phases == ((1.0, 2.0) if kind == "nearby" else (0.5, 0.25))
    assert found.error == pytest.approx(0.02 if kind == "nearby" else 0.03)


def test_distributions_are_of_the_small_equations_and_of_the_last_model_of_the_headline() -> None:
    models = ("small", "small-resolved", "regularised", "translational", "spatial")
    scene: Any = SimpleNamespace(
        headlines=[SimpleNamespace(body=body, first="regularised", second=f"spatia{body * 'l'}") for body in (1, 2)],
        distributions=[SimpleNamespace(model=key, body=1, curve=(float(k),)) for k, key in enumerate(models)],
    )
    assert _distribution_curves(scene, 1) == [("small", (0.0,)), ("small-resolved", (1.0,)), ("spatial", (4.0,))]
    assert _distribution_curves(scene, 2) == []
