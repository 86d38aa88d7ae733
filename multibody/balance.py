"""
The start of a model whose supports share the load: its stiff parts in balance with the loading's first value.

Supports that start with equal shares would be out of balance by the overturning moment and swing for a few of the
contact's own periods, with an acceleration that no stiffness makes smaller. So contacts and bars are let settle,
without friction as at rest, under the loading just before zero; what they give way is kept, the motion is not.
"""

from __future__ import annotations

import math

import numpy as np

from multibody.integrate import Engine
from multibody.level import Level
from multibody.system import EngineState

TIMES = 60.0  # sqrt(penetration): bars and contacts have settled
STEPS = 300


def balanced(engine: Engine, start: EngineState, level: Level) -> EngineState:
    """`start` with its stiff coordinates and contacts settled; `start` itself if it needs no balance or gets none."""
    model = engine.model
    if model.slippery is None:
        return start
    span = TIMES * math.sqrt(level.penetration)
    model.slippery(True)
    model.ground.set_shift(-span)
    settled = engine.run(start, 0.0, span / STEPS, STEPS)
    model.ground.set_shift(0.0)
    model.slippery(False)
    if settled is None or not np.isfinite(settled.coordinates[-1]).all():
        return start
    coordinates, contact = settled.coordinates[-1].copy(), settled.contact[-1].copy()
    moving = model.bodies[:, :2]
    # the horizontal way covered meanwhile, d, also lifts the platform along the sphere
    lifted = 0.5 * float((coordinates[moving[0]] ** 2).sum())
    coordinates[moving] = start.coordinates[moving]
    coordinates[model.bodies[:, 2]] -= lifted
    contact[1::4] = start.contact[1::4]
    return EngineState(coordinates, start.velocities, contact)
