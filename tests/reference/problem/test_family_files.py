"""Values of a scene that run make a scene of each, or of every combination; what is no range is one line."""

import re
import tomllib
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from chains import refusal

import reference
from reference.problem import SceneError, builtin_scenes, load_family, load_scene
from reference.problem.families import make_family
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
    thirds = load_family(_file(tmp_path, "friction = 0.1", "friction = {range = [0.1, 0.5], steps = 4}"))
    assert thirds.values == (0.1, 0.233333333333, 0.366666666667, 0.5)


FAST = "{slow = 0.05, fast = {values = [0.1, 0.08]}, rate = 50.0}"
KEYS = {
    "at the top": ("duration = 20.0", "duration = {range = [5, 20], steps = 4}", "duration", (5, 10, 15, 20)),
    "halves": ("duration = 20.0", "duration = {range = [5, 6], steps = 3}", "duration", (5, 5.5, 6)),
    "whole numbers": ("supports = 4", "supports = {range = [3, 5], steps = 3}", "isolator.supports", (3, 4, 5)),
    "of a body": ("mass = 1.0\nperiod", "mass = {values = [1.1, 1.7]}\nperiod", "bodies.1.mass", (1.1, 1.7)),
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
    family = load_family(_file(tmp_path, "friction = 0.1", "friction = {range = [0.1, 0.100000001], steps = 3}"), 3.0)
    assert [scene.name for scene in family.scenes] == [f"mine[friction={n}]" for n in (0.1, 0.1000000005, 0.100000001)]
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
    ("{range = [0.2, 0.2], steps = 3}", ".range = [0.2, 0.2]: must be two finite numbers"),
    ("{range = [0.1, 0.2], steps = 1}", ".steps = 1: must be a whole number from 2 to 1000"),
    ("{range = [-0.1, 0.2], steps = 4}", " = -0.1: must be greater than"),
    ('{range = [0.1, "0.2"], steps = 3}', ".range = [0.1, '0.2']: must be two finite numbers"),
    ('{values = [0.1, "a"]}', ".values = [0.1, 'a']: must be a list of 1 to 1000 finite numbers"),
    ('{values = [{x = "a.csv", y = 3}]}', ".values = [{'x': 'a.csv', 'y': 3}]: must be a list of 1 to 1000 finite num"),
    ("{values = []}", ".values = []: must be a list of 1 to 1000 finite numbers"),
    ("{values = [{}]}", ".values = [{}]: must be a list of 1 to 1000 finite numbers, or of texts, or of tables of f"),
    ("{values = [0.1, 0.1]}", ".values = 0.1: is there twice"),
    (
        "{values = [0.1, -2.0, -1.0]}",
        " = -2.0: must be greater than or equal to 0; also isolator.friction = -1.0",
    ),
]


@pytest.mark.parametrize(("table", "line"), WRONG)
def test_what_is_no_range_is_one_line(tmp_path: Path, table: str, line: str) -> None:
    file = _file(tmp_path, "friction = 0.1", f"friction = {table}")
    assert str(refusal(load_family, file)).startswith(f"{file}: isolator.friction{line}")
    said = refusal(load_scene, _file(tmp_path, "friction = 0.1", "friction = {values = [0.02, 0.2]}"))
    assert (said.key, said.rule[:32]) == ("isolator.friction", "makes a family of scenes, and on")


def test_all_keys_that_run_wrongly_are_in_one_line_with_all_other_errors_and_nothing_that_follows(
    tmp_path: Path,
) -> None:
    file = _file(
        tmp_path, "friction = 0.1", "friction = {values = []}\nbounds = [2, 1]\nbound = {values = 3}\ntravel = -1.0"
    )
    top, loading = "duration = -1.0", "scale = {range = [3.0, 1.0], steps = 2}"
    text = file.read_text(encoding="utf-8").replace("[excitation]", f"[excitation]\n{loading}")
    file.write_text("combine = 7\nnamed = 1\n" + re.sub("duration = .*", top, text), encoding="utf-8")
    said = str(refusal(load_family, file)).removeprefix(f"{file}: ").split("; also ")
    assert [line.partition(": ")[0] for line in said] == [
        "combine = 7", "named = 1", "duration = -1.0", "isolator.friction.values = []", "isolator.bounds = [2, 1]",
        "isolator.bound = {'values'",
        "isolator.bound.values = 3", "isolator.travel = -1.0", "excitation.scale.range = [3.0, 1.0]",
    ]  # fmt: skip
    both = _file(tmp_path, "friction = 0.1", "friction = {values = []}\ntravel = {values = [-1.0, 2.0]}")
    both.write_text('combine = "product"\n' + both.read_text(encoding="utf-8"), encoding="utf-8")
    said_of_both = str(refusal(load_family, both)).removeprefix(f"{both}: ").split("; also ")
    assert [line.partition(": ")[0] for line in said_of_both] == [
        "isolator.friction.values = []",
        "isolator.travel = -1.0",
    ]
    assert "the keys here are combine, title" in said[1], "a scene file has no name"
    assert "did you mean bounds?" in said[5]


def test_a_line_has_fifty_errors_and_the_number_of_the_others(tmp_path: Path) -> None:
    values = ", ".join(f"-{number}.0" for number in range(1, 61))
    said = str(refusal(load_family, _file(tmp_path, "friction = 0.1", f"friction = {{values = [{values}]}}")))
    assert said.count("; also ") == 49
    assert said.endswith("; and 10 more")


def test_a_line_names_the_files_of_its_errors_and_has_no_control_characters() -> None:
    others = [SceneError("scene", "b", 2, "rule"), SceneError("list", "c", 3, "rule")]
    assert str(SceneError("scene", "a", 1, "x\x1b\n", others)) == (
        "scene: a = 1: x\ufffd\ufffd; also b = 2: rule; also list: c = 3: rule"
    )


