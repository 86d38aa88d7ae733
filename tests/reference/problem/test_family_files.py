"""Values of a scene that run make a scene of each, or of every combination; what is no range is one line."""

from pathlib import Path

import numpy as np
import pytest
from chains import refusal

import reference
from reference.problem import SceneError, builtin_scenes, load_family, load_scene
from reference.problem.families import family_of
from reference.problem.scene_file import scene_text


def _file(tmp_path: Path, old: str, new: str) -> Path:
    text = scene_text("fig3-I").decode()
    assert old in text
    file = tmp_path / "mine.toml"
    file.write_text(text.replace(old, new), encoding="utf-8")
    return file


def test_a_range_makes_a_scene_of_every_value(tmp_path: Path) -> None:
    family = load_family(_file(tmp_path, "friction = 0.1", "friction = {range = [0.02, 0.2], steps = 10}"))
    assert (family.name, family.key) == ("mine", "isolator.friction")
    assert family.values == (0.02, 0.04, 0.06, 0.08, 0.1, 0.12, 0.14, 0.16, 0.18, 0.2), "no digits of rounding"
    assert [scene.friction_coefficient for scene in family.scenes] == list(family.values)
    assert [scene.name for scene in family.scenes][:2] == ["mine[friction=0.02]", "mine[friction=0.04]"]
    fifth = family.scenes[4]
    assert fifth.digest() == load_scene("fig3-I").digest(), "the same question as with the number written there"


FAST = "{slow = 0.05, fast = {values = [0.1, 0.08]}, rate = 50.0}"
KEYS = {
    "at the top": ("duration = 20.0", "duration = {range = [5, 20], steps = 4}", "duration", (5, 10, 15, 20)),
    "whole numbers": ("supports = 4", "supports = {range = [3, 5], steps = 3}", "isolator.supports", (3, 4, 5)),
    "of a body": (
        "mass = 1.0\nperiod",
        "mass = {range = [1.1, 1.7], steps = 3}\nperiod",
        "bodies.1.mass",
        (1.1, 1.4, 1.7),
    ),
    "in a list": ("[[1.0, 0.0]", "[[{range = [1.5, 2.5], steps = 2}, 0.0]", "excitation.amplitudes.0.0", (1.5, 2.5)),
    "fast friction": ("friction = 0.1", f"friction = {FAST}", "isolator.friction.fast", (0.1, 0.08)),
    "values": ("friction = 0.1", "friction = {values = [0.3, 0.05]}", "isolator.friction", (0.3, 0.05)),
    "texts": (f'title = "{load_scene("fig3-I").title}"', 'title = {values = ["a", "b"]}', "title", ("a", "b")),
}


@pytest.mark.parametrize(("old", "new", "key", "values"), KEYS.values(), ids=KEYS.keys())
def test_any_key_of_one_value_may_run(tmp_path: Path, old: str, new: str, key: str, values: tuple[object, ...]) -> None:
    family = load_family(_file(tmp_path, old, new))
    assert (family.key, family.values, len(family.scenes)) == (key, values, len(values))
    short = key if any(part.isdigit() for part in key.split(".")) else key.split(".")[-1]
    assert [scene.name for scene in family.scenes] == [f"mine[{short}={value}]" for value in values]


def test_names_have_as_many_digits_as_it_takes(tmp_path: Path) -> None:
    family = load_family(_file(tmp_path, "friction = 0.1", "friction = {range = [0.1, 0.10001], steps = 3}"), 3.0)
    assert [scene.name for scene in family.scenes] == [f"mine[friction={n}]" for n in (0.1, 0.100005, 0.10001)]
    assert [scene.amplitudes.max() for scene in family.scenes] == [3.0] * 3, "every member is scaled"


def test_a_scene_without_a_range_is_a_family_of_one() -> None:
    for name in builtin_scenes():
        family = load_family(name)
        assert family.scenes == (load_scene(name),)
        assert (family.name, family.key, family.values) == (name, "", ())
        assert load_family(name, 3.0).scenes == (load_scene(name, 3.0),)


WRONG = [  # what runs, and the line behind isolator.friction
    ("{range = [0.1, 0.2]}", " = {'range': [0.1, 0.2]}: must be {range = [lowest, highest]"),
    ("{range = [0.2, 0.1], steps = 3}", ".range = [0.2, 0.1]: must be two finite numbers"),
    ("{range = [0.1, 0.2], steps = 1}", ".steps = 1: must be a whole number from 2 to 1000"),
    ("{range = [-0.1, 0.2], steps = 4}", " = -0.1: must be greater than"),
    ("{values = []}", ".values = []: must be a list of 1 to 1000 finite numbers"),
    ("{values = [0.1, 0.1]}", " = 0.1: is there twice"),
]


