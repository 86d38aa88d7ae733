"""A manufactured motion without stops: circles of a chain over friction on the exact sphere."""

import numpy as np
import pytest
from turning_platform import turning

import reference
from reference.solver.error_estimate import peaks_from
from reference.solver.system import allocate_record
from reference.surface import prepare_run

INSTANTS = np.linspace(0.0, 3.0, 100)
CHAINS = pytest.mark.parametrize("links", [((1.0,), (), None), ((2.0, 1.0, 0.5), (80.0, 40.0), 0.05)])


@CHAINS
def test_circles_over_friction_are_kept(links, within):
    motion = turning(*links, 3.0)
    run = reference.trajectory(motion.scene, motion.phase, tolerance=1e-8, initial=motion.initial)
    within(motion.error(run.time, run.position), 1e-10)
    assert run.peak == pytest.approx(motion.peaks, rel=1e-8)


@CHAINS
def test_collocation_is_of_order_eight_inside_its_steps(links):
    """Seven stages; at the end of a step the order is 13, and the error below rounding."""
    motion = turning(*links, 3.0)
    rest = allocate_record(0, len(motion.circles))
    errors, steps = [], []
    for tolerance in (1e-7, 1e-8, 1e-9, 1e-10):
        run = reference.trajectory(
            motion.scene, motion.phase, tolerance=tolerance, times=INSTANTS, initial=motion.initial
        )
        errors.append(motion.error(run.time, run.position))
        system, demand = prepare_run(motion.scene, "exact", None, tolerance, None, "consistent")
        start = motion.initial.position, motion.initial.velocity
        steps.append(peaks_from(*start, system, np.array([motion.phase]), demand, rest).steps[0])
    end = motion.error(run.time[-1:], run.position[-1:])
    assert end < 1e-13
    assert -np.polyfit(np.log(steps), np.log(errors), 1)[0] == pytest.approx(8.0, abs=0.7)
