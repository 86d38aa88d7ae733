"""Every result says which reading of (5.1) it has, and which law of friction its error leaves out."""

import numpy as np
import pytest

import multibody
import reference
from reference.problem.readings import describe_law, reading_of

FIG3 = reference.load_scene("fig3-I").with_values({"duration": 0.5})
VISCOUS = reference.load_scene("fig4-viscous").with_values({"duration": 0.5})
SMOOTH = FIG3.with_values({"isolator.friction": 0.0})
PHASE = (0.3, 1.1)
BELOW = "regularized below v_reg = 0.002 m/s: the error leaves out what this changes against set-valued friction"


@pytest.mark.parametrize(
    ("scene", "settings", "reading", "law"),
    [
        (FIG3, {}, "literal supremum", "set-valued Coulomb friction; literal supremum"),
        (FIG3, {"cutoff": 2e-3}, "as integrated", "set-valued Coulomb friction; as integrated, v_c = 0.002 m/s"),
        (FIG3, {"regularization": 2e-3}, "as integrated", BELOW),
        (VISCOUS, {}, "", "viscous friction (3.14)"),
        (VISCOUS, {"cutoff": 2e-3}, "", "viscous friction (3.14)"),
        (SMOOTH, {"regularization": 2e-3}, "", "no friction"),
    ],
)
def test_the_equations_say_their_reading_and_their_law(scene, settings, reading, law):
    result = reference.amplification(scene, [PHASE], tolerance=1e-3, **settings)
    assert (result.reading, result.law) == (reading, law)
    assert repr(result).endswith(f"; {law}>")
    assert reading in repr(result)
    assert result.to_xarray().attrs["law"] == law
    if "cutoff" not in settings:
        assert reference.trajectory(scene, PHASE, tolerance=1e-3, **settings).law == law


def test_a_law_that_depends_on_the_velocity_is_not_called_coulomb_s():
    scene = FIG3.with_values({"isolator.friction": {"slow": 0.03, "fast": 0.06, "rate": 100.0}})
    assert describe_law(scene, None) == "set-valued dry friction; literal supremum"


def test_both_readings_agree_where_the_reading_is_left_empty():
    for scene in (VISCOUS, SMOOTH):
        found = [
            reference.amplification(scene, [PHASE], tolerance=1e-4, **law).mu
            for law in ({}, {"cutoff": 1e-3}, {"regularization": 1e-3})
        ]
        assert reading_of(scene, None) == reading_of(scene, 1e-3) == ""
        np.testing.assert_array_equal(found[0], found[1])
        np.testing.assert_array_equal(found[0], found[2])


def test_the_engine_says_its_reading_and_its_law():
    result = multibody.amplification(FIG3, [PHASE], regularization=2e-3, tolerance=1e-2)
    assert (result.reading, result.law, result.model) == ("as integrated", BELOW, "Exudyn, translational model")
    assert f"; as integrated; {BELOW}>" in repr(result)
    viscous = multibody.amplification(VISCOUS, [PHASE], regularization=None, tolerance=1e-2)
    assert (viscous.reading, viscous.law) == ("", "viscous friction (3.14)")
    for motion in (
        multibody.trajectory(FIG3, PHASE, regularization=2e-3, tolerance=1e-2),
        multibody.single_run(FIG3, PHASE, regularization=2e-3, step=1e-3),
    ):
        assert motion.law == BELOW
        assert motion.to_xarray().attrs["law"] == BELOW


def test_the_largest_value_over_the_phases_says_its_reading_except_of_a_displacement():
    for quantity, settings, reading in (
        ("amplification", {}, "literal supremum"),
        ("amplification", {"cutoff": 1e-3}, "as integrated"),
        ("displacement", {}, ""),
    ):
        worst = reference.worst_phases(
            FIG3, quantity=quantity, equations="small", tolerance=1e-2, starts=[PHASE], **settings
        )
        assert worst.reading == reading
        assert worst.law.startswith("set-valued Coulomb friction; ")


def test_a_regularized_law_says_the_largest_change_between_its_two_speeds() -> None:
    changes = np.array([[0.011, -0.032], [np.nan, 0.004]]), np.array([0.0012, -0.00056])
    said = describe_law(FIG3, 2e-3, effect=changes)
    assert said == (
        "regularized below v_reg = 0.002 m/s: the error leaves out what this changes against set-valued friction; "
        "from there to v_reg = 0.0002 m/s mu changes by up to 0.032 and the displacement by up to 0.0012 m"
    )
