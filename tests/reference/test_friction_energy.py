"""Energy that friction dissipates: closed forms, the friction law itself, and the balance with the ground's work."""

from dataclasses import replace

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


@pytest.mark.parametrize("isolator", [{"friction": 0.05}, {"lubrication": 0.4}])
def test_friction_takes_what_gravity_loses(isolator) -> None:
    """m g (z at the start - z at the end), the latter where the platform rests or has come to hardly any speed."""
    motion = released(0.5 * RHO, 30.0 if "lubrication" in isolator else 8.0, **isolator)
    answer = demands(motion)
    left = height(float(np.hypot(*motion.position[-1, 0, :2])))
    expected = 3.0 * GRAVITY * (height(0.5 * RHO) - left)
    assert abs(answer.friction_energy.value - expected) <= answer.friction_energy.error
    assert answer.friction_energy.error < 1e-3 * expected


def test_without_friction_or_motion_nothing_is_dissipated() -> None:
    smooth = demands(released(0.5 * RHO, friction=0.0))
    assert smooth.friction_energy.value == pytest.approx(0.0, abs=1e-9)
    held = demands(released(0.1 * RHO, friction=0.3))
    assert held.friction_energy.value == 0.0


@pytest.mark.parametrize("equations", ["exact", "small"])
@pytest.mark.parametrize(("name", "regularization"), [("fig3-I", None), ("fig3-II", V_REG), ("fig4-viscous", None)])
def test_the_equations_balance_energy_within_the_error(name, regularization, equations) -> None:
    motion = reference.trajectory(reference.load_scene(name), PHASE, equations, regularization)
    answer = demands(motion)
    assert answer.energy_balance is not None
    assert abs(answer.energy_balance.value) <= answer.energy_balance.error < 2e-4 * answer.friction_energy.value


@pytest.mark.parametrize("equations", ["exact", "small"])
def test_vertical_loading_does_its_work_too(equations: str) -> None:
    scene = reference.load_scene("fig3-I").with_values({"excitation.amplitudes": [[1.0, 0.0], [0.0, 1.0], [2.0, 2.0]]})
    answer = demands(reference.trajectory(scene, PHASE, equations))
    assert answer.energy_balance is not None
    assert abs(answer.energy_balance.value) <= answer.energy_balance.error < 1e-3 * answer.friction_energy.value


@pytest.mark.parametrize(("name", "regularization"), [("fig3-I", None), ("fig3-I", V_REG), ("fig4-viscous", None)])
def test_friction_power_is_the_law_times_normal_force_and_speed(name, regularization) -> None:
    scene = reference.load_scene(name)
    motion = reference.trajectory(scene, PHASE, regularization=regularization)
    speed = np.linalg.norm(motion.velocity[:, 0], axis=1)
    law = speed if scene.lubricated else np.minimum(1.0, speed / (regularization or 1e-300))
    expected = scene.friction_coefficient * law * motion.contact_force * speed
    np.testing.assert_allclose(motion.friction_power, expected, atol=2e-5 * expected.max())


def test_the_engine_s_contacts_dissipate_what_its_motion_loses() -> None:
    """Measured at the contact on one hand, and by kinetic, elastic and gravity energy on the other."""
    answer = demands(multibody.trajectory(reference.load_scene("fig3-I"), PHASE))
    assert answer.energy_balance is not None
    assert abs(answer.energy_balance.value) <= answer.energy_balance.error < 2e-3 * answer.friction_energy.value


@pytest.mark.parametrize("side", ["equations", "engine"])
def test_energy_is_balanced_with_velocity_friction(side) -> None:
    law = {"isolator.friction": {"slow": 0.05, "fast": 0.12, "rate": 30.0}, "duration": 8.0}
    scene = reference.load_scene("fig3-I").with_values(law)
    trajectory = reference.trajectory if side == "equations" else multibody.trajectory
    answer = demands(trajectory(scene, PHASE, regularization=V_REG))
    assert answer.energy_balance is not None
    assert abs(answer.energy_balance.value) <= answer.energy_balance.error < 3e-3 * answer.friction_energy.value


def test_a_friction_that_takes_too_much_breaks_the_balance() -> None:
    motion = reference.trajectory(reference.load_scene("fig3-I"), PHASE)
    answer = demands(replace(motion, friction_power=1.01 * motion.friction_power))
    assert answer.energy_balance is not None
    assert abs(answer.energy_balance.value) > answer.energy_balance.error
