"""The solver against motions with a closed form. Tolerances are multiples of the tolerance asked of the solver."""

import numpy as np
import pytest
from chains import chain
from closed_forms.circular_shaking import circular_shaking
from closed_forms.coulomb_decay import coulomb_decay, coulomb_rest
from closed_forms.den_hartog import den_hartog
from closed_forms.planar_sliding import squared_rate, turning_angle, turning_time
from closed_forms.spherical_pendulum import conical_frequency, planar_period

import reference
from reference.analytical.frictionless import frictionless_peaks
from reference.problem import GRAVITY, Scene, State, Trajectory, ground_peak, phase_grid

TOLERANCE = 1e-8
RADIUS = 0.25
STILL = ((0.0, 0.0), (0.0, 0.0))
BOTH = pytest.mark.parametrize("equations", ["exact", "small"])


def moved(scene: Scene, equations: str, times, position, velocity=(0.0, 0.0), phase=(0.0, 0.0)) -> Trajectory:
    """The motion from a state."""
    start = State(*(np.atleast_2d(np.asarray(part, float)) for part in (position, velocity)))
    run = reference.trajectory(scene, phase, equations, tolerance=TOLERANCE, times=times, initial=start)
    assert run.status == "ok"
    return run


@pytest.mark.parametrize("direction", [0.0, 0.7, 2.5])
def test_free_coulomb_decay_of_the_small_equations(direction, within):
    """Turning points, stops and rest of a straight decay, in a direction that is no axis of the coordinates."""
    friction, amplitude = 0.05, 0.1
    along = np.array([np.cos(direction), np.sin(direction)])
    frequency, dead_zone = np.sqrt(GRAVITY / RADIUS), friction * RADIUS
    scene = chain(RADIUS, friction, amplitudes=STILL, duration=4.0)
    run = moved(scene, "small", np.linspace(0.0, 4.0, 401), amplitude * along)
    position, velocity = coulomb_decay(run.time, amplitude, dead_zone, frequency)
    within(abs(run.position[:, 0, :2] - np.outer(position, along)).max() / amplitude, 10 * TOLERANCE)
    allowed = 10 * TOLERANCE * amplitude * frequency
    np.testing.assert_allclose(run.velocity[:, 0, :2], np.outer(velocity, along), atol=allowed)
    (begin, end), = run.stick  # fmt: skip
    assert begin == pytest.approx(coulomb_rest(amplitude, dead_zone, frequency)[0], rel=10 * TOLERANCE)
    assert end == 4.0


@pytest.mark.parametrize("friction", [0.02, 0.1, 0.3])
def test_swing_down_and_up_the_cap_with_friction(friction, within):
    """Speed along the way, contact force with its centripetal part, and where and when the first swing ends."""
    start, along = 1.0, np.array([0.6, -0.8])
    end_time, end_angle = turning_time(start, friction, RADIUS), turning_angle(start, friction, RADIUS)
    scene = chain(RADIUS, friction, amplitudes=STILL, duration=3.0)
    times = np.append(np.linspace(0.0, 0.999 * end_time, 200), end_time)
    run = moved(scene, "exact", times, RADIUS * np.sin(start) * along)
    angle = np.arcsin(run.position[:, 0, :2] @ along / RADIUS)
    rate2 = np.array([squared_rate(a, start, 0.0, friction, RADIUS) for a in angle])
    speed2 = (run.velocity[:, 0] ** 2).sum(axis=-1)
    np.testing.assert_allclose(speed2, RADIUS**2 * rate2, atol=20 * TOLERANCE * speed2.max())
    force = GRAVITY * np.cos(angle) + RADIUS * rate2
    np.testing.assert_allclose(run.contact_force[:-1], force[:-1], rtol=100 * TOLERANCE)
    within(abs(angle[-1] - end_angle), 10 * TOLERANCE)
    np.testing.assert_allclose(run.position[:, 0, 2], RADIUS * (1.0 - np.cos(angle)), atol=1e-14)


@pytest.mark.parametrize("swing", [0.01, 0.1, 0.2])
def test_planar_pendulum_has_its_large_angle_period(swing):
    period = planar_period(RADIUS, swing)
    times = period * np.array([0.5, 1.0, 1.5, 4.0, 4.5])
    run = moved(chain(RADIUS, 0.0, amplitudes=STILL, duration=5.0 * period), "exact", times, [0.0, swing])
    np.testing.assert_allclose(run.position[:, 0, 1] / swing, [-1.0, 1.0, -1.0, 1.0, -1.0], rtol=10 * TOLERANCE)
    np.testing.assert_allclose(run.velocity[:, 0], 0.0, atol=100 * TOLERANCE * swing * np.sqrt(GRAVITY / RADIUS))


