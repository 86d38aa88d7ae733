"""What other commands leave beside a report is part of the next one, and no run loses it."""

import json
import re
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from fake_models import fake_hierarchy
from known_analyses import analyses_are
from known_results import FILES, leave_beside
from report_texts import Tables, both_pages, flat, page_of, schema_errors, summary_of, text_of
from runs import SMALL, Run, quick_figures

from comparison.analyses.ensemble import result as ensemble
from comparison.analyses.ensemble.feature import ensemble_panels
from comparison.analyses.tradeoff.trade import FILE as TRADES
from comparison.analyses.validation import table as validation
from comparison.registry import StudyResults
from comparison.run import main
from comparison.runner.output import publish

ISOLATOR = "largest displacement of the isolator"


MAKES = ("extremes", "benchmarks", "tradeoff SCENE", "ensemble SCENE", "validation FOLDER")


def studied(place: Path, patch: pytest.MonkeyPatch, *words: str) -> int:
    """A small study by fake models; its exit code."""
    quick_figures(patch)
    analyses_are(patch, motions=[])
    return main([*SMALL, *words, "--out", str(place)], fake_hierarchy(), ThreadPoolExecutor)


@pytest.fixture(scope="module")
def beside(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path, dict[str, bytes]]:
    """The pages of a report alone; the report with all results beside it, and their files as they were before it."""
    place = tmp_path_factory.mktemp("beside") / "report"
    with pytest.MonkeyPatch.context() as patch:
        assert studied(place, patch) == 0
        alone = both_pages(place)
        leave_beside(place, FILES, "fig3-I", "fig3-II")
        diagrams = {f"fig3-I-tradeoff.{ending}" for ending in ("nc", "png", "pdf")}
        kept = {name: (place / name).read_bytes() for name in (*FILES, TRADES, *diagrams)}
        assert studied(place, patch) == 0
    return alone, place, kept


def test_results_beside_a_report_are_part_of_the_next(beside: tuple[str, Path, dict[str, bytes]]) -> None:
    alone, place, kept = beside
    pages = both_pages(place)
    for name in MAKES:
        line = f"python -m comparison.{name} makes it"
        assert (line in alone, line in pages) == (True, False), name
    for seen in (
        'id="extremes"', "2e-07", "step limit", "hangs: &lt;forever&gt;",
        'id="benchmarks"', "2.0242 s ± 5e-05", "2.02423 ± 2e-08", "no answer", "a &lt;frame&gt;", "heated",
        'id="tradeoff"', "it agrees &lt;with itself&gt;", "3.0e-08, 4.0e-08", "engine: slope 2.00",
        'id="ensemble"', "Tower &amp; &lt;town&gt;", "5 ok, 1 rim reached",
        'id="validation"', "a &lt;fact&gt;", "half range, mm", "the ratio depends on the load",
    ):  # fmt: skip
        assert seen in pages, seen
    assert pages.count("made &lt;by a test&gt;") >= 4, "every command says how it was made"
    assert "1.0e-03, 1.0e-03" not in pages, "what is beaten is in the picture alone"
    assert pages.count("not a scene of this study") == 1
    assert "(fig3-II)</span>: not a scene of this study" in pages
    assert {name: (place / name).read_bytes() for name in kept} == kept
    assert {"extremes.png", "growth.png"} <= {file.name for file in (place / "figures").iterdir()}


def test_results_beside_a_report_are_in_its_summary(beside: tuple[str, Path, dict[str, bytes]]) -> None:
    _, place, _ = beside
    assert schema_errors(place) == []
    summary = summary_of(place)
    assert summary["extremes"]["rows"][1]["entries"]["spatial"]["reason"] == "step limit"
    assert summary["benchmarks"]["benchmarks"][0]["rows"][0]["published"] == 2.0242
    assert summary["tradeoff"][0]["entries"][0]["pareto_front"] == [True, True]
    assert summary["growth"]["series"][1]["slope"] is None
    assert summary["ensemble"]["curves"][2]["values"] == [0.3, None]


def test_the_pdf_has_the_demands_of_an_ensemble(beside: tuple[str, Path, dict[str, bytes]]) -> None:
    """The largest scale alone, every number in its column, and how closely the codes agree."""
    pages, text = text_of(beside[1] / "report.pdf")
    assert 2 <= pages <= 4
    words = f"Tower & <town> (tower): 3 motions, scale 2 mean 16 % 50 % 84 % largest smallest motions {ISOLATOR}, mm "
    for seen in (f"{words} none 296 500 none none 200 ± 1 2", "The translational engine computed 1 of the motions"):
        assert flat(seen) in flat(text), seen
    assert flat("scale 1 mean") not in flat(text)


