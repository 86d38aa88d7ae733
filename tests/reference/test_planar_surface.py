"""A motion that stays in a plane (4.7) is solved in it: the same surface, where and only where it stays there."""

from typing import Any

import numpy as np
import pytest
from chains import chain

import reference
from reference.problem import load_scene, phase_grid

TWO = {"masses": [1.0, 0.5], "stiffness": [[20.0, 20.0]]}
OBLIQUE = [[1.0, 0.5], [-0.8, -0.4]]
SCENES = {
    "fig4-dry": load_scene("fig4-dry"),
    "fig4-viscous": load_scene("fig4-viscous"),
    "one body": chain(amplitudes=[[1.0, 1.0], [0.5, 0.5]]),
    "oblique, vertical too": chain(**TWO, amplitudes=[*OBLIQUE, [0.5, 0.3]]),
    "along y, links of two stiffnesses": chain(
        masses=[1.0, 0.5, 0.5], stiffness=[[20.0, 30.0], [15.0, 25.0]], amplitudes=[[0.0, 0.0], [1.0, 0.7]], damping=0.2
    ),
}
LAWS: dict[str, dict[str, Any]] = {
    "small": {"equations": "small"},
    "exact": {"equations": "exact"},
    "v_reg": {"equations": "exact", "regularization": 1e-3},
    "printed": {"equations": "small", "rest_condition": "printed"},  # (4.6) is not the same in every direction
}


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("name", SCENES)
def test_the_answer_is_that_of_both_axes(name: str, law: str) -> None:
    scene = SCENES[name]
    reduced, full = (reference.amplification(scene, phase_grid(4), **LAWS[law], full=full) for full in (False, True))
    assert reduced.status.tolist() == full.status.tolist()
    assert (full.status == "ok").all()
    assert (np.abs(reduced.mu - full.mu) <= reduced.error + full.error).all()
