"""
Spheres that turn on springs: friction that yields elastically before it slides.

The engine's contact slides between the surfaces of depression and sphere. A sphere that turns about its fixed center
moves its surface along the depression and nothing else, so that a torsion spring of stiffness k r^2 is a spring k in
series with friction alone, in the tangent plane and alike in all directions. A sphere that moved on a horizontal spring
would take the restoring force N x / rho along, and lengthen the pendulum by N / k.

Regularized friction below its limit would creep, so that the spring would relax within u_y / v_reg. So every contact
either rests, with a coefficient far above the scene's, or slides. It begins to slide when its spring reaches the limit,
and rests when its slip comes to zero. v_reg acts only at the end of a slide, and falls from level to level.
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

# Moment of inertia of all spheres, divided by the square of their radius and the total mass: so small a share is added
# to the mass that vibrates on the springs.
ROTATIONAL_MASS = 1e-9

# Mass and stiffness, in units of the model, with which a sphere's center stays in place: it sinks by 1e-10 rho under
# the weight and does not resonate.
CENTER_MASS, CENTER_STIFFNESS = 1e8, 1e10

# Ratio of the friction coefficient of a contact at rest to the scene's: it creeps at v_reg divided by this ratio.
RESTING_COEFFICIENT_RATIO = 1e6

# Slip speed at which a slide ends at level 0, the coarsest level of accuracy, as a multiple of sqrt(mu g u_y), with
# friction coefficient mu and yield displacement u_y. In short steps the noise of the contact force makes as much slip.
# What is left of the slide stretches the spring beyond its limit, and this does not count as yield.
SLIDE_END_SPEED_RATIO = 0.1

# Largest elongation beyond a spring's limit, over yield displacement, at which a contact rests at accuracy level 0.
NEGLIGIBLE_EXCESS = 1e-4

# Ratio of v_reg, the slip speed below which friction of a sliding contact is linear, to the speed at which slides end.
V_REG_OVER_SLIDE_END = 0.25

# Weight, in `FrictionSprings.step_ratio`, of the platform's change of velocity; the change of springs has weight 1.
VELOCITY_CHANGE_WEIGHT = 0.3

# Smallest elastic displacement by which a vector is divided: the direction of a smaller one is arbitrary.
SMALLEST_DISPLACEMENT = 1e-300


class ContactChange(NamedTuple):
    """
    Start or end of a contact's slide, in the step after a motion's `row`, at the share `step_share` of that step.

    slides: whether the contact begins to slide. limits: elastic displacements (K,) at which contacts slide there; None
    where a slide ends. The spring of the contact that begins to slide is set to its limit, and longer springs of
    contacts at rest are shortened to theirs.
    """

    row: int
    contact: int
    step_share: float
    slides: bool
    limits: Array | None = None


@dataclass(frozen=True)
class FrictionSprings:
    """
    Torsion springs on the spheres, in units of the model: they yield elastically before a contact slides.

    turns: index of the rotations of each sphere, (K, 3). law: friction law of the contacts. displacement: elastic
    displacement at which they slide under the weight. slide_end: slip speed at which slides end at level 0, the
    coarsest level of accuracy. Arguments `motion` are of the type `EngineMotion`.
    """

    mbs: Any
    contacts: list[Any]
    turns: NDArray[np.int_]
    depressions: Depressions
    law: DryFriction
    displacement: float
    slide_end: float

    def begin(self, state: EngineState) -> None:
        """Set each contact's friction coefficient for a run from `state`: by whether the contact rests or slides."""
        for contact, factor in zip(self.contacts, self.coefficient_ratios(state)):
            self.mbs.SetObjectParameter(contact, "dynamicFriction", factor * self.law.largest)

    def coefficient_ratios(self, state: EngineState) -> list[float]:
        """Return the ratio of each contact's friction coefficient to the scene's: 1 in a slide, much larger at rest."""
        return [1.0 if slides else RESTING_COEFFICIENT_RATIO for slides in self._mark_sliding(state)]

    def set_slide_end(self, end: float) -> None:
        """Set the regularization speed v_reg of all contacts in proportion to the slip speed `end` that ends slides."""
        for contact in self.contacts:
            self.mbs.SetObjectParameter(contact, "frictionProportionalZone", V_REG_OVER_SLIDE_END * end)

    def step_ratio(self, motion: Any, state: EngineState, end: float) -> Array:
        """
        Return the change of the state in each step, (T,), in proportion to the change that alters friction.

        It is the larger of two ratios: the largest change of a spring's elongation over the elongation at which
        contacts slide under the weight, and (weighted) the change of the platform's velocity over the slip speed.
        end: slip speed at which slides end.
        """
        turned = np.linalg.norm(np.diff(motion.coordinates[:, self.turns], axis=0), axis=2).max(axis=1, initial=0.0)
        slip = np.maximum(motion.slip[1:], end)[:, self._mark_sliding(state)].min(axis=1, initial=math.inf)
        turning = np.linalg.norm(np.diff(motion.velocities[:, :3], axis=0), axis=1) / slip
        changes = np.maximum(self.depressions.radius / self.displacement * turned, VELOCITY_CHANGE_WEIGHT * turning)
        return np.append(0.0, changes)

    def find_sliding_change(self, motion: Any, state: EngineState, end: float, begin: float) -> ContactChange | None:
        """
        Find the first contact that begins or ends a slide in a motion that starts from `state`; None if there is none.

        end: slip speed at which a slide ends. begin: speed with which a spring must pass its limit to begin a slide.
        """
        if len(motion.time) < 2:
            return None
        time, slip, limit = motion.time, motion.slip, self.limits(motion)
        excess = self.depressions.radius * np.linalg.norm(motion.coordinates[:, self.turns], axis=2) - limit
        negligible = NEGLIGIBLE_EXCESS * self.displacement * (end / self.slide_end) ** 2
        changes = []
        for number, slides in enumerate(self._mark_sliding(state)):
            if slides:
                changes.append(_find_slide_end(number, slip[:, number] / end))
                continue
            change = _find_slide_start(number, excess[:, number] / negligible)
            if change is not None:
                row = change.row
                speed = (excess[row + 1, number] - excess[row, number]) / (time[row + 1] - time[row])
                if speed > begin:
                    change = change._replace(limits=limit[row])
                else:  # too slow for a slide: the contact stays at rest, and its spring is shortened to the limit
                    change = ContactChange(
                        row=row + 1, contact=number, step_share=0.0, slides=False, limits=limit[row + 1]
                    )
            changes.append(change)
        return min((change for change in changes if change is not None), default=None)

    def limits(self, motion: Any) -> Array:
        """Return the elastic displacements (T, K) at which the contacts slide."""
        load = motion.load
        speed = np.linalg.norm(motion.velocities[:, :3], axis=1)[:, None]
        limit: Array = self.displacement * self.law.at(speed, load) / self.law.largest * load
        return limit

    def restart_state(
        self,
        state: EngineState,
        before: EngineState,
        accelerations: Array,
        rates_of_limits: Array,
        end: float,
        change: ContactChange | None = None,
    ) -> EngineState:
        """
        Return `state` with corrected velocities of the spheres, so that the next step can start from it.

        The velocities of the spheres follow from rest or slip of their contacts, because those that the engine computes
        for massless spheres alternate after every kink. before: state that tells which contacts slide. accelerations:
        of all coordinates, (n,). rates_of_limits: rates of change of `limits`, (K,). end: slip speed at which a slide
        ends. change: begin or end of a slide at this instant.
        """
        # A contact at rest turns its sphere with the platform's surface. A contact that slides keeps its spring at the
        # limit, which changes at a known rate, and the rest of the surface's velocity is slip along the spring's force.
        sliding = np.array(self._mark_sliding(before))
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
            rates[:, 2] -= accelerations[self.depressions.vertical]
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

    def state_at_rest(self, state: EngineState) -> EngineState:
        """Return `state` with all contacts put to rest, for a run to continue from."""
        assert state.accelerations is not None  # restart_state has set them
        return self.restart_state(state, state, state.accelerations, np.zeros(len(self.contacts)), math.inf)

    def _mark_sliding(self, state: EngineState) -> tuple[bool, ...]:
        """Return whether each contact slides (K,); all contacts rest at the start."""
        return state.sliding or (False,) * len(self.contacts)


