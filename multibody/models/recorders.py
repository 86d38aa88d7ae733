"""Sensors of a model: everything a run is judged by, kept in the engine's memory and read back after each chunk."""

from __future__ import annotations

from typing import Any

from multibody.models.engine import exudyn, items
from multibody.models.system import Recorders


def add_recorders(
    mbs: Any, nodes: list[Any], contact_nodes: list[Any], contacts: list[Any], plate: Any = None
) -> Recorders:
    """Motion of `nodes`, gap and slip at `contact_nodes`, force and normal of `contacts`, motion of node `plate`."""
    kind = exudyn.OutputVariableType

    def at(node: Any, quantity: Any) -> Any:
        sensor = items.SensorNode(nodeNumber=node, outputVariableType=quantity, storeInternal=True, writeToFile=False)
        return mbs.AddSensor(sensor)

    def of(contact: Any, quantity: Any) -> Any:
        sensor = items.SensorObject(
            objectNumber=contact, outputVariableType=quantity, storeInternal=True, writeToFile=False
        )
        return mbs.AddSensor(sensor)

    motion = (kind.Coordinates, kind.Coordinates_t, kind.Coordinates_tt)
    return Recorders(
        coordinates=[at(node, kind.Coordinates) for node in nodes],
        velocities=[at(node, kind.Coordinates_t) for node in nodes],
        accelerations=[at(node, kind.Coordinates_tt) for node in nodes],
        contact=[at(node, kind.Coordinates) for node in contact_nodes],
        contact_force=[of(contact, quantity) for contact in contacts for quantity in (kind.Force, kind.Director1)],
        plate=[] if plate is None else [at(plate, quantity) for quantity in motion],
    )
