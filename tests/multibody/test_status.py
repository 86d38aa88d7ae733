"""Points without an answer are NaN with a status that says why and when; what needs too much work is refused."""

import re
import runpy
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scenes_at_hand import CONSTANT, frame, one_body
from scipy.integrate import solve_ivp

import multibody
import reference
from multibody import surface
from multibody.integration import refine
from multibody.integration.constant_step import EngineSolver
from multibody.integration.engine_run import Budget, EngineRun, begin_run
from multibody.integration.level import plan_levels
from multibody.integration.one_run import PhasePair
from multibody.models import engine
from multibody.models.assembly import assemble
from reference.problem import GRAVITY, Outcome, Scene, load_scene

PHASE = (0.3, 1.1)


def strong(travel: float, duration: float = 3.0) -> Scene:
    values = {"isolator.friction": 0.05, "duration": duration, "isolator.travel": travel}
    return load_scene("fig3-I", amplitude=2.5).with_values(values)


@pytest.mark.parametrize(
    ("push", "values", "angle", "outcome", "step"),
    [
        # x / rho is flat at the rim: one step of 3 ms is 1 % of it
        (2.0, {}, 0.5 * np.pi, Outcome.RIM_REACHED, 1e-2),
        (0.5, {"isolator.travel": 0.1}, np.arcsin(0.4), Outcome.TRAVEL_REACHED, 2e-5),
    ],
    ids=["rim", "travel"],
)
def test_a_steady_push_ends_the_motion_when_the_pendulum_says(
    push: float, values: dict[str, float], angle: float, outcome: Outcome, step: float
) -> None:
    load = [[-push * GRAVITY, 0.0], [0.0, 0.0]]
    scene = one_body(radius=0.25, friction=0.0, amplitudes=load, periods=[CONSTANT, CONSTANT]).with_values(values)
    result = multibody.amplification(scene, [(0.0, 0.0)], regularization=None)

    def swing(t: float, y: np.ndarray) -> list[float]:
        return [y[1], GRAVITY * (push * np.cos(y[0]) - np.sin(y[0])) / 0.25]

    tight = {"rtol": 1e-10, "atol": 1e-12}
    exact = solve_ivp(swing, (0.0, 1.0), [0.0, 0.0], events=lambda t, y: y[0] - angle, **tight)
    assert result.status[0] == outcome
    assert np.isnan(result.mu).all()
    assert result.instant[0] == pytest.approx(exact.t_events[0][0], abs=step)


@pytest.mark.parametrize("model", ["translational", "spatial"])
def test_the_travel_is_reached_when_the_equations_say(model: str) -> None:
    """Bodies that turn shift the support's load: another motion by some percent."""
    tolerance, apart = (1e-3, 5e-5) if model == "translational" else (1e-2, 5e-3)
    engine = multibody.amplification(strong(0.05), [PHASE], model, tolerance=tolerance)
    equations = reference.amplification(strong(0.05), [PHASE], regularization=1e-3)
    assert engine.status.tolist() == equations.status.tolist() == [Outcome.TRAVEL_REACHED]
    assert engine.instant[0] == pytest.approx(equations.instant[0], abs=apart)


def test_a_stored_motion_ends_before_the_travel() -> None:
    for motion in (multibody.trajectory(strong(0.05), PHASE), multibody.single_run(strong(0.05), PHASE, step=2e-3)):
        assert motion.status == Outcome.TRAVEL_REACHED
        assert np.hypot(*motion.position[:, 0, :2].T).max() <= 0.05
        assert motion.time[-1] <= motion.instant <= motion.time[-1] + 5e-3
        assert np.isnan(reference.demands(motion).displacement.value)
        size = np.linalg.norm(motion.absolute_acceleration, axis=2).max(axis=0)
        np.testing.assert_allclose(motion.peak, size, rtol=1e-3, err_msg="no more and no less than its rows")


def test_a_travel_close_to_the_largest_displacement_is_settled() -> None:
    """The displacement of the first second is the largest; what comes later is looked over in larger steps."""
    free = multibody.amplification(strong(0.2, 8.0).with_values({"isolator.travel": None}), [PHASE])
    most = float(reference.amplification(strong(0.2, 8.0), [PHASE], regularization=1e-3).displacement[0])
    for share, outcome in ((0.999, Outcome.TRAVEL_REACHED), (1.001, Outcome.OK)):
        for full in (False, True):
            result = multibody.amplification(strong(share * most, 8.0), [PHASE], full=full)
            assert result.status.tolist() == [outcome]
    wide = multibody.amplification(strong(0.2, 8.0), [PHASE])
    np.testing.assert_array_equal([wide.mu, wide.error], [free.mu, free.error])


