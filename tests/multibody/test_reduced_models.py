"""A smaller model answers for the one asked for where the scene allows it: no rotations (vi), or a plane (4.7)."""

from typing import Any

import numpy as np
import pytest
from scenes_at_hand import assert_agree

import multibody
from multibody import surface
from reference.problem import Scene, load_scene
from reference.problem.reductions import body_cannot_tilt, is_planar

PHASES = [(2.0, 0.7), (0.3, 1.1)]
LEVEL = {"bodies": [{"mass": 1.0, "height": 0.0, "size": [2.0, 2.0, 0.2]}]}  # with the depressions
ALONG_Y = {"excitation.amplitudes": [[0.0, 0.0], [1.0, 0.6]]}
CASES: dict[str, tuple[Any, str, dict[str, Any]]] = {
    "diagonal": (is_planar, "fig4-dry", {}),
    "lubricated": (is_planar, "fig4-viscous", {}),
    "oblique, vertical too": (is_planar, "fig4-dry", {"excitation.amplitudes": [[1.0, 0.5], [-0.8, -0.4], [0.5, 0.3]]}),
    "links of two stiffnesses and dampers": (is_planar, "fig3-I", {**ALONG_Y, "bodies.1.damping": [0.2, 0.7]}),
    "level": (body_cannot_tilt, "fig3-I", LEVEL),
    "level, three supports": (body_cannot_tilt, "fig3-II", {**LEVEL, "isolator.supports": 3}),
}


@pytest.mark.parametrize(("reduction", "name", "values"), CASES.values(), ids=CASES)
def test_the_answer_is_that_of_the_whole_model(reduction: Any, name: str, values: dict[str, Any]) -> None:
    scene = load_scene(name).with_values({"duration": 3.0, **values})
    model = "spatial" if reduction is body_cannot_tilt else "translational"
    reduced, full = (multibody.amplification(scene, PHASES[:1], model, full=full) for full in (False, True))
    assert reduction(scene)
    assert_agree(reduced, full)


def test_what_does_not_need_it_is_computed_by_the_smaller_model(monkeypatch: pytest.MonkeyPatch) -> None:
    """Coordinates: six of the platform and one or two of the body above; six of each body that turns, one a sphere."""
    built: list[tuple[str, int]] = []
    assemble = surface.assemble

    def noted(scene: Scene, model: str, *rest: Any, **more: Any) -> Any:
        made = assemble(scene, model, *rest, **more)
        built.append((model, made.coordinates))
        return made

    monkeypatch.setattr(surface, "assemble", noted)
    scene = load_scene("fig4-dry").with_values({"duration": 0.05})
    unlike = {"bodies.1.stiffness": [20.0, 20.000001], "bodies.1.period": None}
    for each, full in ((scene, False), (scene.with_values(unlike), False), (scene, True)):
        multibody.amplification(each, PHASES[:1], tolerance=0.1, full=full)
    assert built == [("translational", count) for count in (7, 8, 8)]
    built.clear()
    scene = load_scene("fig3-I").with_values({"duration": 0.5, **LEVEL})
    moving, spatial = (multibody.amplification(scene, PHASES, model) for model in ("translational", "spatial"))
    np.testing.assert_array_equal(spatial.mu, moving.mu)
    multibody.amplification(scene, PHASES[:1], "spatial", full=True)
    multibody.amplification(scene.with_values({"bodies.0.height": 1e-12}), PHASES[:1], "spatial")
    assert built == [*[("translational", 6)] * 2, *[("spatial", 10)] * 2]


def test_off_its_supports_the_model_that_is_asked_for_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    """Thrown up by 12 m/s^2, the translational model ends; the spatial one, asked for, falls back."""
    built: list[str] = []
    assemble = surface.assemble

    def noted(scene: Scene, model: str, *rest: Any, **more: Any) -> Any:
        built.append(model)
        return assemble(scene, model, *rest, **more)

    monkeypatch.setattr(surface, "assemble", noted)
    upward = {"excitation.amplitudes": [[0.0, 0.0], [0.0, 0.0], [12.0, 0.0]]}
    scene = load_scene("fig3-I").with_values({"duration": 0.6, **LEVEL, **upward})
    moving, spatial = (
        multibody.amplification(scene, [(0.0, 0.0)], model, tolerance=1e-2) for model in ("translational", "spatial")
    )
    assert built == ["translational", "translational", "spatial"]
    assert (moving.status[0], np.isnan(moving.mu[0, 0])) == ("contact lost", True)
    assert (spatial.status[0], np.isfinite(spatial.mu[0, 0])) == ("ok", True)
