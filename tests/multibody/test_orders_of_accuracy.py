"""Orders of the engine in its step: a manufactured motion without stops, and a slide that stops."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from chains import chain
from turning_platform import turning

import multibody
from reference.problem import GRAVITY, State

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


def test_a_stop_keeps_the_second_order() -> None:
    """Below v_reg a slide ends exponentially. The order is fitted to 13 steps: the corner's place in one scatters."""
    friction, speed, creep, duration = 0.1, 0.5, 1e-2, 1.0
    scene = chain(np.inf, friction, amplitudes=((0.0, 0.0), (0.0, 0.0)), duration=duration)
    state = State(np.zeros((1, 2)), np.array([[speed, 0.0]]))
    braking = friction * GRAVITY
    left = duration - (speed - creep) / braking
    exact = (speed**2 - creep**2) / (2.0 * braking) + creep**2 / braking * (1.0 - np.exp(-braking * left / creep))
    steps = 0.01 * 2.0 ** -np.arange(0.0, 3.1, 0.25)
    asked: dict[str, Any] = {"regularization": creep, "newton": 1e-8, "residual": 1e-8, "initial": state}
    runs = [multibody.single_run(scene, (0.0, 0.0), step=step, **asked) for step in steps]
    errors = [abs(run.position[-1, 0, 0] - exact) for run in runs]
    assert np.polyfit(np.log(steps), np.log(errors), 1)[0] == pytest.approx(2.0, abs=0.4)