def _find_slide_start(contact: int, excess: Array) -> ContactChange | None:
    """Find the step in which a spring passes its limit; excess: elongation beyond it, divided by a negligible one."""
    rows = np.flatnonzero((excess[1:] > 1.0) & (excess[1:] > excess[:-1]))
    if not len(rows):
        return None
    before, after = excess[rows[0] : rows[0] + 2].tolist()
    step_share = max(-before, 0.0) / (after - min(before, 0.0))
    return ContactChange(row=int(rows[0]), contact=contact, step_share=step_share, slides=True)


def _find_slide_end(contact: int, slip: Array) -> ContactChange | None:
    """Find the step in which an extrapolated slip speed comes to zero; slip: (T,), over the speed that ends a slide."""
    # a speed that is halved in a step comes to zero in the next one, if it falls on along a straight line
    rows = np.flatnonzero((2.0 * slip[1:] <= slip[:-1]) | ((slip[1:] <= 1.0) & (slip[1:] < slip[:-1])))
    if not len(rows):
        return None
    before, after = slip[rows[0] : rows[0] + 2].tolist()
    step_share = min(after / (before - after), 1.0)
    return ContactChange(row=int(rows[0]) + 1, contact=contact, step_share=step_share, slides=False)


def make_friction_springs(
    mbs: Any, scene: Scene, units: Units, contacts: list[Any], first: int, depressions: Depressions
) -> FrictionSprings | None:
    """Return the torsion springs of `contacts`, None if friction is rigid; first: the spheres' first coordinate."""
    if not scene.dry_friction.elastic:
        return None
    turns = first + BODY_COORDINATES * np.arange(len(contacts))[:, None] + np.arange(3, BODY_COORDINATES)
    law = scene.dry_friction.in_unit_of_speed(units.velocity)
    return FrictionSprings(
        mbs=mbs,
        contacts=contacts,
        turns=turns,
        depressions=depressions,
        law=law,
        displacement=scene.yield_displacement / units.length,
        slide_end=slide_end_speed(scene, units),
    )


