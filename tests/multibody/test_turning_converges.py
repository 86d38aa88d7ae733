"""With bodies that turn mu_1 converges as v_reg -> 0; in translation it climbs on towards the supremum."""

import numpy as np
import pytest
from scenes_at_hand import changed

import multibody
from reference.problem import Scene, load_scene

REGULARIZATIONS = (1e-3, 3e-4, 1e-4)  # m/s


def phases_of(scene: Scene) -> np.ndarray:
    """The different ones among 8 x 8 phases: case I has the symmetry of each phase by itself, case II of both."""
    values = (np.arange(8) + 0.37) * np.pi / 4.0
    first = values[:4]
    second = values[:4] if (scene.amplitudes[:2] != 0.0).sum() == 2 else values
    return np.array([(a, b) for a in first for b in second])


@pytest.mark.long
@pytest.mark.parametrize(("name", "count"), [("fig3-I", 16), ("fig3-II", 32)])
def test_the_platform_that_turns_converges(name: str, count: int) -> None:
    scene = changed(load_scene(name), duration=6.0)  # all peaks lie in the first five seconds
    phases = phases_of(scene)
    assert len(phases) == count
    steps = {}
    for model in ("spatial", "translational"):
        answers = [multibody.amplification(scene, phases, model, regularization=v) for v in REGULARIZATIONS]
        known = np.all([np.isfinite(answer.mu[:, 0]) for answer in answers], axis=0)
        assert known.all(), model
        platform = np.array([answer.mu[:, 0] for answer in answers])
        steps[model] = np.abs(np.diff(platform, axis=0) / platform[1:])
    # v_reg falls by 3.3 and 3: the steps of a limit of first order by as much, its errors are up to 1e-3
    first, second = steps["spatial"]
    assert np.median(second) < 0.4 * np.median(first)
    assert (second < 0.5 * first + 2e-3).all()
    assert second.max() < 4e-3
    climbing = steps["translational"]
    assert climbing[1].max() > 3.0 * second.max()
