"""
Spatial model: rigid bodies that can rotate, supports in the plane, contacts that open and close.

Platform and bodies are boxes with six degrees of freedom at their heights. The platform's underside has one depression
per support. Each has its own unilateral contact, so supports share the load as overturning demands. A link is a
set of upright bars clamped at both ends. It is stiff in tension and in bending about the horizontal axes. The scene's
shear stiffness acts halfway up. Against twist it has the stiffness of bars that stand on the ring,
ring^2 (kx + ky) / 2, or at the positions of the supports. Its forces act on both bodies at the same point, the middle
between the two ends. Bars whose axial stiffness a scene states give way in tension and bending, too (`links`).

All links stand on one vertical axis, which is also that of the ring, and of the positions of supports. A center of mass
may be off it (`offset`). The box of a body and the directions of its link's shear stiffness may be turned (`yaw`). The
engine's rotations are those against this state of rest.

A flat slider has the height of its bodies above the plane under the platform, which lies on the tops of the spheres.

More than three supports share the load as elastic bearings do (`supports`), or give way by the scene's
`support_stiffness`. Then the stiffness of the contacts is that of the bearings, and part of the model.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import compress
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from multibody.models.contact import (
    DAMPING_RATIO,
    POSITION_ROUNDING,
    ContactLaw,
    contact_law,
    corner_and_relaxation,
    set_contact_parameters,
)
from multibody.models.depressions import Depressions, FlatUnderside, rotation_matrices
from multibody.models.engine import BODY_COORDINATES, exudyn, items
from multibody.models.friction_springs import add_turning_spheres, make_friction_springs
from multibody.models.impact import ImpactLaw
from multibody.models.links import Link, RigidBodies, add_links, fastest_bar_frequency
from multibody.models.loading import LoadedCoordinate, add_coordinate_load, load_coordinates, make_ground
from multibody.models.plane import make_plane_contact, set_plane_extent, start_platform
from multibody.models.recorders import add_recorders
from multibody.models.speed_friction import SpeedFriction
from multibody.models.state import EngineState
from multibody.models.supports import (
    MAX_DETERMINATE_SUPPORTS,
    MIN_WARPING_COMPLIANCE,
    SPHERES_MASS,
    Supports,
    add_fixed_supports,
    add_sharing_supports,
    make_turning_supports,
)
from multibody.models.system import EngineModel
from multibody.models.units import Units, link_damping, link_stiffness, units_of
from reference.problem import DryFriction, Scene, State
from reference.problem.supports import ring_positions

Array = NDArray[np.float64]


def assemble_spatial(scene: Scene, regularization: float | None, *, contact_force: bool = False) -> EngineModel:
    """
    Assemble the spatial model of a scene, whose bodies rotate on supports that may open, in the engine.

    Arguments are those of `assemble_translational`. Raises ValueError if the scene has no data of supports or bodies.
    """
    units = units_of(scene)
    geometry = _measure_geometry(scene, units)
    masses, centers = geometry.masses, geometry.centers
    container = exudyn.SystemContainer()
    mbs = container.AddSystem()
    nodes, numbers = _add_boxes(mbs, geometry)
    links = _add_links(mbs, scene, units, geometry, numbers)
    ground = make_ground(mbs, scene, units)
    bearings, count = scene.isolator.support_stiffness, len(geometry.places)
    bearing_penetration = 0.0 if bearings is None else units.force / (count * bearings * units.length)
    shared = not bearing_penetration and count > MAX_DETERMINATE_SUPPORTS
    supports = _add_supports(mbs, scene, units, geometry, shared)
    engine_law = contact_law(scene, regularization, units)
    contacts, contact_nodes = _add_contacts(mbs, supports.markers, numbers[0], geometry, engine_law, scene.flat)
    for mass, node in zip(masses, nodes):
        add_coordinate_load(mbs, node, 2, -float(mass))
    pushed = [LoadedCoordinate(node, axis, float(mass), axis) for node, mass in zip(nodes, masses) for axis in range(3)]
    expressions = load_coordinates(mbs, ground, pushed)
    forces = contacts if contact_force or scene.dry_friction.needs_load else []
    recorders = add_recorders(mbs, nodes, supports.springs, contact_nodes, forces)
    mbs.Assemble()

    index = BODY_COORDINATES * np.arange(len(masses))[:, None] + np.arange(3)
    constant = scene.dry_friction.constant
    varying = None if constant else SpeedFriction(mbs, scene, units, engine_law.threshold, contacts, ground)
    parts = _SpatialSystem(
        scene=scene,
        mbs=mbs,
        units=units,
        index=index,
        contacts=contacts,
        links=links,
        supports=supports,
        radius=geometry.radius,
        bearing_penetration=bearing_penetration,
    )
    vertical = parts.body_coordinates + supports.vertical
    underside = FlatUnderside if scene.flat else Depressions
    under_platform = underside(geometry.places, centers[0], geometry.radius, vertical)
    springs = make_friction_springs(mbs, scene, units, contacts, parts.body_coordinates, under_platform)
    law = DryFriction(engine_law.friction, engine_law.friction, 0.0) if varying is None else varying.law
    law = law if springs is None else DryFriction(0.0, 0.0, 0.0)  # 0: friction that yields on springs passes no impulse
    impact_law = _make_impact_law(scene, geometry, under_platform, links, law, engine_law.threshold)
    corner, relaxation = corner_and_relaxation(scene, regularization, units)
    # rounding errors of positions, and those of moments, are each proportional to the distance from the origin
    farthest_place = max(1.0, float(geometry.distances.max()), float(centers[:, 2].max()))
    return EngineModel(
        mbs=mbs,
        units=units,
        ground=ground,
        recorders=recorders,
        bodies=index,
        set_contact=parts.set_contact,
        start=parts.start,
        settle=parts.settle,
        corner=corner,
        relaxation=relaxation,
        rounding=POSITION_ROUNDING * farthest_place**2,
        references=(container, expressions),
        allows_liftoff=True,
        kinematics=impact_law,
        warping_displacement=parts.warping_displacement,
        bearing_penetration=bearing_penetration,
        depressions=under_platform,
        critical_tilt=_critical_tilt(geometry.places, geometry.radius, masses, centers),
        impact=None if bearing_penetration else impact_law,
        bar_damping_times=parts.bar_damping_times,
        take_out_open_contacts=parts.take_out_open_contacts,
        friction=varying,
        rim=np.inf if scene.flat else 1.0,
        springs=springs,
        fastest_bar_frequency=fastest_bar_frequency(links, masses, geometry.tensors, centers),
    )


@dataclass(frozen=True)
class _Geometry:
    """
    Geometry of bodies and supports, in units of the model.

    places: x and y of the supports, (K, 2). distances: distances of the supports from the axis of the links, (K,), or
    (1,) for a ring. radius: radius of the spheres. masses: mass of each body, (N,). centers: centers of mass, (N, 3).
    inertias: moments about the axes of the boxes, (N, 3). axes: these axes at rest, as columns, (N, 3, 3).
    """

    places: Array
    distances: Array
    radius: float
    masses: Array
    centers: Array
    inertias: Array
    axes: Array

    @property
    def tensors(self) -> Array:
        """Inertia tensors of the bodies at rest, (N, 3, 3), in the ground's axes x, y, z, not those of the boxes."""
        turned: Array = (self.axes * self.inertias[:, None, :]) @ self.axes.swapaxes(1, 2)
        return turned


