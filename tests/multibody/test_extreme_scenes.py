"""At the extremes a point ends with an error that holds or with a status, and its work is known before it is spent."""

from typing import Any

import pytest
from scenes_at_hand import both_sides, changed

import multibody
import reference
from multibody.integration.constant_step import Engine
from multibody.integration.level import for_small_peaks
from reference.problem import Outcome, Scene, load_scene

PHASE = [(0.3, 1.1)]
V_REG = 1e-3


def strong(**tables: Any) -> Scene:
    load = {"amplitudes": [[2.0, 0.0], [0.0, 2.0]], **tables.pop("excitation", {})}
    return changed(load_scene("fig3-I"), excitation=load, **tables)


@pytest.mark.parametrize(
    ("scene", "v_reg"),
    [
        (strong(duration=0.1, excitation={"decay": [1e3, 0.3]}), V_REG),
        (strong(duration=0.6).with_values({"bodies.1.period": [1e-2, 8e-3]}), V_REG),  # undamped, it rings at first
        (strong(duration=3.0), 1e-4),  # two levels agree to 0.9 of what both are off
    ],
    ids=["decay 1e3/s", "link 1e-2 s", "v_reg 1e-4 m/s"],
)
def test_the_error_holds_where_a_scene_is_quick(scene: Scene, v_reg: float) -> None:
    both_sides(scene, PHASE, v_reg)


def test_a_loading_of_a_millionth_has_its_factors() -> None:
    """A tower turns by as much less as it sways."""
    scene = load_scene("fig3-I").with_values({"duration": 3.0}).with_amplitude(1e-6)
    both_sides(scene, [(0.3, 1.1), (2.0, 0.7)], model="spatial")


def test_only_a_small_peak_asks_for_a_softer_contact() -> None:
    levels = multibody.levels(load_scene("fig3-I"), tolerance=1e-3)
    assert [for_small_peaks(level, 0.2, 1e-3) for level in levels] == levels
    softer = for_small_peaks(levels[3], 1e-6, 1e-3)
    assert softer.rounding == pytest.approx(0.25 * 1e-3 * 1e-6)
    assert softer.residual == pytest.approx(softer.rounding)
    assert for_small_peaks(levels[3], 1e-20, 1e-3).penetration == pytest.approx(1e-4), "the softest that is tried"
    narrow, wide = (load_scene("fig3-I").with_values({"isolator.ring": ring}) for ring in (2.0, 6.0))
    rounding = [multibody.levels(scene, "spatial")[0].rounding_moment for scene in (narrow, wide)]
    assert rounding[1] / rounding[0] == pytest.approx(9.0), "a force rounds by a place, its moment by that squared"


def test_a_loading_that_is_gone_sets_nothing_rocking() -> None:
    """Contacts in balance with its first value would throw the upper body about: mu_2 was ten times too large."""
    scene = load_scene("fig3-I").with_values({"duration": 1.0, "excitation.decay": [1e6, 1e6]})
    result = multibody.amplification(scene, PHASE, "spatial", V_REG, 1e-2)
    expected = reference.amplification(scene, PHASE, regularization=V_REG)
    assert result.status[0] == Outcome.OK
    assert result.mu[0] == pytest.approx(expected.mu[0], rel=2e-2)


def test_iterations_in_vain_are_work_as_well(monkeypatch: pytest.MonkeyPatch) -> None:
    ran = Engine.run

    def vain(self: Engine, *given: Any) -> Any:
        motion = ran(self, *given)
        self.iterations = 10**6
        return motion

    monkeypatch.setattr(Engine, "run", vain)
    result = multibody.amplification(strong(duration=0.5), PHASE)
    assert result.status[0] == Outcome.STEP_LIMIT
