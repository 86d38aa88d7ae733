"""What every model of the engine has in common, whoever built it: coordinates, contacts, recorders, a way to start."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from multibody.loading import SymbolicGround
from multibody.units import Units
from reference.problem import State

Array = NDArray[np.float64]


@dataclass(frozen=True)
class EngineState:
    """One state of the engine in its own units: coordinates (n,), velocities (n,), contact data (c,)."""

    coordinates: Array
    velocities: Array
    contact: Array


@dataclass(frozen=True)
class Recorders:
    """Sensors read after a run: one per node for each quantity, one per contact for its data node, and its force."""

    coordinates: list[Any]
    velocities: list[Any]
    accelerations: list[Any]
    contact: list[Any]  # gap, slip speed, and two unused entries, per contact
    contact_force: list[Any]  # force vector and normal, per contact; empty unless asked for


@dataclass(frozen=True)
class EngineModel:
    """
    An assembled engine system that can be run again and again.

    bodies: (N, 3), index of the coordinate that moves body i along x, y, z. radius: of the sphere on which the
    platform's centre moves, in units of length, for the rim (4.1). keep_alive: what the engine only points to.
    """

    mbs: Any
    units: Units
    ground: SymbolicGround
    recorders: Recorders
    bodies: NDArray[np.int_]
    start: Callable[[State | None, Array], EngineState]  # from an initial state and the plate's acceleration then
    penetration: float
    slip_threshold: float  # speed in units of velocity under which the friction law is linear; inf if it always is
    keep_alive: tuple[Any, ...]
