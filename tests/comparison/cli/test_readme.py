"""The README is short, gives one command line for the study and one for the tests, and what it points to is there."""

import re
import tomllib

import pytest
from places import ROOT

from comparison.analyses.validation.table import recorded
from comparison.report.results import VALIDATED
from reference.problem import Scene

README = (ROOT / "README.md").read_text(encoding="utf-8")
GUIDE = ROOT / "docs" / "guide"


def test_the_readme_has_at_most_a_hundred_lines_and_one_picture() -> None:
    assert README.count("\n") <= 100
    assert README.count("![") == 1


def test_there_are_two_command_lines_each_of_one_line() -> None:
    blocks = re.findall(r"^```sh\n(.*?)^```$", README, flags=re.MULTILINE | re.DOTALL)
    assert [block.count("\n") for block in blocks] == [1, 1]
    study, tests = blocks
    assert study.endswith("-m comparison.run\n")
    by_continuous_integration = "-m pytest -n auto --dist loadfile\n"
    assert tests.endswith(by_continuous_integration)
    assert all(block.startswith("python3 -m venv .venv && .venv/bin/pip install ") for block in blocks)


def test_the_keys_that_the_guide_shows_make_a_scene() -> None:
    page = (GUIDE / "building.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```toml\n(.*?)^```$", page, flags=re.MULTILINE | re.DOTALL)
    shown = next(tomllib.loads(block) for block in blocks if "bars" in block)
    box = {"size": [5.0, 5.0, 0.6]}
    scene = Scene.model_validate(
        {
            "title": "as shown",
            "duration": 5.0,
            "isolator": {**shown["isolator"], "sphere_radius": 0.1},
            "bodies": [{"mass": 3e4, "height": 0.5, **box}, {**shown["bodies"][0], "height": 3.5, **box}],
            "excitation": {"amplitudes": [[1.5, 0.0], [0.0, 1.5]], "periods": [1.1, 0.7], "decay": [0.3, 0.3]},
        }
    )
    assert scene.stiffness[0, 0] == pytest.approx(12 * 4 * 2e6 / 3.0**3)
    assert scene.isolator.travel == 0.3


def test_the_numbers_from_outside_are_those_of_their_page() -> None:
    page = (ROOT / "docs" / "benchmarks.md").read_text(encoding="utf-8")
    rows = [line for line in page.split("\n## ")[0].splitlines() if line.startswith("|")]
    assert len(rows) == 2 + 5
    assert "\n".join(rows) in README


def test_what_is_said_to_be_validated_is_what_is_recorded() -> None:
    found = {(each.experiment, each.name): each for each in recorded().quantities}
    half, rest = (found["frame, 450 g", name] for name in ("half range", "share of time at rest"))
    for side in ("equations", "engine"):
        error, at_rest = half.sides[side].error, rest.sides[side]
        assert f"half range at nearly twice the load {100.0 * error / half.measured:.1f} % too large" in VALIDATED
        assert (half.sides[side].verdict, at_rest.verdict) == ("law", "within u_val")
        assert f"within its uncertainty, {at_rest.validation:.1f} % of a cycle" in VALIDATED
        assert abs(at_rest.error) < 0.2, "of a cycle, in percent"
