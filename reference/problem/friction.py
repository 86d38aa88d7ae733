"""Dry friction whose coefficient depends on the slip speed, as in friction-pendulum practice, and on the load."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

LEAST_LOAD = 1e-6  # of the weight: friction depends no further on a normal force that is smaller


@dataclass(frozen=True)
class DryFriction:
    """
    The coefficient mu(|v|) = fast - (fast - slow) exp(-rate |v|) of Mokha and Constantinou.

    Under a normal force N in place of the weight W it is mu (N / W)^exponent.

    Attributes
    ----------
    slow : float
        At rest.
    fast : float
        At high speed.
    rate : float
        s/m. 0 for a coefficient that does not depend on the speed.
    exponent : float
        0 for a coefficient that does not depend on the normal force.

    Examples
    --------
    >>> law = DryFriction(slow=0.03, fast=0.06, rate=100.0)
    >>> law.largest, round(float(law.at(0.01)), 4)
    (0.06, 0.049)
    """

    slow: float
    fast: float
    rate: float
    exponent: float = 0.0

    @property
    def varies(self) -> bool:
        """Whether the coefficient depends on the speed."""
        return self.rate > 0.0 and self.slow != self.fast

    @property
    def constant(self) -> bool:
        """Whether the coefficient depends on neither speed nor load."""
        return not self.varies and self.exponent == 0.0

    @property
    def largest(self) -> float:
        """The larger of `slow` and `fast`, which bounds the coefficient at every speed under the weight."""
        return max(self.slow, self.fast)

    def at(self, speed: ArrayLike, load: ArrayLike = 1.0) -> NDArray[np.float64]:
        """
        The coefficient at slip speeds.

        Parameters
        ----------
        speed : array_like
            m/s, of any shape.
        load : array_like
            Normal force over the weight, of a shape that fits.

        Returns
        -------
        ndarray
            Of the shape of both.
        """
        coefficient: NDArray[np.float64] = self.slow - (self.fast - self.slow) * np.expm1(
            -self.rate * np.asarray(speed, dtype=float)
        )
        return coefficient if self.exponent == 0.0 else coefficient * np.maximum(load, LEAST_LOAD) ** self.exponent
