"""The engine ends a motion beyond the isolator's travel, at the instant at which the paper's equations do."""

from __future__ import annotations

import numpy as np
import pytest
from scenes_at_hand import CONSTANT, one_body
from scipy.integrate import solve_ivp

import multibody
import reference
from reference.problem import GRAVITY, Outcome, Scene, load_scene

PHASE = (0.3, 1.1)


def strong(travel: float, duration: float = 3.0) -> Scene:
    values = {"isolator.friction": 0.05, "duration": duration, "isolator.travel": travel}
    return load_scene("fig3-I", amplitude=2.5).with_values(values)


def test_a_steady_push_reaches_the_travel_when_the_pendulum_says() -> None:
    push, radius, travel = 0.5 * GRAVITY, 0.25, 0.1
    scene = one_body(radius=radius, friction=0.0, amplitudes=[[-push, 0.0], [0.0, 0.0]], periods=(CONSTANT, CONSTANT))
    result = multibody.amplification(scene.with_values({"isolator.travel": travel}), [(0.0, 0.0)], regularization=None)

    def swing(t: float, y: np.ndarray) -> list[float]:
        return [y[1], (push * np.cos(y[0]) - GRAVITY * np.sin(y[0])) / radius]

    def beyond(t: float, y: np.ndarray) -> float:
        return float(radius * np.sin(y[0]) - travel)

    exact = solve_ivp(swing, (0.0, 1.0), [0.0, 0.0], events=beyond, rtol=1e-10, atol=1e-12)
    assert result.status[0] == Outcome.TRAVEL_REACHED
    assert np.isnan(result.mu).all()
    assert result.instant[0] == pytest.approx(exact.t_events[0][0], abs=2e-5)


@pytest.mark.parametrize("model", ["translational", "spatial"])
def test_the_instant_is_that_of_the_equations(model: str) -> None:
    scene = strong(0.05)
    engine = multibody.amplification(scene, [PHASE], model, tolerance=1e-3 if model == "translational" else 1e-2)
    equations = reference.amplification(scene, [PHASE], regularization=1e-3)
    assert engine.status.tolist() == equations.status.tolist() == [Outcome.TRAVEL_REACHED]
    # bodies that turn shift the support's load: another motion by some percent
    assert engine.instant[0] == pytest.approx(equations.instant[0], abs=5e-5 if model == "translational" else 5e-3)


def test_a_stored_motion_ends_before_the_travel() -> None:
    for motion in (multibody.trajectory(strong(0.05), PHASE), multibody.single_run(strong(0.05), PHASE, step=2e-3)):
        assert motion.status == Outcome.TRAVEL_REACHED
        assert np.hypot(*motion.position[:, 0, :2].T).max() <= 0.05
        assert motion.time[-1] <= motion.instant <= motion.time[-1] + 5e-3
        assert np.isnan(reference.demands(motion).displacement.value)


def test_a_travel_that_is_not_needed_changes_nothing() -> None:
    free = multibody.amplification(strong(0.2).with_values({"isolator.travel": None}), [PHASE])
    wide = multibody.amplification(strong(0.2), [PHASE])
    np.testing.assert_array_equal(wide.mu, free.mu)
    np.testing.assert_array_equal(wide.error, free.error)


@pytest.mark.parametrize("share", [0.999, 1.001])
def test_a_travel_close_to_the_largest_displacement_is_settled(share: float) -> None:
    """The displacement of the first second is the largest; what comes later is looked over in larger steps."""
    scene = strong(0.2, 8.0)
    most = float(reference.amplification(scene, [PHASE], regularization=1e-3).cap_share[0]) * scene.radius
    for full in (False, True):
        result = multibody.amplification(strong(share * most, 8.0), [PHASE], full=full)
        assert result.status.tolist() == [Outcome.TRAVEL_REACHED if share < 1.0 else Outcome.OK]


@pytest.mark.long
@pytest.mark.parametrize("travel", [0.05, 0.1])
def test_both_sides_end_the_same_motions_on_64_phases(travel: float) -> None:
    scene, phases = strong(travel), np.random.default_rng(5).uniform(0.0, 2.0 * np.pi, (64, 2))
    engine = multibody.amplification(scene, phases)
    equations = reference.amplification(scene, phases, regularization=1e-3)
    np.testing.assert_array_equal(engine.status, equations.status)
    ok = engine.status == Outcome.OK
    print(f"\ntravel {travel}: {(~ok).sum()} of 64 end, instants within {instants_apart(engine, equations):.1e} s")
    assert instants_apart(engine, equations) < 1e-3
    assert (np.abs(engine.mu - equations.mu) <= engine.error + equations.error)[ok].all()


def instants_apart(engine: multibody.Amplification, equations: multibody.Amplification) -> float:
    return float(np.nanmax(np.abs(engine.instant - equations.instant), initial=0.0))
