"""Floor response spectra: closed forms of an oscillator, an independent solution, the same from both sides."""

from dataclasses import replace

import numpy as np
import pytest
from chains import chain, made_up, refusal
from scipy import optimize, signal
from scipy.integrate import solve_ivp

import reference
from reference import factor_for_spectrum
from reference.problem import Accuracy, Trajectory

PHASE = (2.0, 0.7)
DAMPING = 0.05


def harmonic() -> Trajectory:
    """A motion of one body whose absolute acceleration is known."""
    time, total = np.linspace(0.0, 1.0, 101), np.zeros((101, 1, 3))
    total[:, 0, :2] = np.outer(np.sin(2.5 * np.pi * time), [1.0, 2.0])
    return made_up(chain(duration=1.0), time, absolute_acceleration=total)


def test_the_floors_of_a_motion_agree_with_scipy() -> None:
    scene = reference.load_scene("fig3-I").with_values({"duration": 2.0})
    motion = reference.trajectory(scene, PHASE)
    periods = [0.11, 0.6, 2.0]
    spectra = reference.floor_spectra(motion, periods)
    for row, period in enumerate(periods):
        natural = 2.0 * np.pi / period
        for body in range(len(scene.bodies)):
            force = motion.absolute_acceleration[:, body, 0]

            def slope(t, y, natural=natural, force=force):
                return [y[1], -np.interp(t, motion.time, force) - 2.0 * DAMPING * natural * y[1] - natural**2 * y[0]]

            solution = solve_ivp(slope, (0.0, 2.0), [0.0, 0.0], rtol=1e-7, atol=1e-11, max_step=5e-3)
            expected = natural**2 * np.abs(solution.y[0]).max()
            assert spectra.acceleration[body, 0, row] == pytest.approx(expected, rel=2e-3)


@pytest.mark.parametrize("end", [0.1, 1.0, 1.7])
def test_a_ramp_between_two_samples_has_its_closed_form(end: float) -> None:
    """Without damping omega^2 y is the ramp less sin(omega t) / omega t of its top, which never falls."""
    time, total = np.array([0.0, end]), np.zeros((2, 1, 3))
    total[1, 0, 1] = 3.0
    period = 0.8
    found = reference.floor_spectra(made_up(chain(duration=end), time, absolute_acceleration=total), [period], 0.0)
    turned = 2.0 * np.pi * end / period
    assert found.acceleration[0, 1, 0] == pytest.approx(3.0 * (1.0 - np.sin(turned) / turned), rel=1e-9)


@pytest.mark.parametrize(("name", "regularization"), [("fig3-II", None), ("fig3-II", 1e-3), ("synthetic-pair", None)])
def test_more_samples_change_less_than_the_error(name, regularization) -> None:
    scene = reference.load_scene(name).with_values({"duration": 10.0})
    motion = reference.trajectory(scene, PHASE, regularization=regularization)
    gaps = np.diff(motion.time) / 4.0
    between = (motion.time[:-1, None] + gaps[:, None] * np.arange(1, 4))[gaps > 1e-9]
    times = np.union1d(motion.time, between)
    finer = reference.floor_spectra(reference.trajectory(scene, PHASE, regularization=regularization, times=times))
    spectra = reference.floor_spectra(motion)
    assert (np.abs(spectra.acceleration - finer.acceleration) <= spectra.error).all()
    assert np.median(spectra.error / spectra.acceleration) < 2e-3


def test_the_error_of_a_spectrum_counts_the_other_runs() -> None:
    motion = harmonic()
    plain = reference.floor_spectra(motion)
    assert plain.damping == DAMPING
    np.testing.assert_allclose(plain.period, 0.02 * 250.0 ** (np.arange(49) / 48.0))
    larger = replace(motion, absolute_acceleration=1.1 * motion.absolute_acceleration)
    alone, beside = (
        reference.floor_spectra(replace(motion, accuracy=Accuracy(np.zeros(1), others, shares, 0.01)), [0.3, 0.9])
        for others, shares in (((), ()), ((larger, motion, larger), (0.3, 0.5, 0.2)))
    )
    np.testing.assert_allclose((beside.error - alone.error)[:, 0], 0.05 * alone.acceleration[:, 0], rtol=1e-9)
    exact = replace(motion, accuracy=Accuracy(np.zeros(1), (), (), 0.0))
    rising = np.zeros((101, 1, 3)) + motion.time[:, None, None]  # which every third sample has too, with both ends
    assert reference.floor_spectra(replace(exact, absolute_acceleration=rising), [0.3]).error.max() < 1e-9
    kept = [np.union1d([0, 100], np.arange(first, 101, 3)) for first in range(3)]
    coarse = [replace(exact, time=exact.time[k], absolute_acceleration=exact.absolute_acceleration[k]) for k in kept]
    values = [reference.floor_spectra(each, [0.3]).acceleration for each in (exact, *coarse)]
    changes = np.abs(np.array(values[1:]) - values[0])
    np.testing.assert_allclose(reference.floor_spectra(exact, [0.3]).error, 2.0 * changes.max(axis=0), rtol=1e-9)
    rounded = alone.error - reference.floor_spectra(exact, [0.3, 0.9]).error
    np.testing.assert_allclose(rounded, 0.01 * alone.acceleration, rtol=1e-9)


