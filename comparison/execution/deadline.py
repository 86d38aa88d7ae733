"""Until when the workers may compute, and which task still fits."""

from __future__ import annotations

import time
from collections import defaultdict
from collections.abc import Hashable


class Deadline:
    """
    An instant at which the workers must be done.

    Parameters
    ----------
    seconds : float
        From now.
    """

    def __init__(self, seconds: float) -> None:
        self._end = time.monotonic() + seconds
        self._predicted: dict[Hashable, float] = defaultdict(float)
        self._taken: dict[Hashable, float] = defaultdict(float)

    @property
    def left(self) -> float:
        """s until the deadline, negative after it."""
        return self._end - time.monotonic()

    def learn(self, kind: Hashable, predicted: float, taken: float) -> None:
        """Remember what a task of some kind was predicted to take and what it took, s of processor time."""
        self._predicted[kind] += predicted
        self._taken[kind] += taken

    def expected(self, kind: Hashable, predicted: float) -> float:
        """What a task takes, going by what others of its kind took, s of processor time."""
        before = self._predicted[kind]
        return predicted * (self._taken[kind] / before if before > 0.0 else 1.0)

    def allows(self, kind: Hashable, predicted: float) -> bool:
        """Whether a task would end in time."""
        return self.expected(kind, predicted) < self.left
