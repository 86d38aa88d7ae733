"""Energy along a whole run of the chain: what the plate's motion puts in is stored or rubbed away."""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid, trapezoid

import multibody
from reference.problem import GRAVITY, ground_acceleration, load_scene


@pytest.mark.long
def test_energy_equals_the_plate_s_work_less_friction(within: Callable[[float, float], None]) -> None:
    scene, phase, v_reg = load_scene("fig3-I"), (2.0, 0.7), 1e-3
    motion = multibody.trajectory(scene, phase, regularization=v_reg, tolerance=1e-4)
    x, v = motion.position, motion.velocity
    stretch = np.diff(x[..., :2], axis=1)
    stored = (
        0.5 * (scene.masses[:, None] * v**2).sum(axis=(1, 2))
        + 0.5 * (scene.stiffness * stretch**2).sum(axis=(1, 2))
        + scene.total_mass * GRAVITY * x[:, 0, 2]
    )
    ground = ground_acceleration(scene, phase, motion.time)
    supplied = -(scene.masses[:, None] * v * ground[:, None, :]).sum(axis=(1, 2))
    slip = np.linalg.norm(v[:, 0], axis=-1)
    rubbed = scene.friction_coefficient * motion.contact_force * np.minimum(1.0, slip / v_reg) * slip
    power = supplied - rubbed
    work = cumulative_trapezoid(power, motion.time, initial=0.0)
    lost = trapezoid(rubbed, motion.time)
    assert lost > stored.max()
    # trapezoid rule at the engine's own instants, 1 ms apart and closer at stops
    within(abs(stored - work).max() / lost, 2e-5)
