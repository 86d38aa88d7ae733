"""Dampers in the links: the engine like for like with the exact equations, closed forms, no moments left over."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scenes_at_hand import frame

import multibody
import reference
from multibody.models.assembly import assemble
from reference.problem import Outcome, Scene, State, load_scene

PHASES = [(0.3, 1.1), (2.0, 0.7)]
V_REG = 1e-3


def damped(scene: Scene, damping: float | list[float], **values: Any) -> Scene:
    return scene.with_values({f"bodies.{i}.damping": damping for i in range(1, len(scene.bodies))} | values)


def share_of_errors(scene: Scene, phases: Any, v_reg: float | None = V_REG) -> tuple[float, set[str]]:
    """Largest difference of the two sides over the sum of their errors, and the engine's outcomes."""
    engine = multibody.amplification(scene, phases, regularization=v_reg)
    equations = reference.amplification(scene, phases, equations="exact", regularization=v_reg)
    assert set(equations.status) == {Outcome.OK}
    share = np.abs(engine.mu - equations.mu) / (engine.error + equations.error)
    return float(share.max()), set(engine.status)


@pytest.mark.parametrize("damping", [0.02, [2.0, 0.5], 5.0], ids=["2 %", "unequal axes", "zeta 5"])
@pytest.mark.parametrize(("name", "v_reg"), [("fig3-I", V_REG), ("fig4-viscous", None)])
def test_every_factor_lies_within_its_error_of_the_exact_equations(
    name: str, v_reg: float | None, damping: float | list[float]
) -> None:
    share, outcomes = share_of_errors(damped(load_scene(name), damping, duration=4.0), PHASES, v_reg)
    assert outcomes == {Outcome.OK}
    assert share <= 1.0


@pytest.mark.long
@pytest.mark.parametrize("damping", [0.02, 0.05, [3.0, 0.3], 1.0, 5.0], ids=str)
@pytest.mark.parametrize("name", ["fig3-I", "fig3-II", "fig4-dry", "frame"])
def test_64_phases_lie_within_their_errors(name: str, damping: float | list[float]) -> None:
    scene = frame(6.0, 6, 0.5) if name == "frame" else load_scene(name)
    if name == "frame" and isinstance(damping, list):
        damping = [1e3 * part for part in damping]
    phases = np.random.default_rng(7).uniform(0.0, 2.0 * np.pi, (64, 2))
    share, outcomes = share_of_errors(damped(scene, damping), phases)
    print(f"\n{name}, damping {damping}: largest difference over the errors {share:.2f}")
    assert outcomes == {Outcome.OK}
    assert share <= 1.0


@pytest.mark.parametrize("model", ["translational", "spatial"])
def test_damping_of_zero_is_no_damping_to_the_last_bit(model: str) -> None:
    scene = load_scene("fig3-I").with_values({"duration": 1.5})
    without, zero = (
        multibody.amplification(each, PHASES[:1], model, tolerance=1e-2) for each in (scene, damped(scene, 0.0))
    )
    np.testing.assert_array_equal(zero.mu, without.mu)
    np.testing.assert_array_equal(zero.error, without.error)


def test_factors_tend_to_those_without_damping_with_slope_one() -> None:
    """At one level, where steps are the same: differences are those of the motion."""
    scene = load_scene("fig3-I").with_values({"duration": 3.0})
    level = multibody.levels(scene)[3]
    without, weak, weaker = (
        multibody.single_run(damped(scene, zeta), PHASES[1], level=level).peak[1] for zeta in (0.0, 1e-2, 1e-3)
    )
    assert np.log10((without - weak) / (without - weaker)) == pytest.approx(1.0, abs=0.05)


@pytest.mark.parametrize("zeta", [0.05, 1.0, 3.0])
def test_a_damped_body_on_a_held_platform_decays_as_its_closed_form(zeta: float) -> None:
    w, amplitude = 2.0 * np.pi / 1.5, 0.02
    still = {"isolator.friction": 5.0, "excitation.amplitudes": [[1e-9, 0.0], [0.0, 0.0]], "duration": 1.5}
    scene = damped(load_scene("fig3-I"), zeta, **still)
    released = State(np.array([[0.0, 0.0], [amplitude, 0.0]]), np.zeros((2, 2)))
    motion = multibody.trajectory(scene, PHASES[0], initial=released)
    root = np.emath.sqrt(zeta**2 - 1.0) if zeta != 1.0 else 1e-9
    one, other = w * (-zeta + root), w * (-zeta - root)
    expected = ((one * np.exp(other * motion.time) - other * np.exp(one * motion.time)) / (one - other)).real
    np.testing.assert_allclose(motion.position[:, 1, 0], amplitude * expected, atol=2e-4 * amplitude)


def test_upright_bodies_of_the_spatial_model_follow_the_exact_equations() -> None:
    """Bodies at one height in a plane, wide supports: what turns them is small, and so is the difference."""
    low = {"bodies.0.height": 0.0, "bodies.1.height": 0.0, "isolator.ring": 50.0, "duration": 2.0}
    scene = damped(load_scene("fig3-I"), 0.3, **low, **{"bodies.0.size": [90.0, 90.0, 0.1]})
    engine = multibody.amplification(scene, PHASES[:1], "spatial", tolerance=3e-3)
    equations = reference.amplification(scene, PHASES[:1], regularization=V_REG)
    np.testing.assert_allclose(engine.mu, equations.mu, rtol=6e-3)
    undamped = reference.amplification(damped(scene, 0.0), PHASES[:1], regularization=V_REG)
    assert (np.abs(undamped.mu - equations.mu) > 0.05 * equations.mu).any()


def test_dampers_of_the_spatial_model_take_energy_and_leave_base_shear_to_the_isolator() -> None:
    """The only horizontal force on all bodies together is that of the supports, friction plus restoring force."""
    scene = damped(load_scene("fig3-I"), 0.2, duration=2.0)
    motion = multibody.single_run(scene, PHASES[0], "spatial", step=1e-3)
    bare = multibody.single_run(damped(scene, 0.0), PHASES[0], "spatial", step=1e-3)
    drift = [np.hypot(*(run.position[:, 1, :2] - run.position[:, 0, :2]).T)[-500:].max() for run in (motion, bare)]
    assert drift[0] < 0.6 * drift[1]
    limit = motion.contact_force * (0.1 + 1.2 * np.hypot(*motion.position[:, 0, :2].T) / scene.radius) * 1.05
    assert (np.hypot(*motion.isolator_force.T) <= limit).all()


def test_the_links_of_the_spatial_model_have_the_scene_s_damping_in_shear_alone() -> None:
    scene = damped(load_scene("fig3-I"), [0.4, 0.7])
    model, bare = (assemble(each, "spatial", V_REG) for each in (scene, damped(scene, 0.0)))
    diagonals = []
    for each in (model, bare):
        each.set_contact(1e-6)
        found = [each.mbs.GetObject(k) for k in range(each.mbs.systemData.NumberOfObjects())]
        diagonals.append(np.diag(next(item for item in found if "SpringDamper" in item["objectType"])["damping"]))
    expected = scene.damping[0] * model.units.time / model.units.mass
    np.testing.assert_allclose(diagonals[0][:2], expected, rtol=1e-14)
    np.testing.assert_array_equal(diagonals[0][2:], diagonals[1][2:])
    assert not diagonals[1][[0, 1, 5]].any()
