"""Single numbers that are read off motions, each by its own closed form."""

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from chains import chain, made_up

import reference
from reference import motion
from reference.measures import demands
from reference.measures.distribution import FRACTILES, fractile
from reference.measures.peak_demands import QUANTITIES
from reference.measures.story_forces import story_forces
from reference.problem import Outcome, State, load_scene
from reference.solver import ground, look_ahead, peaks
from reference.solver.contact import stop_arc
from reference.solver.peaks import update_peak_by_limit
from reference.solver.phases import follow, sliding, stopping
from reference.solver.record import record_stick
from reference.solver.system import SET_VALUED, YIELDING


def test_fractiles_are_named_in_rising_order_and_follow_hazen() -> None:
    """Of the values 1 ... 100 a share p is below 100 p + 1/2."""
    assert list(FRACTILES) == sorted(FRACTILES)
    for probability in FRACTILES:
        assert fractile(np.arange(100.0, 0.0, -1.0), probability) == pytest.approx(100.0 * probability + 0.5)


def test_units_are_those_of_the_quantities() -> None:
    of = {
        "m": "displacement support_displacement residual drift uplift",
        "J": "friction_energy damping_energy energy_balance",
        "N": "base_shear contact_force_min contact_force_max support_force_min support_force_max",
        "m/s^2": "acceleration",
        "1": "cap_share travel_share stops",
        "rad": "torsion",
    }
    units = {name: unit for unit, names in of.items() for name in names.split()}
    assert {name: unit for name, (_, unit) in QUANTITIES.items()} == units
    words = {"min": "smallest", "max": "largest", "share": "over", "friction": "friction", "damping": "dampers"}
    words |= {part: part for part in ("displacement", "residual", "travel", "drift", "contact", "support", "uplift")}
    for name, (meaning, _) in QUANTITIES.items():
        assert all(words.get(part, "") in meaning for part in name.split("_")), name
    assert len({meaning for meaning, _ in QUANTITIES.values()}) == len(QUANTITIES)


def test_a_drift_is_against_the_body_below() -> None:
    scene = chain(masses=[1.0] * 4, stiffness=[[20.0, 20.0]] * 3, duration=1.0)
    place = np.tile(np.array([1.0, 3.0, 7.0, 8.0])[:, None] * [1.0, 0.0, 0.0], (21, 1, 1))
    motion = made_up(scene, np.linspace(0.0, 1.0, 21), position=place, peak=np.zeros(4))
    assert [drift.value for drift in demands(motion).drift] == [2.0, 4.0, 1.0]


def test_a_support_moves_with_the_turning_platform() -> None:
    """A support of an eccentric platform, against its place before and after the turn about the center of mass."""
    center, angle, moved = np.array([0.2, -0.1]), 0.3, np.array([0.05, -0.02])
    places = {"isolator.ring": None, "isolator.supports": [[1.0, 0.5], [-1.0, 0.5], [0.0, -1.0]]}
    scene = load_scene("fig3-I").with_values(places | {"bodies.0.offset": center})
    scene = scene.with_values({"bodies.1.damping": [3.0, 0.0]})
    place, turns = np.zeros((2, 11, len(scene.bodies), 3))
    place[5:, 0, :2], turns[5:, 0, 2] = moved, angle
    extra = {"turns": turns, "support_force": np.ones((11, 3)), "uplift": np.zeros((11, 3))}
    extra["uplift"][4, 1] = 0.01
    motion = made_up(scene, np.linspace(0.0, 1.0, 11), position=place, extra=extra)
    answer = demands(motion)
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    expected = max(np.linalg.norm(center + moved + turn @ (at - center) - at) for at in scene.support_places)
    assert answer.support_displacement.value == pytest.approx(expected, rel=1e-12)
    assert answer.uplift.value == 0.01
    uplift = story_forces(motion).uplift
    assert uplift is not None
    assert [each.value for each in uplift] == [0.0, 0.01, 0.0]
    assert (answer.damping_energy, answer.energy_balance) == (None, None)
    straight = demands(replace(motion, extra={"support_force": extra["support_force"]}))
    assert (straight.support_displacement, straight.torsion, straight.damping_energy.value) == (None, None, 0.0)


def test_dampers_take_the_energy_of_a_body_on_a_held_platform() -> None:
    """A body let go at rest at x: k x^2 / 2 goes into the damper, nothing into friction."""
    still = [[1e-9, 0.0], [0.0, 0.0]]
    scene = chain(1.0, 5.0, (1.0, 2.0), [(50.0, 50.0)], still, duration=20.0, damping=0.3)
    released = State(np.array([[0.0, 0.0], [0.02, 0.0]]), np.zeros((2, 2)))
    answer = demands(reference.trajectory(scene, (0.0, 0.0), initial=released))
    assert answer.friction_energy.value == 0.0
    assert answer.damping_energy.value == pytest.approx(0.5 * 50.0 * 0.02**2, rel=1e-3)
    assert abs(answer.energy_balance.value) < 1e-3 * answer.damping_energy.value


