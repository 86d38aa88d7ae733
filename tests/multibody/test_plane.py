"""A motion that stays in a plane (4.7) is computed without the bodies' coordinates across it."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scenes_at_hand import changed

import multibody
from multibody import surface
from reference.problem import Scene, ground_peak, in_plane, load_scene, planar

PHASES = [(2.0, 0.7)]
DIAGONAL = [[1.0, 0.5], [-0.8, -0.4]]


def scene_of(name: str = "fig4-dry", amplitudes: Any = None, duration: float = 3.0) -> Scene:
    scene = changed(load_scene(name), duration=duration)
    return scene if amplitudes is None else changed(scene, excitation={"amplitudes": amplitudes})


CASES = {
    "diagonal": scene_of(),
    "lubricated": scene_of("fig4-viscous"),
    "oblique, vertical too": scene_of(amplitudes=[*DIAGONAL, [0.5, 0.3]]),
    "along y, links of two stiffnesses": scene_of("fig3-I", [[0.0, 0.0], [1.0, 0.6]]),
}


@pytest.mark.parametrize("name", CASES)
def test_the_answer_is_that_of_all_coordinates(name: str) -> None:
    reduced, full = (multibody.amplification(CASES[name], PHASES, full=full) for full in (False, True))
    assert planar(CASES[name])
    assert reduced.status.tolist() == full.status.tolist() == ["ok"]
    assert (np.abs(reduced.mu - full.mu) <= reduced.error + full.error).all()


def test_only_what_moves_in_a_plane_is_computed_in_it(monkeypatch: pytest.MonkeyPatch) -> None:
    coordinates = []
    refine = surface.refine

    def noted(scene: Scene, model: Any, *rest: Any, **more: Any) -> Any:
        coordinates.append(model.coordinates)
        return refine(scene, model, *rest, **more)

    monkeypatch.setattr(surface, "refine", noted)
    almost = scene_of(amplitudes=[[1.0, 0.5], [-0.8, -0.4 - 1e-9]], duration=0.05)
    uneven = changed(scene_of(duration=0.05), bodies=[{"mass": 1.0}, {"mass": 1.0, "stiffness": [20.0, 20.000001]}])
    for scene in (scene_of(duration=0.05), almost, uneven):
        multibody.amplification(scene, PHASES, tolerance=0.1)
    multibody.amplification(scene_of(duration=0.05), PHASES, tolerance=0.1, full=True)
    assert coordinates == [7, 8, 8, 8]


@given(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), st.floats(0.1, 2.0), st.floats(0.1, 2.0))
def test_turning_a_scene_into_its_plane_keeps_the_loading(x: float, y: float, first: float, second: float) -> None:
    scene = scene_of(amplitudes=[[x, 2.0 * x], [y, 2.0 * y], [first, second]])  # powers of two keep proportions exact
    turned = in_plane(scene)
    assert planar(scene)
    assert not turned.amplitudes[1].any()
    phases = np.array([(0.3, 1.1), (4.0, 2.0)])
    np.testing.assert_allclose(ground_peak(turned, phases), ground_peak(scene, phases), rtol=1e-13)
    np.testing.assert_array_equal(turned.stiffness, scene.stiffness)
    damped = CASES["along y, links of two stiffnesses"].with_values({"bodies.1.damping": [0.2, 0.7]})
    assert in_plane(damped).damping.tolist() == [[0.7, 0.2]]
