"""
Peaks and valleys of a surface over the phases, by prominence.

A peak is a maximum whose prominence is at least SHARE of the surface's range (highest minus lowest value) and larger
than what the errors of the values can make; its prominence is how far one must go down from it to reach anything
higher. A valley is a peak of the surface upside down. The square is periodic, so a ridge that leaves through one edge
comes back through the opposite one and counts once. `count_drawn_peaks_and_valleys` counts on one period as it is
drawn, bounded by its edges, where the same ridge is cut in two. `count_profile_peaks_and_valleys` counts on the mean
along the diagonals alpha1 - alpha2.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from comparison.result_types import Array

SHARE = 0.3  # least prominence of a maximum that counts as a peak, as a share of highest minus lowest value
# Peaks are also counted with these least prominences instead of SHARE: other counts show that the definition matters.
MIN_SHARE, MAX_SHARE = 0.2, 0.4


@dataclass(frozen=True)
class PeakBasins:
    """Peaks of a surface on a grid, and the basin of each: the points from which ascent leads to it."""

    tops: Sequence[tuple[int, int]]  # row and column of each peak, the highest first
    regions: NDArray[np.int_]  # for every grid point, index in `tops` of the peak that ascent reaches


class PeakCounts(NamedTuple):
    """Numbers of peaks and of valleys of one surface."""

    peaks: int
    valleys: int


def count_periodic_peaks_and_valleys(mu: Array, error: float = 0.0, share: float = SHARE) -> PeakCounts:
    """
    Return the numbers of peaks and valleys of the amplification mu over both phases, continued periodically at 2 pi.

    mu: (n, n), finite, at phases 2 pi k / n. error: absolute error of mu. share: least prominence / (max mu - min mu).
    """
    return PeakCounts(len(find_peak_basins(mu, error, share).tops), len(find_peak_basins(-mu, error, share).tops))


def count_drawn_peaks_and_valleys(mu: Array, error: float = 0.0, share: float = SHARE) -> PeakCounts:
    """Return the numbers of peaks, and of valleys between two peaks, on the drawn square [0, 2 pi]^2, not periodic."""
    return _count_bounded(np.pad(mu, ((0, 1), (0, 1)), mode="wrap"), error, share)


def count_profile_peaks_and_valleys(mu: Array, error: float = 0.0, share: float = SHARE) -> PeakCounts:
    """Return the numbers of peaks and valleys of the mean amplification over alpha1 - alpha2, from -2 pi to 2 pi."""
    n = len(mu)
    rows = np.arange(n)
    along = np.array([mu[(rows + k) % n, rows].mean() for k in range(n)])  # mean along the k-th diagonal
    if np.ptp(along) < share * np.ptp(mu):
        return PeakCounts(0, 0)
    return _count_bounded(np.concatenate([along, along, along[:1]])[:, None], error, share)


def _count_bounded(mu: Array, error: float, share: float) -> PeakCounts:
    """Return the numbers of peaks and valleys of a surface that is not periodic; valleys must lie between two peaks."""
    peaks, valleys = (find_peak_basins(side * mu, error, share, closed=False) for side in (1.0, -1.0))
    between = [np.unique(peaks.regions[valleys.regions == number]) for number in range(len(valleys.tops))]
    return PeakCounts(len(peaks.tops), sum(len(sides) > 1 for sides in between))


def find_peak_basins(mu: Array, error: float = 0.0, share: float = SHARE, closed: bool = True) -> PeakBasins:
    """
    Return the peaks of a surface mu (n, m), none if it varies by at most twice `error`; closed: it is periodic.

    Arguments and definition of a peak: as of `count_periodic_peaks_and_valleys` and in the module's docstring.
    """
    # The points are taken from the highest to the lowest, as islands rise from a falling sea. A point without a higher
    # neighbor is a new island, with a maximum as its top. Where a point joins islands, the lower ones end: the
    # prominence of their maxima is their height above this point, the saddle. Maxima of too little prominence are
    # merged into that of the highest island.
    span = float(np.ptp(mu))
    if not span > 2.0 * error:
        return PeakBasins([], np.full(mu.shape, -1))
    least = max(share * span, 2.0 * error)
    around = _neighbors(*mu.shape, closed)
    height = mu.ravel().tolist()
    order = np.argsort(-mu.ravel(), kind="stable").tolist()
    rank = [0] * len(height)
    for place, node in enumerate(order):
        rank[node] = place
    # Parent of each point in a union-find forest of connected points above a falling level; root: their highest point
    parent = [-1] * len(height)
    top_of = [-1] * len(height)  # for each grid point, the maximum to which steepest ascent leads
    into = list(range(len(height)))  # for maxima of too little prominence, the higher maximum that each is merged into
    tops = []
    for node in order:
        islands: dict[int, int] = {}  # by root of each adjacent union-find tree: this point's highest neighbor in it
        for other in sorted(around[node], key=rank.__getitem__):
            if parent[other] >= 0:
                islands.setdefault(_root_of_node(parent, other), other)
        if not islands:
            tops.append(node)
            parent[node] = top_of[node] = node
            continue
        top_of[node] = top_of[next(iter(islands.values()))]
        highest, *others = sorted(islands, key=rank.__getitem__)
        parent[node] = highest
        for lesser in others:
            parent[lesser] = highest
            if height[lesser] - height[node] < least:
                into[lesser] = top_of[islands[highest]]
    peaks = [top for top in tops if into[top] == top]
    number = {top: peaks.index(_root_of_node(into, top)) for top in tops}
    regions = np.array([number[top] for top in top_of]).reshape(mu.shape)
    return PeakBasins([divmod(top, mu.shape[1]) for top in peaks], regions)


def _root_of_node(parent: list[int], node: int) -> int:
    """Return the root of a node in a union-find forest, given each node's parent; shorten the path to it."""
    while parent[node] != node:
        parent[node] = parent[parent[node]]
        node = parent[node]
    return node


@cache
def _neighbors(rows: int, columns: int, closed: bool) -> list[list[int]]:
    """Return the eight neighbors of each grid point, as indices: a ridge may run along the diagonal of the grid."""
    numbers = np.arange(rows * columns).reshape(rows, columns)
    padded = np.pad(numbers, 1, mode="wrap") if closed else np.pad(numbers, 1, constant_values=-1)
    squares = np.lib.stride_tricks.sliding_window_view(padded, (3, 3)).reshape(-1, 9).tolist()
    return [[node for node in square if node >= 0] for square in squares]