@pytest.mark.parametrize("share", [0.6, 0.72, 0.9])
def test_a_spectrum_is_read_between_the_steps(share: float) -> None:
    """A rigid floor jumps by 1 for a part of a period: the oscillator swings to 2 once, at half a period."""
    time, total = np.array([0.0, 1.0, np.nextafter(1.0, 2.0), 1.0 + share * 1.7]), np.zeros((4, 1, 3))
    total[2:, 0, 0] = 1.0
    motion = made_up(chain(duration=float(time[-1])), time, absolute_acceleration=total)
    found = reference.floor_spectra(motion, [1.7], 0.0).acceleration[0, 0, 0]
    assert found == pytest.approx(2.0, rel=1e-4)


def test_the_error_of_a_peak_counts_the_other_run() -> None:
    scene = load_scene("fig3-II")
    for phase in ((0.3, 1.1), (2.0, 0.7), (4.0, 5.5)):
        motion = reference.trajectory(scene, phase, tolerance=1e-4)
        accuracy = motion.accuracy
        (other,), (share,) = accuracy.coarser, accuracy.share
        left = accuracy.peak_error - accuracy.floor * motion.peak
        reading = left - share * np.abs(motion.peak - other.peak)
        assert (reading >= -1e-6 * left).all()
        assert reading[1] > 1e-5 or phase != (2.0, 0.7), "both runs read this peak inside a long step"


def test_two_runs_that_agree_by_chance_leave_the_error_of_their_tolerance(monkeypatch: pytest.MonkeyPatch) -> None:
    runs: list[Any] = []

    def same(*given: Any) -> Any:
        runs.append(runs[0] if runs else record_run(*given)._replace(reading_error=np.zeros(2)))
        return runs[-1]

    record_run = motion._record_run
    monkeypatch.setattr(motion, "_record_run", same)
    found = reference.trajectory(load_scene("fig3-II"), (0.3, 1.1), tolerance=1e-4)
    assert len(runs) == 2
    np.testing.assert_allclose(found.accuracy.peak_error, found.accuracy.floor * found.peak, rtol=1e-12)
    assert (found.accuracy.peak_error > 1e-7 * found.peak).all()