def test_one_lost_point_does_not_take_the_others_with_it(monkeypatch: pytest.MonkeyPatch) -> None:
    lost = one_body(amplitudes=[[1.0, 0.0], [0.0, 0.0], [0.0, 10.5]], periods=[1.0, 2.0], decay=[0.0, 3.0])
    phases = [(0.0, np.pi), (0.0, 0.0), (1.0, 0.0)]
    result = multibody.amplification(lost, phases)
    assert result.status.tolist() == [Outcome.CONTACT_LOST, Outcome.OK, Outcome.OK]
    assert np.isfinite(result.mu[1:]).all()
    monkeypatch.setattr(surface, "ground_peak", lambda *_: np.array([0.0, np.inf, 1.0]))
    result = multibody.amplification(lost, phases)
    assert result.status.tolist() == [Outcome.NO_GROUND_MOTION, Outcome.NON_FINITE_LOAD, Outcome.OK]
    np.testing.assert_array_equal(result.instant, [0.0, 0.0, np.nan])
    assert np.isnan(result.mu[:2]).all()
    monkeypatch.undo()
    assert multibody.amplification(one_body(), [(0.0, 0.0)]).status[0] == Outcome.NO_GROUND_MOTION


def test_an_answer_without_another_level_says_nothing_of_its_error() -> None:
    result = multibody.amplification(one_body(amplitudes=[[1.0, 0.0], [0.0, 1.0]]), [(0.0, 0.0)], max_work=1000.0)
    assert result.status[0] == Outcome.STEP_LIMIT
    assert np.isnan(result.mu).all()
    scene = load_scene("fig3-I").with_values({"duration": 0.5})
    model = assemble(scene, "translational", 1e-3)
    one = refine.refine(PhasePair(scene, model, np.array(PHASE)), 1e-3, levels=plan_levels(scene, model, 1e-3)[:1])
    assert (one.outcome, one.instant) == (Outcome.STEP_LIMIT, 0.5)
    assert np.isnan(one.peaks).all()
    pair, (level, *_) = PhasePair(scene, model, np.array(PHASE)), plan_levels(scene, model, 1e-3)
    paid = Budget(1e9)
    whole = pair.run_level(level, paid, keep=True)
    steps = sum(len(chunk.time) - 1 for chunk in whole.chunks)
    assert 1e9 - paid.steps_left == whole.work > 1.05 * steps, "a step of many iterations is paid as several"
    half = pair.run_level(level, Budget(0.5 * whole.work))
    assert half.outcome == Outcome.STEP_LIMIT
    assert 0.005 < half.instant * model.units.time < 0.5, "s, what the steps reach"


def test_iterations_in_vain_are_work_as_well(monkeypatch: pytest.MonkeyPatch) -> None:
    ran = EngineSolver.run

    def vain(self: EngineSolver, *given: Any) -> Any:
        motion = ran(self, *given)
        self.newton_iterations = 10**6
        return motion

    monkeypatch.setattr(EngineSolver, "run", vain)
    result = multibody.amplification(load_scene("fig3-I").with_values({"duration": 0.5}), [PHASE])
    assert result.status[0] == Outcome.STEP_LIMIT


def test_a_tolerance_out_of_reach_gives_the_error_reached() -> None:
    scene = load_scene("fig3-I").with_values({"duration": 0.5, "bodies": [{"mass": 1.0}]})
    result = multibody.amplification(scene, [PHASE], tolerance=1e-9)
    assert result.status[0] == Outcome.TOLERANCE_NOT_MET
    assert ((result.error / result.mu > 1e-9) & (result.error / result.mu < 1e-4)).all()
    assert multibody.trajectory(scene, PHASE, tolerance=1e-9).status == Outcome.TOLERANCE_NOT_MET
    motion = multibody.trajectory(scene, PHASE)
    largest = np.linalg.norm(motion.absolute_acceleration[:, 0, :], axis=1).argmax()
    assert result.instant[0] == pytest.approx(motion.time[largest], abs=2e-3), "in s: that of the peak"


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"regularization": None}, "v_reg"),
        ({"phases": [[0.0, 1.0, 2.0]]}, "phases"),
        ({"model": "shaker"}, "model"),
        ({"scene": one_body(), "model": "spatial"}, r"isolator\.supports.*bodies\.0\.height"),
        ({"phase": PHASE}, "exactly one"),
        ({"phase": PHASE, "step": 1e-3, "level": multibody.levels(load_scene("fig3-I"))[0]}, "exactly one"),
        ({"phase": PHASE, "step": 0.0}, "step"),
        ({"phase": PHASE, "step": 20.1}, "step"),
        ({"phase": PHASE, "step": 1.9e-6}, "from 2e-06 to 20 s"),
        ({"phase": PHASE, "step": 1e-3, "integrator": "Euler"}, "integrator"),
        ({"phase": PHASE, "step": 1e-3, "penetration": -1.0}, "penetration"),
    ],
)
def test_wrong_arguments_are_refused_by_name(options: dict[str, Any], message: str) -> None:
    """Of a single run where the phases of one are given."""
    asked = {"scene": load_scene("fig3-I"), **options}
    with pytest.raises(ValueError, match=message):
        multibody.single_run(**asked) if "phase" in asked else multibody.amplification(**{"phases": [PHASE], **asked})


