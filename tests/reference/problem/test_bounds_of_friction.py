"""`bounds` of an isolator makes two buildings, with both coefficients of friction times a factor."""

from pathlib import Path

import pytest
from chains import refusal

from reference.problem import DryFriction, families, load_family, load_scene
from reference.problem.scene_file import scene_text

TABLE = "{slow = 0.03, fast = 0.05, rate = 50.0}"


def bounded_file(folder: Path, friction: str = TABLE, bounds: str = "[0.8, 1.5]", scale: str = "1.0") -> Path:
    """The first case of the paper with bounds of its friction."""
    text = scene_text("fig3-I").decode().replace("friction = 0.1", f"friction = {friction}\nbounds = {bounds}")
    file = folder / "mine.toml"
    file.write_text(text.replace("[excitation]", f"[excitation]\nscale = {scale}"), encoding="utf-8")
    return file


def test_bounds_multiply_slow_and_fast_friction_alike_and_nothing_else(tmp_path: Path) -> None:
    family = load_family(bounded_file(tmp_path))
    laws = [DryFriction(0.024, 0.04, 50.0), DryFriction(0.045, 0.075, 50.0)]
    assert [scene.dry_friction for scene in family.scenes] == laws, "no digits of rounding"
    assert [scene.name for scene in family.scenes] == ["mine[lower bound]", "mine[upper bound]"]
    assert {scene.with_values({"isolator.friction": 0.1}).digest() for scene in family.scenes} == {
        load_scene("fig3-I").with_values({"excitation.scale": 1.0}).digest()
    }


def test_bounds_are_combined_with_every_value_that_runs(tmp_path: Path) -> None:
    family = load_family(bounded_file(tmp_path, scale="{values = [1.0, 2.0]}"))
    names = [f"mine[{bound} bound, scale={scale}]" for bound in ("lower", "upper") for scale in (1, 2)]
    assert [scene.name for scene in family.scenes] == names
    assert family.columns["isolator.bounds"] == (0.8, 0.8, 1.5, 1.5)
    assert family.columns["excitation.scale"] == (1.0, 2.0, 1.0, 2.0)


def test_bodies_of_both_bounds_count_for_the_limit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(families, "MAX_BODIES_IN_ALL", 11)
    said = refusal(load_family, bounded_file(tmp_path, scale="{values = [1.0, 2.0, 3.0]}"))
    assert "bodies: 2 in each of 6 scenes = 12" in str(said)


def test_bounds_of_the_caller_take_the_place_of_those_in_the_file(tmp_path: Path) -> None:
    family = load_family(bounded_file(tmp_path, "0.05"), bounds=(0.7, 2.0))
    assert [scene.friction_coefficient for scene in family.scenes] == [0.035, 0.1]
    assert [scene.friction_coefficient for scene in load_family("fig3-I", bounds=(0.5, 2.0)).scenes] == [0.05, 0.2]


@pytest.mark.parametrize(
    ("friction", "bounds", "line"),
    [
        (TABLE, "[1.5, 0.8]", "[1.5, 0.8]: must be two factors of friction, the smaller first, from 0.01 to 100"),
        (TABLE, "0.8", "0.8: must be two factors"),
        (TABLE, "[0.8, 1.0, 1.5]", "must be two factors"),
        (TABLE, "[0.0, 1.5]", "must be two factors"),
        (TABLE, "[0.8, '1.5']", "must be two factors"),
        ("{values = [0.03, 0.05]}", "[0.8, 1.5]", "multiplies one friction: isolator.friction is {'values'"),
        ("{slow = {values = [0.03, 0.04]}, fast = 0.05, rate = 50.0}", "[0.8, 1.5]", "multiplies one friction"),
        (
            '"much"',
            "[0.8, 1.5]",
            "isolator.friction = 'much': must be a valid number; also isolator.bounds",
        ),
        (
            "-1.0",
            "[1.5, 0.8]",
            "-1.0: must be greater than or equal to 0; also isolator.bounds = [1.5, 0.8]: must be two",
        ),
        ("900.0", "[0.8, 1.5]", "= [0.8, 1.5]: makes isolator.friction = 1350.0, which must be finite, from 0 to 1000"),
    ],
)
def test_wrong_bounds_are_one_line(tmp_path: Path, friction: str, bounds: str, line: str) -> None:
    said = str(refusal(load_family, bounded_file(tmp_path, friction, bounds)))
    assert "isolator.bounds = " in said
    assert line in said
    if "makes" in line:  # the bounds are at fault, whatever else runs
        assert line in str(refusal(load_family, bounded_file(tmp_path, friction, bounds, "{values = [1.0, 2.0]}")))


def test_a_wrong_friction_is_said_as_it_is_written_and_not_as_a_bound(tmp_path: Path) -> None:
    said = str(refusal(load_family, bounded_file(tmp_path, "{slow = 0.05}")))
    assert "isolator.friction = {'slow': 0.05}: give fast and rate" in said


def test_one_scene_of_a_file_with_bounds_is_refused(tmp_path: Path) -> None:
    said = str(refusal(load_scene, bounded_file(tmp_path)))
    assert "isolator.bounds = [0.8, 1.5]: makes a family of scenes, and one scene is asked for" in said
