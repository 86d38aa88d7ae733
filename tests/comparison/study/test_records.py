"""Records and softened bars in a study."""

import numpy as np
import pytest
from studies import solved

import multibody
from comparison.analyses.motions.analysis import choose_places
from comparison.registry import ANALYSES, EVERYTHING, list_first_tasks
from comparison.study.batches import find_refusal
from comparison.study.costs import estimate_point_seconds
from comparison.study.models import (
    MODEL_HIERARCHY,
    SOFTENED_SPATIAL,
    SOFTENED_TRANSLATIONAL,
    models_of,
    pairs_of,
    with_steps_of_scenes,
)
from comparison.study.reductions import list_skipped_computations
from comparison.study.study import Study
from comparison.surfaces.figures.pictures import Pictures
from comparison.surfaces.missing_values import advise_on_outcome
from comparison.surfaces.surfaces import label_surfaces
from reference.problem import Outcome, Scene, load_scene


def test_what_needs_phases_is_not_asked_of_a_record():
    study = Study((load_scene("synthetic-pair"),), 4, 1e-3, selection=EVERYTHING)
    assert {task.stage for task in list_first_tasks(study, ANALYSES)} == {"effective values"}
    assert Pictures().tasks(study, label_surfaces(study, [], [])) == []
    assert list_skipped_computations(study) == []
    (place,) = choose_places(study, None, study.scenes[0])
    assert (place.row, place.column) == (0, 0)


PLAIN = load_scene("fig3-I")
BARS = {"count": 4, "bending_stiffness": 0.8, "length": 1.0}
BARE = {"isolator.supports": None, "isolator.ring": None, "isolator.sphere_radius": None}


def on_bars(**values: object) -> Scene:
    bars = {"bodies.1.period": None, "bodies.1.bars": BARS}
    return PLAIN.with_values({"duration": 1.0, "name": "bars", **bars, **values}).with_amplitude(2.0)


@pytest.mark.parametrize(("values", "step"), [({}, SOFTENED_SPATIAL), (BARE, SOFTENED_TRANSLATIONAL)])
def test_bars_are_softened_last_and_never_like_for_like(values: dict[str, object], step: object) -> None:
    scene = on_bars(**values)
    hierarchy = with_steps_of_scenes(MODEL_HIERARCHY, [PLAIN, scene])
    assert models_of(scene, hierarchy)[-1] == step
    assert step not in models_of(PLAIN, hierarchy)
    pairs = {pair.key: pair for pair in pairs_of(scene, hierarchy)}
    assert pairs["total"].second == step
    assert "softened" not in {*pairs["like-for-like"].second.settings, *pairs["translational"].second.settings}
    loaded = on_bars(**{"bodies.1.bars.load_effect": "softening"})
    assert with_steps_of_scenes(MODEL_HIERARCHY, [PLAIN, loaded]) == MODEL_HIERARCHY, "every model has it"


def test_a_softened_step_has_phases_and_cost_of_its_model() -> None:
    scene = on_bars()
    *_, spatial, softened = with_steps_of_scenes(MODEL_HIERARCHY, [scene])
    assert softened.most == spatial.most
    assert softened.settings == {**spatial.settings, "softened": True}
    assert estimate_point_seconds(scene, softened) == pytest.approx(0.22 / 20.0), "1 s of 20, two bodies"
    taller = PLAIN.with_values({"bodies": [*PLAIN.bodies, PLAIN.bodies[-1]]})
    assert estimate_point_seconds(taller, spatial) == pytest.approx(1.5 * 0.22)


def test_bars_that_buckle_cost_no_other_model() -> None:
    scene = on_bars(**BARE, **{"bodies.1.bars.bending_stiffness": 0.2})
    hierarchy = with_steps_of_scenes(MODEL_HIERARCHY, [scene])
    assert "buckle sideways" in find_refusal(scene, SOFTENED_TRANSLATIONAL, 1e-3)
    study = Study((scene,), 1, 1e-3, models_of(scene, hierarchy)[5:])
    finite = np.isfinite(solved(study)["mu"])
    assert [bool(finite.sel(model=model.key).all()) for model in study.hierarchy] == [True, True, False]
    assert "buckle sideways" in advise_on_outcome(study, scene, SOFTENED_TRANSLATIONAL, Outcome.SOLVER_FAILED)


def test_the_motion_of_a_softened_step_is_that_of_the_softened_scene() -> None:
    scene = on_bars()
    motion = multibody.trajectory(scene, (0.3, 1.1), "translational", softened=True, tolerance=1e-3)
    assert motion.scene == scene.softened()
