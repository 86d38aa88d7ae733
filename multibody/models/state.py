"""State of the engine from which a run starts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class EngineState:
    """
    Coordinates, velocities and contact data of the model at one instant, in its units and relative to the ground.

    Attributes:
    - coordinates, velocities: Values of all coordinates and their rates, (n,).
    - contact: Contact data, (c,): gap, slip speed and two unused entries of each contact.
    - slip_rate, load, load_rate: Rates of the contacts' slip speeds over the last step, their loads over their shares
      of the weight where friction depends on load, and the rates of these loads, (K,); None without a last step.
    - accelerations: Accelerations at the start, (n,); None lets the engine compute them.
    - sliding: Whether each contact slides, (K,), where friction yields; empty at the start, where all rest.
    """

    coordinates: Array
    velocities: Array
    contact: Array
    slip_rate: Array | None = None
    load: Array | None = None
    load_rate: Array | None = None
    accelerations: Array | None = None
    sliding: tuple[bool, ...] = ()
