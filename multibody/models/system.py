"""What every model of the engine has in common, whoever built it: coordinates, contacts, recorders, a way to start."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from multibody.models.loading import Ground
from multibody.models.units import Units
from reference.problem import State

Array = NDArray[np.float64]


AT_REST = np.zeros((3, 3))


@dataclass(frozen=True)
class EngineState:
    """
    One state of the engine in its own units: coordinates (n,), velocities (n,), contact data (c,).

    The first two relative to the plate; plate: its own displacement, velocity, acceleration, (3, 3).
    """

    coordinates: Array
    velocities: Array
    contact: Array
    plate: Array = field(default_factory=AT_REST.copy)


@dataclass(frozen=True)
class Recorders:
    """Sensors read after a run: one per node for each quantity, one per contact for its data node, and its force."""

    coordinates: list[Any]
    velocities: list[Any]
    accelerations: list[Any]
    contact: list[Any]  # gap, slip speed, and two unused entries, per contact
    contact_force: list[Any]  # force vector and normal, per contact; empty unless asked for
    plate: list[Any]  # displacement, velocity, acceleration of a plate that moves; empty without


@dataclass(frozen=True)
class EngineModel:
    """
    An assembled engine system that can be run again and again.

    bodies: (N, 3), index of the coordinate that moves body i along x, y, z. stiffen: sets the contact so that the
    weight presses it in by a given fraction of rho, and the supports so that warping gives way by another one. start:
    state from an initial state (None: at rest), the plate's acceleration then, m/s^2, and the first fraction. settle:
    state to go on from with a smaller step, from the last one, the rate of each gap (K,) and the first fraction. rim:
    largest rise of the platform, in units of length. corner: slip speed in units of velocity under which the friction
    law is linear; inf if it has no such corner. relaxation: time in which a slip below it dies out, in units of time;
    inf likewise. rounding: of a contact force times its penetration, in units of weight times length. moving_plate:
    whether the loading moves the plate, whose coordinates are then the system's last. carried: (C, 3), index of the
    coordinates that the plate carries along x, y, z. keep_alive: the engine's container of the system, and what the
    engine only points to. liftoff: whether the model goes on when every contact is open. slippery: takes the friction
    away, or gives it back; None if the start needs no balance. warped: how far the supports of coordinates (T, n) are
    from a plane, (T,), in units of length; None if the model has no supports that share the load. bearings: penetration
    by the weight that the scene states, in units of length, or 0.
    """

    mbs: Any
    units: Units
    ground: Ground
    recorders: Recorders
    bodies: NDArray[np.int_]
    stiffen: Callable[..., None]
    start: Callable[[State | None, Array, float], EngineState]
    settle: Callable[[EngineState, Array, float], EngineState]
    rim: float
    corner: float
    relaxation: float
    rounding: float
    moving_plate: bool
    carried: NDArray[np.int_]
    keep_alive: tuple[Any, ...]
    liftoff: bool = False
    slippery: Callable[[bool], None] | None = None
    warped: Callable[[Array], Array] | None = None
    bearings: float = 0.0

    @property
    def container(self) -> Any:
        """The engine's container of the system."""
        return self.keep_alive[0]

    @property
    def coordinates(self) -> int:
        """Number of the system's coordinates."""
        return int(self.mbs.systemData.ODE2Size())
