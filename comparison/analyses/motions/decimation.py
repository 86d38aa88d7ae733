"""
Thinning of a motion: the instants between which straight lines reproduce every instant dropped.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reference.build_cache import cached_on_disk

Array = NDArray[np.float64]

SHARE = 0.003  # of the swing of a component: what a thinned motion may be off by
MIN_SWING = 0.01  # of its largest value: a component that changes less is as good as constant


def swing(values: Array) -> Array:
    """Half of what each component of `values` (T, C) goes through, (C,), in whose shares thinning is measured."""
    largest = np.abs(values).max(axis=0, initial=0.0)
    half = 0.5 * (values.max(axis=0, initial=-np.inf) - values.min(axis=0, initial=np.inf))
    scale: Array = np.maximum(half, MIN_SWING * largest)
    return np.where(scale > 0.0, scale, 1.0)


def thinned(time: Array, values: Array, peaks: NDArray[np.intp], share: float = SHARE) -> NDArray[np.intp]:
    """
    Indices to keep of `values` (T, C) at `time` (T,): both ends, `peaks`, and as many more as it takes for straight
    lines between them to miss no value by more than `share` of its component's `swing`.
    """
    if len(time) < 3:
        return np.arange(len(time))
    kept = np.zeros(len(time), bool)
    kept[[0, len(time) - 1]] = kept[peaks] = True
    _keep_corners(np.ascontiguousarray(time), np.ascontiguousarray(values / swing(values)), share, kept)
    return np.flatnonzero(kept)


@cached_on_disk(__file__, error_model="numpy", nogil=True)
def _keep_corners(time: Array, values: Array, share: float, kept: NDArray[np.bool_]) -> None:
    """Add to `kept` (T,), wherever a straight line misses one of `values` (T, C) by too much, the row missed most."""
    start = 0
    while start < len(time) - 1:
        end = start + 1
        while not kept[end]:
            end += 1
        most, row = share, start
        for between in range(start + 1, end):
            part = (time[between] - time[start]) / (time[end] - time[start])
            for c in range(values.shape[1]):
                first, last = values[start, c], values[end, c]
                missed = abs(values[between, c] - first - part * (last - first))
                if missed > most:
                    most, row = missed, between
        if row > start:
            kept[row] = True
        else:
            start = end
