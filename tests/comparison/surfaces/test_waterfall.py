"""The bars of a waterfall are the planted steps, add up to the total, and are drawn on one scale."""

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr
from studies import GRID, KEYS, planted_study, solved

from comparison.report import page
from comparison.report.page_data import find_crossings
from comparison.study.models import MODEL_HIERARCHY
from comparison.study.study import Study
from comparison.surfaces.body_comparison import BodyComparison, count_independent_phases
from comparison.surfaces.waterfall import Waterfall, WaterfallBar, make_waterfall
from comparison.surfaces.waterfall_chart import make_common_scale, place_bars
from reference.problem import load_scene


def bars_of_body(study: Study, surfaces: xr.Dataset, body: int) -> Waterfall:
    return make_waterfall(BodyComparison(study, surfaces, study.scenes[0], body))


def test_the_bars_of_the_largest_difference_add_up_to_it() -> None:
    study, surfaces = planted_study({})
    factor = 1.0 + 0.3 * np.random.default_rng(0).uniform(-1.0, 1.0, surfaces["mu"].shape)
    bars = bars_of_body(study, surfaces.assign(mu=surfaces["mu"] * factor), 2)
    assert abs(sum(bar.size for bar in bars.largest.bars) - bars.largest.total.size) < 1e-15
    assert abs(bars.largest.total.size) > abs(bars.total.size)


def test_every_bar_is_the_planted_step_with_its_sign() -> None:
    levels = dict(zip(KEYS, (0.03, -0.02, -0.01, -0.01)))
    bars = bars_of_body(*planted_study(levels), 1)
    assert [bar.model for bar in bars.bars] == list(KEYS)
    assert [bar.size for bar in bars.bars] == pytest.approx([0.03, -0.05, 0.01, 0.0], abs=1e-12)
    assert (bars.total.model, bars.total.size) == ("spatial", pytest.approx(-0.01, rel=1e-9))
    assert [bar.resolved for bar in bars.bars] == [True, True, True, False]


def test_what_finer_grids_leave_of_the_total_is_a_bar_of_its_own() -> None:
    """Geometry of one phase pair that the spatial model lacks: its mean is over 64 pairs, that of the total over 16."""
    study, surfaces = planted_study({"spatial": 0.05})
    place = {"alpha1": surfaces["alpha1"][3], "alpha2": surfaces["alpha2"][4]}
    for model in ("resolved", "regularised", "translational", "spatial"):
        surfaces["mu"].loc[{"model": model, **place}] *= 1.64
    bars = bars_of_body(study, surfaces, 1)
    assert bars.bars[0].size == pytest.approx(0.01)
    assert (bars.bars[-1].model, bars.bars[-1].size, bars.bars[-1].resolved) == ("phases", pytest.approx(-0.01), False)
    assert bars.total.size == pytest.approx(0.05)
    assert sum(bar.size for bar in bars.bars) == pytest.approx(bars.total.size, rel=1e-12)


def test_a_bar_is_resolved_beyond_its_sampling_error_and_five_numerical_ones() -> None:
    for error, resolved in ((0.0039, True), (0.0041, False)):  # with that of the first model, 1e-5
        bar = bars_of_body(*planted_study({"spatial": 0.02}, {"spatial": error}), 1).bars[-1]
        assert (bar.size, bar.resolved) == (pytest.approx(0.02), resolved)
    study, surfaces = planted_study({"spatial": 0.02})
    surfaces["mu"].loc[{"model": "spatial"}] *= 1.0 + 0.2 * np.cos(surfaces["alpha1"] + 0.3)
    assert not bars_of_body(study, surfaces, 1).bars[-1].resolved


