"""Friction that yields in the engine: a closed form, the equations of the same law, and supports that stand apart."""

from typing import Any

import numpy as np
import pytest
from scenes_at_hand import one_body

import multibody
import reference
from multibody.integration.one_run import PhasePair
from multibody.models.assembly import assemble
from reference.problem import GRAVITY, Scene, State, load_scene

LOADS = {"excitation.amplitudes": [[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]}
PHASE = (0.3, 1.1)


def _yielding(name: str, friction: dict[str, float], **values: Any) -> Scene:
    return load_scene(name).with_values({"isolator.friction": friction, "duration": 4.0, **values})


def test_a_platform_vibrates_on_its_springs_below_yield_without_loss() -> None:
    """About the place where spring and pendulum balance, at the frequency of both, for fifteen periods."""
    scene = one_body(1.0, duration=3.0).with_values({"isolator.friction": {"slow": 0.1, "yield_displacement": 1e-3}})
    start, pendulum, spring = 0.01, GRAVITY, 0.1 * GRAVITY / 1e-3
    middle = start * spring / (spring + pendulum)
    motion = multibody.trajectory(scene, (0.0, 0.0), initial=State(np.array([[start, 0.0]]), np.zeros((1, 2))))
    expected = middle + (start - middle) * np.cos(np.sqrt(spring + pendulum) * motion.time)
    np.testing.assert_allclose(motion.position[:, 0, 0], expected, atol=4e-3 * (start - middle))
    assert motion.time[-1] * np.sqrt(spring + pendulum) > 30.0 * np.pi


def test_a_slow_cycle_loses_four_times_friction_and_way_beyond_yield() -> None:
    """At one level; what the pendulum and the swing on the springs keep at its ends is 0.3 % of it."""
    friction, yields, period = 0.1, 2e-3, 20.0
    shaking = {"amplitudes": [[0.12 * GRAVITY, 0.0], [0.0, 0.0]], "periods": [period] * 2, "decay": [1e-9] * 2}
    scene = one_body(2.0, duration=1.5 * period, **shaking).with_yield_displacement(yields)
    motion = multibody.single_run(scene, (-0.5 * np.pi, 0.0), level=multibody.levels(scene)[1])
    cycle = motion.time >= 0.5 * period
    place, weight = motion.position[cycle, 0, 0], scene.total_mass * GRAVITY
    force = -scene.total_mass * motion.absolute_acceleration[cycle, 0, 0]
    height = 2.0 - np.sqrt(4.0 - place**2)
    lost = np.trapezoid(force * motion.velocity[cycle, 0, 0], motion.time[cycle]) - weight * (height[-1] - height[0])
    amplitude = 0.5 * np.ptp(place)
    assert lost == pytest.approx(4.0 * friction * weight * (amplitude - yields), rel=5e-3)
    assert yields > 0.03 * amplitude


def test_two_levels_that_agree_show_no_error(monkeypatch: pytest.MonkeyPatch) -> None:
    made, run = [], PhasePair.run_level
    monkeypatch.setattr(PhasePair, "run_level", lambda pair, level, *rest, **more: (
        made.append(level), run(pair, level, *rest, **more))[1])  # fmt: skip
    for friction in ({"slow": 0.1, "yield_displacement": 1e-3}, 0.1):
        made.clear()
        scene = load_scene("fig3-I").with_values({"isolator.friction": friction, "duration": 1.0})
        assert multibody.amplification(scene, [PHASE], tolerance=0.1).status.tolist() == ["ok"]
        assert len({level.step for level in made}) == (2 if friction == 0.1 else 3)


@pytest.mark.parametrize(
    ("name", "friction", "values"),
    [
        ("fig3-I", {"slow": 0.1, "yield_displacement": 1e-3}, {}),
        ("fig3-II", {"slow": 0.1, "yield_displacement": 1e-4}, {}),
        ("fig3-II", {"slow": 0.05, "fast": 0.1, "rate": 20.0, "initial_stiffness": 1000.0}, {}),
        ("fig3-II", {"slow": 0.1, "load_exponent": -0.2, "yield_displacement": 1e-3}, LOADS),
        ("fig3-II", {"slow": 0.1, "yield_displacement": 1e-3}, {"isolator.radius": np.inf, "isolator.period": None}),
    ],
    ids=["1 mm", "0.1 mm", "of speed", "of load", "on a plane"],
)
def test_engine_and_equations_agree_within_their_errors(
    name: str, friction: dict[str, float], values: dict[str, Any]
) -> None:
    scene = _yielding(name, friction, **values)
    ours, theirs = multibody.amplification(scene, [PHASE]), reference.amplification(scene, [PHASE])
    assert ours.status.tolist() == ["ok"]
    assert (np.abs(ours.mu - theirs.mu) <= ours.error + theirs.error).all()
    np.testing.assert_allclose(ours.mu, theirs.mu, rtol=5e-4)
    np.testing.assert_allclose(ours.displacement, theirs.displacement, rtol=1e-3)


def test_supports_that_stand_apart_share_the_stiffness() -> None:
    """Overturning presses supports by next to nothing there, so that bodies that turn move as in translation."""
    friction = {"slow": 0.1, "yield_displacement": 1e-3}
    wide = {"isolator.ring": 100.0, "duration": 0.3}
    scene = _yielding("fig3-I", friction, **wide)
    turning = multibody.amplification(scene, [PHASE], model="spatial", full=True)
    straight = multibody.amplification(scene, [PHASE])
    np.testing.assert_allclose(turning.mu, straight.mu, rtol=2e-3)


def test_rigid_friction_has_no_springs() -> None:
    scene = load_scene("fig3-I")
    assert assemble(scene, "spatial", 1e-3).springs is None
    assert [level.slide_end for level in multibody.levels(scene)] == [0.0] * 8
