"""
Spheres that turn on springs: friction that yields elastically before it slides.

The engine's contact slides between the surfaces of depression and sphere. A sphere that turns about its fixed center
moves its surface along the depression and nothing else, so that a torsion spring of stiffness k r^2 is a spring k in
series with friction alone, in the tangent plane and alike in all directions. A sphere that moved on a horizontal spring
would take the restoring force N x / rho along, and lengthen the pendulum by N / k.

Regularized friction below its limit would creep, and make the spring forget within u_y / v_reg. So every contact either
rests, with a coefficient far above the scene's, or slides. Where its spring reaches the limit it slides from there on,
and where its slip comes to zero it rests. v_reg counts in the last moment of a slide, and falls from level to level.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from multibody.models.depressions import Depressions, angular_velocity_matrix
from multibody.models.engine import BODY_COORDINATES, items
from multibody.models.speed_friction import DATA_PER_CONTACT, SLIP_INDEX
from multibody.models.state import EngineState
from multibody.models.units import Units
from reference.problem import DryFriction, Scene

Array = NDArray[np.float64]

# Moment of inertia of all spheres together over r^2: it adds as much to the mass that vibrates on the springs.
TURNING_MASS = 1e-9

# Mass and stiffness that hold the center of a sphere: it moves by 1e-10 rho under the weight, and does not resonate.
HELD_MASS, HELD_STIFFNESS = 1e8, 1e10

# Coefficient of a contact that rests over the scene's: it creeps by that share of v_reg.
RESTING = 1e6

# Slip speed at which a slide ends at level 0, over sqrt(mu g u_y): noise of the contact force turns a massless sphere
# by as much in short steps. What is left of the slide takes the spring beyond its limit, which is no yield.
END_OF_SLIDE = 0.1

# Excess of a spring over its limit at level 0, in yield displacements, that is no yield.
EXCESS = 1e-4

# v_reg over that speed.
REGULARIZED_SHARE = 0.25

# Change of the platform's velocity over the slip speed in one step that counts as much as a change of the springs.
SHARE_OF_SLIDE = 0.3

# Least elastic displacement that has a direction.
SMALLEST_DISPLACEMENT = 1e-300


class ContactChange(NamedTuple):
    """
    A contact that slides, or rests, from a share of the step behind `row` on.

    limits: elastic displacements (K,) that no spring at rest exceeds from there on, and that one which begins to slide
    has; None where a slide ends.
    """

    row: int
    contact: int
    share: float
    slides: bool
    limits: Array | None = None


@dataclass(frozen=True)
class FrictionSprings:
    """
    The springs that turn the spheres, in units of the model.

    turns: index of the rotations of each sphere, (K, 3). law: friction of the contacts. displacement: elastic one at
    which they slide under the weight. slide_end: slip speed at which slides end at level 0. Where steps are meant,
    `motion` is an `EngineMotion`.
    """

    mbs: Any
    contacts: list[Any]
    turns: NDArray[np.int_]
    depressions: Depressions
    law: DryFriction
    displacement: float
    slide_end: float

    def begin(self, state: EngineState) -> None:
        """Give every contact the coefficient with which it rests or slides from a state on."""
        for contact, factor in zip(self.contacts, self.factors(state)):
            self.mbs.SetObjectParameter(contact, "dynamicFriction", factor * self.law.largest)

    def factors(self, state: EngineState) -> list[float]:
        """Coefficients (K,) of the contacts over the scene's: all rest at the start."""
        return [1.0 if slides else RESTING for slides in self._sliding(state)]

    def set_slide_end(self, end: float) -> None:
        """Set the slip speed at which slides end."""
        for contact in self.contacts:
            self.mbs.SetObjectParameter(contact, "frictionProportionalZone", REGULARIZED_SHARE * end)

    def step_ratio(self, motion: Any, state: EngineState, end: float) -> Array:
        """Largest change in each step from `state`, (T,): of displacements over yield, of velocity over slip."""
        turned = np.linalg.norm(np.diff(motion.coordinates[:, self.turns], axis=0), axis=2).max(axis=1, initial=0.0)
        slip = np.maximum(motion.slip[1:], end)[:, self._sliding(state)].min(axis=1, initial=math.inf)
        turning = np.linalg.norm(np.diff(motion.velocities[:, :3], axis=0), axis=1) / slip
        changes = np.maximum(self.depressions.radius / self.displacement * turned, SHARE_OF_SLIDE * turning)
        return np.append(0.0, changes)

    def find_change(self, motion: Any, state: EngineState, end: float, begin: float) -> ContactChange | None:
        """Find the first contact that begins or ends to slide in steps from `state`; None without one."""
        if len(motion.time) < 2:
            return None
        time, slip, limit = motion.time, motion.slip, self.limits(motion)
        excess = self.depressions.radius * np.linalg.norm(motion.coordinates[:, self.turns], axis=2) - limit
        left = EXCESS * self.displacement * (end / self.slide_end) ** 2
        changes = []
        for number, slides in enumerate(self._sliding(state)):
            if slides:
                changes.append(_find_rest(number, slip[:, number] / end))
                continue
            change = _find_yield(number, excess[:, number] / left)
            if change is not None:
                row = change.row
                speed = (excess[row + 1, number] - excess[row, number]) / (time[row + 1] - time[row])
                if speed > begin:
                    change = change._replace(limits=limit[row])
                else:
                    change = ContactChange(row + 1, number, 0.0, False, limit[row + 1])
            changes.append(change)
        return min((change for change in changes if change is not None), default=None)

    def limits(self, motion: Any) -> Array:
        """Elastic displacements at which the contacts slide, (T, K)."""
        load = motion.load
        speed = np.linalg.norm(motion.velocities[:, :3], axis=1)[:, None]
        limit: Array = self.displacement * self.law.at(speed, load) / self.law.largest * load
        return limit

    def settle(
        self,
        state: EngineState,
        before: EngineState,
        accelerations: Array,
        rates_of_limits: Array,
        end: float,
        change: ContactChange | None = None,
    ) -> EngineState:
        """
        Return the state to go on from after steps from `before`, with accelerations (n,), rates (K,) of limits there.

        The rates of the spheres are those of contacts that rest or slide: what the steps leave of massless spheres
        alternates behind every kink. change: what happens there.
        """
        sliding = np.array(self._sliding(before))
        if change is not None and change.limits is not None:
            coordinates = state.coordinates.copy()
            for number in np.flatnonzero(~sliding).tolist():
                size = self.depressions.radius * float(np.linalg.norm(coordinates[self.turns[number]]))
                factor = float(change.limits[number]) / max(size, SMALLEST_DISPLACEMENT)
                begins = change.slides and number == change.contact
                coordinates[self.turns[number]] *= factor if begins else min(factor, 1.0)
            state = replace(state, coordinates=coordinates)
        velocities, accelerations, contact = state.velocities.copy(), accelerations.copy(), state.contact.copy()
        normals, jacobian = self.depressions.contact_normals_and_jacobian(state.coordinates)
        turning = np.eye(BODY_COORDINATES)
        turning[3:, 3:] = angular_velocity_matrix(state.coordinates[3:6])
        speeds, rates = (jacobian @ turning @ values[:BODY_COORDINATES] for values in (velocities, accelerations))
        if len(self.depressions.vertical):
            speeds[:, 2] -= velocities[self.depressions.vertical]
        for number, (turn, normal) in enumerate(zip(self.turns, normals)):
            surface = np.cross(state.coordinates[turn], normal)
            along = surface / max(float(np.linalg.norm(surface)), SMALLEST_DISPLACEMENT)
            slip = float(speeds[number] @ along - rates_of_limits[number])
            if change is not None and change.contact == number:
                sliding[number] = change.slides
            else:
                sliding[number] = sliding[number] and slip > end
            if sliding[number]:
                slip, rates[number] = max(slip, end), 0.0
            else:
                slip = 0.0
            contact[DATA_PER_CONTACT * number + SLIP_INDEX] = slip
            velocities[turn] = np.cross(normal, speeds[number] - slip * along) / self.depressions.radius
            accelerations[turn] = np.cross(normal, rates[number]) / self.depressions.radius
        return replace(
            state, velocities=velocities, contact=contact, accelerations=accelerations, sliding=tuple(sliding.tolist())
        )

    def rest(self, state: EngineState) -> EngineState:
        """Return the state with all contacts at rest."""
        assert state.accelerations is not None  # settled
        resting = replace(state, sliding=(False,) * len(self.contacts))
        return self.settle(resting, resting, state.accelerations, np.zeros(len(self.contacts)), math.inf)

    def _sliding(self, state: EngineState) -> tuple[bool, ...]:
        """Whether each contact slides: none does at the start."""
        return state.sliding or (False,) * len(self.contacts)


