"""Resolved peaks: only rest and slides faster than the cutoff count, however short such a part of a step is."""

import numpy as np
import pytest

import reference
from reference.problem import load_scene

CUTOFF = 1e-3  # m/s
INSTANTS = 300_001
CREEP = {"slow": 0.0430860971356464, "fast": 0.14661134550366858, "rate": 519.697000477915}
CASES = {
    # a slide begins slowly, within a step at whose end it is fast
    "slow onset": (0.10910562657543134, (3.5046219150036997, 3.352310473684884)),
    # creep is faster than the cutoff only between the ends of a step
    "brief creep": (CREEP, (2.6638527317708944, 3.9343328551500085)),
}


def largest(motion, cutoff: float) -> float:
    """Largest absolute acceleration of body 2, m/s^2, over the instants of a motion that count."""
    speed = np.linalg.norm(motion.velocity[:, 0, :2], axis=-1)
    counts = (speed == 0.0) | (speed >= cutoff)
    return float(np.linalg.norm(motion.absolute_acceleration[:, 1], axis=-1)[counts].max())


@pytest.mark.parametrize(("friction", "phase"), CASES.values(), ids=CASES.keys())
def test_a_resolved_peak_is_the_largest_instant_that_counts(friction, phase):
    scene = load_scene("fig4-dry").with_values({"isolator.friction": friction, "duration": 3.0})
    instants = np.linspace(0.0, scene.duration, INSTANTS)
    motion = reference.trajectory(scene, phase, "small", tolerance=1e-10, times=instants)
    supremum = reference.amplification(scene, [phase], equations="small").mu[0, 1]
    expected = supremum * largest(motion, CUTOFF) / largest(motion, 0.0)
    for tolerance in (1e-5, 1e-7):
        answer = reference.amplification(scene, [phase], equations="small", cutoff=CUTOFF, tolerance=tolerance)
        assert answer.status[0] == "ok"
        assert answer.mu[0, 1] == pytest.approx(expected, rel=4e-6)


def test_ever_lower_cutoffs_tend_to_the_literal_supremum_by_a_power_of_the_speed() -> None:
    """The direction of a slide turns like a power of its speed down to the stop (T6 of docs/theory.md)."""
    cutoffs = [None, *(10.0**-exponent for exponent in range(9, 15))]
    mu = [
        reference.amplification(load_scene("fig3-I"), [(1.67079633, 3.24159265)], cutoff=cutoff).mu[0, 0]
        for cutoff in cutoffs
    ]
    ways = mu[0] - np.array(mu[1:])
    np.testing.assert_allclose(ways[1:] / ways[:-1], 0.57, atol=0.015)