def test_the_largest_difference_may_be_of_the_finer_engine() -> None:
    """A ridge between the phases of the spatial model: the translational model shows it."""
    study, surfaces = planted_study({"spatial": 0.05})
    place = {"body": 2, "alpha1": surfaces["alpha1"][3], "alpha2": surfaces["alpha2"][4]}
    for model in ("resolved", "regularised", "translational"):
        surfaces["mu"].loc[{"model": model, **place}] *= 0.6
    surfaces["error"].loc[{"model": "translational", **place}] = 0.01 * surfaces["mu"].sel(
        model="small-resolved", **place
    )
    largest = bars_of_body(study, surfaces, 2).largest
    assert largest.total.error == pytest.approx(0.01, rel=1e-3), "of this phase pair, not of others"
    assert (largest.total.model, largest.total.size) == ("translational", pytest.approx(-0.4, rel=1e-9))
    assert largest.phases == pytest.approx((2.0 * np.pi * 3 / 8, 2.0 * np.pi * 4 / 8))
    surfaces["mu"].loc[{"model": "translational", "alpha1": 0.0, "alpha2": 0.0}] = np.nan
    assert bars_of_body(study, surfaces, 2).largest == largest, "a value missing elsewhere changes nothing"
    surfaces["mu"].loc[{"model": "resolved", "body": 2}] *= 3.0
    equations = bars_of_body(replace(study, hierarchy=study.hierarchy[:6]), surfaces, 2).largest
    assert (equations.total.model, equations.total.size) == ("regularised", pytest.approx(-0.4)), "the last of them"
    surfaces["mu"].loc[{"model": "resolved", "body": 2}] /= 3.0
    assert {bar.model: bar.size for bar in largest.bars} == pytest.approx(
        {"resolved": -0.4, "regularised": 0.0, "translational": 0.0}, abs=1e-12
    )
    surfaces["stride"].loc[{"model": "resolved"}] = 2
    bars = bars_of_body(study, surfaces, 2).largest.bars
    assert [math.isnan(bar.size) for bar in bars] == [True, True, False], "nothing is computed there"


def test_without_a_common_phase_there_is_no_bar_and_no_crash() -> None:
    study, surfaces = planted_study({})
    surfaces["mu"].loc[{"model": "resolved"}] = np.nan
    bars = bars_of_body(study, surfaces, 1)
    assert [math.isnan(bar.size) for bar in bars.bars] == [True, True, False, False]
    surfaces["mu"][:] = np.nan
    bars = bars_of_body(study, surfaces, 1)
    assert not any(bar.resolved for bar in (*bars.bars, bars.total))
    assert bars.largest.bars == ()


def test_independent_phases_are_counted_by_symmetries() -> None:
    """Each harmonic has its axis in case I: four phase pairs give the same mu. In case II two do."""
    for name, orbits in (("fig3-I", 4), ("fig3-II", 8)):
        study, every = Study((load_scene(name),), GRID, 1e-3, MODEL_HIERARCHY), np.ones((4, 4), dtype=bool)
        models = [study.hierarchy[0], study.hierarchy[-1]]
        for full in (False, True):
            asked = replace(study, full=full)
            assert count_independent_phases(asked, asked.scenes[0], models, every, stride=2) == orbits
        every[0, 0] = False  # one of an orbit is missing, the others still tell what it would
        assert count_independent_phases(study, study.scenes[0], models, every, stride=2) == orbits
    study, _ = planted_study({})  # the fake models have none
    every = np.ones((8, 8), dtype=bool)
    assert (
        count_independent_phases(study, study.scenes[0], [study.hierarchy[0], MODEL_HIERARCHY[0]], every, stride=1)
        == 64
    )
    chain = [replace(model, symmetric=MODEL_HIERARCHY[0].symmetric) for model in study.hierarchy]
    base = replace(study, hierarchy=[replace(chain[2], symmetric=study.hierarchy[2].symmetric), *chain[3:6]])
    rows = BodyComparison(base, solved(base), base.scenes[0], 1).rows
    assert rows["regularized-friction"].independent == 64, "that the base has no symmetry counts"


STEPS = [WaterfallBar(*bar, 1e-4, True) for bar in (("resolved", 0.02), ("regularised", -0.10), ("spatial", 0.03))]
TOTAL = WaterfallBar("spatial", -0.05, 1e-4, True)


def test_the_scale_holds_every_bar_with_both_ends_of_its_error() -> None:
    """The steps run over 0.02, -0.08 and -0.05; the least and the largest end may be of any bar, and of any body."""
    for place, error, low, high, ticks in (
        (0, 0.03, -0.08, 0.05, (-0.05, 0.0, 0.05)), (1, 0.04, -0.12, 0.02, (-0.1, -0.05, 0.0)),
        (2, 0.09, -0.14, 0.04, (-0.1, -0.05, 0.0)),
    ):  # fmt: skip
        steps = [replace(bar, error=error if number == place else 0.0) for number, bar in enumerate(STEPS)]
        other = [WaterfallBar("spatial", 0.01, math.nan, True)], WaterfallBar("spatial", 0.01, 0.0, True)
        for waterfalls in ([(steps, TOTAL), other], [other, (steps, TOTAL)]):
            scale = make_common_scale(waterfalls)
            room = 0.03 * (high - low)
            assert (scale.low, scale.high) == pytest.approx((low - room, high + room))
            assert scale.ticks == pytest.approx(ticks)
    assert make_common_scale([([], replace(TOTAL, size=-0.05, error=0.2))]).high == pytest.approx(0.15 + 0.03 * 0.4)


