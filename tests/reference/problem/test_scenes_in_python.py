"""Scenes that are built and changed in Python: arrays and tuples for lists, records from arrays, equality and hash."""

import re

import numpy as np
import pytest
from chains import refusal
from pydantic import ValidationError

from reference.problem import Scene, SceneError, load_scene

FIG3 = load_scene("fig3-I")
TIME = np.array([5.0, 5.1, 5.3, 5.4])
ALONG_X = np.array([0.5, 1.0, -3.0, 0.0])


def table(**excitation):
    return {
        "title": "built in Python",
        "isolator": {"radius": 0.25, "friction": 0.1},
        "bodies": [{"mass": 1.0}, {"mass": np.float64(2.0), "period": (0.5, 0.4)}],
        "excitation": excitation,
    }


def recorded(time=TIME, acceleration=ALONG_X, **others):
    return Scene.model_validate(table(record={"time": time, "acceleration": acceleration}) | others)


def two_frequencies(amplitudes):
    return Scene.model_validate(
        table(amplitudes=amplitudes, periods=np.array([0.9, 1.1]), decay=(0.3, 0.3)) | {"duration": np.float64(3.0)}
    )


def test_arrays_and_tuples_make_the_scene_that_lists_make():
    scene = two_frequencies(np.eye(2))
    assert scene == two_frequencies([[1.0, 0.0], [0.0, 1.0]])
    assert scene.bodies[1].period == [0.5, 0.4]
    assert scene == Scene.model_validate(scene.model_dump(exclude_none=True))


def test_a_record_from_arrays_is_that_of_a_file_and_counts_time_from_its_start(tmp_path):
    scene = recorded()
    assert (scene.duration, scene.excitation.files) == (pytest.approx(0.4), "arrays")
    np.testing.assert_allclose(scene.record, [[0, 0.5, 0, 0], [0.1, 1, 0, 0], [0.3, -3, 0, 0], [0.4, 0, 0, 0]])
    values = np.arange(1.0, 13.0).reshape(4, 3)
    np.testing.assert_array_equal(recorded(acceleration=values, duration=0.2).record[:4, 1:], values)
    rows = "\n".join(f"{t},{a}" for t, a in zip(TIME.tolist(), ALONG_X.tolist()))
    (tmp_path / "a.csv").write_text(f"time [s],ax [m/s^2]\n{rows}\n")
    assert Scene.model_validate(table(record=str(tmp_path / "a.csv"))).digest() == scene.digest()


def test_the_record_of_a_scene_is_changed_by_arrays_and_by_nothing_else():
    record = {"time": TIME, "acceleration": 2.0 * ALONG_X}
    np.testing.assert_array_equal(recorded().with_values({"excitation.record": record}).record[:, 1], 2.0 * ALONG_X)
    replaced = FIG3.with_values({"excitation": {"record": record, "scale": 0.5}})
    record["acceleration"][:] = 7.0
    np.testing.assert_array_equal(replaced.record[:, 1], ALONG_X)
    assert replaced.duration == FIG3.duration
    with pytest.raises(ValueError, match="read-only"):
        replaced.excitation.samples[0, 1] = 7.0


@pytest.mark.parametrize(
    ("time", "acceleration", "rule"),
    [
        (TIME, ALONG_X[:3], "acceleration: shape (3,) at 4 instants"),
        (TIME, np.zeros((4, 4)), "acceleration: shape (4, 4)"),
        (TIME[:, None], ALONG_X, "time: shape (4, 1)"),
        (TIME[::-1], ALONG_X, "-0.2 s from sample to sample"),
        (TIME[:1], ALONG_X[:1], "1 samples: must have at least 2"),
        (TIME, [0.0, np.nan, 0.0, 0.0], "acceleration: must be finite"),
        ("soon", ALONG_X, "time = 'soon': must be numbers"),
    ],
)
def test_arrays_that_are_no_record_are_refused_in_one_line(time, acceleration, rule):
    record = {"time": time, "acceleration": acceleration}
    said = refusal(recorded().with_values, {"excitation.record": record}, kind=SceneError)
    assert said.key == "excitation.record"
    assert said.rule.startswith(rule)
    with pytest.raises(ValidationError, match=re.escape(rule)):
        recorded(time, acceleration)


def test_equal_scenes_have_equal_hashes_and_others_do_not():
    for make in (recorded, lambda: two_frequencies(np.eye(2)), lambda: load_scene("fig3-I")):
        assert make() == make()
        assert hash(make()) == hash(make())
    assert len({FIG3, *(FIG3.with_values({"isolator.friction": value}) for value in (0.1, 0.2, 0.3))}) == 3
    assert len({recorded(), recorded(acceleration=2.0 * ALONG_X), recorded()}) == 2, "samples count, too"
    negative, positive = (two_frequencies([[0.0, 1.0], [1.0, zero]]) for zero in (-0.0, 0.0))
    assert (negative, hash(negative)) == (positive, hash(positive))
