"""Single numbers that a run reports or rests on, each by its own closed form."""

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from scenes_at_hand import forces_of_links

import multibody
import reference
from multibody import demand_surface
from multibody.integration.candidate import Candidate
from multibody.integration.constant_step import EngineMotion
from multibody.integration.engine_run import Budget
from multibody.integration.estimate import (
    _error_of_starting_links,
    compliance_error,
    contact_lag,
    contact_noise_error,
    error_between_levels,
    rounding_error,
)
from multibody.integration.peak import PeakReader
from multibody.integration.step_control import StepControl, gap_rate_at_end
from multibody.integration.termination import find_termination, find_travel_end
from multibody.integration.time_scales import largest_step, list_brief_motions
from multibody.models.assembly import assemble
from multibody.models.depressions import Depressions, rotation_matrices
from multibody.models.impact import ImpactLaw
from multibody.models.links import fastest_bar_frequency
from multibody.models.plane import _largest_distance_possible, set_plane_extent
from multibody.models.spatial import _critical_tilt
from multibody.models.units import units_of
from multibody.motion import _measure_attitude
from reference.problem import GRAVITY, DryFriction, Outcome, Scene, load_scene
from reference.problem.bar_links import BarLink

PHASE = (0.3, 1.1)
BRIEF = load_scene("fig3-I").with_values({"duration": 0.5})
LEVELS = multibody.levels(BRIEF)[:3]
MODEL = assemble(BRIEF, "translational", 1e-3)


@pytest.mark.parametrize(("end", "error"), [(0.8, 0.05), (0.55, 0.005)], ids=["fast on its way back", "slow"])
def test_a_travel_passed_within_a_step_is_passed_on_the_way_out(end: float, error: float) -> None:
    """x = v t - a t^2 / 2 goes beyond the travel and comes back within one step."""
    speed, braking, travel = 2.0, 4.0, 0.49
    time = np.array([0.35, end])
    motion: Any = SimpleNamespace(time=time, coordinates=np.zeros((2, 6)), velocities=np.zeros((2, 6)))
    motion.coordinates[:, 0], motion.velocities[:, 0] = speed * time - 0.5 * braking * time**2, speed - braking * time
    model: Any = SimpleNamespace(bodies=np.arange(3)[None], travel=travel)
    instant, row = find_travel_end(motion, model)
    assert row == 0
    # the squared displacement is of fourth order in time, of which the cubic between two samples misses some
    assert instant == pytest.approx((speed - math.sqrt(speed**2 - 2.0 * braking * travel)) / braking, abs=error)


UNEVEN = {"bodies.0.mass": 2.0, "bodies.1.mass": 3.0, "isolator.friction": 0.07}
QUICK = {"bodies.1.period": [0.01, 0.02]}
LEVELS_OF: dict[str, tuple[dict[str, Any], str, float, float]] = {
    "slower than friction relaxes": ({}, "translational", 1e-3, 1e-3),
    "as stiff as rounding allows": ({"excitation.decay": [0.2, 900.0]}, "translational", 1e-2, 1e-5),
    "weak loading": ({"excitation.scale": 3e-5, "excitation.periods": [0.9, 0.3]}, "translational", 1e-4, 1e-3),
    "quick link": (QUICK, "translational", 1e-3, 1e-2),
    "quick link of a body that turns": ({**QUICK, "isolator.ring": 6.0}, "spatial", 1e-3, 1e-2),
}


@pytest.mark.parametrize("name", LEVELS_OF)
def test_levels_follow_from_the_times_of_the_motion(name: str) -> None:
    """Each halves the step, and quarters the contact's compliance as long as its rounding permits."""
    values, model, tolerance, v_reg = LEVELS_OF[name]
    scene, turns = load_scene("fig3-I").with_values({**UNEVEN, **values}), model == "spatial"
    unit, load = math.sqrt(scene.radius / GRAVITY), scene.largest_acceleration / GRAVITY
    relaxation = 0.4 * v_reg / (0.07 * GRAVITY) / unit  # with the platform's share of the mass
    natural, end = float(reference.modes(scene).period.min()), scene.duration / unit
    period = min(natural, *scene.excitation.periods) / unit
    strength, peak = (load, load) if name == "weak loading" else (1.0, 0.2)
    moment = 1e-15 * (6.0 / scene.radius) ** 2 if turns else 1e-15  # of a place, squared
    stiffest = moment / (0.25 * peak * min(tolerance, 1e-3))
    response = min(0.3 * relaxation, (0.04 if turns else 0.25) * period / (2.0 * math.pi), 1e-3)
    softest = max(response**2, stiffest)
    decay = values.get("excitation.decay", [0.0, 0.0])[1] * unit
    brief = [(28.0 / decay, 1.0 / 24.0 / decay)] if decay else []
    smallest = min(0.05 * 0.14 * relaxation, *(step for _, step in brief), period / 150.0)
    divisions = max(7, math.ceil(math.log(period / 150.0 / smallest, 4.0)))
    levels = multibody.levels(scene, model, tolerance, v_reg)
    assert len(levels) == 8
    for number, level in enumerate(levels):
        step = period / 150.0 / 2.0**number
        penetration = softest / 4.0 ** min(number, math.floor(math.log(softest / stiffest, 4.0) + 1e-9))
        newton = max(1e-5 / 4.0**number * min(1.0, 1e3 * penetration / step**2), 1e-12)
        residual = max(1e-3 * newton * strength, moment / penetration)
        expected = [step, 0.14 / 2.0**number, penetration, newton, residual, 8e-4 / 4.0**number]
        expected += [0.0 if turns else 2.0 * load, 12.0 * (load * end) ** 2, (0.05 * end) ** 2, divisions, 0.0]
        columns = [level.step, level.slip_change, level.penetration, level.newton, level.residual, level.error_floor]
        columns += [level.load, level.force_change, level.softest, level.max_divisions, level.slide_end]
        np.testing.assert_allclose(columns, expected)
        np.testing.assert_allclose(level.decays, [(until, short / 2.0**number) for until, short in brief])


