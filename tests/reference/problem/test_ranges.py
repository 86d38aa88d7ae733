"""Every quantity and argument has a range: inside it is an answer or a named outcome, outside it one line."""

import math

import numpy as np
import pytest

import multibody
import reference
from reference.problem import Outcome, Scene, SceneError, checked_phases, load_scene
from reference.problem.ranges import CUTOFF, REGULARIZATION, SCENE, TOLERANCE
from reference.problem.scene import KEYS
from reference.surface import checked_demand

PHASES = [(0.1, 0.2)]
PLACES = {
    "bodies.mass": "bodies.1.mass",
    "bodies.period": "bodies.1.period.0",
    "bodies.stiffness": "bodies.1.stiffness",
    "bodies.height": "bodies.1.height",
    "bodies.size": "bodies.1.size.2",
    "bodies.offset": "bodies.1.offset",
    "bodies.yaw": "bodies.1.yaw",
    "excitation.amplitudes": "excitation.amplitudes.0.1",
    "excitation.periods": "excitation.periods.0",
    "excitation.decay": "excitation.decay.1",
}


HEATING = {"contact_radius": 0.2, "conductivity": 18.0, "diffusivity": 4.4e-6}
LAW = {"slow": 0.03, "fast": 0.06, "rate": 100.0, "heating": HEATING}


def put(scene: Scene, key: str, value: float) -> Scene:
    """The scene with one quantity changed; another that excludes it is left out."""
    if key.startswith("isolator.friction."):
        scene = scene.with_values({"isolator.friction": LAW})
    values: dict[str, object] = {PLACES.get(key, key): value}
    if key in ("isolator.radius", "isolator.lubrication"):
        values |= {"isolator.period": None} if key == "isolator.radius" else {"isolator.friction": None}
    if key == "bodies.offset":
        values = {"bodies.1.offset": [0.0, value]}
    if key.startswith("bodies.bars."):
        bars = {"count": 4, "bending_stiffness": 1.0, "length": 1.0, key.removeprefix("bodies.bars."): value}
        values = {"bodies.1.period": None, "bodies.1.bars": bars}
    if key.startswith("measured."):
        peak = {"quantity": "mu", "body": 1, "value": 2.0, "uncertainty": 0.1, "phases": [0.0, 0.0]}
        name = key.removeprefix("measured.")
        values = {"measured": [{**peak, name: [value, 0.0] if name == "phases" else value}]}
    if key == "bodies.stiffness":
        values = {"bodies.1.period": None, "bodies.1.stiffness": [value, 1.0]}
    return scene.with_values(values)


def test_every_number_of_a_scene_has_a_range():
    plain = {key for key in KEYS[""] if key == "duration"}
    tables = {"isolator": "isolator", "bodies": "bodies", "excitation": "excitation.two frequencies"}
    tables["isolator.friction"] = "isolator.friction"
    tables |= {name: name for name in ("isolator.friction.heating", "bodies.bars")}
    tables["measured"] = "measured"
    numbers = plain | {f"{name}.{key}" for name, table in tables.items() for key in KEYS[table]}
    unbounded = {"excitation.scale", "bodies.bars", "bodies.bars.load_effect", "measured.quantity", "measured.source"}
    unbounded |= {"isolator.friction.heating"}
    bounded = numbers - unbounded
    assert bounded == set(SCENE), "a scale is bounded by the accelerations that it makes"


@pytest.mark.parametrize("key", SCENE)
@pytest.mark.parametrize("side", ["lowest", "highest"])
def test_a_quantity_beyond_its_range_is_refused_with_the_range(key, side):
    edge = getattr(SCENE[key], side)
    if key.endswith(("supports", "count", "measured.body")):
        outside = edge + (1 if side == "highest" else -1)
    else:
        outside = math.nextafter(edge, math.inf if side == "highest" else -math.inf)
    with pytest.raises(SceneError) as caught:
        put(load_scene("fig3-I"), key, outside)
    assert "\n" not in str(caught.value)
    assert any(f"{number:g}" in caught.value.rule for number in (SCENE[key].lowest, SCENE[key].highest))


@pytest.mark.parametrize("function", [reference.amplification, multibody.amplification])
@pytest.mark.parametrize(
    "asked",
    [
        {"regularization": 0.0},
        {"regularization": -1e-3},
        {"regularization": math.inf},
        {"regularization": "1e-3"},
        {"tolerance": math.nan},
        {"tolerance": None},
        {"tolerance": "1e-3"},
        {"tolerance": True},
        {"tolerance": 0.2},
        {"tolerance": 1e-11},
        {"phases": None},
        {"phases": [["0.1", "0.2"]]},
        {"phases": [(0.1, None)]},
        {"phases": [(0.1,), (0.1, 0.2)]},
        {"phases": [(0.1, 0.2j)]},
        {"phases": [(1e17, 0.2)]},
        {"phases": np.ma.masked_array([(0.1, 0.2)], mask=[(True, False)])},
        {"phases": [(0.1, np.ma.masked)]},
    ],
)
def test_an_argument_outside_its_rules_is_one_line(function, asked):
    with pytest.raises(ValueError, match=r"^(phases|tolerance|regularization)\b.*(must|rad)") as caught:
        function(load_scene("fig3-I"), **{"phases": PHASES, **asked})
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("value", [None, {}, ["exact"], 3, "linear"])
def test_a_choice_that_there_is_not_is_a_value_error(value):
    scene = load_scene("fig3-I")
    with pytest.raises(ValueError, match=r"^equations = .*must be one of exact, small"):
        reference.amplification(scene, PHASES, equations=value)
    with pytest.raises(ValueError, match=r"^model = .*must be one of spatial, translational"):
        multibody.amplification(scene, PHASES, model=value)
    with pytest.raises(ValueError, match=r"^rest_condition = "):
        reference.amplification(scene, PHASES, rest_condition=value)


