"""Friction that depends on the velocity against closed forms, limits and scaling; `oracle_values.json` has more."""

import numpy as np
import pytest
from chains import chain
from scipy.integrate import quad
from scipy.optimize import brentq

import reference
from reference.analytical import circular_shaking
from reference.problem import GRAVITY, DryFriction, Scene, State, linear, load_scene, no_friction, untilted

TOLERANCE = 1e-8
STILL = ((0.0, 0.0), (0.0, 0.0))
STEADY = {"periods": (1e9, 1e9), "decay": (0.0, 0.0)}  # harmonics that stay at their first value
FLAT = 1e11  # m, radius of a cap that is flat
BOTH = pytest.mark.parametrize("equations", ["exact", "small"])
LAWS = pytest.mark.parametrize(
    "law",
    [DryFriction(0.03, 0.06, 100.0), DryFriction(0.06, 0.03, 100.0), DryFriction(0.2, 0.05, 3.0)],
    ids=["rising", "falling", "slowly falling"],
)
RISING, FALLING = ({"slow": a, "fast": b, "rate": 100.0} for a, b in ((0.05, 0.1), (0.1, 0.05)))
PHASES = [(0.3, 1.1), (2.0, 0.7)]


def with_law(scene: Scene, law: DryFriction | dict[str, float] | float) -> Scene:
    table = {"slow": law.slow, "fast": law.fast, "rate": law.rate} if isinstance(law, DryFriction) else law
    return scene.with_values({"isolator.friction": table})


# closed forms --------------------------------------------------------------------------------------------------------


@BOTH
@LAWS
@pytest.mark.parametrize("speed", [0.005, 0.5])
def test_a_straight_slide_stops_as_friction_of_its_speed_says(law, speed, equations):
    """Time and way are the integrals of dv / (mu g) and v dv / (mu g); the time in closed form."""
    rise = law.fast - law.slow
    time = np.log((law.fast * np.exp(law.rate * speed) - rise) / law.slow) / (law.rate * law.fast * GRAVITY)
    way, _ = quad(lambda v: v / ((law.fast - rise * np.exp(-law.rate * v)) * GRAVITY), 0.0, speed, epsabs=0.0)
    scene = with_law(chain(FLAT, 0.1, amplitudes=STILL, duration=2.0 * time), law)
    along = np.array([0.6, -0.8])
    run = reference.trajectory(
        scene, (0.0, 0.0), equations, tolerance=TOLERANCE, initial=State(np.zeros((1, 2)), speed * along[None])
    )
    assert run.status == "ok"
    (begin, end), = run.stick  # fmt: skip
    assert begin == pytest.approx(time, rel=10 * TOLERANCE)
    assert end == scene.duration
    np.testing.assert_allclose(run.position[-1, 0, :2], way * along, rtol=10 * TOLERANCE)


@BOTH
def test_a_force_between_frictions_makes_a_terminal_speed(equations):
    """v' = F - mu(v) g from rest has the solution exp(rate v) = w + (1 - w) exp(-r t), w that of the terminal speed."""
    law, force = DryFriction(0.03, 0.06, 50.0), 0.05 * GRAVITY
    scene = with_law(chain(FLAT, 0.1, amplitudes=((-force, 0.0), (0.0, 0.0)), **STEADY, duration=2.0), law)
    rate = law.rate * (law.fast * GRAVITY - force)
    terminal = (law.fast - law.slow) * GRAVITY / (law.fast * GRAVITY - force)
    run = reference.trajectory(scene, (0.0, 0.0), equations, tolerance=TOLERANCE)
    speed = np.log(terminal + (1.0 - terminal) * np.exp(-rate * run.time)) / law.rate
    assert run.stick == []
    np.testing.assert_allclose(run.velocity[:, 0, 0], speed, atol=10 * TOLERANCE * speed[-1])
    assert speed[-1] == pytest.approx(np.log(terminal) / law.rate, rel=1e-3)
    held = reference.trajectory(scene.with_values({"isolator.friction": 0.06}), (0.0, 0.0), equations)
    assert held.stick == [(0.0, 2.0)]


