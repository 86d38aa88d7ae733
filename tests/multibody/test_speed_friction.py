"""Friction that depends on the velocity in the engine: closed forms and order; test_like_for_like.py has more."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scenes_at_hand import one_body

import multibody
import reference
from multibody.integration.constant_step import silence_engine
from multibody.integration.engine_run import Budget
from multibody.integration.one_run import PhasePair
from multibody.integration.step_control import StepControl
from multibody.models.assembly import assemble
from multibody.models.speed_friction import _compute_rate_of_length
from multibody.models.state import EngineState
from multibody.models.surface_heat import SurfaceHeat
from reference.problem import GRAVITY, DryFriction, State, load_scene
from reference.problem.friction import Heat

V_REG = 1e-3


def test_a_motion_that_begins_moving_heats_from_its_start() -> None:
    heating = {"contact_radius": 0.06, "conductivity": 0.02, "diffusivity": 1e-3}
    scene = one_body(np.inf, duration=0.05).with_values({"isolator.friction": {"slow": 0.1, "heating": heating}})
    start = State(np.zeros((1, 2)), np.array([[1.0, 0.0]]))
    motion = multibody.trajectory(scene, (0.0, 0.0), initial=start)
    other = reference.trajectory(scene, (0.0, 0.0), regularization=1e-3, initial=start, times=motion.time)
    accelerations, expected = (each.absolute_acceleration[:, 0, 0] for each in (motion, other))
    np.testing.assert_allclose(accelerations, expected, atol=2e-5)
    assert np.ptp(expected) > 0.02


@pytest.mark.parametrize(
    ("begin", "end", "share"),
    [
        (0.0, 0.5, 0.6),
        (0.5, 0.0, 0.6),
        (0.2, 0.7, 0.2),
        (0.1, 0.2, 1.0),
        (0.6, 0.4, 0.0),
        (0.2, 0.2, 1.0),
        (0.4, 0.4, 0.0),
    ],
)
def test_a_step_heats_for_the_share_in_which_it_covers_the_center(begin: float, end: float, share: float) -> None:
    """Power that rises with the time for h = 0.64 s: the integral of its kernel is 4/3 P h^0.5."""
    heat, power = SurfaceHeat(Heat(15.0, 0.3, 0.6), 3, 4.0, 0.8, 2.0), np.array([5.0, 0.0, 7.0])
    heat.begin(0.0)
    heat.step_to(0.5, 0.0 * power, begin)
    np.testing.assert_allclose(
        heat.temperature(1.3, power, end), 15.0 + 3.0 * 0.3 * share * 4.0 / 3.0 * 0.8 * power, rtol=2e-3
    )


def test_the_rate_of_a_speed_is_the_part_of_the_acceleration_along_it() -> None:
    velocity, acceleration = np.array([3.0, 0.0, -4.0]), np.array([1.0, 2.0, 7.0, 9.0])
    assert _compute_rate_of_length(velocity, acceleration) == pytest.approx(-5.0)
    assert _compute_rate_of_length(0.0 * velocity, acceleration) == _compute_rate_of_length(velocity, None) == 0.0


def test_a_change_of_the_coefficient_acts_back_on_the_slip() -> None:
    """The slope of mu by the slip speed times the weight over the platform's mass, in units of the model."""
    law = DryFriction(0.03, 0.1, 20.0)
    table = {"isolator.friction": {"slow": law.slow, "fast": law.fast, "rate": law.rate}}
    scene = load_scene("fig3-I").with_values({**table, "bodies.1.mass": 3.0})
    model = assemble(scene, "translational", V_REG)
    slip, unit = np.array([0.02, 0.1, 0.3 * V_REG]), model.units.velocity
    rate = 4.0 * (law.at(slip + 1e-6) - law.at(slip - 1e-6)) / 2e-6 * unit * [1.0, 1.0, 0.3]
    for others in ([], [0.15, 0.15, 0.15]):  # of the contact with the largest rate
        slips = np.column_stack([*([others] if others else []), slip]) / unit
        np.testing.assert_allclose(model.friction.friction_feedback_rate(slips), rate, rtol=1e-6)
    calm: Any = SimpleNamespace(slip=slip[:, None] / unit, time=np.zeros(3), accelerations=np.zeros((3, 8)))
    calm.contact = -np.ones((3, 4))
    for change, bound in ((0.1, 0.2), (0.28, 0.3)):  # steps of 0.3 over the rate are the longest
        level = SimpleNamespace(slip_change=change)
        ratio = StepControl(model, level).step_ratio(calm, calm, calm, 0.7, calm)  # type: ignore[arg-type]
        np.testing.assert_allclose(ratio, 0.7 / bound * rate, rtol=1e-6)


def test_a_platform_approaches_the_center_as_in_the_last_step() -> None:
    """And heat that ran ahead of a step that is repeated is forgotten."""
    heat, power = SurfaceHeat(Heat(15.0, 0.3, 0.6), 2, 4.0, 0.8, 2.0), np.array([5.0, 2.0])
    assert (heat.begin(0.0), heat.distance(0.3)) == (False, 0.0)
    for time, way in ((1.0, 0.5), (1.4, 0.3), (2.0, 0.9)):
        heat.step_to(time, power, way)
    assert heat.begin(1.4)
    assert heat.distance(1.6) == 0.3
    heat.step_to(1.5, power, 0.25)
    assert heat.distance(1.7) == pytest.approx(0.15)
    assert not heat.begin(1.45), "between two steps"


