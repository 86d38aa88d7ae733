"""The solver against motions with a closed form. Tolerances are multiples of the tolerance asked of the solver."""

import numpy as np
import pytest
from chains import chain

import reference
from reference.analytical import (
    circular_shaking,
    conical_frequency,
    coulomb_decay,
    coulomb_rest,
    den_hartog,
    frictionless_amplification,
    planar_period,
    squared_rate,
    turning_angle,
    turning_time,
)
from reference.problem import GRAVITY, Scene, State, phase_grid

TOLERANCE = 1e-8
STILL = ((0.0, 0.0), (0.0, 0.0))
BOTH = pytest.mark.parametrize("equations", ["exact", "small"])


def state(position, velocity) -> State:
    return State(np.atleast_2d(np.asarray(position, float)), np.atleast_2d(np.asarray(velocity, float)))


# free motion of one body on still ground -----------------------------------------------------------------------------


@pytest.mark.parametrize("direction", [0.0, 0.7, 2.5])
def test_free_coulomb_decay_of_the_small_equations(direction, within):
    """Turning points, stops and rest of a straight decay, in a direction that is no axis of the coordinates."""
    radius, friction, amplitude = 0.25, 0.05, 0.1
    scene = chain(radius, friction, amplitudes=STILL, duration=4.0)
    along = np.array([np.cos(direction), np.sin(direction)])
    frequency, dead_zone = np.sqrt(GRAVITY / radius), friction * radius
    run = reference.trajectory(
        scene, (0.0, 0.0), "small", tolerance=TOLERANCE, times=np.linspace(0.0, 4.0, 401),
        initial=state(amplitude * along, [0.0, 0.0]),
    )  # fmt: skip
    assert run.status == "ok"
    position, velocity = coulomb_decay(run.time, amplitude, dead_zone, frequency)
    within(abs(run.position[:, 0, :2] - np.outer(position, along)).max() / amplitude, 10 * TOLERANCE)
    np.testing.assert_allclose(
        run.velocity[:, 0, :2], np.outer(velocity, along), atol=10 * TOLERANCE * amplitude * frequency
    )
    (begin, end), = run.stick  # fmt: skip
    assert begin == pytest.approx(coulomb_rest(amplitude, dead_zone, frequency)[0], rel=10 * TOLERANCE)
    assert end == 4.0


@pytest.mark.parametrize("friction", [0.02, 0.1, 0.3])
def test_swing_down_and_up_the_cap_with_friction(friction, within):
    """Speed along the way, contact force with its centripetal part, and where and when the first swing ends."""
    radius, start = 0.25, 1.0
    end_time, end_angle = turning_time(start, friction, radius), turning_angle(start, friction, radius)
    scene = chain(radius, friction, amplitudes=STILL, duration=3.0)
    along = np.array([0.6, -0.8])
    times = np.append(np.linspace(0.0, 0.999 * end_time, 200), end_time)
    run = reference.trajectory(
        scene, (0.0, 0.0), "exact", tolerance=TOLERANCE, times=times,
        initial=state(radius * np.sin(start) * along, [0.0, 0.0]),
    )  # fmt: skip
    assert run.status == "ok"
    angle = np.arcsin(run.position[:, 0, :2] @ along / radius)
    rate2 = np.array([squared_rate(a, start, 0.0, friction, radius) for a in angle])
    speed2 = (run.velocity[:, 0] ** 2).sum(axis=-1)
    np.testing.assert_allclose(speed2, radius**2 * rate2, atol=20 * TOLERANCE * speed2.max())
    np.testing.assert_allclose(
        run.contact_force[:-1], (GRAVITY * np.cos(angle) + radius * rate2)[:-1], rtol=100 * TOLERANCE
    )
    within(abs(angle[-1] - end_angle), 10 * TOLERANCE)
    np.testing.assert_allclose(run.position[:, 0, 2], radius * (1.0 - np.cos(angle)), atol=1e-14)


@pytest.mark.parametrize("swing", [0.01, 0.1, 0.2])
def test_planar_pendulum_has_its_large_angle_period(swing):
    radius = 0.25
    period = planar_period(radius, swing)
    scene = chain(radius, 0.0, amplitudes=STILL, duration=5.0 * period)
    times = period * np.array([0.5, 1.0, 1.5, 4.0, 4.5])
    run = reference.trajectory(
        scene, (0.0, 0.0), "exact", tolerance=TOLERANCE, times=times, initial=state([0.0, swing], [0.0, 0.0])
    )
    np.testing.assert_allclose(
        run.position[:, 0, 1], swing * np.array([-1.0, 1.0, -1.0, 1.0, -1.0]), rtol=10 * TOLERANCE
    )
    np.testing.assert_allclose(run.velocity[:, 0], 0.0, atol=100 * TOLERANCE * swing * np.sqrt(GRAVITY / radius))


@pytest.mark.parametrize("circle", [0.01, 0.15, 0.24])
def test_conical_pendulum_turns_at_its_frequency(circle, within):
    radius, mass = 0.25, 3.0
    omega = conical_frequency(radius, circle)
    scene = chain(radius, 0.0, masses=(mass,), amplitudes=STILL, duration=5.0)
    run = reference.trajectory(
        scene, (0.0, 0.0), "exact", tolerance=TOLERANCE, times=np.linspace(0.0, 5.0, 101),
        initial=state([circle, 0.0], [0.0, omega * circle]),
    )  # fmt: skip
    turn = np.exp(1j * omega * run.time)
    found = run.position[:, 0, 0] + 1j * run.position[:, 0, 1]
    within(abs(found / circle - turn).max(), 100 * TOLERANCE)
    cosine = np.sqrt(1.0 - (circle / radius) ** 2)
    np.testing.assert_allclose(run.contact_force, mass * GRAVITY / cosine, rtol=100 * TOLERANCE)


