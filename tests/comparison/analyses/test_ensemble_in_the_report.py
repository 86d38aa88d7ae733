"""An ensemble beside the report is part of the next one."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from report_texts import page_of, schema_errors, summary_of
from runs import Run

from comparison.analyses.ensemble.feature import ensemble_panels
from comparison.analyses.ensemble.result import FILE, SCHEMA, STORED, StoredCurve, StoredEngine, StoredEnsemble
from comparison.analyses.ensemble.result import StoredDifference as Difference
from comparison.analyses.ensemble.result import StoredFractile as Fractile
from comparison.analyses.ensemble.result import StoredStripe as Stripe
from comparison.registry import StudyResults
from comparison.runner.output import publish

SMALL = ["fig3-I", "--grid", "2"]
RUN = {"command": "made <by a test>", "began": "then", "compute_seconds": 1.0,
       "provenance": {"commit": "abc", "processor": "one"}}  # fmt: skip


def three_motions() -> StoredEnsemble:
    """Displacements of three motions at two scales: the third reaches the rim at the larger one."""
    known = {"motion 1": (0.1, 0.2), "motion 2": (0.2, 0.5), "motion 3": (0.3, None)}
    errors = [(0.0, None if value is None else 0.0) for _, value in known.values()]
    curves = [
        StoredCurve("displacement", None, "exact", motion, (1.0, 2.0), values, error)
        for (motion, values), error in zip(known.items(), errors)
    ]
    engine = StoredCurve("displacement", None, "translational", "motion 2", (2.0,), (0.51,), (1e-3,))
    low = [Fractile(share, value, 0.0) for share, value in ((0.16, 0.132), (0.5, 0.2), (0.84, 0.268))]
    high = [Fractile(0.16, 0.296, 0.0), Fractile(0.5, 0.5, 0.0), Fractile(0.84, None, None)]
    return StoredEnsemble(
        schema=SCHEMA, scene="tower", title="Tower & <town>", keys=["excitation.scale"], scales=(1.0, 2.0),
        motions=3, bodies=1, outcomes={"ok": 5, "rim reached": 1},
        stripes=[Stripe("displacement", None, "m", 1.0, 3, low), Stripe("displacement", None, "m", 2.0, 2, high)],
        curves=[*curves, engine],
        engine=StoredEngine("translational", [{"scene": "tower[2]", "status": "ok"}],
                            [Difference("displacement", None, 0.02, 1e-4, 2e-3, 1)]),
        run=RUN,
    )  # fmt: skip


def test_what_is_written_is_what_is_read(tmp_path: Path) -> None:
    assert STORED.load(tmp_path) is None
    written = three_motions()
    (tmp_path / FILE).write_bytes(STORED.as_json(written))
    read = STORED.load(tmp_path)
    assert read is not None
    assert STORED.as_json(read) == STORED.as_json(written)


def test_a_panel_in_mm_has_a_thousand_times_the_numbers_in_m(command: Callable[..., Run]) -> None:
    report = command(*SMALL).report
    publish(report, {FILE: STORED.as_json(three_motions())}, "a test")
    command(*SMALL)
    results = StudyResults.model_validate_json((report / "summary.json").read_bytes())
    (panel,) = (panel for panel in ensemble_panels(results.of("ensemble")) if panel["title"] == "isolator displacement")
    assert panel["plot"]["y"]["title"] == "isolator displacement, mm"
    motions, (band,), (engine,) = (
        [line for line in panel["plot"]["series"] if line["name"].startswith(name)]
        for name in ("one motion", "median", "engine")
    )
    assert [line["y"][0] for line in motions] == pytest.approx([100.0, 200.0, 300.0])
    assert band["name"] == "median, 16 % to 84 %"
    assert [band[key][0] for key in ("low", "y", "high")] == pytest.approx([132.0, 200.0, 268.0])
    assert engine["y"] == pytest.approx([510.0])


def test_the_table_has_every_fractile_in_the_column_of_its_share(command: Callable[..., Run]) -> None:
    report = command(*SMALL).report
    publish(report, {FILE: STORED.as_json(three_motions())}, "a test")
    command(*SMALL)
    page = page_of(report)
    heads = re.findall(r'<th class="number">(16|50|84) %</th>', page)
    (row,) = re.findall(r"<tr><td>displacement</td><td[^>]*></td><td[^>]*>1</td>\s*(.*?)</tr>", page, re.S)
    cells = re.findall(r"<td[^>]*>(.*?)</td>", row)
    assert dict(zip(heads, cells)) == {"16": "0.132 ± 0", "50": "0.2 ± 0", "84": "0.268 ± 0"}
    assert cells[3:] == ["m", "3"]


def test_the_ensemble_beside_a_report_is_part_of_the_next(command: Callable[..., Run]) -> None:
    report = command(*SMALL).report
    assert "python -m comparison.ensemble SCENE makes it" in page_of(report)
    publish(report, {FILE: STORED.as_json(three_motions())}, "a test")
    assert command(*SMALL).code == 0
    page = page_of(report)
    for seen in ('id="ensemble"', "Tower &amp; &lt;town&gt;", "5 ok, 1 rim reached", "made &lt;by a test&gt;", "none"):
        assert seen in page, seen
    summary = summary_of(report)
    assert schema_errors(report) == []
    assert summary["ensemble"]["curves"][2]["values"] == [0.3, None]
    assert command(*SMALL, "--skip", "ensemble").code == 0
    assert 'id="ensemble"' not in page_of(report)


def test_a_file_that_is_no_ensemble_is_refused_at_the_start(command: Callable[..., Run], tmp_path: Path) -> None:
    report = command(*SMALL).report
    (report / FILE).write_text('{"schema": "phase-resonance/ensemble", "scene": 3}')
    run = command(*SMALL)
    assert run.code == 2
    assert "not an ensemble" in run.err
    assert "python -m comparison.ensemble" in run.err


@pytest.mark.parametrize("stripes", [[], None])
def test_an_ensemble_without_any_answer_is_shown(command: Callable[..., Run], stripes: list[Stripe] | None) -> None:
    report = command(*SMALL).report
    content = json.loads(STORED.as_json(three_motions()))
    content |= {"curves": [], "outcomes": {"rim reached": 6}}
    content["stripes"] = stripes if stripes is not None else content["stripes"][1:]
    publish(report, {FILE: json.dumps(content).encode()}, "a test")
    assert command(*SMALL).code == 0
    assert "6 rim reached" in page_of(report)
