"""Grids from coarse to fine: a finer study begins with what a coarser one has computed."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from fake_models import fake_hierarchy

from comparison.study.models import MODEL_HIERARCHY, Model
from comparison.study.nesting import levels, nested_grids
from comparison.study.study import Study
from comparison.surfaces.tasks import surface_tasks
from reference.problem import load_scene, phase_axis, phase_grid

SCENES = tuple(load_scene(name) for name in ("fig3-I", "fig3-II", "synthetic-pair"))


@pytest.mark.parametrize("grid", [1, 2, 3, 7, 12, 16, 20, 45, 48, 96, 512])
def test_each_grid_is_part_of_the_next(grid: int) -> None:
    chain = nested_grids(grid)
    assert chain[-1] == grid
    assert all(fine % coarse == 0 and fine > coarse for coarse, fine in pairwise(chain))
    level = levels(grid)
    for number, coarse in enumerate(chain):
        assert (level <= number).sum() == coarse


def test_phases_of_nested_grids_are_the_same_to_the_last_bit() -> None:
    chain = nested_grids(96)
    for coarse, fine in pairwise(chain):
        np.testing.assert_array_equal(phase_axis(fine)[:: fine // coarse], phase_axis(coarse))
    np.testing.assert_allclose(phase_axis(96), 2.0 * np.pi * np.arange(96) / 96, rtol=1e-15)
    np.testing.assert_array_equal(phase_grid(4)[6], phase_axis(4)[[1, 2]])


@pytest.mark.parametrize("hierarchy", [MODEL_HIERARCHY, fake_hierarchy(batch=3)], ids=["symmetric", "every phase"])
@pytest.mark.parametrize("coarse", [2, 4, 8])
def test_a_finer_study_asks_for_all_batches_of_a_coarser_one(hierarchy: tuple[Model, ...], coarse: int) -> None:
    everywhere = [replace(model, most=None) for model in hierarchy]
    first, finer = (
        {task.key.name for task in surface_tasks(Study(SCENES, grid, 1e-3, everywhere))} for grid in (coarse, 24)
    )
    assert first < finer


def test_every_phase_pair_is_in_one_batch() -> None:
    study = Study(SCENES[:1], 12, 1e-3, fake_hierarchy(batch=5))
    for model in study.hierarchy:
        phases = np.concatenate([batch.phases for batch in study.batches() if batch.model == model.key])
        expected = phase_grid(12)[study.places(model)]
        np.testing.assert_array_equal(phases[np.lexsort(phases.T[::-1])], expected)
