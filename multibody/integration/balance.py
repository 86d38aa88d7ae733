"""
The start of a model whose supports share the load: its stiff parts in balance with the loading's first value.

Supports that start with equal shares would be out of balance by the overturning moment and swing for a few of the
contact's own periods, with an acceleration that no stiffness makes smaller. So contacts and bars are let settle,
without friction as at rest, under the loading just before zero; what they give way is kept, the motion is not.
"""

from __future__ import annotations

import math

import numpy as np

from multibody.integration.constant_step import Engine
from multibody.integration.level import Level
from multibody.models.system import EngineState

TIMES = 60.0  # sqrt(penetration): bars and contacts have settled
STEPS = 300
LONGEST = 0.1  # units of time at once: what the platform covers meanwhile stays small beside the sphere


def balanced(engine: Engine, start: EngineState, level: Level) -> EngineState:
    """`start` with its stiff coordinates and contacts settled; `start` itself if it needs no balance or gets none."""
    model = engine.model
    if model.slippery is None:
        return start
    span = TIMES * math.sqrt(max(level.penetration, model.bearings))
    stretches = math.ceil(span / LONGEST)
    state = start
    model.slippery(True)
    model.ground.set_shift(-span / stretches)
    for _ in range(stretches):
        settled = engine.run(state, 0.0, span / STEPS, math.ceil(STEPS / stretches))
        if settled is None or not np.isfinite(settled.coordinates[-1]).all():
            state = start
            break
        state = _back_in_place(engine, start, settled.state(-1))
    model.ground.set_shift(0.0)
    model.slippery(False)
    return state


def _back_in_place(engine: Engine, start: EngineState, settled: EngineState) -> EngineState:
    """What contacts and bars give way by in `settled`, at the place and with the velocities of `start`."""
    coordinates, contact = settled.coordinates.copy(), settled.contact.copy()
    bodies = engine.model.bodies
    # the horizontal way covered meanwhile, d, also lifts the platform along the sphere
    lifted = 0.5 * float((coordinates[bodies[0, :2]] ** 2).sum())
    coordinates[bodies[:, :2]] = start.coordinates[bodies[:, :2]]
    coordinates[bodies[:, 2]] -= lifted
    contact[1::4] = start.contact[1::4]
    return EngineState(coordinates, start.velocities, contact)
