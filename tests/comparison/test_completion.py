"""A coarse model is completed through a finer one only where that is right: known ridges, known roughness."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from fake_models import errors_in
from numpy.typing import NDArray

from comparison.analysis.completion import Completion, completions, leave_one_out, torus, with_completed
from comparison.analysis.surfaces import labeled_surfaces
from comparison.study.batches import execute_batch
from comparison.study.study import Study
from reference.problem import load_scene

Array = NDArray[np.float64]
FINE, COARSE = 48, 16
PHASE = 2.0 * np.pi * np.arange(FINE) / FINE


@pytest.fixture(scope="module")
def blank() -> tuple[Study, xr.Dataset]:
    """A study of 48 x 48 phases, 16 x 16 of the translational model, 4 x 4 of the spatial one."""
    study = Study((load_scene("fig3-I"),), FINE, 1e-3, errors_in({}))
    batches = study.batches()
    return study, labeled_surfaces(study, batches, [execute_batch(batch) for batch in batches])


def ridge(alpha1: Array, alpha2: Array) -> Array:
    """1.5 with a ridge of height 1 that is 3 degrees wide: 16 phases are 22.5 degrees apart."""
    middle = 2.0 * np.pi * 13 / FINE  # 7.5 degrees from the nearest coarse phase
    return 1.5 + np.exp(-(((alpha1 - middle) / np.radians(3.0)) ** 2)) + 0.3 * np.cos(alpha2)


def gap(alpha1: Array, alpha2: Array) -> Array:
    """What the engine adds: small and smooth."""
    return 2e-3 * np.cos(alpha1 + 2.0 * alpha2) + 1e-3


def completed(blank: tuple[Study, xr.Dataset], base: Array, difference: Array, first: float = 0.9) -> Completion:
    """The completion of the translational model, which is `base` + `difference`; the paper's is `first` * base."""
    study, surfaces = blank
    mu = surfaces["mu"].copy(deep=True)
    for model in ("exact", "resolved", "regularised"):
        mu.loc[{"model": model, "body": 1}] = base
    mu.loc[{"model": "small", "body": 1}] = first * base
    every = slice(None, None, FINE // COARSE)
    sparse = np.full_like(base, np.nan)
    sparse[every, every] = (base + difference)[every, every]
    mu.loc[{"model": "translational", "body": 1}] = sparse
    listed = completions(study, surfaces.assign(mu=mu, error=0.0 * mu), study.scenes[0])
    return next(surface for surface in listed if (surface.model, surface.body) == ("translational", 1))


ALPHA = np.meshgrid(PHASE, PHASE, indexing="ij")


def test_a_ridge_that_the_coarse_phases_miss_stands_in_the_completed_surface(blank: tuple[Study, xr.Dataset]) -> None:
    base, difference = ridge(*ALPHA), gap(*ALPHA)
    every = slice(None, None, FINE // COARSE)
    assert base.max() - base[every, every].max() > 0.9, "the coarse phases miss it"
    surface = completed(blank, base, difference)
    assert (surface.accepted, surface.difference_accepted, surface.through) == (True, True, "regularised")
    truth = base + difference
    assert np.abs(surface.mu - truth).max() < 2e-4, "the ridge is there, and the small difference on it"
    assert np.abs(surface.mu - truth).max() < 3.0 * surface.error, "the error that is stated is of the right size"
    computed = surface.mu[every, every]
    np.testing.assert_allclose(computed, truth[every, every], rtol=1e-12, err_msg="computed values stay as they are")


def test_a_difference_that_is_not_smooth_is_refused(blank: tuple[Study, xr.Dataset]) -> None:
    rough = 0.1 * np.random.default_rng(0).uniform(-1.0, 1.0, (FINE, FINE))
    surface = completed(blank, ridge(*ALPHA), rough)
    assert not surface.accepted
    assert not surface.difference_accepted
    assert "leaving out" in surface.reason
    assert np.isnan(surface.mu).all(), "nothing that could be drawn by mistake"


def test_a_jump_in_the_difference_is_refused(blank: tuple[Study, xr.Dataset]) -> None:
    jump = np.where(ALPHA[0] + ALPHA[1] > 2.0 * np.pi, 0.1, 0.0)
    assert not completed(blank, ridge(*ALPHA), jump).accepted


def test_the_surface_may_be_drawn_where_its_tiny_difference_from_the_paper_may_not(
    blank: tuple[Study, xr.Dataset],
) -> None:
    rough = 1e-3 * np.random.default_rng(0).uniform(-1.0, 1.0, (FINE, FINE))
    surface = completed(blank, ridge(*ALPHA), rough, first=1.0)
    assert (surface.accepted, surface.difference_accepted) == (True, False)


def test_the_spatial_model_is_never_a_surface_on_few_phases(blank: tuple[Study, xr.Dataset]) -> None:
    study, surfaces = blank
    listed = [surface for surface in completions(study, surfaces, study.scenes[0]) if surface.model == "spatial"]
    assert [(surface.accepted, surface.computed) for surface in listed] == [(False, 16)] * 2
    assert "4 × 4 phases are too few" in listed[0].reason
    small = Study(study.scenes, 4, 1e-3, tuple(model for model in study.hierarchy))
    whole = labeled_surfaces(small, small.batches(), [execute_batch(batch) for batch in small.batches()])
    listed = completions(small, whole, small.scenes[0])
    assert {surface.model for surface in listed} == set(), "fake models do not say that they are spatial"


def test_points_without_a_value_leave_the_rest_completed(blank: tuple[Study, xr.Dataset]) -> None:
    base, difference = ridge(*ALPHA), gap(*ALPHA)
    difference[9, 12] = np.nan
    surface = completed(blank, base, difference)
    assert (surface.accepted, surface.computed) == (True, 255)
    assert np.abs(surface.mu - base - gap(*ALPHA)).max() < 2e-4


def test_a_record_and_a_model_that_has_all_phases_need_no_completion(blank: tuple[Study, xr.Dataset]) -> None:
    study, surfaces = blank
    assert {surface.model for surface in completions(study, surfaces, study.scenes[0])} == {"translational", "spatial"}
    record = Study((load_scene("synthetic-pair"),), 4, 1e-3, errors_in({}))
    assert completions(record, surfaces, record.scenes[0]) == []


def test_leaving_out_by_turning_the_values_is_the_same_as_one_by_one() -> None:
    phase = 2.0 * np.pi * np.arange(10) / 10
    values = np.random.default_rng(1).normal(size=(10, 10))
    turned = leave_one_out(values, phase)
    values[7, 7] = np.nan  # a gap: one by one
    singly = leave_one_out(values, phase)
    assert np.isnan(singly[7, 7])
    from scipy.interpolate import RBFInterpolator

    places, kept = torus(phase), np.arange(100) != 34
    values = np.random.default_rng(1).normal(size=(10, 10)).ravel()
    assert turned.ravel()[34] == pytest.approx(RBFInterpolator(places[kept], values[kept])(places[34:35])[0], rel=1e-9)
    kept[77] = False
    assert singly.ravel()[34] == pytest.approx(RBFInterpolator(places[kept], values[kept])(places[34:35])[0], rel=1e-9)


def test_the_completed_surfaces_stand_beside_the_computed_ones(blank: tuple[Study, xr.Dataset]) -> None:
    study, surfaces = blank
    listed = completions(study, surfaces, study.scenes[0])
    both = with_completed(surfaces, listed)
    assert np.isfinite(both["completed"].sel(model="translational")).all()
    assert np.isnan(both["completed"].sel(model=["small", "spatial"])).all()
    xr.testing.assert_identical(both.drop_vars("completed"), surfaces)
