"""
Energy along a run: kinetic + gravity + springs = work of the ground - work of friction and dampers.

Powers are integrated by Gauss's rule between the instants where the contact sticks or slides and a grid fine enough
for the kinks that remain where a slide turns round without a rest.
"""

from typing import NamedTuple

import numpy as np
import pytest
from chains import chain
from numpy.polynomial.legendre import leggauss

import reference
from reference.problem import GRAVITY, Scene, Trajectory, ground_acceleration, load_scene
from reference.problem.tables import VelocityFriction

TOLERANCE = 1e-7
GRID = 2e-3  # s
PHASE = (0.3, 1.1)


class Run(NamedTuple):
    scene: Scene
    equations: str = "exact"
    regularization: float | None = None


def damped(scene: Scene, damping: float | list[float]) -> Scene:
    return scene.with_values({f"bodies.{i}.damping": damping for i in range(1, len(scene.bodies))})


FIG3, VISCOUS = load_scene("fig3-I"), load_scene("fig4-viscous")
RISING, FALLING = (
    FIG3.with_values({"isolator.friction": {"slow": slow, "fast": fast, "rate": rate}})
    for slow, fast, rate in ((0.04, 0.1, 80.0), (0.1, 0.05, 30.0))
)
TWO = {"masses": [1.0, 1.0], "stiffness": [[17.0, 27.0]]}
VERTICAL = [[1.0, 0.4], [-0.3, 1.2], [1.3, 0.9]]
RUNS = {
    "rest, slide, stop": Run(FIG3),
    "rest, slide, stop, small": Run(FIG3, "small"),
    "planar": Run(load_scene("fig4-dry")),
    "vertical loading": Run(chain(0.4, 0.07, [2.0, 1.0, 0.5], [[150.0, 110.0], [180.0, 240.0]], VERTICAL)),
    "deep swing": Run(chain(0.25, 0.1, amplitudes=[[2.8, 1.0], [0.5, 2.8]], periods=[1.2, 1.4], **TWO)),
    "regularized": Run(FIG3, regularization=1e-3),
    "regularized, small": Run(FIG3, "small", 1e-2),
    "friction that rises with the speed": Run(RISING),
    "falls": Run(FALLING),
    "falls, small": Run(FALLING, "small"),
    "rises, regularized": Run(RISING, regularization=1e-3),
    "lubricated": Run(VISCOUS),
    "lubricated, small": Run(VISCOUS, "small"),
    "frictionless": Run(chain(0.25, 0.0, amplitudes=[[0.6, 0.2], [0.1, 0.6]], **TWO)),
    "damped": Run(damped(FIG3, 0.03)),
    "damped, regularized, small": Run(damped(load_scene("fig3-II"), [0.7, 0.2]), "small", 1e-3),
    "damped, lubricated, vertical": Run(damped(chain(0.3, lubrication=0.8, amplitudes=VERTICAL, **TWO), 0.4)),
    "held": Run(chain(0.25, 0.6, **TWO)),
    "one body": Run(chain(0.25, 0.05, [2.0], amplitudes=[[2.0, 0.5], [0.3, 1.5]])),
}


def sampled(run: Run) -> tuple[Trajectory, np.ndarray]:
    """The run at Gauss nodes, with the weights of the nodes."""
    plain = reference.trajectory(run.scene, PHASE, run.equations, run.regularization, TOLERANCE)
    duration = run.scene.duration
    corners = [t for interval in plain.stick for t in interval]
    edges = np.unique(np.concatenate([np.arange(0.0, duration, GRID), corners, [duration]]))
    edges = edges[np.append(True, np.diff(edges) > 1e-9)]
    nodes, weights = leggauss(3)
    width = np.diff(edges)[:, None]
    times = (edges[:-1, None] + 0.5 * width * (1.0 + nodes)).ravel()
    motion = reference.trajectory(run.scene, PHASE, run.equations, run.regularization, TOLERANCE, times=times)
    return motion, (0.5 * width * weights).ravel()