def _find_yield(contact: int, excess: Array) -> ContactChange | None:
    """Find the step in which the excess (T,) of a spring over its limit, in units of what is no yield, passes zero."""
    rows = np.flatnonzero((excess[1:] > 1.0) & (excess[1:] > excess[:-1]))
    if not len(rows):
        return None
    before, after = excess[rows[0] : rows[0] + 2].tolist()
    return ContactChange(int(rows[0]), contact, max(-before, 0.0) / (after - min(before, 0.0)), slides=True)


def _find_rest(contact: int, slip: Array) -> ContactChange | None:
    """Find the step in which the slip speed (T,), over that of the end, would pass zero if it fell as in the last."""
    rows = np.flatnonzero((2.0 * slip[1:] <= slip[:-1]) | ((slip[1:] <= 1.0) & (slip[1:] < slip[:-1])))
    if not len(rows):
        return None
    before, after = slip[rows[0] : rows[0] + 2].tolist()
    return ContactChange(int(rows[0]) + 1, contact, min(after / (before - after), 1.0), slides=False)


def make_friction_springs(
    mbs: Any, scene: Scene, units: Units, contacts: list[Any], first: int, depressions: Depressions
) -> FrictionSprings | None:
    """Return the springs under `contacts` whose spheres have the coordinates from `first` on; None in a rigid scene."""
    if not scene.dry_friction.elastic:
        return None
    turns = first + BODY_COORDINATES * np.arange(len(contacts))[:, None] + np.arange(3, BODY_COORDINATES)
    law = scene.dry_friction.in_unit_of_speed(units.velocity)
    return FrictionSprings(
        mbs,
        contacts,
        turns,
        depressions,
        law,
        scene.yield_displacement / units.length,
        end_of_slide(scene, units),
    )