def test_a_level_counts_its_steps() -> None:
    """
    Small steps so that chunks of all levels end alike; those of brief motions and behind an impact, by powers of four.
    """
    level = replace(LEVELS[0], step=0.1, decays=((2.0, 0.01), (1.0, 1e-3)), max_divisions=5)
    assert [level.min_divisions(time) for time in (0.5, 1.0, 1.9, 2.0)] == [4, 2, 2, 0]
    assert replace(level, max_divisions=3).min_divisions(0.5) == 3
    coarse = replace(level, step=0.4, slip_change=0.56, newton=10.0 * level.newton, decays=((2.0, 0.04), (1.0, 4e-3)))
    assert level.coarsen() == coarse
    changes = [*(0.14 / 2.0 ** np.arange(8)), 1.0, 1e-9]
    counts = [StepControl(MODEL, replace(level, slip_change=change)).count_small_steps() for change in changes]
    assert counts == [*(32 * 2 ** np.arange(8)), 8, 4096]
    for step, divisions in ((0.9e-4, 0), (2.4e-4, 0), (0.9e-3, 1), (1.1e-3, 2), (0.5, 5)):
        behind = StepControl(MODEL, replace(level, step=step, penetration=1e-6)).count_divisions_behind_impact()
        assert behind == divisions, "the first step is a quarter of the contact's response time of 1e-3"


def test_motions_that_a_step_does_not_resolve_are_listed_with_theirs() -> None:
    """Harmonics that decay and a platform that oil brakes; until 28 times the time in which each falls to 1/e."""
    values = {"bodies.0.mass": 2.0, "bodies.1.mass": 3.0, "isolator.lubrication": 7.0, "excitation.decay": [0.2, 0.9]}
    scene = load_scene("fig4-viscous").with_values(values)
    model = assemble(scene, "translational", None)
    times = np.array([1.0 / 0.2, 1.0 / 0.9, 2.0 / (7.0 * 5.0 * GRAVITY)]) / model.units.time
    np.testing.assert_allclose(list_brief_motions(scene, model, 1e3), np.column_stack([28.0 * times, times / 24.0]))
    np.testing.assert_allclose(list_brief_motions(scene, model, times[2] / 23.9)[0][0], 28.0 * times[2])
    assert list_brief_motions(scene, model, times[2] / 24.1) == []


def test_a_state_has_the_rates_of_the_step_before_it() -> None:
    """Of the slip speeds, and of the loads over the shares of the weight of two contacts."""
    draw, time = np.random.default_rng(4), np.array([0.0, 0.3, 0.35, 0.75])
    contact, force = draw.normal(size=(4, 8)), draw.normal(size=(4, 2, 2, 3))
    motion = EngineMotion(time, *draw.normal(size=(3, 4, 5)), contact, force.reshape(4, 12))
    load = 2.0 * np.abs((force[:, :, 0] * force[:, :, 1]).sum(axis=2))
    for row, before in ((1, 0), (2, 1), (-1, 2)):
        state, span = motion.state_at(row), time[row] - time[before]
        np.testing.assert_array_equal(state.velocities, motion.velocities[row])
        np.testing.assert_allclose(state.slip_rate, (contact[row, 1::4] - contact[before, 1::4]) / span)
        np.testing.assert_allclose([state.load, state.load_rate], [load[row], (load[row] - load[before]) / span])
    first, unloaded = motion.state_at(0), motion._replace(force=np.empty((4, 0))).state_at(2)
    np.testing.assert_allclose(first.load, load[0])
    assert (first.slip_rate, first.load_rate, unloaded.load, unloaded.load_rate) == (None,) * 4
    assert unloaded.slip_rate is not None


