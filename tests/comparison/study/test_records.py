"""Records, real models and softened bars in a study."""

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from browsers import CHROMIUM, FLAGS, OVERLAPS, PHONE, opened, unfolded, until
from fake_models import fake_hierarchy, known_motions
from known_analyses import analyses_are
from playwright.sync_api import sync_playwright
from runs import RUN
from studies import solved

import multibody
from comparison.analyses.assumptions.command import main as assumptions
from comparison.analyses.motions.analysis import chosen_places
from comparison.registry import ANALYSES, first_tasks, report_of
from comparison.run import main
from comparison.study.batches import refusal_of
from comparison.study.costs import seconds_per_point
from comparison.study.models import (
    MODEL_HIERARCHY,
    SOFTENED_SPATIAL,
    SOFTENED_TRANSLATIONAL,
    models_of,
    pairs_of,
    with_softened_bars,
)
from comparison.study.reductions import reductions
from comparison.study.study import Study
from comparison.surfaces.budget import budget
from comparison.surfaces.figures.pictures import Pictures
from comparison.surfaces.surfaces import NOT_ASKED, labeled_surfaces
from comparison.surfaces.unanswered import advice
from reference.problem import Outcome, Scene, example_scenes, load_scene

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
    values = report_of(study, surfaces, {}, [], RUN).results.scenes[0].values
    assert {(each.model, each.body): each.error for each in values} == {
        (model.key, body): record["error"].sel(model=model.key, body=body).values[0, 0]
        for model in study.hierarchy
        for body in (1, 2)
    }


def test_what_needs_phases_is_not_asked_of_a_record(study, capsys):
    stages = {task.stage for task in first_tasks(Study(study.scenes[:1], 4, 1e-3), ANALYSES)}
    assert stages == {"effective values"}
    assert Pictures().tasks(Study(study.scenes[:1], 4, 1e-3), labeled_surfaces(study, [], [])) == []
    assert reductions(Study(study.scenes[:1], 4, 1e-3)) == []
    (place,) = chosen_places(study, None, study.scenes[0])
    assert (place.row, place.column) == (0, 0)
    assert assumptions(["synthetic-pair"]) == 2
    assert capsys.readouterr().err.count("\n") == 1, "rings of a record are not varied"


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")
def test_the_page_shows_table_and_motions_of_a_record(tmp_path: Path) -> None:
    place = tmp_path / "report"
    with pytest.MonkeyPatch.context() as patch:
        analyses_are(patch, motions=known_motions)
        words = [*example_scenes(), "--grid", "4", "--jobs", "1", "--out", str(place)]
        assert main(words, fake_hierarchy(), ThreadPoolExecutor) == 0
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        visit = opened(browser, place / "index.html", PHONE)
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


PLAIN = load_scene("fig3-I")
BARS = {"count": 4, "bending_stiffness": 0.8, "length": 1.0}
BARE = {"isolator.supports": None, "isolator.ring": None, "isolator.sphere_radius": None}


def on_bars(**values: object) -> Scene:
    bars = {"bodies.1.period": None, "bodies.1.bars": BARS}
    return PLAIN.with_values({"duration": 1.0, "name": "bars", **bars, **values}).with_amplitude(2.0)


@pytest.mark.parametrize(("values", "step"), [({}, SOFTENED_SPATIAL), (BARE, SOFTENED_TRANSLATIONAL)])
def test_bars_are_softened_last_and_never_like_for_like(values: dict[str, object], step: object) -> None:
    scene = on_bars(**values)
    hierarchy = with_softened_bars(MODEL_HIERARCHY, [PLAIN, scene])
    assert models_of(scene, hierarchy)[-1] == step
    assert step not in models_of(PLAIN, hierarchy)
    pairs = {pair.key: pair for pair in pairs_of(scene, hierarchy)}
    assert pairs["total"].second == step
    assert "softened" not in {*pairs["like-for-like"].second.settings, *pairs["translational"].second.settings}
    loaded = on_bars(**{"bodies.1.bars.load_effect": "softening"})
    assert with_softened_bars(MODEL_HIERARCHY, [PLAIN, loaded]) == MODEL_HIERARCHY, "every model has it"


def test_a_softened_step_has_phases_and_cost_of_its_model() -> None:
    scene = on_bars()
    *_, spatial, softened = with_softened_bars(MODEL_HIERARCHY, [scene])
    assert softened.most == spatial.most
    assert seconds_per_point(scene, softened) == pytest.approx(0.22 / 20.0), "1 s of 20, two bodies"
    taller = PLAIN.with_values({"bodies": [*PLAIN.bodies, PLAIN.bodies[-1]]})
    assert seconds_per_point(taller, spatial) == pytest.approx(1.5 * 0.22)


def test_bars_that_buckle_cost_no_other_model() -> None:
    scene = on_bars(**BARE, **{"bodies.1.bars.bending_stiffness": 0.2})
    hierarchy = with_softened_bars(MODEL_HIERARCHY, [scene])
    reason = refusal_of(scene, SOFTENED_TRANSLATIONAL, 1e-3)
    assert "buckle sideways" in reason
    assert "\n" not in reason
    study = Study((scene,), 1, 1e-3, models_of(scene, hierarchy)[3:])
    surfaces = solved(study)
    finite = {key: bool(np.isfinite(surfaces["mu"].sel(model=key)).all()) for key in surfaces["model"].values.tolist()}
    assert finite.pop("softened-translational") is False
    assert finite == {"regularised": True, "translational": True}
    assert "buckle sideways" in advice(study, scene, SOFTENED_TRANSLATIONAL, Outcome.SOLVER_FAILED)


def test_the_step_gives_what_the_softened_scene_gives() -> None:
    scene = on_bars()
    settings = {"model": "translational", "tolerance": 1e-3}
    step = multibody.amplification(scene, [(0.3, 1.1)], softened=True, **settings)
    softened = multibody.amplification(scene.softened(), [(0.3, 1.1)], **settings)
    np.testing.assert_array_equal(step.mu, softened.mu)
    assert np.abs(step.mu - multibody.amplification(scene, [(0.3, 1.1)], **settings).mu).max() > 0.01
    motion = multibody.trajectory(scene, (0.3, 1.1), softened=True, **settings)
    assert motion.scene == scene.softened()
