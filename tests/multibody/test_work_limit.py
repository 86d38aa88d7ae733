"""A model that is refused for its work says so from the scene alone, by how much, and what helps."""

import re

import numpy as np
import pytest
from scenes_at_hand import both_sides, changed, frame

import multibody
import reference
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


@pytest.mark.long
def test_at_what_a_refusal_names_there_are_values() -> None:
    said = multibody.refusal(frame(20.0), "translational", max_work=WORK)
    enough = re.search(r"duration to about (\S+) s", said)
    work = re.search(r"max_work or --max-work, about (\S+) steps", said)
    assert enough is not None
    assert work is not None
    shorter = multibody.amplification(frame(float(enough[1])), [(0.1, 0.2)], max_work=WORK)
    allowed = multibody.amplification(frame(20.0), [(0.1, 0.2)], max_work=float(work[1]))
    assert np.isfinite(shorter.mu).all(), shorter.status
    assert np.isfinite(allowed.mu).all(), allowed.status


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


def test_work_that_runs_out_fails_no_solver() -> None:
    """
    With v_reg so small rounding forbids a contact that friction does not outrun: levels share one, a softer one shows
    what it changes, and Newton iterations double the steps of a light platform.
    """
    floors = frame(0.3, 2, 0.2).model_dump(exclude_none=True)["bodies"]
    bodies = [{**floors[0], "mass": 5.0}, floors[1]]
    scene = changed(frame(0.3, 2, 0.2), bodies=bodies, isolator={"radius": 0.34, "friction": 0.02})
    equations = reference.amplification(scene, [(1.3, 3.8)], regularization=1e-6)
    for work, outcome in ((1e4, Outcome.STEP_LIMIT), (2.5e4, Outcome.STEP_LIMIT), (6e4, Outcome.TOLERANCE_NOT_MET)):
        engine = multibody.amplification(scene, [(1.3, 3.8)], regularization=1e-6, max_work=work)
        assert engine.status.tolist() == [outcome]
    assert (np.abs(engine.mu - equations.mu) <= engine.error + equations.error).all()


@pytest.mark.parametrize(("duration", "period"), [(30.0, 0.17), (60.0, 0.02)])
def test_frames_of_six_and_twenty_floors_are_not_refused(duration: float, period: float) -> None:
    for count in (6, 20):
        for model in ("translational", "spatial"):
            assert multibody.refusal(frame(duration, count, period), model) == ""


@pytest.mark.long
@pytest.mark.parametrize(("count", "duration", "period"), [(6, 60.0, 0.17), (20, 60.0, 0.05), (100, 5.0, 0.17)])
def test_tall_frames_have_answers_within_the_tolerance(count: int, duration: float, period: float) -> None:
    both_sides(frame(duration, count, period), [(0.1, 0.2)])


@pytest.mark.long
def test_a_frame_of_six_floors_has_support_forces() -> None:
    motion = multibody.trajectory(frame(30.0), (0.1, 0.2), model="spatial")
    weight = 6e3 * 9.80665
    assert motion.status == Outcome.OK
    assert motion.extra["support_force"].sum(axis=1) == pytest.approx(weight, rel=0.1)