def test_a_panel_of_an_ensemble_is_in_the_unit_of_its_axis(beside: tuple[str, Path, dict[str, bytes]]) -> None:
    results = StudyResults.model_validate_json((beside[1] / "summary.json").read_bytes())
    [panel] = [each for each in ensemble_panels(results.of("ensemble")) if each["title"] == ISOLATOR]
    assert panel["plot"]["y"] == {"title": f"{ISOLATOR}, mm", "range": pytest.approx([0.0, 1.06 * 511.0])}
    motions, [band], [engine] = (
        [line for line in panel["plot"]["series"] if line["name"] == name]
        for name in ("tower: one motion", "tower", "engine")
    )
    assert [line["y"][0] for line in motions] == pytest.approx([100.0, 200.0, 300.0])
    assert [line.get("legend", True) for line in (*motions, band, engine)] == [False, False, False, True, True]
    assert [band[key][0] for key in ("low", "y", "high")] == pytest.approx([132.0, 200.0, 268.0])
    assert [engine[key] for key in ("low", "y", "high")] == [pytest.approx([x]) for x in (509.0, 510.0, 511.0)]


def test_the_tables_of_an_ensemble_have_every_number_in_its_column(beside: tuple[str, Path, dict[str, bytes]]) -> None:
    tables = Tables(page_of(beside[1]))
    high, low = (dict(zip(*table[:2])) for table in tables.tables if "84 %" in table[0])
    assert low == {
        "demand": f"{ISOLATOR}, mm", "mean": "210", "16 %": "132", "50 %": "200", "84 %": "268",
        "largest": "300", "smallest": "100", "motions": "3",
    }  # fmt: skip
    page = page_of(beside[1])
    assert page.index(": 3 motions, scale 2</h3>") < page.index(": 3 motions, scale 1</h3>")
    assert (high["84 %"], high["motions"], high["smallest"]) == ("none", "2", "200 ± 1")
    [engine] = tables.headed("demand", "like for like", "errors")
    assert list(engine.values()) == [ISOLATOR, "tower", "2 %", "0.01 %", "0.2 %", "1"]


def test_the_tables_of_errors_have_every_number_in_its_column(beside: tuple[str, Path, dict[str, bytes]]) -> None:
    tables = Tables(both_pages(beside[1]))
    trades = [table for table in tables.tables if table[0][-3:] == ["median error", "95 %", "95 % of the estimates"]]
    for row in (row for table in trades for row in table[1:]):
        assert row[-3:] == ["1.0e-09, 2.0e-09", "3.0e-08, 4.0e-08", "none, none"]
    assert len(trades) == 2
    [table] = [table for table in tables.tables if table[0][:3] == ["experiment", "quantity", "use"]]
    for row, each in zip(table[1:], validation.recorded().quantities, strict=True):
        numbers = [each.data, each.inputs]
        assert row[3:6] == [f"{each.measured:.5g}", *(f"{number:.2g}" for number in numbers)]
        for first, side in ((6, "equations"), (10, "engine")):
            number = each.sides[side]
            sizes = number.error, number.numerical, number.validation
            assert row[first : first + 3] == ["none" if size is None else f"{size:.2g}" for size in sizes]


@pytest.mark.parametrize("name", [*FILES, TRADES])
def test_a_file_that_is_no_result_is_refused_at_the_start(
    command: Callable[..., Run], tmp_path: Path, name: str
) -> None:
    publish(tmp_path / "report", {name: b'{"schema": "a-secret", "a-secret": 1}'}, "a test")
    run = command(*SMALL, hierarchy=fake_hierarchy("forbidden"))
    assert (run.code, run.out, run.err.count("\n")) == (2, "", 1)
    assert re.search(rf"{name}: not (a|an) .*: run python -m comparison\.", run.err)
    assert "a-secret" not in run.err, "nothing of it is quoted"


@pytest.mark.parametrize("stripes", [False, True])
def test_an_ensemble_without_any_answer_is_shown(command: Callable[..., Run], tmp_path: Path, stripes: bool) -> None:
    content = json.loads(FILES[ensemble.FILE]) | {"curves": [], "outcomes": {"rim reached": 6}}
    content["stripes"] = content["stripes"][1:] if stripes else []
    publish(tmp_path / "report", {ensemble.FILE: json.dumps(content).encode()}, "a test")
    run = command(*SMALL, "--only", "ensemble")
    assert (run.code, "6 rim reached" in page_of(run.report)) == (0, True)
