"""A model that is refused for its work says so from the scene alone, by how much, and what helps."""

import re

import numpy as np
import pytest
from scenes_at_hand import changed, frame

import multibody
from reference.problem import Outcome, load_scene

WORK = 5e3  # steps


def test_a_refusal_names_durations_that_are_true() -> None:
    said = multibody.refusal(frame(20.0), "spatial", max_work=WORK)
    needed = re.search(r"needs (\S+) steps", said)
    assert needed is not None
    assert float(needed[1]) > WORK
    assert "40 coordinates" in said, "six of each of six bodies, and one of each of four supports that share the load"
    tried = re.search(r"above (\S+) s no step", said)
    enough = re.search(r"duration to about (\S+) s", said)
    assert tried is not None
    assert enough is not None
    assert float(enough[1]) < float(tried[1]) < 20.0
    assert multibody.refusal(frame(0.95 * float(tried[1])), "spatial", max_work=WORK) == ""
    assert multibody.refusal(frame(1.001 * float(tried[1])), "spatial", max_work=WORK) != ""


def test_a_refusal_depends_on_the_model_alone() -> None:
    for tolerance in (1e-5, 1e-3, 1e-1):
        options = {"model": "spatial", "tolerance": tolerance, "max_work": WORK}
        assert "a looser tolerance does not help" in multibody.refusal(frame(20.0), **options)
        point = multibody.amplification(frame(20.0), [(0.1, 0.2)], **options)
        assert (point.status[0], point.instant[0]) == (Outcome.STEP_LIMIT, 0.0)
        assert np.isnan(point.mu).all()


def test_what_is_tried_is_not_refused() -> None:
    scene = changed(load_scene("fig3-I"), duration=0.5)
    assert [multibody.refusal(scene, model) for model in ("translational", "spatial")] == ["", ""]


@pytest.mark.parametrize(("duration", "period"), [(30.0, 0.17), (60.0, 0.02)])
def test_frames_of_six_and_twenty_floors_are_not_refused(duration: float, period: float) -> None:
    for count in (6, 20):
        for model in ("translational", "spatial"):
            assert multibody.refusal(frame(duration, count, period), model) == ""
