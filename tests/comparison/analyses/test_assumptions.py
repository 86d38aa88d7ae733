"""How far the assumptions hold: variations, ranges, what is said of them, and the real models without heights."""

import re
from dataclasses import replace

import numpy as np
import pytest
from fake_models import fake_hierarchy
from known_analyses import collected
from places import scene_text

from comparison.analyses.assumptions import command, validity
from comparison.analyses.assumptions.validity import AssumptionCell, Assumptions, Variation, uneven_lines
from comparison.study.models import MODEL_HIERARCHY
from comparison.study.study import Study
from multibody import amplification
from reference.problem import load_scene

STATED = load_scene("fig3-I")


def _cell(variation: Variation, first: float, second: float, uncertainty: float = 0.0) -> AssumptionCell:
    """mu_1 changes by `one` and `other` at two phase pairs, mu_2 not at all."""
    estimate = ((uncertainty, 0.0),) * 2
    return AssumptionCell("fig3-I", variation, ((first, 0.0), (second, 0.0)), estimate, ("ok", "ok"))


def test_a_variation_changes_ring_heights_and_supports_alone() -> None:
    changed = Variation(ring=2.0, height=0.5, supports=3).of(STATED)
    assert (changed.isolator.ring, changed.isolator.supports) == (2.0, 3)
    assert [body.height for body in changed.bodies] == [0.1, 0.6]
    assert Variation(ring=0.5, height=2.0, supports=4).of(changed).digest() == STATED.digest()
    uneven = Variation(offset=0.1, yaw=0.2).of(STATED)
    assert uneven.offsets.tolist() == [[0.0, 0.0], [0.1, 0.1]]
    assert uneven.yaws.tolist() == [0.0, 0.2]
    assert uneven.with_values({"bodies.1.offset": None, "bodies.1.yaw": None}).digest() == STATED.digest()
    square = 2.0 * np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])
    placed = STATED.with_values({"isolator.supports": square.tolist(), "isolator.ring": None})
    assert Variation(ring=0.5).of(placed).support_places.tolist() == (0.5 * square).tolist(), "by the same factor"
    three = Variation(supports=3, offset=0.1).of(placed)
    assert (three.isolator.supports, three.isolator.ring) == (3, pytest.approx(np.sqrt(8.0)))
    assert three.offsets[1].tolist() == pytest.approx([0.1 * np.sqrt(8.0)] * 2), "over the radius of the ring"


RINGS = [_cell(Variation(ring=ring), c, -c / 2.0) for ring, c in {4: 0.001, 2: 0.002, 1: 0.02, 0.5: 0.003}.items()]
HEIGHTS = [_cell(Variation(height=h), 0.0, c) for h, c in {0: 0.0, 0.5: -0.004, 1: -0.03, 2: 0.002}.items()]
WIDE = _cell(Variation(ring=2.0), 0.004, 0.0)


@pytest.mark.parametrize(
    ("cells", "key", "share", "expected"),
    [
        (RINGS, "ring", 0.01, (2.0, 1.0)),  # 0.5 m would hold, but 1 m does not
        (RINGS, "ring", 0.05, (0.5, None)),
        (HEIGHTS, "height", 0.01, (0.5, 1.0)),
        (HEIGHTS, "height", 0.05, (2.0, None)),
        ([WIDE, _cell(Variation(), 0.008, 0.0, 0.003)], "ring", 0.01, (2.0, 1.0)),  # its uncertainty counts against it
        ([WIDE, _cell(Variation(), 0.008, 0.0, 0.001)], "ring", 0.01, (1.0, None)),
        ([WIDE, _cell(Variation(), float("nan"), 0.0)], "ring", 0.01, (2.0, 1.0)),
        ([_cell(Variation(ring=2.0), 0.2, 0.0)], "ring", 0.01, (None, 2.0)),
    ],
)
def test_a_range_ends_at_the_first_value_that_fails(cells, key, share, expected):
    lines = validity.ranges(STATED, cells)
    [found] = [(each.holds, each.fails) for each in lines if (each.body, each.key, each.share) == (1, key, share)]
    assert found == expected


def test_cells_compare_the_two_engine_models() -> None:
    keys = "isolator.supports", "isolator.ring", "isolator.sphere_radius"
    bare = STATED.with_values({"name": "bare", **dict.fromkeys(keys)})
    study = Study((STATED, bare), 2, 1e-3, fake_hierarchy(gap=0.0))
    cells = collected(Assumptions(), study).cells
    assert [cell.variation for cell in cells] == list(validity.FEW)
    for cell in cells:
        assert (np.array(cell.change) == 0.0).all(), "both fake models answer alike"
        assert np.array(cell.change).shape == (len(validity.PHASES), 2)
        np.testing.assert_allclose(cell.uncertainty, 2e-3 * np.sqrt(2.0))  # both claim a fifth of 1 %: enough to tell
    assert collected(Assumptions(), Study((bare,), 2, 1e-3, fake_hierarchy())) is None
    for cell in collected(Assumptions(), replace(study, hierarchy=fake_hierarchy("always_raising"))).cells:
        assert np.isnan(cell.change).all()
        assert cell.error_message == "RuntimeError: the matrix is singular"
        assert not cell.holds(1, 0.05)


