"""A model that is refused for its work says so from the scene alone, by how much, and what helps."""

from __future__ import annotations

import re

import numpy as np
import pytest
from scenes_at_hand import changed

import multibody
from reference.problem import Outcome, Scene, load_scene


def _frame(duration: float) -> Scene:
    """Six stiffly linked floors on wide supports."""
    above = [
        {"mass": 1e3, "period": [0.17, 0.17], "height": 0.2 + 3.0 * floor, "size": [12.0, 12.0, 0.4]}
        for floor in range(1, 6)
    ]
    return Scene.model_validate(
        {
            "title": "frame",
            "duration": duration,
            "isolator": {"radius": 2.24, "friction": 0.05, "supports": 4, "ring": 6.0, "sphere_radius": 0.05},
            "bodies": [{"mass": 1e3, "height": 0.2, "size": [12.0, 12.0, 0.4]}, *above],
            "excitation": {
                "amplitudes": [[2.943, 0.0], [0.0, 2.943]],
                "periods": [0.8, 1.3],
                "decay": [0.1, 0.1],
            },
        }
    )


def test_a_refusal_tells_by_how_much_and_the_durations_that_it_names_are_true() -> None:
    said = multibody.refusal(_frame(52.0), "spatial")
    assert "1.2 times the work" in said
    assert "40 coordinates" in said, "six of each of six bodies, and one of each of four supports that share the load"
    tried = re.search(r"above (\S+) s no step", said)
    enough = re.search(r"duration to about (\S+) s", said)
    assert tried is not None
    assert enough is not None
    assert float(enough[1]) < float(tried[1]) < 52.0
    assert multibody.refusal(_frame(0.95 * float(tried[1])), "spatial") == ""
    assert multibody.refusal(_frame(1.001 * float(tried[1])), "spatial") != ""


@pytest.mark.long
def test_at_the_duration_that_a_refusal_names_there_are_values() -> None:
    enough = re.search(r"duration to about (\S+) s", multibody.refusal(_frame(52.0), "spatial"))
    assert enough is not None
    found = multibody.amplification(_frame(float(enough[1])), [(0.1, 0.2)], model="spatial")
    assert np.isfinite(found.mu).all(), found.status


def test_a_refusal_is_what_the_model_does_and_no_tolerance_changes_it() -> None:
    for tolerance in (1e-5, 1e-3, 1e-1):
        assert "a looser tolerance does not help" in multibody.refusal(_frame(52.0), "spatial", tolerance=tolerance)
        found = multibody.amplification(_frame(52.0), [(0.1, 0.2)], model="spatial", tolerance=tolerance)
        assert (found.status[0], found.instant[0]) == (Outcome.STEP_LIMIT, 0.0)
        assert np.isnan(found.mu).all()


def test_what_is_tried_is_not_refused() -> None:
    scene = changed(load_scene("fig3-I"), duration=0.5)
    assert [multibody.refusal(scene, model) for model in ("translational", "spatial")] == ["", ""]
