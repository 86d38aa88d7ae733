"""How far the assumptions hold: variations, worst directions, blind trials, ranges, and what is said of them."""

import math
import re
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from fake_models import fake_hierarchy
from known_analyses import collected
from places import scene_text
from rich.console import Console

from comparison.analyses.assumptions import command, statements, trials, validity
from comparison.analyses.assumptions.feature import assumption_panels, section_context
from comparison.analyses.assumptions.statements import (
    NO_EFFECT,
    STATED,
    assumption_lines,
    describe_change,
    describe_direction,
    describe_range,
    describe_variation,
    describe_verdict,
    largest_change,
    range_cell,
)
from comparison.analyses.assumptions.trials import DirectionTrial, next_size
from comparison.analyses.assumptions.validity import AssumptionCell, Assumptions, Validity
from comparison.analyses.assumptions.variations import (
    DIRECTED,
    FEW,
    ONE_PLANE,
    TURNED_LINK,
    UNDER_LOAD,
    Axis,
    Variation,
    blind_by_symmetry,
    plane_of_symmetry,
    trials_of,
)
from comparison.study.models import MODEL_HIERARCHY
from comparison.study.study import Study
from multibody import amplification
from reference.problem import Scene, load_scene
from reference.problem.readings import AS_INTEGRATED

FIRST, PLANAR = load_scene("fig3-I"), load_scene("fig4-dry")
SQUARE = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])


def cell(variation: Variation, first: float, second: float = 0.0, uncertainty: float = 0.0, **more: Any):
    """mu_1 changes by `first` and `second` at two phase pairs, mu_2 not at all."""
    estimate = ((uncertainty, 0.0),) * 2
    return AssumptionCell("fig3-I", variation, ((first, 0.0), (second, 0.0)), estimate, ("ok", "ok"), **more)


def found_of(
    cells: list[AssumptionCell], directions: list[DirectionTrial] | None = None, scene: Scene = FIRST
) -> Validity:
    directions = directions or []
    ranges = tuple(validity.find_validity_ranges(scene, cells, directions))
    phases, as_integrated = validity.PHASES, AS_INTEGRATED
    return Validity(validity.ASSUMPTIONS, as_integrated, phases, 6.0, tuple(cells), tuple(directions), ranges)


def test_a_variation_changes_what_it_names_alone() -> None:
    changed = Variation(ring=2.0, height=0.5, supports=3).of(FIRST)
    assert (changed.isolator.ring, changed.isolator.supports) == (2.0, 3)
    assert [body.height for body in changed.bodies] == [0.1, 0.6]
    back = Variation(ring=0.5, height=2.0, supports=4).of(changed)
    assert back.with_values({"name": FIRST.name}) == FIRST
    uneven = Variation(offset=0.1, direction=math.pi / 2.0, yaw=0.2).of(FIRST)
    assert uneven.offsets.ravel().tolist() == pytest.approx([0.0, 0.0, 0.0, 0.1])
    assert uneven.yaws.tolist() == [0.0, 0.2]
    twice = Variation(offset=0.2, direction=math.pi, yaw=0.5).of(uneven)
    assert [*twice.offsets[1], twice.yaws[1]] == pytest.approx([-0.2, 0.1, 0.7]), "added to what the scene states"
    even = {"bodies.1.offset": None, "bodies.1.yaw": None, "name": FIRST.name}
    assert uneven.with_values(even) == FIRST
    placed = FIRST.with_values({"isolator.supports": (2.0 * SQUARE).tolist(), "isolator.ring": None})
    assert Variation(ring=0.5).of(placed).support_places.tolist() == SQUARE.tolist(), "by the same factor"
    three = Variation(supports=3, offset=0.1).of(placed)
    assert (three.isolator.supports, three.isolator.ring) == (3, pytest.approx(np.sqrt(8.0)))
    assert three.offsets[1].tolist() == pytest.approx([0.1 * np.sqrt(8.0), 0.0]), "over the radius of the ring"


def test_an_oval_is_narrowed_along_its_direction_alone() -> None:
    oval = Variation(ring=2.0, oval=0.25, direction=math.pi / 2.0).of(FIRST)
    np.testing.assert_allclose(oval.support_places, 2.0 * FIRST.support_places * [1.0, 0.75])


