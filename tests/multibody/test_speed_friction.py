"""Friction that depends on the velocity in the engine: closed forms and order; test_like_for_like.py has more."""

import numpy as np
import pytest
from scenes_at_hand import CONSTANT, changed, one_body

import multibody
import reference
from multibody.integration.constant_step import silence
from multibody.integration.one_run import PhasePair
from multibody.models.assembly import assemble
from reference.problem import GRAVITY, DryFriction, State, load_scene

V_REG = 1e-3
FLAT = 1e6  # m, radius of a cap that is nearly flat


@pytest.mark.parametrize(
    "law", [DryFriction(0.03, 0.08, 10.0), DryFriction(0.08, 0.03, 10.0)], ids=["rising", "falling"]
)
def test_a_straight_slide_slows_down_as_its_friction_says(law: DryFriction) -> None:
    """The time from one speed to another is the integral of dv / (mu g), in closed form."""
    speed, rise = 0.5, law.fast - law.slow
    table = {"slow": law.slow, "fast": law.fast, "rate": law.rate}
    scene = changed(one_body(radius=FLAT, duration=0.6), isolator={"friction": table})
    start = State(np.zeros((1, 2)), np.array([[speed, 0.0]]))
    motion = multibody.trajectory(scene, (0.0, 0.0), initial=start, tolerance=1e-4)
    v = motion.velocity[:, 0, 0]

    def passed(speeds: np.ndarray) -> np.ndarray:
        return np.log(law.fast * np.exp(law.rate * speeds) - rise) / (law.rate * law.fast * GRAVITY)

    sliding = v > 0.05
    assert v[sliding].min() < 0.4
    np.testing.assert_allclose(passed(np.array(speed)) - passed(v[sliding]), motion.time[sliding], atol=2e-4)


def test_a_motion_that_begins_moving_heats_from_its_start() -> None:
    heating = {"contact_radius": 0.06, "conductivity": 0.02, "diffusivity": 1e-3}
    scene = changed(one_body(radius=np.inf, duration=0.05), isolator={"friction": {"slow": 0.1, "heating": heating}})
    start = State(np.zeros((1, 2)), np.array([[1.0, 0.0]]))
    motion = multibody.trajectory(scene, (0.0, 0.0), initial=start)
    other = reference.trajectory(scene, (0.0, 0.0), regularization=1e-3, initial=start, times=motion.time)
    accelerations, expected = (each.absolute_acceleration[:, 0, 0] for each in (motion, other))
    np.testing.assert_allclose(accelerations, expected, atol=2e-5)
    assert np.ptp(expected) > 0.02


def test_a_force_between_frictions_makes_a_steady_creep() -> None:
    law, force = {"slow": 0.05, "fast": 0.1, "rate": 100.0}, 0.08 * GRAVITY
    scene = one_body(radius=FLAT, duration=0.5, amplitudes=[[-force, 0.0], [0.0, 0.0]], periods=(CONSTANT, CONSTANT))
    motion = multibody.trajectory(changed(scene, isolator={"friction": law}), (0.0, 0.0), tolerance=1e-4)
    share = (law["fast"] - force / GRAVITY) / (law["fast"] - law["slow"])
    assert motion.velocity[-1, 0, 0] == pytest.approx(-np.log(share) / law["rate"], rel=1e-4)


def test_a_change_of_the_coefficient_acts_back_on_the_slip() -> None:
    """The slope of mu by the slip speed times the weight over the platform's mass, in units of the model."""
    law = DryFriction(0.03, 0.1, 20.0)
    table = {"isolator.friction": {"slow": law.slow, "fast": law.fast, "rate": law.rate}}
    scene = load_scene("fig3-I").with_values({**table, "bodies.1.mass": 3.0})
    model = assemble(scene, "translational", V_REG)
    assert model.friction is not None
    slip, unit = np.array([[0.02], [0.1]]), model.units.velocity
    slope = (law.at(slip[:, 0] + 1e-6) - law.at(slip[:, 0] - 1e-6)) / 2e-6 * unit
    np.testing.assert_allclose(model.friction.feedback(slip / unit), 4.0 * slope, rtol=1e-6)


def test_the_error_falls_with_the_square_of_the_step() -> None:
    """At constant step, down a slide: the coefficient of a step is that of a speed extrapolated from the last two."""
    speed, duration, law = 0.15, 0.2, DryFriction(0.03, 0.1, 20.0)
    table = {"slow": law.slow, "fast": law.fast, "rate": law.rate}
    scene = changed(one_body(radius=FLAT, duration=duration), isolator={"friction": table})
    rise, growth = law.fast - law.slow, np.exp(law.rate * speed)
    decayed = rise + (law.fast * growth - rise) * np.exp(-law.rate * law.fast * GRAVITY * duration)
    exact = np.log(decayed / law.fast) / law.rate
    built = assemble(scene, "translational", V_REG, contact_force=True)
    pair = PhasePair(scene, built, np.zeros(2), State(np.zeros((1, 2)), np.array([[speed, 0.0]])))
    errors = []
    with silence():
        for count in (25, 50, 100, 200):
            run = pair.at_constant_step(count, 1e-8, 1e-7, 1e-11, "generalized alpha", None)
            errors.append(float(run.chunks[-1].velocities[-1, 0]) * built.units.velocity - exact)
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 2.0, atol=0.1)
