"""Sensors of a model, which record motion and contacts in the engine's memory to be read after each chunk."""

from __future__ import annotations

from typing import Any

from multibody.models.engine import exudyn, items
from multibody.models.system import Recorders


def add_recorders(
    mbs: Any,
    nodes: list[Any],
    linear: list[Any],
    contact_nodes: list[Any],
    contacts: list[Any],
) -> Recorders:
    """
    Add the sensors that record a run, and return them.

    The motion is recorded of `nodes` and of `linear`, objects with linear equations. Gap and slip speed are recorded of
    `contact_nodes`, the data nodes of all contacts. Force and normal are recorded of `contacts`.
    """
    kind = exudyn.OutputVariableType

    def sense_node(node: Any, quantity: Any) -> Any:
        """Return a new sensor that keeps a quantity of a node in memory."""
        sensor = items.SensorNode(nodeNumber=node, outputVariableType=quantity, storeInternal=True, writeToFile=False)
        return mbs.AddSensor(sensor)

    def sense_object(contact: Any, quantity: Any) -> Any:
        """Return a new sensor that keeps a quantity of a contact in memory."""
        sensor = items.SensorObject(
            objectNumber=contact, outputVariableType=quantity, storeInternal=True, writeToFile=False
        )
        return mbs.AddSensor(sensor)

    def sense_body(body: Any, quantity: Any) -> Any:
        """Return a new sensor that keeps a quantity of an object with linear equations in memory."""
        sensor = items.SensorBody(bodyNumber=body, outputVariableType=quantity, storeInternal=True, writeToFile=False)
        return mbs.AddSensor(sensor)

    def add_motion_sensors(quantity: Any) -> list[Any]:
        """Add a sensor of a quantity of motion for every node and object with linear equations; return the sensors."""
        return [sense_node(node, quantity) for node in nodes] + [sense_body(body, quantity) for body in linear]

    return Recorders(
        coordinates=add_motion_sensors(kind.Coordinates),
        velocities=add_motion_sensors(kind.Coordinates_t),
        accelerations=add_motion_sensors(kind.Coordinates_tt),
        contact=[sense_node(node, kind.Coordinates) for node in contact_nodes],
        contact_force=[
            sense_object(contact, quantity) for contact in contacts for quantity in (kind.Force, kind.Director1)
        ],
    )
