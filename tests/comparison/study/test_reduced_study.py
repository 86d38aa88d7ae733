"""A study computes mirrored phases once, where and only where the scene's symmetry is exact."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import xarray as xr
from fake_models import fake_hierarchy
from runs import RUN
from studies import solved

import multibody
from comparison.registry import make_report
from comparison.study.batches import execute_batch, find_refusal
from comparison.study.models import (
    EXACT,
    EXACT_AS_INTEGRATED,
    MODEL_HIERARCHY,
    REGULARIZED,
    SMALL,
    SPATIAL,
    TRANSLATIONAL,
    Model,
    applies_to_no_scene,
    models_of,
)
from comparison.study.reductions import list_skipped_computations
from comparison.study.study import Study
from reference.problem import Scene, load_scene
from reference.problem.reductions import is_mirror_symmetric

GRID = 4


def test_of_two_limited_models_the_coarser_grid_is_part_of_the_finer() -> None:
    """Of 60 phases, 30 are every second. 20 would be every third, some of which are not among these: every fourth."""
    limited = [replace(TRANSLATIONAL, most=30), replace(SPATIAL, most=20), SMALL]
    study = Study((load_scene("fig3-I"),), 60, 1e-3, limited)
    assert study.strides == {"small": 1, "translational": 2, "spatial": 4}


def surfaces(scene: Scene, models: list[Model], full: bool) -> tuple[int, xr.Dataset]:
    """How many phase pairs are computed, and the surfaces."""
    study = Study((scene.with_values({"duration": 4.0}),), GRID, 1e-3, models, full)
    return sum(len(batch.phases) for batch in study.batches()), solved(study)


@pytest.mark.parametrize(("name", "alike"), [("fig3-I", 4), ("fig3-II", 2), ("fig4-dry", 2), ("fig4-viscous", 2)])
def test_the_reduced_study_gives_the_full_surfaces(name: str, alike: int) -> None:
    models = [model for model in (SMALL, EXACT, REGULARIZED) if model.applies(load_scene(name))]
    whole, full = surfaces(load_scene(name), models, full=True)
    fewer, reduced = surfaces(load_scene(name), models, full=False)
    assert fewer * alike == whole == len(models) * GRID**2
    assert (reduced["status"] == full["status"]).all()
    assert (abs(reduced["mu"] - full["mu"]) <= reduced["error"] + full["error"]).all()


def short(duration: float = 2.0, **values: Any) -> Scene:
    """Case I over so short a time, with the given keys of its isolator or excitation."""
    parts = {f"{part}.{key}": value for part, keys in values.items() for key, value in keys.items()}
    return load_scene("fig3-I").with_values({**parts, "duration": duration})


RECTANGLE = [[1.2, 0.8], [-1.2, 0.8], [-1.2, -0.8], [1.2, -0.8], [0.0, 0.8], [0.0, -0.8]]
MIRRORED = [np.pi, 0.0]


@pytest.mark.parametrize(
    "values", [{}, {"isolator.supports": 6}, {"isolator.supports": RECTANGLE, "isolator.ring": None}]
)
def test_even_supports_have_the_symmetry_of_the_loading(values: dict[str, Any]) -> None:
    scene = short().with_values(values)
    assert is_mirror_symmetric(scene)
    assert SPATIAL in models_of(scene, MODEL_HIERARCHY)
    shifts = np.array([[0.0, 0.0], MIRRORED, MIRRORED[::-1]])
    here, *there = (multibody.amplification(scene, [np.add((2.0, 0.7), shift)], model="spatial") for shift in shifts)
    assert here.status == "ok"
    for mirrored in there:
        assert (abs(here.mu - mirrored.mu) <= here.error + mirrored.error).all()
    assert len(Study((scene,), GRID, 1e-3, [SPATIAL]).solved(scene, SPATIAL)) == GRID**2 // 4


def test_the_phase_of_a_harmonic_without_amplitude_is_not_varied() -> None:
    scene = short(4.0, excitation={"amplitudes": [[1.0, 0.0], [0.5, 0.0], [0.3, 0.0]]})
    whole, full = surfaces(scene, [EXACT], full=True)
    fewer, reduced = surfaces(scene, [EXACT], full=False)
    assert (whole, fewer) == (GRID**2, GRID)
    assert (abs(reduced["mu"] - full["mu"]) <= reduced["error"] + full["error"]).all()
    (row,) = list_skipped_computations(Study((scene,), GRID, 1e-3, [EXACT]))
    why = "a harmonic without amplitude: its phase changes nothing"
    assert row[:3] == ("mirrored phases, all but 1/4", "all models", why)
    models = [EXACT, replace(TRANSLATIONAL, most=4)]
    rows = list_skipped_computations(Study((scene,), 8, 1e-3, models))
    assert [row[:2] for row in rows[:2]] == [
        ("mirrored phases, all but 1/8", "exact"), ("mirrored phases, all but 1/4", "translational"),
    ]  # fmt: skip


def test_without_friction_no_law_of_friction_is_varied() -> None:
    free, held = short(isolator={"friction": 0.0}), short(isolator={"friction": 1e-9})
    assert [model.key for model in models_of(free, MODEL_HIERARCHY)] == ["small", "exact", "translational", "spatial"]
    assert len(models_of(held, MODEL_HIERARCHY)) == len(MODEL_HIERARCHY)
    [batch] = Study((free,), 3, 1e-3, [EXACT]).batches()
    first, *others = (
        execute_batch(replace(batch, settings={**model.settings, "tolerance": 1e-6}))
        for model in (EXACT, EXACT_AS_INTEGRATED, REGULARIZED)
    )
    for other in others:
        assert (abs(other.mu - first.mu) <= other.error + first.error).all()


def test_a_full_study_asks_both_sides_for_all_of_it() -> None:
    for full in (False, True):
        batches = Study((short(),), GRID, 1e-3, full=full).batches()
        assert all(batch.settings.get("full", False) == full for batch in batches)
        told = find_refusal(short(), replace(TRANSLATIONAL, refusal="fake_models:says_what_it_is_asked"), 1e-4, full)
        asked = {"model": "translational", "regularization": 1e-3, "tolerance": 1e-4}
        assert told == str(asked | ({"full": True} if full else {}))


def test_what_is_left_out_is_listed_once_with_its_reason() -> None:
    platform = {**load_scene("fig3-I").model_dump(exclude_none=True)["bodies"][0], "height": 0.0}
    scene = short(isolator={"friction": 0.0}).with_values({"bodies": [platform]})
    expected = [
        ("mirrored phases, all but 1/4", "all models"),
        ("laws of friction", "small-resolved, resolved, small-regularised, regularised"),
        ("every run but one per harmonic", "small"),
        ("rotations, all supports but one", "spatial"),
    ]
    for supports, rows in ((4, expected), (None, expected[:-1])):  # without supports there is no spatial model
        study = Study((scene.with_values({"isolator.supports": supports}),), GRID, 1e-3)
        assert [(row.what, row.models) for row in list_skipped_computations(study)] == rows
    assert list_skipped_computations(Study((scene,), GRID, 1e-3, full=True)) == []
    (_, *plane) = list_skipped_computations(Study((load_scene("fig4-dry"),), GRID, 1e-3))
    assert [(row.what, row.models) for row in plane] == [
        ("motion across its plane", "small, exact, small-resolved, resolved, small-regularised, regularised"),
        ("motion across its plane, of the bodies", "translational"),
    ]
    twins = tuple(load_scene("fig3-I").with_values({"name": name}) for name in "ab")
    (row,) = list_skipped_computations(Study(twins, GRID, 1e-3))
    assert row.scenes == ("a", "b")


@pytest.mark.parametrize(
    ("amplitudes", "computed"),
    [
        ([[1.0, 1e-9], [0.0, 1.0], [0.0, 0.0]], GRID**2 // 2),
        ([[1.0, 0.0], [0.0, 1.0], [1e-9, 0.0]], GRID**2),
        ([[1.0, 1e-9], [0.5, 0.0], [0.3, 0.0]], GRID**2),
    ],
)
def test_just_outside_the_condition_nothing_is_saved(amplitudes: list[list[float]], computed: int) -> None:
    study = Study((short(excitation={"amplitudes": amplitudes}),), GRID, 1e-3, [EXACT])
    assert len(study.solved(study.scenes[0], EXACT)) == computed
    odd = replace(study, grid=5, scenes=(load_scene("fig3-I"),))
    assert len(odd.solved(odd.scenes[0], EXACT)) == 25, "an odd grid is computed in full"
    few = replace(odd, grid=7, hierarchy=[replace(EXACT, most=4)])
    assert len(few.solved(few.scenes[0], few.hierarchy[0])) == 16, "the last phase and the first are closer"
    plain = replace(EXACT, symmetric=applies_to_no_scene)
    assert len(study.solved(load_scene("fig3-I"), plain)) == GRID**2
    uneven = load_scene("fig3-I").with_values({"isolator.supports": 3})
    assert len(replace(study, hierarchy=[SPATIAL]).solved(uneven, SPATIAL)) == GRID**2


def test_the_report_counts_what_a_model_computed() -> None:
    models = [replace(model, symmetric=is_mirror_symmetric) for model in fake_hierarchy()]
    study = Study((load_scene("fig3-I"),), GRID, 1e-3, models)
    [scene] = make_report(study, solved(study), {}, [], RUN, families=[]).results.scenes
    assert {(row.points, row.computed) for row in scene.models.values()} == {(16, 4)}


@pytest.mark.parametrize(("asked", "of_equations"), [(1e-3, 1e-6), (1e-8, 1e-8)])
def test_the_equations_are_asked_for_more(asked: float, of_equations: float) -> None:
    equations = {"equations": "exact", "regularization": None, "tolerance": of_equations}
    assert {batch.model: dict(batch.settings) for batch in Study((short(),), 1, asked).batches()} == {
        "small": {**equations, "equations": "small"},
        "exact": equations,
        "small-resolved": {**equations, "equations": "small", "cutoff": 1e-3},
        "resolved": {**equations, "cutoff": 1e-3},
        "small-regularised": {**equations, "equations": "small", "regularization": 1e-3},
        "regularised": {**equations, "regularization": 1e-3},
        "translational": {"model": "translational", "regularization": 1e-3, "tolerance": asked},
        "spatial": {"model": "spatial", "regularization": 1e-3, "tolerance": asked},
    }
