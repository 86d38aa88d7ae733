"""
Two formulations of the translational model, the package's own and a kinematic tree, by four of the engine's solvers.

One run at constant step as the engine's tutorials do it: peaks read at the steps, no error estimate.
"""

import time
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from multibody.integration.constant_step import MAX_CONTRACTIVITY, SPECTRAL_RADIUS, silence
from multibody.models.assembly import assemble
from multibody.models.contact import DAMPING_RATIO, contact_law
from multibody.models.engine import exudyn, items, reset_with
from multibody.models.loading import Ground, SymbolicGround, symbolic_load
from multibody.models.translational import HOLLOW_RADIUS
from multibody.models.units import link_stiffness, units_of
from reference.problem import Scene, ground_acceleration, ground_peak

Array = NDArray[np.float64]
V_REG, PENETRATION = 1e-3, 1e-6


@dataclass
class Candidate:
    """An assemble system; absolute: turns recorded coordinates (T, n) into those of the bodies (T, N, 3)."""

    mbs: Any
    ground: Ground
    recorders: list[Any]
    absolute: Any
    start: Any
    keep: tuple[Any, ...]


def rigid_body(scene: Scene, penetration: float, v_reg: float = V_REG, model_name: str = "translational") -> Candidate:
    """The package's own: a rigid body that cannot turn for its inertia, and a linear chain; or bodies that turn."""
    model = assemble(scene, model_name, v_reg)
    model.set_contact(penetration)

    def start(phase: Array) -> tuple[Array, Array, Array]:
        state = model.start(None, ground_acceleration(scene, phase, [0.0])[0], penetration)
        return state.coordinates, state.velocities, state.contact

    def absolute(values: Array) -> Array:
        return values[:, model.bodies]

    return Candidate(model.mbs, model.ground, model.recorders.accelerations, absolute, start, (model,))


def prismatic_tree(scene: Scene, penetration: float, v_reg: float = V_REG) -> Candidate:
    """A kinematic tree of prismatic joints: 3 + 2 (N - 1) relative coordinates, springs in the joints, no rotations."""
    units = units_of(scene)
    masses, stiffness = scene.masses / units.mass, link_stiffness(scene, units)
    friction, corner = contact_law(scene, v_reg, units)
    upper = len(masses) - 1
    kind = exudyn.JointType
    joints = [kind.PrismaticX, kind.PrismaticY, kind.PrismaticZ] + [kind.PrismaticX, kind.PrismaticY] * upper
    count = len(joints)
    container = exudyn.SystemContainer()
    mbs = container.AddSystem()
    frame = mbs.AddObject(items.ObjectGround())
    zeros = [0.0] * count
    node = mbs.AddNode(
        items.NodeGenericODE2(
            referenceCoordinates=zeros,
            initialCoordinates=zeros,
            initialCoordinates_t=zeros,
            numberOfODE2Coordinates=count,
        )
    )
    tree = mbs.AddObject(
        items.ObjectKinematicTree(
            nodeNumber=node,
            jointTypes=joints,
            linkParents=list(range(-1, count - 1)),
            jointTransformations=exudyn.Matrix3DList([np.eye(3)] * count),
            jointOffsets=exudyn.Vector3DList([np.zeros(3)] * count),
            linkInertiasCOM=exudyn.Matrix3DList([np.zeros((3, 3))] * count),
            linkCOMs=exudyn.Vector3DList([np.zeros(3)] * count),
            linkMasses=[0.0, 0.0, masses[0]] + [value for mass in masses[1:] for value in (0.0, mass)],
            jointPControlVector=[0.0] * 3 + list(stiffness.ravel()),
            jointDControlVector=zeros,
            jointPositionOffsetVector=zeros,
            jointVelocityOffsetVector=zeros,
        )
    )
    links = [2 + 2 * i for i in range(upper + 1)]
    markers = [mbs.AddMarker(items.MarkerKinematicTreeRigid(objectNumber=tree, linkNumber=link)) for link in links]
    contact_node = mbs.AddNode(items.NodeGenericData(initialCoordinates=[0.0] * 4, numberOfDataCoordinates=4))
    mbs.AddObject(
        items.ObjectContactSphereSphere(
            markerNumbers=[
                mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=frame, localPosition=[0.0, 0.0, 1.0])),
                markers[0],
            ],
            nodeNumber=contact_node,
            spheresRadii=[HOLLOW_RADIUS - (1.0 - penetration), HOLLOW_RADIUS],
            isHollowSphere1=True,
            dynamicFriction=friction,
            frictionProportionalZone=corner,
            contactStiffness=1.0 / penetration,
            contactDamping=2.0 * DAMPING_RATIO / np.sqrt(penetration),
        )
    )
    ground = SymbolicGround(scene, units)
    expressions = []
    for mass, marker in zip(masses, markers):
        load = mbs.AddLoad(items.LoadForceVector(markerNumber=marker, loadVector=[0.0, 0.0, -mass]))
        expressions.append(symbolic_load(mbs, load, "loadVectorUserFunction", _inertial(ground, float(mass))))
    sensor = items.SensorNode(
        nodeNumber=node,
        outputVariableType=exudyn.OutputVariableType.Coordinates_tt,
        storeInternal=True,
        writeToFile=False,
    )
    recorder = mbs.AddSensor(sensor)
    mbs.Assemble()

    def start(phase: Array) -> tuple[Array, Array, Array]:
        return np.zeros(count), np.zeros(count), np.array([-penetration, 0.0, 0.0, 0.0])

    def absolute(values: Array) -> Array:
        relative = np.concatenate([values[:, :2], values[:, 3:]], axis=1).reshape(len(values), -1, 2)
        vertical = np.broadcast_to(values[:, None, 2:3], (*relative.shape[:2], 1))
        return np.concatenate([np.cumsum(relative, axis=1), vertical], axis=2)

    candidate = Candidate(mbs, ground, [recorder], absolute, start, (container, expressions))
    reset_with(candidate, container)
    return candidate