def test_the_charts_of_means_and_of_largest_differences_have_scales_of_their_own(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    seen: dict[str, Any] = {}
    monkeypatch.setattr(page, "render_template", lambda name, context: seen.update(context))
    monkeypatch.setattr(page, "name_second_model", lambda study: "another")
    larger = [replace(bar, size=5.0 * bar.size) for bar in STEPS], replace(TOTAL, size=5.0 * TOTAL.size)
    largest = SimpleNamespace(bars=larger[0], total=larger[1])
    waterfall = SimpleNamespace(bars=STEPS, total=TOTAL, largest=largest)
    scene = SimpleNamespace(waterfalls=[waterfall], headlines=["line"])
    report: Any = SimpleNamespace(study=SimpleNamespace(hierarchy=()), results=SimpleNamespace(scenes=[scene]))
    page.render_summary(report)
    assert seen["scales"] == {"mean": make_common_scale([(STEPS, TOTAL)]), "largest": make_common_scale([larger])}


def test_a_step_without_a_value_has_no_bar_and_moves_nothing() -> None:
    steps = [STEPS[0], WaterfallBar("regularised", math.nan, math.nan, False), STEPS[2]]
    scale = make_common_scale([(steps, TOTAL)])
    first, missing, last, _ = place_bars(steps, TOTAL, scale)
    assert (missing.kind, missing.width, missing.text) == ("none", 0.0, "no value")
    assert last.left == pytest.approx(first.end, abs=2e-3)


@pytest.mark.parametrize(
    ("size", "error", "kind", "text"),
    [
        (-0.0871, 1e-6, "down", "−8.7 %"),
        (-0.0363, 6e-4, "down", "−3.63 ± 0.06 %"),
        (0.0001, 0.0003, "unresolved", "+0.01 ± 0.03 %"),
        (1e-9, 2e-4, "unresolved", "0 ± 0.02 %"),
        (0.0, 1e-9, "unresolved", "0 %"),
    ],
)
def test_a_size_has_the_digits_that_its_error_leaves(size: float, error: float, kind: str, text: str) -> None:
    bar = place_bars([WaterfallBar("exact", size, error, kind == "down")], TOTAL, make_common_scale([(STEPS, TOTAL)]))[
        0
    ]
    assert (bar.kind, bar.text) == (kind, text)
    scale = make_common_scale([([], WaterfallBar("exact", math.nan, math.nan, False))])
    assert scale.low < 0.0 < scale.high, "without any value there is a scale, too"


def test_the_line_of_the_uncertainty_is_where_it_is_crossed() -> None:
    """|D| = |cos alpha1| crosses 0.5 at pi/3 and its mirror images, whatever alpha2; lines between 48 points: 2e-3."""
    phase = 2.0 * np.pi * np.arange(48) / 48
    size = np.cos(phase)[:, None].repeat(48, axis=1)
    lines = find_crossings(size, np.full_like(size, 0.5), phase)
    where = sorted(float(np.mean([point[0] for point in line])) for line in lines)
    assert where == pytest.approx([np.pi / 3 * k for k in (1, 2, 4, 5)], abs=3e-3)
    assert all(np.ptp([point[1] for point in line]) == pytest.approx(2.0 * np.pi, abs=1e-3) for line in lines)
    assert find_crossings(size, np.zeros_like(size) - 1.0, phase) == [], "beyond everywhere: no line"


def test_a_bar_at_the_largest_difference_is_resolved_beyond_five_errors() -> None:
    for error, resolved in ((0.0039, True), (0.0041, False)):
        bars = bars_of_body(*planted_study({"spatial": 0.02}, {"spatial": error}), 1).largest.bars
        assert bars[-1].resolved == resolved
