"""A motion ends where the platform needs a larger displacement than the isolator permits, at the right instant."""

import numpy as np
import pytest
from chains import chain, refusal
from oracle_law import Law
from scipy.integrate import quad, solve_ivp

import reference
from comparison.evidence.scaling.analysis import scale_scene
from reference.problem import GRAVITY, Outcome, Scene, State, load_scene, phase_grid

PHASE = (0.3, 1.1)
TWO = {"masses": (1.0, 1.5), "stiffness": [(20.0, 30.0)], "amplitudes": ((4.0, 1.0), (0.0, 3.0)), "duration": 6.0}


def limited(scene: Scene, travel: float) -> Scene:
    return scene.with_values({"isolator.travel": travel})


@pytest.mark.parametrize(
    ("travel", "speed", "outcome", "allowed"),
    # at the rim the solver ends where its coordinates do, within its own step of it
    [(0.15, 1.6, Outcome.TRAVEL_REACHED, 3e-9), (None, 2.5, Outcome.RIM_REACHED, 1e-4)],
)
def test_a_thrown_platform_ends_where_its_energy_says(travel, speed, outcome, allowed) -> None:
    """Frictionless from the middle: t = int rho d theta / sqrt(v^2 - 2 g rho (1 - cos theta)) to the end's theta."""
    scene = chain(0.25, 0.0, amplitudes=[[1e-9, 0.0], [0.0, 0.0]], duration=1.0)
    scene = scene.with_values({"isolator.travel": travel})
    start = State(np.zeros((1, 2)), np.array([[0.6 * speed, 0.8 * speed]]))
    time, _ = quad(
        lambda angle: scene.radius / np.sqrt(speed**2 - 2.0 * GRAVITY * scene.radius * (1.0 - np.cos(angle))),
        0.0, np.arcsin((travel or scene.radius) / scene.radius),
    )  # fmt: skip
    run = reference.trajectory(scene, PHASE, initial=start, tolerance=1e-9)
    assert run.status == outcome
    assert run.instant == pytest.approx(time, abs=allowed)
    assert np.hypot(*run.position[:, 0, :2].T).max() <= (travel or scene.radius) * (1.0 + 1e-9)


@pytest.mark.parametrize("equations", ["exact", "small"])
def test_a_travel_that_nobody_states_is_no_end(equations: str) -> None:
    scene = chain(0.25, 0.0, amplitudes=[[1e-9, 0.0], [0.0, 0.0]], duration=1.0)
    start = State(np.zeros((1, 2)), np.array([[1.5, 2.0]]))
    assert reference.trajectory(scene, PHASE, equations, initial=start).status == Outcome.RIM_REACHED
    own = limited(scene, 0.2499)
    assert reference.trajectory(own, PHASE, equations, initial=start).status == Outcome.TRAVEL_REACHED


@pytest.mark.parametrize(("law", "v_reg"), [("lubrication", None), ("friction", 1e-2), ("nothing", None)])
@pytest.mark.parametrize("equations", ["exact", "small"])
def test_the_instant_is_that_of_an_independent_solution(law: str, v_reg: float | None, equations: str) -> None:
    """Plain equations of two bodies, SciPy's event where the displacement passes the travel."""
    coefficient = {"lubrication": 0.3, "friction": 0.03, "nothing": 0.0}[law]
    scene = chain(friction=coefficient, lubrication=coefficient if law == "lubrication" else None, **TWO)
    oracle, travel = Law(scene, PHASE, equations), 0.04

    def beyond(t: float, state: np.ndarray) -> float:
        return float(np.hypot(state[0], state[1]) - travel)

    exact = solve_ivp(
        lambda t, state: oracle.smooth_rate(t, state, v_reg)[0],
        (0.0, 6.0), np.zeros(8), "LSODA", events=beyond, rtol=1e-9, atol=1e-11,
    )  # fmt: skip
    found = reference.amplification(limited(scene, travel), [PHASE], equations, v_reg)
    assert found.status.tolist() == [Outcome.TRAVEL_REACHED]
    assert np.isnan([*found.mu[0], found.cap_share[0]]).all()
    assert found.instant[0] == pytest.approx(exact.t_events[0][0], abs=2e-6)


