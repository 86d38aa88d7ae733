"""The one way to change values of a scene: by dotted key, validated like a scene file."""

import copy
import pickle

import numpy as np
import pytest
from scene_text import GOOD

from reference.problem import Scene, SceneError, example_scenes, load_family, load_scene
from reference.problem.acceptance import Acceptance


def mine(scene: Scene) -> Acceptance:
    return scene.acceptance.of_engines.get("mine", Acceptance())


@pytest.mark.parametrize(
    ("key", "value", "seen"),
    [
        ("isolator.friction", 0.2, lambda scene: scene.friction_coefficient),
        ("bodies.1.height", 0.4, lambda scene: scene.bodies[1].height),
        ("bodies.1.mass", 3.0, lambda scene: scene.masses[1]),
        ("bodies.1.period.1", 3.0, lambda scene: scene.bodies[1].period[1]),
        ("excitation.amplitudes.0.1", -3.0, lambda scene: scene.amplitudes[0, 1]),
        ("duration", 3.0, lambda scene: scene.duration),
        ("name", "other", lambda scene: scene.name),
        ("acceptance.failed", 2, lambda scene: scene.acceptance.failed),
        ("acceptance.total", {"median": 0.1}, lambda scene: (scene.acceptance.total or Acceptance()).stated()),
        ("acceptance.total.median", 0.1, lambda scene: scene.acceptance.total and scene.acceptance.total.median),
        ("acceptance.mine", {"ratio": 2.0}, lambda scene: mine(scene).stated()),
        ("acceptance.mine.ratio", 2.0, lambda scene: mine(scene).ratio),
    ],
)
def test_a_value_is_changed_by_its_dotted_key(key, value, seen):
    scene = load_scene("fig3-I")
    before = scene.model_dump()
    assert seen(scene) != value
    assert seen(scene.with_values({key: value})) == value
    assert scene.model_dump() == before


def test_none_leaves_a_key_out_and_arrays_are_lists():
    scene = load_scene("fig3-I").with_values(
        {
            "isolator.friction": None,
            "isolator.lubrication": np.float64(0.5),
            "bodies.1.period": None,
            "bodies.1.stiffness": np.array([1.0, 2.0]),
        }
    )
    assert scene.lubricated
    assert scene.stiffness.tolist() == [[1.0, 2.0]]


@pytest.mark.parametrize(
    ("key", "value", "rule"),
    [
        ("isolator.frictoin", 0.1, "did you mean friction"),
        ("isolatr.friction", 0.1, "did you mean isolator"),
        ("bodies.1.heigth", 0.1, "did you mean height"),
        ("bodies.1.colour", 0.1, "the keys here are mass, period"),
        ("acceptance.maximun", 0.1, "did you mean maximum"),
        ("acceptance.mine.closure", 0.1, "the keys here are median, maximum, ratio"),
        ("acceptance.my engine.ratio", 0.1, "the name of an engine: letters, digits and -"),
        ("title.x", 0.1, "title has no keys to set one by one: give title as a whole"),
        ("bodies.2.mass", 0.1, "bodies has the indices 0 to 1"),
        ("bodies.mass", 0.1, "indices"),
        ("isolator.friction.x", 0.1, "unknown key"),
        ("isolator.friction.slow", 0.1, "no table: give isolator.friction = {slow = ..., fast = ..., rate = ..., load"),
        ("", 0.1, "unknown key"),
        (".".join(["a"] * 5000), 0.1, "unknown key"),
        ("isolator.friction", "0.1", "number"),
        ("excitation.periods.0", None, "must be a number"),
        ("excitation.record", "a.csv", "takes the place of amplitudes, periods and decay"),
        ("title", "a\0b", "control characters"),
        ("name", "a\nb", "control characters"),
        ("duration", 10**400, "number"),
    ],
)
def test_a_wrong_value_is_one_line_with_scene_key_value_and_rule(key, value, rule):
    with pytest.raises(SceneError) as caught:
        load_scene("fig3-I").with_values({key: value})
    assert rule in caught.value.rule
    assert str(caught.value).startswith("fig3-I: ")
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 700


