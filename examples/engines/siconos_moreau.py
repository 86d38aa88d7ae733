"""
Siconos: Moreau's time stepping with its solver for Coulomb's law. Needs Debian's `apt install python3-siconos`.

    python -m comparison.run fig3-I --grid 4 --model Siconos=examples.engines.siconos_moreau:amplification@resolved

Siconos belongs to the Python of Debian: this file starts that one with itself and hands it the ground motion. The law
is set-valued and truly sticks. What it cannot express: the one-sided limits at stops, since a step has one mean
acceleration. Its error in the direction of slip is of first order in the step.
"""

import io
import math
import subprocess
import sys

import numpy as np

PYTHON = "/usr/bin/python3"
KEYS = "mass", "stiffness", "damping", "radius", "friction", "step", "ground"


def amplification(scene, phases, step=1e-3):
    from reference.problem import ground_acceleration, ground_peak

    count = math.ceil(scene.duration / step)
    step = scene.duration / count
    middle = step * (np.arange(count) + 0.5)
    ground = np.array([ground_acceleration(scene, phase, middle) for phase in phases])
    question, links = io.BytesIO(), (scene.stiffness, scene.damping)
    values = scene.masses, *links, scene.radius, scene.friction_coefficient, step, ground
    np.savez(question, **dict(zip(KEYS, values)))
    run = subprocess.run([PYTHON, __file__], input=question.getvalue(), capture_output=True, timeout=600)
    if run.returncode:
        raise RuntimeError(run.stderr.decode().strip().splitlines()[-1])
    return np.load(io.BytesIO(run.stdout)) / ground_peak(scene, phases)[:, None]


def peaks(mass, stiffness, damping, radius, friction, step, ground):
    """Largest absolute acceleration of every body, m/s^2, under the ground's in the middle of every step."""
    import siconos.numerics as sn

    options = sn.SolverOptions(sn.SICONOS_FRICTION_3D_ONECONTACT_NSN)
    inverse = 1.0 / np.array([mass[0], mass[0], mass.sum()])  # all bodies share the vertical motion of the platform
    x, v, rise = np.zeros((len(mass), 2)), np.zeros((len(mass), 2)), 0.0
    reaction, velocity, coefficient = np.zeros(3), np.zeros(3), np.array([friction])
    largest = np.zeros(len(mass))
    for u in ground:
        middle = x + 0.5 * step * v
        links = stiffness * (middle[1:] - middle[:-1]) + damping * (v[1:] - v[:-1])
        a = -u[:2] + np.zeros_like(x)
        a[:-1] += links / mass[:-1, None]
        a[1:] -= links / mass[1:, None]
        px, py = middle[0]
        height = -math.sqrt(radius**2 - px * px - py * py) if math.isfinite(radius) else -1.0
        normal = np.array([-px / radius, -py / radius, -height / radius if math.isfinite(radius) else 1.0])
        first = np.array([normal[2], 0.0, -normal[0]]) / math.hypot(normal[0], normal[2])
        frame = np.array([normal, first, np.cross(normal, first)])
        before = np.array([v[0, 0], v[0, 1], rise])
        free = before + step * np.array([a[0, 0], a[0, 1], -9.81 - u[2]])
        local = frame @ free
        local[0] += normal @ before  # tangent to the sphere in the mean over the step
        problem = sn.FrictionContactProblem(3, (frame * inverse) @ frame.T, local, coefficient)
        sn.fc3d_driver(problem, reaction, velocity, options)
        after = free + inverse * (frame.T @ reaction)
        mean = (after - before) / step
        a[0] = mean[:2]
        total = (a[:, 0] + u[0]) ** 2 + (a[:, 1] + u[1]) ** 2 + (mean[2] + u[2]) ** 2
        largest = np.maximum(largest, total)
        x, v = x + step * (v + 0.5 * step * a), v + step * a
        slope = -math.sqrt(radius**2 - x[0] @ x[0]) if math.isfinite(radius) else -math.inf
        rise = -(x[0] @ v[0]) / slope
    return np.sqrt(largest)


if __name__ == "__main__":
    asked = np.load(io.BytesIO(sys.stdin.buffer.read()))
    mass, stiffness, damping, radius, friction, step, ground = (asked[key] for key in KEYS)
    numbers = float(radius), float(friction), float(step)
    answer = np.array([peaks(mass, stiffness, damping, *numbers, of_phase) for of_phase in ground])
    np.save(sys.stdout.buffer, answer)
