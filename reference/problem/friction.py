"""Dry friction whose coefficient depends on slip speed, load and heat, as in friction-pendulum practice."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

LEAST_LOAD = 1e-6  # of the weight: friction depends no further on a normal force that is smaller


@dataclass(frozen=True)
class Heat:
    """
    Temperature at the center of a slider's track, degrees C: initial + rise * integral of P(t - s) / sqrt(s) over s.

    P is the power of friction while the slider covers the center: conduction from its whole contact into a half space.

    Attributes
    ----------
    initial : float
        Degrees C.
    rise : float
        K / (W s^0.5), for the power of the whole isolator.
    cover : float
        m. The largest displacement at which the slider covers the center: half the side of a square as large as it.
    """

    initial: float
    rise: float
    cover: float

    @classmethod
    def of(cls, radius: float, conductivity: float, diffusivity: float, initial: float, supports: int) -> Heat:
        """Under so many equal sliders with round contacts of this radius, m; in W/(m K), m^2/s and degrees C."""
        area = supports * math.pi * radius**2
        return cls(initial, math.sqrt(diffusivity / math.pi) / (conductivity * area), 0.5 * math.sqrt(math.pi) * radius)

    @staticmethod
    def factor(temperature: ArrayLike) -> NDArray[np.float64]:
        """Coefficient at a temperature, degrees C, over that stated."""
        return 0.79 * (0.7 ** (0.02 * np.asarray(temperature)) + 0.4)


@dataclass(frozen=True)
class DryFriction:
    """
    The coefficient mu(|v|) = fast - (fast - slow) exp(-rate |v|) of Mokha and Constantinou.

    Under a normal force N in place of the weight W it is mu (N / W)^exponent; heat multiplies it by `Heat.factor`.

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
    heat : Heat, optional
        None for a coefficient that does not depend on the heat of sliding.

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
    heat: Heat | None = None

    @property
    def varies(self) -> bool:
        """Whether the coefficient depends on the speed."""
        return self.rate > 0.0 and self.slow != self.fast

    @property
    def constant(self) -> bool:
        """Whether the coefficient depends on neither speed nor load nor heat."""
        return not self.varies and self.exponent == 0.0 and self.heat is None

    @property
    def by_load(self) -> bool:
        """Whether the coefficient depends on the normal force, directly or by the heat of friction under it."""
        return self.exponent != 0.0 or self.heat is not None

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
