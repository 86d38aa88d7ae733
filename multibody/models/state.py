"""One state of the engine, from which a run starts."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

AT_REST = np.zeros((3, 3))


@dataclass(frozen=True)
class EngineState:
    """One state of the engine in its own units, relative to the plate."""

    coordinates: Array  # (n,)
    velocities: Array  # (n,)
    contact: Array  # (c,), contact data
    plate: Array = field(default_factory=AT_REST.copy)  # (3, 3), its own displacement, velocity, acceleration
    slip_rate: Array | None = None  # (K,), of the contacts' slip speeds over the last step, where there was one
    load: Array | None = None  # (K,), of the contacts, over their shares of the weight, where friction depends on it
    load_rate: Array | None = None  # (K,), over the last step, where there was one
