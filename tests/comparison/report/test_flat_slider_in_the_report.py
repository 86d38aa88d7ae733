"""A flat slider in a study: its radius is infinite, and nothing that is written breaks on it."""

import math

import pytest

from comparison.evidence.effective.analysis import read_values_back
from comparison.study.models import MODEL_HIERARCHY, models_of
from multibody.film import make_drawing
from reference import demands, trajectory
from reference.problem import load_scene

FLAT = load_scene("fig3-I").with_values({"isolator.period": None, "isolator.radius": math.inf, "duration": 2.0})


@pytest.mark.parametrize("model", MODEL_HIERARCHY, ids=lambda model: model.key)
def test_every_motion_shows_a_plane_and_its_friction(model):
    assert model in models_of(FLAT, MODEL_HIERARCHY)
    values = read_values_back((FLAT, model))
    assert values.error_message == ""
    if model.key != "spatial":  # tilting lifts its center of mass
        assert values.radius == math.inf
        assert values.friction == pytest.approx(0.1, rel=2e-3)
    assert values.mass == pytest.approx(2.0, rel=1e-6)


def test_a_film_of_a_flat_slider_draws_a_straight_line():
    motion = trajectory(FLAT, (0.3, 1.1))
    drawn = make_drawing(FLAT, motion, 10.0, 4)
    assert (drawn.swing_curve[:, 1] == 0.0).all()
    assert drawn.swing_curve[:, 0].max() > 10.0 * demands(motion).displacement.value, (
        "it is as long as the way of the bodies"
    )