def test_a_plane_is_as_wide_as_a_platform_may_move() -> None:
    """From where it starts, with its own speed and twice the largest acceleration of the loading, but never back."""
    units, coordinates, velocities = MODEL.units, np.array([0.2, -7.0, 1.0]), np.array([-3.0, 0.5, 2.0])
    end, load = BRIEF.duration / units.time, 2.0 * BRIEF.largest_acceleration / units.acceleration
    expected = 7.0 + 3.0 * end + load * end**2
    assert _largest_distance_possible(BRIEF, units, coordinates, velocities) == pytest.approx(expected)
    made: list[Any] = []
    system: Any = SimpleNamespace(
        SetObjectParameter=lambda *given: made.append(np.array([given[2][k] for k in range(3)]))
    )
    for distance in (1.0, 1e6):
        set_plane_extent(system, "contact", distance, 0.3)
        ahead = np.roll(made[-1], 1, axis=0) - made[-1]  # along the three edges of the triangle
        nearest = np.abs(np.cross(made[-1], ahead)[:, 2]).min() / np.linalg.norm(ahead, axis=1).max()
        assert (nearest >= max(distance, 1e3), made[-1][:, 2].tolist()) == (True, [0.3] * 3)


def test_a_motion_ends_with_what_comes_first() -> None:
    """It passes its travel of 0.5 between the rows 3 and 4; the contact opens before that, at the rim, or not."""
    time, ends = np.arange(7.0), {2: (Outcome.CONTACT_LOST, 2), 4: (Outcome.TRAVEL_REACHED, 3)}
    coordinates, velocities = np.zeros((2, 7, 3))
    coordinates[:, 0], velocities[:, 0] = 0.15 * time, 0.15
    model: Any = SimpleNamespace(depressions=None, bodies=np.arange(3)[None], travel=0.5, allows_liftoff=False)
    for lost, (outcome, row) in ends.items():
        contact = np.where(time >= lost, 1.0, -1.0)[:, None] * [1.0, 0.0, 0.0, 0.0]
        motion: Any = SimpleNamespace(time=time, coordinates=coordinates, velocities=velocities, contact=contact)
        assert find_termination(motion, model) == (outcome, row, pytest.approx(min(lost, 0.5 / 0.15)))
    motion.coordinates[2:, 2], motion.contact[2:, 0] = 1.0, 1.0
    assert find_termination(motion, model) == (Outcome.RIM_REACHED, 2, 2.0)


def peaks_of(*values: Any) -> list[PeakReader]:
    """Peaks of so many runs."""
    peaks = [PeakReader(np.size(value), 1.0) for value in values]
    for each, value in zip(peaks, values):
        each.value[:] = value
    return peaks


def test_a_softer_contact_leaves_at_least_its_share_of_rho_open() -> None:
    """A change counts with a safety of 1.5, and more where the contact is slow; without an answer nothing is known."""
    for change, outcome in ((0.0, Outcome.OK), (0.01, Outcome.OK), (0.01, Outcome.STEP_LIMIT)):
        stiff, soft = peaks_of((1.0, 2.0), (1.0 + change, 2.0 - change))
        run: Any = SimpleNamespace(outcome=outcome, peaks=soft)
        expected = 1.5 * change * (1.0 + contact_lag(LEVELS[0], MODEL)) + LEVELS[0].penetration * stiff.value
        expected += 0.0 if outcome == Outcome.OK else np.inf
        np.testing.assert_allclose(compliance_error(stiff, run, LEVELS[0], MODEL), expected)
    response = np.sqrt(LEVELS[0].penetration * BRIEF.radius / GRAVITY)  # s, of the contact
    relaxation = BRIEF.masses[0] * 1e-3 / (BRIEF.friction_coefficient * BRIEF.total_mass * GRAVITY)  # s, of friction
    assert contact_lag(LEVELS[0], MODEL) == pytest.approx(response / relaxation)


