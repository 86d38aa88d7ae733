"""The gate for users: what it lets pass, what it reports, and what it refuses."""

import re
from collections.abc import Callable
from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from known_analyses import answering, with_engine_off_by

import reference
from comparison.study.batches import drop_unusable, execute_batch
from comparison.study.user_models import REFERENCE_MODEL_KEYS
from comparison.testing import assert_consistent
from reference.problem import Scene, SceneError

LAW_SETTINGS: dict[str, dict[str, Any]] = {
    "small": {"equations": "small"},
    "exact": {},
    "small-resolved": {"equations": "small", "cutoff": 1e-3},
    "resolved": {"cutoff": 1e-3},
    "small-regularised": {"equations": "small", "regularization": 1e-3},
    "regularised": {"regularization": 1e-3},
}
SHORT = reference.load_scene("fig3-I").with_values({"duration": 2.0, "name": "fig3-I"})
BARS = {"bodies.1.period": None, "bodies.1.bars": {"count": 4, "bending_stiffness": 0.8, "length": 1.0}}


def failure(scene: Scene | str = "fig3-I", **asked: Any) -> list[str]:
    """The lines of the gate that fails."""
    with pytest.raises(AssertionError) as failed:
        assert_consistent(scene, **asked)
    return str(failed.value).splitlines()


@pytest.mark.parametrize(("factor", "error", "limit"), [(1.0005, 1e-6, 1e-3), (1.01, 0.02, 0.0)])
def test_what_is_within_limits_or_errors_passes(
    monkeypatch: pytest.MonkeyPatch, factor: float, error: float, limit: float
) -> None:
    with_engine_off_by(monkeypatch, factor, error)
    assert_consistent("fig3-I", like_for_like=limit, total=limit, like_for_like_maximum=limit, total_maximum=limit)


@pytest.mark.parametrize("limit", ["like_for_like", "like_for_like_maximum", "total", "total_maximum"])
def test_a_broken_limit_names_body_phase_values_and_errors(monkeypatch: pytest.MonkeyPatch, limit: str) -> None:
    with_engine_off_by(monkeypatch, 1.01)
    kind, maximum = limit.removesuffix("_maximum"), limit.endswith("maximum")
    first, second = "exact equations, v_reg", "translational engine"
    if kind == "total":
        first, second = "small equations, as integrated", "spatial engine"
    assert failure(**{limit: 1e-3}) == [
        f"fig3-I, body {body}: {kind}: {'maximum' if maximum else 'median'} difference 0.01, allowed 0.001; largest "
        f"0.01 at (0.0000, 0.0000) rad: {first} 2 ± 1e-06, {second} 2.02 ± 1e-06"
        for body in (1, 2)
    ]
    assert "; largest 0.01 under the record: " in failure("synthetic-pair", **{limit: 1e-3})[0]


def change_engine(
    monkeypatch: pytest.MonkeyPatch, change: Callable[[reference.Amplification, np.ndarray], None]
) -> None:
    """Every model answers with mu = 2; change: of the engine's answer at its phases, in place."""

    def import_function(path: str) -> Any:
        def amplification(scene: Scene, phases: np.ndarray, **settings: Any) -> reference.Amplification:
            found: reference.Amplification = answering(1.0, 1e-6)(scene, phases)
            if "multibody" in path:
                change(found, phases)
            return found

        return amplification

    monkeypatch.setattr("comparison.study.batches.import_function", import_function)


def test_median_and_maximum_have_limits_of_their_own(monkeypatch: pytest.MonkeyPatch) -> None:
    """One of nine phase pairs is off by 1 %, that with the last alpha_1 and the first alpha_2."""

    def change(found: reference.Amplification, phases: np.ndarray) -> None:
        found.mu[(phases[:, 0] > 4.0) & (phases[:, 1] < 1.0)] *= 1.01

    change_engine(monkeypatch, change)
    assert_consistent("fig3-II", like_for_like=1e-3, grid=3)
    line, _ = failure("fig3-II", like_for_like_maximum=1e-3, grid=3)
    assert "like_for_like: maximum difference 0.01, allowed 0.001; largest 0.01 at (4.1888, 0.0000) rad" in line


