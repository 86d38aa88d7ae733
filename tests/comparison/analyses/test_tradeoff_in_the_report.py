"""Diagrams beside the report are part of the next one, and no run loses them or what belongs to them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
import xarray as xr
from report_texts import page_of, schema_errors, summary_of
from runs import Run

from comparison.analyses.tradeoff import command as tradeoff
from comparison.analyses.tradeoff.analysis import MeasuredTrade
from comparison.analyses.tradeoff.growth import FILE as GROWTH
from comparison.analyses.tradeoff.growth import SCHEMA, STORED, MeasuredGrowth, with_slope
from comparison.analyses.tradeoff.trade import FILE, Answered, Entry, Trade, with_pareto_fronts
from comparison.runner.output import publish
from reference.problem import load_scene

SMALL = ["fig3-I", "--grid", "2"]
RUN = {"command": "made by a test", "began": "then", "seconds": 1.0, "jobs": 1, "quick": True}
ONE = Entry("exact", "reference, one run", "tolerance inside a step", "", 1e-3, False, False, 3, 3, 0.002,
            (1e-9, 2e-9), (3e-8, 4e-8), (None, None), 0.1)  # fmt: skip


def trade(name: str) -> Trade:
    """Two settings of one method, the second of which is dearer and worse."""
    scene = load_scene(name)
    entries = [ONE, replace(ONE, value=1e-2, seconds=0.003, most=(1e-3, 1e-3), error_message="<b>")]
    question = Answered("exact", "exact equations", 3, "the reference", 1e-10, ["it agrees <with itself>"])
    run = {**RUN, "provenance": {"commit": "abc", "processor": "one"}}
    return Trade(scene.name, scene.title, scene.digest(), 2, [question], with_pareto_fronts(entries, 2), run)


@pytest.fixture
def measure(monkeypatch: pytest.MonkeyPatch) -> Callable[[Path, str], int]:
    """The command, with a measured trade that is known."""

    def run(report: Path, name: str) -> int:
        data = xr.Dataset({"mu": ("point", [1.0])})
        monkeypatch.setattr(tradeoff, "measured_trades", lambda *arguments: [MeasuredTrade(trade(name), data)])
        return tradeoff.main([name, "--out", str(report)])

    return run


def test_the_diagrams_beside_a_report_are_part_of_the_next(
    command: Callable[..., Run], measure: Callable[[Path, str], int]
) -> None:
    report = command(*SMALL).report
    assert "python -m comparison.tradeoff SCENE makes it" in page_of(report, "verification.html")
    assert measure(report, "fig3-I") == 0
    names = [FILE, "fig3-I-tradeoff.nc", "fig3-I-tradeoff.png", "fig3-I-tradeoff.pdf"]
    kept = {name: (report / name).read_bytes() for name in names}
    for _ in range(2):
        run = command(*SMALL)
        assert run.code == 0, run.err
        assert {name: (report / name).read_bytes() for name in names} == kept
    page = page_of(report, "verification.html")
    for seen in ('id="tradeoff"', "it agrees &lt;with itself&gt;", "3.0e-08, 4.0e-08", "made by a test"):
        assert seen in page, seen
    assert "1.0e-03, 1.0e-03" not in page, "what is beaten is in the picture alone"
    summary = summary_of(report)
    assert schema_errors(report) == []
    assert summary["tradeoff"][0]["entries"][0]["pareto_front"] == [True, True]


@pytest.mark.long
def test_diagrams_of_another_scene_are_said_to_be_so(
    command: Callable[..., Run], measure: Callable[[Path, str], int], tmp_path: Path
) -> None:
    for name in ("fig3-I", "fig3-II", "fig3-II"):
        assert measure(tmp_path / "report", name) == 0
    run = command(*SMALL)
    assert run.code == 0, run.err
    page = page_of(run.report, "verification.html")
    assert page.count("not a scene of this study") == 1
    assert "(fig3-II)</span>: not a scene of this study" in page


def test_a_file_that_is_no_trade_is_refused_by_the_study(command: Callable[..., Run], tmp_path: Path) -> None:
    (tmp_path / "report").mkdir()
    (tmp_path / "report" / FILE).write_text("{}", encoding="utf-8")
    run = command(*SMALL)
    assert run.code == 2
    assert run.err.count("\n") == 1
    assert "not a measured trade" in run.err


def test_growth_with_a_gap_beside_a_report_is_part_of_it(command: Callable[..., Run], tmp_path: Path) -> None:
    run_of_growth = {**RUN, "provenance": {"commit": "abc", "processor": "one"}}
    series = [
        with_slope("bodies", "", "engine", (2.0, 4.0, 8.0), (1.0, 4.0, 16.0)),
        with_slope("bodies", "", "slow engine", (2.0, 4.0, 8.0), (1.0, float("nan"), 16.0)),
        with_slope("workers", "", "equations", (1.0, 2.0), (2.0, 1.0)),
    ]
    report = tmp_path / "report"
    growth = MeasuredGrowth(SCHEMA, "fig3-I", "a scene", series, run_of_growth)
    publish(report, {GROWTH: STORED.as_json(growth)}, tradeoff.COMMAND)
    run = command(*SMALL)
    assert run.code == 0, run.err
    page = page_of(report, "verification.html")
    for seen in ('id="tradeoff"', "engine: slope 2.00", "no answer", "made by a test"):
        assert seen in page, seen
    summary = summary_of(report)
    assert summary["growth"]["series"][1]["slope"] is None
    assert (report / "figures" / "growth.png").stat().st_size > 0
