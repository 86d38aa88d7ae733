"""Effective values come from the motion: a model that computes with other values than it was given is seen."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fake_models import fake_hierarchy, sliding
from known_analyses import collected

from comparison.evidence.effective import analysis
from comparison.evidence.effective.analysis import PHASES, read_scene_values, read_values_back, word_effective
from comparison.study.models import (
    EXACT,
    MODEL_HIERARCHY,
    SMALL_RIGID_FRICTION,
    SOFTENED_SPATIAL,
    SOFTENED_TRANSLATIONAL,
    Model,
)
from comparison.study.study import Study
from reference.problem import Scene, Trajectory, ground_acceleration, load_scene

TRUE = {"radius": 0.31, "friction": 0.123, "mass": 2.2}  # the scene says 0.248 m, 0.1 and 2 kg


def _model(**settings: object) -> Model:
    return replace(fake_hierarchy()[-1], trajectory="fake_models:sliding", settings=settings)


def test_what_a_model_computed_with_is_read_from_its_motion() -> None:
    values = read_values_back((load_scene("fig3-I"), _model(**TRUE)))
    assert values.error_message == ""
    found = [values.radius, values.mass, values.contact, values.friction]
    assert found == pytest.approx([TRUE["radius"], TRUE["mass"], TRUE["mass"] * 9.81, TRUE["friction"]], rel=1e-9)
    study = Study((load_scene("fig3-I"), load_scene("fig3-II")), 2, 1e-3, [_model(**TRUE)])
    keys = [(each.scene, each.model) for each in collected(analysis.EffectiveValues(), study)]
    assert keys == [(scene.name, model) for scene in study.scenes for model in ("scene", "spatial")]


def jolted(scene: Scene, phase: Sequence[float], **values: float) -> Trajectory:
    """Slides as it should but for one instant of the fastest slide."""
    motion = sliding(scene, phase, **values)
    acceleration = motion.absolute_acceleration.copy()
    acceleration[np.linalg.norm(motion.velocity[:, 0], axis=1).argmax()] *= 1.5
    return replace(motion, absolute_acceleration=acceleration)


def test_one_instant_tells_nothing_of_the_friction() -> None:
    model = replace(_model(**TRUE), trajectory="test_effective:jolted")
    assert read_values_back((load_scene("fig3-I"), model)).friction == pytest.approx(TRUE["friction"], rel=1e-9)
    in_oil = read_values_back((load_scene("fig4-viscous"), _model(**TRUE)))
    assert in_oil.friction == pytest.approx(TRUE["friction"], rel=1e-9), "over the speed"


def test_no_coefficient_is_read_where_heat_changes_it() -> None:
    heating = {"contact_radius": 0.02, "conductivity": 0.02, "diffusivity": 1e-3}
    heated = load_scene("fig3-I").with_values({"isolator.friction": {"slow": 0.1, "heating": heating}})
    values = read_values_back((heated, _model(**TRUE)))
    assert np.isnan(values.friction)
    assert values.radius == pytest.approx(TRUE["radius"])


LAWS = [
    {"slow": 0.05, "fast": 0.1, "rate": 20.0},
    {"slow": 0.1, "fast": 0.05, "rate": 20.0},
    {"slow": 0.05, "load_exponent": -0.3},
]


@pytest.mark.parametrize("law", LAWS, ids=str)
def test_of_friction_that_varies_the_fast_one_under_the_weight_is_read(law: dict[str, float]) -> None:
    scene = load_scene("fig3-I").with_values({"isolator.friction": law, "duration": 3.0})
    scene = scene.with_values({"excitation.amplitudes": [[1.0, 0.0], [0.0, 1.0], [3.0, 0.0]]})
    fast = law.get("fast", law["slow"])
    assert read_scene_values(scene).friction == fast
    assert read_values_back((scene, EXACT)).friction == pytest.approx(fast, rel=1e-5)
    if "rate" in law:
        slowly = scene.with_values({"isolator.friction.rate": 0.1})
        assert np.isnan(read_values_back((slowly, EXACT)).friction), (
            "a motion that sees no fast friction does not tell it"
        )


def test_rigid_friction_is_read_from_a_motion_with_it() -> None:
    rigid = load_scene("fig3-I").with_values({"duration": 2.0})
    expected, found = (
        read_values_back((scene, SMALL_RIGID_FRICTION)) for scene in (rigid, rigid.with_yield_displacement(1e-3))
    )
    assert found.acceleration == expected.acceleration > 1.0, "friction that yields has no force at the start"


def test_the_scene_states_what_the_motion_is_held_against() -> None:
    upward = [[1.0, 0.0], [0.0, 1.0], [3.0, 0.0]]
    scene = load_scene("fig3-II").with_values({"excitation.amplitudes": upward, "duration": 2.0})
    ground = ground_acceleration(scene, PHASES, [0.0])[0]
    expected = [scene.radius, 0.1, 2.0, 2.0 * (9.81 + ground[2]), np.linalg.norm(ground)]
    for values in (read_scene_values(scene), read_values_back((scene, EXACT))):
        told = [values.radius, values.friction, values.mass, values.contact, values.acceleration]
        assert told == pytest.approx(expected, rel=1e-6), values.model


def test_a_record_is_read_to_its_end(tmp_path: Path) -> None:
    """The ground shakes after 8 s only: a motion that ends before tells no friction."""
    (tmp_path / "late.csv").write_text(
        "time [s],ax [m/s^2],ay [m/s^2]\n0,0,0\n8,0,0\n8.3,6,4\n8.6,-6,4\n8.9,6,-4\n9.2,0,0\n"
    )
    table = load_scene("fig3-I").model_dump(exclude_none=True) | {"duration": 10.0}
    table["excitation"] = {"record": str(tmp_path / "late.csv")}
    scene = Scene.model_validate(table)
    values = read_values_back((scene, EXACT))
    assert (values.radius, values.friction) == pytest.approx((scene.radius, 0.1), rel=1e-6)


@pytest.mark.parametrize(
    ("model", "error_message", "mass"),
    [
        (fake_hierarchy()[-1], "AssertionError: nothing should have been computed", np.nan),
        (_model(**TRUE, status="rim reached"), "the motion ended: rim reached", np.nan),
        (_model(**TRUE, swing=0.0), "", TRUE["mass"]),
    ],
    ids=["fails", "ends early", "never moves"],
)
def test_a_motion_that_tells_nothing_has_no_value(model: Model, error_message: str, mass: float) -> None:
    values = read_values_back((load_scene("fig3-I"), model))
    assert values.error_message == error_message
    assert np.isnan([values.radius, values.friction]).all()
    assert [values.mass, values.contact] == pytest.approx([mass, 9.81 * mass], rel=1e-12, nan_ok=True)


def test_the_dampers_of_both_sides_are_those_of_the_scene() -> None:
    platform, body = load_scene("fig3-I").model_dump(exclude_none=True)["bodies"]
    bodies = [platform, body, {**body, "damping": [0.7, 0.3], "height": 2.0 * body["height"]}]
    scene = load_scene("fig3-I").with_values({"bodies": bodies, "duration": 2.0})
    assert read_scene_values(scene).damping == 0.7
    models = {model.key: model for model in MODEL_HIERARCHY}
    for key in ("small", "exact", "regularised", "translational"):
        assert read_values_back((scene, models[key])).damping == pytest.approx(0.7, rel=1e-3), key
    assert np.isnan(read_values_back((load_scene("fig3-I").with_values({"duration": 2.0}), models["exact"])).damping)


def test_the_bars_of_every_model_are_as_stiff_as_stated() -> None:
    bars = {"count": 4, "bending_stiffness": 0.8, "length": 1.0, "axial_stiffness": 2900.0, "spread": 0.8}
    scene = load_scene("fig3-I").with_values({"duration": 2.0, "bodies.1.period": None, "bodies.1.bars": bars})
    assert read_scene_values(scene).stiffness == pytest.approx(12.0 * 4 * 0.8)
    platform, body = scene.model_dump(exclude_none=True)["bodies"]
    upper = {**body, "mass": 0.5, "height": 2.0, "bars": {**bars, "count": 5}}
    assert read_scene_values(scene.with_values({"bodies": [platform, body, upper]})).stiffness == pytest.approx(48.0)
    for model in (*MODEL_HIERARCHY[-2:], SOFTENED_TRANSLATIONAL, SOFTENED_SPATIAL):
        own = scene.softened() if "softened" in model.settings else scene
        assert read_values_back((scene, model)).stiffness == pytest.approx(own.stiffness[0, 0], rel=1e-5), model.key
    assert np.isnan(read_scene_values(load_scene("fig3-I")).stiffness)


def test_the_largest_departure_of_any_model_and_scene_is_named() -> None:
    """A plane and a scene without friction state nothing that a departure could be a share of."""

    def told(scene: str, model: str, radius: float, friction: float, mass: float) -> analysis.EffectiveModelValues:
        return analysis.EffectiveModelValues(scene, model, radius, friction, mass=mass)

    plane = [told("b", "scene", np.inf, 0.0, 3.0), told("b", "exact", 1e3, 0.01, 3.15)]
    listed = [told("a", "scene", 0.25, 0.1, 2.0), told("a", "small", 0.24, np.nan, 2.0),
              told("a", "exact", 0.25, 0.08, 2.02), told("a", "spatial", 0.25, 0.11, 2.0)]  # fmt: skip
    begin = "largest departures from what the scenes state: "
    assert word_effective([*listed, *plane]) == f"{begin}radius 4 %, friction 20 %, total mass 5 %"
    assert word_effective(plane) == f"{begin}radius not compared, friction not compared, total mass 5 %"
