"""
The reference beside SciPy's LSODA: exact equations, v_reg = 1e-3 m/s.

The accuracy is measured on both, and the reference has to be the better one. LSODA is read well: at its own steps, and
fifty times as closely around its peaks; on a fixed grid of instants it misses the short peaks at stops.

Run with `python -m pytest tests/benchmarks/test_reference_speed.py -m long -s`; reference/README.md has the figures.
"""

import time

import numpy as np
import pytest

import reference
from comparison.evidence.tradeoff.outside import compute_amplification_factors, integrate_motion
from reference.solver.error_estimate import MAX_STEP_TOLERANCE, peaks_at, peaks_with_error
from reference.surface import prepare_run

V_REG = 1e-3  # m/s
# most a point may cost, in accurate runs to the end of the motion; seen: 1.08, 1.29, 1.59, 1.19
MOST_RUNS_FOR_A_POINT = {"fig3-I": 1.3, "fig3-II": 1.6, "fig4-dry": 2.0, "fig4-viscous": 1.5}
LSODA_POINTS = 6  # it is slow


@pytest.mark.long
@pytest.mark.parametrize(
    ("their_tolerance", "our_tolerance", "least"),
    [(1e-8, 1e-6, 40.0), (1e-12, 1e-8, 100.0)],  # seen: 60 and 146
    ids=["mu good to 1e-6", "mu good to 1e-8"],
)
def test_the_reference_is_faster_than_scipys_lsoda_at_better_accuracy(their_tolerance, our_tolerance, least):
    """Median and worst of our errors are no larger than theirs; least: their processor time over ours for one point."""
    scene, phases = reference.load_scene("fig3-I"), reference.phase_grid(16)
    some = phases[:: len(phases) // LSODA_POINTS][:LSODA_POINTS]

    def ours(at, tolerance=our_tolerance):
        return reference.amplification(scene, at, regularization=V_REG, tolerance=tolerance)

    def theirs(at):
        return np.array(
            [
                compute_amplification_factors(
                    scene, each, *integrate_motion(scene, each, "LSODA", their_tolerance, V_REG), V_REG
                )
                for each in at
            ]
        )

    ours(phases[:1])  # compiled
    theirs(some[:1])
    truth, seconds, errors = ours(some, 1e-10), [], []
    assert (truth.status == "ok").all()
    for name, solve, at in (("reference", lambda at: ours(at).mu, phases), ("LSODA", theirs, some)):
        begin = time.process_time()
        solve(at)
        seconds.append((time.process_time() - begin) / len(at))
        errors.append(np.abs(solve(some) / truth.mu - 1.0))
        print(f"\n{name}: {1e3 * seconds[-1]:.2f} ms a point, error {np.median(errors[-1]):.1e} median, ", end="")
        print(f"{errors[-1].max():.1e} largest")
    print(f"ratio of processor time {seconds[1] / seconds[0]:.1f}")
    assert (ours(phases).status == "ok").all()
    assert np.median(errors[0]) <= np.median(errors[1])
    assert errors[0].max() <= errors[1].max()
    assert seconds[1] / seconds[0] > least


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
    system, demand = prepare_run(scene, "exact", None, 1e-6, None, "consistent")

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
