"""Reading the largest value between samples: smooth tops, corners of the law, and the error given for both."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest

from multibody.integration.peak import Peaks, _corner

Signal = Callable[[np.ndarray], np.ndarray]


def read(signal: Signal, slip: Signal, threshold: float, chunks: int, step: float = 0.02) -> Peaks:
    """Peaks of |signal| on [0, 1), sampled with `step` and handed over in `chunks`."""
    time = np.arange(0.0, 1.0, step)
    peaks = Peaks(1, threshold)
    edges = np.linspace(0, len(time) - 1, chunks + 1).astype(int)
    for begin, end in pairwise(edges):
        t = time[begin : end + 1]
        peaks.add(t, np.abs(signal(t))[:, None], slip(t)[:, None])
    return peaks


@pytest.mark.parametrize("chunks", [1, 2, 7, 16])
@pytest.mark.parametrize("shift", [0.0, 0.003, 0.011, 0.019])
def test_a_smooth_top_is_read_to_fourth_order_however_it_is_cut(chunks: int, shift: float) -> None:
    peaks = read(lambda t: np.cos(3.0 * (t - 0.5 - shift)), lambda t: np.ones_like(t), np.inf, chunks)
    # a parabola misses the quartic term, at most (3 h)^4 / 24 half-way between two samples
    assert peaks.value[0] == pytest.approx(1.0, abs=3e-7)
    assert peaks.instant[0] == pytest.approx(0.5 + shift, abs=1e-4)


@pytest.mark.parametrize("chunks", [1, 2, 7])
@pytest.mark.parametrize("corner", [0.5, 0.503, 0.511, 0.519])
def test_a_corner_is_read_from_both_sides(chunks: int, corner: float) -> None:
    def signal(t: np.ndarray) -> np.ndarray:
        return np.where(t < corner, 1.0 + 2.0 * (t - corner) + (t - corner) ** 2, np.exp(-9.0 * (t - corner)))

    peaks = read(signal, lambda t: 1.0 + corner - t, 1.0, chunks)
    assert peaks.instant[0] == pytest.approx(corner, abs=1e-12)
    # the decay is extrapolated by a parabola over up to one step, (9 h)^3 off; half of it is the error given
    assert abs(peaks.value[0] - 1.0) <= peaks.sampling[0] + 1e-12
    assert peaks.sampling[0] < 0.5 * 0.18**3


@pytest.mark.parametrize("chunks", [1, 2, 7, 16])
@pytest.mark.parametrize("corner", [0.503, 0.511, 0.519])
def test_the_rate_of_slip_may_jump_at_the_corner(chunks: int, corner: float) -> None:
    def signal(t: np.ndarray) -> np.ndarray:
        return np.where(t < corner, 1.0 + 3.0 * (t - corner), 1.0 - 0.4 * (t - corner))

    def slip(t: np.ndarray) -> np.ndarray:
        return np.where(t < corner, 1.0 + 0.2 * (t - corner), 1.0 + 0.7 * (t - corner) + (t - corner) ** 2)

    peaks = read(signal, slip, 1.0, chunks)
    # slip is a parabola on either side, of which one correction of the secant leaves h^3
    assert peaks.instant[0] == pytest.approx(corner, abs=1e-4)
    assert abs(peaks.value[0] - 1.0) <= peaks.sampling[0] + 1e-12
    assert peaks.sampling[0] < 5e-4


@pytest.mark.parametrize("chunks", [1, 2, 7])
def test_a_sample_between_corners_has_the_change_as_error(chunks: int) -> None:
    """Steps that are longer than corners are apart resolve neither: levels then agree by accident."""
    time, corners = np.arange(0.0, 1.0, 0.02), np.array([0.511, 0.529])

    def signal(t: np.ndarray) -> np.ndarray:
        return 1.0 + np.where(t < corners[0], 2.0, np.where(t < corners[1], 0.5, -3.0)) * (t - corners[0])

    peaks = Peaks(1, 1.0)
    edges = np.linspace(0, len(time) - 1, chunks + 1).astype(int)
    for begin, end in pairwise(edges):
        t = time[begin : end + 1]
        peaks.add(t, signal(t)[:, None], 1.0 + t[:, None] - corners)
    assert peaks.instant[0] == pytest.approx(0.52)
    assert peaks.sampling[0] == pytest.approx((2.0 - 0.5) * (0.52 - corners[0]))


def test_two_instants_of_one_corner_are_part_of_its_error() -> None:
    """The slip speed passes 1 at 0.504 by the samples before the corner, and at 0.512 by those behind it."""
    time = np.arange(0.44, 0.58, 0.02)
    slip = 1.0 + np.where(time < 0.51, time - 0.504, 3.0 * (time - 0.512))
    value, error, instant = _corner(time, np.where(time < 0.51, 1.0, 0.9), slip[:, None], 3, 1.0, [3])
    assert (value, instant) == pytest.approx((0.95, 0.508))
    assert error == pytest.approx(0.5 * 0.1 + 0.5 * 0.008 * 0.1 / 0.02)


def test_a_rise_over_short_steps_is_not_taken_for_a_slope() -> None:
    """Where a contact opens, the engine shortens its steps, and the next one is as long as ever."""
    before, within, after = np.arange(0.0, 0.5, 0.02), 0.5 + 1e-6 * np.arange(8.0), np.arange(0.52, 1.0, 0.02)
    time = np.concatenate([before, within, after])
    since = np.maximum(time - 0.5, 0.0)
    size = np.where(time < 0.5, 0.99, 1.0 - 0.1 * since - 0.01 * np.exp(-since / 3e-6))
    peaks = Peaks(1, np.inf)
    peaks.add(time, size[:, None], np.ones((len(time), 1)))
    assert peaks.value[0] == pytest.approx(size.max(), abs=1e-9)
    assert peaks.sampling[0] < 1e-3


def test_samples_are_read_on_to_an_impact_behind_them() -> None:
    time, last = np.arange(0.0, 0.5, 0.02), 0.493
    peaks = Peaks(1, np.inf)
    peaks.add(time, np.exp(2.0 * time)[:, None], np.ones((len(time), 1)))
    peaks.read_until(last)
    assert peaks.instant[0] == last
    assert abs(peaks.value[0] - np.exp(2.0 * last)) <= peaks.sampling[0] < 3e-3


@pytest.mark.parametrize("instant", [0.493, 0.6])
def test_samples_far_from_an_impact_say_nothing_about_it(instant: float) -> None:
    time = np.arange(0.0, 0.5, 0.02)
    size = 1.0 + 0.1 * np.cos(np.pi * np.arange(len(time))) if instant < 0.5 else np.exp(time)
    peaks = Peaks(1, np.inf)
    peaks.add(time, size[:, None], np.ones((len(time), 1)))
    before = float(peaks.value[0])
    peaks.read_until(instant)
    assert peaks.value[0] == before


def test_the_end_of_the_record_counts() -> None:
    peaks = read(lambda t: t, lambda t: np.ones_like(t), np.inf, 3)
    assert peaks.value[0] == pytest.approx(0.98)


def test_samples_that_alternate_have_half_of_their_spread() -> None:
    time = np.arange(0.0, 1.0, 0.02)
    size = np.cos(time - 0.5) + 0.01 * np.cos(np.pi * np.arange(len(time)))
    peaks = Peaks(1, np.inf)
    peaks.add(time, size[:, None], np.ones((len(time), 1)))
    assert peaks.value[0] - 1.0 <= peaks.sampling[0] < 0.02
