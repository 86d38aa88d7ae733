"""Friction that yields elastically before it slides, by the equations: another program, closed forms, limits."""

import itertools
import json
import math
from typing import Any

import numpy as np
import pytest
from chains import chain
from yielding_values import LAYOUT, VALUES, case, values_of

import reference
from reference.problem import GRAVITY, Scene, State, load_scene

FOUND: dict[str, Any] = json.loads(VALUES.read_text())
TOLERANCE = 1e-7
# share of a value by which the other program is off: its events have the width of its difference quotients, at which
# a coefficient of the speed has a kink
OTHER_ERROR = {"planar, rising": 3e-6, "rising": 3e-7}
FIG3, VERTICAL = load_scene("fig3-I"), [[1.0, 0.4], [-0.3, 1.2], [1.3, 0.9]]
PHASES = [(0.3, 1.1), (2.0, 0.7), (4.0, 5.5), (1.0, 3.0)]
MASS, RADIUS, FRICTION, WAY = 2.0, 0.5, 0.05, 2e-3
LIMIT, PENDULUM = FRICTION * MASS * GRAVITY, MASS * GRAVITY / RADIUS
STIFFNESS = LIMIT / WAY
ALONE = chain(RADIUS, FRICTION, [MASS], amplitudes=[[1e-12, 0.0], [0.0, 0.0]], duration=12.0).with_values(
    {"isolator.friction": {"slow": FRICTION, "yield_displacement": WAY}}
)


def yielding(scene: Scene, way: float, **table: float) -> Scene:
    return scene.with_values({"isolator.friction": {"slow": 0.1, "yield_displacement": way, **table}})


def thrown(speed: float, times: np.ndarray | None = None) -> reference.Trajectory:
    start = State(position=np.zeros((1, 2)), velocity=np.array([[speed, 0.0]]))
    return reference.trajectory(ALONE, (0.0, 0.0), "small", tolerance=1e-9, times=times, initial=start)


@pytest.mark.parametrize("name", LAYOUT)
def test_factors_are_those_of_the_other_program(name):
    scene, phase, equations = case(name)
    found, other = reference.amplification(scene, [phase], equations, tolerance=TOLERANCE), FOUND[name]
    assert found.status.tolist() == ["ok"]
    assert (found.reading, found.law.startswith(f"{scene.dry_friction.kind} friction that yields")) == ("", True)
    off = OTHER_ERROR.get(name, 3e-8)
    assert (np.abs(found.mu[0] - other["mu"]) <= found.error[0] + off * np.array(other["mu"])).all()
    assert found.displacement[0] == pytest.approx(other["displacement"], rel=1e-6)


@pytest.mark.parametrize("name", LAYOUT)
def test_energy_is_balanced_and_dissipated_as_by_the_other_program(name):
    scene, phase, equations = case(name)
    demands = reference.demands(reference.trajectory(scene, phase, equations, tolerance=TOLERANCE))
    damping = demands.damping_energy or reference.Estimate(0.0, 0.0)
    lost = demands.friction_energy.value + damping.value
    allowed = demands.friction_energy.error + damping.error
    assert allowed < 1e-2 * lost
    if equations == "exact":  # (4.3) as printed keeps terms that do work
        assert abs(lost - FOUND[name]["dissipated"]) <= allowed + 1e-6 * lost
        assert abs(demands.energy_balance.value) <= demands.energy_balance.error
        assert abs(FOUND[name]["imbalance"]) < 1e-9 * lost


def test_the_stored_values_are_what_the_other_program_says():
    scene, phase, _ = case("vertical shaking")
    other, found = (
        values_of("vertical shaking", 0.8),
        reference.amplification(scene.with_values({"duration": 0.8}), [phase], tolerance=TOLERANCE),
    )
    np.testing.assert_allclose(found.mu[0], other["mu"], rtol=1e-7)


def test_below_yield_the_platform_swings_on_both_stiffnesses_without_loss():
    rate = math.sqrt((STIFFNESS + PENDULUM) / MASS)
    times = np.linspace(0.0, 12.0, 400)  # 30 periods
    motion = thrown(0.9 * WAY * rate, times)
    np.testing.assert_allclose(motion.position[:, 0, 0], 0.9 * WAY * np.sin(rate * times), atol=1e-8 * WAY)
    late = np.linspace(0.5 * math.pi / rate, 12.0, 40_001)  # from the first turning point on
    lost = reference.demands(thrown(0.9 * WAY * rate, late)).friction_energy
    assert abs(lost.value) <= lost.error < 1e-2 * LIMIT * WAY


def turning_points(speed: float, count: int) -> list[float]:
    """Turning points of a bilinear oscillator that starts at zero with this speed, by conservation of energy alone."""
    # elastic from x0 with force f0 to the bound: m v^2 / 2 changes by the work of both springs; then sliding to v = 0
    points, x, force, sign, kinetic = [], 0.0, 0.0, 1.0, 0.5 * MASS * speed**2
    for _ in range(count):
        way = (sign * LIMIT - force) / STIFFNESS
        kinetic -= 0.5 * (force + sign * LIMIT) * way + 0.5 * PENDULUM * ((x + way) ** 2 - x**2)
        x += way
        if kinetic < 0.0:  # the bound is not reached again: elastic from here on
            return points
        # kinetic = sign F (y - x) + c (y^2 - x^2) / 2 for the turning point y
        constant = kinetic + sign * LIMIT * x + 0.5 * PENDULUM * x**2
        y = (-sign * LIMIT + sign * math.sqrt(LIMIT**2 + 2.0 * PENDULUM * constant)) / PENDULUM
        points.append(y)
        x, force, sign, kinetic = y, sign * LIMIT, -sign, 0.0
    return points


