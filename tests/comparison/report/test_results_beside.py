"""What other commands leave beside a report is part of the next one, and no run loses it."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from fake_models import fake_hierarchy
from known_results import FILES, leave_beside
from report_texts import both_pages
from runs import SMALL, Run

from comparison.evidence.tradeoff.trade import FILE as TRADES
from comparison.runner.output import publish_files

MAKES = ("extremes", "benchmarks", "tradeoff SCENE", "validation FOLDER")


def test_results_beside_a_report_are_part_of_the_next(command: Callable[..., Run], tmp_path: Path) -> None:
    alone = both_pages(command(*SMALL).report)
    place = tmp_path / "report"
    leave_beside(place, FILES, "fig3-I", "fig3-II")
    kept = {name: (place / name).read_bytes() for name in (*FILES, TRADES, "fig3-I-tradeoff.nc")}
    pages = both_pages(command(*SMALL).report)
    for name in MAKES:
        line = f"phase-resonance {name} makes it"
        assert (line in alone, line in pages) == (True, False), name
    for seen in ("hangs: &lt;forever&gt;", "a &lt;frame&gt;", "it agrees &lt;with itself&gt;", "a &lt;fact&gt;",
                 "(fig3-II)</span>: not a scene of this study"):  # fmt: skip
        assert seen in pages, seen
    assert pages.count("made &lt;by a test&gt;") >= 3, "every command says how it was made"
    assert "1.0e-03, 1.0e-03" not in pages, "what is beaten is in the plot alone"
    assert pages.count("not a scene of this study") == 1
    assert {name: (place / name).read_bytes() for name in kept} == kept


@pytest.mark.parametrize("name", [*FILES, TRADES])
def test_a_file_that_is_no_result_is_refused_at_the_start(
    command: Callable[..., Run], tmp_path: Path, name: str
) -> None:
    publish_files(tmp_path / "report", {name: b'{"schema": "a-secret", "a-secret": 1}'}, "a test")
    run = command(*SMALL, hierarchy=fake_hierarchy("forbidden"))
    assert (run.code, run.out, run.err.count("\n")) == (2, "", 1)
    assert re.search(rf"{name}: not (a|an) .*: run phase-resonance ", run.err)
    assert "a-secret" not in run.err, "nothing of it is quoted"
