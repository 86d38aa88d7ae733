"""Each way a run can fail, provoked by a scene, with the instant it happens at."""

from functools import partial

import numpy as np
import pytest
from chains import chain
from oracle_law import Law
from scipy.optimize import brentq

import reference
from reference import surface
from reference.problem import ADVICE, GRAVITY, Outcome, Scene, State, load_scene, phase_grid

PHASE = (0.3, 1.1)
BOTH = pytest.mark.parametrize("equations", ["exact", "small"])


def refused(scene: Scene, outcome: Outcome, **options) -> float:
    """The instant of the outcome; mu is NaN."""
    found = reference.amplification(scene, [PHASE, PHASE], **options)
    assert found.status.tolist() == [outcome, outcome]
    assert np.isnan(found.mu).all()
    assert ADVICE[outcome]
    assert found.instant[0] == found.instant[1]
    return float(found.instant[0])


@BOTH
@pytest.mark.parametrize("regularization", [None, 1e-3])
def test_a_rim_that_is_reached_and_a_contact_that_opens_in_sliding_are_told_when(equations, regularization):
    scene = chain(0.05, 0.05, amplitudes=[[25.0, 0.0], [0.0, 25.0]], duration=3.0)
    instant = refused(scene, Outcome.RIM_REACHED, equations=equations, regularization=regularization)
    run = reference.trajectory(scene, PHASE, equations, regularization, times=np.linspace(0.0, instant, 2001)[:-1])
    swing = np.hypot(run.position[:, 0, 0], run.position[:, 0, 1]) / scene.radius
    assert swing[:-1].max() < 1.0
    assert swing[-1] > 0.98
    scene = chain(0.25, 0.05, amplitudes=[[2.0, 0.0], [0.0, 2.0], [20.0, 0.0]])
    instant = refused(scene, Outcome.CONTACT_LOST, equations=equations, regularization=regularization)
    run = reference.trajectory(scene, PHASE, equations, regularization, times=np.linspace(0.0, instant, 501)[:-1])
    assert run.contact_force.min() > 0.0
    assert run.contact_force[-1] < 0.2 * GRAVITY


@BOTH
def test_a_contact_opens_at_rest_at_the_root_of_the_ground(equations):
    """Vertical loading alone: at rest in the middle N = m_sum (g + zeta''), zero at a root known in closed form."""
    scene = chain(
        0.25, 0.1, amplitudes=[[0.0, 0.0], [0.0, 0.0], [12.0, 0.0]], masses=[1.0, 1.0], stiffness=[[20.0, 30.0]]
    )
    instant = refused(scene, Outcome.CONTACT_LOST, equations=equations)

    def pressure(t: float) -> float:
        return GRAVITY + 12.0 * np.exp(-0.3 * t) * np.cos(2.0 * np.pi / 0.9 * t + PHASE[0])

    times = np.linspace(0.0, 1.0, 1001)
    first = int(np.argmax([pressure(t) < 0.0 for t in times]))
    root = brentq(pressure, times[first - 1], times[first])
    assert instant == pytest.approx(root, abs=1e-6)


@BOTH
@pytest.mark.parametrize("tolerance", [1e-6, 1e-8])
def test_a_drive_that_touches_the_friction_limit_moves_nothing(equations, tolerance):
    """The platform stays at rest, so its absolute acceleration is that of the ground."""
    limit = 0.1 * GRAVITY
    radius = GRAVITY / (2.0 * np.pi) ** 2
    scene = chain(radius, 0.1, amplitudes=[[limit, 0.0], [0.0, 0.0]], decay=(0.0, 0.0), duration=3.0)
    result = reference.amplification(scene, [(0.0, 0.0)], equations=equations, tolerance=tolerance)
    assert result.status[0] == "ok"
    assert abs(result.mu[0, 0] - 1.0) <= result.error[0, 0]


@BOTH
def test_a_drive_beyond_the_friction_limit_for_a_moment_moves_the_platform(equations):
    """On a plane the platform then has the acceleration of friction, mu g, and not that of the ground."""
    for excess in (1e-4, 4e-4, 1e-3, 3e-3, 1e-2, 3e-2):
        for start in (-0.7, -1.0, -1.4, -1.9):
            loading = {"amplitudes": [[0.1 * GRAVITY * (1.0 + excess), 0.0], [0.0, 0.0]], "decay": (0.0, 0.0)}
            result = reference.amplification(chain(np.inf, 0.1, **loading, duration=0.5), [(start, 0.0)], equations)
            assert abs(result.mu[0, 0] * (1.0 + excess) - 1.0) <= 2.0 * result.error[0, 0], (excess, start)