@pytest.mark.parametrize("v_reg", [None, 1e-3])
def test_the_travel_is_passed_where_a_free_motion_passes_it(v_reg: float | None) -> None:
    """Up to a hair below the largest displacement, which is taken at a stop, in stretched time."""
    scene = load_scene("fig3-I")
    free = reference.trajectory(scene, PHASE, regularization=v_reg, tolerance=1e-9)
    place = np.hypot(*free.position[:, 0, :2].T)
    for share in (0.2, 0.7, 0.999, 0.999999):
        short = limited(scene, share * place.max())
        found = reference.amplification(short, [PHASE], regularization=v_reg, tolerance=1e-8)
        passed = int(np.argmax(place > share * place.max()))
        assert found.status.tolist() == [Outcome.TRAVEL_REACHED]
        assert free.time[passed - 1] - 1e-4 <= found.instant[0] <= free.time[passed] + 1e-4
    demands = reference.demands(reference.trajectory(short, PHASE, regularization=v_reg))
    assert (demands.status, np.isnan(demands.travel_share.value)) == ("travel reached", True)


def test_a_travel_that_is_not_needed_changes_no_number_and_has_its_share() -> None:
    scene, phases = load_scene("fig3-I"), phase_grid(4)
    free = reference.amplification(scene, phases)
    most = free.cap_share.max() * scene.radius
    wide = reference.amplification(limited(scene, 1.2 * most), phases)
    for name in ("mu", "error", "cap_share"):
        np.testing.assert_array_equal(getattr(wide, name), getattr(free, name))
    np.testing.assert_allclose(wide.displacement, free.cap_share * scene.radius)
    narrow = reference.amplification(limited(scene, 0.9 * most), phases)
    ended = narrow.status == Outcome.TRAVEL_REACHED
    np.testing.assert_array_equal(ended, free.cap_share > 0.9 * free.cap_share.max())
    np.testing.assert_allclose(narrow.mu[~ended], free.mu[~ended], rtol=1e-6)
    motion = reference.trajectory(limited(scene, 1.2 * most), PHASE)
    largest = np.hypot(*motion.position[:, 0, :2].T).max()
    assert reference.demands(motion).travel_share.value == pytest.approx(largest / (1.2 * most), rel=1e-6)
    assert reference.demands(reference.trajectory(scene, PHASE)).travel_share is None


def test_a_displacement_that_grows_late_is_not_lost() -> None:
    """A burst first, then beats of weak friction: the largest accelerations come long before the displacement."""
    scene = chain(
        0.25, 0.002, amplitudes=[[6.0, 0.0], [0.0, 0.35]], periods=(0.12, 1.0), decay=(3.0, 0.0), duration=8.0
    )  # fmt: skip
    free = reference.trajectory(scene, PHASE)
    travel = 0.97 * np.hypot(*free.position[:, 0, :2].T).max()
    for full in (False, True):
        found = reference.amplification(limited(scene, travel), [PHASE], full=full)
        assert found.status.tolist() == [Outcome.TRAVEL_REACHED]
        assert found.instant[0] > 3.0


def test_a_start_beyond_the_travel_is_refused_and_a_scaled_loading_scales_it() -> None:
    scene = limited(chain(0.25, 0.1), 0.1)
    start = State(np.array([[0.08, 0.07]]), np.zeros((1, 2)))
    said = str(refusal(reference.trajectory, scene, PHASE, initial=start))
    assert said == "initial: the platform must start within isolator.travel = 0.1 m"
    assert scale_scene(scene, 0.5).isolator.travel == 0.05