def test_the_error_of_levels_is_what_richardson_says() -> None:
    """
    A level that reduces the error r times leaves 1 / (r - 1) of its change: with a safety of 1.5 at two levels, whose r
    is 2, and of 1.25 at three, whose r is seen, between 2 and 4. Changes of opposite sign show no rate; one that falls
    more than fivefold is accidental, and half of the one before counts. The error of reading adds.
    """
    slow = 1.0 + contact_lag(LEVELS[1], MODEL)
    for values, expected in (
        ((1.0, 1.01), 1.5 * 0.01 * (1.0 + contact_lag(LEVELS[0], MODEL))),
        ((0.96, 1.0, 1.016), 1.25 * 0.016 * slow / (2.5 - 1.0)),
        ((0.99, 1.0, 1.02), 1.25 * 0.02 * slow),
        ((0.955, 1.0, 1.01), 1.25 * 0.01 * slow / (4.0 - 1.0)),
        ((0.94, 1.0, 0.99), 1.25 * 0.03 * slow),
        ((0.96, 1.0, 0.99), 1.25 * 0.01 * slow),
        ((0.6, 1.0, 1.01), 1.25 * 0.2 * slow),
    ):
        for reading in (0.0, 0.007):
            peaks = peaks_of(*values)
            peaks[-1].sampling_error[:] = reading
            error = error_between_levels(peaks, LEVELS[: len(values)], MODEL)[0]
            assert error == pytest.approx(expected + reading + 1e-6 * values[-1], rel=1e-9)
    for springs, floor in ((None, 2e-4), ("some", 6e-4)):  # where levels agree by chance
        model: Any = replace(MODEL, springs=springs)  # type: ignore[arg-type]
        error = error_between_levels(peaks_of(3.0, 3.00001), LEVELS[:2], model)[0]
        assert error == pytest.approx(3.00001 * (floor + 1e-6), rel=1e-9)


def test_what_newton_s_method_leaves_is_an_error() -> None:
    """On a plane it adds to what levels show, which all share it; elsewhere it is the least error."""
    shown = 1.5 * 0.01 * (1.0 + contact_lag(LEVELS[0], MODEL))
    for flat, left, expected in ((True, 0.4, shown + 0.4), (False, 0.4, 0.4), (False, 1e-3, shown)):
        last = replace(LEVELS[1], newton=0.5 * left, load=2.0, flat=flat)
        error = error_between_levels(peaks_of(1.0, 1.01), [LEVELS[0], last], MODEL)[0]
        assert error == pytest.approx(expected + 1e-6 * 1.01, rel=1e-9)


def test_the_error_of_an_answer_is_the_sum_of_its_parts() -> None:
    """Unless one body shows that levels have not converged: then none is known to better than itself."""
    [peaks] = peaks_of((1.0, 2.0))
    run: Any = SimpleNamespace(peaks=peaks)
    for shown, expected in ((1e-3, (7e-3, 7e-3)), (0.295, (0.301, 7e-3)), (0.31, (1.004, 2.004))):
        parts = np.array([shown, 1e-3]), np.full(2, 2e-3), np.zeros(2)
        answer = Candidate(run, LEVELS[0], True, *parts, np.full(2, 4e-3), (), confirmed=True, floor=0.0)
        np.testing.assert_allclose(answer.errors, expected)
        assert answer.relative_error == pytest.approx(expected[0])


def test_a_softer_contact_shows_what_rounding_leaves() -> None:
    """Four thirds of the change, with a safety, no less than a level typically has; never more than rounding itself."""
    level = replace(LEVELS[0], rounding_moment=0.1 * LEVELS[0].penetration)
    for ratio, safety, change, expected in (
        (4.0, 1.5, (0.01, 0.02), (0.02, 0.04)),
        (4.0, 3.0, (0.01, 0.03), (0.04, 0.1)),
        (4.0, 1.5, (1e-5, 0.01), (8e-4, 0.02)),
        (3.9, 1.5, (0.0, 0.0), (0.1, 0.1)),
    ):
        stiff, soft = peaks_of((1.0, 2.0), np.array([1.0, 2.0]) + [1.0, -1.0] * np.array(change))
        softer = replace(level, penetration=ratio * level.penetration)
        np.testing.assert_allclose(rounding_error(stiff, level, soft, softer, safety), expected)


def test_stiff_links_that_swing_at_the_start_are_an_error() -> None:
    """What a peak within four response times of the contact exceeds the first sample by, up to twice of it."""
    [peaks] = peaks_of((3.0, 4.0, 4.1, 3.0))
    peaks.first_sample, peaks.instant[:] = np.full(4, 2.0), (3.9e-3, 1e-3, 1e-3, 4.1e-3)
    level, model = replace(LEVELS[0], penetration=1e-6), cast("Any", SimpleNamespace(depressions="some"))
    np.testing.assert_array_equal(_error_of_starting_links(peaks, level, model), [1.0, 2.0, 0.0, 0.0])
    assert not _error_of_starting_links(peaks, level, MODEL).any(), "of bodies that do not turn"