def test_a_difference_within_its_error_is_not_the_largest(monkeypatch: pytest.MonkeyPatch) -> None:
    """2 % beside an error of 5 % at the first phase pair, 1 % beyond the errors at the last."""

    def change(found: reference.Amplification, phases: np.ndarray) -> None:
        first, last = ~phases.any(axis=1), (phases > 4.0).all(axis=1)
        found.mu[first], found.error[first] = 1.02 * found.mu[first], 0.05 * found.mu[first]
        found.mu[last] *= 1.01

    change_engine(monkeypatch, change)
    line, _ = failure("fig3-II", like_for_like_maximum=1e-3, grid=3)
    assert "maximum difference 0.01, allowed 0.001; largest 0.01 at (4.1888, 4.1888) rad" in line


def test_points_without_a_usable_value_fail_unless_they_are_allowed(monkeypatch: pytest.MonkeyPatch) -> None:
    with_engine_off_by(monkeypatch, np.nan)
    both = "exact equations, v_reg and translational engine"
    *bodies, gap, why = failure(like_for_like=1.0)
    assert bodies == [f"fig3-I, body {body}: like_for_like: no phase pair has a value by {both}" for body in (1, 2)]
    assert gap.startswith("fig3-I: translational engine: no value at any of 16 phase pairs")
    assert (gap[-11:], why) == ("; 0 allowed", "multibody:amplification called a non-finite answer ok")
    assert sum("; 20 allowed" in line for line in failure(like_for_like=1.0, total=1.0, failed=20)) == 2, "16 each"
    with_engine_off_by(monkeypatch, 1.0, error=1.2)  # above half of 2
    gaps = failure(like_for_like=1.0)[2:]
    assert ["only values with errors above half of them" in line for line in gaps] == [True, True]


def off_by(factor: float, law: str, missing: int = 0, status: str = "ok"):  # type: ignore[no-untyped-def]
    """
    An engine of the user that is off from the equations of a law by a factor.

    At so many of four phase pairs it has no value; status: what it says of the first.
    """
    asked = []

    def engine(scene, phases, regularization, tolerance):  # type: ignore[no-untyped-def]
        asked.append(regularization)
        mu = factor * reference.amplification(scene, phases, **LAW_SETTINGS[law], tolerance=1e-6).mu
        first = len(asked) == 1
        return SimpleNamespace(mu=mu if len(asked) > missing else np.nan * mu, status=[status if first else "ok"])

    return engine


@pytest.mark.parametrize("law", REFERENCE_MODEL_KEYS)
def test_a_user_engine_is_compared_with_the_equations_of_its_law(law: str) -> None:
    limits = {"like_for_like": 1e-4, "like_for_like_maximum": 1e-4, "grid": 2, "law": law}
    assert_consistent(SHORT, **limits, engine=off_by(1.0, law))
    lines = failure(SHORT, **limits, engine=off_by(1.021, law))
    assert len(lines) == 4, "median and maximum of two bodies"
    assert all("difference 0.021, allowed 0.0001" in line and "your engine " in line for line in lines)
    assert all(line.endswith(" (error unknown)") for line in lines)


@pytest.mark.parametrize("law", REFERENCE_MODEL_KEYS)
def test_no_other_law_is_taken_for_that_of_an_engine(law: str) -> None:
    scene = SHORT.with_values({"duration": 6.0})  # with stops, which tell the readings apart
    for other in [other for other in REFERENCE_MODEL_KEYS if other != law]:
        lines = failure(scene, like_for_like_maximum=1e-4, grid=2, law=other, engine=off_by(1.0, law))
        assert "your engine" in lines[0]


