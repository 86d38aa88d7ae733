"""The one way to change values of a scene: by dotted key, validated like a scene file."""

import pickle
from typing import Any

import numpy as np
import pytest
from chains import refusal

from comparison.evidence.scaling.analysis import scale_scene
from reference.problem import Scene, SceneError, builtin_scenes, load_family, load_scene
from reference.problem.reductions import turn_loading_to_x
from reference.problem.scene_file import scene_text

FIG3 = load_scene("fig3-I")
CHANGED: dict[str, Any] = {
    "isolator.friction": 0.2,
    "bodies.1.height": 0.4,
    "bodies.1.period.1": 3.0,
    "excitation.amplitudes.0.1": -3.0,
    "duration": 3.0,
    "name": "other",
    "acceptance.failed": 2,
    "acceptance.total": {"median": 0.1},
    "acceptance.mine.ratio": 2.0,
}


def test_a_value_is_changed_by_its_dotted_key() -> None:
    before = FIG3.model_dump()
    for key, value in CHANGED.items():
        place: Any = FIG3.with_values({key: value}).model_dump(exclude_none=True)
        for part in key.split("."):
            place = place[int(part)] if isinstance(place, list) else place[part]
        assert place == value
    assert FIG3.model_dump() == before
    for table, update in ((FIG3, {"duration": 3.0}), (FIG3.isolator, {"friction": -0.1})):
        assert "with_values" in str(refusal(table.model_copy, update=update)), "a copy would not be validated"


def test_none_leaves_a_key_out_arrays_are_lists_and_tables_of_the_caller_stay() -> None:
    lubricated = {"isolator.friction": None, "isolator.lubrication": np.float64(0.5)}
    scene = FIG3.with_values({**lubricated, "bodies.1.period": None, "bodies.1.stiffness": np.array([1.0, 2.0])})
    assert (scene.lubricated, scene.stiffness.tolist()) == (True, [[1.0, 2.0]])
    bars = {"count": 4, "bending_stiffness": 1.0, "length": 1.0}
    values = {"bodies.1.period": None, "bodies.1.bars": bars, "bodies.1.bars.length": 2.0}
    assert (FIG3.with_values(values).bodies[1].bars.length, bars["length"]) == (2.0, 1.0)


def test_copies_without_changes_and_dumps_stay_valid() -> None:
    limited = FIG3.with_values({"acceptance.mine.median": 0.1})
    assert limited.acceptance.list_limited_differences()[-1] == ("mine.median", "mine", "median", 0.1)
    assert limited != FIG3
    assert limited.digest() == FIG3.digest()
    for scene in (FIG3, limited):
        read = Scene.model_validate(scene.model_dump(exclude_none=True))
        for same in (read, scene.model_copy(), scene.model_copy(deep=True), pickle.loads(pickle.dumps(scene))):
            assert (same, same.digest(), hash(same)) == (scene, scene.digest(), hash(scene))


def test_a_scale_is_the_same_as_larger_amplitudes_and_counts_once() -> None:
    assert "scale" not in FIG3.model_dump(exclude_none=True)["excitation"]
    for scene in map(load_scene, builtin_scenes()):
        by_key = scene.with_values({"excitation.scale": 1.7})
        by_hand = scene.with_values({"excitation.amplitudes": (1.7 * scene.amplitudes).tolist()})
        assert np.array_equal(by_key.amplitudes, by_hand.amplitudes)
        assert by_key.digest() != scene.digest()
        assert np.array_equal(scale_scene(by_key, 0.5).amplitudes, scale_scene(by_hand, 0.5).amplitudes)
        assert np.abs(by_key.with_amplitude(3.0).amplitudes).max() == pytest.approx(3.0)
        plane = by_key.with_values({"excitation.amplitudes": [[0.0, 0.0], [1.0, 0.5]]})
        assert turn_loading_to_x(plane).amplitudes[0] == pytest.approx([1.7, 0.85])


def test_the_record_of_a_scene_is_changed_by_its_keys(tmp_path: Any) -> None:
    for number in (1, 2):
        (tmp_path / f"{number}.csv").write_text(f"time [s],ax [m/s^2]\n0,0\n1,{number}\n2,0\n")
    record = {"suite": str(tmp_path), "motion": 1}
    first = FIG3.with_values({"excitation": {"record": record, "scale": 3.0}, "duration": 2.0})
    second = first.with_values({"excitation.record.motion": 2})
    assert [scene.record[1, 1] for scene in (first, second)] == [3.0, 6.0]
    assert first.with_values({"excitation.scale": 2.0}).record[1, 1] == 2.0
    assert first.with_amplitude(12.0).record[1, 1] == pytest.approx(12.0)
    assert "did you mean motion" in refusal(first.with_values, {"excitation.record.motions": 2}).rule
    pair = load_scene("synthetic-pair")
    said = refusal(pair.with_values, {"excitation.record.motion": 4}, kind=SceneError)
    assert said.rule == "excitation.record has no keys to set one by one: give excitation.record as a whole"


