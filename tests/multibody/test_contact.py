"""The contact of the engine against closed forms: what one mass does on the sphere and on a plane."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scenes_at_hand import CONSTANT, one_body

import multibody
from multibody.integration.constant_step import EngineSolver, silence_engine
from multibody.models.assembly import assemble
from multibody.models.state import EngineState
from reference.problem import GRAVITY, Scene, State, Trajectory


def started(scene: Scene, position: tuple[float, float], velocity: tuple[float, float], **options: Any) -> Trajectory:
    """The motion from an initial state of the single body."""
    state = State(np.array([position]), np.array([velocity]))
    return multibody.trajectory(scene, (0.0, 0.0), initial=state, **options)


def test_the_weight_presses_the_contact_in(within: Callable[[float, float], None]) -> None:
    model = assemble(one_body(), "translational", 1e-3)
    penetration = 1e-4
    model.set_contact(penetration)
    begin = model.start(None, np.zeros(3), penetration)
    raised = begin.coordinates + np.array([0.0, 0.0, penetration, 0.0, 0.0, 0.0])  # touching, not yet pressed in
    with silence_engine():
        motion = EngineSolver(model, 1e-8, 1e-12).run(
            EngineState(raised, begin.velocities, np.zeros(4)), 0.0, 1e-3, 1000
        )
    assert motion.gap[0, 0] == pytest.approx(0.0, abs=1e-15)
    # settled after 100 of its own time constants, up to Newton's tolerance
    within(abs(motion.gap[-1, 0] / penetration + 1.0), 1e-6)
    assert motion.coordinates[-1, 2] == pytest.approx(0.0, abs=1e-6 * penetration)


def test_a_moving_platform_starts_pressed_by_all_that_accelerates_it() -> None:
    """Weight, centripetal force and the plate, each along the normal (-x, -y, h) / rho."""
    model, penetration, place, speed = assemble(one_body(), "translational", 1e-3), 1e-6, [0.1, -0.05], [0.3, 0.4]
    plate, height = np.array([2.0, -1.0, 0.5]), np.sqrt(0.25**2 - 0.1**2 - 0.05**2)
    start = model.start(State(np.array([place]), np.array([speed])), plate, penetration)
    normal, upward = np.array([-0.1, 0.05, height]) / 0.25, np.dot(place, speed) / height
    pressed = (normal @ plate + normal[2] * GRAVITY + (0.25 + upward**2) / 0.25) / GRAVITY
    assert [-start.contact[0] / penetration, start.load[0]] == pytest.approx([pressed] * 2)


@pytest.mark.parametrize("flat", [False, True])
def test_a_settled_contact_opens_as_its_gap_does(flat: bool) -> None:
    """Along the normal, on a plane the vertical, and nothing changes across it; the gap makes up for the damper."""
    model = assemble(one_body(np.inf if flat else 0.25), "translational", 1e-3)
    place = np.array([50.0, -20.0, 0.0] if flat else [0.3, -0.2, 0.1])
    normal = np.array([0.0, 0.0, 1.0]) - (0.0 if flat else place)
    normal /= np.linalg.norm(normal)
    state = EngineState(np.append(place, np.zeros(3)), np.array([0.1, 0.2, -0.3, 0.0, 0.0, 0.0]), np.ones(4))
    settled, excess = model.settle(state, np.array([0.02]), 1e-6), normal @ state.velocities[:3] - 0.02
    np.testing.assert_allclose((settled.velocities - state.velocities)[:3], -excess * normal, atol=1e-15)
    np.testing.assert_allclose((settled.coordinates - state.coordinates)[:3], 2e-3 * excess * normal, atol=1e-14)
    np.testing.assert_allclose(settled.contact, [1.0 + 2e-3 * excess, 1.0, 1.0, 1.0])


def test_a_held_platform_creeps_as_v_reg_says(within: Callable[[float, float], None]) -> None:
    push, mu, v_reg = 0.5, 0.1, 1e-3
    scene = one_body(friction=mu, duration=0.3, amplitudes=[[-push, 0.0], [0.0, 0.0]], periods=[CONSTANT, CONSTANT])
    motion = multibody.trajectory(scene, (0.0, 0.0), regularization=v_reg, tolerance=1e-4)
    x, v, a = motion.position[-1, 0, 0], motion.velocity[-1, 0, 0], motion.absolute_acceleration[-1, 0, 0] + push
    force = push - GRAVITY * x / scene.radius - a
    assert 0.4 < force / push < 1.0
    # the slope of the sphere, x / rho = 6e-4, enters squared
    within(abs(v * mu * motion.contact_force[-1] / (v_reg * force) - 1.0), 2e-6)
    assert motion.stick == [(0.0, pytest.approx(scene.duration, rel=1e-14))]  # the engine adds up its steps


def test_sliding_stops_after_v_squared_over_two_mu_g(within: Callable[[float, float], None]) -> None:
    speed, mu, v_reg, radius = 1.0, 0.1, 1e-3, 1e4
    scene = one_body(radius=radius, friction=mu, duration=1.2)
    motion = started(scene, (0.0, 0.0), (speed, 0.0), regularization=v_reg, tolerance=1e-5)
    flat = speed**2 / (2.0 * mu * GRAVITY)
    # the slope of the sphere takes x / (2 rho mu) of it, the last bit below v_reg gives v_reg^2 / (2 mu g) back
    distance = flat * (1.0 - flat / (2.0 * radius * mu)) + v_reg**2 / (2.0 * mu * GRAVITY)
    within(abs(motion.position[-1, 0, 0] / distance - 1.0), 2e-5)
    assert motion.stick[0][0] == pytest.approx(speed / (mu * GRAVITY), rel=2e-3)


def test_planar_sliding_follows_the_closed_form(within: Callable[[float, float], None]) -> None:
    mu, radius, begin, speed = 0.15, 0.25, 1.0, 0.5
    scene = one_body(radius=radius, friction=mu, duration=0.4)
    position = (radius * np.sin(begin), 0.0)
    motion = started(scene, position, (-speed * np.cos(begin), 0.0), tolerance=1e-4)
    angle = np.arctan2(motion.position[:, 0, 0], radius - motion.position[:, 0, 2])
    falling = motion.velocity[:, 0, 0] < -0.1

    def particular(th: np.ndarray | float) -> np.ndarray | float:
        weight = 2.0 * GRAVITY / (radius * (1.0 + 4.0 * mu**2))
        return weight * ((1.0 - 2.0 * mu**2) * np.cos(th) + 3.0 * mu * np.sin(th))

    amplitude = ((speed / radius) ** 2 - particular(begin)) * np.exp(-2.0 * mu * begin)
    expected = radius * np.sqrt(amplitude * np.exp(2.0 * mu * angle) + particular(angle))
    speeds = np.linalg.norm(motion.velocity[:, 0], axis=-1)
    assert angle[falling].min() < -0.5
    # h^2 of 3.5 ms steps against the swing of 1 s
    within(abs(speeds[falling] / expected[falling] - 1.0).max(), 1e-4)


def test_a_conical_pendulum_keeps_its_circle_at_its_own_rate(within: Callable[[float, float], None]) -> None:
    radius, cone = 0.25, 0.6
    rate = np.sqrt(GRAVITY / (radius * np.cos(cone)))
    scene = one_body(radius=radius, friction=0.0, duration=2.0)
    across = radius * np.sin(cone)
    motion = started(scene, (across, 0.0), (0.0, rate * across), tolerance=1e-5)
    x, y = motion.position[:, 0, 0], motion.position[:, 0, 1]
    np.testing.assert_allclose(np.hypot(x, y), across, rtol=2e-5)
    within(abs(np.unwrap(np.arctan2(y, x))[-1] / (rate * scene.duration) - 1.0), 1e-5)
    # the compliance gives way by N / k more than at rest: 1e-8 of rho
    np.testing.assert_allclose(motion.contact_force, GRAVITY / np.cos(cone), rtol=1e-4)