@BOTH
def test_loads_beyond_double_precision_or_without_a_motion_are_told_at_once(equations, monkeypatch):
    scene = chain(amplitudes=[[1e200, 0.0], [0.0, 1.0]])
    assert refused(scene, Outcome.NON_FINITE_LOAD, equations=equations) == 0.0
    assert repr(reference.trajectory(scene, PHASE, equations)).startswith(
        "<Trajectory of scene: no samples, 0 rests, platform at most 0 mm off, non-finite load; "
    )
    record = {"record": {"time": [0.0, 1.0], "acceleration": [1e160, 0.0]}}
    assert refused(scene.with_values({"excitation": record}), Outcome.NON_FINITE_LOAD, equations=equations) == 0.0
    weak = chain(amplitudes=[[1e-130, 1e-130], [0.0, 0.0]], periods=(1.0, 1.0), duration=0.5)
    monkeypatch.setattr(surface.numba, "get_num_threads", lambda: 1)  # both in one part of the surface
    found = reference.amplification(weak, [(0.0, 0.0), (0.0, np.pi)], equations)
    assert found.status.tolist() == [Outcome.OK, Outcome.NO_GROUND_MOTION], "out of phase"
    still = chain(amplitudes=[[0.0, 0.0], [0.0, 0.0]])
    assert refused(still, Outcome.NO_GROUND_MOTION, equations=equations) == 0.0


@pytest.mark.parametrize(("threads", "alone", "slices"), [(3, False, 18), (3, True, 1), (1, False, 1)])
def test_the_time_of_a_surface_is_that_of_all_its_slices(threads, alone, slices, monkeypatch):
    """Each states as many seconds as it has phase pairs; on threads a first pair is computed to compile."""
    monkeypatch.setattr(surface.numba, "get_num_threads", lambda: threads)
    solved = []

    def solve(part):
        solved.append(part)
        return part.stop - part.start

    assert surface._solve_on_threads(solve, 51, alone) == 51
    assert len(solved) == slices
    assert sorted(np.concatenate([np.arange(51)[part] for part in solved[slices > 1 :]])) == [*range(51)]


def test_a_failed_point_leaves_its_neighbors_alone():
    scene = chain(0.25, 0.05, [2.0], amplitudes=[[2.0, 0.5], [0.3, 1.5]])
    phases = phase_grid(4) + 0.1
    together = reference.amplification(scene, phases, "small")
    good = together.status == Outcome.OK
    assert 0 < good.sum() < len(phases)
    np.testing.assert_array_equal(np.isnan(together.mu).all(axis=1), ~good)
    np.testing.assert_array_equal(np.isnan(together.instant), good)
    np.testing.assert_array_equal(together.mu[good], reference.amplification(scene, phases[good], "small").mu)


WORDS = {  # of the advice for every outcome
    "ok": "nothing to do",
    "tolerance not met": "loosen the tolerance, or give a cutoff",
    "rim reached": "lower the amplitude or enlarge the radius",
    "travel reached": "lower the amplitude or enlarge the travel",
    "contact lost": "lower the vertical amplitude, or use the spatial model",
    "overturned": "widen the ring or lower the amplitude",
    "painleve paradox": "lower the friction coefficient or the swing, or take a heavier platform",
    "non-finite load": "rescale the scene",
    "no ground motion": "give a nonzero amplitude",
    "step limit": "shorten the duration",
    "solver failed": "loosen the tolerance or change v_reg",
    "worker died": "run the point alone",
    "time limit": "allow more, or shorten the duration",
    "not asked": "see what the solvers reported",
    "value out of range": "negative, infinite or above 1e12",
}


def test_every_outcome_has_advice():
    assert list(WORDS) == list(Outcome) == list(ADVICE)
    assert [outcome.name for outcome in Outcome][2:6] == ["RIM_REACHED", "TRAVEL_REACHED", "CONTACT_LOST", "OVERTURNED"]
    assert [outcome for outcome, words in WORDS.items() if words not in ADVICE[outcome]] == []
    assert not any("\n" in text for text in ADVICE.values())
    assert {text.split()[0] for text in ADVICE.values()} <= {"nothing", "the", "loads", "a", "(5.1)"}, (
        "it begins a sentence"
    )