@pytest.mark.parametrize("duration", ["2.0", "{values = [1.0, 2.0]}"])
def test_a_byte_order_mark_is_no_part_of_a_scene_or_record(duration: str, tmp_path: Any) -> None:
    file, text = tmp_path / "mine.toml", scene_text("fig3-I").decode().replace("20.0", duration)
    file.write_bytes(b"\xef\xbb\xbf" + text.encode())
    assert load_family(file).scenes[-1].duration == 2.0
    (tmp_path / "a.csv").write_bytes(b"\xef\xbb\xbftime [s],ax [g]\n0,0\n0.5,0.1\n1,0\n")
    head = text[: text.index("[excitation]")].replace(duration, "2.0")
    file.write_text(head + '[excitation]\nrecord = "a.csv"\n')
    assert len(load_scene(file).record) == 3


@pytest.mark.parametrize(
    "text",
    [
        "a." * 5000 + "a = 1",
        "duration = {range = [1, 1" + "0" * 400 + "], steps = 2}",
        "duration = 1" + "0" * 5000,
        'title = "' + "x" * 100_000 + '"\nisolator = 3',
        'title = "a\\u0001b"',
    ],
)
def test_keys_and_numbers_of_any_length_are_one_line(text: str, tmp_path: Any) -> None:
    (tmp_path / "mine.toml").write_text(text)
    for read in (load_scene, load_family):
        assert len(str(refusal(read, tmp_path / "mine.toml", kind=SceneError))) < 700


@pytest.mark.parametrize(
    ("values", "name"),
    [
        ({"isolator.friction": 0.123456789}, "fig3-I[friction=0.123456789]"),
        ({"isolator.friction": 0.12, "duration": 3}, "fig3-I[friction=0.12, duration=3]"),
        ({"bodies.1.mass": 2.0}, "fig3-I[bodies.1.mass=2]"),
        ({"isolator.friction": None, "isolator.lubrication": 0.5}, "fig3-I[friction=none, lubrication=0.5]"),
        (
            {"isolator.friction": {"slow": 0.03, "fast": 0.06, "rate": 50}},
            "fig3-I[friction=slow=0.03+fast=0.06+rate=50]",
        ),
        ({"excitation.amplitudes": [[2.0, 0.0], [0.0, 1.0]]}, "fig3-I[amplitudes changed]"),
        ({"isolator.friction": 0.1, "duration": 20}, "fig3-I"),
        ({"title": "another", "acceptance.failed": 2, "analyses": {}}, "fig3-I"),
        ({"isolator.friction": 0.12, "name": "mine"}, "mine"),
        ({f"bodies.{n}.{key}": 0.7 for n in (0, 1) for key in ("mass", "height", "yaw")}, "fig3-I[changed]"),
    ],
)
def test_the_name_of_a_changed_scene_shows_what_was_changed(values: dict[str, Any], name: str) -> None:
    changed = FIG3.with_values(values)
    assert changed.name == name
    assert repr(changed).startswith(f"<Scene {name}: ")
    read = Scene.model_validate(changed.model_dump(exclude_none=True))
    assert (read, read.name) == (changed, name)


def test_a_scene_changed_twice_names_the_last_value_of_each_key() -> None:
    twice = FIG3.with_values({"isolator.friction": 0.12, "duration": 3.0}).with_values({"isolator.friction": 0.13})
    assert twice.name == "fig3-I[duration=3, friction=0.13]"
    assert FIG3.with_amplitude(2.0).name == "fig3-I[amplitude=2]"
    assert FIG3.with_amplitude(2.0).with_amplitude(3.0).name == "fig3-I[amplitude=3]"
    assert load_scene("fig3-I", amplitude=2.0).name == "fig3-I", "a scene of a file is named after it"
    assert load_family("fig3-I", amplitude=2.0).scenes[0].name == "fig3-I"
    bars = {"bodies.1.period": None, "bodies.1.bars": {"count": 4, "bending_stiffness": 20.0, "length": 1.0}}
    assert FIG3.with_values({**bars, "name": "bars"}).softened().name == "bars[softened]"
    assert FIG3.softened().name == "fig3-I"
