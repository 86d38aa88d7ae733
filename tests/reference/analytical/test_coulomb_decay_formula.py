"""Free decay under dry friction against integration with SciPy between the turning points."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from reference.analytical import coulomb_decay, coulomb_rest

FREQUENCY, DEAD_ZONE = 5.0, 0.02


def integrated(amplitude: float) -> tuple[list[float], list[float], np.ndarray]:
    """Turning times and positions, and samples (3, T) of time, position, velocity, until friction holds the body."""
    t, x = 0.0, amplitude
    times, places, samples = [0.0], [amplitude], [np.array([[0.0], [amplitude], [0.0]])]
    while abs(x) > DEAD_ZONE:
        push = np.sign(x) * DEAD_ZONE  # friction opposes the motion, which goes towards the middle

        def rhs(_, y, push=push):
            return [y[1], -(FREQUENCY**2) * (y[0] - push)]

        def turn(s, y, t=t, x=x):
            return y[1] if s > t + 1e-3 else np.sign(-x)

        turn.terminal = True
        run = solve_ivp(
            rhs, (t, t + 2.0), [x, 0.0], method="DOP853", rtol=1e-12, atol=1e-14, events=turn, max_step=0.05
        )
        t, x = float(run.t_events[0][0]), float(run.y_events[0][0][0])
        times.append(t)
        places.append(x)
        samples.append(np.vstack([run.t, run.y]))
    return times, places, np.hstack(samples)


@pytest.mark.parametrize("amplitude", [0.31, -0.31, 0.05, 0.19999])
def test_decay_is_the_integrated_motion(amplitude):
    times, places, (t, x, v) = integrated(amplitude)
    position, velocity = coulomb_decay(t, amplitude, DEAD_ZONE, FREQUENCY)
    np.testing.assert_allclose(position, x, atol=1e-10 * abs(amplitude))
    np.testing.assert_allclose(velocity, v, atol=1e-9 * abs(amplitude) * FREQUENCY)
    assert coulomb_rest(amplitude, DEAD_ZONE, FREQUENCY) == pytest.approx((times[-1], places[-1]), rel=1e-9)


def test_each_half_cycle_costs_twice_the_dead_zone():
    turns = np.arange(5) * np.pi / FREQUENCY
    position, _ = coulomb_decay(turns, 0.31, DEAD_ZONE, FREQUENCY)
    np.testing.assert_allclose(np.abs(position), 0.31 - 2.0 * DEAD_ZONE * np.arange(5), rtol=1e-12)


def test_release_inside_the_dead_zone_stays():
    assert coulomb_rest(0.019, DEAD_ZONE, FREQUENCY) == (0.0, 0.019)
    position, velocity = coulomb_decay([0.0, 3.0], -0.019, DEAD_ZONE, FREQUENCY)
    np.testing.assert_array_equal(position, -0.019)
    np.testing.assert_array_equal(velocity, 0.0)