def test_steps_grow_until_the_slip_speed_asks_for_smaller_ones() -> None:
    """Of the slowest loaded contact: down to what its acceleration asks for, or up to the corner; 32 to 256 steps."""
    model: Any = SimpleNamespace(corner=0.01, bodies=np.array([[0, 1, 2]]))
    control = StepControl(model, replace(LEVELS[0], step=0.1, slip_change=0.07))  # 0.2 at this acceleration
    for before, slip, gap, count in (
        (0.5015, 0.4995, -1.0, 149),
        (0.5015, 0.4995, 1.0, 256),  # unloaded
        (0.4, 0.4995, -1.0, 256),
        (0.9, 0.4995, -1.0, 32),
        (0.00395, 0.00405, -1.0, 59),
    ):
        contact = np.array([[gap, slow, 0.0, 0.0, gap, 2.0, 0.0, 0.0] for slow in (9.0, before, slip)])
        motion: Any = SimpleNamespace(time=np.array([0.0, 0.7, 0.8]), contact=contact, accelerations=np.zeros((3, 8)))
        motion.accelerations[-1] = [0.0, 0.14, 0.0, 9.0, 9.0, 9.0, 9.0, 9.0]
        assert control.count_largest_steps(motion) == count
    assert StepControl(cast("Any", SimpleNamespace(corner=math.inf)), LEVELS[0]).count_largest_steps(motion) == 256
    time, gaps = np.cumsum(np.arange(8.0)), np.random.default_rng(1).normal(size=(8, 2))
    for rows, back in ((8, 4), (6, 4), (5, 4), (4, 2), (3, 2)):  # an even number of steps
        motion = SimpleNamespace(time=time[:rows], gap=gaps[:rows])
        slope = (gaps[rows - 1] - gaps[rows - 1 - back]) / (time[rows - 1] - time[rows - 1 - back])
        np.testing.assert_allclose(gap_rate_at_end(motion), slope)
    assert not gap_rate_at_end(cast("Any", SimpleNamespace(time=time[:2], gap=gaps[:2]))).any()


def test_forces_round_as_the_square_of_the_farthest_place() -> None:
    places = {"isolator.ring": None, "isolator.supports": [[5.0, 0.0], [-1.0, 1.0], [-1.0, -1.0]]}
    for values, farthest in (({"bodies.1.height": 7.0}, 7.0), (places, 5.0)):
        scene = load_scene("fig3-I").with_values(values)
        found = assemble(scene, "spatial", 1e-3).rounding
        assert found == pytest.approx(1e-15 * (farthest / scene.radius) ** 2, abs=0.0)


def test_noise_of_the_contact_is_an_error_along_the_vertical() -> None:
    """
    Half of a force's rounding, which adds to a peak as to its vertical component. On a plane a part of what Newton's
    method leaves acts on the platform, of 2/5 of the mass; of bodies that turn only a peak that is noise has it.
    """
    level = replace(LEVELS[0], rounding_moment=2e-3 * LEVELS[0].penetration, newton=1.0)
    level = replace(level, strength=5.0)  # residual: 5e-3
    scene, peak = BRIEF.with_values({"bodies.0.mass": 2.0, "bodies.1.mass": 3.0}), np.array([0.2, 0.9])
    run: Any = SimpleNamespace(peaks=peaks_of(peak)[0], max_vertical=0.3)

    def noise_of(turns: bool, vertical: bool, flat: bool, run: Any = run) -> Any:
        ground = SimpleNamespace(accelerates=lambda axis: vertical and axis == 2)
        model: Any = SimpleNamespace(depressions="some" if turns else None, ground=ground)
        case = scene.with_values({"isolator.period": None, "isolator.radius": math.inf}) if flat else scene
        return contact_noise_error(run, level, case, model)

    slow, fast = (peak - np.sqrt(peak**2 - (2.0 * v + 1e-3) * 1e-3) for v in (np.minimum(peak, 0.3), peak))
    np.testing.assert_allclose(noise_of(False, False, False), np.minimum(slow, 1e-3))
    np.testing.assert_allclose(noise_of(False, True, False), np.minimum(fast, 1e-3))
    left = 5e-3 / 0.4
    np.testing.assert_allclose(noise_of(False, False, True) - np.minimum(slow, 1e-3), [left, 0.0], atol=1e-15)
    tenfold: Any = SimpleNamespace(peaks=peaks_of(10.0 * peak)[0], max_vertical=0.0)
    found = noise_of(False, False, True, tenfold)[0] - noise_of(False, False, False, tenfold)[0]
    assert found == pytest.approx(left * 40.0 * left / 2.0)
    weak: Any = SimpleNamespace(peaks=peaks_of((3.9e-4, 4.1e-4))[0], max_vertical=0.3)
    np.testing.assert_allclose(noise_of(True, True, False, weak), [4e-4, 0.0])


def test_rounding_makes_a_finer_answer_worse_where_it_may_exceed_the_coarser_one_s_error() -> None:
    """Of any body; without a known error a finer answer is no better."""
    coarse, fine = (answer_with(errors, LEVELS[0]) for errors in ((2e-3, 9e-3), (3e-3, 6e-3)))
    for best, own, rounding, worse in (
        (coarse, (3e-3, 9e-3), 1e-3, False),  # rounding is smaller than both errors
        (coarse, (3e-3, 9.1e-3), 3e-3, True),
        (coarse, (1e-3, 9e-3), 3e-3, True),
        (coarse, (1e-3, 8e-3), 1.0, False),
        (fine, (math.nan, 1e-3), 4e-3, True),
    ):
        level = replace(LEVELS[0], rounding_moment=rounding * LEVELS[0].penetration)
        assert answer_with(own, level).is_worse_by_rounding(best) == worse, (own, rounding)


