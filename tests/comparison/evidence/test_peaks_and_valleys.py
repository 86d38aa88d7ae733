"""Known surfaces: peaks by prominence, curvatures, folds and jumps by a zoom."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from comparison.evidence.claims.peaks_and_valleys import (
    PeakCounts,
    find_peak_basins,
)
from comparison.evidence.claims.peaks_and_valleys import count_drawn_peaks_and_valleys as count_drawn
from comparison.evidence.claims.peaks_and_valleys import count_periodic_peaks_and_valleys as count_periodic
from comparison.evidence.claims.peaks_and_valleys import count_profile_peaks_and_valleys as count_profile
from comparison.evidence.claims.smoothness import find_sharpest_curvatures
from reference.problem import phase_grid

Array = NDArray[np.float64]
N = 16
A1, A2 = phase_grid(N).T.reshape(2, N, N)


def test_waves_have_as_many_peaks_and_valleys_as_periods() -> None:
    a1, a2 = phase_grid(36).T.reshape(2, 36, 36)
    assert count_periodic(np.cos(3.0 * a1) + np.cos(2.0 * a2)) == PeakCounts(6, 6)


def test_a_diagonal_ridge_is_one_peak_and_two_where_cut() -> None:
    assert count_periodic(np.cos(A1 - A2)) == PeakCounts(1, 1)
    assert count_drawn(np.cos(A1 - A2 - np.pi)) == PeakCounts(2, 1), "two parallel ridges and the valley between them"
    assert count_drawn(np.cos(2.0 * (A1 - A2) - np.pi)) == PeakCounts(4, 3), "four, and what separates them"


def test_ridges_are_counted_along_their_own_diagonal() -> None:
    rough = 0.3 * np.cos(3.0 * A1 + 3.0 * A2)
    assert count_profile(rough - np.cos(2.0 * (A1 - A2))) == PeakCounts(4, 3)
    assert count_profile(rough - np.cos(A1 - A2)) == PeakCounts(2, 1)
    assert count_profile(rough + np.cos(A1 - A2)) == PeakCounts(3, 2), "in the middle and at both ends"
    assert count_profile(np.cos(A1 + A2)) == PeakCounts(0, 0)


def test_a_peak_across_the_edge_counts_once() -> None:
    corner = np.exp(np.cos(A1) + np.cos(A2))
    assert count_periodic(corner).peaks == 1
    assert find_peak_basins(corner).tops == [(0, 0)]
    assert count_drawn(corner).peaks == 4


def test_a_peak_less_prominent_than_the_share_does_not_count() -> None:
    two = np.cos(A1) + 0.45 * np.cos(2.0 * A1)  # along alpha1: peaks 1.45 and -0.55, valley -0.73 between them
    prominence = -0.55 - float(two.min())
    share = prominence / float(np.ptp(two))
    assert count_periodic(two, share=0.99 * share).peaks == 2
    assert count_periodic(two, share=1.01 * share).peaks == 1


def test_noise_within_the_errors_makes_no_peak() -> None:
    noise = np.random.default_rng(1).uniform(-1.0, 1.0, A1.shape)
    assert count_periodic(1.0 + 1e-7 * noise, error=1e-7) == PeakCounts(0, 0)
    assert count_periodic(np.cos(A1) + np.cos(A2) + 0.1 * noise, error=0.1) == PeakCounts(1, 1)
    spike = 0.1 * noise
    spike[5, 5] = 10.0
    assert count_periodic(spike, error=0.1, share=0.001).peaks == 1
    assert count_periodic(spike, error=0.0, share=0.001).peaks > 1, "the noise, were it not known to be noise"


def test_a_plateau_is_one_peak_however_wide() -> None:
    assert count_periodic(np.minimum(np.cos(A1) + np.cos(A2), 0.3)).peaks == 1
    assert count_periodic(np.maximum(np.cos(A1) + np.cos(A2), -0.3)).valleys == 1
    assert count_periodic(np.full((N, N), 2.0)) == PeakCounts(0, 0)


def test_regions_belong_to_the_peak_across_the_saddle() -> None:
    heights = np.array([[9.0, 0.0, 5.0, 4.0, 4.5, 1.0, 8.0]])  # the peak of 4.5 is lesser: it hangs on the one of 5
    peaks = find_peak_basins(heights, share=0.3, closed=False)
    assert peaks.tops == [(0, 0), (0, 6), (0, 2)]
    assert peaks.regions[0, 4] == 2


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
    bend = find_sharpest_curvatures(mu, lambda at: SHAPES[kind](*np.mod(at, 2.0 * np.pi).T)[:, None])[0]
    assert bend.kind == kind
    assert bend.exponent == pytest.approx({"smooth": 2.0, "fold": 1.0, "jump": 0.0}[kind], abs=0.34)


def test_every_body_is_judged_by_its_own_surface() -> None:
    smooth, fold = find_sharpest_curvatures(_both(phase_grid(16)).reshape(16, 16, 2), _both)
    assert (smooth.kind, fold.kind) == ("smooth", "fold")
    alpha1, alpha2 = fold.phases
    other_side = np.cos(alpha1 + alpha2 + 0.3)
    assert np.cos(alpha1 - alpha2) == pytest.approx(other_side, abs=0.03), "on the fold, to the last step"


def test_a_place_without_a_value_is_no_answer() -> None:
    mu = _both(phase_grid(16)).reshape(16, 16, 2)
    assert {bend.kind for bend in find_sharpest_curvatures(mu, lambda at: np.full((len(at), 2), np.nan))} == {
        "no answer"
    }
