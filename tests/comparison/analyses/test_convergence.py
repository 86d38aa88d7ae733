"""Regularization to nothing and stiffness to infinity: planted laws are found, the real ones are of first order."""

from __future__ import annotations

import numpy as np
import pytest
from known_analyses import collected
from numpy.typing import NDArray

import multibody
import reference
from comparison.analyses.convergence import analysis as convergence
from comparison.analyses.convergence.analysis import LIMITS, PENETRATIONS, Convergence, limit_trends
from comparison.study.study import Study
from reference.problem import Amplification, Scene, load_scene

Array = NDArray[np.float64]


def _study(*names: str) -> Study:
    return Study(tuple(load_scene(name) for name in names), 2, 1e-3)


def test_a_lubricated_scene_has_only_the_limit_of_the_contact(monkeypatch: pytest.MonkeyPatch) -> None:
    def planted(scene: Scene) -> tuple[Array, Array]:
        sizes = np.array(PENETRATIONS)[None, :, None] * np.array([1.0, -2.0])[None, None, :]
        return sizes, 1e-3 * np.abs(sizes)

    limits = [limit._replace(parameter=PENETRATIONS, expected=1.0, measure=planted) for limit in LIMITS]
    monkeypatch.setattr(convergence, "LIMITS", limits)
    trends = collected(Convergence(), _study("fig3-I", "fig4-viscous"))
    assert [trend.scene for trend in trends] == ["fig3-I"] * 10 + ["fig4-viscous"] * 2
    assert [trend.body for trend in trends] == [1, 2] * 6
    assert {trend.verdict for trend in trends} == {"like the power 1"}


def _regularized(power: float) -> object:
    """mu = 3, or 3 + v^power under a regularized law."""

    def amplification(scene: Scene, phases: Array, tolerance: float, **settings: float) -> Amplification:
        v = settings.get("regularization")
        mu = np.full((len(phases), len(scene.bodies)), 3.0 + (0.0 if v is None else v**power))
        return Amplification(mu, 1e-9 * mu, np.full(len(mu), "ok"), np.full(len(mu), np.nan), 0.0)

    return amplification


@pytest.mark.parametrize(("power", "says"), [(1.0, "like the power 1"), (0.5, "not like the power 1")])
def test_the_order_in_v_reg_is_that_of_the_law(monkeypatch: pytest.MonkeyPatch, power: float, says: str) -> None:
    monkeypatch.setattr(reference, "amplification", _regularized(power))
    monkeypatch.setattr(multibody, "amplification", _regularized(power))
    for number in (0, 2):  # the equations and the engine, against the resolved peak
        trends = list(limit_trends((load_scene("fig3-I"), number)))
        assert trends
        for trend in trends:
            assert trend.verdict == says
            assert trend.exponent == pytest.approx(power, abs=1e-6)


def test_a_limit_that_fails_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(scene: Scene) -> None:
        raise RuntimeError("no engine")

    monkeypatch.setattr(convergence, "LIMITS", [LIMITS[4]._replace(measure=broken)])
    trends = collected(Convergence(), _study("fig3-I"))
    assert [trend.verdict for trend in trends] == ["solver failed: RuntimeError: no engine"] * 2


def test_a_contact_ten_times_stiffer_is_ten_times_closer(monkeypatch: pytest.MonkeyPatch) -> None:
    """Second body of fig3-II: 8e-5 of mu at 3e-3 of rho; what is of higher order there is a tenth of it."""
    monkeypatch.setattr(convergence, "FEWEST_PERIODS", 2.0)
    trend = limit_trends((load_scene("fig3-II"), 4))[1]
    assert trend.verdict == "like the power 1"
    assert trend.medians[0] == pytest.approx(8.4e-5, rel=0.2)
    assert trend.exponent == pytest.approx(1.0, abs=0.15)


@pytest.mark.long
def test_regularization_is_of_first_order() -> None:
    scene = load_scene("fig3-II")
    resolved, supremum = (limit_trends((scene, number)) for number in (0, 1))
    assert [trend.verdict for trend in resolved] == ["like the power 1"] * 2
    assert supremum[0].verdict.startswith("hardly falls")
    assert supremum[1].verdict == "falls"


@pytest.mark.parametrize("order", [1, 2])
def test_the_error_of_a_constant_step_covers_it(monkeypatch: pytest.MonkeyPatch, order: int) -> None:
    """A method of this order that is off by 1 % with the coarser steps."""

    def stepped(scene: Scene, v_reg: float, penetration: float, factor: int) -> Array:
        return np.full((len(convergence.FEW), 2), 3.0 * (1.0 + 0.01 / factor**order))

    monkeypatch.setattr(convergence, "_at_constant_step", stepped)
    monkeypatch.setattr(reference, "amplification", _regularized(60.0))
    sizes, errors = convergence._stiffened(load_scene("fig3-I"))
    assert (np.abs(sizes) <= errors).all()
    assert (errors <= 5.0 * np.abs(sizes)).all()
