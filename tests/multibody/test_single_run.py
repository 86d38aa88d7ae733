"""One run at a level or at a constant step, of which `amplification` and `trajectory` are made; what it leaves."""

import gc
from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import multibody
import reference
from multibody.integration.constant_step import EngineSolver, silence_engine
from multibody.integration.engine_run import Budget
from multibody.integration.one_run import PhasePair
from multibody.models import assembly
from multibody.models.engine import exudyn, reset_when_unused
from multibody.models.translational import _matrix_container
from reference.problem import GRAVITY, Outcome, State, ground_peak, load_scene

PHASE = (0.3, 1.1)
SCENE = load_scene("fig3-I").with_values({"duration": 1.0})


@pytest.mark.parametrize("model", ["translational", "spatial"])
def test_the_run_at_the_second_level_has_the_peaks_of_the_answer(model: str) -> None:
    levels = multibody.levels(SCENE, model)
    for second, asked in ((levels[1], None), (levels[2], tuple(levels[1:]))):
        answer = multibody.amplification(SCENE, [PHASE], model, levels=asked)
        run = multibody.single_run(SCENE, PHASE, model, level=second)
        assert answer.status[0] == run.status == Outcome.OK
        np.testing.assert_array_equal(run.peak / ground_peak(SCENE, [PHASE])[0], answer.mu[0])
        assert answer.cost > 0.0


def test_a_contact_gives_way_by_the_penetration_asked_for() -> None:
    """Under a plate that is pushed up by 4 m/s^2 at the start, whether at a constant step or at a level."""
    scene = SCENE.with_values({"duration": 0.01, "excitation.amplitudes": [[0.0, 0.0], [0.0, 0.0], [4.0, 0.0]]})
    level = replace(multibody.levels(scene)[0], penetration=1e-3)
    runs = [
        multibody.single_run(scene, (0.0, 0.0), **asked)
        for asked in ({"step": 1e-4, "penetration": 1e-3}, {"level": level})
    ]
    for run in runs:
        assert run.position[0, 0, 2] == pytest.approx(-1e-3 * scene.radius * 4.0 / GRAVITY, rel=1e-6)


