"""A light platform under a heavy tower: its equations are solved where they have an answer, else that is told."""

from __future__ import annotations

import numpy as np
import pytest
from chains import chain
from oracle import set_valued_run

import reference
from reference.problem import GRAVITY, Outcome, Scene, State

FRICTION = 0.1


def light(share: float, periods: tuple[float, float] = (1.5, 1.2), friction: float = FRICTION, **changes) -> Scene:
    """Two bodies of 2 kg together, on links of these periods, s; the platform with this share of the mass."""
    upper = 2.0 * (1.0 - share)
    stiffness = [[upper * (2.0 * np.pi / period) ** 2 for period in periods]]
    given = {"amplitudes": [[2.0, 0.0], [0.0, 2.0]], "decay": [1.0 / 3.0, 0.3 / 1.1], "duration": 3.0, **changes}
    return chain(0.25, friction, [2.0 * share, upper], stiffness, **given)


def assert_factors_of_an_independent_code(scene: Scene, phase: tuple[float, float]) -> np.ndarray:
    """The factors (N,), which are within their errors of it."""
    found = reference.amplification(scene, [phase])
    assert found.status[0] == Outcome.OK
    expected = set_valued_run(scene, phase, "exact", [0.0], 1e-9).mu[0]
    assert np.all(np.abs(found.mu[0] - expected) <= found.error[0] + 1e-7 * expected)
    return found.mu[0]


@pytest.mark.long
def test_a_hundredth_of_the_mass_has_the_oracle_s_factors():
    """At an onset the direction of the slide turns by 200 rad/s, and its acceleration depends on it a hundred times."""
    scene, phase = light(0.01), (2.0, 0.7)
    assert_factors_of_an_independent_code(scene, phase)


def test_a_slide_braked_at_first_turns_and_goes_on():
    """
    A stiff link pulls the platform aside within a step from rest. Without the turn friction would stop it at once: the
    first guess hardly moves, and a derivative at its speed forbids the turn. The slide begins at 1.736 s.
    """
    scene, phase = light(0.01, (0.2, 0.25), amplitudes=[[2.0, 0.0], [0.0, 2.0], [2.0, 1.5]], duration=2.2), (5.8, 1.1)
    found = assert_factors_of_an_independent_code(scene, phase)
    assert found[0] > 1.5 * reference.amplification(scene.with_values({"duration": 1.8}), [phase]).mu[0, 0]


def test_a_slide_that_turns_back_sets_out_downhill():
    """
    The platform turns back at 0.44 of the radius, where the tower presses it into the bowl with 1.1 times the weight.
    With the weight alone the force along the bowl would point uphill, where friction brakes any slide.
    """
    scene, phase = light(0.03, friction=0.03, amplitudes=[[5.0, 0.0], [0.0, 3.0]], duration=0.8), (5.4, 2.4)
    assert_factors_of_an_independent_code(scene, phase)


@pytest.mark.parametrize("regularization", [None, 1e-3])
def test_every_pair_has_an_answer_where_inertia_has_its_sign(regularization):
    """D is at least 1 - (m_sum/m1 - 1) mu^2 / 4: 0.17 for a platform of 0.3 % of the mass."""
    phases = np.random.default_rng(0).uniform(0.0, 2.0 * np.pi, (20, 2))
    found = reference.amplification(light(0.003), phases, regularization=regularization)
    assert set(found.status) == {Outcome.OK}


def test_creep_at_a_vanishing_speed_ends_as_coulomb_friction():
    """Where D comes down to 0.08 creep answers within 1e-11 s: a step too long for that is no paradox."""
    phases = np.random.default_rng(1).uniform(0.0, 2.0 * np.pi, (20, 2))
    sharp, crept = (reference.amplification(light(0.0027), phases, regularization=v_reg) for v_reg in (None, 1e-8))
    assert crept.status.tolist() == sharp.status.tolist()
    assert np.mean(crept.status == Outcome.OK) > 0.5


@pytest.mark.parametrize("regularization", [None, 1e-3])
def test_light_platforms_end_in_a_named_paradox(regularization):
    phases = np.random.default_rng(0).uniform(0.0, 2.0 * np.pi, (20, 2))
    found = reference.amplification(light(0.001), phases, regularization=regularization)
    assert set(found.status) <= {Outcome.PAINLEVE, Outcome.CONTACT_LOST}
    assert np.mean(found.status == Outcome.PAINLEVE) > 0.5


@pytest.mark.parametrize("regularization", [None, 1e-3])
def test_a_slide_that_ends_in_a_paradox_is_named_after_it(regularization):
    """At 0.24 % of the mass, just below a quarter of the squared friction, D falls to zero in the middle of a slide."""
    scene = light(0.0024, amplitudes=[[2.0, 0.0], [0.0, 2.0], [2.0, 1.5]])
    found = reference.amplification(scene, [(2.2, 4.1), (1.9, 3.8)], regularization=regularization)
    assert set(found.status) == {Outcome.PAINLEVE}


def test_a_straight_slide_without_acceleration_does_not_begin():
    """The link pulls the platform down its slope, where D = 1 + (m_sum/m1 - 1) tilt (tilt - mu) < 0, until it slips."""
    scene = light(0.001, amplitudes=[[1e-3, 0.0], [0.0, 0.0]])
    place = 0.0125
    start = State(np.array([[place, 0.0], [place, 0.0]]), np.array([[0.0, 0.0], [-0.5, 0.0]]))
    run = reference.trajectory(scene, (0.3, 1.1), initial=start)
    assert run.status == Outcome.PAINLEVE
    assert np.all(run.position[:, 0, 0] == place)
    tilt, rate = place / scene.radius, 2.0 * np.pi / 1.5
    # at the slip: gravity and the link along the slope against friction, the ground's 1e-3 m/s^2 left out
    pull = GRAVITY * np.tan(np.arctan(FRICTION) - np.arcsin(tilt))
    assert run.instant == pytest.approx(np.arcsin(pull / (0.5 * rate * (1.0 - 0.001))) / rate, rel=5e-3)
