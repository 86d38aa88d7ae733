"""The plate's frame: inertial forces over a plate at rest and a plate that really moves give the same motion."""

from typing import Any

import numpy as np
import pytest
from scenes_at_hand import assert_agree

import multibody
from multibody import demand_surface
from reference.problem import Scene, ground_acceleration, load_scene

PHASES = [(2.0, 0.7)]


def shaken_in_all_directions(duration: float) -> Scene:
    shaking = {"excitation.amplitudes": [[1.0, 0.5], [0.0, 1.0], [2.0, 1.0]]}
    return load_scene("fig3-I").with_values({"duration": duration, **shaking})


def test_inertial_forces_and_a_moving_plate_agree() -> None:
    scene = shaken_in_all_directions(3.0)
    inertial, plate = (
        multibody.amplification(scene, PHASES, "spatial", loading=each) for each in ("inertial", "plate")
    )
    assert_agree(plate, inertial)
    # the errors are upper estimates and mostly shared: a plate a million times as heavy leaves less
    np.testing.assert_allclose(plate.mu, inertial.mu, rtol=3e-5)


def test_demands_are_those_of_the_motion_that_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    asked, trajectory = [], demand_surface.trajectory

    def noted(scene: Scene, phase: Any, *given: Any, **more: Any) -> Any:
        asked.append((*given, more))
        return trajectory(scene, phase, *given, **more)

    monkeypatch.setattr(demand_surface, "trajectory", noted)
    found = multibody.peak_demands(shaken_in_all_directions(0.2), PHASES, "spatial", 5e-3, 1e-2, "plate", 1e5)
    assert asked == [("spatial", 5e-3, 1e-2, {"loading": "plate", "max_work": 1e5})]
    assert found.status.tolist() == ["ok"]


def test_motion_over_a_moving_plate_is_relative_to_it() -> None:
    scene, phase = shaken_in_all_directions(2.0), (0.3, 1.1)
    moving, resting = (multibody.trajectory(scene, phase, loading=loading) for loading in ("plate", "inertial"))
    swing = np.abs(resting.position).max()
    assert swing > 0.01
    seen = np.array([np.interp(moving.time, resting.time, x) for x in resting.position.reshape(-1, 6).T]).T
    # linear between steps of 3 ms, and a plate that gives way by a millionth
    np.testing.assert_allclose(moving.position.reshape(-1, 6), seen, atol=2e-4 * swing)
    # over a plate that moves the engine knows absolute accelerations itself; the top body's follow from its spring
    stiffness, mass = scene.stiffness[0], scene.masses[1]
    spring = -stiffness * (moving.position[:, 1, :2] - moving.position[:, 0, :2]) / mass
    largest = np.abs(spring).max()
    assert largest > 2.0 * np.abs(ground_acceleration(scene, phase, moving.time)[:, :2]).max() / 3.0
    np.testing.assert_allclose(moving.absolute_acceleration[:, 1, :2], spring, atol=2e-3 * largest)
