"""
The reference beside SciPy's LSODA on the same points: exact equations, v_reg = 1e-3 m/s, accuracy measured on both.

Run with `python -m pytest tests/benchmarks/test_reference_speed.py -m long -s`; reference/README.md has the figures.
"""

from __future__ import annotations

import time

import numpy as np
import pytest
from numba import njit
from scipy.integrate import solve_ivp

import reference
from reference.problem import GRAVITY, exponents, ground_acceleration, ground_peak
from reference.solver.equations import exact_acceleration

V_REG = 1e-3  # m/s
LSODA_POINTS = 6  # it is slow
LSODA_TOLERANCE = 1e-8  # of its steps: its mu is then good to some 1e-6
SAMPLES = 20_001  # a peak between two of them is lost by less than 1e-6


@njit
def slope(t, y, amplitudes, s, phase, below, above, mass_ratio, radius, friction):
    """Time derivative of (x, v) of two bodies under the exact equations with friction linear below V_REG."""
    z = np.exp(s * t + 1j * phase)
    u = (amplitudes[:, 0] * z[0] + amplitudes[:, 1] * z[1]).real
    px, py, vx, vy = y[0], y[1], y[4], y[5]
    depth2 = radius * radius - px * px - py * py
    speed2 = vx * vx + vy * vy + (px * vx + py * vy) ** 2 / depth2
    factor = friction / max(np.sqrt(speed2), V_REG)
    stretch = y[2:4] - y[0:2]
    fx, fy = above[0] * stretch[0] - u[0], above[1] * stretch[1] - u[1]
    ax, ay, _, _ = exact_acceleration(
        px, py, fx, fy, GRAVITY + u[2], speed2, factor * vx, factor * vy, mass_ratio, radius
    )
    out = np.empty(8)
    out[:4] = y[4:]
    out[4], out[5] = ax, ay
    out[6], out[7] = -below[0] * stretch[0] - u[0], -below[1] * stretch[1] - u[1]
    return out


def lsoda_mu(scene, phase):
    """mu_1, mu_2 from SciPy's LSODA."""
    masses, k = scene.masses, scene.stiffness[0]
    constants = (
        scene.amplitudes, exponents(scene), np.asarray(phase), k / masses[1], k / masses[0],
        scene.total_mass / masses[0], scene.radius, scene.friction_coefficient,
    )  # fmt: skip
    times = np.linspace(0.0, scene.duration, SAMPLES)
    run = solve_ivp(
        slope, (0.0, scene.duration), np.zeros(8), "LSODA", times, args=constants,
        rtol=LSODA_TOLERANCE, atol=LSODA_TOLERANCE * 1e-2,
    )  # fmt: skip
    a = np.array([slope(t, y, *constants) for t, y in zip(run.t, run.y.T)])[:, 4:].reshape(-1, 2, 2)
    x, v = run.y[:2].T, run.y[4:6].T
    depth = np.sqrt(scene.radius**2 - (x**2).sum(axis=1))
    climb = (x * v).sum(axis=1) / depth
    vertical = ((v**2).sum(axis=1) + climb**2 + (x * a[:, 0]).sum(axis=1)) / depth
    ground = ground_acceleration(scene, phase, run.t)
    total = a + ground[:, None, :2]
    squares = (total**2).sum(axis=2) + (vertical + ground[:, 2])[:, None] ** 2
    return np.sqrt(squares.max(axis=0)) / ground_peak(scene, [phase])[0]


@pytest.mark.long
def test_the_reference_is_faster_than_lsoda_at_better_accuracy():
    scene = reference.load_scene("fig3-I")
    phases = reference.phase_grid(16)
    some = phases[:: len(phases) // LSODA_POINTS][:LSODA_POINTS]
    reference.amplification(scene, phases[:1], regularization=V_REG)  # compiled
    lsoda_mu(scene, some[0])
    begin = time.process_time()
    found = reference.amplification(scene, phases, regularization=V_REG)
    ours = (time.process_time() - begin) / len(phases)
    begin = time.process_time()
    theirs_mu = np.array([lsoda_mu(scene, phase) for phase in some])
    theirs = (time.process_time() - begin) / len(some)
    truth = reference.amplification(scene, some, regularization=V_REG, tolerance=1e-9).mu
    error = np.abs(reference.amplification(scene, some, regularization=V_REG).mu / truth - 1.0)
    their_error = np.abs(theirs_mu / truth - 1.0)
    for name, seconds, gap in (("reference", ours, error), ("LSODA", theirs, their_error)):
        print(f"\n{name}: {1e3 * seconds:.2f} ms a point, error {np.median(gap):.1e} median, {gap.max():.1e} largest")
    print(f"ratio of processor time {theirs / ours:.0f}")
    assert (found.status == "ok").all()
    assert error.max() <= their_error.max()
    assert theirs / ours > 15.0  # 41 was measured on a busy machine: the claim is the order of magnitude


@pytest.mark.long
def test_the_cost_per_step_grows_linearly_with_the_number_of_bodies():
    base = reference.load_scene("fig3-I").model_dump(exclude_none=True)

    def seconds(bodies: int) -> float:
        upper = {"mass": 0.01, "stiffness": [4000.0, 5000.0]}
        scene = reference.Scene.model_validate(
            {**base, "duration": 2.0, "bodies": [base["bodies"][0]] + [upper] * (bodies - 1)}
        )
        reference.trajectory(scene, (0.3, 1.1), times=[0.0, 2.0])
        begin = time.process_time()
        found = reference.amplification(scene, [(0.3, 1.1)], tolerance=1e-4)
        assert found.status[0] == "ok"
        return time.process_time() - begin

    few, many = seconds(30), seconds(300)
    print(f"\n30 bodies {few:.3f} s, 300 bodies {many:.3f} s, ratio {many / few:.1f} for 10 times the bodies")
    assert many / few < 40.0  # a longer chain also vibrates more slowly, so that the number of steps differs
