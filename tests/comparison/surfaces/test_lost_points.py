"""A point or a model without a value is named with its reason, and costs no other."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from fake_models import fake_hierarchy, silenced
from places import limited_scene
from report_texts import Tables, page_of, summary_of
from runs import Run
from studies import solved

from comparison.analyses.motions.analysis import Motions, moved
from comparison.study.study import Study
from comparison.surfaces.budget import TOTAL, closure, steps
from comparison.surfaces.unanswered import compared_study, unanswered
from comparison.surfaces.waterfall import waterfall
from reference.problem import load_scene

GRID = ["--grid", "4", "--only", "differences"]


CASES = {
    "no answer, with a reason": ("failing_point", "rim reached"),
    "a nan called ok": ("silent_nan", "solver failed"),
    "raises": ("raising", "solver failed"),
    "wrong shape": ("misshapen_there", "solver failed"),
}


@pytest.mark.parametrize(("model", "outcome"), CASES.values(), ids=CASES.keys())
def test_a_failing_point_is_nan_and_the_others_stay(model: str, outcome: str) -> None:
    study = Study((load_scene("fig3-I"),), 4, 1e-3, fake_hierarchy(model, batch=1))
    engine = solved(study).sel(scene="fig3-I", model="translational")
    status, mu = engine["status"].values, engine["mu"].values
    assert status[3, 3] == outcome
    assert (np.delete(status.ravel(), 15) == "ok").all()
    assert np.isnan(mu[:, 3, 3]).all()
    assert np.isfinite(mu).sum() == 2 * 15


def test_a_batch_that_raises_loses_its_own_points_only(command: Callable[..., Run]) -> None:
    run = command("fig3-I", *GRID, hierarchy=fake_hierarchy("raising", batch=4))
    with xr.open_dataset(run.report / "surfaces.nc", engine="h5netcdf") as data:
        status = data["status"].sel(scene="fig3-I", model="translational").values
    assert (status[3] == "solver failed").all()
    assert (status[:3] == "ok").all()
    assert "RuntimeError: the matrix is singular" in run.err
    summary = summary_of(run.report)
    faults = [f"{model} engine: RuntimeError: the matrix is singular" for model in ("spatial", "translational")]
    assert summary["faults"] == [f"fig3-I, {fault}" for fault in faults]
    assert [alert["text"] for alert in summary["alerts"] if alert["kind"] == "fault"] == faults


def test_without_an_engine_the_equations_take_its_place(command: Callable[..., Run]) -> None:
    run = command("fig3-I", *GRID, "--check", hierarchy=fake_hierarchy("always_raising"))
    assert run.code == 1
    assert "acceptance.median: nothing to compare (translational engine: no value at any" in run.err
    assert "nan" not in run.err
    summary = summary_of(run.report)
    rows = summary["scenes"][0]["differences"]
    assert {(row["pair"], row["first"], row["second"], row["unanswered"]) for row in rows} == {
        ("total", "small", "regularised", 0)
    }
    assert [(one["model"], one["points"], one["used"]) for one in summary["unanswered"]] == [
        ("translational", 16, False),
        ("spatial", 16, False),
    ]


def test_a_scene_without_any_answer_still_gets_its_report(command: Callable[..., Run]) -> None:
    hierarchy = [replace(model, amplification="fake_models:always_raising", settings={}) for model in fake_hierarchy()]
    run = command("fig3-I", *GRID, "--check", hierarchy=hierarchy)
    assert run.code == 1
    assert "nan found" not in run.err
    assert "no value in common at any phase pair" in (run.report / "summary.md").read_text(encoding="utf-8")
    summary = summary_of(run.report)
    assert {row["median"] for row in summary["scenes"][0]["differences"]} == {None}


def test_what_is_not_ok_and_what_has_no_value_are_counted_apart(command: Callable[..., Run]) -> None:
    """One phase pair of 16 has no value, four miss the tolerance."""
    run = command("fig3-I", *GRID, hierarchy=fake_hierarchy("patchy"))
    for row in summary_of(run.report)["scenes"][0]["differences"]:
        assert (row["not_ok"], row["unanswered"], row["asked"]) == (5, 1, 16)
    for row in Tables(page_of(run.report)).headed("not ok", "no value"):
        assert (row["not ok"], row["no value"], row["phase pairs"]) == ("5", "1", "16")
    rows = [line.split() for line in run.out.splitlines() if line.split()[:1] == ["fig3-I"] and "like" in line]
    assert [row[-1] for row in rows] == ["5", "5"]


WHY = "step limit: refused before any step: 3 times the work, shorten the duration to 7 s"


def _solved(*silent: str) -> Study:
    return Study((load_scene("fig3-I"),), 4, 1e-3, silenced(*silent))


@pytest.mark.parametrize("silent", ["spatial", "translational", "resolved", "small"])
def test_the_total_leads_to_the_last_model_with_values(silent: str) -> None:
    study = _solved(silent)
    surfaces = solved(study)
    study = compared_study(study, surfaces)
    scene = study.scenes[0]
    left = [model.key for model in study.hierarchy if model.key != silent]
    for body in (1, 2):
        found = steps(study, surfaces, scene.name, body)
        assert [step.second.key for step in found] == [*left[1:], left[-1]]
        assert (found[-1].key, found[-1].first.key) == (TOTAL, left[0])
        assert found[-1].known.all()
        assert closure(found) < 1e-14
        assert waterfall(study, surfaces, scene, body).points > 0
    (lacking,) = unanswered(study, surfaces)
    assert (lacking.model, lacking.used, lacking.points == lacking.asked) == (silent, False, True)
    assert lacking.why == WHY
    alike = "like-for-like" in {pair.key for pair in study.pairs(scene)}
    assert alike == (silent in ("spatial", "resolved", "small")), "never said of other models"
    surfaces["mu"].loc[{"model": left[1:]}] = np.nan
    alone = compared_study(study, surfaces)
    assert alone.left_out(scene) == (), "nothing would be left to compare"
    assert not any(lacking.used for lacking in unanswered(alone, surfaces))


def test_page_summary_and_terminal_say_which_model_is_refused(command: Callable[..., Run]) -> None:
    run = command("fig3-I", "--grid", "4", hierarchy=silenced("spatial"))
    line = "fig3-I: spatial engine: no value at any of 16 phase pairs: step limit; comparisons leave this model out"
    assert run.code == 0
    page = page_of(run.report)
    assert page.index(line) < page.index('<section id="summary"') < page.index('id="surfaces"')
    assert "no phase pair where every model" not in page
    assert f"No answer: {line}" in run.out
    assert "3 times the work, shorten the duration to 7 s" in (run.report / "summary.md").read_text(encoding="utf-8")
    summary = summary_of(run.report)
    assert [(one["scene"], one["model"], one["points"]) for one in summary["unanswered"]] == [("fig3-I", "spatial", 16)]
    assert [(alert["level"], alert["kind"]) for alert in summary["alerts"]][:1] == [("red", "refused")]
    assert all(row["median"] is not None for row in summary["scenes"][0]["differences"])


def test_a_refused_model_breaks_only_the_limit_of_answers(command: Callable[..., Run]) -> None:
    run = command("fig3-I", *GRID, "--check", hierarchy=silenced("spatial"))
    assert run.code == 1
    assert run.err == (
        "limit broken: fig3-I: acceptance.failed: 16 points without an answer (spatial engine 16 of 16), 0 allowed\n"
    )


def test_limits_may_be_stated_for_every_pair(command: Callable[..., Run], tmp_path: Path) -> None:
    limits = "[acceptance.total]\nmaximum = 0.02\n[acceptance.translational]\nmedian = 1e-3\n"
    scene = limited_scene(tmp_path, limits + "[acceptance.like_for_like]\nratio = 1e3\n", "mine.toml")
    run = command(scene, *GRID, "--check", hierarchy=fake_hierarchy(gap=0.01))
    assert run.code == 1
    assert run.err.splitlines() == [
        f"limit broken: mine: body {body}: acceptance.translational.median: 0.01 found, 0.001 allowed"
        for body in (1, 2)
    ]
    text = (run.report / "junit.xml").read_text(encoding="utf-8")
    for name in ("total.maximum = 0.02", "translational.median = 0.001", "like_for_like.ratio = 1000", "failed = 0"):
        assert f'name="acceptance.{name}"' in text
    assert 'tests="4" failures="1"' in text


def test_the_translational_limit_may_be_of_the_total(command: Callable[..., Run], tmp_path: Path) -> None:
    scene = limited_scene(
        tmp_path, "[acceptance]\nfailed = 99\n[acceptance.translational]\nmedian = 1e-3\n", "mine.toml"
    )
    run = command(scene, *GRID, "--check", hierarchy=silenced("spatial", gap=0.01))
    assert "body 1: acceptance.translational.median: 0.01 found, 0.001 allowed" in run.err


def test_a_check_without_limits_says_that_nothing_was_checked(command: Callable[..., Run], tmp_path: Path) -> None:
    scene = limited_scene(tmp_path, "", "mine.toml")
    run = command(scene, *GRID, "--check", hierarchy=silenced("spatial"))
    assert (run.code, run.err) == (0, "--check: no scene states [acceptance] limits: nothing was checked\n")
    assert "No scene states acceptance limits" in page_of(run.report)
    assert "holds" not in (run.report / "summary.md").read_text(encoding="utf-8")
    both = command(scene, "fig3-I", *GRID, "--check", hierarchy=fake_hierarchy(gap=5e-5))
    assert (both.code, both.err) == (0, "--check: mine: no limits are stated under [acceptance]: nothing was checked\n")


@pytest.mark.parametrize(
    ("limits", "said"),
    [
        ("[acceptance]\nmaximun = 1.0\n", "acceptance.maximun = 1.0: unknown key; did you mean maximum?"),
        ("[acceptance.totals]\nmedian = 1.0\n", "this study has no engine of this name; did you mean total?"),
        (
            "[acceptance.total]\nclosure = 1.0\n",
            "acceptance.total.closure = 1.0: unknown key; the keys here are median, ",
        ),
        (
            "[acceptance]\nmedian = 1.0\n[acceptance.like_for_like]\nmedian = 2.0\n",
            "give median here or in like_for_like",
        ),
    ],
)
def test_a_wrong_limit_is_one_line_with_the_nearest_key(
    command: Callable[..., Run], tmp_path: Path, limits: str, said: str
) -> None:
    run = command(limited_scene(tmp_path, limits, "mine.toml"), "--check", hierarchy=fake_hierarchy("forbidden"))
    assert run.code == 2
    assert said in run.err
    assert run.err.count("\n") == 1


def test_a_motion_that_was_never_begun_has_a_status_and_no_error() -> None:
    study = _solved("spatial")
    surfaces = solved(study)
    task = next(task for task in Motions().arguments(study, surfaces) if task[1].key == "spatial")
    motion = moved(task)
    assert (motion.status, motion.error_message, len(motion.time)) == ("step limit", "", 0)


def test_a_model_that_answers_somewhere_is_kept_and_named() -> None:
    hierarchy = tuple(
        replace(model, amplification="fake_models:failing_point", settings={}) if model.key == "spatial" else model
        for model in fake_hierarchy()
    )
    study = Study((load_scene("fig3-I"),), 4, 1e-3, hierarchy)
    surfaces = solved(study)
    study = compared_study(study, surfaces)
    (lacking,) = unanswered(study, surfaces)
    assert (lacking.points, lacking.asked, lacking.used) == (1, 16, True)
    assert np.isfinite(waterfall(study, surfaces, study.scenes[0], 1).total.size)
