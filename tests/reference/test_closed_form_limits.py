"""Closed forms where no motion of the solver asks for them (test_closed_form_motions.py): limits and refusals."""

import numpy as np
import pytest
from chains import chain, refusal
from closed_forms.circular_shaking import circular_shaking
from closed_forms.coulomb_decay import coulomb_decay, coulomb_rest
from closed_forms.den_hartog import den_hartog, no_stop_bound

FREQUENCY = 2.0 * np.pi / 0.7


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
    assert "the motion stops" in str(refusal(den_hartog, ratio, bound * (1.0 + 1e-9)))
    outside, tangent, v = bound * (1.0 + 1e-2), np.tan(0.5 * np.pi / ratio), 1.0 / (1.0 - ratio**2)
    sine = outside * tangent / ratio
    phase = np.arctan2(-sine / v, np.sqrt(max(v * v - sine**2, 0.0)) / v)
    own = outside * (1.0 - np.cos(angle / ratio) - tangent * np.sin(angle / ratio))
    assert np.any(np.diff(own + v * np.cos(angle + phase)) > 0.0)


@pytest.mark.parametrize("equations", ["exact", "small"])
def test_shaking_without_circles_is_refused(equations):
    law = {"slow": 0.05, "fast": 0.1, "rate": 3.0}
    for changes, rule in (
        ({"isolator.friction": 0.9}, "friction is too strong"),
        ({"bodies.1.stiffness": [120.0, 121.0]}, "not circular"),
        ({"bodies.1.damping": [1.0, 1.1]}, "not circular"),
        ({"isolator.friction": law}, "constant dry friction only"),
        ({"isolator.friction": None, "isolator.lubrication": 0.1}, "constant dry friction only"),
    ):
        scene = chain(0.3, 0.08, (2.0, 1.0), [[120.0, 120.0]], periods=(0.7, 0.7), decay=(0.0, 0.0))
        assert rule in str(refusal(circular_shaking, scene.with_values(changes), 1.0, FREQUENCY, equations))
