"""Friction that depends on the velocity in the engine: closed forms, the exact equations, order, both models."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scenes_at_hand import CONSTANT, changed, one_body

import multibody
import reference
from multibody.integration.constant_step import silence
from multibody.integration.one_run import PhasePair
from multibody.models.assembly import assemble
from reference.problem import GRAVITY, DryFriction, Outcome, Scene, State, load_scene

V_REG = 1e-3
FLAT = 1e6  # m, radius of a cap that is nearly flat
RISING = {"slow": 0.05, "fast": 0.1, "rate": 100.0}
FALLING = {"slow": 0.1, "fast": 0.05, "rate": 100.0}
BOTH_LAWS = pytest.mark.parametrize("law", [RISING, FALLING], ids=["rising", "falling"])
PHASES = np.array([(0.3, 1.1), (2.0, 0.7), (0.867, 4.951), (4.0, 5.5)])


def paper_scene(law: object, name: str = "fig3-I", **values: object) -> Scene:
    return load_scene(name).with_values({"isolator.friction": law, **values})


def within_errors(scene: Scene, phases: np.ndarray, tolerance: float = 1e-3) -> float:
    """Largest difference of engine and exact equations over the sum of their errors."""
    engine = multibody.amplification(scene, phases, regularization=V_REG, tolerance=tolerance)
    equations = reference.amplification(scene, phases, equations="exact", regularization=V_REG)
    assert set(engine.status) == set(equations.status) == {Outcome.OK}
    assert (engine.error <= tolerance * engine.mu).all()
    return float((np.abs(engine.mu - equations.mu) / (engine.error + equations.error)).max())


@BOTH_LAWS
def test_four_points_lie_within_their_errors(law: dict[str, float]) -> None:
    assert within_errors(paper_scene(law, duration=6.0), PHASES) <= 1.0


TOGETHER = {
    "flat slider": {"isolator.period": None, "isolator.radius": math.inf},
    "damped links": {"bodies.1.damping": 0.05},
    "vertical loading": {"excitation.amplitudes": [[1.0, 0.0], [0.0, 1.0], [2.0, 1.0]]},
    "one axis": {"excitation.amplitudes": [[1.0, 0.6], [0.0, 0.0]]},
}


@pytest.mark.parametrize("values", TOGETHER.values(), ids=TOGETHER.keys())
def test_it_goes_together_with_other_keys_of_a_scene(values: dict[str, object]) -> None:
    assert within_errors(paper_scene(RISING, duration=3.0, **values), PHASES[:1]) <= 1.0


def test_it_goes_together_with_a_record() -> None:
    assert within_errors(paper_scene(FALLING, "synthetic-pair", duration=3.0), PHASES[:1]) <= 1.0


@pytest.mark.long
@BOTH_LAWS
@pytest.mark.parametrize("name", ["fig3-I", "fig3-II", "fig4-dry"])
def test_a_surface_lies_within_its_errors_of_the_exact_equations(name: str, law: dict[str, float]) -> None:
    phases = np.random.default_rng(7).uniform(0.0, 2.0 * np.pi, (64, 2))
    share = within_errors(paper_scene(law, name), phases)
    print(f"\n{name}: {len(phases)} points, largest difference over the errors {share:.2f}")
    assert share <= 1.0


@pytest.mark.long
@pytest.mark.parametrize("rate", [1.0, 10.0, 1e3, 1e4, 1e6])
@pytest.mark.parametrize(("slow", "fast"), [(0.03, 0.1), (0.1, 0.03)])
def test_points_of_every_rate_lie_within_their_errors(rate: float, slow: float, fast: float) -> None:
    phases = np.random.default_rng(8).uniform(0.0, 2.0 * np.pi, (16, 2))
    share = within_errors(paper_scene({"slow": slow, "fast": fast, "rate": rate}, duration=8.0), phases)
    print(f"\nrate {rate:g}, {slow:g} to {fast:g}: largest difference over the errors {share:.2f}")
    assert share <= 1.0


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


def test_a_force_between_frictions_makes_a_steady_creep() -> None:
    law, force = RISING, 0.08 * GRAVITY
    scene = one_body(radius=FLAT, duration=0.5, amplitudes=[[-force, 0.0], [0.0, 0.0]], periods=(CONSTANT, CONSTANT))
    motion = multibody.trajectory(changed(scene, isolator={"friction": law}), (0.0, 0.0), tolerance=1e-4)
    share = (law["fast"] - force / GRAVITY) / (law["fast"] - law["slow"])
    assert motion.velocity[-1, 0, 0] == pytest.approx(-np.log(share) / law["rate"], rel=1e-4)


@BOTH_LAWS
def test_every_contact_has_the_friction_of_its_own_speed(law: dict[str, float]) -> None:
    """A body level with the depressions does not turn: the spatial model has the motion of the translational one."""
    body = {"mass": 1.0, "height": 0.0, "size": [2.0, 2.0, 0.2]}
    scene = changed(paper_scene(law, duration=2.0), bodies=[body])
    spatial, translational = (
        multibody.amplification(scene, PHASES[:1], model=model, full=True) for model in ("spatial", "translational")
    )
    assert spatial.status.tolist() == [Outcome.OK]
    assert (np.abs(spatial.mu - translational.mu) <= spatial.error + translational.error).all()


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
