"""The largest value over all phases: surfaces with a known maximum, and fine grids of the equations."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from chains import refusal
from numpy.typing import NDArray

import reference
from reference import phase_maximum
from reference.measures import local_search
from reference.measures.local_maxima import find_local_maxima
from reference.measures.local_search import ComputedPhases, LocalSearch
from reference.problem import Amplification, Scene, builtin_scenes, phase_grid
from reference.problem.readings import describe_law
from reference.problem.symmetry import find_half_turns

Array = NDArray[np.float64]
Surface = Callable[[Array], Array]

TOP = np.array([1.234, 4.321])  # of a smooth hill, rad
asked: list[dict[str, object]] = []  # options of the equations
EDGE = np.array([0.9, 4.6])  # on a line of slope -1/2 beside it, rad


def hill(phases: Array) -> Array:
    value: Array = 2.0 + np.cos(phases - TOP).sum(axis=1)
    return value


def across(phases: Array) -> Array:
    """Zero on the line through EDGE, in [-pi, pi)."""
    line: Array = np.remainder((phases - EDGE) @ [1.0, 2.0] + np.pi, 2.0 * np.pi) - np.pi
    return line


def level(phases: Array) -> Array:
    return np.ones(len(phases))


def scene_with(
    monkeypatch: pytest.MonkeyPatch, numerator: Surface, denominator: Surface = level, error: float = 1e-12
) -> Scene:
    """A scene without symmetries whose mu_1 is the quotient of two functions of the phases (M, 2), rad."""
    asked.clear()

    def amplification(scene: Scene, phases: Array, **options: object) -> Amplification:
        asked.append(options)
        mu = (numerator(phases) / denominator(phases))[:, None]
        ok, never = np.full(len(phases), "ok"), np.full(len(phases), np.nan)
        return Amplification(mu, np.full_like(mu, error), ok, never, 0.0)

    monkeypatch.setattr(phase_maximum, "amplification", amplification)
    monkeypatch.setattr(local_search, "ground_peak", lambda scene, phases: denominator(phases))
    amplitudes = [[1.0, 0.5], [0.3, 1.0], [0.1, 0.1]]
    scene = reference.load_scene("fig3-I").with_values({"excitation.amplitudes": amplitudes})
    assert len(find_half_turns(scene)) == 1
    return scene


def test_a_maximum_in_a_rougher_place_is_climbed_first(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of two maxima the lower one stands higher above its neighbors, so that there may be more beside it."""
    surface = np.full((8, 8), 0.5)
    surface[:3, 1:4] = 1.1
    surface[1, 2], surface[5, 3], surface[0, 1] = 1.2, 1.15, np.nan  # which is no fall
    starts = find_local_maxima(surface, scene_with(monkeypatch, level))
    assert starts[:2].tolist() == (phase_grid(8)[[5 * 8 + 3, 1 * 8 + 2]]).tolist()


def test_neighbors_of_equal_height_are_maxima(monkeypatch: pytest.MonkeyPatch) -> None:
    """A surface that one phase does not change has a ridge."""
    scene = scene_with(monkeypatch, level)
    ridge = np.tile(np.cos(2.0 * np.pi * np.arange(8) / 8)[:, None], 8)
    assert {start[0] for start in find_local_maxima(ridge, scene).tolist()} == {0.0}


def test_of_the_values_of_several_searches_each_has_its_own() -> None:
    columns = {name: np.arange(5.0) + 10.0 * k for k, name in enumerate(("numerator", "denominator", "error"), 1)}
    part = ComputedPhases(phases=np.arange(10.0).reshape(5, 2), **columns).select(slice(2, 4))
    assert part.phases.tolist() == [[4.0, 5.0], [6.0, 7.0]]
    assert [getattr(part, name).tolist() for name in columns] == [[12.0, 13.0], [22.0, 23.0], [32.0, 33.0]]


def beside_a_gap(phases: Array) -> Array:
    return np.where(np.cos(phases - TOP - 2.0).sum(axis=1) > 1.0, np.nan, hill(phases))


def on_the_edge(way: Array) -> Array:
    return hill(EDGE + np.stack([2.0 * way, -way], axis=-1))


WAYS = np.linspace(-np.pi, np.pi, 2001)
HIGHEST_ON_THE_EDGE = float(on_the_edge(WAYS[on_the_edge(WAYS).argmax()] + WAYS / 1000.0).max())


