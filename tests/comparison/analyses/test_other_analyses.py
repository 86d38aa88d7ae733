"""Claims, scaling and convergence reach the page and the summary; claims only where the paper's scenes are studied."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from report_texts import both_pages, summary_of

from comparison.analyses.claims.table import Claims
from comparison.analyses.convergence.analysis import Convergence
from comparison.analyses.scaling.analysis import Scaling
from comparison.runner.task_results import TaskResults
from comparison.study.study import Study
from reference.problem import builtin_scenes, load_scene


@pytest.fixture(scope="module")
def page(finished: Path) -> str:
    return both_pages(finished)


def test_every_verdict_is_on_the_page_with_what_was_found(page: str) -> None:
    table = page.split("Every claim under every reading", 1)[1].split("</table>", 1)[0]
    assert table.count('class="differs" title="periodic 4 and 3">yes</td>') == 2
    assert table.count('class="differs" title="drawn 4 and 3">drawn</td>') == 1
    assert '<td title="fig3-I: rim reached">?</td>' in table
    assert "<li>1: no, |x<sub>2</sub> - y<sub>2</sub>| up to 0</li>" in page


def test_exponents_stand_with_their_uncertainty(page: str) -> None:
    rows = page.split('id="scaling"', 1)[1].split("</table>", 1)[0]
    assert "2.00 ± 0.00" in rows
    assert re.sub("<.*?>", "", rows).count("1: 4.0e-03, 0.5: 1.0e-03, 0.25: 2.5e-04") == 1
    assert "like the power 2" in rows
    rows = page.split('id="convergence"', 1)[1].split("</table>", 1)[0]
    assert ">none</td>" in rows
    assert "within the error bars: no slope can be told" in rows


def test_the_summary_has_them_without_nan(finished: Path) -> None:
    summary: dict[str, Any] = summary_of(finished)
    claims = summary["claims"]
    assert claims["reproduced"] == [1, 2]
    assert [verdict["finding"] for verdict in claims["claims"][0]["verdicts"]] == ["reproduced", "as drawn"]
    assert claims["never"] == ["Fig. 3b: mu_2 has several peaks and valleys, more complex than those of mu_1"]
    forced = {scene["name"]: scene["forced"] for scene in summary["scenes"]}
    assert [(each["axis"], round(each["ratio"], 2)) for each in forced["fig3-I"]] == [("x", 0.56), ("y", 4.56)]
    assert summary["scaling"][0]["exponent"] == pytest.approx(2.0)
    assert summary["convergence"][0]["exponent"] is None


def test_claims_are_tested_only_with_all_scenes_of_the_paper() -> None:
    every = Study(tuple(load_scene(name) for name in builtin_scenes()), 4, 1e-3)
    assert Claims().tasks(every)
    study = Study((load_scene("fig3-I"),), 4, 1e-3)
    assert Claims().tasks(study) == []
    assert Claims().collect(study, None, TaskResults()) is None
    for analysis in (Scaling(), Convergence()):
        assert {task.about.name for task in analysis.tasks(study)} == {"fig3-I"}
