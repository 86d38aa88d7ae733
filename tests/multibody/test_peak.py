"""Reading the largest value between samples: smooth tops, corners of the law, and the error given for both."""

from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from multibody.integration.peak import (
    PeakReader,
    _alternating_part,
    _find_step_jumps,
    _list_smooth_stretches,
    _read_corner,
    find_kinks,
)
from multibody.integration.step_control import KINK_STEP_RATIO, StepControl

TIME = np.arange(0.0, 1.0, 0.02)


def test_a_row_is_on_a_kink_on_either_side_of_it() -> None:
    knots, near = np.array([0.3, 0.5, 0.9]), 1e-9
    time = np.array([0.3 - 2e-9, 0.3, 0.5 - 5e-10, 0.5 + 5e-10, 0.5 + 2e-9, 0.7, 0.9 + 9e-10, 1.0])
    assert find_kinks(time, knots, near).tolist() == [1, 2, 3, 6]
    assert find_kinks(time, np.array([]), near).size == 0


CHUNKS = pytest.mark.parametrize("chunks", [1, 2, 7, 16])
CORNERS = pytest.mark.parametrize("corner", [0.503, 0.511, 0.519])


def read(size: np.ndarray, slip: np.ndarray | float = 1.0, threshold: float = np.inf, chunks: int = 1) -> PeakReader:
    """Peaks of samples at TIME (T,), handed over in chunks; slip speeds (T,) or (T, K)."""
    peaks = PeakReader(1, threshold)
    slip = np.broadcast_to(np.transpose(slip), (np.atleast_2d(np.transpose(slip)).shape[0], len(TIME))).T
    edges = np.linspace(0, len(TIME) - 1, chunks + 1).astype(int)
    for begin, end in pairwise(edges):
        rows = slice(begin, end + 1)
        peaks.add(TIME[rows], size[rows, None], slip[rows])
    return peaks


@CHUNKS
@pytest.mark.parametrize("shift", [0.0, 0.003, 0.011, 0.019])
def test_a_smooth_top_is_read_to_fourth_order_however_it_is_cut(chunks: int, shift: float) -> None:
    peaks = read(np.abs(np.cos(3.0 * (TIME - 0.5 - shift))), chunks=chunks)
    # a parabola misses the quartic term, at most (3 h)^4 / 24 half-way between two samples
    assert peaks.value[0] == pytest.approx(1.0, abs=3e-7)
    assert peaks.instant[0] == pytest.approx(0.5 + shift, abs=1e-4)


@pytest.mark.parametrize("shift", [0.003, 0.007, 0.013])
def test_the_error_of_a_parabola_is_that_of_a_cubic_signal(shift: float) -> None:
    t = TIME - 0.5 - shift
    peaks = read(1.0 - 30.0 * t**2 + 40.0 * t**3)
    missed = abs(peaks.value[0] - 1.0)
    assert 1e-7 < missed <= 1.2 * peaks.sampling_error[0] < 4.0 * missed


def test_the_time_reversed_has_the_same_peak_and_error() -> None:
    """A fourth sample on either side shows what a parabola misses."""
    t = TIME - 0.493
    size = 1.0 - 30.0 * t**2 + np.where(t > 0.0, 50.0, 5.0) * t**3
    there, back = read(size), read(size[::-1])
    assert back.value[0] == pytest.approx(there.value[0], abs=1e-12)
    assert back.sampling_error[0] == pytest.approx(there.sampling_error[0], rel=1e-6)


def test_a_stretch_ends_at_the_next_corner_or_bend() -> None:
    """A corner lies behind its row, a bend on it: there a stretch ends and another begins."""
    draw = np.random.default_rng(5)
    for _ in range(60):
        corners, bends = (sorted(draw.choice(12, size=draw.integers(0, 4), replace=False).tolist()) for _ in range(2))
        row, count = int(draw.integers(13)), 13
        found = list(_list_smooth_stretches(row, count, corners, bends))
        begin, end = max([0, *(c + 1 for c in corners if c < row)]), min([12, *(c for c in corners if c >= row)])
        left = max([begin, *(bend for bend in bends if bend < row)])
        right = min([end, *(bend for bend in bends if bend > row)])
        if row in bends:
            assert found == [(left, row, (row - 1, row - 2)), (row, right, (row + 1, row + 2))]
        else:
            assert found == [(left, right, (row - 1, row + 1))]


