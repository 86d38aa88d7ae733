"""The first screen names the largest real difference, its place and its cause, and no difference that is none."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from fake_models import errors_in

from comparison.analysis.surfaces import labeled_surfaces
from comparison.analysis.verdicts import bar, verdict
from comparison.report.page_data import crossings
from comparison.study.batches import execute_batch
from comparison.study.study import Study
from reference.problem import load_scene

GRID = 8
LATER = ("exact", "resolved", "regularised", "translational", "spatial")


def _studied(gaps: dict[str, float], claimed: dict[str, float] | None = None) -> tuple[Study, xr.Dataset]:
    study = Study((load_scene("fig3-I"),), GRID, 1e-3, errors_in(gaps, claimed))
    batches = study.batches()
    return study, labeled_surfaces(study, batches, [execute_batch(batch) for batch in batches])


def _raised(surfaces: xr.Dataset, models: tuple[str, ...], body: int, row: int, column: int, by: float) -> None:
    place = {"body": body, "alpha1": surfaces["alpha1"][row], "alpha2": surfaces["alpha2"][column]}
    for model in models:
        surfaces["mu"].loc[{"model": model, **place}] *= 1.0 + by


def test_the_verdict_finds_the_planted_difference_and_its_cause() -> None:
    study, surfaces = _studied({})
    _raised(surfaces, LATER[2:], 2, 4, 6, -0.2)  # the regularized law lowers one point, and all that follow keep it
    _raised(surfaces, LATER[4:], 2, 4, 6, 0.05)
    judged = verdict(study, surfaces, study.scenes[0])
    assert (judged.body, judged.cause) == (2, "exact equations, v_reg")
    assert judged.size == pytest.approx(0.8 * 1.05 - 1.0, rel=1e-12)  # rounding
    assert judged.part == pytest.approx(-0.2, rel=1e-12)
    assert judged.phases == pytest.approx((np.pi, 1.5 * np.pi), rel=1e-15)
    assert "body 2 differs by −16 % at (180°, 270°)" in judged.sentence
    assert "largest step there: −20 %, to the exact equations, v_reg" in judged.sentence


def test_a_difference_within_its_uncertainty_is_no_verdict() -> None:
    study, surfaces = _studied({"spatial": 0.01}, {"spatial": 0.004})  # 2.5 times u_D
    judged = verdict(study, surfaces, study.scenes[0])
    assert (judged.body, judged.cause, judged.real) == (0, "", 0.0)
    assert "no real difference" in judged.sentence


def test_a_scene_without_any_common_point_says_so() -> None:
    study, surfaces = _studied({})
    surfaces["mu"].loc[{"model": "spatial"}] = np.nan
    assert "no phase pair in common" in verdict(study, surfaces, study.scenes[0]).sentence
    assert bar(study, surfaces, study.scenes[0], 1).segments == ()


def test_a_bar_has_every_step_at_its_mean_size_and_shares_that_fill_it() -> None:
    planted = {**dict.fromkeys(LATER[:3], 0.03), **dict.fromkeys(LATER[3:], 0.02)}
    study, surfaces = _studied(planted)
    bar_of_body = bar(study, surfaces, study.scenes[0], 1)
    sizes = {part.model: part.size for part in bar_of_body.segments}
    assert sizes == pytest.approx({**dict.fromkeys(LATER, 0.0), "exact": 0.03, "translational": 0.01}, abs=1e-12)
    assert sum(part.share for part in bar_of_body.segments) == pytest.approx(1.0, rel=1e-12)
    assert bar_of_body.total == pytest.approx(0.02, rel=1e-9), "steps of opposite sign cancel in the total"
    assert {part.model: part.real for part in bar_of_body.segments}["exact"] == 1.0


def test_the_line_of_the_uncertainty_runs_where_the_difference_crosses_it() -> None:
    """|D| = |cos alpha1| crosses 0.5 at pi/3 and its mirror images, whatever alpha2; lines between 48 points: 2e-3."""
    phase = 2.0 * np.pi * np.arange(48) / 48
    size = np.cos(phase)[:, None].repeat(48, axis=1)
    lines = crossings(size, np.full_like(size, 0.5), phase)
    where = sorted(float(np.mean([point[0] for point in line])) for line in lines)
    assert where == pytest.approx([np.pi / 3 * k for k in (1, 2, 4, 5)], abs=3e-3)
    assert all(np.ptp([point[1] for point in line]) == pytest.approx(2.0 * np.pi, abs=1e-3) for line in lines)
    assert crossings(size, np.zeros_like(size) - 1.0, phase) == [], "beyond everywhere: no line"