def test_free_decay_has_the_turning_points_of_a_bilinear_oscillator():
    motion, expected = thrown(2.0), turning_points(2.0, 30)
    assert len(expected) == 10
    # the platform turns where friction becomes elastic again; the first interval is the start
    starts = np.array([start for start, _ in motion.stick[1:]])
    found = thrown(2.0, starts).position[: len(expected), 0, 0]
    np.testing.assert_allclose(found, expected, rtol=1e-10)
    assert motion.stick[-1][1] == pytest.approx(ALONE.duration)
    residual = reference.demands(motion).residual
    last = motion.position[motion.time > motion.stick[-1][0], 0, 0]
    assert np.ptp(last) <= residual.error < 2.1 * WAY
    assert residual.value == pytest.approx(abs(expected[-1]), rel=1e-3)


def test_a_slow_cycle_loses_four_times_friction_and_way_beyond_yield():
    # on a flat cap, whose slope changes the friction force by 1e-5
    period, radius, friction = 400.0, 50.0, 0.002
    slow = chain(radius, 0.0, [MASS], (), ((0.04, 0.0), (0.0, 0.0)), (period, period), (1e-9, 1e-9), 2.5 * period)
    slow = slow.with_values({"isolator.friction": {"slow": friction, "yield_displacement": WAY}})
    times = np.linspace(1.5 * period, 2.5 * period, 100001)
    motion = reference.trajectory(slow, (0.0, 0.0), "exact", tolerance=1e-8, times=times)
    amplitude = np.abs(motion.position[:, 0, 0]).max()
    lost, limit = np.trapezoid(motion.friction_power, motion.time), friction * MASS * GRAVITY
    assert lost == pytest.approx(4.0 * limit * (amplitude - WAY), rel=1e-4)
    assert amplitude > 20.0 * WAY


@pytest.mark.parametrize("table", [{}, {"fast": 0.05, "rate": 50.0}, {"load_exponent": 0.3}])
def test_a_turned_motion_is_the_same_motion(table):
    straight = yielding(FIG3.with_values({"bodies.1.period": [1.2, 1.2], "duration": 5.0}), 1e-3, **table)
    amplitudes = np.array([[1.0, 0.3], [0.2, 1.1]])
    angle = 0.7
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    mu = [
        reference.amplification(straight.with_values({"excitation.amplitudes": each}), PHASES, tolerance=TOLERANCE)
        for each in (amplitudes, turn @ amplitudes)
    ]
    ratio = mu[1].mu / mu[0].mu  # the largest ground acceleration does not turn
    assert (np.abs(ratio - 1.0) <= (mu[0].error + mu[1].error) / mu[0].mu + 1e-12).all()


def test_a_plane_motion_along_any_axis_is_the_same():
    along = [FIG3.with_values({"excitation.amplitudes": rows, "bodies.1.period": [1.2, 1.2]}) for rows in (
        [[1.0, 1.5], [0.0, 0.0]], [[0.0, 0.0], [1.0, 1.5]], [[0.6, 0.9], [0.8, 1.2]],
    )]  # fmt: skip
    found = [reference.amplification(yielding(scene, 1e-4), PHASES, tolerance=TOLERANCE) for scene in along]
    for one, other in itertools.pairwise(found):
        assert (np.abs(one.mu - other.mu) <= one.error + other.error).all()


def test_errors_cover_the_difference_to_a_tighter_run():
    for scene in (yielding(FIG3, 1e-4), yielding(FIG3, 1e-3, fast=0.05, rate=50.0)):
        loose, tight = (reference.amplification(scene, PHASES, tolerance=tolerance) for tolerance in (1e-4, 1e-8))
        assert (np.abs(loose.mu - tight.mu) <= loose.error).all()
        assert (loose.error <= 1e-4 * loose.mu).all()


def test_a_small_yield_displacement_tends_to_the_set_valued_law_but_for_the_platform_s_peak():
    ways, limit = (1e-3, 1e-4, 1e-5), reference.amplification(FIG3, PHASES, tolerance=1e-5)
    answers = [reference.amplification(yielding(FIG3, way), PHASES, tolerance=1e-4) for way in ways]
    body = np.array([np.abs(each.mu[:, 1] / limit.mu[:, 1] - 1.0).max() for each in answers])
    reach = np.array([np.abs(each.displacement / limit.displacement - 1.0).max() for each in answers])
    assert (body[1:] < 0.12 * body[:-1]).all()
    assert (reach[1:] < 0.65 * reach[:-1]).all()
    platform = np.abs(answers[-1].mu[:, 0] / limit.mu[:, 0] - 1.0)
    assert platform.max() > 0.05


@pytest.mark.parametrize(
    ("values", "status"),
    [
        ({"excitation.amplitudes": [[1.0, 0.0], [0.0, 1.0], [12.0, 0.0]]}, "contact lost"),
        ({"excitation.amplitudes": [[20.0, 0.0], [0.0, 20.0]]}, "rim reached"),
        ({"isolator.travel": 0.01}, "travel reached"),
    ],
)
def test_motions_end_as_under_rigid_friction(values, status):
    scenes = FIG3.with_values(values), yielding(FIG3, 1e-5).with_values(values)
    rigid, soft = (reference.amplification(scene, [(0.3, 1.1)]) for scene in scenes)
    assert rigid.status.tolist() == soft.status.tolist() == [status]
    assert soft.instant[0] == pytest.approx(rigid.instant[0], rel=2e-3)
