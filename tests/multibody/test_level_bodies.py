"""Where every centre of mass is level with the depressions no body turns: the translational model answers."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scenes_at_hand import changed

import multibody
from multibody import surface
from reference.problem import Outcome, Scene, builtin_scenes, load_scene, untilted

PHASES = [(2.0, 0.7), (0.3, 1.1)]


def level(name: str, duration: float, heights: float = 0.0, **changes: Any) -> Scene:
    scene = changed(load_scene(name), duration=duration, **changes)
    return changed(scene, bodies=[{**b, "height": heights} for b in scene.model_dump(exclude_none=True)["bodies"]])


@pytest.mark.parametrize("name", builtin_scenes())
def test_the_answer_is_that_of_all_supports_and_rotations(name: str) -> None:
    scene = level(name, 2.0, isolator={"supports": 3 if name == "fig3-II" else 4})
    assert untilted(scene)
    reduced, full = (multibody.amplification(scene, PHASES[:1], "spatial", full=full) for full in (False, True))
    assert reduced.status.tolist() == full.status.tolist() == ["ok"]
    assert (np.abs(reduced.mu - full.mu) <= reduced.error + full.error).all()


def test_it_is_answered_by_the_model_without_rotations(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = level("fig3-I", 0.5)
    moving = multibody.amplification(scene, PHASES, "translational")
    built: list[str] = []
    assembled = surface.assembled

    def noted(scene: Scene, model: str, *rest: Any, **more: Any) -> Any:
        built.append(model)
        return assembled(scene, model, *rest, **more)

    monkeypatch.setattr(surface, "assembled", noted)
    np.testing.assert_array_equal(multibody.amplification(scene, PHASES, "spatial").mu, moving.mu)
    multibody.amplification(scene, PHASES[:1], "spatial", full=True)
    multibody.amplification(level("fig3-I", 0.5, 1e-12), PHASES[:1], "spatial")
    assert built == ["translational", "spatial", "spatial"]


def test_a_platform_that_leaves_its_supports_is_followed_by_the_model_asked_for() -> None:
    scene = level("fig3-I", 1.0, excitation={"amplitudes": [[1.0, 0.0], [0.0, 1.0], [12.0, 0.0]]})
    asked, full = (multibody.amplification(scene, [(2.0, 0.7)], "spatial", full=full) for full in (False, True))
    lost = multibody.amplification(scene, [(2.0, 0.7)], "translational")
    assert lost.status[0] == Outcome.CONTACT_LOST
    assert asked.status[0] == full.status[0]
    np.testing.assert_array_equal(asked.mu, full.mu)
