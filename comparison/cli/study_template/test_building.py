"""The gate: the equations and the engine must agree about the building. `python -m pytest`."""

from __future__ import annotations

from pathlib import Path

from comparison.testing import assert_consistent

SCENE = Path(__file__).with_name("building.toml")


def test_the_equations_and_the_engine_agree() -> None:
    """With equal geometry and friction law, amplifications differ by no more than the limits beyond both errors."""
    assert_consistent(SCENE, like_for_like=1e-3, like_for_like_maximum=2e-3, grid=2)
