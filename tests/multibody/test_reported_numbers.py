"""Single numbers that a run reports or rests on, each by its own closed form."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scenes_at_hand import forces_of_links

import multibody
import reference
from multibody.integration.candidate import Candidate
from multibody.integration.estimate import from_compliance, from_levels, lag
from multibody.integration.peak import Peaks
from multibody.integration.travel import travel_reached
from multibody.models.assembly import assemble
from multibody.models.depressions import Depressions, rotation
from multibody.models.impact import ImpactLaw
from multibody.models.spatial import _critical_tilt
from reference.problem import GRAVITY, DryFriction, Outcome, ground_acceleration, load_scene

PHASE = (0.3, 1.1)
BRIEF = load_scene("fig3-I").with_values({"duration": 0.5})


def test_a_travel_passed_within_a_step_is_passed_on_the_way_out() -> None:
    """x = v t - a t^2 / 2 goes beyond the travel and comes back within one step."""
    speed, braking, travel = 2.0, 4.0, 0.49
    time = np.array([0.35, 0.8])
    place = speed * time - 0.5 * braking * time**2
    rate = speed - braking * time
    rows = np.zeros((2, 6))
    motion: Any = SimpleNamespace(time=time, coordinates=rows.copy(), velocities=rows.copy())
    motion.coordinates[:, 0], motion.velocities[:, 0] = place, rate
    model: Any = SimpleNamespace(bodies=np.arange(3)[None], travel=travel)
    instant, row = travel_reached(motion, model)
    assert row == 0
    # the squared displacement is of fourth order in time, of which the cubic between two samples misses some
    assert instant == pytest.approx((speed - math.sqrt(speed**2 - 2.0 * braking * travel)) / braking, abs=0.05)


def test_the_error_of_a_parabola_is_that_of_a_cubic_signal() -> None:
    time = np.arange(0.0, 1.0, 0.02)
    for shift in (0.003, 0.007, 0.013):
        t = time - 0.5 - shift
        peaks = Peaks(1, np.inf)
        peaks.add(time, (1.0 - 30.0 * t**2 + 40.0 * t**3)[:, None], np.ones((len(time), 1)))
        missed = abs(peaks.value[0] - 1.0)
        assert 1e-7 < missed <= 1.2 * peaks.sampling[0] < 4.0 * missed


def test_a_corner_is_the_mean_of_what_both_sides_say() -> None:
    """The rise is a parabola, which is read exactly; the decay is extrapolated by one through its first samples."""
    corner, time = 0.5 + 0.0072, np.arange(0.0, 1.0, 0.02)
    t = time - corner
    peaks = Peaks(1, 1.0)
    signal = np.where(t < 0.0, 1.0 + 2.0 * t + t**2, np.exp(-20.0 * t))
    peaks.add(time, signal[:, None], (1.0 - t)[:, None])
    behind = np.flatnonzero(t > 0.0)[:3]
    decay = np.polyval(np.polyfit(t[behind], signal[behind], 2), 0.0)
    assert abs(decay - 1.0) > 1e-3
    assert peaks.value[0] == pytest.approx(0.5 * (1.0 + decay), abs=1e-9)


def test_a_softer_contact_leaves_at_least_its_share_of_rho_open() -> None:
    stiff, soft = Peaks(2, 1.0), SimpleNamespace(outcome=Outcome.OK, peaks=Peaks(2, 1.0))
    level, model = multibody.levels(BRIEF)[0], assemble(BRIEF, "translational", 1e-3)
    for change in (0.0, 0.01):  # which counts with a safety of 1.5, and more where the contact is slow
        stiff.value[:], soft.peaks.value[:] = (1.0, 2.0), (1.0 + change, 2.0 - change)
        error = from_compliance(stiff, soft, level, model)  # type: ignore[arg-type]
        expected = 1.5 * change * (1.0 + lag(level, model)) + level.penetration * stiff.value
        np.testing.assert_allclose(error, expected)


def test_the_error_of_two_levels_is_at_least_their_change() -> None:
    """Richardson: a level that halves the error leaves as much as it removes."""
    levels = multibody.levels(BRIEF)[:2]
    peaks = [Peaks(1, 1.0), Peaks(1, 1.0)]
    for each, value in zip(peaks, (1.01, 1.0)):
        each.value[:] = value
    assert 0.01 <= from_levels(peaks, levels, assemble(BRIEF, "translational", 1e-3))[0] < 0.03


def test_the_error_of_an_answer_is_the_sum_of_its_parts() -> None:
    run: Any = SimpleNamespace(peaks=Peaks(1, 1.0))
    run.peaks.value[:] = 1.0
    parts = [np.array([part]) for part in (1e-3, 2e-3, 0.0)]
    answer = Candidate(run, multibody.levels(BRIEF)[0], True, *parts, (), compliance=np.array([4e-3]))
    assert answer.errors[0] == pytest.approx(7e-3)


def test_at_the_lowest_rate_a_whole_change_counts_as_error() -> None:
    """Richardson: what a level removes of the error it leaves once more where it halves it."""
    accuracy = multibody.trajectory(BRIEF, PHASE).accuracy
    assert accuracy is not None
    assert all(share >= 1.0 for share in accuracy.share)


def test_displacements_are_meters_and_their_shares_those_of_rho() -> None:
    engine = multibody.amplification(BRIEF, [PHASE])
    equations = reference.amplification(BRIEF, [PHASE], regularization=1e-3)
    np.testing.assert_allclose(engine.displacement, equations.displacement, rtol=1e-3)
    np.testing.assert_allclose(engine.cap_share, equations.cap_share, rtol=1e-3)


def test_supports_that_press_are_not_lifted() -> None:
    motion = multibody.trajectory(BRIEF, PHASE, "spatial")
    assert motion.support_force.min() > 0.0
    assert not motion.extra["uplift"].any()


def test_a_flat_slider_starts_under_the_weight_and_its_inertia() -> None:
    values = {"isolator.period": None, "isolator.radius": math.inf, "duration": 0.01}
    scene = load_scene("fig3-I").with_values({**values, "excitation.amplitudes": [[1.0, 0.0], [0.0, 1.0], [4.0, 2.0]]})
    motion = multibody.trajectory(scene, PHASE)
    expected = scene.total_mass * (GRAVITY + ground_acceleration(scene, PHASE, motion.time)[:, 2])
    np.testing.assert_allclose(motion.contact_force, expected, rtol=1e-3)


def test_a_link_without_bars_twists_as_if_it_stood_on_the_ring() -> None:
    """ring^2 (kx + ky) / 2 of bars that stand where the supports do, against what the engine answers."""
    scene, twisted = load_scene("fig3-I"), np.zeros(12)
    twisted[11] = 1e-4
    _, moments, model = forces_of_links(scene, twisted, np.zeros(12))
    ring = scene.isolator.ring
    assert ring is not None
    expected = 0.5 * ring**2 * scene.stiffness[0].sum() * 1e-4
    assert moments[0, 2] * model.units.force * model.units.length == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize("offset", [[0.03, -0.05], [-0.1, 0.0]], ids=str)
def test_a_stiff_link_carries_an_eccentric_weight_at_rest(offset: list[float]) -> None:
    """On the body above nothing is left but its weight, whose moment about its center of mass is zero."""
    scene = load_scene("fig3-I").with_values({"bodies.1.offset": offset, "isolator.supports": 3})
    _, moments, _ = forces_of_links(scene, np.zeros(12), np.zeros(12))
    below, above = np.abs(moments[:, :2]).max(axis=1)
    assert above < 1e-6 < below


def test_a_tower_tips_where_its_center_is_above_its_edge() -> None:
    """tan = b / h of a center of mass b inside the nearest edge and h above the plane of contact, rho + r = 1.2."""
    square = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])
    centers = np.array([[0.25, 0.0, 1.0], [0.25, 0.0, 5.4]])
    assert _critical_tilt(square, 0.2, np.ones(2), centers) == pytest.approx(math.atan(0.75 / 2.0), rel=1e-14)


def three_bodies_on_bars() -> ImpactLaw:
    """In impacts: eccentric bodies at unequal distances, on links that are rigid in tension and bending."""
    centers = np.array([[0.1, -0.05, 0.3], [-0.2, 0.1, 1.2], [0.05, 0.15, 2.6]])
    depressions = Depressions(np.array([[1.0, 0.0], [-1.0, 1.0], [-1.0, -1.0]]), centers[0], 0.2, np.empty(0, np.int_))
    return ImpactLaw(
        depressions, np.ones(3), np.ones((3, 3)), UPRIGHT, centers, 0.0, DryFriction(0.1, 0.1, 0.0), 1e-3,
        np.ones(2, bool),
    )  # fmt: skip


UPRIGHT = np.tile(np.eye(3), (3, 1, 1))


def test_a_chain_that_moves_as_one_stretches_and_bends_no_link() -> None:
    """Whatever its links are stretched and twisted by."""
    law, coordinates = three_bodies_on_bars(), np.random.default_rng(2).uniform(-0.2, 0.2, 18)
    places = law.centers + coordinates.reshape(3, 6)[:, :3]
    turned = rotation(coordinates.reshape(3, 6)[:, 3:])
    for axis in np.eye(3):
        turn = np.concatenate([[np.cross(axis, place), axis] for place in places]).ravel()
        shift = np.tile(np.concatenate([axis, np.zeros(3)]), 3)
        for velocity in (turn, shift):
            np.testing.assert_allclose(law._bars(coordinates, turned) @ velocity, 0.0, atol=1e-12)


def test_behind_an_impact_stretched_bars_balance_their_dampers() -> None:
    """Stiffness times stretch and damping times its rate: the jump of one makes up for that of the other."""
    law, lags = three_bodies_on_bars(), np.array([0.03, 0.07])
    before, after = np.random.default_rng(3).normal(size=(2, 18))
    stretched = law.with_bars_at_rest(np.zeros(18), before, after, lags).reshape(3, 6)[:, :3]
    jump = (after - before).reshape(3, 2, 3)
    for link, lag_of_link in enumerate(lags):
        end = np.array([0.0, 0.0, law.centers[link : link + 2, 2].mean()])
        below, above = (jump[body, 0] + np.cross(jump[body, 1], end - law.centers[body]) for body in (link, link + 1))
        np.testing.assert_allclose(stretched[link + 1] - stretched[link], [0.0, 0.0, -lag_of_link * (above - below)[2]])


@pytest.mark.parametrize("body", [1, 2])
def test_a_body_that_turns_about_its_link_s_end_bends_it(body: int) -> None:
    """The end is below its center of mass, half way to the body below and on the links' axis."""
    law = three_bodies_on_bars()
    end = np.array([0.0, 0.0, law.centers[body - 1 : body + 1, 2].mean()])
    for axis in np.eye(3):
        velocity = np.zeros((3, 2, 3))
        for above in range(body, 3):
            velocity[above] = np.cross(axis, law.centers[above] - end), axis
        rates = (law._bars(np.zeros(18), UPRIGHT) @ velocity.ravel()).reshape(2, 3)
        np.testing.assert_allclose(rates[body - 1], [0.0, axis[0], axis[1]], atol=1e-12)
        np.testing.assert_allclose(rates[2 - body], 0.0, atol=1e-12)