def end_of_slide(scene: Scene, units: Units) -> float:
    """Slip speed at which a slide ends at level 0 where friction yields, in units of velocity."""
    return END_OF_SLIDE * math.sqrt(scene.friction_coefficient * scene.yield_displacement / units.length)


@dataclass(frozen=True)
class TurningSpheres:
    """Markers of spheres that turn, the engine's object on their coordinates, and the matrices of that, (n, n)."""

    markers: list[Any]
    bodies: list[Any]
    stiffness: Array
    damping: Array

    @property
    def coordinates(self) -> int:
        """Number of their coordinates."""
        return len(self.stiffness)


def add_turning_spheres(
    mbs: Any, scene: Scene, units: Units, places: Array, radius: float, moved: float = 0.0
) -> TurningSpheres:
    """
    Add spheres that turn on springs at places (K, 2), a length of one above the depressions; none in a rigid scene.

    moved: mass of all spheres where they can move vertically, pressed upwards by the weight.
    """
    if not scene.dry_friction.elastic:
        return TurningSpheres([], [], np.zeros((0, 0)), np.zeros((0, 0)))
    count = len(places)
    rest = [[*place, 1.0, 0.0, 0.0, 0.0] for place in places]
    nodes = [mbs.AddNode(items.NodeRigidBodyRxyz(referenceCoordinates=place)) for place in rest]
    turning = scene.dry_friction.stiffness * units.length / units.force * radius**2 / count
    mass = np.tile([HELD_MASS] * 3 + [TURNING_MASS * radius**2 / count] * 3, count)
    stiffness = np.tile([HELD_STIFFNESS] * 3 + [turning] * 3, count)
    damping = np.tile([2.0 * np.sqrt(HELD_MASS * HELD_STIFFNESS)] * 3 + [0.0] * 3, count)
    upward = np.zeros(len(mass))
    if moved:
        vertical = 2 + BODY_COORDINATES * np.arange(count)
        mass[vertical], stiffness[vertical], damping[vertical], upward[vertical] = moved / count, 0.0, 0.0, 1.0 / count
    matrices = np.diag(stiffness), np.diag(damping)
    spheres = items.ObjectGenericODE2(
        nodeNumbers=nodes,
        massMatrix=np.diag(mass),
        stiffnessMatrix=matrices[0],
        dampingMatrix=matrices[1],
        forceVector=upward,
    )
    markers = [mbs.AddMarker(items.MarkerNodeRigid(nodeNumber=node)) for node in nodes]
    return TurningSpheres(markers, [mbs.AddObject(spheres)], *matrices)
