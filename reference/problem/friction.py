"""Dry friction whose coefficient depends on the slip speed: the law of friction-pendulum practice."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray


@dataclass(frozen=True)
class DryFriction:
    """
    The coefficient mu(|v|) = fast - (fast - slow) exp(-rate |v|) of Mokha and Constantinou.

    Attributes
    ----------
    slow : float
        At rest.
    fast : float
        At high speed.
    rate : float
        s/m. 0 for a coefficient that does not depend on the speed.

    Examples
    --------
    >>> law = DryFriction(slow=0.03, fast=0.06, rate=100.0)
    >>> law.largest, round(float(law.at(0.01)), 4)
    (0.06, 0.049)
    """

    slow: float
    fast: float
    rate: float

    @property
    def varies(self) -> bool:
        """Whether the coefficient depends on the speed."""
        return self.rate > 0.0 and self.slow != self.fast

    @property
    def largest(self) -> float:
        """The larger of `slow` and `fast`, which bounds the coefficient at every speed."""
        return max(self.slow, self.fast)

    def at(self, speed: ArrayLike) -> NDArray[np.float64]:
        """
        The coefficient at slip speeds.

        Parameters
        ----------
        speed : array_like
            m/s, of any shape.

        Returns
        -------
        ndarray
            Of the same shape.
        """
        coefficient: NDArray[np.float64] = self.slow - (self.fast - self.slow) * np.expm1(
            -self.rate * np.asarray(speed, dtype=float)
        )
        return coefficient