@BOTH
@pytest.mark.parametrize("slow", [0.03, 0.12])
def test_circular_shaking_feels_friction_of_its_speed(equations, slow):
    """The closed form for constant friction holds with mu(omega r), whose radius r it gives."""
    law, period, acceleration = DryFriction(slow, 0.08, 4.0), 0.7, 3.0
    frequency = 2.0 * np.pi / period
    links = ([300.0, 300.0], [120.0, 120.0])
    scene = chain(
        0.3, 0.08, masses=(2.0, 1.0, 0.7), stiffness=links, periods=(period, period), decay=(0.0, 0.0),
        amplitudes=((acceleration, 0.0), (0.0, acceleration)), duration=2.0,
    )  # fmt: skip

    def circle(friction: float):
        return circular_shaking(with_law(scene, friction), acceleration, frequency, equations)

    def radius(friction: float) -> float:
        return float(abs(circle(friction).amplitude[0]))

    friction = brentq(lambda mu: law.at(frequency * radius(mu)) - mu, *sorted((law.slow, law.fast)), xtol=1e-15)
    assert min(law.slow, law.fast) < 0.98 * friction < 0.98**2 * law.largest, "neither coefficient would do"
    motion = circle(friction)
    place, turn = motion.amplitude, 1j * frequency
    initial = State(
        np.column_stack([place.real, place.imag]), np.column_stack([(turn * place).real, (turn * place).imag])
    )
    run = reference.trajectory(
        with_law(scene, law), (0.0, -np.pi / 2.0), equations, tolerance=TOLERANCE, initial=initial,
        times=np.linspace(0.0, scene.duration, 101),
    )  # fmt: skip
    assert run.status == "ok"
    circling = place * np.exp(turn * run.time)[:, None]
    expected = np.stack([circling.real, circling.imag], axis=-1)
    np.testing.assert_allclose(run.position[..., :2], expected, atol=1e3 * TOLERANCE * abs(place[0]))


# limits --------------------------------------------------------------------------------------------------------------


def answers(rates: list[float], law: dict[str, float], tolerance: float = 1e-9, **asked) -> np.ndarray:
    """mu (R, N) at the first phase pair."""
    scene = load_scene("fig3-I").with_values({"duration": 5.0})
    found = [
        reference.amplification(with_law(scene, {**law, "rate": rate}), PHASES[:1], tolerance=tolerance, **asked)
        for rate in rates
    ]
    assert {str(answer.status[0]) for answer in found} == {"ok"}
    return np.array([answer.mu[0] for answer in found])


def plain(friction: float, tolerance: float = 1e-9, **asked) -> np.ndarray:
    scene = load_scene("fig3-I").with_values({"duration": 5.0, "isolator.friction": friction})
    return reference.amplification(scene, PHASES[:1], tolerance=tolerance, **asked).mu[0]


def slopes(rates: list[float], gap: np.ndarray) -> np.ndarray:
    return np.diff(np.log(np.abs(gap)), axis=0) / np.diff(np.log(rates))[:, None]


READINGS = pytest.mark.parametrize("asked", [{}, {"cutoff": 1e-3}, {"regularization": 1e-3}], ids=str)


@READINGS
@pytest.mark.parametrize("law", [RISING, FALLING], ids=["rising", "falling"])
def test_as_the_rate_vanishes_friction_tends_to_the_slow_one(law, asked):
    rates = [1e-2, 1e-3, 1e-4]
    gap = answers(rates, law, **asked) - plain(law["slow"], **asked)
    np.testing.assert_allclose(slopes(rates, gap)[-1], 1.0, atol=0.01)


# what a scene does not require ---------------------------------------------------------------------------------------


def test_what_friction_forbids_the_larger_coefficient_forbids():
    body = {"mass": 1.0, "height": 0.0, "size": [2.0, 2.0, 0.2]}
    alone = load_scene("fig3-I").with_values({"bodies": [body], "isolator.ring": 0.12})
    assert untilted(with_law(alone, 0.1))
    assert not untilted(with_law(alone, 0.15))
    for slow, fast in ((0.1, 0.4), (0.4, 0.1)):
        law = {"slow": slow, "fast": fast, "rate": 10.0}
        assert not untilted(with_law(alone, law))
        assert not no_friction(with_law(alone, law))
        assert not linear(with_law(alone, law))
    assert not no_friction(with_law(alone, {"slow": 0.1, "fast": 0.0, "rate": 10.0}))
