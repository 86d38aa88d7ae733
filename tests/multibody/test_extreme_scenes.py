"""At the extremes a point ends with an error that holds or with a status, and its work is known before it is spent."""

from typing import Any

import numpy as np
import pytest
from rigid_chain import spatial_motion
from scenes_at_hand import both_sides, changed

import multibody
import reference
from multibody.integration import candidate, one_run
from multibody.integration.adaptive import EngineRun, run_adaptively
from multibody.integration.constant_step import Engine
from multibody.integration.estimate import (
    from_levels,
)
from multibody.integration.level import REAL_WARPING_COMPLIANCE, Level, for_small_peaks
from multibody.integration.one_run import PhasePair
from multibody.integration.peak import Peaks
from multibody.models.assembly import assemble
from reference.problem import Outcome, Scene, ground_acceleration, load_scene

PHASE = [(0.3, 1.1)]
V_REG = 1e-3


def strong(**tables: Any) -> Scene:
    """`fig3-I` at twice its amplitude, changed."""
    load = {"amplitudes": [[2.0, 0.0], [0.0, 2.0]], **tables.pop("excitation", {})}
    return changed(load_scene("fig3-I"), excitation=load, **tables)


def linked(period: float, **tables: Any) -> Scene:
    return strong(bodies=[{"mass": 1.0}, {"mass": 1.0, "period": [period, 0.8 * period]}], **tables)


def adaptive_runs(monkeypatch: pytest.MonkeyPatch) -> list[EngineRun]:
    """The runs of the calls that follow."""
    done: list[EngineRun] = []

    def kept(*given: Any, **more: Any) -> EngineRun:
        done.append(run_adaptively(*given, **more))
        return done[-1]

    monkeypatch.setattr(one_run, "run_adaptively", kept)
    return done


@pytest.mark.long  # half a minute of compiling the independent equations
@pytest.mark.parametrize("tolerance", [1e-3, 3e-4])
def test_an_answer_beyond_the_tolerance_is_the_last_exact_one(tolerance: float) -> None:
    """A link of 1000 s leaves the body 5e-5 g: stiffer contacts round by more, and the last level knew nothing."""
    size = [2.0, 2.0, 0.2]
    above = {"mass": 1.0, "height": 1.2, "size": size, "period": [1e3, 800.0]}
    supports = {"friction": 0.1, "supports": 4, "ring": 1.0, "sphere_radius": 0.05}
    scene = strong(bodies=[{"mass": 1.0, "height": 0.2, "size": size}, above], isolator=supports, duration=3.0)
    engine = multibody.amplification(scene, [(2.0, 0.7)], model="spatial", tolerance=tolerance)
    independent = spatial_motion(scene, (2.0, 0.7), V_REG)
    assert engine.status[0] == Outcome.TOLERANCE_NOT_MET
    assert (engine.error[0] < 3e-3 * engine.mu[0]).all(), engine.error / engine.mu
    assert (np.abs(engine.mu[0] - independent.mu) <= engine.error[0]).all(), (engine.mu, independent.mu, engine.error)


@pytest.mark.parametrize(
    ("scene", "v_reg"),
    [
        (strong(duration=1.0, excitation={"decay": [1e6, 1e6]}), V_REG),  # gone before the largest step ends
        (strong(duration=0.1, excitation={"decay": [1e3, 0.3]}), V_REG),
        (linked(1e-2, duration=0.6), V_REG),  # undamped, it rings when the loading begins
        (linked(1e-3, duration=0.02), V_REG),
        # a slow contact's damper would end its swing
        pytest.param(linked(1e-3, duration=0.3, isolator={"friction": 0.1}), V_REG, marks=pytest.mark.long),
        (strong(duration=3.0), 1e-4),  # two levels agree to 0.9 of what both are off
    ],
    ids=["decay 1e6/s", "decay 1e3/s", "link 1e-2 s", "link 1e-3 s", "link 1e-3 s, longer", "v_reg 1e-4 m/s"],
)
def test_the_error_holds_where_a_scene_is_quick(scene: Scene, v_reg: float) -> None:
    # what is left of a loading of 1 us is weak beside the rounding of the contact force
    both_sides(scene, PHASE, v_reg, tolerance=1e-2 if scene.excitation.decay[0] == 1e6 else 1e-3)


@pytest.mark.parametrize("scene", [strong(duration=1e5), linked(1e-4)], ids=["1e5 s", "link 1e-4 s"])
def test_work_beyond_the_budget_is_refused_before_any_step(scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Engine, "run", lambda *given: pytest.fail("a step was spent"))
    result = multibody.amplification(scene, PHASE)
    assert result.status[0] == Outcome.STEP_LIMIT
    assert result.instant[0] == 0.0
    assert np.isnan(result.mu).all()


