"""
The start of a model whose supports share the load: its stiff parts in balance with the loading's first value.

Supports that start with equal shares are out of balance by the overturning moment. They would swing for a few of the
contact's own periods, with an acceleration that no stiffness makes smaller. So contacts and links settle first, without
friction as at rest, under the loading's value at zero. Their deflection is kept, the motion is not. A loading that is
gone before a contact swings is nothing they could settle under.
"""

from __future__ import annotations

import math

import numpy as np

from multibody.integration.constant_step import Engine
from multibody.models.system import EngineModel, EngineState

SETTLING_TIME = 60.0  # over sqrt(penetration): links and contacts have settled
SETTLING_STEPS = 300
MAX_STRETCH = 0.1  # units of time at once: the distance covered meanwhile stays small beside the sphere


def balanced_start(engine: Engine, start: EngineState, penetration: float) -> EngineState:
    """`start` with its stiff coordinates and contacts settled; `start` itself if it needs no balance or gets none."""
    model = engine.model
    swing = math.sqrt(max(penetration, model.bearing_penetration))
    if model.set_frictionless is None or model.ground.decay_rate * swing > 1.0:
        return start
    span = SETTLING_TIME * swing
    stretches = math.ceil(span / MAX_STRETCH)
    state = start
    model.set_frictionless(True)
    model.ground.hold(True)
    for _ in range(stretches):
        motion = engine.run(state, 0.0, span / SETTLING_STEPS, math.ceil(SETTLING_STEPS / stretches))
        if motion is None or not np.isfinite(motion.coordinates[-1]).all():
            state = start
            break
        state = _returned(model, start, motion.state(-1))
    model.ground.hold(False)
    model.set_frictionless(False)
    return state


def _returned(model: EngineModel, start: EngineState, settled: EngineState) -> EngineState:
    """The deflections of contacts and links in `settled`, at the place and with the velocities of `start`."""
    coordinates, contact = settled.coordinates.copy(), settled.contact.copy()
    bodies = model.bodies
    # the horizontal distance covered meanwhile also lifts the platform along the sphere
    rise = 0.0 if model.rim == math.inf else 0.5 * float((coordinates[bodies[0, :2]] ** 2).sum())
    coordinates[bodies[:, :2]] = start.coordinates[bodies[:, :2]]
    coordinates[bodies[:, 2]] -= rise
    if model.undeformed is not None:  # bars that give way are no part of what settles
        coordinates = model.undeformed(coordinates, start.coordinates)
    contact[1::4] = start.contact[1::4]
    return EngineState(coordinates, start.velocities, contact)