@pytest.mark.parametrize(
    ("numerator", "denominator", "kind", "value"),
    [
        (hill, level, "smooth", 4.0),
        (beside_a_gap, level, "smooth", 4.0),
        (hill, lambda phases: 1.0 + 3.0 * abs(across(phases)), "kink", HIGHEST_ON_THE_EDGE),
        (lambda phases: hill(phases) - (across(phases) < 0.0), level, "jump", HIGHEST_ON_THE_EDGE),
    ],
    ids=["smooth", "points without an answer", "oblique edge", "oblique jump"],
)
def test_a_known_maximum_is_found_to_its_error(
    monkeypatch: pytest.MonkeyPatch, numerator: Surface, denominator: Surface, kind: str, value: float
) -> None:
    worst = reference.worst_phases(scene_with(monkeypatch, numerator, denominator))
    assert worst.kind == kind
    assert abs(worst.value - value) <= worst.error
    if kind == "smooth":
        assert np.allclose(worst.phases, TOP, atol=1e-5)
    else:
        assert abs(across(np.array([worst.phases]))[0]) < 1e-6
    assert (kind == "jump") == (np.dot(worst.side, [1.0, 2.0]) > 0.0)
    assert 0.01 <= reference.worst_phases(scene_with(monkeypatch, numerator, denominator, 0.01)).error < 0.03