@pytest.mark.parametrize(("table", "line"), WRONG)
def test_what_is_no_range_is_one_line(tmp_path: Path, table: str, line: str) -> None:
    file = _file(tmp_path, "friction = 0.1", f"friction = {table}")
    assert str(refusal(load_family, file)).startswith(f"{file}: isolator.friction{line}")
    said = refusal(load_scene, _file(tmp_path, "friction = 0.1", "friction = {values = [0.02, 0.2]}"))
    assert (said.key, said.rule[:32]) == ("isolator.friction", "makes a family of scenes, and on")


def test_the_value_that_runs_is_a_coordinate_of_results(tmp_path: Path) -> None:
    family = load_family(_file(tmp_path, "friction = 0.1", "friction = {values = [0.2, 0.02]}"))
    results = [reference.amplification(scene, (0.3, 1.1), tolerance=1e-3) for scene in family.scenes]
    data = family.to_xarray(results)
    assert data["mu"].dims == ("friction", "body")
    np.testing.assert_array_equal(data["mu"].sel(friction=0.02), results[1].mu)
    with pytest.raises(ValueError, match="results: 1: must be as many as the scenes of the family, 2"):
        family.to_xarray(results[:1])


SCENE = """{top}
title = "combined"
duration = 1.0
isolator = {{radius = 0.25, friction = {friction}}}
bodies = [{{mass = 1.0}}]
excitation = {{record = {record}, scale = {scale}}}
"""
SUITE = '{suite = "suite", motion = "all"}'
TWO = "{values = [0.05, 0.1]}"


@pytest.fixture
def written(tmp_path):
    (tmp_path / "suite").mkdir()
    for number in (1, 2, 3):
        text = f"time [s],ax [m/s^2]\n0,0\n0.5,{number}\n1,0\n"
        (tmp_path / "suite" / f"{number}.csv").write_text(text)

    def write(top="", friction=0.1, record='"suite/1.csv"', scale=1.0):
        path = tmp_path / "mine.toml"
        path.write_text(SCENE.format(top=top, friction=friction, record=record, scale=scale))
        return path

    return write


def test_a_product_has_every_combination_last_key_fastest(written):
    family = load_family(written('combine = "product"', record=SUITE, scale="{range = [0.5, 1.0], steps = 2}"))
    assert family.key == "excitation.record.motion, excitation.scale"
    assert family.columns == {
        "excitation.record.motion": (1, 1, 2, 2, 3, 3),
        "excitation.scale": (0.5, 1.0, 0.5, 1.0, 0.5, 1.0),
    }
    assert [float(scene.record[1, 1]) for scene in family.scenes] == [0.5, 1.0, 1.0, 2.0, 1.5, 3.0]
    assert family.scenes[3].name == "mine[motion=2, scale=1]"
    assert family.values[3] == "2, 1"
    assert len({scene.name for scene in family.scenes}) == 6


@pytest.mark.parametrize(("top", "dims"), [("product", {"scale": 2, "friction": 2}), ("zip", {"scene": 2})])
def test_keys_of_a_product_are_axes_of_its_results(written, top, dims):
    family = load_family(written(f'combine = "{top}"', friction=TWO, scale="{values = [3.0, 1.0]}"))
    data = family.to_xarray([reference.amplification(scene, (0.0, 0.0), tolerance=1e-3) for scene in family.scenes])
    assert dict(data["mu"].isel(body=0).sizes) == dims
    assert (family.scenes[-1].friction_coefficient, float(family.scenes[-1].record[1, 1])) == (0.1, 1.0)
    last = data["mu"].sel(friction=0.1, scale=1.0) if top == "product" else data["mu"].isel(scene=1)
    np.testing.assert_array_equal(last, reference.amplification(family.scenes[-1], (0.0, 0.0), tolerance=1e-3).mu)


RANGE = "{range = [0.1, 0.2], steps = 100}"
MISFITS = [
    ({"friction": TWO, "scale": TWO}, "excitation.scale", 'add combine = "product" or combine = "zip"'),
    ({"top": 'combine = "sum"', "friction": TWO, "scale": TWO}, "combine", "must be one of product, zip"),
    ({"top": 'combine = "zip"', "friction": TWO}, "combine", "two or more keys must run"),
    ({"top": 'combine = "zip"', "friction": TWO, "record": SUITE}, "combine", "friction 2, excitation.record.motion 3"),
    (
        {"top": 'combine = "product"', "friction": RANGE, "scale": RANGE.replace("100", "11")},
        "combine",
        "1100 scenes: must be at most 1000",
    ),
]


@pytest.mark.parametrize(("options", "key", "rule"), MISFITS)
def test_keys_that_cannot_run_together_are_refused_in_one_line(written, options, key, rule):
    said = refusal(load_family, written(**options), kind=SceneError)
    assert said.key == key
    assert rule in said.rule


def test_a_family_of_many_bodies_is_refused_before_its_scenes_are_made():
    bodies = [{"mass": 1.0}] + 100 * [{"mass": 1.0, "period": [1.0, 1.0]}]
    said = refusal(family_of, {"bodies": bodies, "duration": {"range": [1.0, 2.0], "steps": 500}}, "mine.toml")
    assert (said.key, said.value) == ("bodies: 101 in each of 500 scenes", 50_500)
