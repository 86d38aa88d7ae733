"""With bodies that turn mu_1 converges as v_reg -> 0; in translation it climbs on towards the supremum."""

import numpy as np
import pytest
from scenes_at_hand import changed

import multibody
from reference.problem import load_scene

REGULARIZATIONS = (1e-3, 3e-4, 1e-4)  # m/s


@pytest.mark.long
def test_the_platform_that_turns_converges() -> None:
    scene = changed(load_scene("fig3-I"), duration=6.0)  # all peaks lie in the first five seconds
    values = (np.arange(4) + 0.37) * np.pi / 4.0  # each phase has a symmetry of its own
    phases = np.array([(first, second) for first in values for second in values])
    steps = {}
    for model in ("spatial", "translational"):
        answers = [multibody.amplification(scene, phases, model, regularization=v) for v in REGULARIZATIONS]
        platform = np.array([answer.mu[:, 0] for answer in answers])
        assert np.isfinite(platform).all(), model
        steps[model] = np.abs(np.diff(platform, axis=0) / platform[1:])
    # v_reg falls by 3.3 and 3: the steps of a limit of first order by as much, its errors are up to 1e-3
    first, second = steps["spatial"]
    assert np.median(second) < 0.4 * np.median(first)
    assert (second < 0.5 * first + 2e-3).all()
    assert second.max() < 4e-3
    assert steps["translational"][1].max() > 3.0 * second.max()
