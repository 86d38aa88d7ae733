"""What every model of the engine has in common: coordinates, contacts, recorders, a way to start."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from multibody.models.depressions import Depressions
from multibody.models.impact import ImpactLaw
from multibody.models.loading import Ground
from multibody.models.speed_friction import SpeedFriction
from multibody.models.state import EngineState
from multibody.models.units import Units
from reference.problem import State

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Recorders:
    """Sensors that are read after a run."""

    coordinates: list[Any]  # per node
    velocities: list[Any]  # per node
    accelerations: list[Any]  # per node
    contact: list[Any]  # gap, slip speed, and two unused entries, per contact
    contact_force: list[Any]  # force vector and normal, per contact; empty unless asked for
    plate: list[Any]  # displacement, velocity, acceleration of a plate that moves; else empty


@dataclass(frozen=True)
class EngineModel:
    """An assembled engine system that can be run again and again, in units of `units`."""

    mbs: Any  # the engine's system
    units: Units
    ground: Ground  # the loading
    recorders: Recorders
    bodies: NDArray[np.int_]  # (N, 3), index of the coordinate that moves body i along x, y, z
    # sets the contact's penetration under the weight, of rho, and by how much of rho warping of the supports gives way
    set_contact: Callable[..., None]
    # state from an initial state (None: at rest), the plate's acceleration then, m/s^2, and the penetration
    start: Callable[[State | None, Array, float], EngineState]
    # state to go on from with a smaller step, from the last one, the rate of each gap (K,) and the penetration
    settle: Callable[[EngineState, Array, float], EngineState]
    corner: float  # slip speed under which the friction law is linear; inf if it has no such corner
    relaxation: float  # time in which a slip below the corner dies out; inf likewise
    rounding: float  # of a contact force times its penetration, in units of weight times length
    moving_plate: bool  # whether the loading moves the plate, whose coordinates are then the system's last
    carried: NDArray[np.int_]  # (C, 3), index of the coordinates that the plate carries along x, y, z
    references: tuple[Any, ...]  # the engine's container of the system, and what the engine only points to
    allows_liftoff: bool = False  # whether the model goes on when every contact is open
    depressions: Depressions | None = None  # of a platform that turns
    travel: float = math.inf  # largest displacement of the platform that the isolator permits, in units of length
    critical_tilt: float = math.inf  # rad, of the platform, beyond which its weight turns it over
    impact: ImpactLaw | None = None  # of contacts that close; None: their own stiffness decides
    # damping over stiffness of each link along its bars, (N - 1,), in units of time, for a penetration of the contacts
    bar_lags: Callable[[float], Array] | None = None
    # takes contacts (K,) out of the engine, whose penetration is given, and puts the others in
    take_out_open_contacts: Callable[[NDArray[np.bool_], float], None] | None = None
    # of bodies that turn, and of their contacts and stiff links; None: the model starts in balance by itself
    kinematics: ImpactLaw | None = None
    # distance of the supports from a plane, (T,), for coordinates (T, n); None if the supports do not share the load
    warping_displacement: Callable[[Array], Array] | None = None
    bearing_penetration: float = 0.0  # by the weight, as the scene's bearings state it, or 0
    friction: SpeedFriction | None = None  # of contacts whose friction depends on slip speed or load
    rim: float = 1.0  # displacement of the platform at which it reaches the rim; inf on a plane
    fastest_bar_frequency: float = 0.0  # largest angular frequency that bars make which give way; 0 without such bars

    @property
    def container(self) -> Any:
        """The engine's container of the system."""
        return self.references[0]

    @property
    def coordinates(self) -> int:
        """Number of the system's coordinates."""
        return int(self.mbs.systemData.ODE2Size())