def _measure_geometry(scene: Scene, units: Units) -> _Geometry:
    """Return the geometry of a scene's bodies and supports. Raises ValueError where the scene lacks data of them."""
    isolator = scene.isolator
    required = {f"isolator.{key}": getattr(isolator, key) for key in ("supports", "sphere_radius")}
    if not isinstance(isolator.supports, list):
        required["isolator.ring"] = isolator.ring
    for number, body in enumerate(scene.bodies):
        required |= {f"bodies.{number}.{key}": getattr(body, key) for key in ("height", "size")}
    missing = [key for key, value in required.items() if value is None]
    if missing:
        raise ValueError(f"model: 'spatial': {scene.name} needs {', '.join(missing)}")
    assert isolator.sphere_radius is not None
    if isinstance(isolator.supports, list):
        places = np.array(isolator.supports) / units.length
        distances = np.hypot(*places.T)
    else:
        assert isolator.supports is not None
        assert isolator.ring is not None
        places = ring_positions(isolator.supports, isolator.ring / units.length)
        distances = np.hypot(*places[:1].T)
    masses, radius = scene.masses / units.mass, isolator.sphere_radius / units.length
    sizes = np.array([body.size for body in scene.bodies]) / units.length
    inertias = masses[:, None] / 12.0 * ((sizes**2).sum(axis=1)[:, None] - sizes**2)  # homogeneous boxes
    heights = np.array([body.height for body in scene.bodies])
    centers = np.column_stack([scene.offsets, heights]) / units.length
    if scene.flat:
        height_of_plane = 1.0 + radius
        centers[:, 2] += height_of_plane
    axes = rotation_matrices(scene.yaws[:, None] * [0.0, 0.0, 1.0])
    return _Geometry(
        places=places,
        distances=distances,
        radius=radius,
        masses=masses,
        centers=centers,
        inertias=inertias,
        axes=axes,
    )


