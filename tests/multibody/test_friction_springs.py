"""Friction that yields in the engine: a closed form, the equations of the same law, and supports that stand apart."""

import math
from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scenes_at_hand import one_body
from scipy.spatial.transform import Rotation

import multibody
import reference
from multibody.integration.adaptive import Checkpoint, _AdaptiveRun
from multibody.integration.constant_step import silence_engine
from multibody.integration.engine_run import Budget, EngineRun
from multibody.integration.one_run import PhasePair
from multibody.integration.peak import PeakReader
from multibody.integration.time_scales import shortest_period
from multibody.models.assembly import assemble
from multibody.models.friction_springs import ContactChange, _find_slide_end, _find_slide_start
from multibody.models.state import EngineState
from reference.problem import GRAVITY, Outcome, Scene, State, load_scene

LOADS = {"excitation.amplitudes": [[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]}
PHASE = (0.3, 1.1)


def _yielding(name: str, friction: dict[str, float], **values: Any) -> Scene:
    return load_scene(name).with_values({"isolator.friction": friction, "duration": 4.0, **values})


def test_a_platform_vibrates_on_its_springs_below_yield_without_loss() -> None:
    """About the place where spring and pendulum balance, at the frequency of both, for fifteen periods."""
    scene = one_body(1.0, duration=3.0).with_values({"isolator.friction": {"slow": 0.1, "yield_displacement": 1e-3}})
    start, pendulum, spring = 0.01, GRAVITY, 0.1 * GRAVITY / 1e-3
    middle = start * spring / (spring + pendulum)
    model = assemble(scene, "translational", 1e-3)
    period = 2.0 * np.pi / np.sqrt(spring + pendulum)
    assert shortest_period(scene, model) * model.units.time == pytest.approx(period)
    motion = multibody.trajectory(scene, (0.0, 0.0), initial=State(np.array([[start, 0.0]]), np.zeros((1, 2))))
    expected = middle + (start - middle) * np.cos(np.sqrt(spring + pendulum) * motion.time)
    np.testing.assert_allclose(motion.position[:, 0, 0], expected, atol=4e-3 * (start - middle))
    assert motion.time[-1] * np.sqrt(spring + pendulum) > 30.0 * np.pi


def test_a_slow_cycle_loses_four_times_friction_and_way_beyond_yield() -> None:
    """At one level; what the pendulum and the swing on the springs keep at its ends is 0.3 % of it."""
    friction, yields, period = 0.1, 2e-3, 20.0
    shaking = {"amplitudes": [[0.12 * GRAVITY, 0.0], [0.0, 0.0]], "periods": [period] * 2, "decay": [1e-9] * 2}
    scene = one_body(2.0, duration=1.5 * period, **shaking).with_yield_displacement(yields)
    motion = multibody.single_run(scene, (-0.5 * np.pi, 0.0), level=multibody.levels(scene)[1])
    cycle = motion.time >= 0.5 * period
    place, weight = motion.position[cycle, 0, 0], scene.total_mass * GRAVITY
    force = -scene.total_mass * motion.absolute_acceleration[cycle, 0, 0]
    height = 2.0 - np.sqrt(4.0 - place**2)
    lost = np.trapezoid(force * motion.velocity[cycle, 0, 0], motion.time[cycle]) - weight * (height[-1] - height[0])
    amplitude = 0.5 * np.ptp(place)
    assert lost == pytest.approx(4.0 * friction * weight * (amplitude - yields), rel=5e-3)
    assert yields > 0.03 * amplitude


def test_two_levels_that_agree_show_no_error(monkeypatch: pytest.MonkeyPatch) -> None:
    made, run = [], PhasePair.run_level
    monkeypatch.setattr(PhasePair, "run_level", lambda pair, level, *rest, **more: (
        made.append(level), run(pair, level, *rest, **more))[1])  # fmt: skip
    for friction in ({"slow": 0.1, "yield_displacement": 1e-3}, 0.1):
        made.clear()
        scene = load_scene("fig3-I").with_values({"isolator.friction": friction, "duration": 1.0})
        assert multibody.amplification(scene, [PHASE], tolerance=0.1).status.tolist() == ["ok"]
        assert len({level.step for level in made}) == (2 if friction == 0.1 else 3)


@pytest.mark.parametrize(
    ("name", "friction", "values"),
    [
        ("fig3-I", {"slow": 0.1, "yield_displacement": 1e-3}, {}),
        ("fig3-II", {"slow": 0.1, "yield_displacement": 1e-4}, {}),
        ("fig3-II", {"slow": 0.05, "fast": 0.1, "rate": 20.0, "initial_stiffness": 1000.0}, {}),
        ("fig3-II", {"slow": 0.1, "load_exponent": -0.2, "yield_displacement": 1e-3}, LOADS),
        ("fig3-II", {"slow": 0.1, "yield_displacement": 1e-3}, {"isolator.radius": np.inf, "isolator.period": None}),
    ],
    ids=["1 mm", "0.1 mm", "of speed", "of load", "on a plane"],
)
def test_engine_and_equations_agree_within_their_errors(
    name: str, friction: dict[str, float], values: dict[str, Any]
) -> None:
    scene = _yielding(name, friction, **values)
    ours, theirs = multibody.amplification(scene, [PHASE]), reference.amplification(scene, [PHASE])
    assert ours.status.tolist() == ["ok"]
    assert (np.abs(ours.mu - theirs.mu) <= ours.error + theirs.error).all()
    np.testing.assert_allclose(ours.mu, theirs.mu, rtol=5e-4)
    np.testing.assert_allclose(ours.displacement, theirs.displacement, rtol=1e-3)


def test_supports_that_stand_apart_share_the_stiffness() -> None:
    """Overturning presses supports by next to nothing there, so that bodies that turn move as in translation."""
    friction = {"slow": 0.1, "yield_displacement": 1e-3}
    wide = {"isolator.ring": 100.0, "duration": 0.3}
    scene = _yielding("fig3-I", friction, **wide)
    turning = multibody.amplification(scene, [PHASE], model="spatial", full=True)
    straight = multibody.amplification(scene, [PHASE])
    np.testing.assert_allclose(turning.mu, straight.mu, rtol=2e-3)


@pytest.mark.parametrize(
    ("friction", "values"),
    [
        ({"slow": 0.1, "load_exponent": -0.2, "yield_displacement": 1e-3}, LOADS),
        ({"slow": 0.05, "fast": 0.1, "rate": 20.0, "initial_stiffness": 1000.0}, {}),
    ],
    ids=["of load", "of speed"],
)
def test_a_slide_begins_at_the_limit_of_its_instant(friction: dict[str, float], values: dict[str, Any]) -> None:
    """Load and speed change it within the step before by a ten-thousandth."""
    scene = _yielding("fig3-II", friction, **values, duration=1.0)
    model, level = assemble(scene, "translational", 1e-3, contact_force=True), multibody.levels(scene)[0]
    with silence_engine():
        chunks = PhasePair(scene, model, np.array(PHASE)).run_level(level, Budget(1e6), keep=True).chunks
    begun = [pair for pair in pairwise(chunks) if pair[0].slip[0, 0] == 0.0 < pair[1].slip[0, 0]]
    assert begun
    for before, after in begun:
        assert len(after.time) <= 5, "another contact may slide soon"
        for chunk, row, error in ((before, -1, 1e-4), (after, 0, 1e-6)):  # where the step ends, and made exact
            turn = chunk.coordinates[row, model.springs.turns[0]]
            elongation = model.springs.depressions.radius * np.linalg.norm(turn)
            assert elongation == pytest.approx(model.springs.limits(chunk)[row, 0], rel=error)


@pytest.mark.parametrize("supports", [3, 5])
def test_spheres_restart_with_the_speed_of_rest_or_slip(supports: int) -> None:
    """Their surface moves with the depression but for the slip along the spring, faster than its limit grows."""
    on = {"isolator.supports": supports, "isolator.sphere_radius": 0.13}
    scene = _yielding("fig3-I", {"slow": 0.1, "yield_displacement": 1e-3}, **on)
    model, draw, end = assemble(scene, "spatial", 1e-3), np.random.default_rng(6), 0.02
    springs, place = model.springs, model.springs.depressions
    coordinates, velocities, accelerations = draw.uniform(-0.1, 0.1, (3, model.coordinates))
    grows, sliding = draw.uniform(-0.1, 0.1, supports), np.arange(supports) != 1
    state = EngineState(coordinates, velocities, np.zeros(4 * supports), sliding=tuple(sliding.tolist()))
    after = springs.restart_state(state, state, accelerations, grows, end)
    apart, _ = place.sphere_positions(coordinates[None])
    for number, normal in enumerate(apart[0] / np.linalg.norm(apart[0], axis=1)[:, None]):
        free = place.vertical[number : number + 1]  # of the sphere, if it can move
        center = np.array([*place.ring[number], 1.0 + coordinates[free].sum()])
        turn, across = springs.turns[number], np.eye(3) - np.outer(normal, normal)
        along = np.cross(coordinates[turn], normal) / np.linalg.norm(np.cross(coordinates[turn], normal))
        slips, relative = [], []
        for rates, own in ((velocities, after.velocities), (accelerations, after.accelerations)):
            ahead, behind = (Rotation.from_euler("XYZ", coordinates[3:6] + s * rates[3:6]) for s in (1e-6, -1e-6))
            spin, arm = (ahead * behind.inv()).as_rotvec() / 2e-6, center + place.radius * normal - place.center
            relative.append(rates[:3] + np.cross(spin, arm - coordinates[:3]) - [0.0, 0.0, rates[free].sum()])
            slips.append(across @ (relative[-1] - np.cross(own[turn], place.radius * normal)))
        speed = relative[0] @ along - grows[number]
        slides = bool(sliding[number] and speed > end)
        np.testing.assert_allclose(slips[0], speed * along if slides else 0.0, atol=1e-8)
        np.testing.assert_allclose(slips[1], across @ relative[1] if slides else 0.0, atol=1e-8)
        expected = (slides, pytest.approx(speed if slides else 0.0))
        assert (after.sliding[number], after.contact[4 * number + 1]) == expected
    assert 0 < sum(after.sliding) < supports
    limits = np.array([0.02, 0.2, 0.3, 0.02, 0.01])[:supports]
    resting = replace(state, sliding=(True, *[False] * (supports - 1)))
    change = ContactChange(0, 1, 0.0, slides=True, limits=limits)
    begun = springs.restart_state(resting, resting, accelerations, grows, end, change)
    before, behind = (
        place.radius * np.linalg.norm(each.coordinates[springs.turns], axis=1) for each in (resting, begun)
    )
    # springs at rest are shortened to their limits; the one that begins to slide has it
    np.testing.assert_allclose(behind, [before[0], 0.2, *np.minimum(before, limits)[2:]])
    assert begun.sliding[1]


@pytest.mark.parametrize(
    ("find", "values", "expected"),
    [
        (_find_slide_start, [-2.0, 2.0, 3.0], (0, 0.5)),
        (_find_slide_start, [3.0, 2.0, 2.5], (1, 0.0)),  # where it grows again
        (_find_slide_start, [3.0, 2.0, 1.5], None),
        (_find_slide_start, [0.5, 0.9, 0.95], None),
        (_find_slide_end, [9.0, 4.0, 3.0], (1, 0.8)),  # where the next step would end it
        (_find_slide_end, [1.2, 0.9, 0.5], (1, 1.0)),  # below the speed of slides that end
        (_find_slide_end, [9.0, 5.0, 4.0], None),
        (_find_slide_end, [0.5, 0.6, 0.9], None),
    ],
)
def test_a_slide_begins_beyond_its_limit_and_ends_with_its_speed(find: Any, values: Any, expected: Any) -> None:
    found = find(2, np.array(values))
    assert (found and (found.row, found.step_share)) == expected
    assert found is None or (found.contact, found.slides) == (2, find is _find_slide_start)


def test_of_three_supports_the_first_that_slides_or_stops_counts() -> None:
    """Beyond its limit by 1e-4 of yield, less as the square of the speed that ends slides; unless it only creeps."""
    scene = _yielding("fig3-I", {"slow": 0.1, "yield_displacement": 1e-3}, **{"isolator.supports": 3})
    model, time = assemble(scene, "spatial", 1e-3), np.array([0.0, 0.1, 0.4, 0.5])
    springs = model.springs
    assert springs.slide_end * model.units.velocity == pytest.approx(0.1 * math.sqrt(0.1 * GRAVITY * 1e-3))
    end, left, load = 0.5 * springs.slide_end, 0.25e-4 * springs.displacement, 1.0 + 0.1 * np.arange(12.0).reshape(4, 3)
    limit, state = springs.displacement * load, EngineState(*np.zeros((3, 30)), sliding=(False, True, False))
    early, late, falls, steady = [-3.0, -1.0, 2.0, 3.0], [-2.0, -2.0, -1.0, 3.0], [9.0, 4.0, 3.0, 3.0], [9.0] * 4
    slide, rate = ContactChange(1, 2, 1.0 / 3.0, True, limit[1]), 3.0 * left / 0.3
    for excess, slip, begin, expected in (
        ([late, early], steady, 0.9 * rate, slide),
        ([late, early], falls, 0.9 * rate, ContactChange(1, 1, 0.8, False)),
        ([early, late], falls, 0.9 * rate, slide._replace(contact=0)),
        ([[-2.0] * 4, early], steady, 1.1 * rate, ContactChange(2, 2, 0.0, False, limit[2])),
        ([[-2.0] * 4] * 2, steady, 0.0, None),
    ):
        coordinates = np.zeros((4, 30))
        stretched = limit + left * np.column_stack([excess[0], [9.0] * 4, excess[1]])
        coordinates[:, springs.turns[:, 1]] = -stretched / springs.depressions.radius
        slips = end * np.column_stack([np.zeros(4), slip, np.zeros(4)])
        motion = SimpleNamespace(time=time, coordinates=coordinates, velocities=coordinates, slip=slips, load=load)
        found = springs.find_sliding_change(motion, state, end, begin)
        assert (found is None) == (expected is None)
        if expected is not None:
            assert found[:4] == (*expected[:2], pytest.approx(expected.step_share), expected.slides)
            np.testing.assert_equal(found.limits, expected.limits)
    springs.begin(state)
    springs.set_slide_end(end)
    laws = [
        [springs.mbs.GetObjectParameter(contact, name) for contact in springs.contacts]
        for name in ("dynamicFriction", "frictionProportionalZone")
    ]
    np.testing.assert_allclose(laws, [[1e5, 0.1, 1e5], [0.25 * end] * 3])
    fast = replace(state, velocities=np.ones(30), coordinates=0.01 * np.ones(30), accelerations=np.zeros(30))
    assert springs.state_at_rest(fast).sliding == (False, False, False)


def test_steps_follow_the_spring_that_turns_most_and_the_slowest_slide() -> None:
    """By the change of elongation over that of yield, and 0.3 of a change of velocity over the slip, or its end."""
    scene = _yielding("fig3-I", {"slow": 0.1, "yield_displacement": 1e-3}, **{"isolator.supports": 3})
    springs, draw = assemble(scene, "spatial", 1e-3).springs, np.random.default_rng(2)
    turned, moved, slip = 1e-3 * draw.normal(size=(5, 30)), draw.normal(size=(5, 30)), draw.uniform(0.0, 2.0, (5, 3))
    motion = SimpleNamespace(coordinates=turned, velocities=moved, slip=slip, time=np.arange(5.0))
    turns = np.linalg.norm(np.diff(turned[:, 12:].reshape(5, 3, 6)[..., 3:], axis=0), axis=2).max(axis=1)
    by_springs = springs.depressions.radius / springs.displacement * turns
    slowest = np.maximum(slip[1:, [0, 2]].min(axis=1), 0.7)
    by_slides = 0.3 * np.linalg.norm(np.diff(moved[:, :3], axis=0), axis=1) / slowest
    for sliding, expected in (((), by_springs), ((True, False, True), np.maximum(by_springs, by_slides))):
        state = EngineState(turned[0], moved[0], np.zeros(12), sliding=sliding)
        np.testing.assert_allclose(springs.step_ratio(motion, state, 0.7), [0.0, *expected])


def test_a_step_that_fails_is_divided_until_its_slides_end() -> None:
    """From the third division on contacts go to rest, and the first division follows; without a slide it goes on."""
    at_rest = SimpleNamespace(sliding=(False, False))
    springs = SimpleNamespace(state_at_rest=lambda _: at_rest, find_sliding_change=lambda *given: given[2:])
    for divisions, sliding, goes_on, then, rested in (
        (2, (False, True), True, 3, -1.0),
        (3, (False, True), True, 1, 0.7),
        (7, (True, False), True, 1, 0.7),
        (3, (False, False), True, 4, -1.0),
        (7, (), False, 7, -1.0),
    ):
        state: Any = SimpleNamespace(sliding=sliding)
        at, run = Checkpoint(state, 0.7, divisions), EngineRun(PeakReader(1, 1.0), 1.0)
        model, level = SimpleNamespace(springs=springs), SimpleNamespace(max_divisions=7, slide_end=0.2)
        under_way: Any = SimpleNamespace(run=run, at=at, model=model, level=level)
        assert _AdaptiveRun._divide_after_failure(under_way) == goes_on
        assert (at.divisions, at.rested_at, at.time) == (then, rested, 0.7)
        assert any(at.state.sliding) == (any(sliding) and rested < 0.0)
        assert run.outcome == (Outcome.OK if goes_on else Outcome.SOLVER_FAILED)
        np.testing.assert_equal(run.instant, math.nan if goes_on else 0.7)
        begins: Any = _AdaptiveRun._find_sliding_change(under_way, None)  # type: ignore[arg-type]
        assert begins == (0.2, 0.2 if rested < 0.0 else math.inf), "no slide begins where a slide has just failed"
