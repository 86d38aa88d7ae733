"""Dampers in the links against closed forms, limits and symmetries; `oracle_values.json` has more."""

from typing import Any

import numpy as np
import pytest
from chains import chain, refusal

import reference
from reference.problem import Scene, SceneError, State, load_scene
from reference.solver.system import pack_scene

PHASES = [(0.3, 1.1), (2.0, 0.7)]
THREE: dict[str, Any] = {"masses": (2.0, 1.0, 0.5), "stiffness": [(150.0, 110.0), (180.0, 240.0)]}


def damped(scene: Scene, *damping: float | list[float], **values: Any) -> Scene:
    """One value for all links, or one for each."""
    links = len(scene.bodies) - 1
    each = damping if len(damping) > 1 else damping * links
    return scene.with_values({f"bodies.{i + 1}.damping": zeta for i, zeta in enumerate(each)} | values)


def test_a_frictionless_chain_swings_in_its_complex_modes() -> None:
    """Released in the real part of a mode, small equations: Re(phi exp(lambda t)) throughout, nonproportional."""
    scene = damped(chain(0.5, 0.0, **THREE, amplitudes=[[1e-12, 0.0], [0.0, 0.0]], duration=2.0), 0.3, 0.02)
    natural = reference.damped_modes(scene)
    assert (natural.eigenvalue.imag[:, ::2] > 0.0).all(), "the first of each pair"
    for each in (scene, damped(chain(0.5, 0.0, **THREE), 0.6, 0.0)):  # in the latter not the largest real part
        shapes = reference.damped_modes(each).shape
        largest = np.take_along_axis(shapes, np.abs(shapes).argmax(axis=1)[:, None], axis=1)
        np.testing.assert_allclose(largest, 1.0, rtol=1e-12)
    for mode in range(6):
        shape, root = 1e-3 * natural.shape[0, :, mode], natural.eigenvalue[0, mode]
        start = State(*(np.column_stack([part.real, np.zeros(3)]) for part in (shape, root * shape)))
        times = np.linspace(0.0, 2.0, 101)
        motion = reference.trajectory(scene, PHASES[0], "small", times=times, initial=start, tolerance=1e-10)
        expected = (shape * np.exp(root * times)[:, None]).real
        np.testing.assert_allclose(motion.position[:, :, 0], expected, atol=1e-9 * np.abs(shape).max())


def test_dampers_feel_no_jump_where_the_platform_stops() -> None:
    """Within 0.1 us the acceleration above strong dampers changes at a stop as just before it."""
    scene = load_scene("fig3-I").with_values({"bodies.1.period": [0.3, 0.4], "bodies.1.mass": 0.6, "duration": 6.0})
    scene = damped(scene, 2.0)
    stops = np.array([start for start, _ in reference.trajectory(scene, PHASES[0]).stick if start > 0.0])
    times = (stops[:, None] + 1e-7 * np.arange(-40, 41)).ravel()
    above = reference.trajectory(scene, PHASES[0], times=times).absolute_acceleration[:, 1, :2]
    change = np.abs(np.diff(above.reshape(len(stops), -1, 2), axis=1)).max(axis=(1, 2))
    assert len(stops) > 1
    assert (change < 1e-5).all()


@pytest.mark.parametrize("shear", [0.0, 9e3])
def test_steps_know_the_fastest_vibration_and_decay_of_the_chain(shear: float) -> None:
    """By Gershgorin: twice the largest sum of the links of a body over its mass; friction that yields holds, too."""
    scene = damped(chain(0.5, 0.1, **THREE), 0.3, 0.02)
    law: Any = {"isolator.friction": {"slow": 0.1, "initial_stiffness": shear}} if shear else {}
    system = pack_scene(scene.with_values(law), False, None)
    touch = np.array([[1, 0], [1, 1], [0, 1]]) / np.array([[2.0], [1.0], [0.5]])
    decay = 2.0 * (touch @ scene.damping).max()
    assert system.damping_rate == pytest.approx(decay, rel=1e-12)
    assert system.fastest == pytest.approx(np.sqrt(2.0 * (touch @ scene.stiffness).max() + shear / 2.0) + decay)
    assert (reference.damped_modes(scene).eigenvalue.imag < system.fastest).all()
    assert (system.stiffness, system.mass_ratio) == (shear / 2.0 if shear else np.inf, 1.75)
    for below, above, links in (
        (system.below, system.above, scene.stiffness),
        (system.damping_below, system.damping_above, scene.damping),
    ):
        np.testing.assert_allclose(below, [[0.0, 0.0], links[0] / 1.0, links[1] / 0.5], rtol=1e-14)
        np.testing.assert_allclose(above, [links[0] / 2.0, links[1] / 1.0, [0.0, 0.0]], rtol=1e-14)


@pytest.mark.parametrize(
    ("values", "key", "rule"),
    [
        ({"bodies.1.damping": 0.02}, "bodies.1.damping", "superstructure.damping = 0.05 damps all links: remove one"),
        ({"bodies.1.damping": [1.0, 2.0]}, "bodies.1.damping", "remove one of the two keys"),
        ({"bodies": [{"mass": 1.0}]}, "superstructure.damping", "no body stands on the platform: remove this key"),
        ({"superstructure.damping": 5.0}, "superstructure.damping", "must be finite, from 0 to 1"),
        ({"superstructure.ratio": 5.0}, "superstructure.ratio", "unknown key; the keys here are damping"),
    ],
)
def test_damping_of_the_superstructure_stands_alone(values: dict[str, Any], key: str, rule: str) -> None:
    said = refusal(load_scene("fig3-I").with_values, {"superstructure": {"damping": 0.05}} | values, kind=SceneError)
    assert said.key == key
    assert rule in said.rule


def test_damping_of_the_superstructure_follows_bars_that_the_weight_softens() -> None:
    bars = {"count": 4, "bending_stiffness": 2.0, "length": 1.0}
    scene = load_scene("fig3-I").with_values({"bodies.1.period": None, "bodies.1.bars": bars})
    softened = scene.with_values({"superstructure.damping": 0.05}).softened()
    assert softened.stiffness[0, 0] < 0.9 * scene.stiffness[0, 0]
    np.testing.assert_allclose(softened.damping, 0.1 * np.sqrt(softened.stiffness * softened.masses[1]), rtol=1e-12)
    assert softened.digest() != scene.softened().digest()


def test_the_ratio_and_the_coefficients_say_the_same() -> None:
    scene = load_scene("fig3-I")
    ratio = damped(scene, 0.05)
    expected = 2.0 * 0.05 * np.sqrt(scene.stiffness * scene.masses[1:, None])
    np.testing.assert_allclose(ratio.damping, expected, rtol=1e-15)
    stated = damped(scene, expected[0].tolist())
    np.testing.assert_array_equal(stated.damping, ratio.damping)
    assert stated.digest() != ratio.digest() != scene.digest()
    assert not scene.damping.any()
