"""Friction that depends on velocity or load against closed forms; `oracle_values.json` has more."""

import numpy as np
import pytest
from chains import chain
from scipy.integrate import quad

import reference
from reference.problem import GRAVITY, DryFriction, Scene, State, load_scene

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


def with_law(scene: Scene, law: DryFriction | dict[str, float] | float) -> Scene:
    table = {"slow": law.slow, "fast": law.fast, "rate": law.rate} if isinstance(law, DryFriction) else law
    return scene.with_values({"isolator.friction": table})


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


SCENE = load_scene("fig3-I").with_values({"duration": 4.0})
PHASES = [(0.3, 1.1), (2.0, 0.7)]


def factors(friction: object, **asked: object) -> np.ndarray:
    answer = reference.amplification(SCENE.with_values({"isolator.friction": friction}), PHASES, **asked)
    assert set(answer.status) == {"ok"}
    return answer.mu


def test_a_coefficient_depends_on_speed_and_load_as_stated():
    """fast - (fast - slow) exp(-rate v), times a power of the load, which counts from a millionth of the weight on."""
    law, cold = DryFriction(0.03, 0.06, 100.0, exponent=-0.5), 0.06 - 0.03 * np.exp(-1.0)
    np.testing.assert_allclose(law.at(0.01, [1.0, 4.0, 0.0]), cold * np.array([1.0, 0.5, 1000.0]))
    assert (law.varies, law.constant, law.depends_on_load) == (True, False, True)


def test_an_exponent_of_zero_gives_the_bits_of_plain_friction():
    np.testing.assert_array_equal(factors({"slow": 0.1, "load_exponent": 0.0}), factors(0.1))


def test_small_equations_have_the_friction_of_their_constant_load():
    load = {"slow": 0.1, "load_exponent": 0.5, "reference_load": SCENE.total_mass * GRAVITY / 0.64}
    small = {"equations": "small", "tolerance": 1e-8}
    np.testing.assert_allclose(factors(load, **small), factors(0.08, **small), rtol=3e-8)
