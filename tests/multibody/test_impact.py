"""Supports that lift off and close again: closed forms of impacts and flights, overturning, errors behind impacts."""

import math
from dataclasses import replace
from itertools import product
from types import SimpleNamespace
from typing import Any
from unittest.mock import Mock

import numpy as np
import pytest
from scenes_at_hand import assert_agree, one_body
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

import multibody
from multibody.integration.engine_run import Budget, EngineRun
from multibody.integration.estimate import widen_by_impacts
from multibody.integration.level import PHYSICAL_WARPING_COMPLIANCE
from multibody.integration.one_run import PhasePair
from multibody.integration.openings import BEARING_SETTLING_TIME, Event, Openings
from multibody.integration.peak import PeakReader
from multibody.integration.termination import _compute_tilt, _find_end_of_validity
from multibody.models.assembly import assemble
from multibody.models.depressions import Depressions, FlatUnderside, rotation_matrices
from multibody.models.impact import ImpactLaw
from multibody.models.state import EngineState
from multibody.motion import _measure_attitude
from reference.problem import GRAVITY, DryFriction, Outcome, Scene, load_scene

HALF_WIDTH, HEIGHT, RADIUS = 0.5, 3.0, 0.2  # of the square of supports, of the center of mass, of the spheres
CENTER, MOMENTS = np.array([0.0, 0.0, HEIGHT]), np.array([0.9, 0.9, 0.7])  # of mass, of inertia of a block
ARM = HEIGHT - (1.0 + RADIUS)  # of the center of mass above the points of contact
CORNERS = HALF_WIDTH * np.array([[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]])
LEFT, RIGHT = np.array([True, True, False, False]), np.array([False, False, True, True])
NONE, ALL = np.zeros(4, bool), np.ones(4, bool)


def block(restitution: float = 0.0, friction: float | DryFriction = 0.0, corner: float = 1e-9) -> ImpactLaw:
    """A block of mass one on the four corners of a square."""
    depressions = Depressions(CORNERS, CENTER, RADIUS, np.empty(0, np.int_))
    law = DryFriction(friction, friction, 0.0) if isinstance(friction, float) else friction
    inertia = np.ones(1), MOMENTS[None], np.eye(3)[None], CENTER[None]
    return ImpactLaw(depressions, *inertia, restitution, law, corner, np.ones(0, dtype=bool))


@pytest.mark.parametrize("grips", [True, False])
def test_a_rocking_block_slows_down_as_housner_says(grips: bool) -> None:
    """It turns about y by 0.3 about its left edge, on which it stands, and hits the right one; or it slides there."""
    before = 0.3 * np.array([ARM, 0.0, -HALF_WIDTH, 0.0, 1.0, 0.0])
    after, is_open = block(friction=1e3 * grips).solve_impact(np.zeros(6), before, LEFT, RIGHT)
    moment = MOMENTS[1] + HALF_WIDTH**2 + ARM**2 * grips  # about either edge
    assert after[4] / before[4] == pytest.approx((moment - 2.0 * HALF_WIDTH**2) / moment, rel=1e-8)
    np.testing.assert_array_equal(is_open, LEFT)
    # the block now turns about its right edge, or nothing acts along the plate
    along = after[4] * ARM if grips else before[0]
    np.testing.assert_allclose(after[[0, 2]], [along, after[4] * HALF_WIDTH], atol=1e-9)


