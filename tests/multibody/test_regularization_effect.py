"""What regularization does to a surface of the engine is estimated from a second v_reg, if so asked."""

import numpy as np
import pytest
from scenes_at_hand import one_body

import multibody
import reference

# 98 % of the friction at rest: the set-valued law holds the platform, the regularized one lets it creep
HELD = one_body(
    friction=0.1, duration=10.0, amplitudes=[[0.96, 0.0], [0.0, 0.0]], periods=[1.0, 1.0], decay=[0.01, 0.01]
)
V_REG = 1e-4


def test_the_effect_of_regularization_is_the_creep_that_no_error_covers():
    levels = multibody.levels(HELD)[1:]  # of one's own: runs at both speeds take them
    plain = multibody.amplification(HELD, [(0.0, 0.0)], regularization=V_REG, levels=levels)
    result = multibody.amplification(
        HELD, [(0.0, 0.0)], regularization=V_REG, levels=levels, regularization_effect=True
    )
    finer = multibody.amplification(HELD, [(0.0, 0.0)], regularization=V_REG / 10.0, levels=levels)
    for name in ("mu", "error", "displacement", "status"):
        np.testing.assert_array_equal(getattr(result, name), getattr(plain, name))
    np.testing.assert_array_equal(result.regularization_effect, finer.mu - plain.mu)
    np.testing.assert_array_equal(result.displacement_effect, finer.displacement - plain.displacement)
    assert result.cost > 0.0
    truth = reference.amplification(HELD, [(0.0, 0.0)]).displacement - plain.displacement
    assert result.displacement_effect == pytest.approx(truth, rel=0.15), "nine tenths of an effect in proportion"
    assert abs(truth[0]) > 0.9 * plain.displacement[0], "all of it is creep"
    slip = f"the displacement by up to {abs(result.displacement_effect[0]):.2g} m"
    assert result.law.endswith(slip)
    assert f"to v_reg = 1e-05 m/s mu changes by up to {abs(result.regularization_effect[0, 0]):.2g}" in result.law
    assert slip in repr(result)


def test_without_being_asked_for_the_effect_is_unknown_and_without_dry_friction_it_is_zero():
    plain = multibody.amplification(HELD, [(0.0, 0.0)], tolerance=1e-2)
    assert np.isnan(plain.regularization_effect).all()
    assert np.isnan(plain.displacement_effect).all()
    assert "changes by up to" not in plain.law
    scene = reference.load_scene("fig4-viscous").with_values({"duration": 0.5})
    phases = reference.phase_grid(2).reshape(2, 2, 2)
    viscous = multibody.amplification(scene, phases, tolerance=1e-2, regularization=None, regularization_effect=True)
    assert viscous.regularization_effect.shape == viscous.mu.shape == (2, 2, 2)
    assert not viscous.regularization_effect.any()
    assert not viscous.displacement_effect.any()


def test_the_effect_is_unknown_without_an_answer():
    refused = multibody.amplification(HELD, [(0.0, 0.0)], max_work=10.0, regularization_effect=True)
    assert np.isnan(refused.regularization_effect).all()
    assert "changes by up to" not in refused.law
