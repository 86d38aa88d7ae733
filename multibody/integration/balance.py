"""
Initial state of a model whose bodies turn: at rest in static equilibrium under its weight, with stiff parts balanced.

Supports that start with equal shares of the weight are out of balance by the overturning moment. They would oscillate
for a few periods of the contact, with an acceleration that does not depend on its stiffness. An eccentric building on
elastic supports tilts, and as it tilts it shifts, so that every depression stays on its sphere. So Newton's method
finds the coordinates at which the engine's forces are zero, first under the weight alone and for all coordinates, then
also under the initial loading. Contacts, springs of spheres and stiff links deform under this loading until no force
accelerates their deformation. Slow motions, which deform none of these parts, start from the first equilibrium. A
support that would have to pull carries no force. A loading that decays faster than a contact oscillates is left out.

Friction is zero at rest. On a plane no other force holds the platform, so that its position stays as it is.
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

# Largest number of iterations of Newton's method: after them the equilibrium counts as not found.
MAX_ITERATIONS = 50

# Largest residual of the forces, in weights, at which Newton's iteration may end. The rounding error of the forces
# times SAFETY_OF_FORCE_ROUNDING is added to it.
MAX_RESIDUAL = 1e-9
SAFETY_OF_FORCE_ROUNDING = 100.0  # factor on the rounding error of forces, for many contacts and stiff links

CURRENT_CONFIGURATION = exudyn.ConfigurationType.Current  # the engine's name for its present state


def find_balanced_start(
    model: EngineModel, start: EngineState, acceleration: Array, penetration: float
) -> EngineState | None:
    """
    Return the equilibrium near `start` under the weight and the initial acceleration of the ground plate, (3,).

    It is None if none is found, and `start` itself if no body rotates. penetration: of the contacts by the weight.
    """
    if model.kinematics is None:
        return start
    static_penetration = model.bearing_penetration or penetration
    balance = _EquilibriumSolver(model, model.kinematics, start, acceleration, static_penetration, penetration)
    coordinates, closed = balance.solve_under_weight(), np.ones(len(model.kinematics.depressions.ring), dtype=bool)
    followed = follows_decay(model, static_penetration)
    while coordinates is not None and followed and acceleration.any():
        loaded = balance.solve_under_loading(coordinates, closed)
        opens = False if loaded is None else closed & (balance.gaps(loaded) > OPENING_GAP * static_penetration)
        if not np.any(opens):
            coordinates = loaded
            break
        closed = closed & ~opens
    if coordinates is None:
        return None
    gaps, contact = balance.gaps(coordinates), start.contact.copy()
    contact[0::4] = np.where(closed, np.minimum(gaps, -GAP_TOLERANCE * static_penetration), np.maximum(gaps, 0.0))
    return EngineState(coordinates, start.velocities, contact)


def follows_decay(model: EngineModel, penetration: float) -> bool:
    """Return whether a contact with this penetration under the weight oscillates faster than the loading decays."""
    return model.ground.decay_rate * math.sqrt(penetration) <= 1.0


@dataclass
class _EquilibriumSolver:
    """
    Solver for the coordinates at which the engine's forces on a model at rest balance.

    acceleration: initial acceleration of the plate, (3,). static_penetration: penetration of the contacts under the
    weight. penetration: penetration of the level of accuracy.
    """

    model: EngineModel
    kinematics: ImpactLaw
    start: EngineState
    acceleration: Array
    static_penetration: float
    penetration: float

    def __post_init__(self) -> None:
        """Set up the engine's solver, the accelerations of the coordinates and the bound of the residual."""
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
        self._limit = MAX_RESIDUAL + SAFETY_OF_FORCE_ROUNDING * rounding

    def gaps(self, coordinates: Array) -> Array:
        """Return the gaps (K,) of the contacts at coordinates (n,)."""
        clear: Array = self.kinematics.depressions.clearance(coordinates[None])[0] - self.static_penetration
        return clear

    def solve_under_weight(self) -> Array | None:
        """Solve for the coordinates (n,) of the static equilibrium under the weight; return None if there is none."""
        held = np.eye(self._size)[:, self._neutral_coordinates()]
        closed = np.ones(len(self.kinematics.depressions.ring), dtype=bool)
        return self._solve_balance(self.start.coordinates, null_space(held.T), held, closed, 0.0)

    def solve_under_loading(self, equilibrium: Array, closed: Mask) -> Array | None:
        """Solve for the coordinates (n,) at which stiff links and closed contacts (K,) balance the loading at rest."""
        # Only stiff parts may deform: the coordinates move along M^-1 B^T, the response to forces on these parts, where
        # B maps velocities to rates of deformation. All slower motions, which deform no closed contact and no stiff
        # link, stay in place, held by inertia forces M v along each of them.
        mass = self._compute_mass_matrix(equilibrium)
        stiff = self.kinematics.stiff_deformation_rates(equilibrium, np.ones_like(closed))
        spheres = self._size - stiff.shape[1]
        deformed = np.asarray(np.linalg.solve(mass, block_diag(stiff, np.eye(spheres)).T), dtype=float)
        slow_of_bodies = null_space(self.kinematics.stiff_deformation_rates(equilibrium, closed))
        slow = np.vstack([slow_of_bodies, np.zeros((spheres, slow_of_bodies.shape[1]))])
        return self._solve_balance(equilibrium, deformed, mass @ slow, closed, 1.0)

    def _neutral_coordinates(self) -> list[int]:
        """Return the coordinates that friction alone holds: x, y and yaw of a platform on a plane."""
        return [0, 1, 5] if self.model.rim == math.inf else []

    def _solve_balance(self, begin: Array, moved: Array, held: Array, closed: Mask, loading: float) -> Array | None:
        """
        Find the coordinates (n,) in balance, from `begin` on; None if Newton's method finds none.

        moved: directions, as columns (n, s), in which the coordinates may move. held: directions, as columns (n, t), in
        which reactions act. closed: mask (K,) of closed contacts. loading: share of the initial loading that acts.
        """
        # Newton's method is applied to the engine's own forces and their Jacobian. The unknowns are displacements along
        # `moved` and forces along `held`, which hold the slow motions in place. A contact that would have to pull
        # counts as open: it carries no force, and its gap is set to zero instead. The matrix may be singular where
        # friction alone holds a platform on a plane, hence least squares. Iterations continue below the bound of the
        # residual until they no longer halve it, because of rounding.
        moved, _ = np.linalg.qr(moved)
        coordinates, missing = begin, np.zeros(held.shape[1])
        before = math.inf
        for _ in range(MAX_ITERATIONS):
            forces, stiffness = self._compute_forces(coordinates, closed, loading)
            touching = self.gaps(coordinates)[~closed] / self.static_penetration
            residual = np.append(forces - held @ missing, touching)
            worst = float(np.abs(residual).max())
            if not math.isfinite(worst):
                return None
            if worst <= self._limit and worst > 0.5 * before:
                return coordinates
            before = worst
            rates = self.kinematics.gap_rates(coordinates)[~closed] / self.static_penetration
            matrix = np.block([[stiffness @ moved, -held], [rates @ moved, np.zeros((len(rates), len(missing)))]])
            change = np.linalg.lstsq(matrix, -residual, rcond=None)[0]
            coordinates = coordinates + moved @ change[: moved.shape[1]]
            missing = missing + change[moved.shape[1] :]
        return None

    def _compute_mass_matrix(self, coordinates: Array) -> Array:
        """Return the engine's mass matrix (n, n) at coordinates (n,)."""
        self._set_coordinates(coordinates)
        self._solver.ComputeMassMatrix(self.model.mbs, 1.0)
        return np.array(self._solver.GetSystemMassMatrix())

    def _compute_forces(self, coordinates: Array, closed: Mask, loading: float) -> tuple[Array, Array]:
        """Compute forces (n,) under the weight and `loading` times the initial loading, and their Jacobian (n, n)."""
        shaken = self._compute_mass_matrix(coordinates) @ self._carried
        contact = np.zeros_like(self.start.contact)
        a_gap_of_a_closed_contact = -1.0
        contact[0::4] = np.where(closed, a_gap_of_a_closed_contact, 0.0)
        self._set_coordinates(coordinates)
        mbs = self.model.mbs
        mbs.systemData.SetDataCoordinates(contact, configuration=CURRENT_CONFIGURATION)
        self._solver.ComputeODE2RHS(mbs)
        forces = np.array(self._solver.GetSystemResidual())
        self._solver.ComputeJacobianODE2RHS(mbs, 1.0, 0.0, 0.0)
        already_loads = 1.0  # share of the initial loading that the engine's forces contain
        return forces - (loading - already_loads) * shaken, np.array(self._solver.GetSystemJacobian())

    def _set_coordinates(self, coordinates: Array) -> None:
        """Set the engine's present coordinates, in units of the model."""
        self.model.mbs.systemData.SetODE2Coordinates(coordinates, configuration=CURRENT_CONFIGURATION)