def _inertial(ground: SymbolicGround, mass: float) -> Any:
    def force(mbs: Any, t: Any, loadVector: Any) -> list[Any]:
        return [-mass * ground.along(0, t), -mass * ground.along(1, t), -mass - mass * ground.along(2, t)]

    return force


FORMULATIONS = {"rigid body": rigid_body, "prismatic tree": prismatic_tree}


def settings_of(solver: str, *, modified: bool = True) -> tuple[Any, Any]:
    """Simulation settings, and the engine's solver type."""
    settings = exudyn.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 0.0
    integration = settings.timeIntegration
    integration.verboseMode = 0
    if modified:
        integration.newton.useModifiedNewton = True
        integration.newton.modifiedNewtonContractivity = MAX_CONTRACTIVITY
        integration.newton.relativeTolerance, integration.newton.absoluteTolerance = 1e-5, 1e-8
        integration.generalizedAlpha.spectralRadius = SPECTRAL_RADIUS
    integration.generalizedAlpha.useNewmark = solver == "trapezoidal"
    kinds = {"RK44": "RK44", "velocity Verlet": "VelocityVerlet"}
    return settings, getattr(exudyn.DynamicSolverType, kinds.get(solver, "GeneralizedAlpha"))


def run(
    scene: Scene, candidate: Candidate, phase: Array, solver: str, step: float, *, modified: bool = True
) -> tuple[Array, float]:
    """Peaks over the plate's (N,), and processor time, s. NaN where the engine gives up."""
    units = units_of(scene)
    settings, kind = settings_of(solver, modified=modified)
    count = round(scene.duration / step)
    settings.timeIntegration.endTime = scene.duration / units.time
    settings.timeIntegration.numberOfSteps = count
    candidate.ground.set_phase(phase)
    coordinates, velocities, contact = candidate.start(phase)
    data, initial = candidate.mbs.systemData, exudyn.ConfigurationType.Initial
    data.SetODE2Coordinates(coordinates, configuration=initial)
    data.SetODE2Coordinates_t(velocities, configuration=initial)
    data.SetDataCoordinates(contact, configuration=initial)
    clock = time.process_time()
    with silence():
        try:
            candidate.mbs.SolveDynamic(settings, solverType=kind)
        except (exudyn.ExudynError, RuntimeError, ValueError):
            return np.full(len(scene.bodies), np.nan), time.process_time() - clock
    cost = time.process_time() - clock
    stored = [candidate.mbs.GetSensorStoredData(recorder) for recorder in candidate.recorders]
    ground = ground_acceleration(scene, phase, stored[0][:, 0] * units.time)[:, None, :]
    relative = candidate.absolute(np.hstack([rows[:, 1:] for rows in stored])) * units.acceleration
    peaks: Array = np.linalg.norm(relative + ground, axis=-1).max(axis=0)
    return peaks / ground_peak(scene, [phase])[0], cost
