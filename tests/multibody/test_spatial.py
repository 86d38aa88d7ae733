"""The spatial model: the translational one where assumption (vi) holds, statics of the supports, liftoff."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scenes_at_hand import CONSTANT, changed, one_body

import multibody
from reference.problem import GRAVITY, Outcome, Scene, ground_acceleration, load_scene

LOST = (Outcome.CONTACT_LOST, Outcome.RIM_REACHED, Outcome.SOLVER_FAILED)
SIZE = [1.0, 1.0, 0.2]


def pushed(push: float, *, ring: float, height: float, duration: float = 0.3) -> Scene:
    """One held body on four supports under a steady push along x."""
    scene = one_body(
        friction=0.2, duration=duration, amplitudes=[[-push, 0.0], [0.0, 0.0]], periods=(CONSTANT, CONSTANT)
    )
    isolator: dict[str, Any] = {"supports": 4, "ring": ring, "sphere_radius": 0.05}
    return changed(scene, isolator=isolator, bodies=[{"mass": 1.0, "height": height, "size": SIZE}])


def test_with_all_heights_zero_it_is_the_translational_model() -> None:
    scene = changed(load_scene("fig3-I"), duration=3.0)
    flat = changed(scene, bodies=[{**body, "height": 0.0} for body in scene.model_dump(exclude_none=True)["bodies"]])
    phase = [(0.3, 1.1)]
    turning = multibody.amplification(flat, phase, model="spatial", full=True)
    moving = multibody.amplification(scene, phase)
    assert turning.status[0] == moving.status[0] == "ok"
    assert (np.abs(turning.mu - moving.mu) <= turning.error + moving.error).all()


def test_the_start_is_in_balance_with_the_loading() -> None:
    # supports that start with equal shares would swing for 1 ms, each body with the plate's own acceleration
    scene = changed(
        load_scene("fig3-I"), duration=0.01, excitation={"amplitudes": [[1.0, 0.0], [0.0, 1.0], [4.0, 2.0]]}
    )
    motion = multibody.trajectory(scene, (0.3, 1.1), model="spatial")
    ground = ground_acceleration(scene, (0.3, 1.1), motion.time)[:, None, 2]
    assert np.abs(ground).max() > 4.0
    # every body goes up with the plate; what is left is 7e-3 of the settling and what the sphere lifts in 10 ms
    np.testing.assert_allclose(motion.absolute_acceleration[:, :, 2] - ground, 0.0, atol=2e-2)


@pytest.mark.parametrize("supports", [3, 4])
def test_errors_hold_against_a_tenth_of_the_tolerance(supports: int) -> None:
    scene = changed(load_scene("fig3-I"), duration=3.0, isolator={"supports": supports})
    phases = [(2.0, 0.7)]
    loose, tight = (multibody.amplification(scene, phases, model="spatial", tolerance=t) for t in (1e-3, 1e-4))
    assert loose.status.tolist() == tight.status.tolist() == ["ok"]
    assert (np.abs(loose.mu - tight.mu) <= loose.error + tight.error).all()


def test_a_tower_on_three_supports_too_close_together_is_lost_by_name() -> None:
    scene = changed(load_scene("fig3-I"), duration=1.5, isolator={"supports": 3, "ring": 0.05})
    result = multibody.amplification(scene, [(2.0, 0.7)], model="spatial", tolerance=1e-2)
    assert result.status[0] in LOST
    assert np.isnan(result.mu).all()
    assert 0.0 < result.instant[0] < 1.5


def test_supports_share_the_load_as_the_overturning_moment_demands() -> None:
    push, ring, height, lever = 0.5, 1.0, 0.6, 0.25 + 0.05
    motion = multibody.trajectory(pushed(push, ring=ring, height=height), (0.0, 0.0), model="spatial")
    forces = motion.extra["support_force"][-1]
    places = ring * np.cos(2.0 * np.pi * (np.arange(4) + 0.5) / 4.0)
    assert forces.sum() == pytest.approx(GRAVITY, rel=1e-4)
    # about the plane in which the spheres touch, a radius R = rho + r above the depressions' centres
    assert forces @ places == pytest.approx(push * (height - lever), rel=1e-2)


def test_a_body_on_a_narrow_ring_lifts_off_and_comes_back() -> None:
    # the push turns from 1.5 m/s^2 to its opposite within 0.5 s; tipping starts at g * (ring / sqrt 2) / lever
    scene = pushed(1.5, ring=0.1, height=1.2, duration=0.5)
    rocking = changed(scene, excitation={"periods": [0.5, 0.5]})
    motion = multibody.trajectory(rocking, (0.0, 0.0), model="spatial", tolerance=1e-2)
    lifted = motion.extra["liftoff"]
    assert len(lifted) > 0
    assert motion.extra["support_force"].min() == 0.0
    assert motion.extra["tilt"].max() > 1e-4
    wide = changed(rocking, isolator={"ring": 2.0})
    assert len(multibody.trajectory(wide, (0.0, 0.0), model="spatial").extra["liftoff"]) == 0


def test_unequal_loads_turn_the_platform_about_the_vertical() -> None:
    scene = changed(load_scene("fig3-I"), duration=2.0)
    high = multibody.trajectory(scene, (2.0, 0.7), model="spatial")
    flat = changed(scene, bodies=[{**body, "height": 0.0} for body in scene.model_dump(exclude_none=True)["bodies"]])
    level = multibody.trajectory(flat, (2.0, 0.7), model="spatial")
    assert np.abs(high.extra["yaw"]).max() > 1e-4
    assert np.abs(level.extra["yaw"]).max() < 1e-7


def test_a_scene_without_spatial_data_is_refused_with_what_it_lacks() -> None:
    with pytest.raises(ValueError, match=r"isolator\.supports.*bodies\.0\.height"):
        multibody.amplification(one_body(), [(0.0, 0.0)], model="spatial")
