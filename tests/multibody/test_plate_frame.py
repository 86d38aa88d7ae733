"""
The plate's frame: inertial forces on bodies over a plate at rest, or a plate that really moves under them.

The moving plate is a body a million times as heavy as all others, driven by its own mass times the loading's
acceleration, with the supports on it and weight as the only other load. Nothing is taken from the plate's frame but
the start at rest.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scenes_at_hand import changed

from multibody.contact import DAMPING
from multibody.engine import exudyn, items
from multibody.integrate import silence
from multibody.loading import SymbolicGround, symbolic_load
from multibody.surface import assembled
from multibody.translational import HOLLOW, LOCKED
from multibody.units import Units, units_of
from reference.problem import Scene, ground_acceleration, load_scene

Array = NDArray[np.float64]
HEAVY, PENETRATION, V_REG, STEP = 1e6, 1e-6, 1e-3, 1e-3
PHASE = np.array([0.3, 1.1])


def settings_for(scene: Scene, units: Units) -> Any:
    settings = exudyn.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 0.0
    integration = settings.timeIntegration
    integration.verboseMode = 0
    integration.endTime = scene.duration / units.time
    integration.numberOfSteps = round(scene.duration / STEP)
    integration.generalizedAlpha.spectralRadius = 0.8
    # the first residual is the plate's; what counts are the light bodies'
    integration.newton.relativeTolerance, integration.newton.absoluteTolerance = 1e-13, 1e-8
    return settings


def on_a_moving_plate(scene: Scene) -> tuple[Array, Array]:
    """Absolute acceleration (T, 3) of the platform of a one-body scene, and its displacement from the plate (T, 3)."""
    units = units_of(scene)
    container = exudyn.SystemContainer()
    mbs = container.AddSystem()
    ground = SymbolicGround(scene, units)
    nodes, markers, expressions = [], [], []
    for mass, weight in ((HEAVY, 0.0), (1.0, 1.0)):
        nodes.append(mbs.AddNode(items.NodeRigidBodyRxyz(referenceCoordinates=[0.0] * 6)))
        body = mbs.AddObject(items.ObjectRigidBody(nodeNumber=nodes[-1], mass=mass, inertia=[LOCKED] * 3 + [0.0] * 3))
        lifted = [0.0, 0.0, 1.0] if mass == HEAVY else [0.0, 0.0, 0.0]
        markers.append(mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localPosition=lifted)))
        mbs.AddLoad(items.LoadForceVector(markerNumber=markers[-1], loadVector=[0.0, 0.0, -weight]))

    def drive(mbs: Any, t: Any, loadVector: Any) -> list[Any]:
        return [HEAVY * ground.along(axis, t) for axis in range(3)]

    drive_load = mbs.AddLoad(items.LoadForceVector(markerNumber=markers[0], loadVector=[0.0, 0.0, 0.0]))
    expressions.append(symbolic_load(mbs, drive_load, "loadVectorUserFunction", drive))
    contact_node = mbs.AddNode(
        items.NodeGenericData(initialCoordinates=[-PENETRATION, 0.0, 0.0, 0.0], numberOfDataCoordinates=4)
    )
    mbs.AddObject(
        items.ObjectContactSphereSphere(
            markerNumbers=markers,
            nodeNumber=contact_node,
            spheresRadii=[HOLLOW - (1.0 - PENETRATION), HOLLOW],
            isHollowSphere1=True,
            dynamicFriction=scene.friction_coefficient,
            frictionProportionalZone=V_REG / units.velocity,
            contactStiffness=1.0 / PENETRATION,
            contactDamping=2.0 * DAMPING / np.sqrt(PENETRATION),
        )
    )
    kinds = exudyn.OutputVariableType
    sensors = [
        mbs.AddSensor(items.SensorNode(nodeNumber=node, outputVariableType=kind, storeInternal=True, writeToFile=False))
        for node, kind in zip(
            [nodes[1], nodes[0], nodes[1]], [kinds.Coordinates_tt, kinds.Coordinates, kinds.Coordinates]
        )
    ]
    mbs.Assemble()
    ground.set_phase(PHASE)
    with silence():
        assert mbs.SolveDynamic(settings_for(scene, units)) is not False
    acceleration, plate, platform = (mbs.GetSensorStoredData(sensor)[:, 1:4] for sensor in sensors)
    return acceleration * units.acceleration, (platform - plate) * units.length


def over_a_plate_at_rest(scene: Scene) -> tuple[Array, Array]:
    model = assembled(scene, "translational", V_REG)
    units = model.units
    model.stiffen(PENETRATION)
    model.ground.set_phase(PHASE)
    state = model.start(None, np.zeros(3), PENETRATION)
    model.mbs.systemData.SetDataCoordinates(state.contact, configuration=exudyn.ConfigurationType.Initial)
    with silence():
        model.mbs.SolveDynamic(settings_for(scene, units))
    read = model.mbs.GetSensorStoredData
    relative, place = (read(part[0])[:, 1:4] for part in (model.recorders.accelerations, model.recorders.coordinates))
    time = read(model.recorders.coordinates[0])[:, 0] * units.time
    return relative * units.acceleration + ground_acceleration(scene, PHASE, time), place * units.length


def test_inertial_forces_and_a_plate_that_moves_give_the_same_motion() -> None:
    shaking = {"amplitudes": [[1.0, 0.5], [0.0, 1.0], [1.0, 1.0]]}
    scene = changed(load_scene("fig3-I"), duration=3.0, bodies=[{"mass": 1.0}], excitation=shaking)
    moving, resting = on_a_moving_plate(scene), over_a_plate_at_rest(scene)
    swing = np.abs(resting[1]).max()
    assert swing > 0.01
    # the plate gives way by 1e-6 of the platform's weight; the rest is the step's error, not the same in both frames
    np.testing.assert_allclose(moving[1], resting[1], atol=1e-4 * swing)
    peaks = [np.linalg.norm(acceleration, axis=-1).max() for acceleration, _ in (moving, resting)]
    np.testing.assert_allclose(peaks[0], peaks[1], rtol=1e-3)