def test_an_uneven_variation_gives_factors_and_torsion() -> None:
    """Where motions raise, the factors alone."""
    spatial, uneven = MODEL_HIERARCHY[-1], Variation(offset=0.1)
    short = STATED.with_values({"duration": 1.0})
    factors = amplification(uneven.of(short), validity.PHASES, tolerance=1e-3, **spatial.settings)
    solved = validity.varied((short, spatial, uneven, 1e-3))
    assert solved.status == tuple(factors.status)
    assert (np.abs(solved.mu - factors.mu) <= np.minimum(solved.error, factors.error)).all()
    assert (solved.error <= 1e-3 * solved.mu).all()
    assert np.array(solved.torsion)[:, 1].min() > 1e-3
    lacking = validity.varied((short, replace(spatial, trajectory="comparison.nowhere:trajectory"), uneven, 1e-3))
    assert np.array_equal(lacking.mu, factors.mu)
    assert lacking.error_message == "no motion: ModuleNotFoundError: No module named 'comparison.nowhere'"


def test_with_all_heights_zero_the_real_models_agree() -> None:
    study = Study((load_scene("fig3-II").with_values({"duration": 2.0}),), 1, 1e-3, MODEL_HIERARCHY)
    (cell,) = collected(Assumptions([Variation(height=0.0)]), study).cells
    assert set(cell.status) == {"ok"}
    assert cell.torsion == ()
    assert (np.abs(cell.change) <= cell.uncertainty).all()
    assert np.abs(cell.change).max() > 0.0, "the model that turns has answered, not the one it is held against"


def test_bars_under_load_are_varied_only_where_they_give_way() -> None:
    bars = {"count": 4, "bending_stiffness": 0.8, "length": 1.0, "axial_stiffness": 2900.0, "spread": 0.8}
    for stiffness, expected in ((2900.0, validity.UNDER_LOAD), (None, ())):
        bars["axial_stiffness"] = stiffness
        scene = STATED.with_values({"bodies.1.period": None, "bodies.1.bars": bars})
        study = Study((scene,), 1, 1e-3, MODEL_HIERARCHY)
        asked = [variation for _, _, variation, _ in Assumptions(()).arguments(study)]
        assert asked == [None, *expected]
        effects = [variation.of(scene).bodies[1].bars.load_effect for variation in expected]
        assert effects == ["softening", "shortening"][: len(expected)]


def test_torsion_and_what_shortening_changes_are_said() -> None:
    even = _cell(Variation(), 0.0, 0.0)
    moved = replace(_cell(Variation(offset=0.1), 0.03, 0.02), torsion=((1e-3, 5e-3), (2e-3, 4e-3), (0.0, 0.0)))
    broken = replace(_cell(Variation(yaw=0.2), 0.0, 0.0), error_message="it broke")
    loaded = [_cell(variation, size, size, 1e-3) for variation, size in zip(validity.UNDER_LOAD, (-0.1, -0.082))]
    first, second, third = uneven_lines(STATED, [even, moved, broken, *loaded])
    assert first.endswith("change mu_1 by up to 3 %, mu_2 by up to 0 %; they turn by up to 5 mrad")
    assert second.endswith("no motion says how far they turn (it broke)")
    assert third.endswith("change mu_1 by up to 2 ± 0.1 %, mu_2 by up to 0 ± 0 %")
    nothing = [even, loaded[0], _cell(validity.UNDER_LOAD[1], float("nan"), 0.0)]
    assert uneven_lines(STATED, nothing)[-1].startswith("no value says")


def test_the_command_prints_the_change_of_every_body(monkeypatch, capsys, tmp_path):
    variations = Variation(ring=0.5), Variation(height=2.0, supports=3), Variation(offset=0.1, yaw=0.3)
    cells = [
        AssumptionCell("fig3-I", each, ((0.01 * n, -0.02 * n),), ((1e-4 * n, 2e-4 * n),), ("ok",))
        for n, each in enumerate(variations, start=1)
    ]
    ranges = tuple(validity.ranges(STATED, cells))
    found = validity.Validity(validity.ASSUMPTIONS, ((0.0, 0.0),), 1.0, tuple(cells), ranges)
    monkeypatch.setattr(command, "computed", lambda *rest: None)
    monkeypatch.setattr(Assumptions, "collect", lambda *rest: found)
    file = tmp_path / "fig3-I.toml"
    file.write_text(scene_text("fig3-I", ("ring = 1.0 ", "ring = 2.0 ")), encoding="utf-8")
    assert command.main([str(file), "--out", str(tmp_path / "report"), "--figures", str(tmp_path / "drawn")]) == 0
    rows = [re.split(r"\s{2,}", line.strip()) for line in capsys.readouterr().out.splitlines()]
    for cells_of_row in (
        ["1", "1", "4", "0", "0", "1.000", "2.000", "0.010", "0.020", "ok"],
        ["2", "2", "3", "0", "0", "2.000", "4.000", "0.020", "0.040", "ok"],
        ["2", "1", "4", "0.2", "0.3", "3.000", "6.000", "0.030", "0.060", "ok"],
    ):
        assert cells_of_row in rows
    assert {file.suffix for file in (tmp_path / "drawn").iterdir()} == {".png", ".pdf", ".json"}
