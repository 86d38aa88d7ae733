"""
The start of a model whose bodies turn: at rest in the static equilibrium of its weight, its stiff parts in balance.

Supports that start with equal shares are out of balance by the overturning moment. They would swing for a few of the
contact's own periods, with an acceleration that no stiffness makes smaller. An eccentric building on elastic supports
tilts, and as it tilts it shifts, so that every depression stays on its sphere. So the engine's forces are solved
for zero by Newton's method, first under the weight alone and for all coordinates. Then the loading's first value joins
it. Contacts, springs of spheres and stiff links give way to it until no force accelerates their deformation. The slow
motions, which deform none of them, start from where they were. A support that would have to pull carries nothing. A
loading that is gone before a contact swings is nothing they could give way to.

Friction is zero at rest. On a plane nothing else holds the platform, which keeps its place there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag, null_space

from multibody.integration.constant_step import set_initial_state
from multibody.integration.openings import GAP_TOLERANCE, OPENING_GAP
from multibody.models.engine import exudyn
from multibody.models.impact import ImpactLaw
from multibody.models.state import EngineState
from multibody.models.system import EngineModel

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

# Largest number of iterations of Newton's method.
MAX_ITERATIONS = 50

# Largest residual of the forces, in weights, to which their rounding is added with a safety factor for many contacts
# and stiff links.
MAX_RESIDUAL = 1e-9
SAFETY_OF_RESIDUAL = 100.0

CURRENT = exudyn.ConfigurationType.Current


def find_balanced_start(
    model: EngineModel, start: EngineState, acceleration: Array, penetration: float
) -> EngineState | None:
    """Find the equilibrium near `start` under the plate's acceleration (3,); `start` if none is needed, else None."""
    if model.kinematics is None:
        return start
    pressed = model.bearing_penetration or penetration
    balance = _Balance(model, model.kinematics, start, acceleration, pressed, penetration)
    coordinates, closed = balance.solve_under_weight(), np.ones(len(model.kinematics.depressions.ring), dtype=bool)
    lasts = model.ground.decay_rate * math.sqrt(pressed) <= 1.0
    while coordinates is not None and lasts and acceleration.any():
        loaded = balance.solve_under_loading(coordinates, closed)
        opens = False if loaded is None else closed & (balance.gaps(loaded) > OPENING_GAP * pressed)
        if not np.any(opens):
            coordinates = loaded
            break
        closed = closed & ~opens
    if coordinates is None:
        return None
    gaps, contact = balance.gaps(coordinates), start.contact.copy()
    contact[0::4] = np.where(closed, np.minimum(gaps, -GAP_TOLERANCE * pressed), np.maximum(gaps, 0.0))
    return EngineState(coordinates, start.velocities, contact)