def slip_force(run: Run, motion: Trajectory) -> np.ndarray:
    """Friction force over the contact force, (T, 3), opposite to the slip, where the contact slides."""
    velocity = motion.velocity[:, 0]
    speed = np.sqrt((velocity**2).sum(axis=-1))
    coefficient = run.scene.friction_coefficient
    if run.scene.lubricated:
        return -coefficient * velocity
    if isinstance(run.scene.isolator.friction, VelocityFriction):
        law = run.scene.isolator.friction
        coefficient = (law.fast - (law.fast - law.slow) * np.exp(-law.rate * speed))[:, None]
    if run.regularization is not None:
        return -coefficient * velocity / np.maximum(speed, run.regularization)[:, None]
    moving = speed > 0.0
    return -coefficient * velocity / np.where(moving, speed, 1.0)[:, None]


def stored(run: Run, motion: Trajectory) -> np.ndarray:
    """Kinetic, elastic and gravitational energy, (T,), J."""
    scene = run.scene
    kinetic = 0.5 * (scene.masses[:, None] * motion.velocity[:, :, :2] ** 2).sum(axis=(1, 2))
    elastic = 0.5 * (scene.stiffness * np.diff(motion.position[:, :, :2], axis=1) ** 2).sum(axis=(1, 2))
    if run.equations == "small":
        square = (motion.position[:, 0, :2] ** 2).sum(axis=-1)
        return kinetic + elastic + 0.5 * scene.total_mass * GRAVITY / scene.radius * square
    vertical = 0.5 * scene.total_mass * motion.velocity[:, 0, 2] ** 2
    return kinetic + elastic + vertical + scene.total_mass * GRAVITY * motion.position[:, 0, 2]


def powers(run: Run, motion: Trajectory) -> tuple[np.ndarray, np.ndarray]:
    """Power of the ground, and of friction and dampers, (T,) each, W."""
    scene = run.scene
    ground = ground_acceleration(scene, PHASE, motion.time)
    velocity = motion.velocity
    shaking = -(scene.masses[:, None] * velocity[:, :, :2] * ground[:, None, :2]).sum(axis=(1, 2))
    friction = slip_force(run, motion)
    dampers = -(scene.damping * np.diff(velocity[:, :, :2], axis=1) ** 2).sum(axis=(1, 2))
    if run.equations == "small":
        platform, place = velocity[:, 0, :2], motion.position[:, 0, :2]
        along = (place * friction[:, :2]).sum(axis=-1) * (ground[:, :2] * platform).sum(axis=-1)
        weight = (friction[:, :2] * platform).sum(axis=-1) * scene.total_mass * (GRAVITY + ground[:, 2])
        friction = weight - scene.masses[0] * along / scene.radius  # the terms with xi'' x of (4.3)
        return shaking, friction + dampers
    shaking -= scene.total_mass * velocity[:, 0, 2] * ground[:, 2]
    return shaking, motion.contact_force * (friction * velocity[:, 0]).sum(axis=-1) + dampers


@pytest.mark.parametrize("run", RUNS.values(), ids=RUNS)
def test_energy_is_balanced(run, within):
    """At every instant, to ten times the tolerance of the largest amount of energy that is exchanged."""
    motion, weights = sampled(run)
    assert motion.status == "ok"
    shaking, friction = powers(run, motion)
    # work up to a node: all earlier nodes in full and half of its own, so compare where cells end
    work = np.cumsum(weights * (shaking + friction))[2::3]
    exchanged = np.cumsum(weights * np.abs(shaking))[-1]
    energy = stored(run, motion)
    # energy at the cells' ends, by the parabola through the three nodes of the cell
    nodes, _ = leggauss(3)
    basis = [np.prod([(1.0 - nodes[j]) / (nodes[k] - nodes[j]) for j in range(3) if j != k]) for k in range(3)]
    ends = energy.reshape(-1, 3) @ np.array(basis)
    assert np.all(friction <= 1e-12 * np.abs(shaking).max())
    within(abs(ends - work).max() / exchanged, 10.0 * TOLERANCE)
