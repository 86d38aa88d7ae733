"""Derivatives with respect to values of the scene, against closed forms and a law of scaling."""

import numpy as np
import pytest
from chains import chain

import reference
from reference import Estimate, Scene, SceneError, sensitivity
from reference.problem import Amplification

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


def test_the_derivative_along_two_values_is_the_sum_of_both() -> None:
    def mu(scene: Scene) -> Amplification:
        return reference.amplification(scene, [(0.3, 1.1)], tolerance=1e-9)

    def along_both(scene: Scene) -> Amplification:
        return mu(scene.with_values({"isolator.friction": 0.08 * float(scene.excitation.scale)}))

    scene = ONE_BODY.with_values({"excitation.scale": 1.0})
    apart = sensitivity(scene, ["isolator.friction", "excitation.scale"], mu)
    friction, scale = apart["isolator.friction"], apart["excitation.scale"]
    both = sensitivity(scene, ["excitation.scale"], along_both)["excitation.scale"]
    missed = np.abs(0.08 * friction.value + scale.value - both.value)
    error = 0.08 * friction.error + scale.error + both.error
    assert np.abs(0.08 * friction.value).min() > 5.0 * np.abs(both.value).max(), "two large parts that nearly cancel"
    assert (missed <= error).all()
    assert (error < 1e-4 * np.abs(scale.value)).all()


def test_a_run_without_an_answer_has_no_derivative() -> None:
    found = sensitivity(ONE_BODY, ["isolator.friction"], lambda scene: Estimate(np.nan, np.nan))
    assert np.isnan(found["isolator.friction"].value)


@pytest.mark.parametrize(
    ("key", "kind", "said"),
    [
        ("isolator.frictio", SceneError, "friction"),
        ("title", ValueError, "must be a number"),
        ("isolator.lubrication", ValueError, "must be a number"),
    ],
)
def test_a_key_without_a_number_is_refused(key: str, kind: type[Exception], said: str) -> None:
    with pytest.raises(kind, match=said):
        sensitivity(ONE_BODY, [key], lambda scene: Estimate(1.0, 0.0))


def test_what_is_no_list_and_has_no_error_is_refused() -> None:
    with pytest.raises(TypeError, match=r"keys = 'isolator\.friction': must be a list of keys"):
        sensitivity(ONE_BODY, "isolator.friction", lambda scene: Estimate(1.0, 0.0))
    with pytest.raises(TypeError, match=r"quantity: returns array\(.*must return an Amplification"):
        sensitivity(ONE_BODY, ["isolator.friction"], lambda scene: scene.masses)  # type: ignore[arg-type, return-value]