@pytest.mark.parametrize("place", [-1.0, 0.0, 0.07, 1.03, 1.3, 1.49, 2.0])
def test_a_peak_over_an_arc_is_found_on_either_side_of_the_best_sample(
    place: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A cosine over 1.5 rad, highest at `place` or at the nearer end; below the floor the best sample is enough."""
    squared = lambda system, load, angle, horizontal: horizontal + math.cos(angle - place)  # noqa: E731
    monkeypatch.setattr(stop_arc, "squared_absolute_acceleration", squared)
    for begin, end in ((0.0, 1.5), (1.5, 0.0)):
        found = stop_arc.arc_peak.py_func(None, None, begin, end, 0.0, 4.0)
        assert found == pytest.approx(4.0 + math.cos(min(max(place, 0.0), 1.5) - place), abs=1e-9)
        assert found >= stop_arc.arc_peak.py_func(None, None, begin, end, 99.0, 4.0) > found - 0.02


def test_a_record_has_the_friction_of_the_instant_before_and_behind_its_samples(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(ground, "friction_temperature_factor_at", lambda system, time: 0.5 + 0.1 * time)
    monkeypatch.setattr(ground, "next_knot", lambda record, time: int(np.searchsorted(record[:, 0], time, "right")))
    record: Any = SimpleNamespace(record=np.array([[1.0, 2.0, 3.0, 4.0], [2.0, 4.0, -3.0, 0.0]]))
    for time, expected in ((0.5, (2.0, 3.0, 4.0)), (1.25, (2.5, 1.5, 3.0)), (2.5, (0.0, 0.0, 0.0))):
        found = ground.record_acceleration_at.py_func(record, time)
        assert (found.x, found.y, found.z) == pytest.approx(expected)
        assert found.k_t == 0.5 + 0.1 * time


def test_a_motion_whose_looser_run_ended_early_is_that_of_a_tighter_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """Both runs give its error, and it states its law of friction as any other."""
    asked, record_run = [], motion._record_run

    def early(system: Any, pair: Any, x: Any, v: Any, settings: Any) -> Any:
        asked.append(settings.tolerance)
        run = record_run(system, pair, x, v, settings)
        return run._replace(outcome=Outcome.RIM_REACHED, instant=1.0) if len(asked) == 2 else run

    usual = reference.trajectory(load_scene("fig3-II"), (0.3, 1.1), regularization=1e-3)
    monkeypatch.setattr(motion, "_record_run", early)
    found = reference.trajectory(load_scene("fig3-II"), (0.3, 1.1), regularization=1e-3)
    assert asked[2] < asked[0] < asked[1]
    assert (found.status, found.law) == ("ok", usual.law)
    assert found.law != ""
    assert found.accuracy is not None


@pytest.mark.parametrize("yields", [False, True])
def test_velocity_errors_change_a_body_through_each_of_its_own_springs(
    yields: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Three bodies are linked; friction that yields is one more spring of the platform."""
    random = np.random.default_rng(8)
    defect, below, above = random.uniform(1.0, 3.0, (3, 3, 2))
    below[0], above[2] = np.nan, np.nan  # no springs
    monkeypatch.setattr(peaks, "velocity_defect", lambda work, body, axis: defect[body, axis])
    law, stiffness = (YIELDING, 7.0) if yields else (SET_VALUED, np.nan)
    system: Any = SimpleNamespace(below=below, above=above, law=law, stiffness=stiffness)
    for body in range(3):
        rates = np.zeros(2)
        for other, springs in ((body - 1, below[body]), (body + 1, above[body])):
            if 0 <= other < 3:
                rates += springs * (defect[other] - defect[body])
        rates -= 7.0 * defect[0] if yields and body == 0 else 0.0
        found = peaks.link_error_rate.py_func(system, SimpleNamespace(x=np.zeros((3, 2))), 0.2, body)
        assert found == pytest.approx(0.2 * np.hypot(*rates))


def test_a_platform_at_rest_may_slip_from_eight_tenths_of_its_squared_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    """A rough run then bounds its acceleration by that of a slide near its stop, otherwise by the ground's."""
    monkeypatch.setattr(look_ahead, "static_limit", lambda system, k_t, reaction: 0.5 * reaction)
    monkeypatch.setattr(look_ahead, "largest_near_stop", lambda gx, gy, *rest: 100.0 + gx + 10.0 * gy + rest[-1])
    load: Any = SimpleNamespace(k_t=1.0, fx=1.0, fy=2.0, px=0.5, py=-0.25)
    shaken: Any = SimpleNamespace(x=3.0, y=-4.0)
    limit, system = 0.5 * 4.0, SimpleNamespace(radius=2.0)
    for share, bound in ((0.79, 5.0), (0.81, 100.0 + (1.0 - 1.0) + 10.0 * (2.0 + 0.5) + limit)):
        excess = (share - 1.0) * limit**2
        found = look_ahead.bound_held_acceleration.py_func(system, load, shaken, excess, 4.0)
        assert found == (share > 0.8, pytest.approx(bound))


def test_a_slide_from_rest_that_fails_is_given_up_only_below_the_response_time_of_its_friction(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Friction that changes fast with the speed needs shorter steps than the loading does."""
    monkeypatch.setattr(sliding, "coefficient_slope", lambda system, speed: -50.0)
    long = sliding.NEGLIGIBLE_STEP * 3.0
    short = min(sliding.NEGLIGIBLE_RESPONSE / (50.0 * 2.0 * 10.0), 0.5 * long)
    monkeypatch.setattr(sliding, "NEGLIGIBLE_RESPONSE", short * 50.0 * 2.0 * 10.0)
    settings, give_up = SimpleNamespace(period=3.0), (sliding.UNSOLVED, sliding.SLIDING)
    for rate, length, slips, speed, expected in (
        (0.0, 0.9 * long, False, 0.0, give_up),
        (0.0, 0.9 * long, True, 0.0, (sliding.SOLVED, sliding.REST)),
        (0.0, 1.1 * long, False, 0.0, (sliding.SOLVED, sliding.SLIDING)),
        (9.0, 0.9 * long, False, 0.0, (sliding.SOLVED, sliding.SLIDING)),
        (9.0, 0.9 * short, False, 0.0, give_up),
        (9.0, 0.9 * short, False, 1.0, (sliding.SOLVED, sliding.SLIDING)),
    ):
        monkeypatch.setattr(sliding, "barely_slips", lambda system, work, slips=slips: slips)
        work: Any = SimpleNamespace(v=np.array([[0.0, speed]]), last_length=1.0, max_growth=9.0, hold_time=0.0)
        system: Any = SimpleNamespace(rate=rate, mass_ratio=2.0, gravity=10.0)
        assert sliding.recover_failed_slide.py_func(system, work, settings, length) == expected


def test_bodies_above_have_the_arc_s_vertical_part(monkeypatch: pytest.MonkeyPatch) -> None:
    """At a stop: the horizontal part of each stays, and all share the vertical acceleration of the platform."""
    taken: dict[int, float] = {}

    def take(work: object, body: int, squared: float) -> None:
        taken[int(body)] = squared

    monkeypatch.setattr(stopping, "direction_at_stop", lambda *rest: 1.0)
    monkeypatch.setattr(stopping, "arc_peak", lambda system, load, a, b, floor, horizontal: 9.0 if horizontal else 4.0)
    monkeypatch.setattr(stopping, "update_peak_by_limit", take)
    total = np.array([[0.0, 0.0, 0.0], [1.0, 2.0, 0.1], [3.0, 0.5, 0.1]])
    work: Any = SimpleNamespace(x=np.zeros((3, 2)), total0=total, best=np.ones(3), angle=0.0)
    assert stopping.update_peaks_by_arc.py_func(SimpleNamespace(small=False), work, None, False)
    assert taken == {0: 9.0, 1: 1.0 + 4.0 + 4.0, 2: 9.0 + 0.25 + 4.0}


def test_at_a_stop_the_platform_rises_along_its_sphere_on_top_of_the_ground(monkeypatch: pytest.MonkeyPatch) -> None:
    radius, place, along, ground = 0.6, np.array([0.3, -0.1]), np.array([1.3, 0.8]), np.array([0.4, -0.7, 2.1])
    monkeypatch.setattr(stop_arc, "acceleration_along", lambda *rest: (*along, 9.0, 1.0))
    load = SimpleNamespace(**dict(zip(("px", "py", "ux", "uy", "uz"), (*place, *ground), strict=True)))
    time = 1e-3
    height = [radius - math.sqrt(radius**2 - at @ at) for at in (place, place + 0.5 * along * time**2)]
    rise = ground[2] + 2.0 * (height[1] - height[0]) / time**2
    for small, vertical in ((False, rise), (True, ground[2])):
        system: Any = SimpleNamespace(small=small, radius=radius)
        squared = stop_arc.squared_absolute_acceleration.py_func
        assert squared(system, load, 0.4, 0.0) == pytest.approx(vertical**2, rel=1e-5)
        across = float(np.sum((along + ground[:2]) ** 2))
        assert squared(system, load, 0.4, 1.0) == pytest.approx(across + vertical**2, rel=1e-5)


def test_what_steps_miss_of_a_vibration_adds_up_to_all_of_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """A share of 6e-8 of the defect and the angle's seventh power in a step, up to the defect over twice that share."""
    monkeypatch.setattr(follow, "link_error_rate", lambda *given: 0.0)
    work: Any = SimpleNamespace(x=np.zeros((2, 2)), defect=np.array([1e-3, 2e-3]), drift=np.zeros(2))
    share = 6e-8 * 6.0**7
    for step in range(1, 10_000):
        follow.add_drift.py_func(SimpleNamespace(fastest=50.0), work, 0.1, 6.0)
        if step < 5:
            np.testing.assert_allclose(work.drift, step * share * work.defect)
    np.testing.assert_allclose(work.drift, work.defect / (2.0 * share))


def test_a_one_sided_limit_has_what_the_steps_missed_of_vibrations_as_its_error() -> None:
    """The largest of its body is replaced; near it an early end is put off alone, and below nothing is changed."""
    for squared, later, best, error in ((4.1, 1.5, 4.1, 3e-5), (3.9, 1.5, 4.0, 7e-5), (3.0, 0.5, 4.0, 7e-5)):
        work: Any = SimpleNamespace(time=1.5, last_peak=0.5, last_large=0.5)
        work.best, work.reading_error, work.drift = np.array([[9.0, 4.0], [8e-5, 7e-5], [2e-5, 3e-5]])
        update_peak_by_limit.py_func(work, 1, squared)
        assert (work.last_large, work.last_peak) == (later, later)
        assert work.best.tolist() == [9.0, best]
        assert work.reading_error.tolist() == [8e-5, error]


def test_rests_that_touch_are_one() -> None:
    record: Any = SimpleNamespace(counts=np.zeros(2, int), sticks=np.zeros((4, 2)))
    for start, end in ((0.0, 1.0), (1.0, 2.5), (3.0, 4.0), (3.5, 3.5)):
        record_stick.py_func(record, start, end)
    assert record.sticks[: record.counts[1]].tolist() == [[0.0, 2.5], [3.0, 4.0]]
