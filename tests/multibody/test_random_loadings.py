"""Whatever the loading, no value of the engine is called ok that the equations with the same law contradict."""

import numpy as np
import pytest
from random_loadings import Case, random_case
from scenes_at_hand import changed

import multibody
import reference
from multibody.integration.estimate import from_levels
from multibody.integration.peak import Peaks
from multibody.models.assembly import assemble
from reference.problem import Outcome, load_scene

WEAKEST, STRONGEST = 1e-15, 1e3  # m/s^2
MAX_WORK = 6e4  # of a point: longer ones are refused
BRIEF = load_scene("fig4-viscous").with_values({"duration": 0.01})
THREE_SECONDS = load_scene("fig3-I").with_values({"duration": 3.0})
NAMED = {
    **{f"fig4-viscous, {size:g}": Case(BRIEF.with_amplitude(size), (0.3, 1.1), None, 1e-3) for size in (1e-12, 1e-9)},
    "fig4-viscous, 3e-07": Case(BRIEF.with_amplitude(3e-7), (0.3, 1.1), None, 1e-2),
    "fig3-I, 1e-14": Case(THREE_SECONDS.with_amplitude(1e-14), (0.3, 1.1), 1e-3, 1e-2),
    "fig3-I, 1e-13": Case(THREE_SECONDS.with_amplitude(1e-13), (0.3, 1.1), 1e-3, 1e-2),
    "fig4-viscous, 1e-120": Case(BRIEF.with_amplitude(1e-120), (0.3, 1.1), None, 1e-2),
}


def assert_not_contradicted(case: Case, max_work: float = MAX_WORK) -> bool:
    """Whether the engine has an answer, whose error and status hold."""
    scene, phase, v_reg, tolerance = case
    engine = multibody.amplification(scene, [phase], regularization=v_reg, tolerance=tolerance, max_work=max_work)
    if np.isnan(engine.mu).any():
        assert engine.status[0] not in (Outcome.OK, Outcome.TOLERANCE_NOT_MET)
        return False
    within = bool((engine.error <= tolerance * engine.mu).all())
    assert engine.status[0] == (Outcome.OK if within else Outcome.TOLERANCE_NOT_MET)
    equations = reference.amplification(scene, [phase], equations="exact", regularization=v_reg)
    beyond = np.abs(engine.mu - equations.mu) / (engine.error + equations.error)
    assert (beyond <= 1.0).all(), (scene.model_dump_json(), case[1:], engine.mu, engine.error, equations.mu)
    return True


@pytest.mark.parametrize("name", NAMED)
def test_a_loading_that_rounding_drowns_has_an_error_that_covers(name: str) -> None:
    assert assert_not_contradicted(NAMED[name])
    scene, phase, v_reg, tolerance = NAMED[name]
    engine = multibody.amplification(scene, [phase], regularization=v_reg, tolerance=tolerance)
    assert engine.status[0] == Outcome.TOLERANCE_NOT_MET


@pytest.mark.parametrize("first", range(0, 20, 10))
def test_no_random_value_is_contradicted_by_the_equations(first: int) -> None:
    answered = [assert_not_contradicted(random_case(seed, WEAKEST, STRONGEST)) for seed in range(first, first + 10)]
    assert sum(answered) >= 5


@pytest.mark.long
@pytest.mark.parametrize("first", range(1000, 1300, 100))
def test_no_value_of_300_scenes_is_contradicted(first: int) -> None:
    answered = [assert_not_contradicted(random_case(seed, WEAKEST, STRONGEST)) for seed in range(first, first + 100)]
    assert sum(answered) >= 60


@pytest.mark.parametrize("mass", [3.0, 0.1])
def test_a_flat_slider_without_iterations_has_its_error(mass: float) -> None:
    """Steps whose forces change by less than the residual are taken as they are: 0.6 % at 5e-9 m/s^2, in all runs."""
    for seed in range(30):
        case = random_case(seed, 1e-11, 1e-8, 0.01, 0.1)
        flat = case.scene.with_values({"isolator.friction": 0.1, "isolator.lubrication": None})
        flat = changed(flat, isolator={"radius": np.inf}).with_values({"bodies.0.mass": mass})
        assert_not_contradicted(Case(flat, case.phase, 1e-3, case.tolerance))


def test_the_error_of_reading_is_part_of_the_error() -> None:
    model, levels = assemble(THREE_SECONDS, "translational", 1e-3), multibody.levels(THREE_SECONDS)[:2]
    peaks = [Peaks(1, 1e-3) for _ in levels]
    for each in peaks:
        each.value[:] = 1.0
    without = from_levels(peaks, levels, model)
    peaks[-1].sampling[:] = 0.01
    np.testing.assert_allclose(from_levels(peaks, levels, model) - without, 0.01, rtol=1e-9)


@pytest.mark.parametrize("size", [1e-6, 1e-15])
def test_a_platform_that_only_creeps_is_a_lubricated_one(size: float) -> None:
    scene = THREE_SECONDS.with_values({"duration": 1.0})
    viscous = scene.with_values({"isolator.friction": None, "isolator.lubrication": scene.friction_coefficient / 1e-3})
    found = reference.amplification(scene.with_amplitude(size), [(0.3, 1.1)], "exact", 1e-3)
    expected = reference.amplification(viscous.with_amplitude(1e-6), [(0.3, 1.1)], "exact")
    np.testing.assert_allclose(found.mu, expected.mu, rtol=2e-5)


@pytest.mark.parametrize("max_work", [2e4, 3e3])  # with the other one levels end before
@pytest.mark.parametrize("seed", [28, 40, 62, 65, 94])
def test_an_answer_before_rounding_takes_over_is_not_ok(seed: int, max_work: float) -> None:
    for strongest, v_reg in ((1e-1, 1e-5), (1e-2, 1e-4)):
        scene, phase, _, _ = random_case(seed, strongest * (1e-2 if v_reg == 1e-5 else 1e-3), strongest, 1e-2, 1.0)
        assert_not_contradicted(Case(scene, phase, v_reg, 1e-4), max_work)
