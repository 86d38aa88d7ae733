"""Derivatives with respect to values of the scene, against closed forms and a law of scaling."""

import numpy as np
import pytest
from chains import chain, refusal

from reference import Estimate, Scene, SceneError, sensitivity

ONE_BODY = chain(0.25, 0.08, [2.0], (), [[1.5, 0.4], [0.3, 1.2]], duration=6.0)


def test_a_power_of_a_value_has_its_derivative_within_the_error() -> None:
    def cube(scene: Scene) -> Estimate:
        return Estimate(scene.isolator.friction**-3.0, 1e-9)  # type: ignore[operator]

    found = sensitivity(ONE_BODY, ["isolator.friction"], cube)["isolator.friction"]
    missed = abs(found.value - -3.0 * 0.08**-4.0)
    assert missed <= found.error <= 1e-5 * abs(found.value)


def test_the_error_of_the_quantity_is_over_the_step() -> None:
    """1.6 % of the value is the largest step, over which (4 near - far) / 3 has three times the error."""
    found = sensitivity(ONE_BODY, ["bodies.0.mass"], lambda scene: Estimate(scene.total_mass, 1e-3))["bodies.0.mass"]
    assert (found.value, found.error) == pytest.approx((1.0, 3.0 * 1e-3 / (1.6e-2 * 2.0)))


def test_a_kink_within_the_step_shows_in_the_error() -> None:
    def kinked(scene: Scene) -> Estimate:
        return Estimate(max(scene.isolator.friction - 0.08, 0.0), 0.0)  # type: ignore[operator]

    found = sensitivity(ONE_BODY.with_values({"isolator.friction": 0.080001}), ["isolator.friction"], kinked)
    assert abs(found["isolator.friction"].value - 1.0) <= found["isolator.friction"].error


def test_what_has_no_derivative_is_refused_or_unknown() -> None:
    found = sensitivity(ONE_BODY, ["isolator.friction"], lambda scene: Estimate(np.nan, np.nan))
    assert np.isnan(found["isolator.friction"].value)
    for keys, kind, said in (
        (["isolator.frictio"], SceneError, "did you mean friction"),
        (["title"], ValueError, "must be a number"),
        (["isolator.lubrication"], ValueError, "must be a number"),
        ("isolator.friction", TypeError, "keys = 'isolator.friction': must be a list of keys"),
    ):
        assert said in str(refusal(sensitivity, ONE_BODY, keys, lambda scene: Estimate(1.0, 0.0), kind=kind))
    line = str(refusal(sensitivity, ONE_BODY, ["isolator.friction"], lambda scene: scene.masses, kind=TypeError))
    assert line.startswith("quantity: returns array(")
    assert "must return an Amplification" in line
