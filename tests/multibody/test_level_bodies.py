"""A single body whose center is level with the depressions does not turn: the translational model answers for it."""

from typing import Any

import numpy as np
import pytest
from scenes_at_hand import changed

import multibody
from multibody import surface
from reference.problem import Scene, builtin_scenes, load_scene, untilted

PHASES = [(2.0, 0.7), (0.3, 1.1)]


def level(name: str, duration: float, height: float = 0.0, bodies: int = 1, **changes: Any) -> Scene:
    scene = changed(load_scene(name), duration=duration, **changes)
    kept = scene.model_dump(exclude_none=True)["bodies"][:bodies]
    return changed(scene, bodies=[{**body, "height": height} for body in kept])


@pytest.mark.parametrize("name", [name for name in builtin_scenes() if name != "fig4-viscous"])
def test_the_answer_is_that_of_all_supports_and_rotations(name: str) -> None:
    scene = level(name, 2.0, isolator={"supports": 3 if name == "fig3-II" else 4})
    assert untilted(scene)
    reduced, full = (multibody.amplification(scene, PHASES[:1], "spatial", full=full) for full in (False, True))
    assert reduced.status.tolist() == full.status.tolist() == ["ok"]
    assert (np.abs(reduced.mu - full.mu) <= reduced.error + full.error).all()


@pytest.mark.parametrize(
    "scene",
    [
        level("fig3-I", 1.0, bodies=2),  # its weight shifts by more than the platform's
        level("fig3-I", 1.0, height=1e-12),
        level("fig3-I", 1.0, isolator={"ring": 0.05}),  # friction, 0.3 m above, lifts it off a support
        level("fig3-I", 1.0, isolator={"support_stiffness": 1e5}),
        level("fig4-viscous", 1.0),  # friction without a limit
        level("fig3-I", 1.0).with_values({"bodies.0.offset": [0.1, 0.0]}),
        level("fig3-I", 1.0).with_values({"isolator.ring": None, "isolator.supports": [[1, 1], [-1, 1], [0, -1]]}),
    ],
)
def test_it_is_refused_where_something_may_turn(scene: Scene) -> None:
    assert not untilted(scene)


def test_the_weight_of_a_second_level_body_turns_the_platform() -> None:
    scene = level("fig3-I", 2.65, bodies=2)
    spatial, moving = (
        multibody.amplification(scene, PHASES[:1], model, tolerance=5e-4) for model in ("spatial", "translational")
    )
    assert moving.mu[0, 0] - spatial.mu[0, 0] > 2.0 * (moving.error[0, 0] + spatial.error[0, 0])


def test_it_is_answered_by_the_model_without_rotations(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = level("fig3-I", 0.5)
    moving = multibody.amplification(scene, PHASES, "translational")
    built: list[str] = []
    assemble = surface.assemble

    def noted(scene: Scene, model: str, *rest: Any, **more: Any) -> Any:
        built.append(model)
        return assemble(scene, model, *rest, **more)

    monkeypatch.setattr(surface, "assemble", noted)
    np.testing.assert_array_equal(multibody.amplification(scene, PHASES, "spatial").mu, moving.mu)
    multibody.amplification(scene, PHASES[:1], "spatial", full=True)
    multibody.amplification(level("fig3-I", 0.5, 1e-12), PHASES[:1], "spatial")
    assert built == ["translational", "spatial", "spatial"]
