"""Dampers in the links: closed forms, no moments left over; test_like_for_like.py has more."""

from typing import Any

import numpy as np
import pytest
from scenes_at_hand import assert_within, forces_of_links
from scipy.spatial.transform import Rotation

import multibody
import reference
from multibody.integration.time_scales import fastest_damper_rate, shortest_period
from multibody.models.assembly import assemble
from multibody.models.depressions import angular_velocity_matrix
from reference.problem import Scene, load_scene

PHASES = [(0.3, 1.1), (2.0, 0.7)]


BARS = {"count": 4, "bending_stiffness": 8.0, "length": 0.9, "axial_stiffness": 3e3, "spread": 0.8}
LINKS: dict[str, dict[str, Any]] = {
    "stiff": {},
    "at an angle": {"yaw": 0.7},
    "bars": {"period": None, "bars": {**BARS, "torsional_stiffness": 2.0}},
    "shortening bars": {"period": None, "bars": {**BARS, "load_effect": "shortening"}},
}


def two_bodies(link: str, damping: Any) -> Scene:
    values = {f"bodies.1.{key}": value for key, value in {**LINKS[link], "offset": [0.2, -0.1]}.items()}
    return load_scene("fig3-I").with_values({**values, "bodies.1.damping": damping, "isolator.friction": 0.0})


CENTERS = np.array([[0.0, 0.0, 0.2], [0.2, -0.1, 1.2]]) / load_scene("fig3-I").radius  # at rest, in units of the model
DRAW = np.random.default_rng(6)
COORDINATES = DRAW.uniform(-0.3, 0.3, 12)  # of bodies that are displaced and rotated against each other
COORDINATES[9:] = COORDINATES[3:6] + DRAW.uniform(-0.01, 0.01, 3)
PLACES = COORDINATES.reshape(2, 6)[:, :3] + CENTERS


@pytest.mark.parametrize("link", LINKS)
def test_a_link_keeps_the_momentum_of_its_bodies(link: str) -> None:
    """Linear and angular; the engine's middle axes are exact to a 24th of the square of a relative turn."""
    scene = two_bodies(link, 0.0).with_amplitude(1e-12)
    force, moment, model = forces_of_links(scene, COORDINATES, np.zeros(12))
    force[:, 2] += scene.masses / model.units.mass  # without the weight
    np.testing.assert_allclose(force.sum(axis=0), 0.0, atol=1e-9)
    about_the_origin = (moment + np.cross(PLACES, force)).sum(axis=0)
    np.testing.assert_allclose(about_the_origin, 0.0, atol=2e-5 * np.abs(force).max())


@pytest.mark.parametrize("link", ["stiff", "at an angle", "bars"])
def test_a_damper_takes_its_link_s_power_and_keeps_momentum(link: str) -> None:
    """Bars that give way damp every direction in proportion to its stiffness, as that in shear."""
    scene, angles = two_bodies(link, 0.7 if link == "bars" else [0.7, 0.2]), COORDINATES.reshape(2, 6)[:, 3:]
    velocities, spins = np.random.default_rng(7).uniform(-0.5, 0.5, (2, 2, 3))
    turning = [np.linalg.solve(angular_velocity_matrix(each), spin) for each, spin in zip(angles, spins)]
    rates = np.hstack([velocities, turning]).ravel()
    (force, moment, model), bare = (
        forces_of_links(each, COORDINATES, rates) for each in (scene, two_bodies(link, 0.0))
    )
    force, moment = force - bare[0], moment - bare[1]
    np.testing.assert_allclose(force.sum(axis=0), 0.0, atol=1e-9)
    np.testing.assert_allclose((moment + np.cross(PLACES, force)).sum(axis=0), 0.0, atol=1e-8)
    half = 0.5 * (CENTERS[1, 2] - CENTERS[0, 2])

    def deformation(time: float) -> Any:
        """In the middle axes of both bodies, by SciPy's rotations."""
        turned = [
            Rotation.from_rotvec(time * spin) * Rotation.from_euler("XYZ", each) for spin, each in zip(spins, angles)
        ]
        relative = (turned[0].inv() * turned[1]).as_rotvec()
        middle = turned[0] * Rotation.from_rotvec(0.5 * relative)
        ends = [
            place + time * velocity + turn.apply([-center[0], -center[1], sign * half])
            for place, velocity, turn, center, sign in zip(PLACES, velocities, turned, CENTERS, (1.0, -1.0))
        ]
        return np.append(middle.inv().apply(ends[1] - ends[0]), relative)

    rate, yaw = (deformation(1e-5) - deformation(-1e-5)) / 2e-5, scene.yaws[1]
    along = np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]]) @ rate[:2]
    values, units = scene.damping[0] * model.units.time / model.units.mass, model.units
    taken, bars = (values * along**2).sum(), scene.bar_links[0]
    if bars is not None:
        moments = np.array([bars.bending, bars.bending, bars.torsion]) / units.force / units.length
        along_bars = bars.tension * units.length / units.force * rate[2] ** 2
        taken += scene.damping[0, 0] / bars.shear / units.time * (along_bars + (moments * rate[3:] ** 2).sum())
    power = (force * velocities).sum() + (moment * spins).sum()
    assert power == pytest.approx(-taken, rel=2e-3)  # bodies are turned against each other by 0.01


def test_a_damped_body_off_the_axis_has_dampers_that_turn() -> None:
    """Those of elastic_chain.py on bearings of 1e7 N/m; without omega x D they are 0.95162 and 1.01113."""
    values = {"duration": 4.0, "isolator.supports": 3, "bodies.1.offset": [0.2, 0.2], "bodies.1.damping": 0.3}
    scene = load_scene("fig3-I").with_values(values).with_amplitude(1.5)
    answer = multibody.amplification(scene, [(2.0, 0.7)], "spatial", 5e-3, tolerance=1e-4)
    assert_within(answer, [0.947956, 1.013365])


@pytest.mark.parametrize("way", [1, -1], ids=["along x below", "along y above"])
def test_steps_follow_the_fastest_swing_damper_and_harmonic_wherever_they_are(way: int) -> None:
    stiff = [{"stiffness": [9e3, 40.0][::way], "damping": [0.0, 30.0][::way]}, {"stiffness": [20.0, 50.0]}][::way]
    bodies = [{"mass": 2.0}, {"mass": 3.0, **stiff[0]}, {"mass": 0.7, **stiff[1]}]
    scene = load_scene("fig3-I").with_values({"bodies": bodies, "excitation.decay": [0.2, 3.0][::way]})
    model = assemble(scene, "translational", 1e-3)
    assert shortest_period(scene, model) * model.units.time == pytest.approx(reference.modes(scene).period.min())
    assert model.ground.decay_rate == pytest.approx(3.0 * model.units.time)
    link, damper = np.eye(3)[:2] - np.eye(3)[1:], np.diag([30.0, 0.0][::way])
    rate = np.linalg.eigvals((link.T @ damper @ link) / scene.masses[:, None]).real.max() * model.units.time
    assert rate <= fastest_damper_rate(scene, model.units) * (1.0 + 1e-12) <= 2.0 * rate