def test_a_cutoff_is_positive_and_without_regularization():
    for cutoff, v_reg in ((0.0, None), (1e-3, 1e-3)):
        with pytest.raises(ValueError, match=rf"^cutoff = {cutoff}"):
            reference.amplification(load_scene("fig3-I"), PHASES, cutoff=cutoff, regularization=v_reg)


@pytest.mark.parametrize("function", [reference.trajectory, multibody.trajectory])
def test_arguments_of_a_trajectory_are_checked_alike(function):
    scene = load_scene("fig3-I").with_values({"duration": 0.1})
    for phase in ("0.1", None, {}, (1e17, 0.0), np.ma.masked_array((0.1, 0.2), mask=(True, False))):
        with pytest.raises(ValueError, match=r"^phase"):
            function(scene, phase)
    still = np.zeros((2, 2))
    for place in (np.ma.masked_array(still, mask=True), "here", still + 1e13, still + 0.5, still[:1]):
        with pytest.raises(ValueError, match=r"^initial"):
            function(scene, (0.1, 0.2), initial=reference.State(place, still))
    with pytest.raises(ValueError, match=r"^initial"):
        function(scene, (0.1, 0.2), initial=3)


@pytest.mark.parametrize("turns", [-100_000, -3, 1, 1000, 159_000])
def test_phases_are_reduced_as_exactly_as_a_double_holds_them(turns):
    angles = np.array([(0.3, 1.1), (2.0, 6.0)]) + 2.0 * np.pi * turns
    reduced = checked_phases(angles)
    assert (np.abs(reduced) <= 2.0 * np.pi).all()
    np.testing.assert_allclose(np.cos(reduced), np.cos(angles), rtol=0.0, atol=1e-15)
    np.testing.assert_allclose(np.sin(reduced), np.sin(angles), rtol=0.0, atol=1e-15)


def test_phases_within_a_turn_are_not_touched():
    angles = np.random.default_rng(1).uniform(-6.28, 6.28, (50, 2))
    assert (checked_phases(angles) == angles).all()


@pytest.mark.parametrize("function", [reference.amplification, multibody.amplification])
def test_both_sides_answer_a_phase_of_many_turns_like_the_phase(function):
    scene = load_scene("fig3-I").with_values({"duration": 0.5})
    many = function(scene, [(0.3 + 2.0 * np.pi * 1e5, 1.1)])
    one = function(scene, [(0.3, 1.1)])
    np.testing.assert_allclose(many.mu, one.mu, rtol=1e-8)


@pytest.mark.parametrize("value", [REGULARIZATION.lowest, REGULARIZATION.highest])
def test_the_ends_of_the_range_of_v_reg_are_answered_right(value):
    """At the lower end like the set-valued law, at the upper end like no friction."""
    scene = load_scene("fig4-dry")
    found = reference.amplification(scene, PHASES, regularization=value)
    limit = scene if value == REGULARIZATION.lowest else scene.with_values({"isolator.friction": 0.0})
    expected = reference.amplification(limit, PHASES)
    assert found.status[0] == Outcome.OK
    np.testing.assert_allclose(found.mu, expected.mu, rtol=2e-6)


@pytest.mark.parametrize("value", [CUTOFF.lowest, CUTOFF.highest])
@pytest.mark.parametrize("tolerance", [TOLERANCE.lowest, TOLERANCE.highest])
def test_the_ends_of_cutoff_and_tolerance_have_an_answer(value, tolerance):
    found = reference.amplification(load_scene("fig3-I"), PHASES, cutoff=value, tolerance=tolerance)
    assert found.status[0] in (Outcome.OK, Outcome.TOLERANCE_NOT_MET)
    assert (found.error <= 0.1 * found.mu).all()


@pytest.mark.parametrize("amplitude", [1e-145, 1e-160, 1e-170])
def test_a_ground_whose_squares_lose_digits_is_at_rest(amplitude):
    found = reference.amplification(load_scene("fig3-I").with_amplitude(amplitude), PHASES)
    assert found.status[0] == Outcome.NO_GROUND_MOTION


def test_a_run_of_many_cycles_ends():
    """An undamped loading for as long as a scene may last: refused after so many steps, not hours later."""
    scene = load_scene("fig3-I").with_values({"duration": 8e5, "excitation.decay": [0.0, 0.0]})
    unlimited = 1000.0 * scene.duration / 0.9
    _, demand = checked_demand(scene, "exact", None, 1e-6, None, "consistent")
    assert demand.step_limit < 0.01 * unlimited
