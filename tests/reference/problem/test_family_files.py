"""One value of a scene that runs over a range makes a scene of each of its values; what is no range is one line."""

from pathlib import Path

import numpy as np
import pytest
from chains import refusal

import reference
from reference.problem import builtin_scenes, load_family, load_scene
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
    "of a body": ("mass = 1.0\nperiod", "mass = {range = [1, 2], steps = 3}\nperiod", "bodies.1.mass", (1.0, 1.5, 2.0)),
    "in a list": ("[[1.0, 0.0]", "[[{range = [1.0, 2.0], steps = 2}, 0.0]", "excitation.amplitudes.0.0", (1.0, 2.0)),
    "fast friction": ("friction = 0.1", f"friction = {FAST}", "isolator.friction.fast", (0.1, 0.08)),
    "values": ("friction = 0.1", "friction = {values = [0.3, 0.05]}", "isolator.friction", (0.3, 0.05)),
    "texts": (f'title = "{load_scene("fig3-I").title}"', 'title = {values = ["a", "b"]}', "title", ("a", "b")),
}


def test_a_whole_table_may_run(tmp_path: Path) -> None:
    tables = [{"slow": 0.05, "fast": 0.08, "rate": 50.0}, {"slow": 0.05, "fast": 0.1, "rate": 50.0}]
    listed = ", ".join("{" + ", ".join(f"{key} = {part}" for key, part in each.items()) + "}" for each in tables)
    family = load_family(_file(tmp_path, "friction = 0.1", f"friction = {{values = [{listed}]}}"))
    assert [scene.name for scene in family.scenes] == [
        "mine[friction=slow=0.05+fast=0.08+rate=50]", "mine[friction=slow=0.05+fast=0.1+rate=50]",
    ]  # fmt: skip
    given = [load_scene("fig3-I").with_values({"isolator.friction": table}) for table in tables]
    assert [scene.digest() for scene in family.scenes] == [scene.digest() for scene in given]


@pytest.mark.parametrize(("old", "new", "key", "values"), KEYS.values(), ids=KEYS.keys())
def test_any_key_of_one_value_may_run(tmp_path: Path, old: str, new: str, key: str, values: tuple[object, ...]) -> None:
    family = load_family(_file(tmp_path, old, new))
    assert (family.key, family.values) == (key, values)
    assert len({scene.name for scene in family.scenes}) == len(family.scenes) == len(values)
    short = key if any(part.isdigit() for part in key.split(".")) else key.split(".")[-1]
    assert family.scenes[0].name == f"mine[{short}={values[0]:g}]" if key != "title" else "mine[title=a]"


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
    ("{range = [0.1, 0.2], step = 3}", " = {'range': [0.1, 0.2], 'step': 3}: must be"),
    ("{range = [0.1, 0.2, 0.3], steps = 3}", ".range = [0.1, 0.2, 0.3]: must be two"),
    ("{range = [0.2, 0.1], steps = 3}", ".range = [0.2, 0.1]: must be two finite numbers"),
    ("{range = [-1e308, 1e308], steps = 5}", ".range = [-1e+308, 1e+308]: must be two finite numbers"),
    ("{range = [0.1, 0.2], steps = 1}", ".steps = 1: must be a whole number from 2 to 1000"),
    ("{range = [-0.1, 0.2], steps = 4}", " = -0.1: must be greater than"),
    ("{values = []}", ".values = []: must be a list of 1 to 1000 finite numbers"),
    ("{values = [1, 'a']}", ".values = [1, 'a']: must be a list of 1 to 1000 finite"),
    ("{values = [0.1, 0.1]}", " = 0.1: is there twice"),
]


@pytest.mark.parametrize(("table", "line"), WRONG)
def test_what_is_no_range_is_one_line(tmp_path: Path, table: str, line: str) -> None:
    file = _file(tmp_path, "friction = 0.1", f"friction = {table}")
    assert str(refusal(load_family, file)).startswith(f"{file}: isolator.friction{line}")


def test_one_scene_of_a_file_with_a_range_is_refused(tmp_path: Path) -> None:
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