# steady forced motion with friction ----------------------------------------------------------------------------------


@BOTH
@pytest.mark.parametrize(("ratio", "dead_zone"), [(0.6, 0.3), (1.4, 0.2), (2.0, 0.15), (0.8, 0.5)])
def test_den_hartog_s_oscillation_goes_on_as_it_was_begun(ratio, dead_zone, equations, within):
    """From a turning point, under so weak a loading that the isolator's terms (x/rho)^2, mu x u/(rho g) are < 1e-7."""
    radius, ground = 0.25, 1e-4
    steady = den_hartog(ratio, dead_zone)
    own = np.sqrt(GRAVITY / radius)
    unit = ground / own**2  # a, m
    period = 2.0 * np.pi / (ratio * own)
    along = np.array([0.8, 0.6])
    scene = chain(
        radius, dead_zone * unit / radius, amplitudes=[[-0.8 * ground, 0.0], [-0.6 * ground, 0.0]],
        periods=[period, period], decay=[0.0, 0.0], duration=6.0 * period,
    )  # fmt: skip
    run = reference.trajectory(
        scene, (steady.phase, 0.0), equations, tolerance=TOLERANCE, times=np.linspace(0.0, 6.0 * period, 301),
        initial=state(steady.amplitude * unit * along, [0.0, 0.0]),
    )  # fmt: skip
    assert run.status == "ok"
    assert run.stick == []
    wanted = unit * steady.position(ratio * own * run.time)
    found = run.position[:, 0, :2] / (unit * steady.amplitude)
    within(abs(found - np.outer(wanted / (unit * steady.amplitude), along)).max(), 100 * TOLERANCE + 1e-7)


@BOTH
@pytest.mark.parametrize(
    ("count", "damping"), [(1, None), (2, None), (3, None), (6, None), (2, 0.05), (3, 0.5), (6, 3.0)]
)
def test_a_shaken_chain_stays_on_its_circles(count, damping, equations):
    """Every body on its own circle, the platform sliding at constant speed on a fifth of the radius or more."""
    acceleration, period = 3.0, 0.8
    masses, links = [2.0, 1.0, 0.7, 1.5, 0.4, 1.0][:count], [300.0, 500.0, 800.0, 200.0, 400.0][: count - 1]
    scene = chain(
        0.3, 0.08, masses, [[k, k] for k in links], amplitudes=[[acceleration, 0.0], [0.0, acceleration]],
        periods=[period, period], decay=[0.0, 0.0], duration=4.0, damping=damping,
    )  # fmt: skip
    omega = 2.0 * np.pi / period
    circle = circular_shaking(scene, acceleration, omega, equations)
    start, speed = circle.amplitude, 1j * omega * circle.amplitude
    run = reference.trajectory(
        scene, (0.0, -0.5 * np.pi), equations, tolerance=TOLERANCE, times=np.linspace(0.0, 4.0, 81),
        initial=State(np.stack([start.real, start.imag], axis=1), np.stack([speed.real, speed.imag], axis=1)),
    )  # fmt: skip
    assert run.status == "ok"
    found = run.position[:, :, 0] + 1j * run.position[:, :, 1]
    wanted = np.exp(1j * omega * run.time)[:, None] * circle.amplitude
    # the circle may repel its neighbors: they part at most like the chain's free vibration, hence the factor
    np.testing.assert_allclose(found, wanted, atol=1000 * TOLERANCE * np.abs(circle.amplitude).max())
    horizontal = np.hypot(run.absolute_acceleration[:, :, 0], run.absolute_acceleration[:, :, 1])
    np.testing.assert_allclose(
        horizontal / acceleration, np.broadcast_to(circle.amplification, horizontal.shape), rtol=1e4 * TOLERANCE
    )
    np.testing.assert_allclose(run.contact_force, circle.normal, rtol=1e4 * TOLERANCE)


# frictionless response ------------------------------------------------------------------------------------------------

FRICTIONLESS = chain(
    0.25, 0.0, [2.0, 1.0, 0.4], [[60.0, 90.0], [50.0, 70.0]], [[0.6, 0.2], [-0.1, 0.5]], decay=[0.33, 0.1]
)


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-8])
def test_frictionless_surface_is_the_closed_form_to_its_error(tolerance, within):
    phases = phase_grid(4)
    found = reference.amplification(FRICTIONLESS, phases, equations="small", tolerance=tolerance, full=True)
    exact = frictionless_amplification(FRICTIONLESS, phases)
    assert (found.status == "ok").all()
    within((np.abs(found.mu - exact) / (found.error + 1e-12)).max(), 1.0)
    assert np.all(found.error <= tolerance * found.mu)


def test_platform_held_by_friction_moves_with_the_ground():
    scene: Scene = chain(friction=2.0, masses=[1.0, 0.5], stiffness=[[40.0, 30.0]])
    for equations in ("exact", "small"):
        found = reference.amplification(scene, phase_grid(3), equations=equations, tolerance=TOLERANCE)
        np.testing.assert_allclose(found.mu[:, 0], 1.0, rtol=TOLERANCE)
