"""A motion that stays in a plane (4.7) is solved in it: the same surface, where and only where it stays there."""

from typing import Any

import numpy as np
import pytest
from chains import chain

import reference
from reference import surface
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
LAWS = {"small": ("small", None, None), "exact": ("exact", None, None), "v_reg": ("exact", 1e-3, None)}


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("name", SCENES)
def test_the_answer_is_that_of_both_axes(name: str, law: str) -> None:
    scene, (equations, v_reg, cutoff) = SCENES[name], LAWS[law]
    reduced, full = (
        reference.amplification(scene, phase_grid(4), equations, v_reg, cutoff=cutoff, full=full)
        for full in (False, True)
    )
    assert reduced.status.tolist() == full.status.tolist()
    assert (full.status == "ok").all()
    assert (np.abs(reduced.mu - full.mu) <= reduced.error + full.error).all()


@pytest.fixture
def axes(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The axes of every system that was solved."""
    noted: list[int] = []
    solved = surface.peaks_with_error

    def seen(system: Any, *rest: Any, **options: Any) -> Any:
        noted.append(system.axes)
        return solved(system, *rest, **options)

    monkeypatch.setattr(surface, "peaks_with_error", seen)
    return noted


def test_a_motion_in_a_plane_has_one_axis_unless_asked_in_full(axes: list[int]) -> None:
    scene = chain(masses=[1.0, 0.5], stiffness=[[20.0, 20.0]], amplitudes=OBLIQUE, duration=0.5)
    reference.amplification(scene, [(0.3, 1.1)])
    reference.amplification(scene, [(0.3, 1.1)], full=True)
    # (4.6) as printed is not the same in every direction
    reference.amplification(scene, [(0.3, 1.1)], rest_condition="printed")
    assert axes == [1, 2, 2]