def test_levels_that_cannot_round_less_are_not_spent(monkeypatch: pytest.MonkeyPatch) -> None:
    # 1e-11 m/s^2 is less than what a contact force rounds to
    done = adaptive_runs(monkeypatch)
    weak = strong(duration=0.5, excitation={"amplitudes": [[1e-11, 0.0], [0.0, 1e-11]]})
    result = multibody.amplification(weak, PHASE)
    assert result.status[0] == Outcome.TOLERANCE_NOT_MET
    assert (result.error > 0.1 * result.mu).all()
    assert len(done) <= 3, "two levels, and the compliance of the second"


def test_iterations_in_vain_are_work_as_well(monkeypatch: pytest.MonkeyPatch) -> None:
    ran = Engine.run

    def vain(self: Engine, *given: Any) -> Any:
        motion = ran(self, *given)
        self.iterations = 10**6
        return motion

    monkeypatch.setattr(Engine, "run", vain)
    result = multibody.amplification(strong(duration=0.5), PHASE)
    assert result.status[0] == Outcome.STEP_LIMIT


def test_what_the_compliance_leaves_is_part_of_the_error(monkeypatch: pytest.MonkeyPatch) -> None:
    done = adaptive_runs(monkeypatch)
    both_sides(strong(duration=0.3), PHASE, tolerance=1e-9, outcome=Outcome.TOLERANCE_NOT_MET, strict=1e-8)
    assert done[-1].work < 1.5 * done[-2].work, "the last run repeats the finest level with a softer contact"


