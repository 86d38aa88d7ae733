"""A point or a model without a value is named with its reason, and costs no other."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fake_models import fake_hierarchy, silenced, why_refused
from places import limited_scene
from report_texts import page_of, summary_of
from runs import Run
from studies import body_comparisons, solved

from comparison.analyses.motions import analysis as motions
from comparison.analyses.motions.analysis import compute_stored_motion
from comparison.study import batches
from comparison.study.models import MODEL_HIERARCHY, chain_of, pairs_of
from comparison.study.study import Study
from comparison.surfaces.budget import compute_closure_error
from comparison.surfaces.missing_values import leave_out_empty_models, list_missing_values
from reference.problem import load_scene

GRID = ["--grid", "4", "--only", "differences"]


@pytest.mark.parametrize(
    ("model", "outcome"),
    [("failing_point", "rim reached"), *((f, "solver failed") for f in ("silent_nan", "raising", "misshapen_there"))],
)
def test_a_failing_point_is_nan_and_the_others_stay(model: str, outcome: str) -> None:
    study = Study((load_scene("fig3-I"),), 4, 1e-3, fake_hierarchy(model, batch=1))
    engine = solved(study).sel(scene="fig3-I", model="translational")
    status, mu = engine["status"].values, engine["mu"].values
    assert status[3, 3] == outcome
    assert (np.delete(status.ravel(), 15) == "ok").all()
    assert np.isnan(mu[:, 3, 3]).all()
    assert np.isfinite(mu).sum() == 2 * 15


def test_without_an_engine_the_equations_take_its_place(command: Callable[..., Run]) -> None:
    run = command("fig3-I", *GRID, "--check", hierarchy=fake_hierarchy("always_raising"))
    assert run.code == 1
    assert "acceptance.median: nothing to compare (translational engine: no value at any" in run.err
    assert "nan" not in run.err
    rows = summary_of(run.report)["scenes"][0]["differences"]
    assert {tuple(row[name] for name in ("pair", "first", "second", "unanswered")) for row in rows} == {
        ("total", "small-resolved", "regularised", 0)
    }


def test_a_scene_without_any_answer_still_gets_its_report(command: Callable[..., Run]) -> None:
    hierarchy = [replace(model, amplification="fake_models:always_raising", settings={}) for model in fake_hierarchy()]
    run = command("fig3-I", *GRID, "--check", hierarchy=hierarchy)
    assert run.code == 1
    assert "nan found" not in run.err
    assert "no value in common at any phase pair" in (run.report / "summary.md").read_text(encoding="utf-8")
    assert {row["median"] for row in summary_of(run.report)["scenes"][0]["differences"]} == {None}


@pytest.mark.parametrize("silent", ["spatial", "translational", "resolved", "small-resolved"])
def test_the_total_leads_to_the_last_model_with_values(silent: str) -> None:
    study = Study((load_scene("fig3-I"),), 4, 1e-3, silenced(silent))
    surfaces = solved(study)
    study = leave_out_empty_models(study, surfaces)
    scene = study.scenes[0]
    left = [model.key for model in chain_of(scene, study.hierarchy) if model.key != silent]
    for comparison in body_comparisons(study, surfaces):
        assert [pair.second.key for pair in comparison.consecutive_model_pairs] == left[1:]
        assert (comparison.total.first, comparison.total.second) == (left[0], left[-1])
        assert comparison.total.unanswered == 0
        assert compute_closure_error(comparison) < 1e-14
    (lacking,) = list_missing_values(study, surfaces)
    assert (lacking.model, lacking.used, lacking.points == lacking.asked) == (silent, False, True)
    assert lacking.why == f"step limit: {why_refused(scene, 1e-3)}"
    pairs = {pair.key: pair.sentence for pair in study.pairs(scene)}
    assert ("translational" in pairs) == (silent == "resolved"), "from the printed equations, to no total"
    assert pairs["total"].endswith("the most complete model of Exudyn") == (silent != "spatial")
    (alone,) = pairs_of(scene, study.hierarchy[:6])
    assert alone.sentence == "the paper's printed equations against the exact equations, v_reg"
    alike = "like-for-like" in pairs
    assert alike == (silent in ("spatial", "resolved", "small-resolved")), "never said of other models"
    surfaces["mu"].loc[{"model": [*left[1:]]}] = np.nan
    alone = leave_out_empty_models(study, surfaces)
    assert alone.left_out(scene) == (), "nothing would be left to compare"
    assert not any(lacking.used for lacking in list_missing_values(alone, surfaces))


@pytest.mark.parametrize("body", [0, 1])
def test_a_phase_pair_lacks_a_value_where_one_body_does(body: int) -> None:
    study = Study((load_scene("fig3-I"),), 4, 1e-3, fake_hierarchy())
    surfaces = solved(study)
    at = {"scene": "fig3-I", "model": "translational"}
    mu, error = (surfaces[name].sel(at).values.copy() for name in ("mu", "error"))
    mu[body, 0, 1] = np.nan
    error[body, 2, :2], error[body, 3, 3] = 0.6 * mu[body, 2, :2], 0.4 * mu[body, 3, 3]
    surfaces["mu"].loc[at], surfaces["error"].loc[at] = mu, error
    (lacking,) = list_missing_values(study, surfaces)
    assert (lacking.model, lacking.points, lacking.unusable, lacking.asked) == ("translational", 1, 2, 16)


def test_the_translational_limit_may_be_of_the_total(command: Callable[..., Run], tmp_path: Path) -> None:
    limits = "[acceptance]\nfailed = 99\n[acceptance.translational]\nmedian = 1e-3\n"
    scene = limited_scene(tmp_path, limits, "mine.toml")
    run = command(scene, *GRID, "--check", hierarchy=silenced("spatial", gap=0.01))
    assert "body 1: acceptance.translational.median: 0.01 found, 0.001 allowed" in run.err


def test_a_study_without_limits_holds_none(command: Callable[..., Run], tmp_path: Path) -> None:
    report = command(limited_scene(tmp_path, "", "mine.toml"), *GRID, hierarchy=silenced("spatial")).report
    assert "No scene states acceptance limits" in page_of(report)
    assert "holds" not in (report / "summary.md").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("limits", "said"),
    [
        ("[acceptance]\nmaximun = 1.0\n", "acceptance.maximun = 1.0: unknown key; did you mean maximum?"),
        ("[acceptance.totals]\nmedian = 1.0\n", "this study has no engine of this name; did you mean total?"),
        ("[acceptance.mina]\nmedian = 1.0\n", "this study has no engine of this name; did you mean mine?"),
        (
            "[acceptance.mine]\nmedian = 1.0\n[acceptance.zzz]\nmedian = 2.0\n",
            "this study has no engine of this name; --model zzz=module:function enters it",
        ),
        ("[acceptance.total]\nclosure = 1.0\n", "total.closure = 1.0: unknown key; the keys here are median, "),
        ("[acceptance]\nmedian = 1.0\n[acceptance.like_for_like]\nmedian = 2.0\n", "here or in like_for_like"),
    ],
)
def test_a_wrong_limit_is_one_line_with_the_nearest_key(
    command: Callable[..., Run], tmp_path: Path, limits: str, said: str
) -> None:
    scenes = "fig3-I", limited_scene(tmp_path, limits, "mine.toml")
    run = command(*scenes, "--check", "--model", "mine=user_engines:plain", hierarchy=fake_hierarchy("forbidden"))
    assert run.code == 2
    assert said in run.err
    assert run.err.count("\n") == 1


def test_a_motion_is_asked_for_with_the_equations_and_friction_of_its_model(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[dict[str, object]] = []
    monkeypatch.setattr(batches, "import_function", lambda path: lambda *motion, **settings: asked.append(settings))
    place = motions.MotionPlace("fig3-I", 0, 0, "")
    for model in MODEL_HIERARCHY[:6]:
        compute_stored_motion((load_scene("fig3-I"), model, 1e-3, place, (0.0, 0.0)))
    assert [(settings["equations"], settings["regularization"]) for settings in asked] == [
        ("small", None), ("exact", None), ("small", None), ("exact", None), ("small", 1e-3), ("exact", 1e-3),
    ]  # fmt: skip
    assert not any("cutoff" in settings for settings in asked), "a way to read a motion, not to move"