def test_a_lower_maximum_is_the_runner_up_and_every_pair_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    """Hills of 4, 3.5 and 3.2; searches begin at each, and two of them at the highest."""
    tops = [TOP, TOP + 2.0, TOP - 2.0]

    def hills(phases: Array) -> Array:
        heights = [top * np.exp(-6.0 * (1.0 - np.cos(phases - at)).sum(axis=1)) for top, at in zip((4, 3.5, 3.2), tops)]
        return np.max(heights, axis=0)

    computed: list[Array] = []
    scene = scene_with(monkeypatch, lambda phases: computed.append(phases) or hills(phases))
    worst = reference.worst_phases(scene, starts=[*[top + 0.1 for top in tops], TOP - 0.2])
    assert (worst.value, worst.runner_up) == (pytest.approx(4.0, abs=1e-6), pytest.approx(3.5, abs=1e-2))
    assert (worst.climbs, worst.reached, worst.evaluations) == (4, 2, sum(map(len, computed)))
    first = computed[1][: len(computed[1]) // 4]
    assert np.ptp(first, axis=0) == pytest.approx(4.0 * np.pi / phase_maximum.GRID), "two steps of the grid"
    seam = scene_with(monkeypatch, lambda phases: hills(phases + TOP - [0.01, 0.0]))
    again = reference.worst_phases(seam, starts=[[0.1, 0.1], [6.2, 6.2], [3.0, 3.0]])
    assert (again.climbs, again.reached) == (3, 2), "across the ends of the phases"
    shifted = scene_with(monkeypatch, lambda phases: hills(phases - np.pi))
    law = {"equations": "small", "regularization": None, "cutoff": 1e-3}
    told = reference.worst_phases(shifted, tolerance=1e-7, **law)
    assert all(0.0 <= phase < 2.0 * np.pi for phase in told.phases)
    assert told.law == describe_law(shifted, None, 1e-3) != describe_law(shifted, None)
    assert asked[0] == law | {"tolerance": 1e-4}, "the grid"
    assert asked[-1] == law | {"tolerance": 1e-7}


def test_searches_merge_move_and_end_by_their_rules(monkeypatch: pytest.MonkeyPatch) -> None:
    wide, high = LocalSearch(TOP + 0.02, 1.0, 0.0, 0.03, count=2), LocalSearch(TOP, 2.0, 0.0, 0.001, count=3)
    [kept] = local_search.merge_searches([wide, high], np.zeros((1, 2)))
    assert (kept, kept.count) == (high, 5), "in the square of either"
    kept.history = [(0.1, 1.0), (0.02, 1.7), (0.002, 1.9), *[(0.002, 2.0)] * 5]
    assert kept.recent_gain == pytest.approx(0.3), "since it was ten times as wide"
    kept.half_width, kept.value_range = 0.1, 9.0
    assert [kept.may_reach(2.0 + far) for far in (2.9, 3.1)] == [True, False], "ten times what six rounds gained"
    points = ComputedPhases(np.stack([TOP, TOP + 1.0]), np.array([1.0, 3.0]), np.ones(2), np.array([0.1, 0.2]))
    kept.move_to_best(points)
    assert (kept.phases.tolist(), kept.value, kept.error) == ((TOP + 1.0).tolist(), 3.0, 0.2)
    spike = scene_with(monkeypatch, lambda phases: np.where((phases == TOP).all(axis=1), 2.0, 1.0))
    surface, top = local_search.Surface(spike, phase_maximum.amplification, {}, 0), LocalSearch(TOP, 2.0, 0.0, 0.1)
    assert local_search.classify_maximum(surface, top)[0] == "kink", "no side of it is high"
    square = surface.compute(TOP + 0.1 * local_search.make_square_nodes(3)[0])
    square.numerator[:] = [1.5, *[1.0] * 7, np.nan]  # which is taken for the lowest
    assert (local_search.predict_best(surface, top, square)[0] > TOP).all()
    flat = scene_with(monkeypatch, lambda phases: np.full(len(phases), 1.0 if len(phases) > 1 else 0.5))
    missed = LocalSearch(TOP, 1.0, 0.1, 0.1)
    local_search.advance_searches(local_search.Surface(flat, phase_maximum.amplification, {}, 0), [missed])
    assert missed.half_width > 0.0, "the values are alike, and the prediction failed"
    ones, statuses = np.ones((3, 1)), np.array(["rim reached", "contact lost", "ok"])
    surface.amplification = lambda *given, **options: Amplification(ones, ones, statuses, np.zeros(3), 0.0)
    surface.compute(np.zeros((3, 2)))
    assert surface.outcome == "contact lost", "the last that was not ok"


def test_a_search_narrows_only_where_its_best_pair_moved_little_along_both_phases(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    surface = local_search.Surface(scene_with(monkeypatch, hill), phase_maximum.amplification, {}, 0)
    for away, narrows in (([1.0, 0.0], False), ([0.0, 1.0], False), ([0.01, 0.01], True)):
        search = LocalSearch(TOP + away, 1.0, 0.0, 0.2)
        local_search.advance_searches(surface, [search])
        assert (search.half_width < 0.2) == narrows
        assert search.half_width > 0.0


def test_a_search_starts_where_the_motion_has_a_result(monkeypatch: pytest.MonkeyPatch) -> None:
    lost = scene_with(monkeypatch, lambda phases: np.where(phases[:, 0] < 1.0, np.nan, 2.0))
    surface = local_search.Surface(lost, phase_maximum.amplification, {}, 0)
    searches = phase_maximum._start_searches(surface, np.array([[0.5, 0.1], [1.5, 0.2], [2.5, 0.3], [0.7, 0.4]]))
    assert [each.phases.tolist() for each in searches] == [[1.5, 0.2], [2.5, 0.3]]
    assert [each.value for each in searches] == [2.0, 2.0]


def test_a_wrong_argument_and_a_record_are_refused_in_one_line() -> None:
    for name, value, said in (
        ("body", 0, "body = 0: must be an integer from 1 to 2"),
        ("body", 3, "body = 3: must be an integer from 1 to 2"),
        ("quantity", "drift", "quantity = 'drift': must be one of amplification, displacement"),
        ("tolerance", 0.0, "tolerance = 0.0: must be"),
    ):
        assert str(refusal(reference.worst_phases, reference.load_scene("fig3-I"), **{name: value})).startswith(said)
    assert "no phases" in str(refusal(reference.worst_phases, reference.load_scene("synthetic-pair")))


@pytest.mark.parametrize(
    ("name", "law", "points"),
    [
        ("fig3-I", {}, 24),
        pytest.param("fig3-I", {"cutoff": 1e-3}, 512, marks=pytest.mark.long),
        *(pytest.param(name, {}, 512, marks=pytest.mark.long) for name in builtin_scenes()),
    ],
)
def test_no_point_of_a_surface_exceeds_the_maximum(name: str, law: dict[str, Any], points: int) -> None:
    scene, phases = reference.load_scene(name), phase_grid(points)
    # a half turn gives the other half
    surface = reference.amplification(scene, phases[phases[:, 0] < np.pi], tolerance=1e-5, **law)
    mu, displacement = np.nanmax(surface.mu - surface.error, axis=0), np.nanmax(surface.cap_share) * scene.radius
    for body in (1, 2) if points > 24 else (1,):
        worst = reference.worst_phases(scene, body, **law)
        assert mu[body - 1] <= worst.value + worst.error < mu[body - 1] + 0.1
    far = reference.worst_phases(scene, quantity="displacement", **law)
    assert displacement <= far.value + far.error < 1.02 * displacement
    assert far.error >= 1e-3 * far.value, "a surface knows displacements to a thousandth"


def test_the_largest_mu_2_stands_on_a_kink() -> None:
    worst = reference.worst_phases(reference.load_scene("fig3-I"), body=2)
    assert worst.kind == "kink"
    assert worst.value == pytest.approx(3.0663, abs=1e-4)