@pytest.mark.parametrize(
    ("scene", "variation", "reason"),
    [
        (PLANAR, Variation(ring=0.5), ONE_PLANE),
        (PLANAR, Variation(height=0.0), ONE_PLANE),
        (PLANAR, Variation(offset=0.1, direction=math.pi / 4.0), ONE_PLANE),
        (PLANAR, Variation(oval=0.5, direction=-math.pi / 4.0), ONE_PLANE),
        (PLANAR, Variation(yaw=0.2), TURNED_LINK),
        (PLANAR, Variation(offset=0.1, direction=-math.pi / 4.0), ""),
        (PLANAR, Variation(oval=0.5), ONE_PLANE),
        (PLANAR, Variation(supports=3), ONE_PLANE),
        (PLANAR, Variation(yaw=0.2, offset=0.1), ""),
        (PLANAR.with_values({"bodies.1.size": [2.0, 1.0, 0.2]}), Variation(yaw=0.2), ""),
        (PLANAR.with_values({"isolator.friction": {"slow": 0.1, "load_exponent": -0.2, "reference_load": 10.0}}),
         Variation(ring=0.5), ""),
        (PLANAR.with_values({"bodies.1.damping": [1.0, 2.0]}), Variation(ring=0.5), ""),
        (FIRST, Variation(yaw=0.2), ""),
        (FIRST, Variation(ring=0.5), ""),
        (FIRST.with_values({"excitation.amplitudes": [[1.0, 1.0], [0.0, 0.0]]}), Variation(offset=0.1), ONE_PLANE),
        (FIRST.with_values({"excitation.amplitudes": [[1.0, 1.0], [0.0, 0.0]]}), Variation(offset=0.1, direction=1.0),
         ""),
    ],
)  # fmt: skip
def test_a_trial_is_blind_where_the_scene_is_its_own_mirror_image(
    scene: Scene, variation: Variation, reason: str
) -> None:
    assert blind_by_symmetry(scene, variation) == reason


@pytest.mark.parametrize(
    ("variation", "telling"),
    [
        (Variation(offset=0.1, direction=math.pi / 4.0), False),
        (Variation(offset=0.1, direction=-math.pi / 4.0), True),
        (Variation(yaw=0.2), False),
        (Variation(oval=0.5), False),
        (Variation(supports=3), False),
    ],
)
def test_a_blind_trial_of_the_engine_has_no_effect(variation: Variation, telling: bool) -> None:
    """In the plane of Fig. 4 an offset changes nothing, across it mu_2 changes by more than 1 %."""
    short, spatial, pairs = PLANAR.with_values({"duration": 3.0}), MODEL_HIERARCHY[-1], [(2.0, 0.7)]
    stated, varied = (
        amplification(each, pairs, tolerance=2e-3, **{**spatial.settings, "regularization": 1e-2})
        for each in (short, variation.of(short))
    )
    change = np.abs(varied.mu / stated.mu - 1.0).max()
    assert change > 0.01 if telling else change < 1e-4


def test_directions_are_different_ones_of_the_scene() -> None:
    degrees = {
        (name, key): [round(math.degrees(each.direction), 1) for each in trials_of(load_scene(name), key)]
        for name in ("fig3-I", "fig3-II", "fig4-dry")
        for key in ("oval", "offset")
    }
    assert degrees["fig3-I", "offset"] == degrees["fig3-I", "oval"] == [0.0, 30.0, 60.0, 90.0]
    assert degrees["fig3-II", "offset"] == degrees["fig3-II", "oval"] == [0.0, 45.0, 90.0, 135.0]
    assert degrees["fig4-dry", "offset"] == degrees["fig4-dry", "oval"] == [45.0, 67.5, 90.0, 112.5, 135.0]
    lifted = FIRST.with_values({"excitation.amplitudes": [[1.0, 0.0], [0.0, 1.0], [0.5, 0.0]]})
    assert [round(math.degrees(each.direction)) for each in trials_of(lifted, "offset")] == [*range(0, 360, 45)]
    assert [each.yaw for each in trials_of(FIRST, "yaw")] == [0.2, -0.2, 0.1, -0.1]
    for name in ("fig3-I", "fig3-II", "fig4-dry"):
        scene = load_scene(name)
        for key in ("oval", "offset") if name != "fig4-dry" else ("offset",):
            assert sum(not blind_by_symmetry(scene, each) for each in trials_of(scene, key)) >= 4


def test_a_plane_is_that_of_the_loading() -> None:
    assert plane_of_symmetry(FIRST) is None
    assert plane_of_symmetry(PLANAR) == pytest.approx(math.pi / 4.0)
    turned = FIRST.with_values({"excitation.amplitudes": [[0.0, 0.0], [1.0, 1.0]]})
    assert plane_of_symmetry(turned) == pytest.approx(math.pi / 2.0), "stiffer links along y, the plane is theirs"
    assert plane_of_symmetry(PLANAR.with_values({"excitation.amplitudes": [[0.0, 0.0], [0.0, 0.0]]})) is None


def fake_trial(scene: Scene, model: Any, variation: Variation | None, *rest: Any, **settings: Any) -> trials.Trial:
    """mu_1 falls by the offset over the ring, most towards y; mu_2 by a tenth of it."""
    size = 0.0 if variation is None else variation.offset * (1.0 + math.sin(variation.direction))
    pairs = settings.get("phases", rest[-1] if rest else None)
    mu = np.array([[2.0 - 1.4 * size, 3.0 - 0.3 * size]] * len(pairs))
    return trials.Trial(variation, mu, 1e-6 * mu, ("ok",) * len(pairs), "", 0.5)


