"""
Units of the engine's model: total mass, rho and sqrt(rho / g).

In them the contact carries 1, the pendulum has length 1 and gravity is 1, so that every tolerance and stiffness
is a pure number and a scene of 1 kg runs through the same arithmetic as the same scene of 1e6 kg. A flat slider
has no length of its own. There the unit is the pendulum that swings with the loading.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from reference.problem import GRAVITY, Scene, loading_period


@dataclass(frozen=True)
class Units:
    """Units of mass, length and time of the model, in kg, m and s, and units that follow from them."""

    mass: float
    length: float
    time: float

    @property
    def velocity(self) -> float:
        """Unit of velocity, m/s."""
        return self.length / self.time

    @property
    def acceleration(self) -> float:
        """Unit of acceleration, m/s^2."""
        return self.length / self.time**2

    @property
    def force(self) -> float:
        """Unit of force, N."""
        return self.mass * self.acceleration


def units_of(scene: Scene) -> Units:
    """Return units in which total mass, pendulum length rho and g are 1; on a plane the loading sets the time unit."""
    if scene.flat:
        time = min(loading_period(scene), scene.duration) / (2.0 * math.pi)
        return Units(scene.total_mass, GRAVITY * time**2, time)
    return Units(scene.total_mass, scene.radius, math.sqrt(scene.radius / GRAVITY))


def link_stiffness(scene: Scene, units: Units) -> NDArray[np.float64]:
    """Return the shear stiffness of the links between bodies along x and y, (N-1, 2), in units of the model."""
    return scene.stiffness * (units.time**2 / units.mass)


def link_damping(scene: Scene, units: Units) -> NDArray[np.float64]:
    """Return the shear damping of the links between bodies along x and y, (N-1, 2), in units of the model."""
    return scene.damping * (units.time / units.mass)
