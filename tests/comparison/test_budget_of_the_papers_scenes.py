"""The budget of the four scenes of the paper, by the real models: it closes, and so does the like-for-like gap."""

from __future__ import annotations

import numpy as np
import pytest

from comparison.account.acceptance import checked_limits
from comparison.account.budget import budget, closure, steps
from comparison.account.differences import differences
from comparison.account.surfaces import labelled_surfaces
from comparison.account.unanswered import unanswered
from comparison.plan.study import Study
from comparison.plan.tiles import solve_tile
from reference.problem import builtin_scenes, load_scene

pytestmark = pytest.mark.long

GRID = 4


@pytest.mark.parametrize("name", builtin_scenes())
def test_the_budget_closes_and_no_like_for_like_step_exceeds_twice_its_uncertainty(name: str) -> None:
    scene = load_scene(name)
    study = Study((scene,), GRID, 1e-3)
    tiles = study.tiles()
    surfaces = labelled_surfaces(study, tiles, [solve_tile(tile) for tile in tiles])
    limits = checked_limits(study, surfaces, differences(study, surfaces), unanswered(study, surfaces))
    assert len(limits) == 5
    assert [line for limit in limits for line in limit.broken] == []
    for body in range(1, len(scene.bodies) + 1):
        found = steps(study, surfaces, name, body)
        assert closure(found) < 1e-14  # rounding of a handful of numbers near 1
        like_for_like = next(step for step in found if step.key == "translational")
        assert like_for_like.known.all()
        assert like_for_like.ratio.max() <= 2.0
        for step in found:
            assert (step.uncertainty[step.real] <= 0.2 * np.abs(step.size[step.real])).all()
    rows = [entry for entry in budget(study, surfaces) if entry.step == "exact"]
    assert all(entry.real > 0.1 for entry in rows), "the paper's simplification is seen in every scene and body"