def test_the_coefficient_is_that_of_speed_and_load_at_the_end_of_a_step() -> None:
    """By the rates of the step before; no speed is negative."""
    law = {"slow": 0.03, "fast": 0.1, "rate": 20.0, "load_exponent": -0.3}
    model = assemble(load_scene("fig3-I").with_values({"isolator.friction": law}), "translational", V_REG)
    rates = {"slip_rate": np.array([-0.5]), "load": np.array([1.3]), "load_rate": np.array([0.4])}
    state, friction = EngineState(np.zeros(8), np.zeros(8), np.array([-1.0, 0.02, 0.0, 0.0]), **rates), model.friction
    friction.begin(model.mbs, state, 0.7)
    found = friction._coefficients_without_heat(0.01) + friction._coefficients_without_heat(0.1)
    assert found == pytest.approx([friction.law.coefficient_at(0.015, 1.304), friction.law.coefficient_at(0.0, 1.34)])


def test_friction_that_depends_on_the_load_has_second_order_at_a_constant_step() -> None:
    """The load is extrapolated as the speed is: with that of the step before the order would be one."""
    law = {"slow": 0.03, "fast": 0.1, "rate": 20.0, "load_exponent": -0.3}
    amplitudes = [[1.0, 0.4], [-0.3, 1.2], [2.3, 1.9]]
    scene = load_scene("fig3-I").with_values({"duration": 1.5, "isolator.friction": law})
    scene = scene.with_values({"excitation.amplitudes": amplitudes})
    errors = []
    for step in (2e-3, 5e-4):
        motion = multibody.single_run(scene, (0.3, 1.1), step=step)
        exact = reference.trajectory(scene, (0.3, 1.1), regularization=V_REG, times=motion.time)
        errors.append(abs(motion.position[:, 0, :2] - exact.position[:, 0, :2]).max())
    assert errors[1] < errors[0] / 12.0 < 1e-6


def test_every_contact_has_the_friction_of_its_own_speed() -> None:
    law = {"slow": 0.03, "fast": 0.1, "rate": 20.0}
    scene = load_scene("fig3-I").with_values({"isolator.friction": law, "isolator.supports": 3})
    friction = assemble(scene, "spatial", V_REG).friction
    contact, slips = np.zeros(12), [0.01, 0.2, 0.05]
    contact[0::4], contact[1::4] = -1.0, slips
    assert friction._read_speeds(contact, np.ones(30)) == slips


@pytest.mark.parametrize("model", ["translational", "spatial"])
@pytest.mark.parametrize("law", [{"load_exponent": -0.3}, {"yield_displacement": 1e-3}], ids=["of load", "yielding"])
def test_contact_forces_that_nobody_asks_for_change_no_motion(model: str, law: dict[str, float]) -> None:
    scene = load_scene("fig3-I").with_values({"duration": 0.4, "isolator.friction": {"slow": 0.05, **law}})
    level, peaks = multibody.levels(scene, model)[0], []
    for contact_force in (False, True):
        pair = PhasePair(scene, assemble(scene, model, V_REG, contact_force=contact_force), np.array([0.3, 1.1]))
        peaks.append(pair.run_level(level, Budget(1e6)).peaks.value)
    np.testing.assert_array_equal(*peaks)


@pytest.mark.parametrize("name", ["constant", "rising", "lubricated", "yielding"])
def test_an_impact_has_the_friction_of_its_scene(name: str) -> None:
    """Springs transmit none, as they are soft beside contacts."""
    rising = {"slow": 0.03, "fast": 0.1, "rate": 20.0}
    frictions: Any = {"constant": 0.07, "rising": rising, "yielding": {"slow": 0.1, "yield_displacement": 1e-3}}
    scene = load_scene("fig4-viscous" if name == "lubricated" else "fig3-I").with_values({"isolator.supports": 3})
    if name != "lubricated":
        scene = scene.with_values({"isolator.friction": frictions[name]})
    model, speed = assemble(scene, "spatial", V_REG), 0.4
    law, slip = model.impact, speed / model.units.velocity
    expected = {"constant": 0.07, "rising": 0.1 - 0.07 * np.exp(-8.0), "yielding": 0.0}
    found = law.friction.at(slip) * min(slip / law.corner, 1.0)
    assert found == pytest.approx(expected.get(name, scene.friction_coefficient * speed))


@pytest.mark.parametrize(
    ("slow", "fast", "duration", "halvings"), [(0.03, 0.1, 0.2, 3), (0.1, 0.03, 0.08, 2)], ids=["rising", "falling"]
)
def test_a_slide_has_its_closed_form_and_second_order(slow: float, fast: float, duration: float, halvings: int) -> None:
    """At constant step: the coefficient of a step is that of a speed extrapolated from the last two."""
    speed, rate, rise = 0.15, 20.0, fast - slow
    law = {"slow": slow, "fast": fast, "rate": rate}
    scene = one_body(1e6, duration=duration).with_values({"isolator.friction": law})
    decayed = rise + (fast * np.exp(rate * speed) - rise) * np.exp(-rate * fast * GRAVITY * duration)
    exact = np.log(decayed / fast) / rate
    built = assemble(scene, "translational", V_REG, contact_force=True)
    pair = PhasePair(scene, built, np.zeros(2), State(np.zeros((1, 2)), np.array([[speed, 0.0]])))
    errors = []
    with silence_engine():
        for count in 25 * 2 ** np.arange(halvings + 1):
            run = pair.run_constant_step(int(count), 1e-8, 1e-7, 1e-11, "generalized alpha", None)
            errors.append(float(run.chunks[-1].velocities[-1, 0]) * built.units.velocity - exact)
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 2.0, atol=0.1)
