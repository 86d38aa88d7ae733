"""The spatial model: an independent calculation, rest, and the start in balance."""

import math
from typing import Any

import numpy as np
import pytest
from scenes_at_hand import assert_agrees_with_newton_and_euler

import multibody
import reference
from multibody.integration.engine_run import Budget
from multibody.integration.one_run import PhasePair
from multibody.models.assembly import assemble
from reference.problem import GRAVITY, State, ground_acceleration, load_scene


@pytest.mark.long  # a minute of compiling the independent equations
@pytest.mark.parametrize(
    "values",
    [
        {"duration": 2.65, "isolator.supports": 3},
        {"duration": 2.65},
        {"duration": 4.0, "isolator.ring": 0.3},  # one of four opens
    ],
)
def test_factors_agree_with_constrained_newton_euler_equations(values: dict[str, Any]) -> None:
    assert_agrees_with_newton_and_euler(load_scene("fig3-I").with_values(values), (2.0, 0.7))


def test_a_platform_rests_while_every_support_creeps() -> None:
    offsets = {"bodies.0.offset": [0.3, -0.1], "bodies.1.offset": [0.3, 0.1]}  # of a platform that turns
    scene = load_scene("fig3-I").with_values({"duration": 1.0, **offsets})
    motion = multibody.trajectory(scene, (2.0, 0.7), "spatial", tolerance=1e-2)
    creeping = motion.extra["slip_speed"] < 1e-3
    rest = [any(begin <= instant <= end for begin, end in motion.stick) for instant in motion.time]
    assert (creeping.all(axis=1) == rest).all()
    assert creeping.any(axis=1).mean() > np.mean(rest) + 0.1


VERTICAL = {"excitation.amplitudes": [[0.0, 0.0], [0.0, 0.0], [4.0, 2.0]], "excitation.decay": [0.0, 0.0]}


@pytest.mark.parametrize("stated", [False, True], ids=["at rest", "at a stated state"])
@pytest.mark.parametrize("supports", [3, 4])
def test_the_start_is_in_balance_with_the_loading(supports: int, stated: bool) -> None:
    """Every body goes up with the plate: spheres and links start as deep as weight and inertia press them."""
    scene = load_scene("fig3-I").with_values({"duration": 1e-3, "isolator.supports": supports, **VERTICAL})
    state = State(np.zeros((2, 2)), np.zeros((2, 2))) if stated else None
    motion = multibody.trajectory(scene, (0.3, 1.1), model="spatial", initial=state)
    ground = ground_acceleration(scene, (0.3, 1.1), motion.time)
    assert ground[0, 2] > 4.5
    np.testing.assert_allclose(motion.absolute_acceleration - ground[:, None], 0.0, atol=1e-3)
    share = scene.total_mass * (GRAVITY + ground[:, 2:]) / supports
    np.testing.assert_allclose(motion.extra["support_force"], np.tile(share, supports), rtol=1e-3)


@pytest.mark.parametrize(("supports", "share"), [(3, 1.0), (4, 1.0), (6, 1.0), (3, 1.5)])
def test_a_start_without_weight_is_in_balance_at_every_level(supports: int, share: float) -> None:
    """The plate falls as fast as the bodies, or faster: springs of spheres and links carry nothing."""
    fall = {**VERTICAL, "excitation.amplitudes": [[0.0, 0.0], [0.0, 0.0], [-share * GRAVITY, 0.0]]}
    scene = load_scene("fig3-I").with_values({"isolator.supports": supports, **fall})
    model = assemble(scene, "spatial", 1e-3)
    for level in multibody.levels(scene, "spatial"):
        pair = PhasePair(scene, model, np.zeros(2))
        run = pair.run_level(level, Budget(1e5), stop=1e-3 * math.sqrt(level.penetration), keep=True)
        expected = np.zeros(model.coordinates)
        expected[model.bodies[:, 2]] = share - 1.0
        np.testing.assert_allclose(run.chunks[0].accelerations[0], expected, atol=1e-2)


def test_a_loading_that_is_gone_sets_nothing_rocking() -> None:
    """Contacts in balance with its first value would throw the upper body about: mu_2 was ten times too large."""
    scene = load_scene("fig3-I").with_values({"duration": 1.0, "excitation.decay": [1e6, 1e6]})
    result = multibody.amplification(scene, [(0.3, 1.1)], "spatial", tolerance=1e-2)
    expected = reference.amplification(scene, [(0.3, 1.1)], regularization=1e-3)
    assert result.status[0] == "ok"
    assert result.mu[0] == pytest.approx(expected.mu[0], rel=2e-2)


def test_links_of_a_given_start_carry_the_weight_of_all_bodies_above() -> None:
    """At once every body is accelerated as the plate is, upwards by 0.5 cos(0.3) m/s^2."""
    above = [{"mass": 2.0, "height": 1.2, "size": [2.0, 1.5, 0.3], "stiffness": [300.0, 200.0]},
             {"mass": 1.5, "height": 2.3, "size": [1.0, 1.5, 0.3], "stiffness": [200.0, 300.0]}]  # fmt: skip
    loading = {"excitation.amplitudes": [[0.0, 0.0], [0.0, 0.0], [0.5, 0.0]], "duration": 5e-4}
    platform = {"mass": 1.0, "height": 0.2, "size": [2.0, 2.0, 0.2]}
    scene = load_scene("fig3-I").with_values({"bodies": [platform, *above], **loading})
    start = State(np.zeros((3, 2)), np.zeros((3, 2)))
    motion = multibody.trajectory(scene, (0.3, 1.0), "spatial", initial=start, tolerance=1e-2)
    np.testing.assert_allclose(motion.absolute_acceleration[0, :, 2], 0.5 * math.cos(0.3), rtol=1e-4)
