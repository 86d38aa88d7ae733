"""The step of the hierarchy that softens bars by the weight that they carry."""

from __future__ import annotations

import numpy as np
import pytest
from studies import solved

import multibody
from comparison.study.batches import refusal_of
from comparison.study.costs import seconds_per_point
from comparison.study.models import (
    MODEL_HIERARCHY,
    SOFTENED_SPATIAL,
    SOFTENED_TRANSLATIONAL,
    models_of,
    pairs_of,
    with_softened_bars,
)
from comparison.study.study import Study
from comparison.surfaces.unanswered import advice
from reference.problem import Outcome, Scene, load_scene

PLAIN = load_scene("fig3-I")
BARS = {"count": 4, "bending_stiffness": 0.8, "length": 1.0}
BARE = {"isolator.supports": None, "isolator.ring": None, "isolator.sphere_radius": None}


def on_bars(**values: object) -> Scene:
    bars = {"bodies.1.period": None, "bodies.1.bars": BARS}
    return PLAIN.with_values({"duration": 1.0, "name": "bars", **bars, **values}).with_amplitude(2.0)


def test_scenes_without_bars_have_the_hierarchy_that_they_had() -> None:
    assert with_softened_bars(MODEL_HIERARCHY, [PLAIN]) == MODEL_HIERARCHY
    loaded = on_bars(**{"bodies.1.bars.load_effect": "softening"})
    assert with_softened_bars(MODEL_HIERARCHY, [loaded]) == MODEL_HIERARCHY, "every model has it"


@pytest.mark.parametrize(("values", "step"), [({}, SOFTENED_SPATIAL), (BARE, SOFTENED_TRANSLATIONAL)])
def test_bars_are_softened_last_and_never_like_for_like(values: dict[str, object], step: object) -> None:
    scene = on_bars(**values)
    hierarchy = with_softened_bars(MODEL_HIERARCHY, [PLAIN, scene])
    assert models_of(scene, hierarchy)[-1] == step
    assert step not in models_of(PLAIN, hierarchy)
    pairs = {pair.key: pair for pair in pairs_of(scene, hierarchy)}
    assert pairs["total"].second == step
    assert "softened" not in pairs["like-for-like"].second.settings
    assert "softened" not in pairs["translational"].second.settings


def test_a_softened_step_has_phases_and_cost_of_its_model() -> None:
    scene = on_bars()
    *_, spatial, softened = with_softened_bars(MODEL_HIERARCHY, [scene])
    assert softened.most == spatial.most
    assert seconds_per_point(scene, softened) == seconds_per_point(scene, spatial)


def test_bars_that_buckle_cost_no_other_model() -> None:
    scene = on_bars(**BARE, **{"bodies.1.bars.bending_stiffness": 0.2})
    hierarchy = with_softened_bars(MODEL_HIERARCHY, [scene])
    reason = refusal_of(scene, SOFTENED_TRANSLATIONAL, 1e-3)
    assert "buckle sideways" in reason
    assert "\n" not in reason
    study = Study((scene,), 1, 1e-3, models_of(scene, hierarchy)[3:])
    surfaces = solved(study)
    finite = {key: bool(np.isfinite(surfaces["mu"].sel(model=key)).all()) for key in surfaces["model"].values.tolist()}
    assert finite.pop("softened-translational") is False
    assert finite == {"regularised": True, "translational": True}
    assert "buckle sideways" in advice(study, scene, SOFTENED_TRANSLATIONAL, Outcome.SOLVER_FAILED)


def test_the_step_gives_what_the_softened_scene_gives() -> None:
    scene = on_bars()
    settings = {"model": "translational", "tolerance": 1e-3}
    step = multibody.amplification(scene, [(0.3, 1.1)], softened=True, **settings)
    softened = multibody.amplification(scene.softened(), [(0.3, 1.1)], **settings)
    np.testing.assert_array_equal(step.mu, softened.mu)
    assert np.abs(step.mu - multibody.amplification(scene, [(0.3, 1.1)], **settings).mu).max() > 0.01
    motion = multibody.trajectory(scene, (0.3, 1.1), softened=True, **settings)
    assert motion.scene == scene.softened()
