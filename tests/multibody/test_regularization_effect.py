"""What regularization does to a surface of the engine is estimated from a second v_reg, if so asked."""

from inspect import signature
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scenes_at_hand import one_body

import multibody
import reference
from multibody import surface

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


def test_both_speeds_have_all_that_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """The softened scene, the model and every limit; of two runs of 3 s and 5 s the cost is the sum."""
    asked: list[Any] = []

    def noted(*given: Any) -> Any:
        def answer(pairs: Any, ground: Any, *limits: Any) -> Any:
            asked.append((*given, *limits))
            return (*np.full((2, 1, 2), 1.0 / len(asked)), np.array(["ok"]), np.array([np.nan]), np.array([0.1]))

        return SimpleNamespace(answer=answer)

    monkeypatch.setattr(surface, "_reduce_model", noted)
    monkeypatch.setattr(surface, "time", SimpleNamespace(process_time=iter([0.0, 3.0, 10.0, 15.0]).__next__))
    bars = {"bodies.1.period": None, "bodies.1.bars": {"count": 4, "bending_stiffness": 0.8, "length": 1.0}}
    scene, levels = reference.load_scene("synthetic-pair").with_values(bars), multibody.levels(HELD)
    found = multibody.amplification(
        scene, (0.0, 0.0), "spatial", 2e-3, 1e-2, full=True, levels=levels, max_work=5e4, softened=True,
        regularization_effect=True,
    )  # fmt: skip
    page = (Path(multibody.__file__).parent / "README.md").read_text(encoding="utf-8")
    damping = signature(multibody.floor_spectra).parameters["damping"].default
    assert "v_reg in m/s, below which dry friction is linear" in page
    assert "computes\n  every point with a tenth of v_reg" in page
    assert f"`floor_spectra(trajectory, periods=None, damping={damping})`" in page
    soft, limits = scene.softened(), (1e-2, levels, 5e4)
    assert asked == [(soft, "spatial", v_reg, True, *limits) for v_reg in (2e-3, pytest.approx(2e-4))]
    assert (found.cost, found.scene_name, found.regularization_effect.tolist()) == (8.0, scene.name, [-0.5, -0.5])
