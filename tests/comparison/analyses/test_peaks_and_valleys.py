"""Peaks are counted by prominence on the square that closes: known surfaces, shifts, noise, plateaus."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from comparison.analyses.claims.peaks_and_valleys import Counts, drawn, periodic, profiled, relief
from reference.problem import phase_grid

Array = NDArray[np.float64]
N = 16


A1, A2 = phase_grid(N).T.reshape(2, N, N)


@pytest.mark.parametrize("across", [1, 2, 3])
@pytest.mark.parametrize("along", [1, 2])
def test_waves_have_as_many_peaks_and_valleys_as_periods(across: int, along: int) -> None:
    a1, a2 = phase_grid(36).T.reshape(2, 36, 36)
    assert periodic(np.cos(across * a1) + np.cos(along * a2)) == Counts(across * along, across * along)


def test_a_diagonal_ridge_is_one_peak_and_two_where_cut() -> None:
    assert periodic(np.cos(A1 - A2)) == Counts(1, 1)
    assert drawn(np.cos(A1 - A2 - np.pi)) == Counts(2, 1), "two parallel ridges and the valley between them"
    assert drawn(np.cos(2.0 * (A1 - A2) - np.pi)) == Counts(4, 3), "four, and what separates them"


def test_ridges_are_counted_along_their_own_diagonal() -> None:
    rough = 0.3 * np.cos(3.0 * A1 + 3.0 * A2)
    assert profiled(rough - np.cos(2.0 * (A1 - A2))) == Counts(4, 3)
    assert profiled(rough - np.cos(A1 - A2)) == Counts(2, 1)
    assert profiled(np.cos(A1 + A2)) == Counts(0, 0)


def test_a_peak_across_the_edge_counts_once() -> None:
    corner = np.exp(np.cos(A1) + np.cos(A2))
    assert periodic(corner).peaks == 1
    assert relief(corner).tops == [(0, 0)]
    assert drawn(corner).peaks == 4


def test_a_peak_less_prominent_than_the_share_does_not_count() -> None:
    two = np.cos(A1) + 0.45 * np.cos(2.0 * A1)  # along alpha1: peaks 1.45 and -0.55, valley -0.73 between them
    prominence = -0.55 - float(two.min())
    share = prominence / float(np.ptp(two))
    assert periodic(two, share=0.99 * share).peaks == 2
    assert periodic(two, share=1.01 * share).peaks == 1


def test_noise_within_the_errors_makes_no_peak() -> None:
    noise = np.random.default_rng(1).uniform(-1.0, 1.0, A1.shape)
    assert periodic(1.0 + 1e-7 * noise, error=1e-7) == Counts(0, 0)
    assert periodic(np.cos(A1) + np.cos(A2) + 0.1 * noise, error=0.1) == Counts(1, 1)
    spike = 0.1 * noise
    spike[5, 5] = 10.0
    assert periodic(spike, error=0.1, share=0.001).peaks == 1
    assert periodic(spike, error=0.0, share=0.001).peaks > 1, "the noise, were it not known to be noise"


def test_a_plateau_is_one_peak_however_wide() -> None:
    assert periodic(np.minimum(np.cos(A1) + np.cos(A2), 0.3)).peaks == 1
    assert periodic(np.maximum(np.cos(A1) + np.cos(A2), -0.3)).valleys == 1
    assert periodic(np.full((N, N), 2.0)) == Counts(0, 0)


def test_regions_belong_to_the_peak_across_the_saddle() -> None:
    heights = np.array([[9.0, 0.0, 5.0, 4.0, 4.5, 1.0, 8.0]])  # the peak of 4.5 is lesser: it hangs on the one of 5
    peaks = relief(heights, share=0.3, closed=False)
    assert peaks.tops == [(0, 0), (0, 6), (0, 2)]
    assert peaks.regions[0, 4] == 2


@st.composite
def _surface(draw: st.DrawFn) -> Array:
    """A few harmonics of both phases, rounded so that ties occur."""
    weights = draw(st.lists(st.floats(-1.0, 1.0), min_size=6, max_size=6))
    waves = [(1, 0), (0, 1), (1, -1), (2, 0), (1, 1), (2, -2)]
    total = sum(weight * np.cos(i * A1 + j * A2 + 3.0 * weight) for weight, (i, j) in zip(weights, waves))
    return np.asarray(np.round(total, 2))


@given(_surface(), st.integers(0, N - 1), st.integers(0, N - 1), st.floats(0.1, 10.0), st.floats(-5.0, 5.0))
def test_the_count_knows_no_origin_and_no_unit(mu: Array, down: int, right: int, factor: float, offset: float) -> None:
    """Shifted on the torus, mirrored, scaled: the same; to a tie at the threshold, which rounding may break."""
    counts = {share: periodic(mu, 1e-9, share) for share in (0.3, 0.3 + 1e-9, 0.3 - 1e-9)}
    if len(set(counts.values())) > 1:
        return
    moved = factor * np.roll(mu, (down, right), axis=(0, 1)) + offset
    assert periodic(moved, 1e-9) == counts[0.3]
    assert periodic(mu.T, 1e-9) == periodic(mu[::-1], 1e-9) == counts[0.3]
    flipped = periodic(-mu, 1e-9)
    assert (flipped.peaks, flipped.valleys) == (counts[0.3].valleys, counts[0.3].peaks)


@given(_surface())
def test_a_higher_share_never_finds_more(mu: Array) -> None:
    peaks = [periodic(mu, share=share).peaks for share in (0.05, 0.2, 0.4, 0.9)]
    assert peaks == sorted(peaks, reverse=True)
