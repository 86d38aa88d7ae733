"""The bars of the first screen: they stand on one scale, follow one another, and end at the total."""

from __future__ import annotations

import math

import pytest

from comparison.surfaces.waterfall import WaterfallBar
from comparison.surfaces.waterfall_chart import bars_of, log_scale, scale_of

NAN = float("nan")


def _bar(model: str, size: float, error: float = 1e-4) -> WaterfallBar:
    return WaterfallBar(model, size, error)


STEPS = [_bar("exact", 0.02), _bar("resolved", -0.10), _bar("spatial", 0.03)]
TOTAL = _bar("spatial", -0.05)


def test_every_bar_begins_where_the_one_before_it_ends() -> None:
    scale = scale_of([(STEPS, TOTAL)])
    *steps, total = bars_of(STEPS, TOTAL, scale)
    starts = [0.0, 0.02, -0.08]
    for bar, start, step in zip(steps, starts, STEPS, strict=True):
        ends = sorted((scale.at(start), scale.at(start + step.size)))
        assert [bar.left, bar.left + bar.width] == pytest.approx(ends, abs=2e-3)
        assert bar.end == pytest.approx(scale.at(start + step.size), abs=2e-3)
    assert steps[-1].end == pytest.approx(total.end, abs=2e-3)
    assert [bar.kind for bar in steps] == ["up", "down", "up"]


def test_one_scale_holds_the_longest_bar_of_all_with_its_error() -> None:
    small = [_bar("exact", 1e-4)]
    scale = scale_of([(STEPS, TOTAL), (small, small[0]), ([_bar("exact", 0.3, error=0.05)], _bar("exact", 0.3))])
    assert scale.low < -0.08
    assert scale.high > 0.35
    bar = bars_of(small, small[0], scale)[0]
    assert bar.width == pytest.approx(100.0 * 1e-4 / (scale.high - scale.low), abs=1e-3), "its true size, however small"


def test_ticks_are_round_and_inside() -> None:
    scale = scale_of([(STEPS, TOTAL)])
    assert 0.0 in [round(tick, 12) for tick in scale.ticks]
    assert all(0.0 <= scale.at(tick) <= 100.0 for tick in scale.ticks)


def test_a_step_without_a_value_has_no_bar_and_moves_nothing() -> None:
    steps = [STEPS[0], _bar("resolved", NAN, NAN), _bar("spatial", 0.01)]
    scale = scale_of([(steps, TOTAL)])
    first, missing, last, _ = bars_of(steps, TOTAL, scale)
    assert (missing.kind, missing.width, missing.text) == ("none", 0.0, "no value")
    assert last.left == pytest.approx(first.end, abs=2e-3)


def test_what_is_not_real_is_gray_and_shows_its_error() -> None:
    bar = bars_of([_bar("exact", 0.0001, error=0.0003)], TOTAL, scale_of([(STEPS, TOTAL)]))[0]
    assert bar.kind == "unreal"
    assert bar.text == "+0.01 ± 0.03 %"


@pytest.mark.parametrize(
    ("size", "error", "text"),
    [(-0.0871, 1e-6, "−8.7 %"), (-0.0363, 6e-4, "−3.63 ± 0.06 %"), (1e-9, 2e-4, "0 ± 0.02 %"), (0.0, 1e-9, "0 %")],
)
def test_a_size_has_the_digits_that_its_error_leaves(size: float, error: float, text: str) -> None:
    assert bars_of([_bar("exact", size, error)], TOTAL, scale_of([(STEPS, TOTAL)]))[0].text == text


def test_a_study_without_any_value_has_a_scale() -> None:
    scale = scale_of([([_bar("exact", NAN, NAN)], _bar("exact", NAN, NAN))])
    assert scale.low < 0.0 < scale.high


def test_a_logarithmic_axis_spans_all_sizes_above_zero() -> None:
    scale = log_scale([3e-5, 0.2, 0.0, NAN])
    assert (scale.low, scale.high) == pytest.approx((1e-5, 1.0))
    assert scale.at(math.sqrt(1e-5)) == pytest.approx(50.0)
    assert scale.at(0.0) == 1.0
    assert len(scale.ticks) == 6