def test_an_answer_is_judged_by_all_bodies_and_any_rounding() -> None:
    """And only if the runs that confirm it have ended; a softer contact may show that less rounds."""
    answer = answer_with((4e-3, 4e-3), LEVELS[0])
    for confirmed, tolerance, meets in ((True, 4e-3, True), (True, 3.9e-3, False), (False, 1.0, False)):
        asked = replace(answer, confirmed=confirmed)
        assert (asked.meets(tolerance), asked.may_meet(tolerance)) == (meets, meets)
    rounded = replace(answer, rounding=np.array([0.0, 5e-3]))
    assert (rounded.meets(4e-3), rounded.may_meet(4e-3)) == (False, True), "a softer contact may show that less rounds"
    for rounding, limited in ((0.9e-3, False), (1.5e-3, True), (2.5e-3, True)):
        level = replace(LEVELS[0], rounding_moment=rounding * LEVELS[0].penetration)
        assert answer_with((4e-3, 4e-3), level).is_limited_by_rounding(1e-3) == limited
    soft: Any = SimpleNamespace(outcome=Outcome.OK, peaks=peaks_of((1.01, 2.001))[0])
    asked_of: list[Any] = []
    pair: Any = SimpleNamespace(
        run_level=lambda *given, **more: (asked_of.append((*given, more)), soft)[1], model=MODEL
    )
    level = replace(LEVELS[0], rounding_moment=0.1 * LEVELS[0].penetration)
    shared = replace(answer_with((0.0, 0.0), level), shares_contact=True, rounding=np.array([0.03, 0.03]))
    shared.run.stop, budget = 0.7, Budget(1.0)
    whole = shared.add_compliance_error(pair, budget, keep=True)
    softer = replace(level, penetration=4.0 * level.penetration)
    assert asked_of == [(softer, budget, 0.7, {"keep": True, "residual": level.residual})]
    np.testing.assert_allclose(whole.rounding, [0.03, 0.004])
    assert (shared.is_complete, whole.is_complete, [run for run, _ in whole.coarser]) == (False, True, [soft])


def test_bars_shorten_steps_up_to_twentyfold() -> None:
    for frequency, step in ((0.0, 0.02), (2.0, 0.02), (2.0 * math.pi, 1.0 / 40.0 / 2.0), (1e4, 1e-3)):
        bars: Any = SimpleNamespace(fastest_bar_frequency=2.0 * frequency)
        assert largest_step(3.0, bars) == pytest.approx(step)


def answer_with(errors: tuple[float, float], level: Any) -> Candidate:
    """Peaks of 1 and 2 with these errors."""
    run: Any = SimpleNamespace(peaks=peaks_of((1.0, 2.0))[0], stop=math.inf)
    nothing = np.zeros(2)
    return Candidate(run, level, False, np.array(errors), nothing, nothing, None, (), confirmed=True, floor=0.0)


def test_a_motion_comes_with_the_accuracy_of_all_its_numbers() -> None:
    """At the lowest rate a whole change counts, with the safety of two levels and more where the contact is slow."""
    accuracy = multibody.trajectory(BRIEF, PHASE).accuracy
    assert accuracy.share == pytest.approx([1.5 * (1.0 + contact_lag(LEVELS[0], MODEL))])
    assert accuracy.floor == LEVELS[1].error_floor == 2e-4


def test_displacements_are_meters_and_their_shares_those_of_rho() -> None:
    engine = multibody.amplification(BRIEF, [PHASE])
    equations = reference.amplification(BRIEF, [PHASE], regularization=1e-3)
    np.testing.assert_allclose(engine.displacement, equations.displacement, rtol=1e-3)
    np.testing.assert_allclose(engine.cap_share, equations.cap_share, rtol=1e-3)


def test_supports_that_press_are_not_lifted() -> None:
    motion = multibody.trajectory(BRIEF, PHASE, "spatial")
    assert motion.support_force.min() > 0.0
    assert not motion.extra["uplift"].any()
    np.testing.assert_allclose(motion.contact_force, motion.support_force.sum(axis=1), rtol=1e-12)
    lubricated = load_scene("fig4-viscous").with_values({"duration": 0.5})
    assert multibody.trajectory(lubricated, PHASE).stick == [], "only dry friction sticks"


