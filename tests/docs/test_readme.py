"""The README is short, and the numbers that it and the page of evidence state are those that are recorded."""

import re
import tomllib

import evidence_table
import pytest
from pages import ROOT

from comparison.analyses.validation.table import recorded
from comparison.report.results import VALIDATED
from reference.problem import Scene

README = (ROOT / "README.md").read_text(encoding="utf-8")


def test_the_readme_is_short_and_has_two_commands_of_one_line() -> None:
    assert README.count("\n") <= 100
    assert README.count("![") == 1
    blocks = re.findall(r"^```sh\n(.*?)^```$", README, flags=re.MULTILINE | re.DOTALL)
    assert [block.count("\n") for block in blocks] == [1, 1]
    assert all(block.startswith("python3 -m venv .venv && .venv/bin/pip install ") for block in blocks)
    assert blocks[0].endswith("-m comparison.run\n")
    assert blocks[1].endswith("-m pytest -n auto --dist loadfile\n"), "by continuous integration"


def test_the_keys_that_the_guide_shows_make_a_scene() -> None:
    page = (ROOT / "docs/guide/building.md").read_text(encoding="utf-8")
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


def test_the_page_of_evidence_has_the_table_that_its_command_writes() -> None:
    page = (ROOT / "docs" / "evidence.md").read_text(encoding="utf-8")
    assert evidence_table.with_table(page) == page
    assert page.index("|") > page.index(evidence_table.BEGIN)


def test_what_is_said_to_be_validated_is_what_is_recorded() -> None:
    found = {(each.experiment, each.name): each for each in recorded().quantities}
    half, rest = (found["frame, 450 g", name] for name in ("half range", "share of time at rest"))
    row = next(line for line in README.splitlines() if "**measured**" in line)
    errors = [100.0 * half.sides[side].error / half.measured for side in ("equations", "engine")]
    shares = [rest.sides[side].error for side in ("equations", "engine")]
    assert f"half range {max(map(abs, errors)):.1f} %, beyond it" in row
    assert f"time at rest {max(map(abs, shares)):.1f} % of a cycle, within u" in row
    for side, error in zip(("equations", "engine"), errors):
        assert f"half range at nearly twice the load {error:.1f} % too large" in VALIDATED
        assert (half.sides[side].verdict, rest.sides[side].verdict) == ("law", "within u_val")
        assert f"within its uncertainty, {rest.sides[side].validation:.1f} % of a cycle" in VALIDATED
        assert abs(rest.sides[side].error) < 0.2, "of a cycle, in percent"
