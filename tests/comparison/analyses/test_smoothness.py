"""A zoom tells a curvature from a fold and a jump; symmetric surfaces are those of a full computation."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from comparison.analyses.claims.smoothness import bends
from reference import amplification
from reference.problem import Amplification, Scene, half_turn, load_scene, own_axes, phase_grid
from reference.problem.symmetry import surface

Array = NDArray[np.float64]
SHAPES: dict[str, Callable[[Array, Array], Array]] = {
    "smooth": lambda a, b: np.exp(np.cos(a) + np.cos(b - 1.0)),
    "fold": lambda a, b: np.maximum(np.cos(a - b), np.cos(a + b + 0.3)),
    "jump": lambda a, b: np.cos(a) + (np.abs(b - 3.0) < 1.1),
}


def _both(phases: Array) -> Array:
    """Two bodies: one smooth, one folded."""
    return np.stack([SHAPES[kind](*phases.T) for kind in ("smooth", "fold")], axis=-1)


@pytest.mark.parametrize("kind", SHAPES)
def test_the_exponent_is_that_of_the_shape(kind: str) -> None:
    """That of a fold depends on where it lies between the points: by a factor of two over three halvings, 1/3."""
    phases = phase_grid(16)
    mu = SHAPES[kind](*phases.T).reshape(16, 16, 1)
    bend = bends(mu, lambda at: SHAPES[kind](*np.mod(at, 2.0 * np.pi).T)[:, None])[0]
    assert bend.kind == kind
    assert bend.exponent == pytest.approx({"smooth": 2.0, "fold": 1.0, "jump": 0.0}[kind], abs=0.34)


def test_every_body_is_judged_by_its_own_surface() -> None:
    smooth, fold = bends(_both(phase_grid(16)).reshape(16, 16, 2), _both)
    assert (smooth.kind, fold.kind) == ("smooth", "fold")
    alpha1, alpha2 = fold.phases
    other_side = np.cos(alpha1 + alpha2 + 0.3)
    assert np.cos(alpha1 - alpha2) == pytest.approx(other_side, abs=0.03), "on the fold, to the last step"


def test_a_place_without_a_value_is_no_answer() -> None:
    mu = _both(phase_grid(16)).reshape(16, 16, 2)
    assert {bend.kind for bend in bends(mu, lambda at: np.full((len(at), 2), np.nan))} == {"no answer"}


def _short(name: str) -> Scene:
    return load_scene(name).with_values({"duration": 1.5})


@pytest.mark.parametrize(("name", "share"), [("fig3-I", 4), ("fig3-II", 2), ("fig4-viscous", 2)])
def test_a_surface_from_its_symmetry_is_the_one_solved_in_full(name: str, share: int) -> None:
    """To 1e-6 of mu, the accuracy asked for, with a grid whose half is odd."""
    asked = []

    def solve(scene: Scene, phases: Array) -> Amplification:
        asked.append(len(phases))
        return amplification(scene, phases, equations="small", tolerance=1e-6)

    mu, _, statuses = surface(_short(name), 6, solve)
    assert asked == [36 // share]
    assert statuses == ["ok"]
    full = solve(_short(name), phase_grid(6)).mu.reshape(6, 6, 2)
    np.testing.assert_allclose(mu, full, rtol=2e-6)


def test_what_is_not_symmetric_is_solved_in_full() -> None:
    scene = load_scene("fig3-I")
    table = scene.model_dump(exclude_none=True)

    def with_rows(*rows: list[float]) -> Scene:
        return Scene.model_validate({**table, "excitation": {**table["excitation"], "amplitudes": [*rows]}})

    assert own_axes(with_rows([0.0, 1.0], [1.0, 0.0])), "each along its own axis, the other way round"
    assert not own_axes(with_rows([1.0, 1.0], [0.0, 0.0])), "both along one axis"
    assert not own_axes(with_rows([1.0, 0.0], [0.5, 1.0]))
    assert not half_turn(with_rows([1.0, 0.0], [0.0, 1.0], [0.1, 0.0])), "with vertical loading nothing is symmetric"
    asked = []

    def solve(scene: Scene, phases: Array) -> Amplification:
        asked.append(phases)
        mu = phases.copy()
        return Amplification(mu, mu, np.full(len(mu), "ok"), np.full(len(mu), np.nan), 0.0)

    for scene, grid in ((load_scene("fig3-I"), 5), (with_rows([1.0, 0.0], [0.0, 1.0], [0.1, 0.0]), 4)):
        mu, _, _ = surface(scene, grid, solve)
        np.testing.assert_array_equal(asked[-1], phase_grid(grid))
        np.testing.assert_array_equal(mu.reshape(-1, 2), phase_grid(grid))
