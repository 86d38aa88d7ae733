"""`excitation.scale` of the two-frequency loading: the same as larger amplitudes, everywhere."""

import numpy as np
import pytest

from comparison.analyses.scaling.analysis import scaled
from reference.problem import Scene, SceneError, builtin_scenes, in_plane, load_scene


def both(name: str) -> tuple[Scene, Scene]:
    """A scene scaled by its key, and by its amplitudes."""
    scene = load_scene(name).with_values({"duration": 2.0})
    by_hand = scene.with_values({"excitation.amplitudes": (1.7 * scene.amplitudes).tolist()})
    return scene.with_values({"excitation.scale": 1.7}), by_hand


def test_a_scale_is_the_same_as_larger_amplitudes() -> None:
    for name in builtin_scenes():
        by_key, by_hand = both(name)
        assert np.array_equal(by_key.amplitudes, by_hand.amplitudes)


def test_no_scaled_scene_is_scaled_twice() -> None:
    by_key, by_hand = both("fig3-I")
    assert np.array_equal(scaled(by_key, 0.5).amplitudes, scaled(by_hand, 0.5).amplitudes)
    assert np.abs(by_key.with_amplitude(3.0).amplitudes).max() == pytest.approx(3.0)
    plane = by_key.with_values({"excitation.amplitudes": [[0.0, 0.0], [1.0, 0.5]]})
    assert in_plane(plane).amplitudes[0] == pytest.approx([1.7, 0.85])


def test_a_scale_that_is_not_given_changes_no_digest() -> None:
    scene = load_scene("fig3-I")
    assert "scale" not in scene.model_dump(exclude_none=True)["excitation"]
    assert scene.with_values({"excitation.scale": 2.0}).digest() != scene.digest()


def test_a_scale_beyond_double_precision_is_refused_in_one_line() -> None:
    with pytest.raises(SceneError, match=r"excitation\.scale.*must leave every acceleration finite"):
        load_scene("fig3-I").with_values(
            {"excitation.amplitudes": [[1e308, 0.0], [0.0, 1.0]], "excitation.scale": 1e10}
        )
