"""A lubricated contact from nearly frictionless to locked: the error holds against the equations."""

from __future__ import annotations

import numpy as np
import pytest

import multibody
import reference
from reference.problem import Outcome, load_scene

PHASES = [(0.1, 0.2), (2.0, 0.7)]


@pytest.mark.parametrize("lubrication", [1e-3, 10.0, 1e5, pytest.param(1e9, marks=pytest.mark.long)])
def test_the_error_holds_at_any_lubrication(lubrication: float) -> None:
    scene = load_scene("fig4-viscous").with_values({"duration": 5.0, "isolator.lubrication": lubrication})
    engine, equations = multibody.amplification(scene, PHASES), reference.amplification(scene, PHASES)
    assert engine.status.tolist() == [Outcome.OK] * 2
    assert (np.abs(engine.mu - equations.mu) <= engine.error + equations.error).all()


def test_a_locked_platform_moves_with_the_ground() -> None:
    scene = load_scene("fig4-viscous").with_values({"isolator.lubrication": 1e7})
    found = multibody.amplification(scene, PHASES)
    np.testing.assert_allclose(found.mu[:, 0], 1.0, rtol=1e-3)


def test_a_record_shakes_a_locked_platform_like_the_ground() -> None:
    isolator = {"period": 2.0, "lubrication": 1e5}
    scene = load_scene("synthetic-pair").with_values({"duration": 2.0, "isolator": isolator})
    engine, equations = multibody.amplification(scene, PHASES[:1]), reference.amplification(scene, PHASES[:1])
    assert engine.status[0] == Outcome.OK
    assert (np.abs(engine.mu - equations.mu) <= engine.error + equations.error).all()
