"""Closed forms where no motion of the solver asks for them (test_closed_form_motions.py): limits and refusals."""

import numpy as np
import pytest
from chains import chain
from scipy.integrate import solve_ivp

from reference.analytical import (
    circular_shaking,
    coulomb_decay,
    coulomb_rest,
    den_hartog,
    frictionless_motion,
    no_stop_bound,
    squared_rate,
)
from reference.problem import GRAVITY

RADIUS, FREQUENCY = 0.25, 2.0 * np.pi / 0.7


@pytest.mark.parametrize("friction", [0.0, 0.05, 0.3])
def test_squared_rate_obeys_the_equation_of_motion(friction):
    """rho theta'' = -g sin theta + mu N/m while theta falls, N/m = g cos theta + rho theta'^2, integrated in time."""
    start, rate = 0.9, -0.5

    def rhs(_, y):
        theta, omega = y
        normal = GRAVITY * np.cos(theta) + RADIUS * omega**2
        return [omega, (-GRAVITY * np.sin(theta) + friction * normal) / RADIUS]

    run = solve_ivp(rhs, (0.0, 0.25), [start, rate], method="DOP853", rtol=1e-12, atol=1e-13)
    found = [squared_rate(angle, start, rate, friction, RADIUS) for angle in run.y[0]]
    np.testing.assert_allclose(found, run.y[1] ** 2, rtol=1e-9)


def test_release_inside_the_dead_zone_stays():
    assert coulomb_rest(0.019, 0.02, 5.0) == (0.0, 0.019)
    position, velocity = coulomb_decay([0.0, 3.0], -0.019, 0.02, 5.0)
    np.testing.assert_array_equal(position, -0.019)
    np.testing.assert_array_equal(velocity, 0.0)


@pytest.mark.parametrize("ratio", [0.6, 0.8, 1.4, 2.0])
def test_bound_is_where_the_slide_begins_to_stop(ratio):
    """Just inside, x falls all the half period; just outside, the formula's motion would turn back within it."""
    bound, angle = no_stop_bound(ratio), np.linspace(0.0, np.pi, 200001)
    assert np.all(np.diff(den_hartog(ratio, bound * (1.0 - 1e-4)).position(angle)) < 1e-14)
    with pytest.raises(ValueError, match="the motion stops"):
        den_hartog(ratio, bound * (1.0 + 1e-9))
    outside = bound * (1.0 + 1e-2)
    tangent = np.tan(0.5 * np.pi / ratio)
    v, u = 1.0 / (1.0 - ratio**2), tangent / ratio
    phase = np.arctan2(-outside * u / v, np.sqrt(max(v * v - (outside * u) ** 2, 0.0)) / v)
    own = outside * (1.0 - np.cos(angle / ratio) - tangent * np.sin(angle / ratio))
    assert np.any(np.diff(own + v * np.cos(angle + phase)) > 0.0)


@pytest.mark.parametrize("equations", ["exact", "small"])
@pytest.mark.parametrize(
    ("friction", "stiffness", "rule"), [(0.9, 120.0, "friction is too strong"), (0.08, 121.0, "not circular")]
)
def test_shaking_without_circles_is_refused(friction, stiffness, rule, equations):
    scene = chain(0.3, friction, (2.0, 1.0), [[120.0, stiffness]], [[1.0, 0.0], [0.0, 1.0]], (0.7, 0.7), (0.0, 0.0))
    with pytest.raises(ValueError, match=rule):
        circular_shaking(scene, 1.0, FREQUENCY, equations)


@pytest.mark.parametrize(
    ("friction", "vertical", "rule"), [(0.1, [0.0, 0.0], "friction"), (0.0, [1.0, 0.0], "vertical")]
)
def test_scenes_without_a_modal_sum_are_refused(friction, vertical, rule):
    scene = chain(friction=friction, amplitudes=[[1.0, 0.0], [0.0, 1.0], vertical])
    with pytest.raises(ValueError, match=rule):
        frictionless_motion(scene, (0.3, 1.1), [0.0])
