"""Den Hartog's steady oscillation: known values, the equation of motion, the bound of continuous sliding."""

import numpy as np
import pytest

from reference.analytical import den_hartog, no_stop_bound


@pytest.mark.parametrize(
    ("ratio", "dead_zone", "amplitude"),
    [(0.6, 0.3, 1.5356018), (1.4, 0.2, 0.9985343), (2.0, 0.15, 0.3247863), (0.8, 0.5, 2.3322350)],
)
def test_amplitude_has_the_known_values(ratio, dead_zone, amplitude):
    """Computed apart from this code; seven decimals are given."""
    assert den_hartog(ratio, dead_zone).amplitude == pytest.approx(amplitude, abs=6e-8)


@pytest.mark.parametrize(("ratio", "dead_zone"), [(0.6, 0.3), (1.4, 0.2), (2.0, 0.15), (0.8, 0.5)])
def test_motion_obeys_its_equation_and_repeats(ratio, dead_zone):
    motion = den_hartog(ratio, dead_zone)
    angle = np.linspace(1e-3, np.pi - 1e-3, 400)
    x = motion.position(angle)
    force = np.cos(angle + motion.phase) + dead_zone  # x falls, so friction pushes up
    np.testing.assert_allclose(motion.acceleration(angle) + x, force, atol=1e-13)
    step = 1e-4  # fourth-order central difference: error step^4/b^4, rounding eps/step^2
    ring = [motion.position(angle[2:-2] + k * step) for k in (-2, -1, 0, 1, 2)]
    second = (-ring[0] + 16 * ring[1] - 30 * ring[2] + 16 * ring[3] - ring[4]) / (12 * step**2)
    np.testing.assert_allclose(ratio**2 * second, motion.acceleration(angle[2:-2]), atol=1e-6)
    assert motion.position(0.0) == pytest.approx(motion.amplitude, rel=1e-13)
    assert motion.position(np.pi) == pytest.approx(-motion.amplitude, rel=1e-13)
    np.testing.assert_allclose(motion.position(angle + np.pi), -x, atol=1e-13)
    rate = (motion.position(2e-6) - motion.position(1e-6)) / 1e-6
    assert rate == pytest.approx(0.0, abs=1e-4)  # a turning point
    assert np.all(np.diff(x) < 0.0)  # no turn and no stop between


@pytest.mark.parametrize("ratio", [0.6, 0.8, 1.4, 2.0])
def test_bound_is_where_the_slide_begins_to_stop(ratio):
    """Just inside, x falls all the half period; just outside, the formula's motion would turn back within it."""
    bound = no_stop_bound(ratio)
    angle = np.linspace(0.0, np.pi, 200001)
    inside = den_hartog(ratio, bound * (1.0 - 1e-4)).position(angle)
    assert np.all(np.diff(inside) < 1e-14)
    with pytest.raises(ValueError, match="the motion stops"):
        den_hartog(ratio, bound * (1.0 + 1e-9))
    outside = bound * (1.0 + 1e-2)
    v, u = 1.0 / (1.0 - ratio**2), np.tan(0.5 * np.pi / ratio) / ratio
    tangent = np.tan(0.5 * np.pi / ratio)
    x0 = np.sqrt(max(v * v - (outside * u) ** 2, 0.0))
    phase = np.arctan2(-outside * u / v, x0 / v)
    own = outside * (1.0 - np.cos(angle / ratio) - tangent * np.sin(angle / ratio))
    assert np.any(np.diff(own + v * np.cos(angle + phase)) > 0.0)