@pytest.mark.parametrize(
    ("places", "square"), [({}, 1.0), ({"supports": [[1.4, 0.2], [-0.9, 1.1], [-0.6, -1.2]], "ring": None}, 5.82 / 3.0)]
)
def test_a_link_without_bars_twists_as_if_it_stood_on_the_supports(places: dict[str, Any], square: float) -> None:
    """Mean square distance times (kx + ky) / 2: of a ring of 1 m, or of stated places, against the engine's moment."""
    scene = load_scene("fig3-I").with_values({f"isolator.{key}": value for key, value in places.items()})
    twisted = np.zeros(12)
    twisted[11] = 1e-4
    _, moments, model = forces_of_links(scene, twisted, np.zeros(12))
    expected = 0.5 * square * scene.stiffness[0].sum() * 1e-4
    assert moments[0, 2] * model.units.force * model.units.length == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize("offset", [[0.03, -0.05], [-0.1, 0.0]], ids=str)
def test_a_stiff_link_carries_an_eccentric_weight_at_rest(offset: list[float]) -> None:
    """On the body above nothing is left but its weight, whose moment about its center of mass is zero."""
    top = {"mass": 0.7, "height": 2.1, "size": [1.1, 0.9, 0.2], "period": [1.0, 0.8], "offset": [0.2, 0.07]}
    for more in ([], [top]):
        bodies = [body.model_dump(exclude_none=True) for body in load_scene("fig3-I").bodies]
        bodies[1]["offset"] = offset
        scene = load_scene("fig3-I").with_values({"bodies": [*bodies, *more], "isolator.supports": 3})
        _, moments, _ = forces_of_links(scene, *np.zeros((2, 12 + 6 * len(more))))
        below, *above = np.abs(moments[:, :2]).max(axis=1)
        assert max(above) < 1e-6 < below


def test_each_link_twists_as_its_own_bars() -> None:
    """On the ring of 1 m, or as far apart as stated, by shear and by the torsion of each over its length."""
    bars = {"count": 3, "bending_stiffness": 0.8, "length": 0.9, "spread": 0.6, "torsional_stiffness": 2.0}
    top = {"mass": 0.7, "height": 2.1, "size": [1.1, 0.9, 0.2], "bars": bars}
    bodies = [body.model_dump(exclude_none=True) for body in load_scene("fig3-I").bodies]
    scene, twisted = load_scene("fig3-I").with_values({"bodies": [*bodies, top]}), np.zeros(18)
    twisted[11] = twisted[17] = 1e-4
    for link, expected in ((0, scene.stiffness[0].mean()), (1, 0.36 * scene.stiffness[1].mean() + 3 * 2.0 / 0.9)):
        moved = np.where(np.arange(18) < 6 * (link + 1), 0.0, twisted)
        _, moments, model = forces_of_links(scene, moved, np.zeros(18))
        found = moments[link, 2] * model.units.force * model.units.length
        assert found == pytest.approx(1e-4 * expected, rel=1e-4)


def test_a_tower_tips_where_its_center_is_above_its_edge() -> None:
    """tan = b / h of a center of mass b inside the nearest edge and h above the plane of contact, rho + r = 1.2."""
    square = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])
    masses, centers = np.array([1.0, 3.0]), np.array([[0.1, 0.0, 1.0], [0.3, 0.0, 5.4]])
    assert _critical_tilt(square, 0.2, masses, centers) == pytest.approx(math.atan(0.75 / 3.1), rel=1e-14)


def three_bodies_on_bars() -> ImpactLaw:
    """In impacts: eccentric bodies at unequal distances, on links that are rigid in tension and bending."""
    centers = np.array([[0.1, -0.05, 0.3], [-0.2, 0.1, 1.2], [0.05, 0.15, 2.6]])
    depressions = Depressions(np.array([[1.0, 0.0], [-1.0, 1.0], [-1.0, -1.0]]), centers[0], 0.2, np.empty(0, np.int_))
    inertia = np.ones(3), np.ones((3, 3)), UPRIGHT, centers
    return ImpactLaw(depressions, *inertia, 0.0, DryFriction(0.1, 0.1, 0.0), 1e-3, np.ones(2, bool))


UPRIGHT = np.tile(np.eye(3), (3, 1, 1))


