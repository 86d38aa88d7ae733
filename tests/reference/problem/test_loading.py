"""The ground motion in closed form, its peak, and the phases."""

import math
from itertools import pairwise

import numpy as np
import pytest
from chains import chain
from scipy.integrate import quad

from reference.problem import (
    exponents,
    ground_acceleration,
    ground_displacement,
    ground_peak,
    ground_velocity,
    loading_period,
    phase_grid,
)
from reference.problem.phases import grid_axes

PHASE = (0.3, 1.1)
LOAD = chain(amplitudes=((1.0, 0.4), (-0.3, 1.2), (0.2, 0.7)), decay=(0.33, 0.0))


def test_acceleration_is_the_sum_of_damped_cosines_as_printed():
    """(5.3) term by term in scalars."""
    for t in (0.0, 0.37, 12.0):
        first = math.exp(-0.33 * t) * math.cos(2.0 * math.pi / 0.9 * t + 0.3)
        second = math.cos(2.0 * math.pi / 1.1 * t + 1.1)
        expected = [first + 0.4 * second, -0.3 * first + 1.2 * second, 0.2 * first + 0.7 * second]
        assert ground_acceleration(LOAD, PHASE, [t])[0] == pytest.approx(expected, abs=1e-14)


@pytest.mark.parametrize("end", [1e-3, 0.1, 1.7, 9.3])
def test_velocity_and_displacement_integrate_the_acceleration(end):
    """Velocity by one quadrature, displacement as int (end - t) a dt, to 1e-12."""
    pieces = np.linspace(0.0, end, 2 + int(4 * end))
    for row in range(3):

        def integral(weight, row=row):
            def integrand(t):
                return weight(t) * ground_acceleration(LOAD, PHASE, [t])[0, row]

            return sum(quad(integrand, a, b, epsabs=1e-14, epsrel=1e-13)[0] for a, b in pairwise(pieces))

        assert ground_velocity(LOAD, PHASE, [end])[0, row] == pytest.approx(integral(lambda t: 1.0), abs=1e-12)
        assert ground_displacement(LOAD, PHASE, [end])[0, row] == pytest.approx(integral(lambda t: end - t), abs=1e-12)


def test_displacement_keeps_its_digits_at_small_times():
    """Against the Taylor series, 16 terms; from times where the closed form would cancel."""
    s = exponents(LOAD)
    for t in 10.0 ** np.linspace(-12, -1, 45):
        terms = sum((s * t) ** k / math.factorial(k + 2) for k in range(16))
        exact = (LOAD.amplitudes @ (t * t * terms * np.exp(1j * np.array(PHASE)))).real
        np.testing.assert_allclose(ground_displacement(LOAD, PHASE, [t])[0], exact, rtol=1e-12)


@pytest.mark.parametrize("duration", [0.03, 0.2, 1.0, 20.0])
@pytest.mark.parametrize("decay", [(0.0, 0.0), (0.3, 2.0)])
def test_ground_peak_is_the_maximum_of_dense_samples(duration, decay):
    """Between samples |u|^2 rises by at most half its curvature times (step / 2)^2."""
    phases = np.random.default_rng(5).uniform(0.0, 6.3, (20, 2))
    for amplitudes in (((1.0, 0.4), (-0.3, 1.2), (0.2, 0.7)), ((0.0, 2.0), (0.0, 0.0)), ((1.0, 0.0), (0.0, 1.0))):
        load = chain(amplitudes=amplitudes, periods=(0.4, 0.55), decay=decay, duration=duration)
        times = np.linspace(0.0, duration, 4_001)
        envelope, fastest = np.abs(amplitudes).sum(), 2.0 * np.pi / 0.4 + max(decay)
        for phase, peak in zip(phases, ground_peak(load, phases)):
            sampled = np.sqrt((ground_acceleration(load, phase, times) ** 2).sum(axis=1).max())
            assert sampled * (1.0 - 1e-13) <= peak
            assert peak**2 - sampled**2 <= 4.0 * (envelope * fastest * times[1]) ** 2 + 1e-14


@pytest.mark.parametrize("amplitudes", [((1.0, 0.0), (0.0, 1.0), (0.0, 0.0)), ((1.0, 1.0), (0.0, 0.0), (0.0, 0.0))])
def test_the_ground_peaks_at_its_highest_wave_and_not_at_the_highest_sample(amplitudes):
    """Of 200 phase pairs some have the highest of 32 samples per period on a wave that is not the highest."""
    load = chain(amplitudes=amplitudes, periods=(0.4, 0.55), decay=(0.0, 0.0), duration=10.0)
    phases = np.random.default_rng(5).uniform(0.0, 6.3, (200, 2))
    waves = np.exp(np.multiply.outer(np.linspace(0.0, 10.0, 20_001), exponents(load)))
    squares = sum(((row * np.exp(1j * phases)) @ waves.T).real ** 2 for row in load.amplitudes)
    np.testing.assert_allclose(ground_peak(load, phases), np.sqrt(squares.max(axis=1)), rtol=2e-5)


def test_the_loading_changes_within_the_shorter_period_whichever_it_is():
    assert [loading_period(chain(periods=periods)) for periods in ((0.7, 1.1), (1.1, 0.7))] == [0.7, 0.7]
    at_rest = {"record": {"time": [0.0, 0.5], "acceleration": [0.0, 0.0]}}
    assert loading_period(chain(duration=3.0).with_values({"excitation": at_rest})) == 3.0


@pytest.mark.parametrize("count", [1, 3])
def test_a_phase_pair_has_two_phases(count):
    with pytest.raises(ValueError, match=rf"^phases: shape \({count},\): must be \(2,\), rad$"):
        ground_velocity(LOAD, np.zeros(count), [0.0])


def test_phase_grid_covers_the_torus_once_with_alpha2_fastest():
    grid = phase_grid(4)
    assert grid.shape == (16, 2)
    np.testing.assert_allclose(grid[:5, 1], np.array([0.0, 0.25, 0.5, 0.75, 0.0]) * 2.0 * np.pi)
    np.testing.assert_allclose(grid[:5, 0], [0.0, 0.0, 0.0, 0.0, 0.5 * np.pi])
    assert grid.max() < 2.0 * np.pi
    assert len({tuple(pair) for pair in grid.tolist()}) == 16
    assert [axis.tolist() for axis in grid_axes(grid) or ()] == [grid[::4, 0].tolist(), grid[:4, 1].tolist()]
    for less in (grid[:4], grid[::4], grid[:4, None], grid[None, :4], grid[[0, 1, 4, 6]], grid[:6]):
        assert grid_axes(less) is None, "one row or column, or no grid"