@CHUNKS
@CORNERS
def test_a_corner_is_the_mean_of_what_both_sides_say(chunks: int, corner: float) -> None:
    """The rise is a parabola, which is read exactly; the decay is extrapolated by one through its first samples."""
    t = TIME - corner
    size = np.where(t < 0.0, 1.0 + 2.0 * t + t**2, np.exp(-9.0 * t))
    peaks = read(size, 1.0 - t, 1.0, chunks)
    behind = np.flatnonzero(t > 0.0)[:3]
    decay = np.polyval(np.polyfit(t[behind], size[behind], 2), 0.0)
    assert peaks.instant[0] == pytest.approx(corner, abs=1e-12)
    assert peaks.value[0] == pytest.approx(0.5 * (1.0 + decay), abs=1e-9)
    assert peaks.sampling_error[0] == pytest.approx(0.5 * abs(1.0 - decay), abs=1e-9)


@CHUNKS
@CORNERS
def test_the_rate_of_slip_may_jump_at_the_corner(chunks: int, corner: float) -> None:
    t = TIME - corner
    slip = np.where(t < 0.0, 1.0 + 0.2 * t, 1.0 + 0.7 * t + t**2)
    peaks = read(np.where(t < 0.0, 1.0 + 3.0 * t, 1.0 - 0.4 * t), slip, 1.0, chunks)
    # slip is a parabola on either side, of which one correction of the secant leaves h^3
    assert peaks.instant[0] == pytest.approx(corner, abs=1e-4)
    assert abs(peaks.value[0] - 1.0) <= peaks.sampling_error[0] + 1e-12
    assert peaks.sampling_error[0] < 5e-4


def test_instants_of_both_sides_that_differ_are_an_error() -> None:
    """Slip speeds that pass 1 at 0.506 by the samples before and at 0.514 by those behind, or the other way."""
    time = 0.02 * np.arange(24.0, 28.0)
    for before, behind in ((0.506, 0.514), (0.514, 0.506)):
        slip = 1.0 + np.where(time < 0.51, time - before, 2.0 * (time - behind))
        found = _read_corner(time, 1.0 + time, slip[:, None], 1, 1.0, [1])
        assert found == pytest.approx((1.51, 0.5 * 0.008, 0.51))


@CHUNKS
def test_a_sample_between_corners_has_the_change_as_error(chunks: int) -> None:
    """Steps that are longer than corners are apart resolve neither: levels then agree by accident."""
    corners = np.array([0.511, 0.529])
    slope = np.where(corners[0] > TIME, 2.0, np.where(corners[1] > TIME, 0.5, -3.0))
    peaks = read(1.0 + slope * (TIME - corners[0]), 1.0 + TIME[:, None] - corners, 1.0, chunks)
    assert peaks.instant[0] == pytest.approx(0.52)
    assert peaks.sampling_error[0] == pytest.approx((2.0 - 0.5) * (0.52 - corners[0]))


def test_two_instants_of_one_corner_are_part_of_its_error() -> None:
    """The slip speed passes 1 at 0.504 by the samples before the corner, and at 0.512 by those behind it."""
    time = np.arange(0.44, 0.58, 0.02)
    slip = 1.0 + np.where(time < 0.51, time - 0.504, 3.0 * (time - 0.512))
    slips = np.column_stack([2.0 + time, slip])  # of another contact, too
    value, error, instant = _read_corner(time, np.where(time < 0.51, 1.0, 0.9), slips, 3, 1.0, [3])
    assert (value, instant) == pytest.approx((0.95, 0.508))
    assert error == pytest.approx(0.5 * 0.1 + 0.5 * 0.008 * 0.1 / 0.02)


def test_a_rise_over_short_steps_is_not_taken_for_a_slope() -> None:
    """Where a contact opens, the engine shortens its steps, and the next one is as long as ever."""
    time = np.concatenate([np.arange(0.0, 0.5, 0.02), 0.5 + 1e-6 * np.arange(8.0), np.arange(0.52, 1.0, 0.02)])
    since = np.maximum(time - 0.5, 0.0)
    size = np.where(time < 0.5, 0.99, 1.0 - 0.1 * since - 0.01 * np.exp(-since / 3e-6))
    peaks = PeakReader(1, np.inf)
    peaks.add(time, size[:, None], np.ones((len(time), 1)))
    assert peaks.value[0] == pytest.approx(size.max(), abs=1e-9)
    assert peaks.sampling_error[0] < 1e-3
    jumps = [_find_step_jumps(np.array([0.0, 1.0, 1.0 + step, 2.0 + step])).tolist() for step in (19.0, 21.0)]
    assert jumps == [[], [1, 2]]