def test_of_unequal_supports_links_and_angles_the_right_one_counts() -> None:
    law = three_bodies_on_bars()
    assert law.depressions._farthest == pytest.approx(math.hypot(1.1, 1.05, 0.3)), "the second of three"
    bars: Any = SimpleNamespace(bars=BarLink(shear=3.0, bending=5.0, tension=70.0, torsion=2.0, pendulum=0.0, load=1.0))
    stiff, chain_of = cast("Any", SimpleNamespace(bars=None)), (law.masses, np.tile(np.eye(3), (3, 1, 1)), law.centers)
    alone = fastest_bar_frequency([bars], *(part[1:] for part in chain_of))
    assert fastest_bar_frequency([stiff, bars], *chain_of) == pytest.approx(alone)
    flat = BRIEF.with_values({"isolator.period": None, "isolator.radius": math.inf, "duration": 0.2})
    assert units_of(flat).time == pytest.approx(0.2 / (2.0 * math.pi)), "shorter than a period of the loading"
    motion: Any = SimpleNamespace(coordinates=np.array([[0.0, 0.0, 0.0, 0.5, 0.7, 0.2]]), gap=np.zeros((1, 0)))
    attitude = _measure_attitude(cast("Any", SimpleNamespace(bodies=np.arange(3)[None])), motion, np.zeros(1))
    assert np.cos(attitude["tilt"]) == pytest.approx(rotation_matrices(np.array([0.5, 0.7, 0.2]))[2, 2])


def test_a_chain_that_moves_as_one_stretches_and_bends_no_link() -> None:
    """Whatever its links are stretched and twisted by."""
    law, coordinates = three_bodies_on_bars(), np.random.default_rng(2).uniform(-0.2, 0.2, 18)
    places = law.centers + coordinates.reshape(3, 6)[:, :3]
    turned = rotation_matrices(coordinates.reshape(3, 6)[:, 3:])
    for axis in np.eye(3):
        turn = np.concatenate([[np.cross(axis, place), axis] for place in places]).ravel()
        for velocity in (turn, np.tile([*axis, 0.0, 0.0, 0.0], 3)):
            np.testing.assert_allclose(law._bar_rates(coordinates, turned) @ velocity, 0.0, atol=1e-12)


def test_behind_an_impact_stretched_bars_balance_their_dampers() -> None:
    """Stiffness times stretch and damping times its rate: the jump of one makes up for that of the other."""
    law, lags = three_bodies_on_bars(), np.array([0.03, 0.07])
    before, after = np.random.default_rng(3).normal(size=(2, 18))
    stretched = law.unload_bar_dampers(np.zeros(18), before, after, lags).reshape(3, 6)[:, :3]
    jump = (after - before).reshape(3, 2, 3)
    for link, lag_of_link in enumerate(lags):
        end = np.array([0.0, 0.0, law.centers[link : link + 2, 2].mean()])
        below, above = (jump[body, 0] + np.cross(jump[body, 1], end - law.centers[body]) for body in (link, link + 1))
        np.testing.assert_allclose(stretched[link + 1] - stretched[link], [0.0, 0.0, -lag_of_link * (above - below)[2]])


@pytest.mark.parametrize("body", [1, 2])
def test_a_body_that_turns_about_its_link_s_end_bends_it(body: int) -> None:
    """
    The end is below its center of mass, half way to the body below and on the links' axis. The link's own axis turns by
    half as much, which stretches it by what it is displaced across.
    """
    law, coordinates = three_bodies_on_bars(), np.random.default_rng(9).uniform(-0.3, 0.3, 18)
    places = law.centers + coordinates.reshape(3, 6)[:, :3]
    turned = rotation_matrices(coordinates.reshape(3, 6)[:, 3:])
    both = law._bar_rates(coordinates, turned).reshape(2, 3, 18)
    alone = replace(law, rigid=np.arange(2) == body - 1)._bar_rates(coordinates, turned)
    np.testing.assert_array_equal(alone, both[body - 1])  # of a rigid link beside one that gives way
    end = np.array([0.0, 0.0, law.centers[body - 1 : body + 1, 2].mean()])  # at rest
    below, above = (places[each] + turned[each] @ (end - law.centers[each]) for each in (body - 1, body))
    for axis in np.eye(3):
        velocity = np.zeros((3, 2, 3))
        for moving in range(body, 3):
            velocity[moving] = np.cross(axis, places[moving] - above), axis
        rates = (law._bar_rates(coordinates, turned) @ velocity.ravel()).reshape(2, 3)
        stretch = -0.5 * axis @ np.cross(above - below, turned[body - 1][:, 2])
        np.testing.assert_allclose(rates[body - 1], [stretch, *(axis @ turned[body - 1][:, :2])], atol=1e-12)
        np.testing.assert_allclose(rates[2 - body], 0.0, atol=1e-12)


def test_demands_are_those_of_the_motion_that_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    asked, trajectory = [], demand_surface.trajectory

    def noted(scene: Scene, phase: Any, *given: Any, **more: Any) -> Any:
        asked.append((*given, more))
        return trajectory(scene, phase, *given, **more)

    monkeypatch.setattr(demand_surface, "trajectory", noted)
    found = multibody.peak_demands(BRIEF.with_values({"duration": 0.2}), [PHASE], "spatial", 5e-3, 1e-2, 1e5)
    assert asked == [("spatial", 5e-3, 1e-2, {"max_work": 1e5})]
    assert found.status.tolist() == ["ok"]
