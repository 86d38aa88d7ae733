"""
Energy along a run: kinetic + gravity + springs = work of the ground - work of friction and dampers.

Powers are integrated by Gauss's rule between the instants where the contact sticks or slides and a grid fine enough
for the kinks that remain where a slide turns round without a rest.
"""

import numpy as np
import pytest
from chains import chain
from numpy.polynomial.legendre import leggauss

import reference
from reference.measures.energy import compute_energy
from reference.problem import GRAVITY, Scene, Trajectory, ground_acceleration, load_scene

TOLERANCE = 1e-7
GRID = 2e-3  # s
PHASE = (0.3, 1.1)
FIG3, VISCOUS = load_scene("fig3-I"), load_scene("fig4-viscous")
RISING, FALLING = (
    FIG3.with_values({"isolator.friction": {"slow": slow, "fast": fast, "rate": rate}})
    for slow, fast, rate in ((0.04, 0.1, 80.0), (0.1, 0.05, 30.0))
)
TWO = {"masses": [1.0, 1.0], "stiffness": [[17.0, 27.0]]}
VERTICAL = [[1.0, 0.4], [-0.3, 1.2], [1.3, 0.9]]
RUNS = {  # scene, equations, v_reg
    "rest, slide, stop": (FIG3, "exact", None),
    "rest, slide, stop, small": (FIG3, "small", None),
    "vertical loading": (chain(0.4, 0.07, [2.0, 1.0, 0.5], [[150.0, 110.0], [180.0, 240.0]], VERTICAL), "exact", None),
    "deep swing": (chain(0.25, 0.1, amplitudes=[[2.8, 1.0], [0.5, 2.8]], periods=[1.2, 1.4], **TWO), "exact", None),
    "regularized, small": (FIG3, "small", 1e-2),
    "falling friction": (FALLING, "exact", None),
    "falling friction, small": (FALLING, "small", None),
    "rising friction, regularized": (RISING, "exact", 1e-3),
    "lubricated, small": (VISCOUS, "small", None),
    "frictionless": (chain(0.25, 0.0, amplitudes=[[0.6, 0.2], [0.1, 0.6]], **TWO), "exact", None),
    "damped, lubricated": (chain(0.3, lubrication=0.8, amplitudes=VERTICAL, damping=0.4, **TWO), "exact", None),
}


def slip_force(scene: Scene, v_reg: float | None, velocity: np.ndarray) -> np.ndarray:
    """Friction force over the contact force, (T, 3), opposite to the slip."""
    if scene.lubricated:
        return -scene.friction_coefficient * velocity
    law, speed = scene.dry_friction, np.linalg.norm(velocity, axis=1)
    coefficient = law.fast - (law.fast - law.slow) * np.exp(-law.rate * speed)
    return -(coefficient / np.maximum(speed, v_reg or 1e-300))[:, None] * velocity


def energy_and_powers(
    scene: Scene, equations: str, v_reg: float | None, motion: Trajectory
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Stored energy, J, and power of the ground, and of friction and dampers, W, (T,) each."""
    ground, velocity, place = ground_acceleration(scene, PHASE, motion.time), motion.velocity, motion.position
    kinetic = 0.5 * (scene.masses[:, None] * velocity[:, :, :2] ** 2).sum(axis=(1, 2))
    energy = kinetic + 0.5 * (scene.stiffness * np.diff(place[:, :, :2], axis=1) ** 2).sum(axis=(1, 2))
    shaking = -(scene.masses[:, None] * velocity[:, :, :2] * ground[:, None, :2]).sum(axis=(1, 2))
    friction = slip_force(scene, v_reg, velocity[:, 0])
    dampers = -(scene.damping * np.diff(velocity[:, :, :2], axis=1) ** 2).sum(axis=(1, 2))
    if equations == "small":
        platform = velocity[:, 0, :2]
        energy += 0.5 * scene.total_mass * GRAVITY / scene.radius * (place[:, 0, :2] ** 2).sum(axis=-1)
        along = (place[:, 0, :2] * friction[:, :2]).sum(axis=-1) * (ground[:, :2] * platform).sum(axis=-1)
        weight = (friction[:, :2] * platform).sum(axis=-1) * scene.total_mass * (GRAVITY + ground[:, 2])
        friction = weight - scene.masses[0] * along / scene.radius  # the terms with xi'' x of (4.3)
        return energy, shaking, friction + dampers
    energy += scene.total_mass * (0.5 * velocity[:, 0, 2] ** 2 + GRAVITY * place[:, 0, 2])
    shaking -= scene.total_mass * velocity[:, 0, 2] * ground[:, 2]
    return energy, shaking, motion.contact_force * (friction * velocity[:, 0]).sum(axis=-1) + dampers


@pytest.mark.parametrize(("scene", "equations", "v_reg"), RUNS.values(), ids=RUNS)
def test_energy_is_balanced(scene, equations, v_reg, within):
    """At every instant, to ten times the tolerance of the largest amount of energy that is exchanged."""
    law = PHASE, equations, v_reg, TOLERANCE
    corners = [t for interval in reference.trajectory(scene, *law).stick for t in interval]
    edges = np.unique(np.concatenate([np.arange(0.0, scene.duration, GRID), corners, [scene.duration]]))
    edges = edges[np.append(True, np.diff(edges) > 1e-9)]
    nodes, weights = leggauss(3)
    width = np.diff(edges)[:, None]
    motion = reference.trajectory(scene, *law, times=(edges[:-1, None] + 0.5 * width * (1.0 + nodes)).ravel())
    assert motion.status == "ok"
    energy, shaking, friction = energy_and_powers(scene, equations, v_reg, motion)
    found = compute_energy(motion)
    np.testing.assert_allclose(found.stored, energy, rtol=1e-10, atol=1e-12 * energy.max())
    np.testing.assert_allclose(found.ground, shaking, rtol=1e-9, atol=1e-9 * np.abs(shaking).max())
    assert np.all(friction <= 1e-12 * np.abs(shaking).max())
    works = [np.cumsum((0.5 * width * weights).ravel() * power)[2::3] for power in (shaking + friction, abs(shaking))]
    # energy at the cells' ends, where works are whole, by the parabola through the three nodes of the cell
    basis = [np.prod([(1.0 - nodes[j]) / (nodes[k] - nodes[j]) for j in range(3) if j != k]) for k in range(3)]
    within(abs(energy.reshape(-1, 3) @ np.array(basis) - works[0]).max() / works[1][-1], 10.0 * TOLERANCE)