def test_without_a_run_on_compliance_the_level_before_answers(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(candidate, "from_compliance", lambda stiff, *rest: np.full_like(stiff.value, np.inf))
    both_sides(strong(duration=0.3), PHASE, tolerance=1e-6, outcome=Outcome.TOLERANCE_NOT_MET, strict=1e-8)


@pytest.mark.parametrize("model", ["translational", "spatial"])
def test_a_loading_of_a_millionth_has_its_factors(model: str) -> None:
    """A tower turns by as much less as it sways."""
    scene = load_scene("fig3-I").with_values({"duration": 3.0}).with_amplitude(1e-6)
    both_sides(scene, [(0.3, 1.1), (2.0, 0.7)], model=model)


@pytest.mark.parametrize(
    "scene",
    [
        linked(1e3, duration=1.0),
        pytest.param(strong(duration=1.0, excitation={"decay": [1e6, 1e6]}), marks=pytest.mark.long),
    ],
    ids=["link 1e3 s", "decay 1e6/s"],
)
def test_a_body_that_hardly_moves_has_its_factor_to_1e_3(scene: Scene) -> None:
    engine, _ = both_sides(scene, [(2.0, 0.7)])
    assert (engine.mu < 1e-3 * engine.mu.max()).any() or engine.mu.max() < 1e-2


def test_only_a_small_peak_asks_for_a_softer_contact() -> None:
    levels = multibody.levels(load_scene("fig3-I"), tolerance=1e-3)
    assert [for_small_peaks(level, 0.2, 1e-3) for level in levels] == levels
    softer = for_small_peaks(levels[3], 1e-6, 1e-3)
    assert softer.rounding == pytest.approx(0.25 * 1e-3 * 1e-6)
    assert softer.residual == pytest.approx(softer.rounding)
    assert for_small_peaks(levels[3], 1e-20, 1e-3).penetration == pytest.approx(1e-4), "the softest that is tried"


def test_rounding_counts_no_more_than_a_softer_contact_shows() -> None:
    """A loading of 1 kHz needs a contact so stiff that its rounding may be a third of what the upper body feels."""
    scene = strong(duration=0.02, excitation={"periods": [1e-3, 1.1e-3]})
    phases = [(0.3, 1.1), (2.0, 0.7)]
    engine = multibody.amplification(scene, phases, "spatial", tolerance=3e-4)
    # a tower hardly turns in so short a time
    equations = reference.amplification(scene, phases, regularization=V_REG)
    assert (engine.mu[:, 1] < 1e-3).all()
    assert (np.abs(engine.mu - equations.mu) <= engine.error + equations.error).all()
    assert (engine.error <= 1e-3 * engine.mu).all()


def ring_that_opens(supports: int) -> Scene:
    isolator = {"period": None, "radius": 0.25, "friction": 0.1, "supports": supports, "ring": 0.3}
    load = {"amplitudes": [[2.0, 0.0], [0.0, 2.0], [1.0, 0.5]], "decay": [0.0, 0.0]}
    return strong(duration=2.0, excitation=load).with_values({f"isolator.{key}": isolator[key] for key in isolator})


def test_where_a_support_opens_every_level_has_bearings(monkeypatch: pytest.MonkeyPatch) -> None:
    """Which support is hit first depends on the springs: mu_1 is 1.893 on springs of 1e-4 rho, 1.826 on real ones."""
    levels: list[tuple[Level, EngineRun]] = []
    at_level = PhasePair.at_level

    def noted(self: PhasePair, level: Level, *given: Any, **more: Any) -> EngineRun:
        levels.append((level, at_level(self, level, *given, **more)))
        return levels[-1][1]

    monkeypatch.setattr(PhasePair, "at_level", noted)
    result = multibody.amplification(ring_that_opens(4), PHASE, "spatial", V_REG, 1e-2)
    assert result.status[0] == Outcome.OK
    assert [level.warping_compliance for level, _ in levels] == [2e-5, *[REAL_WARPING_COMPLIANCE] * (len(levels) - 1)]
    assert all(run.lifts_off for _, run in levels)
    assert result.mu[0, 0] == pytest.approx(1.826, abs=float(result.error[0, 0]))


@pytest.mark.long
def test_loads_of_warped_supports_behind_a_peak_do_not_act_on_it() -> None:
    """Without friction the tower turns more and more, and supports open again and again behind the largest peaks."""
    covers(strong(duration=3.0, isolator={"friction": 0.0}), 3e-3)


def covers(scene: Scene, finer: float, **asked: Any) -> None:
    """The error of the spatial model at 1e-2 covers what a finer tolerance changes."""
    loose, strict = (multibody.amplification(scene, PHASE, "spatial", tolerance=t, **asked) for t in (1e-2, finer))
    assert [loose.status[0], strict.status[0]] == [Outcome.OK] * 2
    assert (np.abs(loose.mu - strict.mu) <= loose.error + strict.error).all()


@pytest.mark.long
def test_nine_supports_that_rattle_have_an_answer() -> None:
    places = [[x, y] for x in (-1.0, 0.0, 1.0) for y in (-1.0, 0.0, 1.0)]
    scene = strong(duration=3.0).with_values({"isolator.supports": places, "isolator.ring": None})
    covers(scene, 1e-3, max_work=5e4)


@pytest.mark.long
@pytest.mark.parametrize(("supports", "finer"), [(4, 1e-3), (5, 2e-3), (6, 1e-3), (8, 1e-3)])
def test_the_error_covers_what_supports_that_open_do(supports: int, finer: float) -> None:
    """Impacts take every level of the five supports elsewhere by 1.2e-3: they have no answer at 1e-3."""
    covers(ring_that_opens(supports), finer)


def test_the_loading_before_the_start_throws_nothing_off() -> None:
    """A plate that falls at nearly g at first, and by its decay at more than g before, takes the platform along."""
    load = {"amplitudes": [[0.2, 0.36], [-0.39, -0.14], [-3.96, 6.52]], "periods": [0.303, 0.643], "decay": [3.0, 5.4]}
    scene = changed(ring_that_opens(6), excitation=load, duration=0.5)
    scene = scene.with_values({"isolator.radius": 0.85, "isolator.ring": 1.9})
    phase = (0.665, 3.034)
    result = multibody.amplification(scene, [phase], "spatial", 1e-2, 1e-3)
    plate = ground_acceleration(scene, phase, np.zeros(1))[0]
    assert result.status[0] == Outcome.OK
    assert result.mu[0, 0] == pytest.approx(abs(plate[2]) / np.linalg.norm(plate), rel=1e-3), "at rest it slides freely"


def test_a_loading_that_is_gone_sets_nothing_rocking() -> None:
    """Contacts in balance with its first value would throw the upper body about: mu_2 was ten times too large."""
    scene = load_scene("fig3-I").with_values({"duration": 1.0, "excitation.decay": [1e6, 1e6]})
    result = multibody.amplification(scene, PHASE, "spatial", 1e-3, 1e-2)
    expected = reference.amplification(scene, PHASE, regularization=1e-3)
    assert result.status[0] == Outcome.OK
    assert result.mu[0] == pytest.approx(expected.mu[0], rel=2e-2)


def test_changes_of_opposite_sign_show_no_rate_of_convergence() -> None:
    scene = load_scene("fig3-I")
    model, levels = assemble(scene, "translational", V_REG), multibody.levels(scene)[:3]
    errors = []
    for last in (0.9, 1.1, 1.01):  # by a quarter of the change before, and by less than a credible share
        peaks = [Peaks(1, V_REG) for _ in levels]
        for each, value in zip(peaks, (0.6, 1.0, last)):
            each.value[:] = value
        errors.append(float(from_levels(peaks, levels, model)[0]))
    assert errors == pytest.approx([3.0 * errors[1], errors[1], 6.0 * errors[1]], rel=1e-3)


def test_friction_quicker_than_the_contact_loses_nothing() -> None:
    found = multibody.amplification(strong(duration=0.5), [(2.0, 0.7)], regularization=1e-8, max_work=5e4)
    assert found.status[0] in (Outcome.OK, Outcome.TOLERANCE_NOT_MET, Outcome.STEP_LIMIT)
