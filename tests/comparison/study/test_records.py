"""A study with recorded motions: one point per scene and model, tables and motions in place of surfaces."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from browsers import CHROMIUM, FLAGS, OVERLAPS, PHONE, opened, unfolded, until
from fake_models import fake_hierarchy, known_motions
from known_analyses import analyses_are
from places import EXAMPLES
from playwright.sync_api import sync_playwright
from report_texts import page_of, summary_of
from runs import Run
from studies import solved

from comparison.analyses.assumptions.command import main as assumptions
from comparison.analyses.motions.analysis import chosen_places
from comparison.registry import ANALYSES, first_tasks
from comparison.run import main
from comparison.study.reductions import reductions
from comparison.study.study import Study
from comparison.surfaces.budget import budget
from comparison.surfaces.figures.pictures import Pictures
from comparison.surfaces.surfaces import NOT_ASKED, labeled_surfaces
from reference.problem import example_scenes, load_family, load_scene

MIXED = ("synthetic-pair", "fig4-viscous")


@pytest.fixture
def study() -> Study:
    return Study(tuple(map(load_scene, MIXED)), 4, 1e-3, fake_hierarchy(gap=0.01))


def test_a_record_is_one_point_beside_the_grid_of_others(study):
    surfaces = solved(study)
    record, grid = (surfaces.sel(scene=name) for name in MIXED)
    assert [len(batch.phases) for batch in study.batches() if batch.scene.recorded] == [1] * 6
    assert (record["status"].isel(alpha1=0, alpha2=0) == "ok").all()
    assert (record["status"] == NOT_ASKED).sum() == 6 * 15
    assert np.isfinite(grid["mu"].sel(model="small")).all()
    entries = [entry for entry in budget(study, surfaces) if entry.scene == "synthetic-pair"]
    total = next(entry for entry in entries if (entry.body, entry.step) == (1, "total"))
    assert (total.asked, total.median) == (1, pytest.approx(0.01))
    assert np.isnan([*total.phases, total.peak_moves]).all()


def test_what_needs_phases_is_not_asked_of_a_record(study):
    stages = {task.stage for task in first_tasks(Study(study.scenes[:1], 4, 1e-3), ANALYSES)}
    assert stages == {"effective values"}
    assert Pictures().tasks(Study(study.scenes[:1], 4, 1e-3), labeled_surfaces(study, [], [])) == []
    assert reductions(Study(study.scenes[:1], 4, 1e-3)) == []
    (place,) = chosen_places(study, None, study.scenes[0])
    assert (place.row, place.column) == (0, 0)


@pytest.mark.long
def test_a_mixed_study_is_planned_computed_and_checked(command: Callable[..., Run]) -> None:
    plan = command(*MIXED, "--grid", "4", "--plan")
    assert (plan.code, "one point per model" in plan.out) == (0, True)
    run = command(*MIXED, "--grid", "4", "--check", hierarchy=fake_hierarchy(gap=0.0))
    assert (run.code, run.err) == (0, "")
    first, second = summary_of(run.report)["scenes"]
    assert {row["asked"] for row in first["differences"]} == {1}
    assert {tuple(row["phases"]) for row in first["differences"]} == {(None, None)}
    assert [scene["models"]["small"]["phases_per_axis"] for scene in (first, second)] == [1, 4]
    with xr.open_dataset(run.report / "surfaces.nc", engine="h5netcdf") as stored:
        assert stored["recorded"].values.tolist() == [True, False]
    names = sorted(file.name for file in (run.report / "figures").iterdir())
    assert names
    assert not [name for name in names if name.startswith("synthetic")]


def test_a_broken_limit_of_a_record_is_told(command: Callable[..., Run]) -> None:
    run = command("synthetic-pair", "--check", hierarchy=fake_hierarchy(gap=0.01))
    assert run.code == 1
    assert "synthetic-pair" in run.err


@pytest.mark.long
def test_a_family_of_scales_is_drawn(command: Callable[..., Run], tmp_path: Path) -> None:
    text = (EXAMPLES / "synthetic-pair.toml").read_text(encoding="utf-8")
    file = tmp_path / "mine.toml"
    file.write_text(text.replace("scale = 1.0", "scale = {range = [0.5, 2.0], steps = 4}"), encoding="utf-8")
    assert [scene.record[5, 1] / load_scene("synthetic-pair").record[5, 1] for scene in load_family(file).scenes] == [
        0.5, 1.0, 1.5, 2.0,
    ]  # fmt: skip
    run = command(str(file))
    assert run.code == 0
    assert (run.report / "figures" / "mine-body1-family.png").exists()
    assert "4 values of excitation.scale" in page_of(run.report)


def test_varied_rings_are_refused_of_a_record_in_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert assumptions(["synthetic-pair"]) == 2
    assert capsys.readouterr().err.count("\n") == 1


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")
def test_the_page_shows_table_and_motions_of_a_record(tmp_path: Path) -> None:
    place = tmp_path / "report"
    with pytest.MonkeyPatch.context() as patch:
        analyses_are(patch, motions=known_motions)
        words = [*example_scenes(), "--grid", "4", "--jobs", "1", "--out", str(place)]
        assert main(words, fake_hierarchy(), ThreadPoolExecutor) == 0
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        for width in (PHONE,):
            visit = opened(browser, place / "index.html", width)
            page = visit.page
            assert page.locator("canvas.surface:visible").count() == 0
            assert page.locator("[data-record]:visible tbody tr").count() == 6, "one row for each model"
            until(page, "document.querySelector('[data-part=plots] svg')")
            page.locator("[data-part=pair]").select_option("like-for-like")
            until(page, "document.querySelector('[data-part=plots] .legend')?.textContent.includes('translational')")
            page.locator("[data-part=scene]").select_option(index=1)
            page.locator("[data-part=body]").select_option("2")
            assert page.locator("[data-record='1-2']").is_visible()
            unfolded(page)
            assert page.evaluate(OVERLAPS)["faults"] == []
            assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
            assert "phases per axis" not in page.inner_text("main")
            assert (visit.complaints, len(visit.requests)) == ([], 1)
        browser.close()
