"""The numbers do not depend on how many workers compute them, nor on the order in which they finish."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import xarray as xr
from fake_models import fake_ladder

from comparison.analysis.surfaces import labelled_surfaces
from comparison.execution.sweep import sweep
from comparison.study.batches import solve_tile, unanswered
from comparison.study.study import Study
from reference.problem import load_scene


def test_results_are_the_same_to_the_last_bit_for_any_number_of_jobs() -> None:
    study = Study((load_scene("fig3-I"),), 4, 1e-3, fake_ladder("uneven", tile=1))
    tiles = study.tiles()
    order: list[int] = []
    found = []
    for jobs in (1, 3):
        order.clear()
        answers = sweep(
            tiles, solve_tile, unanswered, lambda tile, answer: order.append(tile.first), jobs, ThreadPoolExecutor
        )
        found.append(labelled_surfaces(study, tiles, answers).drop_vars("cost"))
    assert order != [tile.first for tile in tiles], "the second time they finished in another order"
    xr.testing.assert_equal(*found)  # values, not only close ones


def test_the_cut_into_tiles_covers_every_phase_once() -> None:
    study = Study((load_scene("fig3-I"), load_scene("fig4-viscous")), 5, 1e-3, fake_ladder(tile=4))
    for rung in study.ladder:
        for scene in study.scenes:
            tiles = [tile for tile in study.tiles() if tile.rung == rung.key and tile.scene.name == scene.name]
            covered = [tile.first + i for tile in tiles for i in range(len(tile.phases))]
            assert covered == (list(range(study.points(rung))) if rung.applies(scene) else [])
