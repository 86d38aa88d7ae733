"""Energy that friction dissipates: closed forms, the friction law itself, and the balance with the ground's work."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from chains import chain

import multibody
import reference
from reference.measures import demands
from reference.problem import GRAVITY, State, Trajectory

PHASE = (2.0, 0.7)
RHO = 0.25
V_REG = 1e-3


def released(offset: float, duration: float = 8.0, **isolator: float) -> Trajectory:
    """One body let go at an offset on a plate at rest."""
    still = [[0.0, 0.0], [0.0, 0.0]]
    scene = chain(RHO, masses=[3.0], amplitudes=still, duration=duration, **isolator)
    state = State(position=np.array([[offset, 0.0]]), velocity=np.zeros((1, 2)))
    return reference.trajectory(scene, PHASE, initial=state)


def height(place: float) -> float:
    """Of the sphere above its lowest point, m."""
    return RHO - float(np.sqrt(RHO**2 - place**2))


@pytest.mark.parametrize("isolator", [{"friction": 0.05}, {"lubrication": 0.4}, {"friction": 0.0}, {"friction": 3.0}])
def test_friction_takes_what_gravity_loses(isolator) -> None:
    """
    m g (z at the start - z at the end), the latter where the platform rests or has come to hardly any speed.

    Nothing without friction, and nothing where friction holds the platform.
    """
    motion = released(0.5 * RHO, 30.0 if "lubrication" in isolator else 8.0, **isolator)
    answer = demands(motion)
    left = height(float(np.hypot(*motion.position[-1, 0, :2])))
    expected = 3.0 * GRAVITY * (height(0.5 * RHO) - left) if isolator != {"friction": 0.0} else 0.0
    assert abs(answer.friction_energy.value - expected) <= answer.friction_energy.error + 1e-9
    assert answer.friction_energy.error < max(1e-3 * expected, 1e-6)
    assert (expected == 0.0) == (isolator.get("friction") in (0.0, 3.0))


VERTICAL = {"excitation.amplitudes": [[1.0, 0.0], [0.0, 1.0], [2.0, 2.0]]}
VARYING = {"isolator.friction": {"slow": 0.05, "fast": 0.12, "rate": 30.0}, "duration": 8.0}
RUNS = [("fig3-I", {}, None), ("fig3-II", {}, V_REG), ("fig4-viscous", {}, None), ("fig3-I", VERTICAL, None)]
BALANCES = [(*run, partial(reference.trajectory, equations=name)) for run in RUNS for name in ("exact", "small")]
BALANCES += [("fig3-I", VARYING, V_REG, side.trajectory) for side in (reference, multibody)]


@pytest.mark.parametrize(
    ("name", "values", "v_reg", "trajectory"), [*BALANCES, ("fig3-I", {}, V_REG, multibody.trajectory)]
)
def test_energy_is_balanced_within_the_error(name, values, v_reg, trajectory) -> None:
    """By the engine: measured at the contact, and from kinetic, elastic and gravity energy."""
    scene = reference.load_scene(name).with_values(values)
    answer = demands(trajectory(scene, PHASE, regularization=v_reg))
    limit = 3e-3 if values or trajectory is multibody.trajectory else 2e-4
    assert answer.energy_balance is not None
    assert abs(answer.energy_balance.value) <= answer.energy_balance.error < limit * answer.friction_energy.value


@pytest.mark.parametrize(("name", "regularization"), [("fig3-I", None), ("fig3-I", V_REG), ("fig4-viscous", None)])
def test_friction_power_is_the_law_times_normal_force_and_speed(name, regularization) -> None:
    scene = reference.load_scene(name)
    motion = reference.trajectory(scene, PHASE, regularization=regularization)
    speed = np.linalg.norm(motion.velocity[:, 0], axis=1)
    law = speed if scene.lubricated else np.minimum(1.0, speed / (regularization or 1e-300))
    expected = scene.friction_coefficient * law * motion.contact_force * speed
    np.testing.assert_allclose(motion.friction_power, expected, atol=2e-5 * expected.max())


def test_a_friction_that_takes_too_much_breaks_the_balance() -> None:
    motion = reference.trajectory(reference.load_scene("fig3-I"), PHASE)
    answer = demands(replace(motion, friction_power=1.01 * motion.friction_power))
    assert answer.energy_balance is not None
    assert abs(answer.energy_balance.value) > answer.energy_balance.error
