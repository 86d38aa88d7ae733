"""
The reference beside SciPy's LSODA: exact equations, v_reg = 1e-3 m/s.

The accuracy is measured on both, and the reference has to be the better one. LSODA is read well: at its own steps, and
fifty times as closely around its peaks; on a fixed grid of instants it misses the short peaks at stops.

Run with `python -m pytest tests/benchmarks/test_reference_speed.py -m long -s`; reference/README.md has the figures.
"""

import os
import subprocess
import sys
import time

import numpy as np
import pytest

import reference
from comparison.analyses.tradeoff.outside import factors, motion
from reference.solver.error_estimate import MAX_STEP_TOLERANCE, peaks_at, peaks_with_error
from reference.surface import checked_demand

V_REG = 1e-3  # m/s
# most a point may cost, in accurate runs to the end of the motion; seen: 1.08, 1.29, 1.59, 1.19
MOST_RUNS_FOR_A_POINT = {"fig3-I": 1.3, "fig3-II": 1.6, "fig4-dry": 2.0, "fig4-viscous": 1.5}
LSODA_POINTS = 6  # it is slow


def compared(their_tolerance, our_tolerance):
    """Their processor time over ours for one point; asserts that our mu is nearer to the truth, median and worst."""
    scene = reference.load_scene("fig3-I")
    phases = reference.phase_grid(16)
    some = phases[:: len(phases) // LSODA_POINTS][:LSODA_POINTS]

    def ours(at, tolerance):
        return reference.amplification(scene, at, regularization=V_REG, tolerance=tolerance)

    def theirs(phase):
        return factors(scene, phase, *motion(scene, phase, "LSODA", their_tolerance, V_REG), V_REG)

    ours(phases[:1], our_tolerance)  # compiled
    theirs(some[0])
    truth = ours(some, 1e-10)
    begin = time.process_time()
    found = ours(phases, our_tolerance)
    our_time = (time.process_time() - begin) / len(phases)
    begin = time.process_time()
    their_mu = np.array([theirs(phase) for phase in some])
    their_time = (time.process_time() - begin) / len(some)
    error = np.abs(ours(some, our_tolerance).mu / truth.mu - 1.0)
    their_error = np.abs(their_mu / truth.mu - 1.0)
    rows = (
        (f"reference {our_tolerance:.0e}", our_time, error),
        (f"LSODA {their_tolerance:.0e}", their_time, their_error),
    )
    for name, seconds, gap in rows:
        print(f"\n{name}: {1e3 * seconds:.2f} ms a point, error {np.median(gap):.1e} median, {gap.max():.1e} largest")
    print(f"ratio of processor time {their_time / our_time:.1f}")
    assert (found.status == "ok").all()
    assert (truth.status == "ok").all()
    assert np.median(error) <= np.median(their_error)
    assert error.max() <= their_error.max()
    return their_time / our_time


@pytest.mark.long
@pytest.mark.parametrize(
    ("their_tolerance", "our_tolerance", "least"),
    [(1e-8, 1e-6, 40.0), (1e-12, 1e-8, 100.0)],  # seen: 60 and 146
    ids=["mu good to 1e-6", "mu good to 1e-8"],
)
def test_the_reference_is_faster_than_scipys_lsoda_at_better_accuracy(their_tolerance, our_tolerance, least):
    assert compared(their_tolerance, our_tolerance) > least


@pytest.mark.long
@pytest.mark.parametrize("law", [{}, {"equations": "small"}, {"regularization": V_REG}], ids=str)
def test_a_point_whose_runs_stop_early_costs_less(law):
    """fig3-I has no other reduction for a single point, so full over not full is the early end alone."""
    scene, phases = reference.load_scene("fig3-I"), reference.phase_grid(16) + 0.1
    reference.amplification(scene, phases[:1], **law)  # compiled
    seconds = np.array(
        [[reference.amplification(scene, phases, full=full, **law).cost for full in (True, False)] for _ in range(3)]
    )
    whole, early = seconds.min(axis=0)
    print(f"\nto the end {1e3 * whole / len(phases):.2f} ms a point, early {1e3 * early / len(phases):.2f} ms")
    print(f"ratio of processor time {whole / early:.2f}")
    assert whole / early > 1.5  # seen: 1.69


@pytest.mark.long
@pytest.mark.parametrize(("name", "most"), list(MOST_RUNS_FOR_A_POINT.items()))
def test_a_point_with_its_error_costs_about_one_accurate_run_to_the_end_of_the_motion(name, most):
    """Its finer run, at the same tolerance inside a step."""
    scene, phases = reference.load_scene(name), reference.phase_grid(16) + 0.1
    system, demand = checked_demand(scene, "exact", None, 1e-6, None, "consistent")

    def seconds(solve) -> float:
        begin = time.process_time()
        solve(system, phases, demand)
        return time.process_time() - begin

    def plain(*arguments):
        peaks_at(*arguments, MAX_STEP_TOLERANCE)

    seconds(plain)  # compiled
    run, point = np.array([[seconds(solve) for solve in (plain, peaks_with_error)] for _ in range(5)]).min(axis=0)
    print(f"\none run {1e3 * run / len(phases):.2f} ms, a point {1e3 * point / len(phases):.2f} ms: {point / run:.2f}")
    assert point / run < most


FIRST_CALL = """
import time
import reference.solver.compiled.parts as parts
if {apart}:
    parts.NEWEST_KNOWN = 0, 0
import reference
begin = time.process_time()
reference.amplification(reference.load_scene("fig3-I"), [(0.3, 1.1)], full=True)
print(time.process_time() - begin)
"""


@pytest.mark.long
def test_parts_that_are_built_with_their_entry_point_compile_faster_than_parts_built_apart(tmp_path):
    def seconds(apart: bool) -> float:
        environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / str(apart))}
        command = [sys.executable, "-c", FIRST_CALL.format(apart=apart)]
        run = subprocess.run(command, env=environment, check=True, capture_output=True, text=True)
        return float(run.stdout)

    together, apart = seconds(False), seconds(True)
    print(f"\nfirst call: built together {together:.1f} s, apart {apart:.1f} s, ratio {apart / together:.2f}")
    assert apart / together > 1.3
