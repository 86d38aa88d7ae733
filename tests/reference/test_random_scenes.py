"""Random valid scenes: nothing hangs, nothing is silently wrong, every failure has a name."""

import numpy as np
import pytest
from chains import chain
from hypothesis import given, settings
from hypothesis import strategies as st

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


@st.composite
def scenes(draw: st.DrawFn) -> Scene:
    def number(low: float, high: float) -> float:
        """Log-uniform, four digits."""
        exponent = draw(st.floats(np.log10(low), np.log10(high)))
        return float(f"{10.0**exponent:.4g}")

    def signed(high: float) -> float:
        return round(draw(st.floats(-high, high)), 3)

    count = draw(st.integers(1, 4))
    rows = draw(st.sampled_from([2, 2, 2, 3]))
    strength = number(0.1, 3.0)
    amplitudes = [[strength * signed(1.0), strength * signed(1.0)] for _ in range(rows)]
    amplitudes[0][0] = strength
    masses = [number(0.1, 10.0) for _ in range(count)]
    stiffness = [[m * (2.0 * np.pi / number(0.2, 3.0)) ** 2 for _ in range(2)] for m in masses[1:]]
    lubricated = draw(st.booleans()) and draw(st.booleans())
    return chain(
        radius=number(0.1, 3.0),
        friction=draw(st.sampled_from([0.0, 0.02, 0.05, 0.1, 0.2, 0.5])),
        lubrication=number(0.05, 3.0) if lubricated else None,
        masses=masses,
        stiffness=stiffness,
        amplitudes=amplitudes,
        periods=[number(0.3, 2.0), number(0.3, 2.0)],
        decay=[number(0.05, 1.0), number(0.05, 1.0)],
        duration=number(0.5, 8.0),
        damping=draw(st.sampled_from([None, None, 0.02, 0.3, 5.0])),
    )


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


arguments = {
    "scene": scenes(),
    "phase": st.tuples(st.floats(0.0, 6.28), st.floats(0.0, 6.28)),
    "equations": st.sampled_from(["exact", "small"]),
    "v_reg": st.sampled_from([None, None, 1e-2, 1e-3, 1e-4]),
}


@given(**arguments)
@settings(max_examples=40, deadline=None)
def test_random_scenes_are_answered_or_refused_by_name(scene, phase, equations, v_reg):
    hold(scene, phase, equations, v_reg)


@pytest.mark.long
@given(**arguments)
@settings(max_examples=1000, deadline=None)
def test_a_thousand_scenes_are_answered_or_refused_by_name(scene, phase, equations, v_reg):
    hold(scene, phase, equations, v_reg)