@pytest.mark.parametrize("limits", [{}, {"residual": 3e-7, "discontinuous": 0.2}], ids=["usual", "stated"])
def test_a_run_at_a_constant_step_has_the_tolerances_asked_for(
    limits: dict[str, float], monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[Any] = []
    monkeypatch.setattr(EngineSolver, "run", lambda solver, *_: asked.append(solver.settings.timeIntegration))
    assert multibody.single_run(SCENE, PHASE, step=1e-3, newton=2e-4, **limits).status == Outcome.SOLVER_FAILED
    pair = PhasePair(SCENE, assembly.assemble(SCENE, "translational", 1e-3), np.array(PHASE))
    pair.run_level(multibody.levels(SCENE)[0], Budget(1e5), residual=4e-7)
    found, *_, at_level = asked
    assert at_level.newton.absoluteTolerance == 4e-7
    tolerances = found.newton.relativeTolerance, found.newton.absoluteTolerance, found.discontinuous.iterationTolerance
    assert tolerances == pytest.approx((2e-4, limits.get("residual", 2e-7), limits.get("discontinuous", 2e-4)))


def test_a_constant_step_divides_a_duration_that_is_no_whole_number_of_it_but_for_rounding() -> None:
    """0.3 / 0.1 is less than 3 in binary numbers."""
    motion = multibody.single_run(SCENE.with_values({"duration": 0.3}), PHASE, step=0.1)
    assert motion.time[[1, -1]] == pytest.approx([0.1, 0.3])


@pytest.mark.parametrize("size", [40, 41, 90])
def test_the_matrices_of_a_chain_of_any_length_reach_the_engine_whole(size: int) -> None:
    """Long ones go there as their non-zero entries."""
    matrix = np.where(np.random.default_rng(3).random((size, size)) < 0.1, 1.0 + np.arange(size), 0.0)
    given = _matrix_container(matrix)
    whole = given if isinstance(given, np.ndarray) else given.Convert2DenseMatrix()
    np.testing.assert_array_equal(whole, matrix)


def test_a_run_that_cannot_end_takes_no_step(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(EngineSolver, "run", lambda *given: pytest.fail("a step was spent"))
    run = multibody.single_run(SCENE, PHASE, level=replace(multibody.levels(SCENE)[0], step=1e-9))
    assert (run.status, run.instant, len(run.time)) == (Outcome.STEP_LIMIT, 0.0, 0)


@pytest.mark.parametrize("model", ["translational", "spatial"])
def test_all_bodies_start_as_fast_upwards_as_the_platform_slides(model: str) -> None:
    place, speed = np.array([[0.03, -0.04], [0.0, 0.0]]), np.array([[0.6, 0.2], [0.1, 0.3]])
    scene = SCENE.with_values({"duration": 1e-3})
    run = multibody.single_run(scene, PHASE, model, step=1e-4, initial=State(place, speed))
    upward = (place[0] @ speed[0]) / np.sqrt(SCENE.radius**2 - 0.05**2)
    np.testing.assert_allclose(run.velocity[0], np.column_stack([speed, [upward, upward]]), rtol=1e-12)
    np.testing.assert_allclose(run.position[0, :, :2], place, rtol=1e-6)
    assert run.extra["slip_speed"][0, 0] == pytest.approx(np.hypot(np.hypot(*speed[0]), upward), rel=1e-9)


@pytest.mark.parametrize("integrator", ["generalized alpha", "trapezoidal", "RK44"])
def test_every_integrator_finds_the_motion_at_a_constant_step(integrator: str) -> None:
    run = multibody.single_run(SCENE, PHASE, step=2e-4, integrator=integrator)
    answer = multibody.amplification(SCENE, [PHASE])
    assert len(run.time) >= 5001, "the engine may halve steps, never lengthen them"
    np.testing.assert_allclose(run.peak / ground_peak(SCENE, [PHASE])[0], answer.mu[0], rtol=5e-3)


def test_of_the_implicit_integrators_the_trapezoidal_rule_alone_damps_nothing() -> None:
    """The upper body vibrates for thirty of its periods, in steps of a sixth of a period."""
    scene = load_scene("fig4-viscous").with_values({"isolator.lubrication": 0.0, "duration": 3.0})
    still = {"excitation.amplitudes": [[1e-9, 0.0], [0.0, 0.0]], "bodies.1.period": [0.1, 0.1]}
    start = State(np.array([[0.0, 0.0], [1e-4, 0.0]]), np.zeros((2, 2)))
    left = {}
    for integrator in ("generalized alpha", "trapezoidal"):
        run = multibody.single_run(scene.with_values(still), PHASE, step=0.016, integrator=integrator, initial=start)
        drift = np.diff(run.position[:, :, 0], axis=1)[:, 0]
        left[integrator] = np.ptp(drift[-15:]) / np.ptp(drift[:15])
    assert left["generalized alpha"] < 0.9
    assert left["trapezoidal"] > 0.95, "as read at six instants in a period"


def test_a_peak_at_a_stop_is_read_at_the_corner_of_the_law_at_a_constant_step() -> None:
    """A parabola across the corner, where the platform comes to a stop, would be wrong by 14 %."""
    scene = SCENE.with_values({"duration": 3.0})
    expected = reference.trajectory(scene, (4.0, 0.7), regularization=1e-3).peak
    np.testing.assert_allclose(multibody.single_run(scene, (4.0, 0.7), step=2e-3).peak, expected, rtol=5e-3)


def test_steps_are_small_at_stops_and_large_elsewhere() -> None:
    v_reg = 1e-3
    motion = multibody.trajectory(SCENE.with_values({"duration": 6.0}), (2.0, 0.7), regularization=v_reg)
    step, slip = np.diff(motion.time), motion.extra["slip_speed"][:-1, 0]
    change = np.linalg.norm(np.diff(motion.velocity[:, 0], axis=0), axis=-1)
    # the bound at level 1 is 0.07 of the slip speed, met at the row before and exceeded at most by what one step adds
    assert (change / np.maximum(slip, v_reg)).max() < 0.14
    assert step.min() < step.max() / 10.0
    assert np.median(step) > 0.9 * step.max()


def test_contact_forces_settle_where_steps_become_smaller() -> None:
    """And nowhere else: the forces of a long step are no start for a short one."""
    settled: list[float] = []
    scene = SCENE.with_values({"duration": 3.0})
    built, level = assembly.assemble(scene, "translational", 1e-3), multibody.levels(scene)[0]

    def noted(state: Any, gap_rate: Any, penetration: float) -> Any:
        settled.append(state.coordinates[0])
        return built.settle(state, gap_rate, penetration)

    with silence_engine():
        pair = PhasePair(scene, replace(built, settle=noted), np.array([2.0, 0.7]))
        run = pair.run_level(level, Budget(1e5), keep=True)
    steps = [chunk.time[-1] - chunk.time[-2] for chunk in run.chunks]
    shorter = [after < 0.5 * before for before, after in pairwise(steps)]
    assert settled == [chunk.coordinates[-1, 0] for chunk, less in zip(run.chunks, shorter) if less]
    assert 0 < len(settled) < len(run.chunks) / 2


@pytest.mark.parametrize("speaks", [True, False])
def test_the_engine_speaks_as_before_behind_a_call_that_fails(speaks: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(exudyn.config, "printToConsole", speaks)
    with pytest.raises(ValueError, match="model"):
        multibody.trajectory(SCENE, PHASE, "planar")
    assert exudyn.config.printToConsole == speaks


def test_an_unstable_run_is_no_answer() -> None:
    assert multibody.single_run(SCENE, PHASE, step=2e-3, integrator="velocity Verlet").status != Outcome.OK


@pytest.mark.parametrize("model", ["translational", "spatial"])
def test_the_engine_is_reset_with_the_last_copy_of_a_model(model: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """It keeps its memory allocated until then."""
    freed: list[bool] = []
    container = SimpleNamespace(Reset=lambda: freed.append(True))
    monkeypatch.setattr(assembly, "reset_when_unused", lambda owner, _: reset_when_unused(owner, container))
    copied = replace(assembly.assemble(SCENE, model, 1e-3), allows_liftoff=True)
    gc.collect()
    assert (len(freed), copied.coordinates > 0) == (0, True)
    del copied
    multibody.single_run(SCENE, PHASE, model, step=0.1)
    gc.collect()
    assert len(freed) == 2, "the copy, and the model of the run"
