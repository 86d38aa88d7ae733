"""A smaller model answers for the one asked for where the scene allows it: no rotations (vi), or a plane (4.7)."""

from typing import Any

import numpy as np
import pytest
from scenes_at_hand import assert_agree

import multibody
from multibody import surface
from reference.problem import Scene, load_scene, planar, untilted

PHASES = [(2.0, 0.7), (0.3, 1.1)]
DIAGONAL = [[1.0, 0.5], [-0.8, -0.4]]


def planar_scene(name: str = "fig4-dry", amplitudes: Any = None, duration: float = 3.0, **values: Any) -> Scene:
    scene = load_scene(name).with_values({"duration": duration, **values})
    return scene if amplitudes is None else scene.with_values({"excitation.amplitudes": amplitudes})


PLANAR = {
    "diagonal": planar_scene(),
    "lubricated": planar_scene("fig4-viscous"),
    "oblique, vertical too": planar_scene(amplitudes=[*DIAGONAL, [0.5, 0.3]]),
    "along y, links of two stiffnesses and dampers": planar_scene(
        "fig3-I", [[0.0, 0.0], [1.0, 0.6]], **{"bodies.1.damping": [0.2, 0.7]}
    ),
}


def level(name: str, duration: float, **values: Any) -> Scene:
    """The platform alone, with its center in the plane of the depressions."""
    body = {**load_scene(name).bodies[0].model_dump(exclude_none=True), "height": 0.0}
    return load_scene(name).with_values({"duration": duration, "bodies": [body], **values})


LEVEL = {"level": level("fig3-I", 2.0), "level, three supports": level("fig3-II", 2.0, **{"isolator.supports": 3})}


@pytest.mark.parametrize("name", [*PLANAR, *LEVEL])
def test_the_answer_is_that_of_the_whole_model(name: str) -> None:
    scene, model = (PLANAR[name], "translational") if name in PLANAR else (LEVEL[name], "spatial")
    reduced, full = (multibody.amplification(scene, PHASES[:1], model, full=full) for full in (False, True))
    assert (planar if name in PLANAR else untilted)(scene)
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
    scene, unlike = planar_scene(duration=0.05), {"bodies.1.stiffness": [20.0, 20.000001], "bodies.1.period": None}
    for each, full in ((scene, False), (scene.with_values(unlike), False), (scene, True)):
        multibody.amplification(each, PHASES[:1], tolerance=0.1, full=full)
    assert built == [("translational", count) for count in (7, 8, 8)]
    built.clear()
    moving, spatial = (
        multibody.amplification(level("fig3-I", 0.5), PHASES, model) for model in ("translational", "spatial")
    )
    np.testing.assert_array_equal(spatial.mu, moving.mu)
    multibody.amplification(level("fig3-I", 0.5), PHASES[:1], "spatial", full=True)
    multibody.amplification(level("fig3-I", 0.5, **{"bodies.0.height": 1e-12}), PHASES[:1], "spatial")
    assert built == [*[("translational", 6)] * 2, *[("spatial", 10)] * 2]


def test_off_its_supports_the_model_that_is_asked_for_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    """Thrown up by 12 m/s^2, the translational model ends; the spatial one falls back, loaded as it is asked for."""
    loads: list[str] = []
    assemble = surface.assemble

    def noted(*given: Any, loading: str, **more: Any) -> Any:
        loads.append(loading)
        return assemble(*given, loading=loading, **more)

    monkeypatch.setattr(surface, "assemble", noted)
    scene = level("fig3-I", 0.6, **{"excitation.amplitudes": [[0.0, 0.0], [0.0, 0.0], [12.0, 0.0]]})
    moving, spatial = (
        multibody.amplification(scene, [(0.0, 0.0)], model, tolerance=1e-2, loading="plate")
        for model in ("translational", "spatial")
    )
    assert loads == ["plate"] * 3
    assert (moving.status[0], np.isnan(moving.mu[0, 0])) == ("contact lost", True)
    assert (spatial.status[0], np.isfinite(spatial.mu[0, 0])) == ("ok", True)