def _add_boxes(mbs: Any, geometry: _Geometry) -> tuple[list[Any], list[Any]]:
    """Add the bodies to the engine's system; return their nodes and object numbers."""
    nodes, bodies = [], []
    for mass, center, tensor in zip(geometry.masses, geometry.centers, geometry.tensors):
        nodes.append(mbs.AddNode(items.NodeRigidBodyRxyz(referenceCoordinates=[*center, 0.0, 0.0, 0.0])))
        moments = [*np.diag(tensor), tensor[1, 2], tensor[0, 2], tensor[0, 1]]
        bodies.append(mbs.AddObject(items.ObjectRigidBody(nodeNumber=nodes[-1], mass=mass, inertia=moments)))
    return nodes, bodies


def _add_links(mbs: Any, scene: Scene, units: Units, geometry: _Geometry, numbers: list[Any]) -> list[Link]:
    """Add the links between the bodies, with shear stiffness along the axes of the upper body of each."""
    directions = geometry.axes[1:, :2, :2]
    shear, damping = (
        directions @ (values[:, :, None] * directions.swapaxes(1, 2))
        for values in (link_stiffness(scene, units), link_damping(scene, units))
    )
    bodies = RigidBodies(numbers, geometry.masses, geometry.centers)
    return add_links(mbs, scene, units, bodies, shear, damping, float((geometry.distances**2).mean()))


def _add_supports(mbs: Any, scene: Scene, units: Units, geometry: _Geometry, shared: bool) -> Supports:
    """
    Add the spheres of the supports; shared: whether they stand on vertical springs, by which they share the load.

    Where friction yields, they also rotate on torsion springs; otherwise they do not rotate.
    """
    places = geometry.places
    if scene.dry_friction.elastic:
        moved = SPHERES_MASS if shared else 0.0
        turning = add_turning_spheres(mbs, scene, units, places, geometry.radius, moved)
        return make_turning_supports(mbs, places, turning, shared)
    return add_sharing_supports(mbs, places) if shared else add_fixed_supports(mbs, places)


def _make_impact_law(
    scene: Scene, geometry: _Geometry, under_platform: Depressions, links: list[Link], law: DryFriction, corner: float
) -> ImpactLaw:
    """Return the impact law of contacts that close, with friction by `law`, linear below the slip speed `corner`."""
    restitution = scene.isolator.restitution or 0.0
    rigid = np.array([link.bars is None for link in links], dtype=bool)
    return ImpactLaw(
        depressions=under_platform,
        masses=geometry.masses,
        inertias=geometry.inertias,
        axes=geometry.axes,
        centers=geometry.centers,
        restitution=restitution,
        friction=law,
        corner=corner,
        rigid=rigid,
    )


