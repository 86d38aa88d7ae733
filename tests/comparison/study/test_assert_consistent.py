"""The gate for users: what it lets pass, what it reports, and what it refuses."""

import re
from fractions import Fraction

import numpy as np
import pytest
from known_analyses import with_engine_off_by

import reference
from comparison.testing import assert_consistent
from reference.problem import SceneError


def test_sides_that_agree_pass(monkeypatch: pytest.MonkeyPatch) -> None:
    with_engine_off_by(monkeypatch, 1.0005)
    assert_consistent("fig3-I", like_for_like=1e-3, total=1e-3, like_for_like_maximum=1e-3, total_maximum=1e-3)


@pytest.mark.parametrize("limit", ["like_for_like", "like_for_like_maximum", "total", "total_maximum"])
def test_a_broken_limit_names_body_phase_values_and_errors(monkeypatch: pytest.MonkeyPatch, limit: str) -> None:
    with_engine_off_by(monkeypatch, 1.01)
    with pytest.raises(AssertionError) as failure:
        assert_consistent("fig3-I", **{limit: 1e-3})  # type: ignore[arg-type]
    lines = str(failure.value).splitlines()
    assert len(lines) == 2, "one for each body"
    assert lines[0].startswith(f"fig3-I, body 1: {limit.removesuffix('_maximum')}: ")
    for part in ("difference 0.01, allowed 0.001", "(0.0000, 0.0000) rad", " 2 ± 1e-06", " 2.02 ± 1e-06"):
        assert part in lines[0]


def test_the_phases_named_are_alpha_1_and_alpha_2_in_this_order() -> None:
    def engine(scene, phases, regularization, tolerance):  # type: ignore[no-untyped-def]
        result = reference.amplification(scene, phases, regularization=regularization, tolerance=1e-6)
        there = (phases[:, 0] > 3.0) & (phases[:, 1] < 1.0)
        return np.where(there[:, None], 1.01, 1.0) * result.mu

    scene = reference.load_scene("fig3-I").with_values({"duration": 2.0})
    with pytest.raises(AssertionError, match=r"at \(3\.1416, 0\.0000\) rad"):
        assert_consistent(scene, like_for_like_maximum=1e-3, grid=2, law="exact", engine=engine)


def test_a_difference_within_its_errors_never_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    with_engine_off_by(monkeypatch, 1.01, error=0.02)
    assert_consistent("fig3-I", like_for_like=0.0, total=0.0, like_for_like_maximum=0.0, total_maximum=0.0)


def test_no_value_at_all_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    with_engine_off_by(monkeypatch, np.nan)
    with pytest.raises(AssertionError, match="no phase pair has a value"):
        assert_consistent("fig3-I", like_for_like=1.0)


def off_by(factor: float, missing: int = 0):  # type: ignore[no-untyped-def]
    """An engine of the user that is off from the exact equations, without a value at so many of four phase pairs."""
    asked = []

    def engine(scene, phases, regularization, tolerance):  # type: ignore[no-untyped-def]
        asked.append(regularization)
        result = reference.amplification(scene, phases, regularization=regularization, tolerance=1e-6)
        return factor * result.mu if len(asked) > missing else np.full_like(result.mu, np.nan)

    return engine


@pytest.mark.parametrize("law", ["regularised", "exact"])
def test_a_user_engine_is_compared_with_the_equations_of_its_law(law: str) -> None:
    scene = reference.load_scene("fig3-I").with_values({"duration": 2.0})
    limits = {"like_for_like": 1e-4, "like_for_like_maximum": 1e-4, "grid": 2, "law": law}
    assert_consistent(scene, **limits, engine=off_by(1.0))
    with pytest.raises(AssertionError) as failure:
        assert_consistent(scene, **limits, engine=off_by(1.021))
    lines = str(failure.value).splitlines()
    assert len(lines) == 4, "median and maximum of two bodies"
    assert all("difference 0.021, allowed 0.0001" in line and "engine " in line for line in lines)
    assert all(line.endswith(" (error unknown)") for line in lines)


def test_a_point_without_a_value_fails_unless_it_is_allowed() -> None:
    scene = reference.load_scene("fig3-I").with_values({"duration": 2.0})
    with pytest.raises(AssertionError, match=r"fig3-I: engine: no value at 1 of 4 phase pairs: .*; 0 allowed"):
        assert_consistent(scene, like_for_like=0.1, grid=2, engine=off_by(1.0, missing=1))
    assert_consistent(scene, like_for_like=0.1, grid=2, engine=off_by(1.0, missing=1), failed=1)


