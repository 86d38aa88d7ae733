"""The geometric step falls like s^2 in a model that has one, does not in one that has not, and does in the paper's."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from known_analyses import collected
from numpy.typing import NDArray

import reference
from comparison.analyses.scaling.analysis import PRINTED, STEP, Scaling, scaled
from comparison.analyses.trends import Trend
from comparison.study.study import Study
from reference import trajectory
from reference.problem import Amplification, Scene, load_scene

Array = NDArray[np.float64]


def _study(*names: str) -> Study:
    return Study(tuple(load_scene(name) for name in names), 2, 1e-3)


def _model(step: Callable[[float], float]) -> Callable[..., Amplification]:
    """mu = 2 + i, small as printed 1 + 0.01 s^2 of it, exact step(s) above that; s read from the scene's loading."""

    def amplification(scene: Scene, phases: Array, equations: str, **settings: object) -> Amplification:
        s = float(np.abs(scene.amplitudes).max())
        factor = (1.0 + 0.01 * s**2) * (1.0 + (step(s) if equations == "exact" else 0.0))
        mu = factor * (2.0 + np.arange(len(scene.bodies)) + 0.1 * np.cos(phases[:, :1]))
        return Amplification(mu, 1e-9 * mu, np.full(len(mu), "ok"), np.full(len(mu), np.nan), 0.0)

    return amplification


def _found(monkeypatch: pytest.MonkeyPatch, step: Callable[[float], float], name: str = "fig3-I") -> list[Trend]:
    monkeypatch.setattr(reference, "amplification", _model(step))
    return list(collected(Scaling(), _study(name)))


def test_a_geometric_step_has_the_exponent_two(monkeypatch: pytest.MonkeyPatch) -> None:
    trends = _found(monkeypatch, lambda s: 0.03 * s**2)
    assert len(trends) == 2 * 2 * 2, "supremum and resolved, two bodies, two trends"
    assert {trend.verdict for trend in trends} == {"like the power 2"}
    assert {round(trend.exponent, 2) for trend in trends if trend.what.startswith(STEP)} == {2.0}


@pytest.mark.parametrize("step", [lambda s: 0.03 * s, lambda s: 0.03, lambda s: 0.03 * s**3])
def test_a_step_that_is_no_geometry_is_found_out(
    monkeypatch: pytest.MonkeyPatch, step: Callable[[float], float]
) -> None:
    verdicts = {trend.what.split(",")[0]: trend.verdict for trend in _found(monkeypatch, step)}
    assert verdicts[STEP] == "not like the power 2"
    assert verdicts[PRINTED.split(",")[0]] == "like the power 2", "the small equations alone are untouched"


def test_a_step_that_jumps_has_no_exponent(monkeypatch: pytest.MonkeyPatch) -> None:
    trends = _found(monkeypatch, lambda s: 0.2 if s == 0.25 else -0.03 * s**2)
    assert {trend.verdict[:15] for trend in trends if trend.what.startswith(STEP)} == {"no single slope"}


def test_a_lubricated_scene_has_one_peak(monkeypatch: pytest.MonkeyPatch) -> None:
    assert len(_found(monkeypatch, lambda s: 0.03 * s**2, "fig4-viscous")) == 2 * 2

    def broken(*args: object, **settings: object) -> None:
        raise RuntimeError("singular")

    monkeypatch.setattr(reference, "amplification", broken)
    trends = collected(Scaling(), _study("fig4-viscous"))
    assert [trend.body for trend in trends] == [1, 2]
    assert {trend.verdict for trend in trends} == {"solver failed: RuntimeError: singular"}


VARYING = {"slow": 0.02, "fast": 0.1, "rate": 20.0}  # s/m; slips of 0.05 m/s lie in the middle of its rise


@pytest.mark.parametrize(("name", "friction"), [("fig3-II", 0.1), ("fig3-II", VARYING), ("fig4-viscous", None)])
def test_the_scaled_scene_moves_as_the_scene_scaled(name: str, friction: object) -> None:
    """Small equations without the kept terms would do so exactly; with them to s^2 of the swing, 1e-2 here."""
    scene = load_scene(name).with_values({"duration": 2.0, **({"isolator.friction": friction} if friction else {})})
    larger, smaller = (trajectory(scaled(scene, s), (2.0, 0.7), equations="small").position for s in (0.25, 0.125))
    np.testing.assert_allclose(larger, 2.0 * smaller, atol=1e-2 * np.abs(larger).max())


@pytest.mark.long
def test_the_step_to_the_exact_equations_is_geometry() -> None:
    """fig3-II: every trend like s^2, with an uncertainty below 0.1."""
    trends = collected(Scaling(), _study("fig3-II"))
    assert {trend.verdict for trend in trends} == {"like the power 2"}
    assert max(trend.uncertainty for trend in trends) < 0.1
