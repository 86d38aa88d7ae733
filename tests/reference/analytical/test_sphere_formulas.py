"""Motions of one body in the spherical cap: formulas against quadrature and integration."""

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from reference.analytical import (
    conical_frequency,
    planar_period,
    squared_rate,
    stopping_distance,
    stopping_time,
    turning_angle,
    turning_time,
)
from reference.problem import GRAVITY

RADIUS = 0.25


@pytest.mark.parametrize("start", [1e-3, 0.5, 1.2])
def test_planar_period_is_the_quadrature_of_the_energy_integral(start):
    """T = 4 sqrt(rho/2g) int_0^start d theta / sqrt(cos theta - cos start), theta = start sin u takes the root away."""

    def rate(u):
        angle = start * np.sin(u)
        drop = 2.0 * np.sin(0.5 * (start + angle)) * np.sin(0.5 * (start - angle))  # cos angle - cos start
        return start * np.cos(u) / np.sqrt(drop)

    value, _ = quad(rate, 0.0, 0.5 * np.pi - 1e-9, epsabs=1e-13, epsrel=1e-12)
    exact = 4.0 * np.sqrt(RADIUS / (2.0 * GRAVITY)) * value
    assert planar_period(RADIUS, RADIUS * np.sin(start)) == pytest.approx(exact, rel=1e-8)


@pytest.mark.parametrize("circle", [0.01, 0.1, 0.2])
def test_conical_pendulum_balances_gravity_and_centripetal_force(circle):
    omega = conical_frequency(RADIUS, circle)
    slope = circle / np.sqrt(RADIUS**2 - circle**2)
    assert omega**2 * circle == pytest.approx(GRAVITY * slope, rel=1e-14)


@pytest.mark.parametrize("friction", [0.0, 0.05, 0.3])
def test_squared_rate_obeys_the_equation_of_motion(friction):
    """rho theta'' = -g sin theta + mu N/m while theta falls, N/m = g cos theta + rho theta'^2, integrated in time."""
    start, rate = 0.9, -0.5

    def rhs(_, y):
        theta, omega = y
        normal = GRAVITY * np.cos(theta) + RADIUS * omega**2
        return [omega, (-GRAVITY * np.sin(theta) + friction * normal) / RADIUS]

    run = solve_ivp(rhs, (0.0, 0.25), [start, rate], method="DOP853", rtol=1e-12, atol=1e-13)
    assert np.all(run.y[1] < 0.0)
    found = [squared_rate(angle, start, rate, friction, RADIUS) for angle in run.y[0]]
    np.testing.assert_allclose(found, run.y[1] ** 2, rtol=1e-9)


@pytest.mark.parametrize("friction", [0.02, 0.1, 0.3])
def test_turning_point_and_time_are_the_integrated_ones(friction):
    start = 1.0

    def rhs(_, y):
        theta, omega = y
        normal = GRAVITY * np.cos(theta) + RADIUS * omega**2
        return [omega, (-GRAVITY * np.sin(theta) + friction * normal) / RADIUS]

    def turn(_, y):
        return y[1] + 1e-300

    turn.terminal, turn.direction = True, 1.0
    run = solve_ivp(rhs, (0.0, 3.0), [start, 0.0], method="DOP853", rtol=1e-12, atol=1e-13, events=turn)
    assert turning_angle(start, friction, RADIUS) == pytest.approx(run.y[0, -1], abs=1e-10)
    assert turning_time(start, friction, RADIUS) == pytest.approx(run.t[-1], rel=1e-10)


def test_frictionless_swing_takes_half_a_pendulum_period():
    assert turning_time(0.8, 0.0, RADIUS) == pytest.approx(0.5 * planar_period(RADIUS, RADIUS * np.sin(0.8)), rel=1e-12)


def test_straight_stop_is_the_integral_of_constant_deceleration():
    speed, friction = 2.0, 0.3
    time = stopping_time(speed, friction)
    distance, _ = quad(lambda t: speed - friction * GRAVITY * t, 0.0, time)
    assert stopping_distance(speed, friction) == pytest.approx(distance, rel=1e-13)
    assert speed - friction * GRAVITY * time == pytest.approx(0.0, abs=1e-14)