@pytest.mark.parametrize("circle", [0.01, 0.15, 0.24])
def test_conical_pendulum_turns_at_its_frequency(circle, within):
    omega, mass = conical_frequency(RADIUS, circle), 3.0
    scene = chain(RADIUS, 0.0, masses=(mass,), amplitudes=STILL, duration=5.0)
    run = moved(scene, "exact", np.linspace(0.0, 5.0, 101), [circle, 0.0], [0.0, omega * circle])
    found = run.position[:, 0, 0] + 1j * run.position[:, 0, 1]
    within(abs(found / circle - np.exp(1j * omega * run.time)).max(), 100 * TOLERANCE)
    cosine = np.sqrt(1.0 - (circle / RADIUS) ** 2)
    np.testing.assert_allclose(run.contact_force, mass * GRAVITY / cosine, rtol=100 * TOLERANCE)


@BOTH
@pytest.mark.parametrize(("ratio", "dead_zone"), [(0.6, 0.3), (1.4, 0.2), (2.0, 0.15), (0.8, 0.5)])
def test_den_hartog_s_oscillation_goes_on_as_it_was_begun(ratio, dead_zone, equations, within):
    """From a turning point, under so weak a loading that the isolator's terms (x/rho)^2, mu x u/(rho g) are < 1e-7."""
    steady, own, ground = den_hartog(ratio, dead_zone), np.sqrt(GRAVITY / RADIUS), 1e-4
    unit, period, along = ground / own**2, 2.0 * np.pi / (ratio * own), np.array([0.8, 0.6])
    loading = {"amplitudes": [[-0.8 * ground, 0.0], [-0.6 * ground, 0.0]], "periods": [period, period]}
    scene = chain(RADIUS, dead_zone * unit / RADIUS, decay=[0.0, 0.0], duration=6.0 * period, **loading)
    times, size = np.linspace(0.0, 6.0 * period, 301), steady.amplitude * unit
    run = moved(scene, equations, times, size * along, phase=(steady.phase, 0.0))
    assert run.stick == []
    angle = ratio * own * run.time
    wanted = np.outer(steady.position(angle) / steady.amplitude, along)
    within(abs(run.position[:, 0, :2] / size - wanted).max(), 100 * TOLERANCE + 1e-7)
    absolute = np.outer(ground * (steady.acceleration(angle) - np.cos(angle + steady.phase)), along)
    inside = np.abs(np.sin(angle)) > 0.1  # not beside a turning point, where it jumps
    np.testing.assert_allclose(run.absolute_acceleration[inside, 0, :2], absolute[inside], atol=2e-6 * ground)


@BOTH
@pytest.mark.parametrize(("count", "damping"), [(1, None), (6, None), (2, 0.05), (3, 0.5)])
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
    start, speed = (np.stack([z.real, z.imag], axis=1) for z in (circle.amplitude, 1j * omega * circle.amplitude))
    run = moved(scene, equations, np.linspace(0.0, 4.0, 81), start, speed, (0.0, -0.5 * np.pi))
    found = run.position[:, :, 0] + 1j * run.position[:, :, 1]
    wanted = np.exp(1j * omega * run.time)[:, None] * circle.amplitude
    # the circle may repel its neighbors: they part at most like the chain's free vibration, hence the factor
    np.testing.assert_allclose(found, wanted, atol=1000 * TOLERANCE * np.abs(circle.amplitude).max())
    factors = np.hypot(run.absolute_acceleration[:, :, 0], run.absolute_acceleration[:, :, 1]) / acceleration
    np.testing.assert_allclose(factors, np.tile(circle.amplification, (81, 1)), rtol=1e4 * TOLERANCE)
    np.testing.assert_allclose(run.contact_force, circle.normal, rtol=1e4 * TOLERANCE)


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-8])
def test_frictionless_surface_is_the_closed_form_to_its_error(tolerance, within):
    links, amplitudes = [[60.0, 90.0], [50.0, 70.0]], [[0.6, 0.2], [-0.1, 0.5]]
    scene = chain(RADIUS, 0.0, [2.0, 1.0, 0.4], links, amplitudes, decay=[0.33, 0.1])
    found = reference.amplification(scene, phase_grid(4), equations="small", tolerance=tolerance, full=True)
    exact = frictionless_peaks(scene, phase_grid(4))[0] / ground_peak(scene, phase_grid(4))[:, None]
    assert (found.status == "ok").all()
    within((np.abs(found.mu - exact) / (found.error + 1e-12)).max(), 1.0)
    assert np.all(found.error <= tolerance * found.mu)