def test_an_engine_that_raises_fails_with_file_line_and_message() -> None:
    def broken(scene, phases):  # type: ignore[no-untyped-def]
        raise ZeroDivisionError("a pivot vanishes")

    line = broken.__code__.co_firstlineno + 1
    with pytest.raises(AssertionError) as failure:
        assert_consistent("fig3-I", like_for_like=0.1, grid=2, engine=broken)
    assert str(failure.value).splitlines()[-1] == (
        f"ZeroDivisionError: a pivot vanishes (test_assert_consistent.py, line {line})"
    )


@pytest.mark.parametrize(
    ("argument", "value", "rule"),
    [
        ("grid", Fraction(1, 1000), "grid = Fraction(1, 1000): must be a whole number from 1 to 512"),
        ("grid", True, "grid = True: must be a whole number from 1 to 512"),
        ("tolerance", "1", "tolerance = '1': must be finite and positive, from 1e-10 to 0.1"),
        ("law", "spatial", "law = 'spatial': must be one of small, exact, resolved, regularised"),
        ("failed", -1, "failed = -1: must be a whole number from 0"),
    ],
)
def test_a_wrong_argument_of_the_gate_is_one_line(argument: str, value: object, rule: str) -> None:
    with pytest.raises(ValueError, match=re.escape(rule)):
        assert_consistent("fig3-I", like_for_like=0.1, **{argument: value})  # type: ignore[arg-type]


def test_the_spatial_model_is_computed_for_the_total_only(monkeypatch: pytest.MonkeyPatch) -> None:
    computed: list[str] = []

    def execute(batch):  # type: ignore[no-untyped-def]
        from comparison.study.batches import BatchResult

        computed.append(batch.model)
        shape = (len(batch.phases), 2)
        never = np.full(shape[0], np.nan)
        return BatchResult(np.full(shape, 2.0), np.full(shape, 1e-6), ["ok"] * shape[0], never, 0.0, "", never)

    monkeypatch.setattr("comparison.testing.execute_batch", execute)
    assert_consistent("fig3-I", like_for_like=1e-3)
    assert "spatial" not in computed
    assert_consistent("fig3-I", total=1e-3)
    assert "spatial" in computed


def test_a_gate_without_a_limit_is_refused_in_one_line() -> None:
    with pytest.raises(
        ValueError, match="no limit: give one of like_for_like, like_for_like_maximum, total, total_maximum"
    ):
        assert_consistent("fig3-I")
    with pytest.raises(ValueError, match="total_maximum"):
        assert_consistent("fig3-I", total_maximum=-1.0)
    with pytest.raises(SceneError):
        assert_consistent("fig3-III", total=0.1)


@pytest.mark.parametrize("name", ["fig4-viscous"])
def test_a_scene_of_the_paper_is_consistent(name: str) -> None:
    scene = reference.load_scene(name).with_values({"duration": 6.0})
    assert_consistent(scene, like_for_like=1e-3, like_for_like_maximum=5e-3, grid=2)


def test_median_and_maximum_have_limits_of_their_own(monkeypatch: pytest.MonkeyPatch) -> None:
    """One of four phase pairs is off by 1 %."""

    def imported(path: str):  # type: ignore[no-untyped-def]
        def amplification(scene, phases, **settings):  # type: ignore[no-untyped-def]
            off = 0.01 * ("multibody" in path) * (np.asarray(phases).sum(axis=1) == 0.0)
            mu = np.repeat(2.0 * (1.0 + off)[:, None], len(scene.bodies), axis=1)
            ok, never = np.full(len(mu), "ok"), np.full(len(mu), np.nan)
            return reference.Amplification(mu, np.full_like(mu, 1e-6), ok, never, 0.0)

        return amplification

    monkeypatch.setattr("comparison.study.batches.imported", imported)
    scene = reference.load_scene("fig3-II").with_values({"isolator.friction": 0.1})
    assert_consistent(scene, like_for_like=1e-3, grid=3)
    with pytest.raises(AssertionError, match=r"like_for_like: maximum difference 0\.01, allowed"):
        assert_consistent(scene, like_for_like_maximum=1e-3, grid=3)