@dataclass(frozen=True)
class _SpatialSystem:
    """
    Assembled spatial model, which sets its contacts and links and gives its initial state, in its own units.

    index: index of the coordinates that move the bodies, (N, 3). radius: radius of the spheres. bearing_penetration:
    penetration under the weight by the stiffness of the scene's bearings, or 0.
    """

    scene: Scene
    mbs: Any
    units: Units
    index: NDArray[np.int_]
    contacts: list[Any]
    links: list[Link]
    supports: Supports
    radius: float
    bearing_penetration: float

    @property
    def body_coordinates(self) -> int:
        """Number of coordinates of the bodies, which come before those of the spheres."""
        return BODY_COORDINATES * len(self.index)

    def set_contact(self, penetration: float, warping_compliance: float = MIN_WARPING_COMPLIANCE) -> None:
        """
        Set the stiffness of contacts, supports and links.

        penetration: of the contacts under the weight. warping_compliance: displacement of the supports out of a common
        plane under the weight.
        """
        self._set_penetration(penetration)
        self.supports.set_stiffness(penetration, warping_compliance)
        for link in self.links:
            link.set_stiffness(self.mbs, penetration)

    def bar_damping_times(self, penetration: float) -> Array:
        """
        Return the ratio of damping to stiffness in tension of each link, (N - 1,), in units of time.

        It follows from the penetration of the contacts; for links of elastic bars it is 0.
        """
        return np.array([link.damping_time(penetration) for link in self.links])

    def take_out_open_contacts(self, is_open: NDArray[np.bool_], penetration: float) -> None:
        """Switch off the engine's contacts `is_open` (K,); set up the others for a `penetration` under the weight."""
        self._set_penetration(penetration)
        for contact in compress(self.contacts, is_open):
            self.mbs.SetObjectParameter(contact, "contactStiffness", 0.0)
            self.mbs.SetObjectParameter(contact, "contactDamping", 0.0)

    def _set_penetration(self, penetration: float) -> None:
        """
        Set stiffness, damping and radii of the contacts for a `penetration` under the weight.

        If the scene states the stiffness of its bearings, the penetration follows from that instead.
        """
        pressed = self.bearing_penetration or penetration
        radii = self.radius + pressed if self.scene.flat else [self.radius + pressed, self.radius + 1.0]
        stated = self.scene.isolator.support_damping
        ratio = DAMPING_RATIO if stated is None else stated
        for contact in self.contacts:
            set_contact_parameters(self.mbs, contact, radii, pressed, len(self.contacts), ratio)

    def start(self, initial: State | None, ground_acceleration: Array, penetration: float) -> EngineState:
        """Return the engine's state for an initial state (None: at rest) and the ground's acceleration, m/s^2."""
        index, pressed = self.index, self.bearing_penetration or penetration

        def set_extent(distance: float) -> None:
            """Make the triangles of a flat slider's plane large enough for a move by `distance`, in units of length."""
            for contact in self.contacts:
                set_plane_extent(self.mbs, contact, distance, 1.0 + self.radius)

        count = self.body_coordinates + self.supports.coordinates
        coordinates, velocities, gap, slip = start_platform(
            self.scene, self.units, index, count, initial, ground_acceleration, pressed, set_extent
        )
        coordinates[index[1:, 2]], velocities[index[1:, 2]] = coordinates[2], velocities[2]
        # spheres and stiff links rise as far as the vertical loading relieves them of the weight
        relief = 1.0 + gap / pressed
        settlement = relief * self.supports.static_settlement(penetration)
        coordinates[index[:, 2]] += settlement
        coordinates[index[1:, 2]] += relief * np.cumsum([link.static_settlement(penetration) for link in self.links])
        coordinates[self.body_coordinates + self.supports.vertical] = settlement
        contacts = len(self.contacts)
        data, load = np.tile([gap, slip, 0.0, 0.0], contacts), np.full(contacts, -gap / pressed)
        return EngineState(coordinates, velocities, data, load=load)

    def settle(self, state: EngineState, gap_rate: Array, penetration: float) -> EngineState:
        """Return `state` unchanged, to go on with a smaller step: contact forces of bodies that rotate adjust to it."""
        return state

    def warping_displacement(self, coordinates: Array) -> Array:
        """Return the largest distance (T,) of any support from the plane that fits all best, at coordinates (T, n)."""
        vertical = self.body_coordinates + self.supports.vertical
        largest: Array = np.abs(coordinates[:, vertical] @ self.supports.warping).max(axis=1, initial=0.0)
        return largest


def _critical_tilt(ring: Array, radius: float, masses: Array, centers: Array) -> float:
    """Return the tilt, rad, at which the center of mass is above the nearest edge of the supports."""
    center = masses @ centers / masses.sum()
    # each row of `equations` is the outward normal of an edge of the supports' outline, and minus its distance
    outward_normals, distances = np.split(ConvexHull(ring).equations, [2], axis=1)
    inside = -float((outward_normals @ center[:2] + distances[:, 0]).max())
    return float(np.arctan2(inside, center[2] - (1.0 + radius)))


def _add_contacts(
    mbs: Any, supports: list[Any], platform: Any, geometry: _Geometry, law: ContactLaw, flat: bool
) -> tuple[list[Any], list[Any]]:
    """Add contacts of the spheres with the platform's depressions or plane; return them and their data nodes."""
    radius, ring = geometry.radius, geometry.places
    depressions = np.column_stack([ring, np.zeros(len(ring))]) - geometry.centers[0]
    contacts, nodes = [], []
    for place, support in zip(depressions, supports):
        nodes.append(mbs.AddNode(items.NodeGenericData(initialCoordinates=[0.0] * 4, numberOfDataCoordinates=4)))
        depression = mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=platform, localPosition=[*place]))
        if flat:
            contact = make_plane_contact(support, depression, nodes[-1], radius, law)
            contacts.append(mbs.AddObject(contact))
            continue
        contact = items.ObjectContactSphereSphere(
            markerNumbers=[support, depression],
            nodeNumber=nodes[-1],
            spheresRadii=[radius, radius + 1.0],
            isHollowSphere1=True,
            dynamicFriction=law.friction,
            frictionProportionalZone=law.threshold,
        )
        contacts.append(mbs.AddObject(contact))
    return contacts, nodes
