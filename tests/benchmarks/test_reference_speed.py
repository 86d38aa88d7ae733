"""
The reference beside LSODA, called by SciPy and by compiled code (numbalsoda): exact equations, v_reg = 1e-3 m/s.

The accuracy is measured on both.

Run with `python -m pytest tests/benchmarks/test_reference_speed.py -m long -s`; reference/README.md has the figures.
"""

from __future__ import annotations

import time
from functools import cache

import numpy as np
import pytest
from numba import carray, cfunc, njit
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


@njit
def accelerations(times, states, *constants):
    out = np.empty_like(states)
    for n in range(len(times)):
        out[n] = slope(times[n], states[n], *constants)
    return out


def constants_of(scene, phase):
    masses, k = scene.masses, scene.stiffness[0]
    return (
        scene.amplitudes, exponents(scene), np.asarray(phase), k / masses[1], k / masses[0],
        scene.total_mass / masses[0], scene.radius, scene.friction_coefficient,
    )  # fmt: skip


def scipy_motion(scene, phase):
    """Times (T,) and states (T, 8) from SciPy's LSODA."""
    times = np.linspace(0.0, scene.duration, SAMPLES)
    run = solve_ivp(
        slope, (0.0, scene.duration), np.zeros(8), "LSODA", times, args=constants_of(scene, phase),
        rtol=LSODA_TOLERANCE, atol=LSODA_TOLERANCE * 1e-2,
    )  # fmt: skip
    return run.t, run.y.T


def numbalsoda_motion(scene, phase):
    """Times (T,) and states (T, 8) from LSODA called by compiled code."""
    from numbalsoda import lsoda

    amplitudes, s, alpha, *rest = constants_of(scene, phase)
    data = np.concatenate([amplitudes.ravel(), s.real, s.imag, alpha, *[np.atleast_1d(part) for part in rest]])
    times = np.linspace(0.0, scene.duration, SAMPLES)
    states, success = lsoda(
        compiled_slope(), np.zeros(8), times, data, rtol=LSODA_TOLERANCE, atol=LSODA_TOLERANCE * 1e-2
    )
    assert success
    return times, states


@cache
def compiled_slope():
    """Address of `slope` in the form that numbalsoda calls."""
    from numbalsoda import lsoda_sig

    @cfunc(lsoda_sig)
    def right_hand_side(t, y, dy, data):
        p = carray(data, (19,))
        s = p[6:8] + 1j * p[8:10]
        out = slope(t, carray(y, (8,)), p[:6].reshape((3, 2)), s, p[10:12], p[12:14], p[14:16], p[16], p[17], p[18])
        state = carray(dy, (8,))
        for i in range(8):
            state[i] = out[i]

    return right_hand_side.address


def lsoda_mu(scene, phase, motion):
    """mu_1, mu_2 read from a motion of LSODA."""
    constants = constants_of(scene, phase)
    t, y = motion(scene, phase)
    a = accelerations(t, y, *constants)[:, 4:].reshape(-1, 2, 2)
    x, v = y[:, :2], y[:, 4:6]
    depth = np.sqrt(scene.radius**2 - (x**2).sum(axis=1))
    climb = (x * v).sum(axis=1) / depth
    vertical = ((v**2).sum(axis=1) + climb**2 + (x * a[:, 0]).sum(axis=1)) / depth
    ground = ground_acceleration(scene, phase, t)
    total = a + ground[:, None, :2]
    squares = (total**2).sum(axis=2) + (vertical + ground[:, 2])[:, None] ** 2
    return np.sqrt(squares.max(axis=0)) / ground_peak(scene, [phase])[0]


@pytest.mark.long
@pytest.mark.parametrize("motion", [scipy_motion, numbalsoda_motion])
def test_the_reference_is_faster_than_lsoda_at_better_accuracy(motion):
    if motion is numbalsoda_motion:
        pytest.importorskip("numbalsoda", reason="needs a C++ and a Fortran compiler to be installed")
    scene = reference.load_scene("fig3-I")
    phases = reference.phase_grid(16)
    some = phases[:: len(phases) // LSODA_POINTS][:LSODA_POINTS]
    reference.amplification(scene, phases[:1], regularization=V_REG)  # compiled
    lsoda_mu(scene, some[0], motion)
    begin = time.process_time()
    found = reference.amplification(scene, phases, regularization=V_REG)
    ours = (time.process_time() - begin) / len(phases)
    begin = time.process_time()
    theirs_mu = np.array([lsoda_mu(scene, phase, motion) for phase in some])
    theirs = (time.process_time() - begin) / len(some)
    truth = reference.amplification(scene, some, regularization=V_REG, tolerance=1e-9).mu
    error = np.abs(reference.amplification(scene, some, regularization=V_REG).mu / truth - 1.0)
    their_error = np.abs(theirs_mu / truth - 1.0)
    for name, seconds, gap in (("reference", ours, error), (motion.__name__, theirs, their_error)):
        print(f"\n{name}: {1e3 * seconds:.2f} ms a point, error {np.median(gap):.1e} median, {gap.max():.1e} largest")
    print(f"ratio of processor time {theirs / ours:.1f}")
    assert (found.status == "ok").all()
    assert error.max() <= their_error.max()
    # 78 (SciPy) was measured on a busy machine, its calls of Python included: the claim is the order of magnitude
    assert theirs / ours > (30.0 if motion is scipy_motion else 1.0)


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
