"""The rotations of the independent equations of space (rigid_chain.py), at turns that no scene of the tests reaches."""

import numpy as np
import pytest
import rigid_chain
from scipy.spatial.transform import Rotation

pytestmark = pytest.mark.long
TURNS = np.random.default_rng(3).uniform(-1.5, 1.5, (20, 3))


def test_matrices_of_turns_and_their_products_are_those_of_scipy():
    for turn, other in zip(TURNS, TURNS[::-1]):
        matrix, second = Rotation.from_rotvec(turn), Rotation.from_rotvec(other)
        assert rigid_chain._rotation(turn) == pytest.approx(matrix.as_matrix(), abs=1e-14)
        product = rigid_chain._product(matrix.as_matrix(), second.as_matrix())
        assert product == pytest.approx((matrix * second).as_matrix(), abs=1e-14)
        assert rigid_chain._turned(product, other) == pytest.approx((matrix * second).apply(other), abs=1e-14)
        assert rigid_chain._rotation_vector(matrix.as_matrix()) == pytest.approx(matrix.as_rotvec(), abs=1e-13)


@pytest.mark.parametrize("size", [1.0, 1e-2, 1e-5])
def test_the_rate_of_a_turn_is_its_difference_along_the_motion(size):
    step = 1e-5
    for turn, omega in zip(size * TURNS, TURNS[::-1]):
        ends = [(Rotation.from_rotvec(s * omega) * Rotation.from_rotvec(turn)).as_rotvec() for s in (-step, step)]
        assert rigid_chain._rate(turn, omega) == pytest.approx((ends[1] - ends[0]) / (2.0 * step), abs=1e-8)


@pytest.mark.parametrize("relative", [0.0, 0.7])
def test_what_a_link_does_to_two_bodies_changes_no_momentum(relative):
    """Against gravity and the shaking alone: forces between bodies cancel, and so do their moments."""
    rng, bodies = np.random.default_rng(4), 3
    centers = np.array([[0.0, 0.0, 0.1], [0.1, -0.2, 0.6], [-0.1, 0.1, 1.3]])
    turn = np.array([0.4, -0.3, 0.6]) + relative * rng.uniform(-0.5, 0.5, (bodies, 3))
    state = np.array([centers + rng.normal(0.0, 0.1, (bodies, 3)), turn, *rng.normal(0.0, 1.0, (2, bodies, 3))])
    masses, tensors = np.array([3.0, 2.0, 1.5]), np.array([np.diag(rng.uniform(0.2, 0.5, 3)) for _ in range(bodies)])
    shear, twist = np.array([[[900.0, 100.0], [100.0, 700.0]]] * 2), np.array([50.0, 70.0])
    bars = np.array([[0.0] * 6, [2e4, 300.0, 0.5, 15.0, 2.0, -1.0]])
    ring, ground = np.array([[1.0, 0.0], [-0.5, 0.8], [-0.5, -0.8]]), np.array([0.7, -0.4, 0.0])
    accelerated, normals = rigid_chain.accelerations(
        state, ground, masses, tensors, centers, shear, twist, bars, ring, 1.0, 0.0, 0.0, 1.0
    )
    field = -np.array([*ground[:2], rigid_chain.GRAVITY])
    spun, force, moment = np.zeros(3), masses.sum() * field, np.zeros(3)
    for i, mass in enumerate(masses):
        matrix = Rotation.from_rotvec(turn[i]).as_matrix()
        tensor, omega = matrix @ tensors[i] @ matrix.T, state[3, i]
        spun += mass * np.cross(state[0, i], accelerated[i, :3])
        spun += tensor @ accelerated[i, 3:] + np.cross(omega, tensor @ omega)
        moment += mass * np.cross(state[0, i], field)
    for point, normal in zip(ring, normals):
        support = state[0, 0] + Rotation.from_rotvec(turn[0]).apply([*point, 0.0] - centers[0])
        away = np.array([*point, 1.0]) - support
        force += normal * away / np.linalg.norm(away)
        moment += np.cross(support, normal * away / np.linalg.norm(away))
    assert masses @ accelerated[:, :3] == pytest.approx(force, rel=1e-9, abs=1e-9)
    assert spun == pytest.approx(moment, rel=1e-9, abs=1e-9)
