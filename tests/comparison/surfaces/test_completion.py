"""A coarse model is completed through a finer one only where that is right: known ridges, known roughness."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from fake_models import errors_in
from known_analyses import collected
from numpy.typing import NDArray
from studies import solved

from comparison.runner.runner import Runner
from comparison.runner.task_results import TaskResults
from comparison.study.models import TRANSLATIONAL
from comparison.study.study import Study
from comparison.surfaces import completion
from comparison.surfaces.completion import (
    CONFIDENCE,
    CompletedSurfaces,
    Completion,
    HeldOut,
    add_completed,
    choose_held_out,
    complete_surfaces,
    interpolate_on_phases,
)
from reference.problem import load_scene

Array = NDArray[np.float64]
FINE, COARSE = 48, 16
ENGINE_ERROR = 2e-4  # relative, the largest of the held-out values


@pytest.fixture(scope="module")
def blank() -> tuple[Study, xr.Dataset]:
    """A study of 48 x 48 phases, 16 x 16 of the translational model, 4 x 4 of the spatial one."""
    study = Study((load_scene("fig3-I"),), FINE, 1e-3, errors_in({}))
    return study, solved(study)


def square(grid: int) -> tuple[Array, Array]:
    phase = 2.0 * np.pi * np.arange(grid) / grid
    alpha1, alpha2 = np.meshgrid(phase, phase, indexing="ij")
    return alpha1, alpha2


ALPHA = square(FINE)


def ridge(alpha1: Array, alpha2: Array) -> Array:
    """1.5 with a ridge of height 1 that is 3 degrees wide: 16 phases are 22.5 degrees apart."""
    middle = 2.0 * np.pi * 13 / FINE  # 7.5 degrees from the nearest coarse phase
    return 1.5 + np.exp(-(((alpha1 - middle) / np.radians(3.0)) ** 2)) + 0.3 * np.cos(alpha2)


def gap(alpha1: Array, alpha2: Array) -> Array:
    """What the engine adds: small and smooth."""
    return 2e-3 * np.cos(alpha1 + 2.0 * alpha2) + 1e-3


ENGINE = errors_in({})[6]


def unused(study: Study, truth: Array) -> HeldOut:
    """The truth at the held-out phase pairs of the translational model, the same for both bodies."""
    values = np.repeat(truth.ravel()[choose_held_out(study, study.scenes[0], ENGINE)][:, None], 2, axis=1)
    share = np.where(np.arange(len(values)) == 7, 1.0, 0.5)  # the largest is at one of them
    return HeldOut(values, ENGINE_ERROR * share[:, None] * values)


def completed(
    blank: tuple[Study, xr.Dataset],
    base: Array,
    difference: Array,
    first: float = 0.9,
    held_out: HeldOut | None = None,
) -> Completion:
    """The completion of the translational model, which is `base` + `difference`; the paper's is `first` * base."""
    study, surfaces = blank
    mu = surfaces["mu"].copy(deep=True)
    for model in ("resolved", "regularised"):
        mu.loc[{"model": model, "body": 1}] = base
    mu.loc[{"model": "small-resolved", "body": 1}] = first * base
    every = slice(None, None, FINE // COARSE)
    sparse = np.full_like(base, np.nan)
    sparse[every, every] = (base + difference)[every, every]
    mu.loc[{"model": "translational", "body": 1}] = sparse
    known = {("fig3-I", "translational"): held_out or unused(study, base + difference)}
    listed = complete_surfaces(study, surfaces.assign(mu=mu, error=0.0 * mu), study.scenes[0], known)
    return next(surface for surface in listed if (surface.model, surface.body) == ("translational", 1))


def test_a_ridge_between_coarse_phases_is_completed(blank: tuple[Study, xr.Dataset]) -> None:
    base, difference = ridge(*ALPHA), gap(*ALPHA)
    every = slice(None, None, FINE // COARSE)
    assert base.max() - base[every, every].max() > 0.9, "the coarse phases miss it"
    surface = completed(blank, base, difference)
    assert (surface.accepted, surface.difference_accepted, surface.through) == (True, True, "regularised")
    truth = base + difference
    missed = np.abs(surface.mu / truth - 1.0)
    assert missed.max() < 2e-4, "the ridge is there, and the small difference on it"
    assert (missed > surface.error).mean() < 0.05, "not more phase pairs are off by more than it states"
    assert (surface.held_out, surface.confidence, surface.asked) == (59, CONFIDENCE, 1e-3)
    assert surface.share == pytest.approx(0.05, abs=5e-4)
    assert surface.model_error == pytest.approx(ENGINE_ERROR)
    apart = np.percentile(np.abs(truth / (0.9 * base) - 1.0), 95.0, method="hazen")
    assert surface.difference == pytest.approx(apart, rel=2e-3)
    for share in (4.9, 5.1):
        assert replace(surface, difference=share * surface.error).difference_accepted == (share > 5.0)
    assert f"{100.0 * surface.error:.2g} % at 59 held-out phase pairs" in surface.certificate
    assert "with 95 % confidence at most 5 % of the phase pairs" in surface.certificate
    computed = surface.mu[every, every]
    np.testing.assert_allclose(computed, truth[every, every], rtol=1e-12, err_msg="computed values stay as they are")


def test_a_difference_that_is_not_smooth_is_refused(blank: tuple[Study, xr.Dataset]) -> None:
    rough = np.random.default_rng(0).uniform(-1.0, 1.0, (FINE, FINE))
    surface = completed(blank, ridge(*ALPHA), 0.1 * rough)
    assert (surface.accepted, surface.difference_accepted) == (False, False)
    assert "misses held-out phase pairs" in surface.reason
    assert np.isnan(surface.mu).all(), "nothing that could be drawn by mistake"
    surface = completed(blank, ridge(*ALPHA), 5e-4 * rough, first=1.0)
    assert (surface.accepted, surface.difference_accepted) == (True, False), "its values may be drawn"


def test_a_spatial_model_on_few_phases_is_no_surface(blank: tuple[Study, xr.Dataset]) -> None:
    study, surfaces = blank
    small = Study(study.scenes, 4, 1e-3, study.hierarchy)
    assert complete_surfaces(small, solved(small), small.scenes[0], {}) == [], (
        "fake models do not say that they are spatial"
    )
    for most, reason in ((8, "8 × 8 phases are too few for a surface"), (16, "its supports stop one by one")):
        hierarchy = [
            replace(model, settings={"model": "spatial"}, most=most) if model.key == "spatial" else model
            for model in study.hierarchy
        ]
        spatial = replace(study, hierarchy=hierarchy)
        found = complete_surfaces(spatial, surfaces, study.scenes[0], {})
        assert [each.reason.split(":")[0] for each in found if each.model == "spatial"] == [reason] * 2
        assert {task.argument[1].key for task in CompletedSurfaces().tasks(spatial)} == {"translational"}


def test_points_without_a_value_leave_the_rest_completed(blank: tuple[Study, xr.Dataset]) -> None:
    base, difference = ridge(*ALPHA), gap(*ALPHA)
    difference[9, 12] = np.nan
    surface = completed(blank, base, difference)
    assert (surface.accepted, surface.computed, surface.held_out) == (True, 255, 59)
    assert np.abs(surface.mu - base - gap(*ALPHA)).max() < 2e-4


def test_held_out_phases_without_a_value_weaken_the_statement(blank: tuple[Study, xr.Dataset]) -> None:
    base, difference = ridge(*ALPHA), gap(*ALPHA)
    few = unused(blank[0], base + difference).mu
    for count, reason in ((30, ""), (31, "28 held-out phase pairs with a value are too few")):
        few[:count] = np.nan
        surface = completed(blank, base, difference, held_out=HeldOut(few, 0.0 * few))
        assert surface.reason == reason, "29 say that at most 10 % are off by more, with 95 % confidence"
        assert surface.share == pytest.approx(1.0 if reason else 1.0 - 0.05 ** (1 / 29))


def test_records_and_models_with_all_phases_are_not_completed(blank: tuple[Study, xr.Dataset]) -> None:
    study, surfaces = blank
    record = Study((load_scene("synthetic-pair"),), 4, 1e-3, errors_in({}))
    assert complete_surfaces(record, surfaces, record.scenes[0], {}) == []
    assert CompletedSurfaces().tasks(record) == []
    level = CompletedSurfaces().tasks(replace(study, grid=COARSE))
    assert {task.argument[1].key for task in level} == {"spatial"}, "a level that has all phases holds none of them out"


@pytest.mark.parametrize(("scene", "images", "grid"), [("fig3-I", 4, FINE), ("fig3-II", 2, FINE), ("fig3-I", 4, 50)])
def test_held_out_phases_are_no_mirror_images(scene: str, images: int, grid: int) -> None:
    """Of 50 phases a model computes 13, the last closer to the first than the others."""
    model = replace(TRANSLATIONAL, most=COARSE)
    named = replace(model, key="other")
    study = Study((load_scene(scene),), grid, 1e-3, (model, named))
    chosen = choose_held_out(study, study.scenes[0], model)
    assert len(chosen) == 59
    np.testing.assert_array_equal(chosen, choose_held_out(study, study.scenes[0], model), err_msg="alike in every run")
    row, column = np.divmod(chosen, grid)
    half, stride = grid // 2, study.stride(model)
    shifts = [(0, 0), (half, half), (0, half), (half, 0)][:images]
    every = {((r + a) % grid, (c + b) % grid) for r, c in zip(row, column) for a, b in shifts}
    assert len(every) == 59 * images, "each counts once"
    assert all(r % stride or c % stride for r, c in every), "none was computed"
    for other in (study, load_scene("fig4-dry"), model), (study, study.scenes[0], named):
        assert len(np.intersect1d(chosen, choose_held_out(*other))) < 20, "another scene or model, another choice"
    full = choose_held_out(replace(study, full=True), study.scenes[0], model)
    assert len(full) == 59
    assert (np.column_stack(np.divmod(full, grid)) % stride).any(axis=1).all()


def test_the_analysis_computes_what_is_held_out(
    blank: tuple[Study, xr.Dataset], monkeypatch: pytest.MonkeyPatch
) -> None:
    study, surfaces = blank
    found = collected(CompletedSurfaces(), study)
    (scene,) = study.scenes
    assert set(found) == {(scene.name, "translational"), (scene.name, "spatial")}
    place = choose_held_out(study, scene, ENGINE)
    truth = surfaces["mu"].sel(scene=scene.name, model="exact").values.reshape(2, -1)[:, place]
    np.testing.assert_allclose(found[scene.name, "translational"].mu.T, truth, rtol=1e-12)
    listed = complete_surfaces(study, surfaces, scene, found)
    assert all(surface.accepted for surface in listed)
    of_engine = found[scene.name, "translational"]
    worse = {**found, (scene.name, "translational"): HeldOut(of_engine.mu, of_engine.error * [1.0, 3.0])}
    one, other = complete_surfaces(study, surfaces, scene, worse)[:2]
    assert other.model_error == pytest.approx(3.0 * one.model_error), "of its own body"
    stored = add_completed(surfaces, [replace(one, error=0.01), replace(other, error=0.02)]).sel(model="translational")
    np.testing.assert_array_equal(stored["completed"].values, [[one.mu, other.mu]])
    assert stored["completed_error"].values.tolist() == [[0.01, 0.02]]
    assert CompletedSurfaces().collect(study, surfaces, TaskResults()) is None, "where the time ended before them"
    reasons = {surface.reason for surface in complete_surfaces(study, surfaces, scene, None)}
    assert reasons == {"no phase pairs were held out to check an interpolation"}
    part = TaskResults()
    Runner(part, 2, ThreadPoolExecutor).run(CompletedSurfaces().tasks(study)[:-1])
    assert set(CompletedSurfaces().collect(study, surfaces, part) or ()) == {(scene.name, "translational")}
    monkeypatch.setattr(completion, "compute_held_out", lambda task: 1.0 / 0.0)
    lost = collected(CompletedSurfaces(), study)
    for part in (part for held_out in lost.values() for part in (held_out.mu, held_out.error)):
        np.testing.assert_array_equal(part, np.full((59, 2), np.nan), err_msg="tasks that fail")
    reasons = {surface.reason for surface in complete_surfaces(study, surfaces, scene, lost)}
    assert reasons == {"0 held-out phase pairs with a value are too few"}


def bump(random: np.random.Generator, alpha: tuple[Array, Array]) -> Array:
    """A difference on 6 to 12 % of the phase pairs somewhere, rough there, and a little noise everywhere."""
    middle = random.uniform(0.0, 2.0 * np.pi, 2)
    apart = [np.abs(np.angle(np.exp(1j * (axis - m)))) for axis, m in zip(alpha, middle)]
    inside = np.maximum(*apart) < np.pi * np.sqrt(random.uniform(0.06, 0.12))
    return 1e-5 * random.normal(size=inside.shape) + np.where(inside, 0.01 * random.uniform(0.5, 1.0, inside.shape), 0)


def test_a_certificate_holds_as_often_as_its_confidence() -> None:
    """Of random surfaces; it holds where no larger share is off by more than it states."""
    grid, surfaces = 18, 120
    models = errors_in({})[3], replace(ENGINE, most=grid // 2)
    study = Study((load_scene("fig3-I"),), grid, 1e3, models)  # every surface is kept, however far it is off
    (scene,), every, blank = study.scenes, study.places(models[1]), solved(study)
    random, alpha = np.random.default_rng(0), square(grid)
    base = 2.0 + np.cos(alpha[0])
    kept = 0
    for _ in range(surfaces // 2):  # of two bodies each
        truth = np.stack([base + bump(random, alpha) for _ in range(2)])
        sparse = np.full((2, grid**2), np.nan)
        sparse[:, every] = truth.reshape(2, -1)[:, every]
        mu = blank["mu"].copy(data=np.stack([np.stack([base, base]), sparse.reshape(truth.shape)])[None])
        values = truth.reshape(2, -1)[:, choose_held_out(study, scene, models[1])].T
        known, held_out = blank.assign(mu=mu, error=0.0 * mu), {(scene.name, ENGINE.key): HeldOut(values, 0.0 * values)}
        for surface in complete_surfaces(study, known, scene, held_out):
            missed = np.abs(surface.mu / truth[surface.body - 1] - 1.0).ravel()
            between = np.delete(missed, every)
            kept += (between > surface.error * (1.0 + 1e-9)).mean() <= surface.share
    assert kept >= CONFIDENCE * surfaces


def test_a_smooth_surface_is_completed_to_a_few_thousandths() -> None:
    """Thin-plate splines from 12 phases per axis do it; planes between them miss 3 %."""
    coarse, fine = (2.0 * np.pi * np.arange(count) / count for count in (12, 48))
    truth = 2.0 + np.cos(fine[:, None] - 0.4) + 0.5 * np.sin(fine)
    made = interpolate_on_phases(truth[::4, ::4], coarse, fine)
    np.testing.assert_allclose(made[::4, ::4], truth[::4, ::4], rtol=1e-9)
    assert np.abs(made / truth - 1.0).max() < 4e-3
