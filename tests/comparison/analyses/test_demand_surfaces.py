"""Demands of every phase pair in a study: the surfaces, their symmetry, statistics, gaps, and the report."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr
from known_analyses import collected

import reference
from comparison.analyses.demands.analysis import DemandSurfaces, demand_statistics
from comparison.analyses.demands.feature import demand_lines
from comparison.report.panels import make_distribution_panels
from comparison.study.models import EXACT, REGULARIZED, SMALL
from comparison.study.study import Study
from comparison.surfaces.distribution import CURVE_PROBABILITIES
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


def test_a_distribution_has_a_curve_of_every_model_with_its_color_and_dash() -> None:
    models = [SimpleNamespace(key=key, title=key.upper()) for key in ("small", "exact", "spatial")]
    results: Any = SimpleNamespace(models=models)
    curves = [("exact", [1.0, 2.5]), ("small", [np.nan, 3.0]), ("spatial", [4.0])]
    for unit, of_axis in (("mm", "drift, mm"), ("", "drift")):
        [panel] = make_distribution_panels(results, "tower", "drift", unit, curves)
        share = "share of the phases"
        assert (panel["title"], panel["plot"]["x"], panel["plot"]["y"]) == (
            "tower, drift", {"title": of_axis}, {"title": share}
        )  # fmt: skip
        assert panel["plot"]["label"] == f"tower, drift: {share} at which it stays below a value, by model"
        assert panel["plot"]["series"] == [
            {"name": name, "x": x, "y": CURVE_PROBABILITIES.tolist(), "color": color, "dash": dash}
            for name, x, color, dash in (
                ("EXACT", [1.0, 2.5], 1, ""), ("SMALL", [None, 3.0], 0, "7 3"), ("SPATIAL", [4.0], 2, "2 2")
            )
        ]  # fmt: skip
    assert make_distribution_panels(results, "tower", "drift", "mm", []) == []


def test_a_row_of_a_demand_names_its_scene_quantity_body_and_model() -> None:
    scenes = [
        SimpleNamespace(name=name, demand_statistics=[SimpleNamespace(quantity=quantity, body=body, model=model)])
        for name, quantity, body, model in (
            ("tower", "drift", 3, "small"),
            ("tower", "acceleration", 1, "small"),
            ("hall", "friction_energy", 0, "exact"),
        )
    ]
    results: Any = SimpleNamespace(scenes=scenes, titles={"small": "SMALL", "exact": "EXACT"})
    assert [(row["scene"], row["name"], row["title"]) for row in demand_lines(results)] == [
        ("tower", "drift against the body below of body 3, m", "SMALL"),
        ("tower", "largest absolute acceleration (literal supremum where friction sticks) of body 1, m/s^2", "SMALL"),
        ("hall", "energy dissipated by friction, J", "EXACT"),
    ]


def test_a_record_has_one_value_and_no_phases(study: Study, demands: xr.Dataset) -> None:
    rows = {(row.model, row.quantity, row.body): row for row in demand_statistics(study, demands, study.scenes[1])}
    row = rows[EXACT.key, "base_shear", 0]
    assert (row.points, row.unknown) == (1, 0.0)
    assert row.lowest.value == row.mean.value == row.highest.value
    assert np.isnan(row.highest.phases).all()


def test_the_extremes_of_a_demand_have_their_own_errors_and_phases(study: Study, demands: xr.Dataset) -> None:
    value, planted = 10.0 + np.arange(16.0).reshape(4, 4), demands.copy(deep=True)
    value[1, 3], value[2, 0], value[0, 1] = 1.0, 99.0, np.nan
    for name, numbers in (("base_shear", value), ("base_shear_error", 0.01 * value[::-1])):
        planted[name].loc[{"scene": "fig3-I", "model": EXACT.key}] = numbers
    rows = {(row.model, row.quantity): row for row in demand_statistics(study, planted, study.scenes[0])}
    row, axis = rows[EXACT.key, "base_shear"], phase_axis(4)
    found = [(each.value, each.error, *each.phases) for each in (row.lowest, row.highest)]
    assert found[0] == pytest.approx((1.0, 0.21, axis[1], axis[3]))
    assert found[1] == pytest.approx((99.0, 0.14, axis[2], axis[0]))
    assert row.unknown == pytest.approx(1.0 / 16.0)
    limited = replace(study, hierarchy=(SMALL, replace(EXACT, most=2)))  # every second phase of either axis
    rows = {(row.model, row.quantity): row for row in demand_statistics(limited, planted, study.scenes[0])}
    assert rows[EXACT.key, "base_shear"].highest.phases == pytest.approx((axis[2], axis[0]))


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
