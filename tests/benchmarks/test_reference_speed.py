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
from numba import carray, cfunc

import reference
from comparison.tradeoff.outside import constants_of, factors, motion, slope

V_REG = 1e-3  # m/s
LSODA_POINTS = 6  # it is slow
SAMPLES = 20_001  # of numbalsoda's motion: a smooth peak between two is lost by less than 1e-6
LSODA_TOLERANCE = 1e-8  # of its steps: its mu is then good to some 1e-6


def scipy_motion(scene, phase):
    """Times (T,) and states (T, 8) from SciPy's LSODA."""
    return motion(scene, phase, "LSODA", LSODA_TOLERANCE, V_REG)


def numbalsoda_motion(scene, phase):
    """Times (T,) and states (T, 8) from LSODA called by compiled code."""
    from numbalsoda import lsoda

    amplitudes, s, alpha, *rest = constants_of(scene, phase, V_REG)
    data = np.concatenate([amplitudes.ravel(), s.real, s.imag, alpha, *[np.ravel(part) for part in rest]])
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
        p = carray(data, (24,))
        s = p[6:8] + 1j * p[8:10]
        below, above = p[12:16].reshape((2, 2)), p[16:20].reshape((2, 2))
        out = slope(
            t, carray(y, (8,)), p[:6].reshape((3, 2)), s, p[10:12], below, above, p[20], p[21], p[22], p[23]
        )  # fmt: skip
        state = carray(dy, (8,))
        for i in range(8):
            state[i] = out[i]

    return right_hand_side.address


@pytest.mark.long
@pytest.mark.parametrize("solver", [scipy_motion, numbalsoda_motion])
def test_the_reference_is_faster_than_lsoda_at_better_accuracy(solver):
    if solver is numbalsoda_motion:
        pytest.importorskip("numbalsoda", reason="needs a C++ and a Fortran compiler to be installed")
    scene = reference.load_scene("fig3-I")
    phases = reference.phase_grid(16)
    some = phases[:: len(phases) // LSODA_POINTS][:LSODA_POINTS]
    reference.amplification(scene, phases[:1], regularization=V_REG)  # compiled
    factors(scene, some[0], *solver(scene, some[0]), V_REG)
    begin = time.process_time()
    found = reference.amplification(scene, phases, regularization=V_REG)
    ours = (time.process_time() - begin) / len(phases)
    begin = time.process_time()
    theirs_mu = np.array([factors(scene, phase, *solver(scene, phase), V_REG) for phase in some])
    theirs = (time.process_time() - begin) / len(some)
    truth = reference.amplification(scene, some, regularization=V_REG, tolerance=1e-9).mu
    error = np.abs(reference.amplification(scene, some, regularization=V_REG).mu / truth - 1.0)
    their_error = np.abs(theirs_mu / truth - 1.0)
    for name, seconds, gap in (("reference", ours, error), (solver.__name__, theirs, their_error)):
        print(f"\n{name}: {1e3 * seconds:.2f} ms a point, error {np.median(gap):.1e} median, {gap.max():.1e} largest")
    print(f"ratio of processor time {theirs / ours:.1f}")
    assert (found.status == "ok").all()
    assert error.max() <= their_error.max()
    # 78 (SciPy) was measured on a busy machine, its calls of Python included: the claim is the order of magnitude
    assert theirs / ours > (30.0 if solver is scipy_motion else 1.0)


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
