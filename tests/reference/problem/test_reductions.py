"""What a scene does not require, decided from the scene alone, and why."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from chains import chain

import reference
from reference.problem import Scene, load_scene
from reference.problem.reductions import (
    Reduction,
    body_cannot_tilt,
    bound_fastest_rate,
    find_unused_harmonics,
    has_half_turn_symmetry,
    has_no_friction_law,
    has_one_axis_per_harmonic,
    has_planar_chain,
    is_linear,
    is_mirror_symmetric,
    is_planar,
    turn_loading_to_x,
)
from reference.problem.symmetry import complete_surface

FIG3 = load_scene("fig3-I")
ALONE = {"bodies": [{"mass": 1.0, "height": 0.0, "size": [2.0, 2.0, 0.2]}], "isolator.ring": 0.12}
SMOOTH = {"isolator.friction": 0.0}
OIL = {"isolator.friction": None, "isolator.lubrication": 0.1}
UPRIGHT = {"excitation.amplitudes": [[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]}
UPRIGHT_ONCE = {"excitation.amplitudes": [[1.0, 0.0], [0.4, 0.0], [0.0, 0.5]]}
OBLIQUE = {"excitation.amplitudes": [[1.0, 0.5], [-0.8, -0.4]]}
ALIKE = {**OBLIQUE, "bodies.1.period": [1.5, 1.5]}
ALONG_X = {"excitation.amplitudes": [[1.0, 0.5], [0.0, 0.0]]}
TWICE_SHAKEN = {"excitation.amplitudes": [[1.0, 0.0], [0.0, 1.0 + 1e-9]]}


def law(**table: object) -> dict[str, Any]:
    return {"isolator.friction": {"slow": 0.1, **table}}


def places(*supports: list[float]) -> dict[str, Any]:
    return {"isolator.ring": None, "isolator.supports": list(supports)}


def upon(upper: dict[str, Any]) -> dict[str, Any]:
    """A third body on two that stand alike along x and y."""
    bodies = [
        {"mass": 1.0},
        {"mass": 0.8, "period": [1.5, 1.5], "damping": 0.1},
        {"mass": 0.5, "period": [1.5, 1.5], **upper},
    ]
    return {**OBLIQUE, "bodies": bodies}


# values of fig3-I by key, whether something may be left out, and how the reason begins
DECIDED: list[tuple[Callable[[Scene], Reduction], dict[str, Any], bool, str]] = [
    (body_cannot_tilt, {}, False, "bodies above the platform"),
    (body_cannot_tilt, {"isolator.ring": None, "isolator.supports": None}, False, "no supports are stated"),
    (body_cannot_tilt, ALONE, True, "one body, its center level with the depressions"),
    (
        body_cannot_tilt,
        {**ALONE, "bodies.0.offset": [0.01, 0.0]},
        False,
        "supports or centers of mass at stated places",
    ),
    (body_cannot_tilt, {**ALONE, "isolator.period": None, "isolator.radius": math.inf}, False, "a flat slider"),
    (body_cannot_tilt, {**ALONE, "bodies.0.size": None}, False, "a body above the depressions"),
    (body_cannot_tilt, {**ALONE, "isolator.sphere_radius": None}, False, "no supports are stated"),
    (body_cannot_tilt, {**ALONE, "bodies.0.height": 0.1}, False, "a body above the depressions"),
    (body_cannot_tilt, {**ALONE, "isolator.support_stiffness": 1e4}, False, "supports that give way"),
    (body_cannot_tilt, {**ALONE, **OIL}, False, "lubricated"),
    (body_cannot_tilt, {**ALONE, **law(load_exponent=0.1)}, False, "friction that depends on the load"),
    # twice the friction, 2 mu (rho + r), within the square of four supports: 0.0844 m is the least ring
    (body_cannot_tilt, {**ALONE, "isolator.ring": 0.085}, True, "one body"),
    (body_cannot_tilt, {**ALONE, "isolator.ring": 0.084}, False, "a narrow ring"),
    (body_cannot_tilt, {**ALONE, **law(fast=0.4, rate=10.0)}, False, "a narrow ring"),
    (
        body_cannot_tilt,
        {**ALONE, "isolator.friction": {"slow": 0.4, "fast": 0.1, "rate": 10.0}},
        False,
        "a narrow ring",
    ),
    (is_mirror_symmetric, {}, True, "an even number of supports on a ring"),
    (is_mirror_symmetric, {"isolator.supports": 3}, False, "an odd number of supports"),
    (is_mirror_symmetric, {"isolator.ring": None, "isolator.supports": None}, False, "an odd number of supports"),
    (is_mirror_symmetric, {"bodies.1.offset": [0.0, 0.1]}, False, "a center of mass off the axis"),
    (is_mirror_symmetric, {"bodies.1.yaw": 0.1}, False, "a body or link at an angle"),
    (
        is_mirror_symmetric,
        places([1.0, 2.0], [1.0, -2.0], [-1.0, 2.0], [-1.0, -2.0]),
        True,
        "positions of supports that",
    ),
    (
        is_mirror_symmetric,
        places([1.0, 1.0], [1.0, -1.0], [-1.0, 0.0]),
        False,
        "supports at positions that are no mirror",
    ),
    (
        is_mirror_symmetric,
        places([1.0, 1.0], [-1.0, 1.0], [0.0, -1.0]),
        False,
        "supports at positions that are no mirror",
    ),
    (is_planar, {}, False, "the harmonics act in different directions"),
    (is_planar, ALONG_X, True, "loading along one axis"),
    (is_planar, ALIKE, True, "(4.7): one direction of loading"),
    (
        is_planar,
        {**ALIKE, "excitation.amplitudes.1.1": -0.4 - 1e-9},
        False,
        "the harmonics act in different directions",
    ),
    (is_planar, upon({"period": [1.5, 1.5 + 1e-9]}), False, "loading across links that are not equally stiff"),
    (is_planar, {**ALIKE, "bodies.1.damping": 0.1}, True, "(4.7): one direction of loading"),
    (is_planar, upon({"damping": [0.1, 0.2]}), False, "loading across links that are not equally damped"),
    (has_planar_chain, {**ALONG_X, "bodies": [{"mass": 1.0}]}, False, "one body"),
    (is_linear, SMOOTH, True, "no friction, no vertical loading"),
    (is_linear, {}, False, "dry friction"),
    (is_linear, law(fast=0.0, rate=10.0), False, "dry friction"),
    (is_linear, {**SMOOTH, "bodies.1.damping": 0.1}, False, "damped links"),
    (is_linear, {**SMOOTH, **UPRIGHT}, False, "vertical loading"),
    (is_linear, {**SMOOTH, **UPRIGHT_ONCE}, False, "vertical loading"),
    (is_linear, {**SMOOTH, "bodies.1.period": [1e-3, 1.2]}, True, "no friction, no vertical loading"),
    (is_linear, {**SMOOTH, "bodies.1.period": [5e-4, 1.2]}, False, "more than 200000 rad of the fastest vibration"),
    (has_half_turn_symmetry, UPRIGHT, False, "vertical loading"),
    (has_half_turn_symmetry, UPRIGHT_ONCE, False, "vertical loading"),
    (has_half_turn_symmetry, {}, True, "no vertical loading"),
    (has_one_axis_per_harmonic, UPRIGHT, False, "vertical loading"),
    (has_one_axis_per_harmonic, UPRIGHT_ONCE, False, "vertical loading"),
    (has_one_axis_per_harmonic, TWICE_SHAKEN, True, "each harmonic has its own axis"),
    (has_one_axis_per_harmonic, {"excitation.amplitudes": [[1.0, 0.0], [0.4, 0.0]]}, False, "a harmonic acts"),
    (has_one_axis_per_harmonic, ALONG_X, False, "a harmonic acts along both axes, or both along one"),
    (has_no_friction_law, SMOOTH, True, "no friction"),
    (has_no_friction_law, law(fast=0.0, rate=10.0), False, "friction"),
]


@pytest.mark.parametrize(("decide", "values", "allowed", "reason"), DECIDED)
def test_a_scene_says_what_may_be_left_out_and_why(
    decide: Callable[[Scene], Reduction], values: dict[str, Any], allowed: bool, reason: str
) -> None:
    decision = decide(FIG3.with_values(values))
    assert bool(decision) == allowed
    assert decision.reason.startswith(reason)


def test_a_bound_on_all_rates_and_the_direction_of_a_harmonic_alone() -> None:
    """The fastest is the loading, its decay, or the link of a light body above along y."""
    for periods, decay, stiff in (((1, 1e-3), (0, 0), 9.0), ((1, 1), (80, 0), 9.0), ((2, 3), (0, 0), 1e6)):
        scene = chain(0.25, 0.0, [3.0, 2.0, 0.1], [[8.0, 9.0], [7.0, stiff]], periods=periods, decay=decay)
        load, natural = reference.problem.exponents(scene), reference.natural_modes.modes(scene).frequency.max()
        fastest = max(natural, load.imag.max(), -load.real.min())
        assert fastest <= bound_fastest_rate(scene) < 1.5 * fastest
    oblique = FIG3.with_values({"excitation.amplitudes": [[0.0, 0.3], [0.0, -0.4]]})
    assert np.allclose(turn_loading_to_x(oblique).amplitudes, [[0.0, 0.5], [0.0, 0.0], [0.0, 0.0]])


def test_a_record_has_no_harmonics_to_leave_out() -> None:
    """Reductions decide by amplitudes; a record taken for loading without any would be solved as if at rest."""
    scene = load_scene("synthetic-pair").with_values(SMOOTH)
    for reduction in (has_half_turn_symmetry, has_one_axis_per_harmonic, is_planar, is_linear):
        assert reduction(scene) == Reduction(False, "a recorded motion: no harmonics, no phases")
    for asked in (lambda: scene.amplitudes, lambda: reference.problem.exponents(scene)):
        with pytest.raises(ValueError, match="recorded motion"):
            asked()
    assert find_unused_harmonics(FIG3.with_values({"excitation.amplitudes": [[1.0, 0.0], [0.4, 0.0]]})) == [1]
    assert find_unused_harmonics(FIG3.with_values(UPRIGHT_ONCE)) == [], "it acts, vertically alone"


@pytest.mark.parametrize(
    ("amplitudes", "solved"),
    [
        ([[1.0, 0.0], [0.0, 1.4]], 4),
        ([[1.0, 0.7], [-0.3, 1.2]], 8),
        ([[1.0, 0.0], [0.4, 0.0]], 2),
        ([[0.0, 1.0], [0.0, 0.4]], 2),
        ([[1.0, 0.7], [-0.3, 1.2], [0.5, 0.2]], 16),
    ],
)
def test_a_surface_follows_from_as_few_pairs_as_symmetries_leave(amplitudes: list[list[float]], solved: int) -> None:
    scene = chain(masses=[1.0, 1.0], stiffness=[[20.0, 30.0]], amplitudes=amplitudes, damping=0.03, duration=3.0)
    asked: list[int] = []

    def solve(scene: Scene, phases: np.ndarray) -> reference.Amplification:
        asked.append(len(phases))
        return reference.amplification(scene, phases, full=True)

    mu, error, statuses = complete_surface(scene, 4, solve)
    whole = reference.amplification(scene, reference.phase_grid(4), full=True)
    assert (asked, statuses) == ([solved], ["ok"])
    np.testing.assert_allclose(mu.reshape(16, 2), whole.mu, rtol=2e-6)
    assert error.shape == mu.shape == (4, 4, 2)
    assert len(np.unique(whole.mu[:, 1].round(5))) == solved, "no fewer would do"
