"""Demands of every phase pair in a study: the surfaces, their symmetry, statistics, gaps, and the report."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from known_analyses import collected

import reference
from comparison.analyses.demands.analysis import DemandSurfaces, demand_statistics
from comparison.study.models import EXACT, REGULARIZED, SMALL
from comparison.study.study import Study
from reference.problem import load_scene
from reference.problem.phases import phase_axis


@pytest.fixture(scope="module")
def study() -> Study:
    """A scene with mirrored phases, shortened, and one under a record."""
    first = load_scene("fig3-I").with_values({"duration": 1.5, "name": "fig3-I"})
    record = load_scene("synthetic-pair").with_values({"duration": 2.0})
    return Study((first, record), 4, 1e-3, (SMALL, EXACT, REGULARIZED))


@pytest.fixture(scope="module")
def demands(study: Study) -> xr.Dataset:
    found: xr.Dataset = collected(DemandSurfaces(), study)
    return found


def test_every_pair_has_the_demands_of_its_own_motion(study: Study, demands: xr.Dataset) -> None:
    scene, axis = study.scenes[0], phase_axis(4)
    assert len(study.solved(scene, REGULARIZED)) < 16, "mirrored ones are not computed again"
    pairs = [(axis[row], axis[column]) for row in range(4) for column in range(4)]
    expected = reference.peak_demands(scene, pairs, regularization=1e-3)
    for name, estimates in expected.items():
        there = demands[name].sel(scene=scene.name, model=REGULARIZED.key)
        error = demands[f"{name}_error"].sel(scene=scene.name, model=REGULARIZED.key)
        if "body" in there.dims:
            bodies = [2] if name == "drift" else [1, 2]
            there, error = (each.sel(body=bodies).transpose(..., "body") for each in (there, error))
        values = np.asarray(there).reshape(16, -1)
        known = estimates.value.reshape(16, -1)
        assert (np.isfinite(values) == np.isfinite(known)).all()
        far = np.abs(values - known) > np.asarray(error).reshape(16, -1) + estimates.error.reshape(16, -1)
        assert not far.any(), name
    assert set(demands["status"].sel(scene=scene.name, model=REGULARIZED.key).values.ravel()) == {"ok"}


def test_a_record_has_one_value_and_no_phases(study: Study, demands: xr.Dataset) -> None:
    rows = {(row.model, row.quantity, row.body): row for row in demand_statistics(study, demands, study.scenes[1])}
    row = rows[EXACT.key, "base_shear", 0]
    assert (row.points, row.unknown) == (1, 0.0)
    assert row.lowest.value == row.mean.value == row.highest.value
    assert np.isnan(row.highest.phases).all()


def test_an_unknown_error_of_a_demand_is_one_of_its_mean(study: Study, demands: xr.Dataset) -> None:
    unsure = demands.assign(drift_error=demands["drift_error"].where(demands["alpha1"] > 0.0))
    rows = {
        (row.model, row.quantity): row for row in demand_statistics(study, unsure, study.scenes[0]) if row.body == 2
    }
    assert [np.isnan(rows[SMALL.key, name].mean.error) for name in ("drift", "acceleration")] == [True, False]


def test_a_task_that_fails_costs_its_own_pairs_alone(study: Study) -> None:
    broken = replace(EXACT, trajectory="fake_models:refused")
    found = collected(DemandSurfaces(), replace(study, hierarchy=(SMALL, broken)))
    assert set(found["status"].sel(scene="fig3-I", model="exact").values.ravel()) == {"solver failed"}
    assert np.isnan(found["base_shear"].sel(model="exact")).all()
    assert np.isfinite(found["base_shear"].sel(scene="fig3-I", model="small")).all()
