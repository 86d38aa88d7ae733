"""The order of the engine in its step, by a manufactured motion without stops."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from turning_platform import turning

import multibody

SPATIAL = {"isolator.supports": 3, "isolator.ring": 0.5, "isolator.sphere_radius": 0.02}
SPATIAL |= {"bodies.0.height": 0.0, "bodies.0.size": [1.0, 1.0, 0.2]}


@pytest.mark.parametrize("integrator", ["generalized alpha", "trapezoidal"])
@pytest.mark.parametrize(
    ("model", "chain_of", "changes"),
    [("translational", ((2.0, 1.0, 0.5), (80.0, 40.0), 0.05), {}), ("spatial", ((1.0,), (), None), SPATIAL)],
)
def test_a_motion_without_stops_is_of_second_order(
    model: str, chain_of: Any, changes: dict[str, Any], integrator: str, within: Callable[[float, float], None]
) -> None:
    """Circles over friction, exact: the error falls by four where the step is halved, to 0.03 of the order."""
    motion = turning(*chain_of, 1.0)  # of these masses, stiffnesses and damping
    scene = motion.scene.with_values(changes)
    tight: dict[str, Any] = {"newton": 1e-8, "integrator": integrator, "initial": motion.initial}
    runs = [multibody.single_run(scene, motion.phase, model, step=step, **tight) for step in (4e-3, 2e-3, 1e-3)]
    errors = [motion.error(run.time, run.position) for run in runs]
    within(abs(np.log2(np.divide(errors[:-1], errors[1:])) - 2.0).max(), 0.03)
