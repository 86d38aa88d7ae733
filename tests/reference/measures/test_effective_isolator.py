"""The effective isolator against the loop of friction and restoring force, drawn and integrated."""

import numpy as np
import pytest
from chains import refusal

import reference
from reference.problem import GRAVITY

ISOLATOR = {"radius": 2.0, "friction": {"slow": 0.09, "fast": 0.06, "rate": 100.0}}
SCENE = reference.load_scene("fig3-I").with_values({"isolator": ISOLATOR})
WEIGHT = SCENE.total_mass * GRAVITY


def test_effective_isolator_has_the_energy_of_the_loop():
    amplitude = np.array([[0.02, 0.1], [0.25, 0.4]])
    isolator = reference.effective_isolator(SCENE, amplitude)
    angle = np.linspace(0.0, 2.0 * np.pi, 40001)
    way = np.cos(angle)
    for index, largest in np.ndenumerate(amplitude):
        force = WEIGHT * (largest * way / 2.0 - 0.06 * np.sign(np.sin(angle)))
        stiffness = force.max() / largest
        energy = abs(np.trapezoid(force, largest * way))
        assert isolator.stiffness[index] == pytest.approx(stiffness, rel=1e-3)
        assert isolator.period[index] == pytest.approx(2 * np.pi * np.sqrt(SCENE.total_mass / stiffness), rel=1e-3)
        assert isolator.damping[index] == pytest.approx(energy / (2 * np.pi * stiffness * largest**2), rel=1e-3)


def test_friction_that_yields_is_elastic_up_to_there():
    yielding = SCENE.with_values({"isolator.friction.yield_displacement": 0.03})  # 0.09 W at 0.03 m, 0.06 W at 0.02 m
    isolator = reference.effective_isolator(yielding, [0.01, 0.05])
    assert isolator.stiffness == pytest.approx(WEIGHT * (0.5 + np.array([3.0, 1.2])))
    loss = 4.0 * 0.06 * WEIGHT * (0.05 - 0.02)
    assert isolator.damping == pytest.approx([0.0, loss / (2.0 * np.pi * WEIGHT * 1.7 * 0.05**2)])
    assert isolator.restoring == pytest.approx(np.array([0.01, 0.05]) / (2.0 * 0.06))


def test_platform_left_below_restoring_one_stays():
    for share, stays in ((0.9, True), (1.1, False)):
        still = SCENE.with_values({"isolator": {"radius": 2.0, "friction": 0.06}}).with_amplitude(1e-9)
        start = share * 0.06 * 2.0 / np.hypot(1.0, share * 0.06)  # exact: the slope at D, not D / rho
        assert reference.effective_isolator(still, start).restoring == pytest.approx(share, rel=3e-3)
        place = np.zeros((len(still.bodies), 2))
        place[:, 0] = start
        initial = reference.State(position=place, velocity=np.zeros_like(place))
        motion = reference.trajectory(still, (0.0, 0.0), "exact", tolerance=1e-4, initial=initial)
        assert bool(motion.stick and motion.stick[0][0] == 0.0) == stays


def test_effective_isolator_refuses_no_displacement_and_lubrication():
    for wrong in (0.0, -0.1, float("nan"), [0.1, float("inf")], [0.1, 0.0]):
        assert "must be lengths in m above 0" in str(refusal(reference.effective_isolator, SCENE, wrong))
    assert "no dry friction" in str(refusal(reference.effective_isolator, reference.load_scene("fig4-viscous"), 0.1))