@pytest.mark.parametrize(("missing", "status"), [(1, "ok"), (0, "not converged"), (0, "tolerance not met")])
def test_a_status_that_is_not_ok_is_no_value(missing: int, status: str) -> None:
    limits = {"like_for_like": 1e-4, "like_for_like_maximum": 1e-4, "grid": 2}
    engine = {"missing": missing, "status": status}
    gap, *why = failure(SHORT, **limits, engine=off_by(1.0, "regularised", **engine))
    assert re.fullmatch(r"fig3-I: your engine: no value at 1 of 4 phase pairs: .*; 0 allowed", gap)
    assert why == (["the engine's status is 'not converged'"] if status == "not converged" else [])
    assert_consistent(SHORT, **limits, engine=off_by(1.0, "regularised", **engine), failed=1)


@pytest.mark.parametrize(
    ("arguments", "rule"),
    [
        ({"grid": Fraction(1, 1000)}, "grid = Fraction(1, 1000): must be a whole number from 1 to 512"),
        ({"grid": True}, "grid = True: must be a whole number from 1 to 512"),
        ({"tolerance": "1"}, "tolerance = '1': must be finite and positive, from 1e-10 to 0.1"),
        ({"law": "spatial"}, "law = 'spatial': must be one of small, exact, small-resolved, resolved, small-"),
        ({"failed": -1}, "failed = -1: must be a whole number from 0"),
        ({"like_for_like": None}, "no limit: give one of like_for_like, like_for_like_maximum, total, total_maximum"),
        ({"total_maximum": -1.0}, "total_maximum = -1.0: "),
    ],
)
def test_a_wrong_argument_of_the_gate_is_one_line(arguments: dict[str, Any], rule: str) -> None:
    with pytest.raises(ValueError, match=re.escape(rule)):
        assert_consistent("fig3-I", **{"like_for_like": 0.1, **arguments})
    with pytest.raises(SceneError):
        assert_consistent("fig3-III", total=0.1)


@pytest.mark.parametrize(
    ("scene", "limit", "models"),
    [
        (SHORT, "like_for_like", {"regularised": 1e-6, "translational": 1e-3}),
        (SHORT, "total", {"small-resolved": 1e-6, "spatial": 1e-3}),
        (SHORT.with_values(BARS), "total", {"small-resolved": 1e-6, "softened-spatial": 1e-3}),
    ],
)
def test_only_the_models_that_a_limit_needs_are_computed(
    monkeypatch: pytest.MonkeyPatch, scene: Scene, limit: str, models: dict[str, float]
) -> None:
    computed: list[Any] = []
    noted = lambda batch: computed.append(batch) or execute_batch(batch)  # noqa: E731
    monkeypatch.setattr("comparison.testing.execute_batch", noted)
    with_engine_off_by(monkeypatch, 1.0)
    assert_consistent(scene, **{limit: 1e-3})
    assert {batch.model: batch.settings["tolerance"] for batch in computed} == models
    computed.clear()
    assert_consistent(scene, **{"like_for_like": 1e-3, limit: 1e-3})
    assert {batch.model for batch in computed} == {*models, "regularised", "translational"}


def test_a_broken_median_is_told_with_the_largest_difference_and_its_place(monkeypatch: pytest.MonkeyPatch) -> None:
    def change(found: reference.Amplification, phases: np.ndarray) -> None:
        found.mu[:] *= 1.01
        found.mu[(phases > 4.0).all(axis=1)] *= 1.02

    change_engine(monkeypatch, change)
    line, _ = failure("fig3-II", like_for_like=1e-3, grid=3)
    assert "median difference 0.01, allowed 0.001; largest 0.0302 at (4.1888, 4.1888) rad" in line
    assert line.endswith(", translational engine 2.0604 ± 1e-06")


@pytest.mark.parametrize("value", [-1.0, 1e13, np.inf])
def test_an_answer_that_failed_keeps_its_reason_whatever_its_value(value: float) -> None:
    mu, error = np.array([[value, 2.0]] * 4 + [[1.5, 2.0]]), np.zeros((5, 2))
    status = ["ok", "ok, nearly", "diverged", "tolerance not met", "diverged"]
    drop_unusable(mu, error, status, own=True)
    assert status == [*["value out of range"] * 2, "diverged", "value out of range", "diverged"]
    assert np.isnan(mu).all()
