"""
nosnoc: finite elements that find the switches between vector fields. Needs `pip install nosnoc`.

    python -m comparison.run fig3-I --grid 2 --model-limit 600 \
        --model nosnoc=examples.engines.nosnoc_slider:amplification@resolved

Friction pushes along the nearest of `directions` to the slip velocity: nosnoc switches between finitely many vector
fields, so that the disk of friction becomes a polygon. What it cannot express beside the direction: the one-sided
limits at stops. It is slow: each step is an optimization, and a phase pair takes two minutes.
"""

import math

import casadi as ca
import nosnoc
import numpy as np

from reference.problem import GRAVITY, ground_peak
from reference.problem.excitation import exponents

STUCK, SLIDES = 1e-6, 1e-3  # m/s: between these speeds no acceleration is read, as in `resolved`


def amplification(scene, phases, step=0.02, directions=8):
    return np.array([_peaks(scene, phase, step, directions) for phase in phases]) / ground_peak(scene, phases)[:, None]


def _peaks(scene, phase, step, directions):
    """Largest absolute acceleration of every body, m/s^2."""
    masses, count = scene.masses, len(scene.masses)
    x, v, t = ca.SX.sym("x", 2, count), ca.SX.sym("v", 2, count), ca.SX.sym("t")
    u = ca.SX.zeros(3)
    for wave, exponent, angle in zip(scene.amplitudes.T, exponents(scene), phase):
        u += wave * ca.exp(exponent.real * t) * ca.cos(exponent.imag * t + angle)
    a = -ca.repmat(u[:2], 1, count)
    for j in range(count - 1):
        link = scene.stiffness[j] * (x[:, j + 1] - x[:, j]) + scene.damping[j] * (v[:, j + 1] - v[:, j])
        a[:, j] += link / masses[j]
        a[:, j + 1] -= link / masses[j + 1]
    radius, p, w = scene.radius, x[:, 0], v[:, 0]
    height = -ca.sqrt(radius**2 - ca.sumsqr(p))
    normal, velocity = ca.vertcat(-p, -height) / radius, ca.vertcat(w, -ca.dot(p, w) / height)
    first = ca.vertcat(normal[2], 0.0, -normal[0]) / ca.sqrt(normal[0] ** 2 + normal[2] ** 2)
    second, free = ca.cross(normal, first), ca.vertcat(a[:, 0], -GRAVITY - u[2])
    inverse = np.array([1.0, 1.0, masses[0] / scene.total_mass])  # all bodies share the platform's vertical motion

    def platform(direction):
        push = inverse * (normal - scene.friction_coefficient * direction)
        return free + (ca.sumsqr(velocity) / radius - ca.dot(normal, free)) / ca.dot(normal, push) * push

    angles = 2.0 * math.pi / directions * np.arange(directions)
    sides = [math.cos(angle) * first + math.sin(angle) * second for angle in angles]
    fields = [ca.vertcat(ca.vec(v), platform(side)[:2], ca.vec(a[:, 1:]), 1.0) for side in sides]
    model = nosnoc.NosnocModel(
        x=ca.vertcat(ca.vec(x), ca.vec(v), t),
        F=[ca.horzcat(*fields)],
        g_Stewart=[ca.vertcat(*(-ca.dot(side, velocity) for side in sides))],
        x0=np.zeros(4 * count + 1),
    )
    steps = math.ceil(scene.duration / step)
    options = nosnoc.NosnocOpts(n_s=2, terminal_time=scene.duration / steps, sigma_0=0.1, print_level=0)
    run = nosnoc.NosnocSimLooper(nosnoc.NosnocSolver(options, model), model.x0, steps, print_level=0)
    run.run()
    speed, sliding = ca.norm_2(velocity), platform(velocity / ca.norm_2(velocity))
    read = ca.Function("read", [model.x], [speed, sliding, a + u[:2], u])
    largest = np.zeros(count)
    for state in run.get_results()["X_sim"]:
        slip, slides, total, ground = (np.array(value).T for value in read(state))
        if not STUCK < slip < SLIDES:
            first_body = ground[0] if slip <= STUCK else slides[0] + ground[0]
            above = np.column_stack([total[1:], np.full(count - 1, first_body[2])])
            largest = np.maximum(largest, np.linalg.norm([first_body, *above], axis=1))
    return largest