def test_a_motion_that_ended_early_has_no_spectra() -> None:
    scene = reference.load_scene("fig3-I").with_values(
        {"excitation.amplitudes": [[9.0, 0.0], [0.0, 9.0]], "isolator.friction": 0.01}
    )
    motion = reference.trajectory(scene, PHASE)
    assert motion.status == "rim reached"
    assert np.isnan(reference.floor_spectra(motion).acceleration).all()


def test_the_factor_for_a_spectrum_is_that_of_least_squares() -> None:
    """The minimum of the squared differences of logarithms, found by SciPy from spectra of SciPy."""
    random = np.random.default_rng(3)
    time, periods = np.arange(0.0, 12.0, 0.002), np.geomspace(0.4, 2.0, 5)
    ground = np.column_stack([np.interp(time, np.arange(13.0), random.normal(size=13)) for _ in "xy"])
    ground *= [1.0, 2.0]
    target = random.uniform(1.0, 4.0, 5)
    mean = np.ones(5)
    for n, omega in enumerate(2.0 * np.pi / periods):
        system = signal.lti([[0.0, 1.0], [-(omega**2), -0.2 * omega]], [[0.0], [-1.0]], [[1.0, 0.0]], [[0.0]])
        for row in ground.T:
            mean[n] *= omega * np.sqrt(np.abs(signal.lsim(system, row, time)[1]).max())

    def misfit(logarithm: float) -> float:
        return float(((np.log(np.exp(logarithm) * mean) - np.log(target)) ** 2).sum())

    expected = np.exp(optimize.minimize_scalar(misfit, bracket=(-1.0, 1.0)).x)
    np.testing.assert_allclose(reference.response_spectrum(time, ground, periods, damping=0.1), mean, rtol=1e-4)
    assert factor_for_spectrum(time, ground, periods, target, damping=0.1) == pytest.approx(expected, rel=1e-4)
    doubled = factor_for_spectrum(time, 2.0 * ground, periods, target, damping=0.1)
    assert doubled == pytest.approx(0.5 * expected, rel=1e-4)
    plain = reference.response_spectrum(time, ground, periods)
    np.testing.assert_array_equal(plain, reference.response_spectrum(time, ground, periods, damping=0.05))
    assert factor_for_spectrum(time, ground, periods, plain) == pytest.approx(1.0)


FITTING = "must be positive numbers (P,), as many periods as accelerations of the target"


def test_what_has_no_spectrum_or_factor_is_refused_in_one_line() -> None:
    motion, rising, both = harmonic(), [0.0, 1.0], [1.0, 2.0]
    for periods, damping, rule in (
        ([0.0, 1.0], 0.05, "periods: must be positive"),
        ([[1.0]], 0.05, "periods: must be positive"),
        ([1.0], -0.1, "damping = -0.1: must be finite, from 0 to 1 of critical"),
    ):
        assert str(refusal(reference.floor_spectra, motion, periods, damping)).startswith(rule)
    for given, rule in (
        ((rising, both, [1.0, 2.0], [1.0]), f"periods (2,), target (1,): {FITTING}"),
        ((rising, both, [1.0], [0.0]), f"periods (1,), target (1,): {FITTING}"),
        ((rising, both, [-1.0], [1.0]), f"periods (1,), target (1,): {FITTING}"),
        ((rising, both, [[1.0]], [[1.0]]), f"periods (1, 1), target (1, 1): {FITTING}"),
        ((rising, both, [], []), f"periods (0,), target (0,): {FITTING}"),
        (([0.0, 1.0, 1.0], [1.0, 2.0, 3.0], [1.0], [1.0]), "rising instants"),
        ((rising, [[1.0, 0.0], [2.0, 0.0]], [1.0], [1.0]), "at rest along a direction"),
    ):
        assert rule in str(refusal(factor_for_spectrum, *given))
