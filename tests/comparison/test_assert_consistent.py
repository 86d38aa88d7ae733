"""The gate for users: what it lets pass, what it reports, and what it refuses."""

from __future__ import annotations

import numpy as np
import pytest

import reference
from comparison.testing import assert_consistent
from reference.problem import SceneError


def with_engine_off_by(monkeypatch: pytest.MonkeyPatch, factor: float, error: float = 1e-6) -> None:
    """Every model answers with mu = 2, the engine's models with `factor` times that."""
    monkeypatch.setattr(
        "comparison.study.batches.imported", lambda path: answering(factor if "multibody" in path else 1.0, error)
    )


def answering(factor: float, error: float):  # type: ignore[no-untyped-def]
    def amplification(scene, phases, **settings):  # type: ignore[no-untyped-def]
        mu = np.full((len(phases), len(scene.bodies)), 2.0 * factor)
        ok, never = np.full(len(phases), "ok"), np.full(len(phases), np.nan)
        return reference.Amplification(mu, np.full_like(mu, error), ok, never, 0.0)

    return amplification


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


def test_a_difference_within_its_errors_never_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    with_engine_off_by(monkeypatch, 1.01, error=0.02)
    assert_consistent("fig3-I", like_for_like=0.0, total=0.0, like_for_like_maximum=0.0, total_maximum=0.0)


def test_no_value_at_all_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    with_engine_off_by(monkeypatch, np.nan)
    with pytest.raises(AssertionError, match="no phase pair has a value"):
        assert_consistent("fig3-I", like_for_like=1.0)


def test_the_spatial_model_is_computed_for_the_total_difference_only(monkeypatch: pytest.MonkeyPatch) -> None:
    computed: list[str] = []

    def execute(batch):  # type: ignore[no-untyped-def]
        from comparison.study.batches import BatchResult

        computed.append(batch.model)
        shape = (len(batch.phases), 2)
        return BatchResult(np.full(shape, 2.0), np.full(shape, 1e-6), ["ok"] * shape[0], np.full(shape[0], np.nan), 0.0)

    monkeypatch.setattr("comparison.testing.execute_batch", execute)
    assert_consistent("fig3-I", like_for_like=1e-3)
    assert "spatial" not in computed
    assert_consistent("fig3-I", total=1e-3)
    assert "spatial" in computed


def test_a_gate_without_a_limit_or_with_a_wrong_one_is_refused_in_one_line() -> None:
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