@pytest.mark.parametrize(
    "update", [{"isolator.friction": 0.1}, {"duration": 3.0}, {"isolator": {"period": 1.0, "friction": -0.1}}]
)
def test_an_unvalidated_copy_is_refused_and_names_the_way(update):
    scene = load_scene("fig3-I")
    with pytest.raises(ValueError, match="with_values"):
        scene.model_copy(update=update)
    with pytest.raises(ValueError, match="with_values"):
        scene.isolator.model_copy(update={"friction": -0.1})


def test_copies_without_changes_and_dumps_stay_valid():
    scene = load_scene("fig3-I")
    for same in (
        scene.model_copy(),
        scene.model_copy(deep=True),
        copy.copy(scene),
        copy.deepcopy(scene),
        pickle.loads(pickle.dumps(scene)),
        Scene.model_validate(scene.model_dump(exclude_none=True)),
    ):
        assert same == scene
        assert same.digest() == scene.digest()


def test_a_record_keeps_its_samples_when_its_scale_changes():
    scene = load_scene(example_scenes()[0])
    twice = scene.with_values({"excitation.scale": 2.0 * scene.excitation.scale})
    np.testing.assert_allclose(twice.record[:, 1:], 2.0 * scene.record[:, 1:])


@pytest.mark.parametrize("content", [GOOD, GOOD.replace("duration = 2.0", "duration = {values = [1.0, 2.0]}")])
def test_a_byte_order_mark_is_no_part_of_a_scene(content, tmp_path):
    file = tmp_path / "mine.toml"
    file.write_bytes(b"\xef\xbb\xbf" + content.encode())
    assert load_family(file).scenes[-1].duration == 2.0


def test_a_byte_order_mark_is_no_part_of_a_record(tmp_path):
    (tmp_path / "a.csv").write_bytes(b"\xef\xbb\xbftime [s],ax [g]\n0,0\n0.5,0.1\n1,0\n")
    table = GOOD[: GOOD.index("[excitation]")] + '[excitation]\nrecord = "a.csv"\n'
    (tmp_path / "mine.toml").write_text(table)
    assert len(load_scene(tmp_path / "mine.toml").record) == 3


@pytest.mark.parametrize(
    "text",
    [
        "a." * 5000 + "a = 1",
        "[isolator]\n" + "a." * 900 + "b = 1",
        "duration = 1" + "0" * 400,
        "duration = {range = [1, 1" + "0" * 400 + "], steps = 2}",
        "duration = {values = [1" + "0" * 400 + ", 2]}",
        "duration = 1" + "0" * 5000,
        'title = "' + "x" * 100_000 + '"\nisolator = 3',
        'title = "a\\u0001b"',
    ],
)
def test_keys_and_numbers_of_any_length_are_one_line(text, tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text(text)
    for read in (load_scene, load_family):
        with pytest.raises(SceneError) as caught:
            read(file)
        assert "\n" not in str(caught.value)
        assert len(str(caught.value)) < 700


def test_tables_of_the_caller_stay_as_they_are() -> None:
    bars = {"count": 4, "bending_stiffness": 1.0, "length": 1.0}
    values = {"bodies.1.period": None, "bodies.1.bars": bars, "bodies.1.bars.length": 2.0}
    assert load_scene("fig3-I").with_values(values).bodies[1].bars.length == 2.0
    assert bars["length"] == 1.0


def test_a_record_is_changed_as_a_whole():
    with pytest.raises(SceneError) as fault:
        load_scene("synthetic-pair").with_values({"excitation.record.motion": 4})
    assert str(fault.value).endswith("has no keys to set one by one: give excitation.record as a whole")


def test_a_scene_with_limits_of_an_engine_is_read_again():
    scene = load_scene("fig3-I").with_values({"acceptance.mine.median": 0.1})
    assert Scene.model_validate(scene.model_dump(exclude_none=True)) == scene != load_scene("fig3-I")
    assert scene.acceptance.differences()[-1] == ("mine.median", "mine", "median", 0.1)
    assert pickle.loads(pickle.dumps(scene)) == scene
    assert scene.digest() == load_scene("fig3-I").digest()
