"""A study computes mirrored phases once, where and only where the scene's symmetry is exact."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from comparison.account.surfaces import labelled_surfaces
from comparison.plan.ladder import EXACT, REGULARISED, SMALL, TRANSLATIONAL, Rung
from comparison.plan.study import Study
from comparison.plan.symmetry import sources
from comparison.plan.tiles import solve_tile
from reference.problem import Scene, builtin_scenes, load_scene

GRID = 4


def surfaces(scene: Scene, rungs: list[Rung], full: bool):
    study = Study((scene.model_copy(update={"duration": 4.0}),), GRID, 1e-3, rungs, full)
    tiles = study.tiles()
    return sum(len(tile.phases) for tile in tiles), labelled_surfaces(
        study, tiles, [solve_tile(tile) for tile in tiles]
    )


@pytest.mark.parametrize("name", builtin_scenes())
def test_the_reduced_study_gives_the_full_surfaces_within_the_errors(name: str) -> None:
    rungs = [rung for rung in (SMALL, EXACT, REGULARISED) if rung.applies(load_scene(name))]
    whole, full = surfaces(load_scene(name), rungs, full=True)
    fewer, reduced = surfaces(load_scene(name), rungs, full=False)
    saved = {"fig3-I": 4, "fig3-II": 2, "fig4-dry": 2, "fig4-viscous": 2}[name]
    assert fewer * saved == whole == len(rungs) * GRID**2
    assert (reduced["status"] == full["status"]).all()
    assert (abs(reduced["mu"] - full["mu"]) <= reduced["error"] + full["error"]).all()


def test_the_engine_has_the_symmetry_too() -> None:
    whole, full = surfaces(load_scene("fig3-I"), [TRANSLATIONAL], full=True)
    fewer, reduced = surfaces(load_scene("fig3-I"), [TRANSLATIONAL], full=False)
    assert whole == 4 * fewer
    assert (abs(reduced["mu"] - full["mu"]) <= reduced["error"] + full["error"]).all()


def test_just_outside_the_condition_nothing_is_saved() -> None:
    table = load_scene("fig3-I").model_dump(exclude_none=True)
    crossed = [[1.0, 1e-9], [0.0, 1.0]]
    lifted = [[1.0, 0.0], [0.0, 1.0], [1e-9, 0.0]]
    for amplitudes, computed in ((crossed, GRID**2 // 2), (lifted, GRID**2)):
        table["excitation"]["amplitudes"] = amplitudes
        study = Study((Scene.model_validate(table),), GRID, 1e-3, [EXACT])
        assert len(study.solved(study.scenes[0], EXACT)) == computed


def test_an_odd_grid_and_a_model_without_the_symmetry_are_computed_in_full() -> None:
    scene = load_scene("fig3-I")
    assert (sources(scene, 5) == np.arange(25)).all()
    plain = replace(EXACT, symmetric=False)
    assert len(Study((scene,), GRID, 1e-3, [plain]).solved(scene, plain)) == GRID**2


def test_every_source_is_its_own_source() -> None:
    for name in builtin_scenes():
        for grid in (1, 2, 6, 7):
            chosen = sources(load_scene(name), grid)
            assert (chosen[chosen] == chosen).all()
