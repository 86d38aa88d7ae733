"""Circular shaking against the force balance on the sphere, written in space and not by complex amplitudes."""

import numpy as np
import pytest
from chains import chain

from reference.analytical import circular_shaking
from reference.problem import GRAVITY, Scene

FREQUENCY = 2.0 * np.pi / 0.7


def circled(friction: float = 0.08, masses: tuple[float, ...] = (2.0, 1.0, 0.7)) -> Scene:
    links = [[k, k] for k in (300.0, 120.0)][: len(masses) - 1]
    return chain(0.3, friction, masses, links, [[3.0, 0.0], [0.0, 3.0]], (0.7, 0.7), (0.0, 0.0))


@pytest.mark.parametrize("acceleration", [2.0, 3.0, 5.0])
def test_forces_balance_on_the_sphere_at_every_instant(acceleration):
    scene = circled()
    motion = circular_shaking(scene, acceleration, FREQUENCY)
    for t in (0.0, 0.13, 0.4):
        turn = np.exp(1j * FREQUENCY * t)
        place = motion.amplitude * turn
        acting = -scene.masses * (acceleration * turn - FREQUENCY**2 * place)  # inertia forces
        elastic = scene.stiffness[:, 0] * np.diff(place)
        acting[:-1] += elastic
        acting[1:] -= elastic
        np.testing.assert_allclose(acting[1:], 0.0, atol=1e-12)
        # contact: the normal reaction points to the center of the sphere, friction against the velocity
        x, y = place[0].real, place[0].imag
        normal = np.array([-x, -y, np.sqrt(scene.radius**2 - x * x - y * y)]) / scene.radius
        velocity = 1j * FREQUENCY * place[0]
        slip = np.array([velocity.real, velocity.imag, 0.0]) / abs(velocity)
        reaction = motion.normal * (normal - scene.friction_coefficient * slip)
        weight = -scene.total_mass * GRAVITY
        total = np.array([acting[0].real, acting[0].imag, weight]) + reaction
        np.testing.assert_allclose(total, 0.0, atol=1e-11 * abs(weight))


def test_small_amplitudes_agree_with_the_linearized_circle():
    gaps = []
    for scale in (1e-1, 1e-2):
        scene = circled(0.08 * scale)
        exact = circular_shaking(scene, 3.0 * scale, FREQUENCY, "exact")
        small = circular_shaking(scene, 3.0 * scale, FREQUENCY, "small")
        gaps.append(np.abs(exact.amplification / small.amplification - 1.0).max())
    assert gaps[0] / gaps[1] == pytest.approx(100.0, rel=0.1)


def test_one_body_has_the_textbook_amplitude():
    """|Z|^2 = (a^2 - (mu g)^2) / (g/rho - omega^2)^2, the platform as a plane oscillator with constant friction."""
    scene = circled(0.05, (2.0,))
    motion = circular_shaking(scene, 3.0, FREQUENCY, "small")
    exact = np.sqrt(9.0 - (0.05 * GRAVITY) ** 2) / abs(GRAVITY / 0.3 - FREQUENCY**2)
    assert abs(motion.amplitude[0]) == pytest.approx(exact, rel=1e-13)


@pytest.mark.parametrize("equations", ["exact", "small"])
def test_friction_that_holds_the_platform_is_refused(equations):
    with pytest.raises(ValueError, match="friction is too strong"):
        circular_shaking(circled(0.9), 1.0, FREQUENCY, equations)


def test_unequal_springs_are_refused():
    with pytest.raises(ValueError, match="not circular"):
        circular_shaking(circled().with_values({"bodies.1.stiffness": [300.0, 301.0]}), 3.0, FREQUENCY)
