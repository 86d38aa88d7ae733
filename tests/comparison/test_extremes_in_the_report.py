"""A matrix of extremes beside the report is part of the next one, and no run loses it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

from conftest import Run
from jsonschema import Draft202012Validator

from comparison.analyses.extremes.figure import draw_extremes
from comparison.analyses.extremes.matrix import FILE, PICTURE, STORED, Entry, Extreme, Matrix
from comparison.runner.output import made_by, publish

SMALL = ["fig3-I", "--grid", "2"]
RUN = {"command": "made by a test", "began": "then", "seconds": 1.0, "cpu_seconds": 2.0, "jobs": 1}
FOUND = Matrix(
    {"small": "small equations", "spatial": "spatial engine"},
    [
        Extreme("friction", "1e-9", {"small": Entry("converged", "error 2e-07 confirmed", "ok", 2e-7, 0.25, 0.5)}),
        Extreme("friction", "10", {"spatial": Entry("limit", "step limit", "step limit", None, 0.25, 0.5)}),
        Extreme("rho, m", "1e3", {"small": Entry("FAILED", "hangs: <forever>", "time limit", None, None, None)}),
    ],
    {**RUN, "limit": 90.0, "reduced": False, "provenance": {"commit": "abc"}},
)


def beside(report: Path) -> None:
    """What `python -m comparison.extremes --out` of the report's directory leaves there."""
    picture = made_by(lambda folder: draw_extremes(folder / PICTURE, FOUND))
    publish(report, {FILE: STORED.as_json(FOUND), **picture}, "comparison.extremes")


def test_the_matrix_beside_a_report_is_part_of_the_next_and_stays_there(command: Callable[..., Run]) -> None:
    report = command(*SMALL).report
    assert "python -m comparison.extremes makes it" in (report / "verification.html").read_text(encoding="utf-8")
    beside(report)
    kept = (report / "extremes.json").read_bytes()
    for _ in range(2):
        run = command(*SMALL)
        assert run.code == 0, run.err
        assert (report / "extremes.json").read_bytes() == kept
        page = (report / "verification.html").read_text(encoding="utf-8")
        assert "python -m comparison.extremes makes it" not in page
        assert 'id="extremes"' in page
        for seen in ("2e-07", "step limit", "made by a test", "hangs: &lt;forever&gt;"):
            assert seen in page, seen
        assert (report / "figures" / "extremes.png").exists()


def test_the_matrix_may_be_there_before_the_first_report(command: Callable[..., Run], tmp_path: Path) -> None:
    beside(tmp_path / "report")
    run = command(*SMALL)
    assert run.code == 0, run.err
    summary = json.loads((run.report / "summary.json").read_text(encoding="utf-8"))
    schema = json.loads((run.report / "summary.schema.json").read_text(encoding="utf-8"))
    assert [error_message.message for error_message in Draft202012Validator(schema).iter_errors(summary)] == []
    assert summary["extremes"]["rows"][1]["entries"]["spatial"]["reason"] == "step limit"


def test_a_file_of_that_name_which_is_no_matrix_is_refused_in_one_line(
    command: Callable[..., Run], tmp_path: Path
) -> None:
    beside(tmp_path / "report")
    (tmp_path / "report" / "extremes.json").write_text("{}", encoding="utf-8")
    run = command(*SMALL)
    assert run.code == 2
    assert run.err.count("\n") == 1
    assert "not a matrix of extremes" in run.err
