# ruff: noqa: E501 (a sentence stands on one line where it can)
"""What pages say of the default study is their record: body, pair, grid, mean and largest each in its place."""

import json
from pathlib import Path
from typing import Any

import default_study
import pytest
from default_study import GRID, PASSAGES, READINGS, with_passages

from comparison.surfaces.statements import word_headline, word_verdict

SCENES = ("fig3-I", "fig4-dry")


def row(scene: str, pair: str, body: int, number: int) -> dict[str, Any]:
    """A row of pairwise different numbers on two grids."""
    grids = [
        {"phases_per_axis": grid, "mean": (-0.001 if grid == GRID else 0.0007) * number, "maximum": 0.003 * number}
        for grid in (GRID // 2, GRID)
    ]
    return {"scene": scene, "pair": pair, "body": body, "grids": grids}


KNOWN = {
    "verdict": "Read as integrated, they can be trusted.",
    "leads": {"claims": "Of the paper's statements 9 are met.", "conditioning": "It is ill-conditioned."},
    "rows": [
        row(scene, pair, body, 1 + 20 * place + 2 * number + 100 * (body == 2))
        for body in (1, 2)
        for place, scene in enumerate(SCENES)
        for number, (pair, _) in enumerate(READINGS)
    ],
}


def test_the_readings_are_mean_and_largest_of_the_platform_on_the_common_grid() -> None:
    head, _, *lines = PASSAGES["readings"](KNOWN).splitlines()
    assert head == f"| μ₁, second against first, mean (largest size) over {GRID} × {GRID} phases | fig3-I | fig4-dry |"
    assert lines[0] == "| small equations, literal supremum → Exudyn (spatial) | −0.1 % (0.3 %) | −2.1 % (6.3 %) |"
    assert lines[4] == "| geometry: small → exact equations, literal suprema | −0.9 % (2.7 %) | −2.9 % (8.7 %) |"
    assert len(lines) == len(READINGS)


@pytest.mark.parametrize("pair", [pair for pair, _ in READINGS])
def test_every_pair_is_named_by_its_reading_models_and_effect(pair: str) -> None:
    words = dict(READINGS)[pair]
    assert ("supremum" in words or "suprema" in words) == (pair in ("supremum-total", "reading", "geometry-supremum"))
    assert ("as integrated" in words) == (pair in ("total", "translational", "reading", "geometry"))
    assert words.startswith("geometry") == pair.startswith("geometry")
    assert ("(translational)" in words) == (pair == "translational")
    assert ("(spatial)" in words) == (pair in ("supremum-total", "total"))


def test_a_passage_is_that_of_its_name_and_the_rest_of_the_page_stays() -> None:
    page = (
        "a\n<!-- default study: conditioning -->\nold\n<!-- end -->\nb\n<!-- default study: answer -->\n<!-- end -->\n"
    )
    assert with_passages(page, KNOWN) == (
        "a\n<!-- default study: conditioning -->\nIt is ill-conditioned.\n<!-- end -->\nb\n<!-- default study: answer -->\n"
        "Read as integrated, they can be trusted. Of the paper's statements 9 are met.\n<!-- end -->\n"
    )


def test_the_table_of_answers_has_the_cells_of_the_first_screen(monkeypatch: pytest.MonkeyPatch) -> None:
    cells = {name: (lambda line, name=name: f"{name} of {line.name}") for name in vars(default_study.CELL_WORDINGS)}
    monkeypatch.setattr(
        default_study, "CELL_WORDINGS", type("Cells", (), {name: staticmethod(f) for name, f in cells.items()})
    )
    line = type("Line", (), {"scene": "tower", "name": "body 2"})
    monkeypatch.setattr(default_study, "headlines", lambda known: [line])
    head, _, row = PASSAGES["answers"](KNOWN).splitlines()
    assert row == (
        "| `tower` | body 2 | **difference of body 2** range of body 2 | causes of body 2 | agreement of body 2 | "
        "supremum of body 2 |"
    )
    order = ("mean, range", "causes", "same equations", "literal supremum")
    places = [head.index(words) for words in order]
    assert places == sorted(places)


@pytest.mark.parametrize("page", default_study.pages(), ids=lambda page: page.stem)
def test_every_passage_of_a_page_is_that_of_the_record(page: Path) -> None:
    recorded = json.loads(default_study.RECORD.read_text(encoding="utf-8"))
    text = page.read_text(encoding="utf-8")
    assert with_passages(text, recorded) == text


def test_the_record_is_in_the_words_of_today() -> None:
    """Its headlines, worded again, are the sentences that are recorded."""
    recorded = json.loads(default_study.RECORD.read_text(encoding="utf-8"))
    for line in default_study.headlines(recorded):
        assert word_headline(line) == line.sentence
    words = word_verdict(default_study.headlines(recorded), recorded["measured"])
    assert words == recorded["verdict"]
