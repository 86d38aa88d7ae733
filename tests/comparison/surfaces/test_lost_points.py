"""A model that fails costs its own points and nothing else: NaN with a status, counted; the run goes on."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from fake_models import fake_hierarchy
from report_texts import Tables, page_of, summary_of
from runs import Run
from studies import solved

from comparison.study.study import Study
from reference.problem import load_scene

GRID = ["fig3-I", "--grid", "4", "--jobs", "2"]


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
    run = command(*GRID, hierarchy=fake_hierarchy("raising", batch=4))
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
    run = command(*GRID, hierarchy=fake_hierarchy("always_raising"))
    assert run.code == 0
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
    run = command(*GRID, "--check", hierarchy=hierarchy)
    assert run.code == 1
    assert "nan found" not in run.err
    assert "no value in common at any phase pair" in (run.report / "summary.md").read_text(encoding="utf-8")
    summary = summary_of(run.report)
    assert {row["median"] for row in summary["scenes"][0]["differences"]} == {None}


def test_check_passes_no_limit_without_a_comparison(command: Callable[..., Run]) -> None:
    run = command(*GRID, "--check", hierarchy=fake_hierarchy("always_raising"))
    assert run.code == 1
    assert (
        "limit broken: fig3-I: acceptance.median: nothing to compare (translational engine: no value at any" in run.err
    )
    assert "nan" not in run.err


def test_what_is_not_ok_and_what_has_no_value_are_counted_apart(command: Callable[..., Run]) -> None:
    """One phase pair of 16 has no value, four miss the tolerance."""
    run = command(*GRID, hierarchy=fake_hierarchy("patchy"))
    for row in summary_of(run.report)["scenes"][0]["differences"]:
        assert (row["not_ok"], row["unanswered"], row["asked"]) == (5, 1, 16)
    for row in Tables(page_of(run.report)).headed("not ok", "no value"):
        assert (row["not ok"], row["no value"], row["phase pairs"]) == ("5", "1", "16")
    rows = [line.split() for line in run.out.splitlines() if line.split()[:1] == ["fig3-I"] and "like" in line]
    assert [row[-1] for row in rows] == ["5", "5"]