def test_an_oblong_block_that_is_turned_is_hit_as_one_of_exchanged_moments() -> None:
    inertias, exchanged = np.array([[0.9, 0.4, 0.7]]), np.array([[0.4, 0.9, 0.7]])
    quarter = np.array([[[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]])
    before = np.array([0.1, 0.2, -0.5, 0.3, -0.4, 0.1])
    found = [
        replace(block(friction=0.3), inertias=moments, axes=axes).solve_impact(np.zeros(6), before, LEFT, RIGHT)[0]
        for moments, axes in ((inertias, quarter), (exchanged, np.eye(3)[None]), (inertias, np.eye(3)[None]))
    ]
    np.testing.assert_allclose(found[0], found[1], atol=1e-12)
    assert np.abs(found[2] - found[1]).max() > 0.01


def test_an_impact_turns_with_the_block_and_its_corners() -> None:
    """A block of three different moments of inertia is turned by a yaw between zero and a quarter of a turn."""
    turned = Rotation.from_euler("z", 0.6).as_matrix()
    before = np.array([0.1, 0.2, -0.5, 0.3, -0.4, 0.1])
    found = []
    for turn in (np.eye(3), turned):
        law = replace(block(friction=0.3), inertias=np.array([[0.9, 0.4, 0.7]]), axes=turn[None])
        law = replace(law, depressions=Depressions(CORNERS @ turn[:2, :2].T, CENTER, RADIUS, np.empty(0, np.int_)))
        after, _ = law.solve_impact(np.zeros(6), (before.reshape(2, 3) @ turn.T).ravel(), LEFT, RIGHT)
        found.append(after.reshape(2, 3) @ turn)
    np.testing.assert_allclose(found[1], found[0], atol=1e-9)


@pytest.mark.parametrize("underside", [Depressions, FlatUnderside])
def test_a_platform_that_moves_along_a_normal_opens_its_contact_by_as_much(underside: type[Depressions]) -> None:
    place = underside(CORNERS, np.array([0.1, -0.2, 0.3]), RADIUS, np.arange(6, 10))
    coordinates = np.array([0.1, -0.05, 0.02, 0.1, -0.2, 0.3, 0.01, 0.02, -0.01, 0.0])
    normals, _ = place.contact_normals_and_jacobian(coordinates)
    for number, normal in enumerate(normals):
        moved = coordinates + np.append(1e-6 * normal, np.zeros(7))
        opened = place.clearance(np.array([coordinates, moved]))[:, number]
        assert opened[1] - opened[0] == pytest.approx(1e-6, rel=1e-4)
    ways = coordinates + 1e-6 * np.stack([np.eye(10), -np.eye(10)])  # of the platform and of each sphere
    ahead, behind = (place.clearance(each) for each in ways)
    rates = replace(block(), depressions=place).gap_rates(coordinates)
    np.testing.assert_allclose(rates, (ahead - behind).T / 2e-6, atol=1e-6)


def test_spheres_that_are_hit_move_with_the_corners_of_the_block() -> None:
    """In the bottom of the depressions they meet the vertical velocity alone."""
    law = replace(block(), depressions=Depressions(CORNERS, CENTER, RADIUS, np.arange(6, 10)))
    before = np.array([0.1, 0.0, -0.7, 0.3, -0.2, 0.0, 0.01, 0.02, 0.03, 0.04])
    after = law.carry_spheres_along(np.zeros(10), before, RIGHT)
    of_corners = -0.7 + 0.3 * CORNERS[:, 1] + 0.2 * CORNERS[:, 0]
    np.testing.assert_allclose(after, [*before[:6], *np.where(RIGHT, of_corners, before[6:])], atol=1e-12)
    rocks = np.array([0.0, 0.0, 0.0, 0.0, 0.4, 0.0, *np.where(LEFT, 0.2, 0.0)])  # the left spheres rise with it
    turns_easily = replace(law, inertias=np.array([[0.1, 0.1, 0.1]]))  # an impact on the right pushes the left down
    hit, is_open = turns_easily.solve_impact(np.zeros(10), rocks, LEFT, RIGHT)
    np.testing.assert_allclose((law.gap_rates(np.zeros(10)) @ hit)[LEFT], 0.0, atol=1e-9)
    assert not is_open[LEFT].any()
    aside = np.array([0.1, -0.06, 0.05, 0.02, -0.03, 0.1, 0.05, 0.04, 0.06, 0.05])  # on a slope
    rates = law.gap_rates(aside) @ law.carry_spheres_along(aside, before, RIGHT)
    np.testing.assert_allclose(rates[RIGHT], 0.0, atol=1e-12)
    np.testing.assert_allclose(rates[LEFT], (law.gap_rates(aside) @ before)[LEFT], atol=1e-12)
    for of_spheres, met in ((0.05, 0.0), (-0.3, -0.3)):  # spheres that spring up do not push a block that falls on them
        fall = np.array([0.0, 0.0, -0.7, 0.0, 0.0, 0.0, *[of_spheres] * 4])
        rebound, _ = replace(law, restitution=0.4).solve_impact(np.zeros(10), fall, NONE, ALL)
        expected = [met + 0.4 * (met + 0.7), *[of_spheres] * 4]  # behind which the spheres stay
        np.testing.assert_allclose(rebound[[2, 6, 7, 8, 9]], expected, atol=1e-8)


@pytest.mark.parametrize("restitution", [0.0, 0.4, 1.0])
def test_a_level_block_rebounds_by_the_restitution(restitution: float) -> None:
    fall = np.array([0.0, 0.0, -0.7, 0.0, 0.0, 0.0])
    after, is_open = block(restitution, friction=0.3).solve_impact(np.zeros(6), fall, NONE, ALL)
    np.testing.assert_allclose(after, [0.0, 0.0, 0.7 * restitution, 0.0, 0.0, 0.0], atol=1e-8)
    assert is_open.all() == (restitution > 0.0)


def test_the_friction_of_an_impact_is_that_of_the_whole_speed() -> None:
    """Gripped by mu times its normal impulse of 0.7, over the height at which a block of this inertia is held."""
    law = block(0.0, DryFriction(0.02, 0.2, 1.0), 1e-3)
    along, across = (
        law.solve_impact(np.zeros(6), np.array([x, y, -0.7, 0.0, 0.0, 0.0]), NONE, ALL)[0]
        for x, y in ((0.4, 0.0), (0.0, 0.4))
    )
    assert along[0] == pytest.approx(across[1], rel=1e-6)
    assert along[0] == pytest.approx(0.4 - (0.2 - 0.18 * math.exp(-0.4)) * 0.7, rel=1e-6)
    crept, _ = block(0.0, 0.2, 0.5).solve_impact(np.zeros(6), np.array([0.4, 0.0, -0.7, 0.0, 0.0, 0.0]), NONE, ALL)
    assert crept[0] == pytest.approx(0.4 / (1.0 + 0.2 * 0.7 / 0.5), rel=1e-6), "below v_reg in proportion to the speed"


@pytest.mark.parametrize("seed", range(40))
def test_no_impact_adds_energy_or_breaks_the_laws_of_contact(seed: int) -> None:
    random = np.random.default_rng(seed)
    friction, corner = random.uniform(0.0, 0.3), 1e-3
    law = block(0.0, DryFriction(friction, 0.3 - friction, 1.0) if seed % 2 else friction, corner)
    coordinates = np.concatenate([random.uniform(-0.2, 0.2, 3), random.uniform(-0.05, 0.05, 3)])
    before = random.normal(size=6)
    hit = random.random(4) < 0.5
    closed = ~hit & (law.normal_speeds(coordinates, before)[0] > -1e-3) & (random.random(4) < 0.5)
    after, is_open = law.solve_impact(coordinates, before, closed, hit)
    speeds, _ = law.normal_speeds(coordinates, after)
    assert (speeds[closed | hit] > -1e-9).all()
    np.testing.assert_array_equal(is_open[closed | hit], speeds[closed | hit] > 1e-5)
    axes, turning = rotation_matrices(coordinates[3:]), law._velocity_matrix(coordinates)
    inertia = axes @ np.diag(MOMENTS) @ axes.T
    energies = [0.5 * v[:3] @ v[:3] + 0.5 * v[3:] @ inertia @ v[3:] for v in (turning @ before, turning @ after)]
    assert energies[1] <= energies[0] * (1.0 + 1e-9)


GAPS: dict[str, tuple[bool, Any, float | None]] = {  # of two contacts, in penetrations, behind a step of a length
    "opens": (False, lambda t: (t - 0.3, t - 0.2), 0.2),
    "is open already": (False, lambda t: (t, t - 0.2), None),
    "closes": (True, lambda t: (0.3 - t, 0.6 - t), 0.3),
    "closes behind a flight within the step": (True, lambda t: (t * (0.1 - t), 1.0), 0.1),
    "closes behind a flight half as long as its first trial": (True, lambda t: (t * (0.4 - t), 1.0), 0.4),
    "touches without a flight": (True, lambda t: (-t, 1.0), None),
    "rounds to a gap at the end of the step": (True, lambda t: (2.0 - t, 1.0 - t + 1e-9), 1.0),
}


@pytest.mark.parametrize(("closes", "gaps", "expected"), GAPS.values(), ids=GAPS)
def test_an_event_is_located_within_its_step(closes: bool, gaps: Any, expected: float | None) -> None:
    """Where the first of its contacts opens or closes, also behind a flight that is shorter than the step."""
    penetration, which = 1e-6, np.array([True, True, False])

    def run(state: Any, time: float, length: float, count: int) -> Any:
        assert (time, count) == (7.0, 1)
        return SimpleNamespace(coordinates=np.array([[0.0], [length]]), length=length)

    def clearance(coordinates: Any) -> Any:
        return penetration * (1.0 + np.array([[*gaps(float(t)), -5.0 if closes else 5.0] for [t] in coordinates]))

    model = SimpleNamespace(take_out_open_contacts=lambda is_open, penetration: None)
    law: Any = SimpleNamespace(depressions=SimpleNamespace(clearance=clearance, ring=np.zeros((3, 2))))
    solver: Any = SimpleNamespace(model=model, run=run)
    state: Any = SimpleNamespace(coordinates=np.zeros(1))
    motion: Any = Openings(solver, law, penetration).locate_event(state, 7.0, 1.0, Event(0, closes, which))
    assert (motion is None) == (expected is None)
    if motion is not None:
        assert motion.length == pytest.approx(expected, abs=1e-4)


THREE = [True, True, True, False]
HITS: dict[str, tuple[Any, ...]] = {  # contacts that close, gaps in penetrations, rates of the gaps; which are hit
    "within a penetration": ([1, 0, 0, 0], [1e-4, 0.5, 3.0, -1.0], [-1.0, -0.2, -0.2, 0.0], [1, 1, 0, 0]),
    "and not those that part": ([1, 0, 0, 0], [1e-4, 0.5, 1.5e-4, 0.0], [-1.0, 0.2, 0.1, -1.0], [1, 0, 0, 0]),
    "unless they overlap": ([1, 0, 0, 0], [1e-4, -0.1, 9.0, 0.0], [-1.0, 0.2, -0.1, 0.0], [1, 1, 0, 0]),
    "within a tenth of a microsecond": ([1, 0, 0, 0], [1e-4, 1.2, 1.3, 0.0], [-1.0, -50.0, -50.0, 0.0], [1, 1, 0, 0]),
    "the nearest if none has closed": ([1, 1, 0, 0], [0.9, 0.7, 0.2, 0.0], [0.1, 0.1, 0.1, 0.0], [0, 1, 0, 0]),
    "the fastest decides": ([1, 1, 0, 0], [1e-4, 1e-4, 9.0, 0.0], [-2e-5, -5e-7, 0.0, 0.0], [1, 1, 0, 0]),
    "slowly": ([1, 1, 0, 0], [1e-4, 0.5, 9.0, 0.0], [-9e-7, -5e-7, 0.0, 0.0], [1, 1, 0, 0]),
}


@pytest.mark.parametrize("penetration", [4e-6, 1e-8])
@pytest.mark.parametrize("name", HITS)
def test_contacts_that_close_at_once_share_an_impact(name: str, penetration: float) -> None:
    which, gaps, rates, hit = (np.array(part, kind) for part, kind in zip(HITS[name], (bool, float, float, bool)))
    if name == "within a tenth of a microsecond":
        rates *= penetration / 4e-6
    seen, opened = [], np.array([False, False, True, True])
    law: Any = SimpleNamespace(
        depressions=SimpleNamespace(clearance=lambda _: penetration * (1.0 + gaps[None]), ring=np.zeros((4, 2))),
        normal_speeds=lambda *_: (rates, rates),
        carry_spheres_along=lambda coordinates, velocities, struck: velocities + struck,
        unload_bar_dampers=lambda coordinates, before, after, times: coordinates + after - before + times,
        solve_impact=lambda at, moving, *contacts: (seen.append([*contacts]), (2.0 * moving, opened))[1],
    )
    model = SimpleNamespace(take_out_open_contacts=lambda *_: None, bar_damping_times=lambda _: 0.5)
    openings = Openings(SimpleNamespace(model=model), law, penetration)  # type: ignore[arg-type]
    openings.is_open = np.array(THREE)
    moving, rest = np.array([0.1, 0.2, 0.3, 0.4]), np.zeros(4)
    state = EngineState(rest, moving, np.arange(16.0), np.ones(4), np.ones(4))
    after = openings.apply_impact(state, 7.0, which)
    np.testing.assert_array_equal(after.contact[0::4], np.where(hit, -1e-4 * penetration, [0.0, 4.0, 8.0, 12.0]))
    quiet = -2.0 * rates[hit].min() <= 1e-3 * math.sqrt(penetration)
    assert openings.settled_at == (-math.inf if quiet else 7.0 + max(40.0 * math.sqrt(penetration), 0.04))
    jumps = rates[hit].min() < -1e-5
    assert (openings.impacts, after.slip_rate is None, after.load is None) == (int(jumps), jumps, jumps)
    np.testing.assert_array_equal(seen, [[~np.array(THREE), hit]] if jumps else [])
    np.testing.assert_allclose(after.velocities, 2.0 * moving if jumps else moving + hit)
    np.testing.assert_allclose(after.coordinates, moving + 0.5 if jumps else 0.0)
    np.testing.assert_array_equal(openings.is_open, opened if jumps else THREE & ~hit)


def test_the_first_contact_that_opens_or_comes_closer_overlapping_is_an_event() -> None:
    """Not one that is closed and comes closer, or open and parts."""
    law: Any = SimpleNamespace(depressions=SimpleNamespace(ring=np.zeros((2, 2)), clearance=lambda at: at + 1.0))
    solver: Any = SimpleNamespace(model=SimpleNamespace(take_out_open_contacts=lambda *_: None))
    openings = Openings(solver, law, 1.0)
    openings.is_open = np.array([True, False])
    for gaps, closed_gaps, expected in (
        ([1.0, 0.2, -0.3], [-1.0, -1.0, -2.0], (1, True, [True, False])),
        ([-0.5, -0.2, -0.1], [-1.0, -2.0, -3.0], None),
        ([-0.5, -0.2, 0.4], [-1.0, 1e-4, 3e-4], (1, False, [False, True])),
        ([1.0, -0.1, -0.5], [-1.0, 3e-4, 3e-4], (0, True, [True, False])),
    ):
        both: Any = np.column_stack([gaps, closed_gaps])
        event = openings.find_first_event(SimpleNamespace(coordinates=both, gap=both))  # type: ignore[arg-type]
        assert (None if event is None else (event.row, event.closes, event.contacts.tolist())) == expected


PACE = 2.0 * math.pi / 0.4  # of a plate that moves up and down


@pytest.mark.parametrize(("stated", "found"), [(None, 0.0), (0.0, 0.0), (0.4, 0.4)])
def test_supports_that_close_rebound_by_a_stated_restitution_alone(stated: float | None, found: float) -> None:
    scene = load_scene("fig3-I").with_values({"isolator.restitution": stated})
    assert assemble(scene, "spatial", 1e-3).impact.restitution == found


def bouncing(restitution: float, push: float = 15.0, duration: float = 0.45) -> Scene:
    """One body over its supports, thrown off by a plate that moves up and down only."""
    load = [[0.0, 0.0], [0.0, 0.0], [push, 0.0]]
    scene = one_body(friction=0.0, duration=duration, amplitudes=load, periods=[0.4, 0.4])
    on = {"supports": 3, "ring": 0.5, "sphere_radius": 0.05, "restitution": restitution}
    body = {"mass": 1.0, "height": 0.3, "size": [1.0, 1.0, 0.2]}
    return scene.with_values({"bodies": [body], "isolator": {"radius": 0.25, "friction": 0.0, **on}})


def rise(t: Any, begin: float, speed: float, push: float = 15.0, phase: float = 0.0) -> Any:
    """Height of a ball thrown at `begin` from a plate that moves by push cos(PACE t + phase), from it, and its rate."""
    aloft, turned, start = t - begin, PACE * t + phase, PACE * begin + phase
    plate = push / PACE**2 * (np.cos(turned) - math.cos(start) + math.sin(start) * PACE * aloft)
    rate = speed - GRAVITY * aloft - push / PACE * (np.sin(turned) - math.sin(start))
    return speed * aloft - 0.5 * GRAVITY * aloft**2 + plate, rate


def flights(restitution: float, end: float, push: float = 15.0, phase: float = 0.0) -> list[tuple[float, float]]:
    """Start and end of the flights of the ball that begin before `end`."""
    start, speed = (math.acos(-GRAVITY / push) - phase) / PACE, 0.0
    done: list[tuple[float, float]] = []
    while start < end and (speed > 0.0 or not done):
        flight, grid = (start, speed, push, phase), start + np.linspace(1e-3, 0.4, 400)
        first = int((rise(grid, *flight)[0] < 0.0).argmax())
        landing = float(brentq(lambda *given: rise(*given)[0], grid[first - 1], grid[first], flight, 1e-13))
        done.append((start, landing))
        start, speed = landing, -restitution * float(rise(landing, *flight)[1])
    return done


def test_flights_begin_and_end_when_free_fall_says() -> None:
    motion = multibody.trajectory(bouncing(0.5), (0.0, 0.0), model="spatial", tolerance=1e-2)
    expected = [flight for flight in flights(0.5, 0.45) if flight[1] < 0.45]
    assert len(expected) == 2
    for support in range(3):
        intervals = motion.extra["liftoff"][motion.extra["liftoff"][:, 0] == support][:2, 1:]
        # the contact follows the force within the square root of its penetration, some 1e-4 s
        np.testing.assert_allclose(intervals[0, 0], expected[0][0], atol=2e-4)
        np.testing.assert_allclose(intervals[:, 1], [end for _, end in expected], atol=3e-5)
    highest = rise(np.linspace(*expected[0], 10_001), expected[0][0], 0.0)[0].max()
    np.testing.assert_allclose(motion.extra["uplift"].max(axis=0), highest, rtol=1e-3)


@pytest.mark.parametrize("number", [0, 1])
def test_a_platform_tilted_by_its_contacts_lands_at_once(number: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Uneven loads press rigid spheres in by nothing: a platform that does not turn lands as often as a ball."""
    values = {"isolator.friction": 0.05, "excitation.amplitudes": [[3.0, 0.0], [0.0, 2.1], [15.0, 0.0]]}
    scene = bouncing(0.8, duration=0.6).with_values(values)
    landings = [end for _, end in flights(0.8, 0.6) if end < 0.6]
    read, read_until = [], PeakReader.read_until
    monkeypatch.setattr(
        PeakReader, "read_until", lambda peaks, instant: (read.append(instant), read_until(peaks, instant))[1]
    )
    assert one_level(scene, (0.0, 0.0), number, 6e4).impacts == len(landings) == 2
    early = np.abs(np.subtract.outer(landings, np.array(read) * math.sqrt(scene.radius / GRAVITY)))
    assert early.min(axis=1).max() < 5e-3, "peaks are read up to every landing"


def test_the_largest_value_behind_an_impact_converges() -> None:
    """A body lands on a plate whose acceleration falls: nothing counted before or later is as large."""
    push, phase = 20.0, 0.5 * math.pi
    scene = bouncing(0.0, push, 0.5)
    [(_, landing)] = flights(0.0, 0.5, push, phase)
    counted = landing + BEARING_SETTLING_TIME * math.sqrt(scene.radius / GRAVITY)
    model = assemble(scene, "spatial", 1e-3)
    pair = PhasePair(scene, model, np.array([phase, 0.0]), in_full=True)
    runs = [pair.run_level(level, Budget(1e6)) for level in multibody.levels(scene, "spatial")[:3]]
    peaks = np.array([run.peaks.value[0] for run in runs]) * model.units.acceleration
    errors = np.abs(peaks / (push * math.cos(PACE * counted + phase)) - 1.0)
    assert errors[0] < 1e-3
    assert (errors[1:] < errors[:-1] / 3.5).all(), errors


def tower(ring: float) -> Scene:
    isolator = {"isolator.friction": 0.05, "isolator.supports": 3, "isolator.ring": ring}
    load = {"excitation.amplitudes": [[4.0, 0.0], [0.0, 4.0]], "excitation.decay": [0.33, 0.27]}
    return load_scene("fig3-I").with_values({"duration": 3.0, **isolator, **load})


def one_level(scene: Scene, phase: tuple[float, float], number: int, work: float) -> EngineRun:
    """The run of one level on springs of real bearings."""
    level = replace(multibody.levels(scene, "spatial")[number], warping_compliance=PHYSICAL_WARPING_COMPLIANCE)
    pair = PhasePair(scene, assemble(scene, "spatial", 1e-3), np.array(phase), in_full=True)
    return pair.run_level(level, Budget(work))


def test_a_contact_that_opens_again_does_not_end_the_run() -> None:
    values = {"duration": 0.56, "isolator.friction": 0.1, "isolator.supports": 4, "excitation.decay": [0.333, 0.273]}
    scene = tower(1.0).with_values({**values, "excitation.amplitudes": [[2.0, 0.0], [0.0, 2.0], [15.0, 0.0]]})
    run = one_level(scene, (2.0, 0.7), 4, 6e4)
    assert run.impacts > 10
    assert run.has_opened
    assert run.outcome == Outcome.OK, "the engine shortened its step without end"


def test_tilt_and_liftoff_are_those_of_the_platform() -> None:
    """Of two bodies; the second of two supports opens, which lasts from the last instant of contact to the next."""
    model: Any = SimpleNamespace(bodies=np.array([[0, 1, 2], [6, 7, 8]]))
    angles = np.array([[0.3, -0.4, 0.9], [0.1, 0.2, 0.5]])
    coordinates = np.hstack([np.zeros((2, 3)), angles]).ravel()
    gap = np.array([[-1.0] * 5, [-1.0, -1.0, 1.0, 1.0, -1.0]]).T
    motion: Any = SimpleNamespace(coordinates=np.tile(coordinates, (5, 1)), gap=gap)
    found = _measure_attitude(model, motion, 0.1 * np.arange(5))
    np.testing.assert_allclose(found["tilt"], np.arccos(rotation_matrices(angles[0])[2, 2]))
    np.testing.assert_allclose(_compute_tilt(motion, model), found["tilt"])
    np.testing.assert_array_equal(found["yaw"], [0.9] * 5)
    np.testing.assert_array_equal(found["turns"][3], angles)
    np.testing.assert_allclose(found["liftoff"], [[1.0, 0.1, 0.4]])
    motion.time = np.arange(5)
    steep = SimpleNamespace(
        coordinates=np.where(np.arange(12) == 3, 0.5 * np.arange(5)[:, None], 0.0), time=motion.time
    )
    model.depressions, model.critical_tilt = Mock(**{"is_near_rest.return_value": False}), 1.9
    model.depressions.rows_beyond_rim.return_value = np.zeros(5, bool)  # as of a plane
    assert _find_end_of_validity(steep, model) == (Outcome.OVERTURNED, 4), "beyond 90 degrees"
    model.critical_tilt, model.depressions.rows_beyond_rim.return_value = 0.6, np.arange(5) >= 1
    assert _find_end_of_validity(steep, model) == (Outcome.RIM_REACHED, 1), "tilted by 0.5 rad there, and more later"
    for beyond, near, limit, expected in (
        (3, False, 0.4, (Outcome.OVERTURNED, 3)), (3, False, 0.6, (Outcome.RIM_REACHED, 3)),
        (5, False, 0.4, (Outcome.OK, 4)), (3, True, 0.4, (Outcome.OK, 4)),
    ):  # fmt: skip
        model.depressions = Mock(**{"is_near_rest.return_value": near})
        model.depressions.rows_beyond_rim.return_value = np.arange(5) >= beyond
        model.critical_tilt = limit
        assert _find_end_of_validity(motion, model) == expected, "tilted by 0.49 rad"


def test_a_tower_that_overturns_ends_under_that_name() -> None:
    results = [
        multibody.amplification(tower(0.1), [(0.3, 1.1)], "spatial", tolerance=tolerance, full=True)
        for tolerance in (1e-2, 1e-3)
    ]
    assert [result.status.tolist() for result in results] == [[Outcome.OVERTURNED]] * 2
    assert np.isnan(results[0].mu).all()
    assert results[0].instant[0] == pytest.approx(results[1].instant[0], rel=5e-3)
    assert 1.0 < results[0].instant[0] < 3.0


def test_supports_that_open_leave_answers_that_agree() -> None:
    """The plate falls as fast as the bodies at a turning point of its acceleration, and nothing chatters."""
    load = {"excitation.amplitudes": [[2.0, 0.0], [0.0, 2.0], [GRAVITY, 0.0]], "excitation.decay": [0.0, 0.0]}
    scene = load_scene("fig3-I").with_values({"duration": 1.0, **load})
    loose, strict = (
        multibody.amplification(scene, [(0.0, 1.1)], "spatial", tolerance=tolerance, max_work=5e4)
        for tolerance in (1e-2, 1e-3)
    )
    assert_agree(loose, strict)


def test_levels_that_impacts_scatter_have_their_spread() -> None:
    run = EngineRun(PeakReader(3, math.inf), math.inf, impacts=50)
    peaks = [PeakReader(3, math.inf), PeakReader(3, math.inf), run.peaks]
    # to and fro, ever on by hardly less, and by a third of the change before
    for each, values in zip(peaks, ([3.4600, 2.5135, 1.0090], [3.4624, 2.5115, 1.0000], [3.4582, 2.5102, 0.9970])):
        each.value[:] = values
    errors = widen_by_impacts(np.zeros(3), peaks, run, 2)
    np.testing.assert_allclose(errors, [0.0042, 0.0033, 1e-3 * 0.997], rtol=1e-9)
    run.impacts = 0
    assert not widen_by_impacts(np.zeros(3), peaks, run, 2).any()


@pytest.mark.parametrize(("height", "width"), [(0.0, 1.0), (5.0, 1.0), (0.2, 10.0)])
def test_a_platform_near_its_rest_has_all_spheres_in(height: float, width: float) -> None:
    """Bounds on its place and angles prove it, and only where that is so."""
    draw, proved = np.random.default_rng(3), 0
    ring = 0.4 * width * np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
    place = Depressions(ring, np.array([0.3 * width, -0.2 * width, height]), 0.1, np.arange(6, 10))
    levers = [*ring.T, np.zeros(4)] - place.center[:, None]
    assert place._farthest == pytest.approx(np.linalg.norm(levers, axis=0).max())
    for size in np.geomspace(1e-3, 3.0, 400):
        moved = draw.random(10) < 0.5  # some of them alone come further before a sphere leaves
        coordinates = size * moved * draw.uniform(-1.0, 1.0, (20, 10))
        if place.is_near_rest(coordinates):
            proved += 1
            assert not place.rows_beyond_rim(coordinates).any()
            assert (rotation_matrices(coordinates[:, 3:6])[:, 2, 2] > 0.0).all()
    assert 100 < proved < 400
    for across, (upright, way) in product((0, 1), ((2, 1.1), (6, -1.1), (9, -1.1))):  # a lift, or a sphere that sinks
        out = np.zeros((1, 10))
        out[0, [across, upright]] = 1.1, way
        assert (place.rows_beyond_rim(out).any(), place.is_near_rest(out)) == (True, False)
