"""The plate's frame: on a plate that the engine really moves, bodies move against it as inertial forces say."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

import multibody
from multibody.integration.constant_step import silence_engine
from multibody.models.contact import contact_law, set_contact_parameters
from multibody.models.engine import exudyn, items
from multibody.models.friction_springs import add_turning_spheres
from multibody.models.translational import HOLLOW_RADIUS, LOCKED_INERTIA, SPHERE_RADIUS, _add_chain, _add_contact
from multibody.models.units import link_damping, link_stiffness, units_of
from reference.problem import Scene, ground_acceleration, load_scene

PHASE, V_REG, PENETRATION, STEP = (0.3, 1.1), 1e-3, 1e-6, 5e-4
PLATE_MASS = 1e6  # over that of all bodies, which move the plate by a millionth of what it moves them
SHAKEN = load_scene("fig3-I").with_values(
    {"duration": 2.0, "excitation.amplitudes": [[1.0, 0.5], [0.0, 1.0], [2.0, 1.0]]}
)


def position_against_moving_plate(scene: Scene) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Instants (T,), s, and positions (T, N, 2), m, by steps of one length, with the weight as the only other load."""
    units, container = units_of(scene), exudyn.SystemContainer()
    mbs = container.AddSystem()
    node = mbs.AddNode(items.NodeRigidBodyRxyz(referenceCoordinates=[0.0] * 6))
    platform = mbs.AddMarker(items.MarkerNodeRigid(nodeNumber=node))
    masses, links = scene.masses / units.mass, (link_stiffness(scene, units), link_damping(scene, units))
    _, chain = _add_chain(mbs, node, masses, *links)
    fixed = add_turning_spheres(mbs, scene, units, np.zeros((1, 2)), SPHERE_RADIUS)
    carrying = mbs.AddNode(items.NodeRigidBodyRxyz(referenceCoordinates=[0.0] * 6))
    inertia = [LOCKED_INERTIA] * 3 + [0.0] * 3
    plate = mbs.AddObject(items.ObjectRigidBody(nodeNumber=carrying, mass=PLATE_MASS, inertia=inertia))

    def push(mbs: Any, time: float, force: Any) -> list[float]:
        acceleration = ground_acceleration(scene, PHASE, [time * units.time])[0]
        return list(PLATE_MASS * acceleration / units.acceleration)

    middle = mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=plate))
    mbs.AddLoad(items.LoadForceVector(markerNumber=middle, loadVector=[0.0] * 3, loadVectorUserFunction=push))
    law = contact_law(scene, V_REG, units)
    contact, _, _ = _add_contact(mbs, plate, platform, law, fixed, False)
    radii = [HOLLOW_RADIUS - (1.0 - PENETRATION), HOLLOW_RADIUS]
    set_contact_parameters(mbs, contact, radii, PENETRATION)
    kind, stored = exudyn.OutputVariableType.Coordinates, {"storeInternal": True, "writeToFile": False}
    bodies = mbs.AddSensor(items.SensorBody(bodyNumber=chain, outputVariableType=kind, **stored))
    below = mbs.AddSensor(items.SensorNode(nodeNumber=carrying, outputVariableType=kind, **stored))
    mbs.Assemble()
    settings = exudyn.SimulationSettings()
    integration = settings.timeIntegration
    settings.solution.file.write, settings.solution.sensors.writePeriod = False, 0.0
    integration.endTime, integration.numberOfSteps = scene.duration / units.time, round(scene.duration / STEP)
    integration.generalizedAlpha.spectralRadius = 0.8
    integration.newton.relativeTolerance, integration.newton.absoluteTolerance = 1e-14, 1e-8
    with silence_engine():
        mbs.SolveDynamic(settings)
    moved, plate_moved = mbs.GetSensorStoredData(bodies), mbs.GetSensorStoredData(below)[:, 1:3]
    position = np.stack([moved[:, 1:3], moved[:, 7:9]], axis=1) - plate_moved[:, None]
    return moved[:, 0] * units.time, position * units.length


def test_inertial_forces_and_a_moving_plate_agree() -> None:
    resting = multibody.trajectory(SHAKEN, PHASE, regularization=V_REG)
    swing = np.abs(resting.position).max()
    assert swing > 0.01
    time, position = position_against_moving_plate(SHAKEN)
    seen = [np.interp(time, resting.time, x) for x in resting.position[:, :, :2].reshape(-1, 4).T]
    np.testing.assert_allclose(position.reshape(-1, 4).T, seen, atol=5e-4 * swing)


def test_absolute_acceleration_of_the_top_body_is_that_of_its_spring() -> None:
    motion = multibody.trajectory(SHAKEN, PHASE)
    stretched = motion.position[:, 1, :2] - motion.position[:, 0, :2]
    spring = -SHAKEN.stiffness[0] * stretched / SHAKEN.masses[1]
    largest = np.abs(spring).max()
    assert largest > 2.0 * np.abs(motion.ground[:, :2]).max() / 3.0
    np.testing.assert_allclose(motion.absolute_acceleration[:, 1, :2], spring, atol=2e-3 * largest)