def test_a_refusal_says_what_is_needed_and_what_helps() -> None:
    """
    Of masses of 1 kg on a pendulum of 1 s and a link of 1.2 s: w^2 = (2 pi)^2 (2 + 2 k +- 2 sqrt(1 + k^2)) / 2 with
    k = 1 / 1.2^2, so that the fastest period is 0.586 s. Level 0 takes 150 steps of it, a first run four times fewer
    where nothing comes near a peak; two levels that grow twofold, and the softer contact, take ten times 150.
    """
    scene = load_scene("synthetic-pair")
    assert multibody.refusal(scene, max_work=100.0) == (
        "refused before any step: it needs 1.3e+03 steps of the engine or more, and a phase pair may take 1e+02 "
        "(8 coordinates in steps of 0.016 s over 20 s; the fastest period is 0.59 s). Allow more work (max_work or "
        "--max-work, about 52000 steps), shorten the duration to about 0.039 s (above 1.6 s no step is taken), or take "
        "a longer period; a looser tolerance may help"
    )
    for loose, said in (
        (
            {"tolerance": 1e-2},
            ("steps of 0.031 s", "period is 0.59 s", "26000 steps", "0.078 s (above 3.2 s", "does not help"),
        ),
        ({"full": True}, ("5.1e+03 steps", "steps of 0.0039 s", "(above 0.4 s")),
    ):
        assert all(part in multibody.refusal(scene, max_work=100.0, **loose) for part in said)
    bars = {"bodies.1.period": None, "bodies.1.bars": {"count": 4, "bending_stiffness": 0.8, "length": 1.0}}
    on_bars = scene.with_values(bars)
    softened, stiff = (multibody.refusal(on_bars, max_work=100.0, softened=soft) for soft in (True, False))
    assert softened == multibody.refusal(on_bars.softened(), max_work=100.0) != stiff
    buckled = multibody.refusal(on_bars.with_values({"bodies.1.bars.bending_stiffness": 1e-3}), softened=True)
    assert re.match(r"refused before any step: .*buckl", buckled)
    for duration in (1.55, 1.57):
        refused = multibody.refusal(scene.with_values({"duration": duration}), max_work=100.0)
        assert (refused != "") == (duration > 1.563)


def test_a_run_is_refused_by_the_longest_steps_that_it_may_take(monkeypatch: pytest.MonkeyPatch) -> None:
    """Four times those of level 0, unless it goes to the end; nothing is assembled for a pair that has too little."""
    asked: list[float] = []

    def limited(pair: PhasePair, level: Any, budget: Any, *rest: Any, **more: Any) -> EngineRun:
        asked.append(budget.steps_left)
        return begin_run(pair.model).terminate(Outcome.STEP_LIMIT, 0.0)

    monkeypatch.setattr(PhasePair, "run_level", limited)
    scene = load_scene("synthetic-pair")  # 5.1e3 steps of level 0
    for work, full, runs in ((1200.0, False, 0), (1400.0, False, 2), (5000.0, True, 0), (5300.0, True, 2)):
        asked.clear()
        status = multibody.amplification(scene, [PHASE], max_work=work, full=full).status
        assert (status[0], asked) == (Outcome.STEP_LIMIT, [work] * runs)
        assert (multibody.refusal(scene, max_work=work, full=full) == "") == bool(runs)
    asked.clear()
    multibody.trajectory(scene, PHASE, max_work=5000.0)
    assert asked == [], "a motion that is kept goes to its end"


@pytest.mark.parametrize("scene", [load_scene("fig3-I"), frame(60.0, 20, 0.02)], ids=["fig3-I", "20 stiff floors"])
def test_what_is_tried_is_not_refused(scene: Scene) -> None:
    """Of two bodies with six coordinates each, and four supports that share the load with one each."""
    assert "(16 coordinates" in multibody.refusal(load_scene("fig3-I"), "spatial", max_work=10.0)
    assert [multibody.refusal(scene, model) for model in ("translational", "spatial")] == ["", ""]


def test_every_key_that_the_spatial_model_lacks_is_named() -> None:
    lacks = dict.fromkeys(("isolator.ring", "bodies.0.size", "bodies.1.height", "bodies.1.size"))
    keys = ", ".join(lacks)
    with pytest.raises(ValueError, match=re.escape(f"model: 'spatial': fig3-I needs {keys}")):
        multibody.amplification(load_scene("fig3-I").with_values({**lacks, "name": "fig3-I"}), (0.0, 0.0), "spatial")


def test_an_engine_that_cannot_be_loaded_names_the_package_of_the_readme(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "exudyn", None)
    with pytest.raises(ImportError, match=r"^the engine Exudyn cannot be loaded .*exudyn") as failed:
        runpy.run_path(str(engine.__file__))
    package = str(failed.value).partition("it needs the package ")[2].partition(")")[0]
    installing = (Path(multibody.__file__).parents[1] / "README.md").read_text(encoding="utf-8")
    assert f"and `{package}`)" in installing