def slide_end_speed(scene: Scene, units: Units) -> float:
    """Return the slip speed, in the model's unit, at which a slide on yielding friction ends at accuracy level 0."""
    return SLIDE_END_SPEED_RATIO * math.sqrt(scene.friction_coefficient * scene.yield_displacement / units.length)


@dataclass(frozen=True)
class TurningSpheres:
    """
    Spheres that rotate on springs, in the engine.

    markers: at the centers of the spheres. bodies: the one object of all spheres; empty where there are none.
    stiffness, damping: matrices (n, n) for the n coordinates of the spheres.
    """

    markers: list[Any]
    bodies: list[Any]
    stiffness: Array
    damping: Array

    @property
    def coordinates(self) -> int:
        """Number of coordinates of the spheres."""
        return len(self.stiffness)


def add_turning_spheres(
    mbs: Any, scene: Scene, units: Units, places: Array, radius: float, moved: float = 0.0
) -> TurningSpheres:
    """
    Add spheres of a `radius` that rotate on springs, in units of the model; add none if friction is rigid.

    places: horizontal places (K, 2) of their centers, at height one. moved: 0 if their centers stay in place; otherwise
    they also move vertically, with this total mass, and a force equal to the weight presses them up.
    """
    if not scene.dry_friction.elastic:
        return TurningSpheres(markers=[], bodies=[], stiffness=np.zeros((0, 0)), damping=np.zeros((0, 0)))
    count = len(places)
    rest = [[*place, 1.0, 0.0, 0.0, 0.0] for place in places]
    nodes = [mbs.AddNode(items.NodeRigidBodyRxyz(referenceCoordinates=place)) for place in rest]
    turning = scene.dry_friction.stiffness * units.length / units.force * radius**2 / count
    mass = np.tile([CENTER_MASS] * 3 + [ROTATIONAL_MASS * radius**2 / count] * 3, count)
    stiffness = np.tile([CENTER_STIFFNESS] * 3 + [turning] * 3, count)
    damping = np.tile([2.0 * np.sqrt(CENTER_MASS * CENTER_STIFFNESS)] * 3 + [0.0] * 3, count)
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
