"""Energy that friction dissipates: closed forms, the friction law itself, and the balance with the ground's work."""

from functools import partial

import numpy as np
import pytest
from chains import chain

import multibody
import reference
from reference.measures import demands
from reference.problem import GRAVITY, State

PHASE = (2.0, 0.7)
RHO = 0.25
V_REG = 1e-3


@pytest.mark.parametrize("isolator", [{"friction": 0.05}, {"lubrication": 0.4}, {"friction": 0.0}, {"friction": 3.0}])
def test_friction_takes_what_gravity_loses(isolator) -> None:
    """
    m g (z at the start - z at the end), the latter where the platform rests or has come to hardly any speed.

    Nothing without friction, and nothing where friction holds the platform.
    """
    duration = 30.0 if "lubrication" in isolator else 8.0
    scene = chain(RHO, masses=[3.0], amplitudes=[[0.0, 0.0], [0.0, 0.0]], duration=duration, **isolator)
    motion = reference.trajectory(scene, PHASE, initial=State(np.array([[0.5 * RHO, 0.0]]), np.zeros((1, 2))))
    answer = demands(motion)
    before, left = (RHO - np.sqrt(RHO**2 - place @ place) for place in motion.position[[0, -1], 0, :2])
    expected = 3.0 * GRAVITY * (before - left) if isolator != {"friction": 0.0} else 0.0
    assert abs(answer.friction_energy.value - expected) <= answer.friction_energy.error + 1e-9
    assert answer.friction_energy.error < max(1e-3 * expected, 1e-6)
    assert (expected == 0.0) == (isolator.get("friction") in (0.0, 3.0))


VERTICAL = {"excitation.amplitudes": [[1.0, 0.0], [0.0, 1.0], [2.0, 2.0]]}
VARYING = {"isolator.friction": {"slow": 0.05, "fast": 0.12, "rate": 30.0}, "duration": 8.0, "bodies.1.mass": 0.6}
RUNS = [("fig3-I", {}, None), ("fig3-II", {}, V_REG), ("fig4-viscous", {}, None), ("fig3-I", VERTICAL, None)]
BALANCES = [(*run, partial(reference.trajectory, equations=name)) for run in RUNS for name in ("exact", "small")]
BALANCES += [("fig3-I", VARYING, V_REG, side.trajectory) for side in (reference, multibody)]


@pytest.mark.parametrize(
    ("name", "values", "v_reg", "trajectory"), [*BALANCES, ("fig3-I", {}, V_REG, multibody.trajectory)]
)
def test_energy_is_balanced_within_the_error(name, values, v_reg, trajectory) -> None:
    """By the engine: measured at the contact, and from kinetic, elastic and gravity energy."""
    scene = reference.load_scene(name).with_values({"bodies.1.mass": 1.7, **values})
    answer = demands(trajectory(scene, PHASE, regularization=v_reg))
    limit = 3e-3 if values or trajectory is multibody.trajectory else 2e-4
    assert answer.energy_balance is not None
    assert abs(answer.energy_balance.value) <= answer.energy_balance.error < limit * answer.friction_energy.value


@pytest.mark.parametrize(("name", "regularization"), [("fig3-I", None), ("fig3-I", V_REG), ("fig4-viscous", None)])
def test_friction_power_is_the_law_times_normal_force_and_speed(name, regularization) -> None:
    scene = reference.load_scene(name).with_values({"bodies.1.mass": 1.7})
    motion = reference.trajectory(scene, PHASE, regularization=regularization)
    speed = np.linalg.norm(motion.velocity[:, 0], axis=1)
    law = speed if scene.lubricated else np.minimum(1.0, speed / (regularization or 1e-300))
    expected = scene.friction_coefficient * law * motion.contact_force * speed
    np.testing.assert_allclose(motion.friction_power, expected, atol=2e-5 * expected.max())