def test_the_value_that_runs_is_a_coordinate_of_results(tmp_path: Path) -> None:
    family = load_family(_file(tmp_path, "friction = 0.1", "friction = {values = [0.2, 0.02]}"))
    results = [reference.amplification(scene, (0.3, 1.1), tolerance=1e-3) for scene in family.scenes]
    data = family.to_xarray(results)
    assert data["mu"].dims == ("friction", "body")
    np.testing.assert_array_equal(data["mu"].sel(friction=0.02), results[1].mu)
    with pytest.raises(ValueError, match="results: 1: must be as many as the scenes of the family, 2"):
        family.to_xarray(results[:1])
    alone = load_family(combined(tmp_path, 'combine = "product"', "{values = [0.2]}", "{values = [3.0]}"))
    assert alone.to_xarray(results[:1])["mu"].dims == ("scene", "body")
    limits = {"median": {"values": [0.2, 0.1]}, "total": {"median": {"values": [0.4, 0.3]}}}
    data = {**tomllib.loads(scene_text("fig3-I").decode()), "combine": "zip", "acceptance": limits}
    columns = {"acceptance.median": [0.2, 0.1], "acceptance.total.median": [0.4, 0.3]}
    labeled = make_family(data, "mine.toml").to_xarray(results)
    assert {name: labeled[name].values.tolist() for name in columns} == columns, "whole keys where the last parts agree"
    data = tomllib.loads(scene_text("fig3-I").decode())
    data["bodies"][1]["mass"] = {"values": [1.0, 2.0]}
    assert make_family(data, "mine.toml").to_xarray(results)["mu"].dims == ("bodies.1.mass", "body"), "of which body"


def combined(tmp_path: Path, top: str, friction: str, scale: str) -> Path:
    """fig3-I with values of two keys that run, and a line on top."""
    file = _file(tmp_path, "friction = 0.1", f"friction = {friction}")
    text = file.read_text(encoding="utf-8").replace("[excitation]", f"[excitation]\nscale = {scale}")
    file.write_text(f"{top}\n{text}", encoding="utf-8")
    return file


TWO, THREE = "{values = [0.05, 0.1]}", "{values = [3.0, 1.0, 2.0]}"


@pytest.mark.parametrize(("top", "dims"), [("product", {"scale": 3, "friction": 2}), ("zip", {"scene": 2})])
def test_keys_that_run_together_are_axes_of_results_the_last_one_fastest(tmp_path, top, dims):
    scales = THREE if top == "product" else "{values = [3.0, 1.0]}"
    family = load_family(combined(tmp_path, f'combine = "{top}"', TWO, scales))
    assert family.key == "isolator.friction, excitation.scale"
    values = list(product((0.05, 0.1), (3.0, 1.0, 2.0))) if top == "product" else [(0.05, 3.0), (0.1, 1.0)]
    assert family.columns == dict(zip(family.key.split(", "), zip(*values)))
    assert [(s.friction_coefficient, s.amplitudes.max()) for s in family.scenes] == values
    assert family.scenes[1].name == f"mine[friction={values[1][0]}, scale=1]"
    assert family.values[1] == f"{values[1][0]}, 1"
    results = [reference.amplification(scene, (0.3, 1.1), tolerance=1e-3) for scene in family.scenes]
    data = family.to_xarray(results)
    assert dict(data["mu"].isel(body=0).sizes) == dims
    last = data["mu"].sel(friction=0.1, scale=2.0) if top == "product" else data["mu"].isel(scene=1)
    np.testing.assert_array_equal(last, results[-1].mu)


RANGE = "{range = [0.1, 0.2], steps = 100}"
MISFITS = [
    ("", TWO, TWO, "excitation.scale", 'add combine = "product" or combine = "zip"'),
    ('combine = "sum"', TWO, TWO, "combine", "must be one of product, zip"),
    ('combine = "zip"', TWO, "1.0", "combine", "two or more keys must run"),
    ('combine = "zip"', TWO, THREE, "combine", "friction 2, excitation.scale 3"),
    ('combine = "product"', RANGE, RANGE.replace("100", "11"), "combine", "1100 scenes: must be at most 1000"),
]


@pytest.mark.parametrize(("top", "friction", "scale", "key", "rule"), MISFITS)
def test_keys_that_cannot_run_together_are_refused_in_one_line(tmp_path, top, friction, scale, key, rule):
    said = refusal(load_family, combined(tmp_path, top, friction, scale), kind=SceneError)
    assert said.key == key
    assert rule in said.rule


def test_a_family_of_many_bodies_is_refused_before_its_scenes_are_made():
    bodies = [{"mass": 1.0}] + 100 * [{"mass": 1.0, "period": [1.0, 1.0]}]
    said = refusal(make_family, {"bodies": bodies, "duration": {"range": [1.0, 2.0], "steps": 500}}, "mine.toml")
    assert (said.key, said.value) == ("bodies: 101 in each of 500 scenes", 50_500)
    most = {"bodies": bodies[:100], "duration": {"range": [1.0, 2.0], "steps": 500}}
    assert "50000 bodies" not in str(refusal(make_family, most, "mine.toml"))
    many = {"combine": "zip", "bodies": [{"mass": {"values": [1.0, 2.0 + n]}} for n in range(23)]}
    said = refusal(make_family, many, "mine.toml")
    assert (said.key, said.value, said.rule) == ("bodies.20.mass", {"values": [1.0, 22.0]}, "at most 20 keys may run")
