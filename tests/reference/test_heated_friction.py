"""Friction that its own heat lowers, against an independent integration, closed forms and limits."""

from __future__ import annotations

import numpy as np
import pytest
from heated_motion import heated_motion, temperature_rise

import reference
from reference.problem import SceneError, State, load_scene

SCENE = load_scene("fig3-I").with_values({"duration": 4.0})
# so small a weight heats only what hardly conducts; the slider leaves the center within each swing
HEATING = {"contact_radius": 0.02, "conductivity": 0.02, "diffusivity": 1e-3}
PHASE = (0.3, 1.1)


def heated(base: object = SCENE, friction: dict | None = None, **changes: float) -> object:
    return base.with_values({"isolator.friction": {"slow": 0.1, **(friction or {}), "heating": HEATING | changes}})


CASES = {
    "plain": (heated(), "exact"),
    "small": (heated(), "small"),
    "rising": (heated(friction={"slow": 0.05, "fast": 0.1, "rate": 100.0}), "exact"),
    "eased": (heated(SCENE.with_values({"excitation.amplitudes": [[1, 0], [0, 1], [1, 0.5]]}),
                     friction={"load_exponent": -0.357}), "exact"),
    "cold": (heated(initial_temperature=-20.0, contact_radius=0.01), "exact"),
    "always covered": (heated(contact_radius=0.06), "exact"),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_a_heated_motion_is_that_of_constant_steps(name, within):
    """The error of the steps, of an order between one and two where the slider leaves the center, is the larger."""
    scene, equations = CASES[name]
    _, rough, _ = heated_motion(scene, PHASE, equations, 1e-2, 2e-3)
    times, fine, _ = heated_motion(scene, PHASE, equations, 1e-2, 1e-3)
    cold = scene.with_values({"isolator.friction.heating.conductivity": 1e4})
    motion, without = (reference.trajectory(each, PHASE, equations, 1e-2, times=times[::2]) for each in (scene, cold))
    error = 2.0 * np.abs(rough - fine[::2]).max()
    assert motion.status == "ok"
    within(np.abs(motion.position[..., :2].reshape(rough.shape) - fine[::2]).max() / error, 1.0)
    assert np.abs(motion.position - without.position).max() > 50.0 * error


@pytest.mark.parametrize("v_reg", [None, 1e-3])
def test_the_friction_of_a_motion_is_what_its_heat_leaves(v_reg):
    """Power by the balance of forces; the integral over a constant step; friction where the platform slides fast."""
    scene, step = heated(), 2e-4
    motion = reference.trajectory(scene, PHASE, regularization=v_reg, times=np.arange(20001) * step)
    speed = np.linalg.norm(motion.velocity[:, 0], axis=1)
    covers = np.hypot(*motion.position[:, 0, :2].T) < 0.5 * np.sqrt(np.pi) * HEATING["contact_radius"]
    integral = temperature_rise(HEATING, 4, motion.friction_power * covers, step)
    fast = speed > 0.05
    left = motion.friction_power[fast] / (0.1 * motion.contact_force[fast] * speed[fast])
    assert np.ptp(left) > 0.15
    np.testing.assert_allclose(left, 0.79 * (0.7 ** (0.02 * (20.0 + integral[fast])) + 0.4), atol=3e-3)


def test_a_slide_on_a_plane_warms_like_the_root_of_time():
    """Constant flux q: T - T0 = 2 sqrt(D t / pi) q / k; its effect on the speed is 2/3 t of that on the friction."""
    table = {"contact_radius": 1.0, "conductivity": 100.0, "diffusivity": 1e-5}
    scene = load_scene("fig3-I").with_values({
        "isolator.period": None, "isolator.radius": np.inf, "duration": 1e-3, "excitation.scale": 1e-9,
        "isolator.friction": {"slow": 0.1, "heating": table}, "isolator.supports": None, "isolator.ring": None,
        "isolator.sphere_radius": None, "bodies": [{"mass": 1e6}],
    })  # fmt: skip
    cold = scene.with_values({"isolator.friction.heating.conductivity": 1e4})
    start, times = State(np.zeros((1, 2)), np.array([[1.0, 0.0]])), np.array([2.5e-4, 1e-3])
    speed, without = (
        reference.trajectory(each, PHASE, tolerance=1e-10, initial=start, times=times).velocity[:, 0, 0]
        for each in (scene, cold)
    )
    k_t, gravity = 0.79 * (0.7**0.4 + 0.4), 9.80665
    flux = 0.1 * k_t * 1e6 * gravity / np.pi
    slope = 0.79 * 0.02 * np.log(0.7) * 0.7**0.4
    rise = 2.0 * np.sqrt(1e-5 * times / np.pi) * flux * (1.0 / 100.0 - 1.0 / 1e4)
    np.testing.assert_allclose(speed - without, -0.1 * gravity * slope * rise * times * 2.0 / 3.0, rtol=5e-3)


@pytest.mark.parametrize("v_reg", [None, 1e-3])
def test_what_heat_changes_falls_with_slope_one_in_the_conductivity(v_reg):
    k_t = 0.79 * (0.7**0.4 + 0.4)
    plain = SCENE.with_values({"isolator.friction": 0.1 * k_t})
    mu, far, near = (
        reference.amplification(scene, [PHASE, (2.0, 0.7)], regularization=v_reg, tolerance=1e-7).mu
        for scene in (plain, heated(conductivity=20.0), heated(conductivity=40.0))
    )
    assert np.abs(near - mu).max() > 1e-5
    np.testing.assert_allclose(far - mu, 2.0 * (near - mu), atol=0.03 * np.abs(far - mu).max())


def test_a_large_contact_stays_cold():
    scenes = heated(contact_radius=10.0), SCENE.with_values({"isolator.friction": 0.1 * 0.79 * (0.7**0.4 + 0.4)})
    large, mu = (reference.amplification(scene, [PHASE], tolerance=1e-6).mu for scene in scenes)
    np.testing.assert_allclose(large, mu, rtol=3e-6)


def test_a_heated_motion_in_a_plane_is_that_of_two_axes():
    scene = heated(SCENE.with_values({"excitation.amplitudes": [[1.0, 0.5], [0.0, 0.0]]}))
    flat, full = (reference.amplification(scene, [PHASE], tolerance=1e-6, full=full) for full in (False, True))
    assert (np.abs(flat.mu - full.mu) <= flat.error + full.error).all()


def test_supports_share_the_load_and_so_the_heat():
    four, eight = (heated(SCENE.with_values({"isolator.supports": count})).dry_friction.heat for count in (4, 8))
    assert eight.rise == four.rise / 2.0
    assert eight.cover == four.cover


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ({"conductivity": 18.0, "diffusivity": 4.4e-6}, "contact_radius"),
        ({**HEATING, "conductivity": 0.0}, "greater than 0"),
        ({**HEATING, "initial_temperature": 500.0}, "from -50 to 300 degrees C"),
        ({**HEATING, "thickness": 1.0}, "thickness"),
    ],
)
def test_wrong_tables_of_heating_are_refused_in_one_line(table, said):
    with pytest.raises(SceneError, match=said) as caught:
        SCENE.with_values({"isolator.friction": {"slow": 0.1, "heating": table}})
    assert "\n" not in str(caught.value)