@dataclass
class _Balance:
    """
    The engine's forces on a model at rest, and the coordinates at which they balance.

    acceleration: of the plate, (3,). pressed: penetration of the contacts under the weight. penetration: of the level.
    """

    model: EngineModel
    kinematics: ImpactLaw
    start: EngineState
    acceleration: Array
    pressed: float
    penetration: float

    def __post_init__(self) -> None:
        settings = exudyn.SimulationSettings()
        settings.timeIntegration.verboseMode = 0
        settings.solution.file.write = False
        set_initial_state(self.model, self.start)
        self.model.ground.begin(0.0)
        self._solver = exudyn.MainSolverImplicitSecondOrder()
        self._solver.InitializeSolver(self.model.mbs, settings)
        self._size = len(self.start.coordinates)
        self._carried = np.zeros(self._size)
        self._carried[self.model.bodies] = self.acceleration
        rounding = self.model.rounding / self.penetration
        self._limit = MAX_RESIDUAL + SAFETY_OF_RESIDUAL * rounding

    def gaps(self, coordinates: Array) -> Array:
        """Gaps (K,) of the contacts at coordinates (n,)."""
        clear: Array = self.kinematics.depressions.clearance(coordinates[None])[0] - self.pressed
        return clear

    def solve_under_weight(self) -> Array | None:
        """Solve for the coordinates (n,) of the static equilibrium; None without one."""
        held = np.eye(self._size)[:, self._neutral_coordinates()]
        closed = np.ones(len(self.kinematics.depressions.ring), dtype=bool)
        return self._solve_balance(self.start.coordinates, null_space(held.T), held, closed, 0.0)

    def solve_under_loading(self, equilibrium: Array, closed: Mask) -> Array | None:
        """Solve for the coordinates (n,) at which the loading deforms what is stiff, with closed contacts (K,)."""
        mass = self._compute_mass_matrix(equilibrium)
        stiff = self.kinematics.stiff_rates(equilibrium, np.ones_like(closed))
        spheres = self._size - stiff.shape[1]
        deformed = np.asarray(np.linalg.solve(mass, block_diag(stiff, np.eye(spheres)).T), dtype=float)
        slow_of_bodies = null_space(self.kinematics.stiff_rates(equilibrium, closed))
        slow = np.vstack([slow_of_bodies, np.zeros((spheres, slow_of_bodies.shape[1]))])
        return self._solve_balance(equilibrium, deformed, mass @ slow, closed, 1.0)

    def _neutral_coordinates(self) -> list[int]:
        """Coordinates that nothing but friction holds: place and yaw of a platform on a plane."""
        first = int(self.model.bodies[0, 0])
        return [first, first + 1, first + 5] if self.model.rim == math.inf else []

    def _solve_balance(self, begin: Array, moved: Array, held: Array, closed: Mask, loading: float) -> Array | None:
        """Solve for coordinates, from `begin` along `moved` (n, s), at which only forces `held` (n, t) are missing."""
        # Newton's method on the engine's own forces and their derivative, in the coordinates that may move and the
        # forces that may be left over, which hold the slow motions. Open contacts add the equations that they just
        # touch, so that a contact that would have to pull carries nothing. The matrix may be singular where friction
        # alone holds a platform on a plane, hence least squares. Iterations go on behind the bound of the residual
        # until they no longer halve it: rounding is reached then.
        moved, _ = np.linalg.qr(moved)
        coordinates, missing = begin, np.zeros(held.shape[1])
        before = math.inf
        for _ in range(MAX_ITERATIONS):
            forces, stiffness = self._compute_forces(coordinates, closed, loading)
            touching = self.gaps(coordinates)[~closed] / self.pressed
            residual = np.append(forces - held @ missing, touching)
            worst = float(np.abs(residual).max())
            if not math.isfinite(worst):
                return None
            if worst <= self._limit and worst > 0.5 * before:
                return coordinates
            before = worst
            rates = self.kinematics.gap_rates(coordinates)[~closed] / self.pressed
            matrix = np.block([[stiffness @ moved, -held], [rates @ moved, np.zeros((len(rates), len(missing)))]])
            change = np.linalg.lstsq(matrix, -residual, rcond=None)[0]
            coordinates = coordinates + moved @ change[: moved.shape[1]]
            missing = missing + change[moved.shape[1] :]
        return None

    def _compute_mass_matrix(self, coordinates: Array) -> Array:
        """Compute the engine's mass matrix (n, n)."""
        self._set_coordinates(coordinates)
        self._solver.ComputeMassMatrix(self.model.mbs, 1.0)
        return np.array(self._solver.GetSystemMassMatrix())

    def _compute_forces(self, coordinates: Array, closed: Mask, loading: float) -> tuple[Array, Array]:
        """Compute forces (n,) under the weight and a share of the loading's first value, and their Jacobian (n, n)."""
        shaken = self._compute_mass_matrix(coordinates) @ self._carried
        contact = np.zeros_like(self.start.contact)
        a_gap_of_a_closed_contact = -1.0
        contact[0::4] = np.where(closed, a_gap_of_a_closed_contact, 0.0)
        self._set_coordinates(coordinates)
        mbs = self.model.mbs
        mbs.systemData.SetDataCoordinates(contact, configuration=CURRENT)
        self._solver.ComputeODE2RHS(mbs)
        forces = np.array(self._solver.GetSystemResidual())
        self._solver.ComputeJacobianODE2RHS(mbs, 1.0, 0.0, 0.0)
        already_loads = 1.0
        return forces - (loading - already_loads) * shaken, np.array(self._solver.GetSystemJacobian())

    def _set_coordinates(self, coordinates: Array) -> None:
        self.model.mbs.systemData.SetODE2Coordinates(coordinates, configuration=CURRENT)
