"""One state of the engine, from which a run starts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class EngineState:
    """
    One state of the engine in its own units, relative to the plate.

    Attributes:
    - coordinates, velocities: (n,) arrays.
    - contact: Contact data, (c,).
    - slip_rate, load, load_rate: Rates of the contacts' slip speeds over the last step, their loads over their shares
      of the weight where friction depends on it, and the rates of these; None where there was no last step, (K,).
    - accelerations: (n,) where the engine is not to compute them; else None.
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