def test_samples_are_read_on_to_an_impact_behind_them() -> None:
    """Unless it is far behind them, or they do not resolve the motion."""
    growing, alternating = np.exp(2.0 * TIME), 1.0 + 0.1 * np.cos(np.pi * np.arange(len(TIME)))
    for size, instant, on in (
        (growing, 1.009, True),
        (growing, 1.011, False),
        (alternating, 0.993, False),
        (2.0 - alternating, 0.993, False),
        (growing, 0.993, None),
    ):
        peaks = read(size)
        if on is None:  # behind a kink of the loading
            peaks._knots, peaks._near = TIME[-2:-1], 1e-9
        before = float(peaks.value[0])
        peaks.read_until(instant)
        if on:
            assert peaks.instant[0] == instant
            assert abs(peaks.value[0] - np.exp(2.0 * instant)) <= peaks.sampling_error[0] < 2e-2
        else:
            assert peaks.value[0] == before


def test_the_end_of_the_record_counts() -> None:
    assert read(TIME, chunks=3).value[0] == pytest.approx(0.98)


def test_samples_that_alternate_have_half_of_their_spread() -> None:
    """A later and larger peak of two that are read keeps what the error of the other leaves possible."""
    alternating = 0.01 * np.cos(np.pi * np.arange(len(TIME)))
    peaks = read(np.cos(TIME - 0.5) + alternating)
    assert peaks.value[0] - 1.0 <= peaks.sampling_error[0] < 0.02
    early = np.where(TIME < 0.5, 1.0 - 40.0 * (TIME - 0.25) ** 2 + alternating, 1.0 - 40.0 * (TIME - 0.75) ** 2)
    early[TIME >= 0.5] += 0.011
    rough, smooth = read(np.where(TIME < 0.5, early, 0.0)), read(early, chunks=2)
    assert smooth.value[0] == pytest.approx(1.011, abs=1e-4)
    assert smooth.value[0] + smooth.sampling_error[0] == pytest.approx(
        rough.value[0] + rough.sampling_error[0], abs=1e-9
    )


def test_what_a_longer_last_step_misses_counts_in_full() -> None:
    """Of five samples on a cubic but for the last; among equal steps its share of an alternation counts, 1/16."""
    for time, share in (([0.0, 1.0, 2.0, 3.0, 4.0], 1.0 / 16.0), ([0.0, 1.0, 2.0, 3.0, 4.6], 1.0)):
        at = np.array(time)
        size = 1.0 + 0.5 * at - 0.1 * at**2 + 0.02 * at**3 + [0.0, 0.0, 0.0, 0.0, 0.3]
        assert _alternating_part(at, size) == pytest.approx(0.3 * share)


@pytest.mark.parametrize("way", [1, -1], ids=["first body", "second body"])
def test_a_step_behind_a_kink_is_short_where_a_body_is_near_its_peak_and_a_contact_creeps(way: int) -> None:
    ground = SimpleNamespace(knots=np.array([0.2, 0.6, 1.0]), near=1e-9)
    model: Any = SimpleNamespace(ground=ground, corner=1e-2, relaxation=0.05)
    level: Any = SimpleNamespace(error_floor=1e-3)
    time = 0.1 * np.arange(11)
    bent = 1.0 - 0.3 * (1.0 - np.exp(-np.maximum(time - 0.2, 0.0) / 0.07))
    for slowest, peak, expected in ((1e-3, 1.001, 1.5), (2e-2, 1.001, 0.0), (1e-3, 2.0, 0.0)):
        motion: Any = SimpleNamespace(
            time=time, slip=np.column_stack([0.0 * time + 0.5, 0.0 * time + slowest])[:, ::way]
        )
        size, peaks = np.column_stack([bent, 1.0 + 0.1 * time])[:, ::way], np.array([peak, 1.0])[::way]
        ratio = StepControl(model, level)._kink_step_ratio(motion, size, peaks, 0.075 * KINK_STEP_RATIO)
        np.testing.assert_allclose(ratio, np.where(np.arange(11) == 3, expected, 0.0))
