"""Assembled model of the engine: its coordinates, contacts, recorders and initial state."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from multibody.models.depressions import Depressions
from multibody.models.friction_springs import FrictionSprings
from multibody.models.impact import ImpactLaw
from multibody.models.loading import Ground
from multibody.models.speed_friction import SpeedFriction
from multibody.models.state import EngineState
from multibody.models.units import Units
from reference.problem import State

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Recorders:
    """
    Sensors of a model that are read after a run.

    coordinates, velocities, accelerations: one sensor for each node. contact: gap, slip speed and two unused entries of
    each contact. contact_force: force vector and normal of each contact; empty unless requested.
    """

    coordinates: list[Any]
    velocities: list[Any]
    accelerations: list[Any]
    contact: list[Any]
    contact_force: list[Any]


@dataclass(frozen=True)
class EngineModel:
    """
    Model assembled in the engine, which can be run any number of times; its quantities are in units of `units`.

    Attributes:
    - mbs: The engine's system.
    - ground: Acceleration of the plate.
    - bodies: Index of the coordinate that moves each body along x, y, z, (N, 3).
    - set_contact: Sets the contact's penetration under the weight and the compliance of the supports against warping.
    - start: Returns the state for an initial state (None: at rest), the plate's acceleration then, m/s^2, and the
      penetration.
    - settle: Returns the state to continue from with a smaller step, for the last state, the rates (K,) of the gaps and
      the penetration.
    - corner, relaxation: Slip speed below which the friction law is linear, and the relaxation time of such a slip; inf
      if the law has no such corner.
    - rounding: Rounding error of a contact force times its penetration, in units of weight times length.
    - references: The engine's container of the system, and objects that must stay alive because the engine points to
      them.
    - allows_liftoff: Whether a run continues when every contact is open.
    - depressions: Depressions of a platform that turns.
    - travel: Largest displacement of the platform that the isolator permits.
    - critical_tilt: Tilt of the platform, rad, beyond which its weight turns it over.
    - impact: Impact law of contacts that close; None in the translational model, and on bearings of stated stiffness.
    - bar_damping_times: Returns damping over stiffness of each link along its bars, (N - 1,), in units of time, for a
      penetration.
    - take_out_open_contacts: Takes contacts (K,) out of the engine, whose penetration is given, and puts the others in.
    - kinematics: Kinematics of bodies that turn, of their contacts and stiff links; None where no body turns, so that
      the initial state needs no search for equilibrium.
    - warping_displacement: Returns the distance of the supports from a plane, (T,), for coordinates (T, n); None where
      the supports do not share the load.
    - bearing_penetration: Penetration under the weight as the scene's bearings state it, or 0.
    - friction: Friction that depends on slip speed or load.
    - springs: Springs on which the spheres turn where friction yields; None for rigid friction.
    - rim: Displacement of the platform at which it reaches the rim; inf on a plane.
    - fastest_bar_frequency: Largest angular frequency of the bodies on elastic bars; 0 without such bars.
    """

    mbs: Any
    units: Units
    ground: Ground
    recorders: Recorders
    bodies: NDArray[np.int_]
    set_contact: Callable[..., None]
    start: Callable[[State | None, Array, float], EngineState]
    settle: Callable[[EngineState, Array, float], EngineState]
    corner: float
    relaxation: float
    rounding: float
    references: tuple[Any, ...]
    allows_liftoff: bool = False
    depressions: Depressions | None = None
    travel: float = math.inf
    critical_tilt: float = math.inf
    impact: ImpactLaw | None = None
    bar_damping_times: Callable[[float], Array] | None = None
    take_out_open_contacts: Callable[[NDArray[np.bool_], float], None] | None = None
    kinematics: ImpactLaw | None = None
    warping_displacement: Callable[[Array], Array] | None = None
    bearing_penetration: float = 0.0
    friction: SpeedFriction | None = None
    springs: FrictionSprings | None = None
    rim: float = 1.0
    fastest_bar_frequency: float = 0.0

    @property
    def container(self) -> Any:
        """The engine's object that owns the system."""
        return self.references[0]

    @property
    def coordinates(self) -> int:
        """Number of coordinates of the system."""
        return int(self.mbs.systemData.ODE2Size())