def test_a_run_of_too_many_steps_ends_at_its_limit(monkeypatch):
    scene = load_scene("fig3-I")
    for name, limit in (("BASE_STEPS", 20), ("MAX_STEPS", 0)):
        monkeypatch.setattr(surface, name, limit)
    assert 0.0 < refused(scene, Outcome.STEP_LIMIT) < scene.duration


def test_a_run_has_the_unit_the_time_and_the_steps_of_its_scene():
    scene = chain(0.25, 0.1, [3.0, 0.2], [[5e5, 9.0]], [[1.0, 0.5], [0.3, -0.4]], (0.9, 0.5), (0.3, 40.0), 3.0)
    settings = {"equations": "exact", "regularization": None, "tolerance": 1e-6, "cutoff": None}
    prepare = partial(surface.prepare_run, **settings, rest_condition="consistent")
    system, demand = prepare(scene)
    assert (demand.unit, demand.period) == pytest.approx((np.hypot(1.5, 0.7), 20.0 * np.pi / system.fastest))
    assert demand.step_limit == 20_000 + int(1000.0 * 3.0 / 0.5 + 30.0 * 3.0 * system.fastest / (2.0 * np.pi))
    slow = scene.with_values({"bodies.1.stiffness": [20.0, 9.0]})
    assert prepare(slow)[1].period == pytest.approx(2.0 * np.pi / 40.0)
    record = {"record": {"time": [0.0, 0.1, 0.3], "acceleration": [[3.0, 4.0], [0.0, 1.0], [0.0, 0.0]]}}
    system, demand = prepare(slow.with_values({"excitation": record}))
    steps = 1000.0 * 3.0 / (2.0 * np.pi * 4.0 / 30.0) + 30.0 * 3.0 * system.fastest / (2.0 * np.pi) + 10.0 * 3.0
    assert (demand.unit, demand.step_limit) == (5.0, 20_000 + int(steps))


def test_the_printed_rest_condition_is_looser():
    """(4.6) as printed lets friction hold sqrt(2) of its limit at the origin: the first rest lasts longer."""
    scene = load_scene("fig3-I")
    consistent = reference.trajectory(scene, PHASE, "small")
    printed = reference.trajectory(scene, PHASE, "small", rest_condition="printed")
    assert printed.stick[0][1] > consistent.stick[0][1]
    law = Law(scene, PHASE, "small")
    end = consistent.stick[0][1]
    run = reference.trajectory(scene, PHASE, "small", times=[end])
    q = run.position[0, :, :2].ravel().tolist()
    assert law.excess(end, q, law.link_forces(q, [0.0] * len(q))) == pytest.approx(0.0, abs=1e-6)


def test_the_first_rest_ends_where_the_print_says():
    """F_3 and the components of F_F of (4.6), off the center and under a different loading along each axis."""
    scene = load_scene("fig3-I")
    scene = scene.with_values({"excitation.amplitudes": [[1.9, -0.6], [0.5, 1.4], [0.8, -1.1]]})
    initial = State(np.array([[0.07, -0.03]] * 2), np.zeros((2, 2)))
    options = {"rest_condition": "printed", "initial": initial}
    end = reference.trajectory(scene, PHASE, "small", **options).stick[0][1]
    place = reference.trajectory(scene, PHASE, "small", times=[end], **options).position[0, :, :2].ravel()
    law = Law(scene, PHASE, "small")
    force, ground = law.link_forces(place.tolist(), [0.0] * 4), law.ground(end)
    normal, held, limit = law.total / law.mass[0] * (GRAVITY + ground[2]), [], []
    for axis in range(2):
        drive = force[axis] / law.mass[0] - ground[axis]
        held.append(-(drive + 2.0 * ground[axis]) + normal * place[axis] / law.rho)
        limit.append(law.mu * (normal - ground[axis] * (place[0] + place[1]) / law.rho))
    assert 0.0 < end < scene.duration
    assert law.excess(end, place.tolist(), force) > 1e-3, "by the condition that is not the print's it has ended before"
    assert np.hypot(*held) == pytest.approx(np.hypot(*limit), rel=1e-8)
