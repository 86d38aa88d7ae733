"""A link given by its bars: k = 12 n E J / l^3, and nothing else than a stiffness to every model."""

import numpy as np
import pytest

from reference.problem import Scene, in_plane, load_scene, planar

BARS = {"count": 4, "bending_stiffness": 0.75, "length": 1.25}
STIFFNESS = 12.0 * 4 * 0.75 / 1.25**3


def linked(**link: object) -> Scene:
    return load_scene("fig3-I").with_values(
        {"duration": 3.0, "bodies.1.period": None, **{f"bodies.1.{key}": value for key, value in link.items()}}
    )


def test_the_printed_factor_would_make_a_link_144_times_softer():
    """A beam clamped at both ends, by its flexibility: the integral of M^2 / (E J) with M = F (l / 2 - s)."""
    s = np.linspace(0.0, BARS["length"], 200_001)
    sway = np.trapezoid((BARS["length"] / 2.0 - s) ** 2, s) / BARS["bending_stiffness"]
    assert linked(bars=BARS).stiffness[0, 0] == pytest.approx(BARS["count"] / sway, rel=1e-8)


def test_a_scene_with_bars_is_turned_into_its_plane():
    scene = linked(bars=BARS).with_values({"excitation.amplitudes": [[0.0, 0.0], [2.0, 1.0]]})
    assert planar(scene)
    assert in_plane(scene).stiffness.tolist() == scene.stiffness.tolist()
    assert scene.with_values({"bodies.1.bars.length": 2.5}).stiffness[0, 0] == pytest.approx(STIFFNESS / 8.0)
    assert Scene.model_validate(scene.model_dump(exclude_none=True)) == scene
    assert scene.digest() != linked(stiffness=[STIFFNESS] * 2).digest()
    assert hash(scene) == hash(Scene.model_validate(scene.model_dump(exclude_none=True)))
