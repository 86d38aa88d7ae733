"""A matrix of extremes beside the report is part of the next one, and no run loses it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from known_results import FOUND
from report_texts import page_of, schema_errors, summary_of
from runs import Run

from comparison.analyses.extremes.figure import draw_extremes
from comparison.analyses.extremes.matrix import FILE, PICTURE, STORED
from comparison.runner.output import made_by, publish

SMALL = ["fig3-I", "--grid", "2"]


def beside(report: Path) -> None:
    """What `python -m comparison.extremes --out` of the report's directory leaves there."""
    picture = made_by(lambda folder: draw_extremes(folder / PICTURE, FOUND))
    publish(report, {FILE: STORED.as_json(FOUND), **picture}, "comparison.extremes")


def test_the_matrix_beside_a_report_is_part_of_the_next(command: Callable[..., Run]) -> None:
    report = command(*SMALL).report
    assert "python -m comparison.extremes makes it" in page_of(report, "verification.html")
    beside(report)
    kept = (report / "extremes.json").read_bytes()
    for _ in range(2):
        run = command(*SMALL)
        assert run.code == 0, run.err
        assert (report / "extremes.json").read_bytes() == kept
        page = page_of(report, "verification.html")
        assert "python -m comparison.extremes makes it" not in page
        assert 'id="extremes"' in page
        for seen in ("2e-07", "step limit", "made by a test", "hangs: &lt;forever&gt;"):
            assert seen in page, seen
        assert (report / "figures" / "extremes.png").exists()


def test_the_matrix_may_be_there_before_the_first_report(command: Callable[..., Run], tmp_path: Path) -> None:
    beside(tmp_path / "report")
    run = command(*SMALL)
    assert run.code == 0, run.err
    summary = summary_of(run.report)
    assert schema_errors(run.report) == []
    assert summary["extremes"]["rows"][1]["entries"]["spatial"]["reason"] == "step limit"


def test_a_file_that_is_no_matrix_is_refused_in_one_line(command: Callable[..., Run], tmp_path: Path) -> None:
    beside(tmp_path / "report")
    (tmp_path / "report" / "extremes.json").write_text("{}", encoding="utf-8")
    run = command(*SMALL)
    assert run.code == 2
    assert run.err.count("\n") == 1
    assert "not a matrix of extremes" in run.err
