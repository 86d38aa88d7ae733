"""Benchmarks beside the report are part of the next one, and no run loses them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from report_texts import page_of, schema_errors, summary_of
from runs import Run

from comparison.analyses.benchmarks.table import FILE, PAGE, STORED, Benchmark, Benchmarks, Number, Row, Verdict
from comparison.runner.output import publish

SMALL = ["fig3-I", "--grid", "2"]
NUMBERS = {
    "equations": Number(2.02423, 2e-8, Verdict.MET.value),
    "smoothed": Number(2.02425, 2e-8, Verdict.MET.value),
    "engine": Number(None, None, Verdict.NONE.value),
}
FOUND = Benchmarks(
    [
        Benchmark(
            "frame",
            "a <frame>",
            "a book",
            "links",
            1e-4,
            "theirs is heated",
            [Row("isolation period", "s", 2.0242, 5e-5, NUMBERS)],
            {"engine": "it broke"},
            {"engine": 1.0},
        )
    ],
    {"command": "made by a test", "began": "then", "seconds": 1.0, "jobs": 1, "provenance": {"commit": "abc"}},
)


def test_benchmarks_beside_a_report_are_part_of_the_next(command: Callable[..., Run], tmp_path: Path):
    report = command(*SMALL).report
    assert "python -m comparison.benchmarks makes it" in page_of(report, "verification.html")
    publish(report, {FILE: STORED.as_json(FOUND), PAGE: b"a page"}, "comparison.benchmarks")
    for _ in range(2):
        run = command(*SMALL)
        assert run.code == 0, run.err
        assert (report / FILE).read_bytes() == STORED.as_json(FOUND)
        page = page_of(report, "verification.html")
        assert "python -m comparison.benchmarks makes it" not in page
        for seen in (
            'id="benchmarks"',
            "2.0242 s ± 5e-05",
            "2.02423 ± 2e-08",
            "no answer",
            "a &lt;frame&gt;",
            "heated",
        ):
            assert seen in page, seen
    summary = summary_of(report)
    assert schema_errors(report) == []
    assert summary["benchmarks"]["benchmarks"][0]["rows"][0]["published"] == 2.0242


def test_a_file_that_is_no_table_is_refused_in_one_line(command: Callable[..., Run], tmp_path: Path):
    publish(tmp_path / "report", {FILE: b"{}"}, "comparison.benchmarks")
    run = command(*SMALL)
    assert run.code == 2
    assert run.err.count("\n") == 1
    assert "not a table of benchmarks" in run.err
