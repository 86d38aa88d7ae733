"""Sentences that pages state by hand: what they count and conclude follows from the numbers beside them."""

import math
import re

import numpy as np
import pytest
from pages import ROOT
from scipy.stats import beta

from comparison.evidence.validation.table import load_record
from reference.problem import builtin_scenes, load_scene

EVIDENCE, CLAIMS, VALIDATION = (
    (ROOT / f"docs/{name}.md").read_text(encoding="utf-8") for name in ("evidence", "claims", "validation")
)
SECTION = (ROOT / "comparison/evidence/claims/section.html.j2").read_text(encoding="utf-8")
NUMBER = r"(\d+(?:\.\d+)?)"
OPEN = rf"{NUMBER} m/s²(?: \(it gives no unit of the amplitudes\))?, {NUMBER} s and\s(?:f_c = )?{NUMBER} s/m"


def bound(misfits: int, points: int) -> float:
    """The share of misfits that is not exceeded with a confidence of 95 % (Clopper and Pearson)."""
    return float(beta.ppf(0.95, misfits + 1, points - misfits))


def counted(text: str, words: str) -> list[int]:
    """The whole numbers in a sentence."""
    found = re.search(words.replace(" ", r"\s"), text)
    assert found, words
    return [int(number) for number in found.groups()]


@pytest.mark.parametrize("page", [EVIDENCE, CLAIMS, SECTION], ids=["evidence", "claims", "report"])
def test_what_the_paper_leaves_open_is_what_the_scenes_assume(page: str) -> None:
    scenes = [load_scene(name) for name in builtin_scenes()]
    amplitudes = {float(np.abs(scene.excitation.amplitudes).max()) for scene in scenes}
    lubrication = {scene.isolator.lubrication for scene in scenes if scene.lubricated}
    (stated,) = re.findall(OPEN, page)
    assert [amplitudes, {scene.duration for scene in scenes}, lubrication] == [{float(number)} for number in stated]


def test_the_shares_of_the_random_scenes_are_those_of_their_counts() -> None:
    rows = re.findall(r"^\| ([\w -]+) \| ([\d ]+) \| (\d+) \| ([\d.]+) %, ([\d.]+) % \|.* ([\d.]+) \|$", EVIDENCE, re.M)
    counts = [(int(points.replace(" ", "")), int(misfits)) for _, points, misfits, *_ in rows]
    assert rows[-1][0] == "together"
    assert len(rows) == 5
    assert counts[-1] == tuple(map(sum, zip(*counts[:-1])))
    assert float(rows[-1][-1]) == max(float(row[-1]) for row in rows[:-1])
    for (_, _, _, share, most, _), (points, misfits) in zip(rows, counts):
        assert (share, most) == (f"{100.0 * misfits / points:.2f}", f"{100.0 * bound(misfits, points):.2f}")


def test_the_random_spatial_scenes_add_up() -> None:
    compared = [
        int(points) for points in re.findall(r"^\| (?:Newton|the same model|nothing).*?\| (\d+) \|", EVIDENCE, re.M)
    ]
    (scenes,) = counted(EVIDENCE, r"(\d+) random scenes were computed")
    others = counted(EVIDENCE, r'others: (\d+) "tolerance not met", (\d+) "step limit" [^"]*, (\d+) "overturned"')
    assert scenes == sum(compared) + sum(others)
    (points,) = counted(EVIDENCE, r"No q > 1 in (\d+) points")
    assert points == sum(compared[:2])
    later = counted(EVIDENCE, r"Since then (\d+) random[\s\S]*?(\d+) were computed to 1e-3 and (\d+) to")
    assert later[0] == sum(later[1:])
    ends = counted(EVIDENCE, r'(\d+) are `ok`, (\d+) "tolerance not met", (\d+) "rim reached", (\d+) "step limit"')
    assert later[0] == sum(ends)
    for count, words in ((points, r"share below ([\d.]+) %"), (49, r"less than ([\d.]+) % of misfits")):
        stated = re.search(words, EVIDENCE)
        assert stated
        digits = len(stated[1].partition(".")[2])
        assert float(stated[1]) == math.ceil(10**digits * 100.0 * bound(0, count)) / 10**digits


def test_the_self_assessment_has_eight_levels_and_what_is_not_met() -> None:
    rows = re.findall(r"^\| ([a-z ]+) \| (\d) \| (.*) \|$", VALIDATION, re.M)
    assert len(rows) == 8
    assert all(0 <= int(level) <= 4 for _, level, _ in rows)
    counts = load_record().counts()
    assert ("most values not met" in {name: why for name, _, why in rows}["validation"]) == (
        counts["not met"] > counts["met"]
    )