def test_the_worst_direction_is_followed_until_limits_are_close(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(trials, "amplification_of", fake_trial)
    engines = MODEL_HIERARCHY[-2], MODEL_HIERARCHY[-1]
    answer = trials.answer_trials((FIRST, engines, ("offset",), 2e-3, validity.PHASES, 20))
    assert [(each.worst, round(math.degrees(each.variation.direction))) for each in answer.directions] == [
        (False, 0), (False, 30), (False, 60), (True, 90),
    ]  # fmt: skip
    assert [each.variation.direction for each in answer.trials if each.variation] == pytest.approx(
        [math.pi / 2.0] * len(answer.trials)
    )
    cells = [validity._make_cell(FIRST, each, fake_trial(FIRST, None, None, validity.PHASES)) for each in answer.trials]
    cells.append(cell(Variation(), 0.0))
    by = {
        (r.body, r.share): r
        for r in validity.find_validity_ranges(FIRST, cells, answer.directions)
        if r.key == "offset"
    }
    first = by[1, 0.05]  # mu_1 falls by 1.4 times the offset
    assert first.holds <= 0.05 / 1.4 < first.fails <= trials.BISECTION_RATIO * first.holds
    assert first.direction == pytest.approx(math.pi / 2.0)
    assert by[2, 0.05].holds >= 0.1


def test_the_next_size_closes_in_on_a_limit() -> None:
    def sizes(*tried: tuple[float, float]) -> float | None:
        return next_size([(size, np.array([change])) for size, change in tried], 0.025, 0.4)

    assert sizes((0.1, 0.2)) == 0.05
    assert sizes((0.1, float("nan"))) == 0.05, "without a value nothing holds"
    assert sizes((0.1, 0.2), (0.05, 0.1), (0.025, 0.06)) is None, "smaller than the smallest is not tried"
    assert sizes((0.1, 0.03), (0.05, 0.005)) == pytest.approx(math.sqrt(0.005))
    assert sizes((0.1, 0.001)) == 0.2
    assert sizes((0.1, 0.001), (0.2, 0.002), (0.4, 0.003)) is None


def test_a_direction_without_a_value_is_the_worst(monkeypatch: pytest.MonkeyPatch) -> None:
    def lost(scene: Scene, model: Any, variation: Variation | None, *rest: Any, **settings: Any) -> trials.Trial:
        trial = fake_trial(scene, model, variation, *rest, **settings)
        nothing = variation is not None and variation.direction == 0.0
        return replace(trial, mu=trial.mu * (math.nan if nothing else 1.0))

    monkeypatch.setattr(trials, "amplification_of", lost)
    worst = [each.worst for each in trials.find_worst_directions(FIRST, MODEL_HIERARCHY[-1], ("offset",))]
    assert worst == [True, False, False, False]


RINGS = [cell(Variation(ring=ring), c, -c / 2.0) for ring, c in {4: 0.001, 2: 0.002, 1: 0.02, 0.5: 0.003}.items()]
HEIGHTS = [cell(Variation(height=h), 0.0, c) for h, c in {0: 0.0, 0.5: -0.004, 1: -0.03, 2: 0.002}.items()]
WIDE = cell(Variation(ring=2.0), 0.004)


@pytest.mark.parametrize(
    ("cells", "key", "share", "expected"),
    [
        (RINGS, "ring", 0.01, (2.0, 1.0)),  # 0.5 m would hold, but 1 m does not
        (RINGS, "ring", 0.05, (0.5, None)),
        (HEIGHTS, "height", 0.01, (0.5, 1.0)),
        (HEIGHTS, "height", 0.05, (2.0, None)),
        ([WIDE, cell(Variation(), 0.008, 0.0, 0.003)], "ring", 0.01, (2.0, 1.0)),  # its uncertainty counts against it
        ([WIDE, cell(Variation(), 0.008, 0.0, 0.001)], "ring", 0.01, (1.0, None)),
        ([WIDE, cell(Variation(), float("nan"), 0.0)], "ring", 0.01, (2.0, 1.0)),
        ([cell(Variation(ring=2.0), 0.2)], "ring", 0.01, (None, 2.0)),
        ([cell(Variation(), 0.0), cell(Variation(yaw=-0.2), 0.02)], "yaw", 0.01, (0.0, 0.2)),
    ],
)
def test_a_range_ends_at_the_first_value_that_fails(
    cells: list[AssumptionCell], key: Axis, share: float, expected: tuple[float | None, float | None]
) -> None:
    lines = validity.find_validity_ranges(FIRST, cells)
    [found] = [(each.holds, each.fails) for each in lines if (each.body, each.key, each.share) == (1, key, share)]
    assert found == expected
    both = replace(WIDE, change=((0.001, -0.03), (-0.004, 0.02)), uncertainty=((0.003, 0.001), (0.002, 0.005)))
    assert [(both.largest(body), both.error_estimate(body)) for body in (1, 2)] == [(0.004, 0.003), (0.03, 0.005)]


BLIND = DirectionTrial("fig3-I", "offset", Variation(offset=0.1), (), (), ONE_PLANE, False)


def test_a_blind_trial_is_no_evidence() -> None:
    """Planted: a blind trial counted as one that holds."""
    rings = [cell(Variation(ring=ring), 0.0, no_effect=ONE_PLANE) for ring in (0.5, 1.0, 2.0)]
    found = found_of(rings, [replace(BLIND, scene="other", no_effect=""), BLIND])
    assert {each.key for each in found.ranges} == {"ring", "offset", "height"}
    for each in found.ranges:
        assert (each.holds, each.fails, each.no_effect) == (None, None, ONE_PLANE)
        assert range_cell(each) == NO_EFFECT
        assert "stays within" not in describe_range(each)
        assert "which is no evidence" in describe_range(each)
    assert describe_direction(FIRST, BLIND).endswith(f": {NO_EFFECT}")
    assert largest_change(found, rings[1], 1).verdict == "not compared"
    assert describe_change(largest_change(found, rings[1], 1)) == f"mu_1: {NO_EFFECT}"
    assert " met" not in describe_verdict(found)
    assert describe_verdict(found).endswith(f"fig3-I not compared: {NO_EFFECT}.")
    assert assumption_panels(found, FIRST) == []
    for ring in (2.0, 0.2):
        partly = validity.find_validity_ranges(FIRST, [*rings[:2], cell(Variation(ring=ring), 0.003)])
        assert next((r.holds, r.fails, r.no_effect) for r in partly if r.key == "ring") == (ring, None, "")


def test_a_blind_trial_that_has_an_effect_is_not_called_blind() -> None:
    plain = trials.Trial(None, np.full((2, 2), 2.0), np.full((2, 2), 1e-4), ("ok",) * 2, "", 0.0)
    for size, reason in ((1.0, ONE_PLANE), (1.02, ""), (np.array([1.0, 1.02]), "")):
        control = trials.Trial(Variation(ring=0.5), plain.mu[:1] * size, plain.error[:1], ("ok",), "", 0.0)
        assert validity._make_cell(PLANAR, control, plain).no_effect == reason
        lost = replace(plain, error_message="lost")
        assert [validity._make_cell(PLANAR, *each).error_message for each in (
            (control, plain), (control, lost), (replace(control, error_message="failed"), lost)
        )] == ["", "lost", "failed"]  # fmt: skip


def test_a_change_says_reading_base_sign_error_and_place() -> None:
    """Planted: the other sign, the translational model as base, the smaller phase pair, the mean for the largest."""
    stated = cell(Variation(), -0.09, -0.04, 1e-3)
    moved = cell(Variation(offset=0.1, direction=math.pi), -0.181, -0.424, 3e-3)
    found = found_of([stated, moved])
    change = largest_change(found, moved, 1, stated)
    assert (change.size, change.phases, change.base) == (pytest.approx(0.576 / 0.96 - 1.0), (2.0, 0.7), STATED)
    assert change.error == pytest.approx(math.hypot(3e-3, 1e-3))
    text = "mu_1 (as integrated) changes by −40.0 ± 0.3 % against the stated spatial model, at (2, 0.7) rad"
    assert describe_change(change) == text.replace("−40.0 ± 0.3 %", statements.word_difference(-0.4, change.error))
    assert describe_change(replace(change, size=0.02, error=0.004)).startswith(
        "mu_1 (as integrated) changes by +2.0 ± 0.4"
    )
    assert "literal supremum" in describe_change(replace(change, reading="literal supremum"))
    assert largest_change(found, moved, 1).base == "the translational model"
    # one pair is computed where both are equal by symmetry
    once = replace(stated, change=stated.change[:1], uncertainty=stated.uncertainty[:1])
    assert largest_change(found, moved, 1, once).size == pytest.approx(0.576 / 0.91 - 1.0)
    assert describe_change(replace(change, size=math.nan)) == "mu_1: not compared, a phase pair has no value"
    [line] = assumption_lines(found, FIRST)
    assert line.startswith("bodies above the platform 0.1 m off the axis towards 180 degrees: mu_1 (as integrated)")


@pytest.mark.parametrize(
    ("size", "error", "reason", "verdict"),
    [
        (-0.005, 0.001, "", "met"),
        (-0.0095, 0.001, "", "not met (by 0.05 %)"),  # its error counts against it
        (-0.09, 0.0, "", "not met (by 8 %)"),
        (0.09, 0.0, "", "not met (by 8 %)"),
        (0.0, 0.0, ONE_PLANE, "not compared"),
        (math.nan, 0.0, "", "not compared"),
        (0.001, math.nan, "", "not compared"),
        (12.0, 38.0, "", "not compared"),  # Planted: +1200 ± 3800 % is "not met"
        (-0.5, 0.02, "", "not met (by 51 %)"),  # a large error that leaves no doubt
    ],
)
def test_a_verdict_has_three_words(size: float, error: float, reason: str, verdict: str) -> None:
    change = statements.Change("s", 1, size, error, (0.0, 0.0), "as integrated", STATED, reason)
    assert change.verdict == verdict


def test_rings_and_offsets_are_told_in_meters_and_other_sizes_as_shares() -> None:
    wide = FIRST.with_values({"isolator.ring": 2.5, "name": FIRST.name})
    changes = {"ring": Variation(ring=2.0), "offset": Variation(offset=0.1), "oval": Variation(oval=0.5)}
    cells = [cell(Variation(), 0.001), *(cell(variation, 0.2, uncertainty=0.01) for variation in changes.values())]
    ranges = validity.find_validity_ranges(wide, cells)
    found = {each.key: each.fails for each in ranges if (each.body, each.share) == (1, 0.01)}
    assert {key: found[key] for key in changes} == {"ring": 5.0, "offset": 0.25, "oval": 0.5}
    lines = [panel["plot"]["series"][0] for panel in assumption_panels(found_of(cells, scene=wide), wide)]
    assert [line["x"] for line in lines] == [[2.5, 5.0], [1.0], [0.0, 0.5], [0.0, 0.25]]
    assert [lines[-1][side][-1] for side in ("low", "y", "high")] == pytest.approx([19.0, 20.0, 21.0])


def test_the_verdict_is_that_of_the_worst_body_of_every_scene() -> None:
    rows = ((0.001, -0.03), (0.002, 0.02))
    second = AssumptionCell("fig3-II", Variation(), rows, ((0.0, 1e-3),) * 2, ("ok",) * 2)
    found = found_of([cell(Variation(), 0.004), cell(Variation(ring=0.5), 0.9), second])
    assert describe_verdict(found) == (
        "Bodies that turn leave mu_i (as integrated) within 1 % of the translational model: fig3-I met: mu_1 +0.4 %; "
        "fig3-II not met (by 2.1 %): mu_2 −3.0 ± 0.1 %."
    )
    close = replace(second, change=((0.009, 0.0085),) * 2)  # the smaller one may be the larger
    assert "fig3-II met: mu_2 +0.9 ± 0.1 %" in describe_verdict(found_of([close]))
    assert describe_verdict(found_of([cell(Variation(), math.nan)])).endswith("fig3-I not compared: no value.")
    assert describe_verdict(found_of([])) == ""


def test_ranges_are_worded_with_direction_and_limit() -> None:
    """Planted: another direction or sense; a limit where all that was tried holds."""
    given = {"scene": "s", "body": 1, "share": 0.01}
    for key, holds, fails, direction, text, short in (
        ("offset", 0.05, 0.1, math.pi / 2.0,
         "with centers of mass moved by up to 0.05 m towards 90 degrees, no longer by 0.1 m", "≤ 0.05, not 0.1"),
        ("offset", 0.0, 0.025, 0.0, "with centers of mass as stated, no longer by 0.025 m", "≤ 0, not 0.025"),
        ("yaw", 0.1, None, -1.0, "with bodies and links turned by up to 0.1 rad clockwise, the largest tried",
         "≤ 0.1 (all tried)"),
        ("ring", 2.0, 1.0, None, "with rings from 2 m, no longer at 1 m", "≥ 2, not 1"),
    ):  # fmt: skip
        each = validity.ValidityRange(**given, key=key, holds=holds, fails=fails, direction=direction)  # type: ignore[arg-type]
        assert describe_range(each) == f"mu_1 stays within 1 % {text}"
        assert range_cell(each) == short
    for key, fails, direction, text, short in (
        ("oval", 0.5, math.pi, "with the ring narrowed by 0.5 of its radius along 180 degrees", "not 0.5"),
        ("oval", 0.0, 0.0, "with the ring as stated", "not 0"),
        ("height", 0.0, None, "at zero heights", "not 0"),
        ("height", 0.25, None, "with heights of 0.25 times the stated ones", "not 0.25"),
        ("ring", 8.0, None, "with a ring of 8 m, the largest tried", "not 8"),
        ("offset", 0.1, 0.0, "with centers of mass moved by 0.1 m towards 0 degrees", "not 0.1"),
        ("yaw", 0.1, 1.0, "with bodies and links turned by 0.1 rad counterclockwise", "not 0.1"),
    ):  # Planted: "at none tried" where the first size fails and a later one holds
        each = validity.ValidityRange(**given, key=key, holds=None, fails=fails, direction=direction)  # type: ignore[arg-type]
        assert (describe_range(each), range_cell(each)) == (f"mu_1 leaves 1 % already {text}", short)
    assert describe_variation(FIRST, Variation(yaw=-0.2)).endswith("their links turned by -0.2 rad")


def test_where_mu_has_no_value_nothing_is_said_to_fail() -> None:
    """Planted: a scene without any value "stays within 1 % at no ring tried"; NaN in the table."""
    nan = math.nan
    rings = [cell(Variation(ring=ring), change) for ring, change in ((2.0, 0.0), (1.0, nan), (0.5, 0.9))]
    others = [cell(Variation(height=0.0), nan), cell(Variation(yaw=0.1), 0.0), cell(Variation(yaw=0.2), nan)]
    found = found_of([*rings, *others])
    said = {(each.key, each.body): each for each in found.ranges if each.share == 0.01}
    assert describe_range(said["ring", 1]) == "mu_1 stays within 1 % with rings from 2 m, not known at 1 m"
    assert range_cell(said["ring", 1]) == "≥ 2, not known at 1"
    assert (
        describe_range(said["height", 1]) == "mu_1 over the heights: not compared, a phase pair has no value that tells"
    )
    assert range_cell(said["height", 1]) == "not compared"
    doubtful = validity.find_validity_ranges(
        FIRST, [cell(Variation(), 0.2, uncertainty=0.3), cell(Variation(ring=0.5), 1.0)]
    )
    assert describe_range(doubtful[0]).endswith("not compared, a phase pair has no value that tells")
    assert (said["ring", 2].fails, said["ring", 2].no_value) == (None, False), "mu_2 has values"
    turned = replace(said["yaw", 1], holds=0.1, fails=0.2, direction=1.0)
    assert describe_range(turned).endswith("by up to 0.1 rad counterclockwise, not known at 0.2 rad")
    lost = replace(BLIND, no_effect="", change=(nan, 0.2), uncertainty=(nan, nan))
    assert describe_direction(FIRST, lost).endswith(": mu_1 no value, mu_2 +20 %")
    lost = replace(lost, worst=True)
    assert describe_direction(FIRST, lost).endswith(": mu_1 no value, mu_2 +20 % (taken for the worst)")
    uneven = [cell(Variation(), 0.0), cell(lost.variation, nan)]
    [line] = statements.describe_uneven(found_of(uneven, [lost, replace(lost, worst=False, change=(0.1, 0.2))]), FIRST)
    assert ", taken for the worst of 2 directions: mu_1: not compared, " in line


def test_the_table_has_no_nan_and_every_digit_of_many_bodies(capsys: pytest.CaptureFixture[str]) -> None:
    """Planted: seven numbers in a cell cut the ring's radius, 0.5 m, to "0."."""
    rows = ((math.nan, *(0.125,) * 6),)
    wide = AssumptionCell("fig3-I", Variation(ring=0.5, height=0.25), rows, rows, ("ok", "contact lost"))
    bodies = [*FIRST.model_dump(exclude_none=True)["bodies"], *FIRST.model_dump(exclude_none=True)["bodies"][1:] * 5]
    tall = FIRST.with_values({"bodies": bodies, "name": "fig3-I"})
    command._print_assumptions(Console(width=120), tall, found_of([wide], scene=tall))
    printed = capsys.readouterr().out
    assert "nan" not in printed
    assert re.search(r"^ *0\.5 +0\.25 +4 +none  \+12\.500", printed, re.M)
    assert printed.count("+12.500") == 6


def test_a_variation_that_makes_no_scene_loses_its_own_trial_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """Planted: one offset beyond the supports takes all ovals, offsets and angles with it."""
    edge = FIRST.with_values({"bodies.1.offset": [1.39, 0.0], "name": "fig3-I"})  # 0.7 m off the axis by all bodies
    found = trials.amplification_of(edge, MODEL_HIERARCHY[-1], Variation(offset=0.1), 1e-3, np.array(validity.PHASES))
    assert (found.status, np.isnan(found.mu).all(), found.mu.shape) == (("refused",) * 2, True, (2, 2))
    assert "would carry nothing at rest" in found.error_message
    tall, engines = PLANAR.with_values({"bodies.1.height": 9e5}), (MODEL_HIERARCHY[-2], MODEL_HIERARCHY[-1])
    [high] = trials.answer_trials((tall, engines, Variation(height=2.0), 1e-3, validity.PHASES, 3)).trials
    assert high.status == ("refused",) * 2, "also where it is asked whether symmetry hides its effect"
    plain = trials.Trial(None, np.ones((2, 2)), np.zeros((2, 2)), ("ok",) * 2, "", 0.0)
    lost = validity._make_cell(edge, found, plain)
    [line] = [line for line in assumption_lines(found_of([lost], scene=edge), edge) if line.startswith("refused: ")]
    assert line.endswith(found.error_message)


def test_panels_show_signed_changes_with_errors_and_bands() -> None:
    cells = [cell(Variation(ring=ring), -0.02 / ring, 0.01, 1e-3) for ring in (1.0, 2.0)]
    (panel,) = (each for each in assumption_panels(found_of(cells), FIRST) if each["title"].startswith("radius"))
    first, second = panel["plot"]["series"]
    assert (first["x"], first["y"]) == ([1.0, 2.0], pytest.approx([-2.0, -1.0]))
    assert (first["low"], first["high"]) == (pytest.approx([-2.1, -1.1]), pytest.approx([-1.9, -0.9]))
    assert (first["name"], second["name"], second["y"]) == ("μ_1", "μ_2", [0.0, 0.0])
    assert [(band["from"], band["to"]) for band in panel["plot"]["bands"]] == [(-1.0, 1.0), (-5.0, 5.0)]
    assert panel["plot"]["y"]["title"] == "largest change of μ_i, %"


def test_a_section_tells_the_directions_of_its_scene_alone() -> None:
    other = FIRST.with_values({"name": "other", "title": "Other"})
    cells = [cell(Variation(ring=2.0), 0.1), replace(cell(Variation(ring=2.0), 0.2), scene="other")]
    trials = [
        replace(BLIND, variation=Variation(offset=size), scene=name)
        for size, name in ((0.1, "fig3-I"), (0.2, "other"), (0.3, "other"))
    ]
    found: Any = SimpleNamespace(assumptions=found_of(cells, trials))
    report: Any = SimpleNamespace(results=found, study=SimpleNamespace(scenes=(FIRST, other)))
    told = {each["name"]: each["directions"] for each in section_context(report)["assumption_scenes"]}
    assert told == {
        name: [describe_direction(scene, trial) for trial in trials if trial.scene == name]
        for name, scene in (("fig3-I", FIRST), ("other", other))
    }
    assert [len(lines) for lines in told.values()] == [1, 2]
    loaded = [replace(cell(what, 0.1), scene="other") for what in UNDER_LOAD]
    both, own = (statements.assumption_lines(found_of(each), FIRST) for each in ([*cells, *loaded], cells))
    assert both == own, "nor those on the bars of another"


def test_cells_compare_the_two_engine_models() -> None:
    keys = "isolator.supports", "isolator.ring", "isolator.sphere_radius"
    bare = FIRST.with_values({"name": "bare", "duration": 1.5, **dict.fromkeys(keys)})
    study = Study((FIRST, bare), 2, 1e-3, fake_hierarchy(gap=0.0))
    found = collected(Assumptions(), study)
    assert [each.variation for each in found.cells][: len(FEW)] == list(FEW)
    assert found.duration == 6.0, "of the longest scene"
    brief = Study((FIRST.with_values({"duration": 2.5}), bare), 2, 1e-3, fake_hierarchy())
    assert collected(Assumptions(FEW[:1], directed=()), brief).duration == 2.5
    assert {each.scene for each in found.directions} == {FIRST.name}, "whatever is shortened to compute them"
    assert {(each.key, each.worst) for each in found.directions} == {
        (key, worst) for key in DIRECTED for worst in (True, False)
    }
    for each in found.cells:
        assert (np.array(each.change) == 0.0).all(), "both fake models answer alike"
        assert np.array(each.change).shape == (len(validity.PHASES), 2)
        np.testing.assert_allclose(each.uncertainty, 2e-3 * np.sqrt(2.0))  # both claim a fifth of 1 %: enough to tell
    assert collected(Assumptions(), Study((bare,), 2, 1e-3, fake_hierarchy())) is None
    lost = collected(Assumptions(), replace(study, hierarchy=fake_hierarchy("always_raising")))
    assert len(lost.cells) == len(FEW) + len(DIRECTED)
    for each in lost.cells:
        assert np.isnan(each.change).all()
        assert each.error_message == "RuntimeError: the matrix is singular"
        assert not each.holds(1, 0.05)


def test_with_all_heights_zero_the_real_models_agree() -> None:
    study = Study((load_scene("fig3-II").with_values({"duration": 2.0}),), 1, 1e-3, MODEL_HIERARCHY)
    (only,) = collected(Assumptions([Variation(height=0.0)], directed=()), study).cells
    assert set(only.status) == {"ok"}
    assert only.no_effect == ""
    assert (np.abs(only.change) <= only.uncertainty).all()
    assert np.abs(only.change).max() > 0.0, "the model that turns has answered, not the one it is held against"


def test_bars_under_load_are_varied_only_where_they_give_way() -> None:
    bars = {"count": 4, "bending_stiffness": 0.8, "length": 1.0, "axial_stiffness": 2900.0, "spread": 0.8}
    for stiffness, expected in ((2900.0, UNDER_LOAD), (None, ())):
        bars["axial_stiffness"] = stiffness
        scene = FIRST.with_values({"bodies.1.period": None, "bodies.1.bars": bars})
        study = Study((scene,), 1, 1e-3, MODEL_HIERARCHY)
        asked = [what for _, _, what, *_ in Assumptions((), directed=()).task_arguments(study)]
        assert asked == [None, *expected]
        effects = [variation.of(scene).bodies[1].bars.load_effect for variation in expected]
        assert effects == ["softening", "shortening"][: len(expected)]


def test_one_link_of_bars_among_others_is_enough() -> None:
    bars = {"count": 4, "bending_stiffness": 0.8, "length": 1.0, "axial_stiffness": 2900.0, "spread": 0.8}
    third = {"mass": 0.7, "height": 2.3, "size": [0.4, 0.4, 0.2], "bars": bars}
    bodies = [*FIRST.model_dump(exclude_none=True)["bodies"], third]
    study = Study((FIRST.with_values({"bodies": bodies}),), 1, 1e-3, MODEL_HIERARCHY)
    asked = [what for _, _, what, *_ in Assumptions((), directed=()).task_arguments(study)]
    assert asked == [None, *UNDER_LOAD]


def test_an_error_of_any_trial_is_that_of_its_task(monkeypatch: pytest.MonkeyPatch) -> None:
    made = [
        replace(fake_trial(FIRST, MODEL_HIERARCHY[-1], None, validity.PHASES), error_message=text)
        for text in ("", "late", "later")
    ]
    monkeypatch.setattr(trials, "amplification_of", fake_trial)
    monkeypatch.setattr(trials, "find_worst_directions", lambda *rest: (replace(BLIND, worst=True),))
    monkeypatch.setattr(trials, "follow_direction", lambda *rest: made)
    task = FIRST, (MODEL_HIERARCHY[-2], MODEL_HIERARCHY[-1]), ("offset",), 1e-3, validity.PHASES, 3
    assert trials.answer_trials(task).error_message == "late"


def test_what_shortening_changes_is_said() -> None:
    loaded = [cell(variation, size, size, 1e-3) for variation, size in zip(UNDER_LOAD, (-0.1, -0.082))]
    (line,) = assumption_lines(found_of(loaded), FIRST)
    assert line.endswith("change mu_1 by up to 2 ± 0.1 %, mu_2 by up to 0 ± 0 %")
    softened, shortened = (
        AssumptionCell("fig3-I", each, ((0.0, 0.0),) * 3, ((0.0, 0.0),) * 3, ("ok",) * 3) for each in UNDER_LOAD
    )
    changes, errors = ((0.001, -0.02), (-0.06, 0.01), (0.02, 0.0)), ((1e-3, 0.0), (2e-3, 4e-3), (0.0, 0.0))
    (line,) = assumption_lines(found_of([softened, replace(shortened, change=changes, uncertainty=errors)]), FIRST)
    assert line.endswith("change mu_1 by up to 6 ± 0.2 %, mu_2 by up to 2 ± 0.4 %"), "the largest of all phase pairs"
    nothing = [loaded[0], cell(UNDER_LOAD[1], float("nan"))]
    assert assumption_lines(found_of(nothing), FIRST)[-1].startswith("no value says")
    for alone in (Variation(offset=0.1), Variation()):
        assert assumption_lines(found_of([cell(alone, 0.02)]), FIRST) == [], "a change is one from the stated scene"


def test_the_command_prints_the_change_of_every_body(monkeypatch, capsys, tmp_path):
    variations = Variation(ring=0.5), Variation(height=2.0, supports=3), Variation(offset=0.1, direction=math.pi / 2.0)
    cells = [
        AssumptionCell("fig3-I", each, ((0.01 * n, -0.02 * n),), ((1e-3 * n, 2e-3 * n),), ("ok",))
        for n, each in enumerate(variations, start=1)
    ]
    cells.append(replace(cells[0], variation=Variation(ring=4.0), no_effect=ONE_PLANE))
    monkeypatch.setattr(command, "compute_tasks", lambda *rest: None)
    monkeypatch.setattr(Assumptions, "collect", lambda *rest: found_of(cells, [BLIND]))
    file = tmp_path / "fig3-I.toml"
    file.write_text(scene_text("fig3-I", ("ring = 1.0 ", "ring = 2.0 ")), encoding="utf-8")
    assert command.main([str(file), "--out", str(tmp_path / "report")]) == 0
    out = capsys.readouterr().out
    rows = [re.split(r"\s{2,}", line.strip()) for line in out.splitlines()]
    for cells_of_row in (
        ["1", "1", "4", "+1.000", "-2.000", "0.100", "0.200", "ok"],
        ["2", "2", "3", "+2.000", "-4.000", "0.200", "0.400", "ok"],
        ["2", "1", "4", "0.2 m at 90°", "+3.000", "-6.000", "0.300", "0.600", "ok"],
        ["8", "1", "4", "+1.000", "-2.000", "0.100", "0.200", NO_EFFECT],
    ):
        assert cells_of_row in rows
    assert f"0.2 m off the axis towards 0 degrees: {NO_EFFECT}" in out
