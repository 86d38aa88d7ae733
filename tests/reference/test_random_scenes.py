"""Random valid scenes: nothing hangs, nothing is silently wrong, every failure has a name."""

import numpy as np
import pytest
from random_loadings import random_case

import reference
from reference.problem import Outcome, Scene

TOLERANCE = 1e-4
NAMED = {
    Outcome.RIM_REACHED,
    Outcome.CONTACT_LOST,
    Outcome.PAINLEVE,
    Outcome.TOLERANCE_NOT_MET,
    Outcome.STEP_LIMIT,
    Outcome.NO_GROUND_MOTION,  # two harmonics of one period may cancel
}
LONGEST = 60.0  # s of compute for one point: a hang, on any machine


def hold(scene: Scene, phase: tuple[float, float], equations: str, v_reg: float | None) -> None:
    coarse, fine = (
        reference.amplification(scene, [phase], equations, v_reg, tolerance, full=True)
        for tolerance in (TOLERANCE, TOLERANCE / 100.0)
    )
    for found, tolerance in ((coarse, TOLERANCE), (fine, TOLERANCE / 100.0)):
        assert found.cost < LONGEST
        if found.status[0] == Outcome.OK:
            assert np.isfinite(found.mu).all()
            assert np.all(found.error <= tolerance * found.mu)
            assert np.isnan(found.instant[0])
        else:
            assert found.status[0] in NAMED
            assert 0.0 <= found.instant[0] <= scene.duration * (1.0 + 1e-12)
            if found.status[0] != Outcome.TOLERANCE_NOT_MET:
                assert np.isnan(found.mu).all()
    if coarse.status[0] == Outcome.OK:
        assert fine.status[0] in (Outcome.OK, Outcome.TOLERANCE_NOT_MET, Outcome.STEP_LIMIT)
        if fine.status[0] == Outcome.OK:
            assert np.all(np.abs(coarse.mu - fine.mu) <= TOLERANCE * fine.mu)


@pytest.fixture(scope="module", autouse=True)
def compiled():
    """The first call compiles, which is not part of any point's cost."""
    reference.amplification(reference.load_scene("fig3-I"), [(0.0, 0.0)], tolerance=1e-3)


@pytest.mark.parametrize("seeds", [range(60), pytest.param(range(1000, 2000), marks=pytest.mark.long)])
def test_random_scenes_are_answered_or_refused_by_name(seeds: range) -> None:
    for seed in seeds:
        scene, phase, v_reg, _ = random_case(seed, 0.1, 6.0, 0.5, 5.0)
        hold(scene, phase, ("exact", "small")[seed % 2], v_reg if seed % 3 else None)
