"""Every number of a table stands below its head: planted rows in which no two numbers are alike, read back."""

import io
import math
import re
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest
from report_texts import Tables
from rich.console import Console

from comparison.cli.closing import _print_differences
from comparison.report import page
from comparison.report.page import _group_alerts, _make_template_environment, word_measurements
from comparison.report.results import VALIDATED_BRIEFLY
from comparison.report.scene_result import ModelOutcome
from comparison.report.section import Section
from comparison.report.summary_text import render_summary_text
from comparison.report.surface_sections import BUDGET, DIFFERENCES, OUTCOMES, list_models_in_use
from comparison.surfaces.alerts import Alert
from comparison.surfaces.differences import Difference, GridMean
from comparison.surfaces.headline import Effect
from comparison.surfaces.waterfall import WaterfallBar
from comparison.surfaces.waterfall_chart import make_log_scale

NAN = math.nan
ROW = Difference(
    scene="tower", body=2, first="small", second="spatial", base="small", median=0.011, percentile95=0.031,
    maximum=0.041, phases=(math.pi / 2.0, math.pi / 4.0), asked=61, pair="like-for-like", effect="turning",
    reading="as integrated", mean=-0.021, numerical_error=3e-4, sampling_error=4e-4, spread=0.052, low=-0.041,
    low_error=1e-3, low_phases=(0.0, 0.0), high=0.013, high_error=2e-3, high_phases=(0.0, 0.0), phases_per_axis=8,
    independent=59, grids=(GridMean(4, -0.071, 0.091), GridMean(8, -0.081, 0.093)), beyond_error=0.62, resolved=0.73,
    ratio=3.4, not_ok=7, unanswered=5,
)  # fmt: skip
DOTS = make_log_scale([0.021, 0.041])


def tables_of(section: str, **context: Any) -> Tables:
    titles = {"small": "small equations", "spatial": "spatial engine"}
    template = _make_template_environment().get_template(f"sections/{section}.html.j2")
    return Tables(template.render({"titles": titles, **context}))


def test_a_difference_has_mean_spread_95_percent_and_maximum_below_their_heads() -> None:
    tables = tables_of("differences", results=SimpleNamespace(phased=True), rows=[ROW], dots=DOTS)
    assert tables.rows(0) == [{
        "scene": "tower", "body": "2", "difference": "like for like", "mean, 95 %, maximum": "", "mean": "−2.1 %",
        "standard deviation": "5.2 %", "95 %": "3.1 %", "maximum": "4.1 %",
    }]  # fmt: skip
    assert tables.rows(1) == [{
        "scene": "tower", "body": "2", "difference": "like for like", "median size": "1.1 %", "maximum at α₁": "90°",
        "at α₂": "45°", "beyond uD": "62 %", "largest, uD": "3.4", "phase pairs": "61", "not ok": "7", "no value": "5",
    }]  # fmt: skip


def test_a_share_beyond_errors_is_unknown_without_errors_and_none_without_values() -> None:
    lacking = [replace(ROW, beyond_error=NAN, ratio=NAN, unanswered=count) for count in (5, 61)]
    rows = tables_of("differences", results=SimpleNamespace(phased=True), rows=lacking, dots=DOTS).rows(1)
    assert [[row["beyond uD"], row["largest, uD"]] for row in rows] == [["unknown"] * 2, ["none"] * 2]


def test_an_effect_has_mean_error_share_other_order_and_suprema_below_their_heads() -> None:
    effect = Effect("turning", "spatial", -0.021, 0.0017, 0.28, True, -0.035, "without geometry", -0.014, 0.0043)
    line = SimpleNamespace(
        body=2, effects=[effect], mean=-0.075, error=0.0023, maximum=-0.18, phases_per_axis=16, spread=0.066
    )
    scene = SimpleNamespace(name="tower", headlines=[line], effects=[ROW], differences=[ROW], recorded=False)
    results = SimpleNamespace(phased=True, scenes_with=lambda name: [scene])
    tables = tables_of("budget", results=results, grids=[4, 8])
    heads = (
        "scene", "body", "effect", "mean, as integrated", "error", "share of the total", "another order", "interaction",
        "literal suprema", "largest size", "phases",
    )  # fmt: skip
    one, total = tables.rows(0)
    cells = (
        "tower",
        "2",
        "turning",
        "−2.1 %",
        "0.17 %",
        "28 %",
        "−3.5 % without geometry",
        "−1.4 %",
        "+0.43 %",
        "4.1 %",
        "8 × 8",
    )
    assert one == dict(zip(heads, cells, strict=True))
    sums = ("tower", "2", "total", "−7.5 %", "0.23 %", "", "", "", "", "−18 %", "16 × 16")
    assert total == dict(zip(heads, sums, strict=True))
    coarse = tables.rows(1)[0]
    assert (coarse["4 × 4"], coarse["8 × 8"], coarse["sampling error"]) == ("−7.1 %", "−8.1 %", "0.04 %")
    assert (coarse["reading"], coarse["relative to"]) == ("as integrated", "small equations")
    assert coarse["difference"] == "small equations → spatial engine"


def test_an_outcome_has_its_counts_shares_and_cost_per_point_asked_for() -> None:
    outcome = ModelOutcome(
        phases_per_axis=8, points=64, computed=40, outcomes={"ok": 60, "rim reached": 4},
        advice={"rim reached": "lower it"}, cap_share=0.123, travel_share=0.456, cost=32.0,
    )  # fmt: skip
    scene = SimpleNamespace(name="tower", models={"spatial": outcome})
    results = SimpleNamespace(phased=True, scenes=[scene], run=SimpleNamespace(parts={}), faults=[])
    (row,) = tables_of("outcomes", results=results, limited=True, most_cost=32.0).rows(0)
    assert row == {
        "scene": "tower", "model": "spatial engine", "ok": "60", "phase pairs": "64", "displacement, % of ρ": "12.3",
        "% of the travel": "45.6", "other outcomes, and what to try": "4 × rim reached: lower it",
        "processor time, s": "32.0", "s per point": "0.5",
    }  # fmt: skip


def markdown(text: str, head: str) -> list[dict[str, str]]:
    """The rows of the table of summary.md below a heading."""
    lines = text.partition(f"### {head}\n")[2].splitlines()
    first = next(number for number, line in enumerate(lines) if line.startswith("| "))
    heads, _, *rows = ([cell.strip() for cell in line.strip("|").split("|")] for line in lines[first:] if line)
    return [dict(zip(heads, row)) for row in rows if len(row) == len(heads)]


def test_the_tables_of_summary_md_have_their_numbers_below_their_heads() -> None:
    bars = [WaterfallBar("resolved", -0.021, 0.001, True), WaterfallBar("spatial", 0.033, 0.04, False)]
    waterfall = SimpleNamespace(body=2, bars=bars, total=WaterfallBar("total", 0.012, 0.001, True))
    models = [SimpleNamespace(key=key, title=f"{key} title") for key in ("small", "resolved", "spatial")]
    scene = SimpleNamespace(
        name="tower", title="A tower", headlines=[], differences=[ROW], waterfalls=[waterfall],
        models={key: SimpleNamespace(outcomes={"ok": 64}) for key in ("small", "resolved", "spatial")},
    )  # fmt: skip
    results = SimpleNamespace(
        scenes=[scene], phased=[scene], grid=8, gate="All hold.", broken=[], alerts=[], absent={}, faults=[],
        measurements="nothing was measured", scenes_with=lambda name: [scene], models=models,
        run=SimpleNamespace(command="run", word_run_times="1 s", began="now", provenance={}),
    )  # fmt: skip
    text = render_summary_text(results)  # type: ignore[arg-type]
    assert markdown(text, "Differences")[0] == {
        "scene": "tower", "body": "2", "difference": "like for like", "mean": "−2.1 %", "standard deviation": "5.2 %",
        "95 %": "3.1 %", "maximum": "4.1 %", "at (α₁, α₂)": "(90°, 45°)", "beyond u\\_D": "62 %", "no value": "5 of 61",
    }  # fmt: skip
    assert markdown(text, "Causes of the difference")[0] == {
        "scene": "tower", "body": "2", "resolved title": "−2.1 %", "spatial title": "(+3.3 %)", "total": "+1.2 %",
    }  # fmt: skip


def alert(scene: str, kind: Any, level: Any = "amber", advice: str = "") -> Alert:
    return Alert(level=level, kind=kind, scene=scene, text=f"text of {scene}", help=advice)


def test_alerts_of_a_kind_are_counted_together_and_never_across_kinds() -> None:
    listed = [alert("a", "limit", "red"), alert("b", "swing"), alert("c", "swing"), alert("d", "swing", advice="other")]
    found = [(each["level"], each["title"], each["lines"]) for each in _group_alerts(SimpleNamespace(alerts=listed))]  # type: ignore[arg-type]
    assert found == [
        ("red", "1 acceptance limit broken", ["a: text of a"]),
        ("amber", "2 wide swings of the platform", ["b: text of b", "c: text of c"]),
        ("amber", "1 wide swing of the platform", ["d: text of d"]),
    ]


def test_the_answers_stand_below_their_heads_and_beside_their_labels() -> None:
    names = ("difference", "range", "causes", "agreement", "supremum")
    cells = SimpleNamespace(**{name: lambda line, name=name: f"<{name} {line.body}>" for name in names})
    scene = SimpleNamespace(name="tower", title="", headlines=[SimpleNamespace(name="platform", body=1)])
    results = SimpleNamespace(scenes=[scene], phased=True, gate="", engine_lines=[])
    template = _make_template_environment().get_template("sections/summary.html.j2")
    text = template.render(results=results, cells=cells, second_title="SECOND", drawn=[])
    less = "less the paper's equations, relative to these, as integrated"
    assert Tables(text).rows(0) == [{
        "scene": "tower", "body": "platform",
        f"SECOND {less}: mean, and range over the phases (α₁, α₂)": "<difference 1> <range 1>",
        "causes, with their share of the mean": "<causes 1>",
        "same equations and friction law: largest difference (met?)": "<agreement 1>",
        "literal supremum above as integrated: mean, largest": "<supremum 1>",
    }]  # fmt: skip
    labels = dict(re.findall(r'<td data-label="([^"]*)">.*?&lt;(\w+) 1', text))
    assert labels == {
        "SECOND less the paper’s equations, as integrated: mean, range": "difference", "causes": "causes",
        "same equations and friction law: largest difference (met?)": "agreement",
        "literal supremum above as integrated": "supremum",
    }  # fmt: skip


def test_the_answers_name_exudyn_only_where_an_engine_takes_part(monkeypatch: pytest.MonkeyPatch) -> None:
    for sides, name in ((("equations", "engine"), "Exudyn"), (("equations", "user"), "the last model")):
        models = [SimpleNamespace(side=side) for side in sides]
        monkeypatch.setattr(page, "list_models_in_use", lambda study, models=models: models)
        assert page.name_second_model(SimpleNamespace()) == name  # type: ignore[arg-type]


def test_a_section_is_there_if_it_was_asked_for_and_any_of_its_fields_was_found() -> None:
    section = Section("title", name="mine", shows=("a", "b"))
    for a, b, absent, shown in (
        (None, 1, {}, True),
        (None, [], {}, True),
        (1, None, {}, True),
        (None, None, {}, False),
        (1, 1, {"mine": ""}, False),
    ):
        results: Any = SimpleNamespace(a=a, b=b, absent=absent)
        assert section.is_present(results) == shown
        assert replace(section, shows=()).is_present(results) == (not absent)


def test_numbers_of_sections_are_of_every_scene_and_row() -> None:
    def outcome(cost: float, travel_share: float) -> Any:
        return SimpleNamespace(cost=cost, travel_share=travel_share)

    other = replace(ROW, mean=0.3, maximum=0.5, grids=(GridMean(6, 0.0, 0.0), GridMean(12, 0.0, 0.0)))
    scenes = [
        SimpleNamespace(differences=[ROW, replace(ROW, grids=(GridMean(2, 0.0, 0.0),))], effects=[other],
                        models={"a": outcome(1.0, NAN), "b": outcome(7.0, NAN)}),
        SimpleNamespace(differences=[other], effects=[ROW, replace(ROW, grids=(GridMean(16, 0.0, 0.0),))],
                        models={"a": outcome(3.0, NAN), "b": outcome(5.0, 0.2)}),
    ]  # fmt: skip
    for listed, grids, cost, limited in (
        (scenes, [2, 4, 6, 8, 12, 16], 7.0, True),
        (scenes[:1], [2, 4, 6, 8, 12], 7.0, False),
    ):
        report: Any = SimpleNamespace(
            results=SimpleNamespace(scenes=listed, scenes_with=lambda name, listed=listed: listed)
        )
        assert BUDGET.section.context(report) == {"grids": grids}
        assert OUTCOMES.section.context(report) == {"limited": limited, "most_cost": cost}
        found = DIFFERENCES.section.context(report)
        rows = [row for scene in listed for row in scene.differences]
        sizes = [0.021, 0.041, *([0.3, 0.5] if len(listed) == 2 else [])]
        assert (found["rows"], found["dots"]) == (rows, make_log_scale(sizes))
    nothing: Any = SimpleNamespace(results=SimpleNamespace(scenes=[SimpleNamespace(models={"a": outcome(0.0, NAN)})]))
    assert OUTCOMES.section.context(nothing)["most_cost"] == 1.0, "no division by zero"
    hierarchy = [SimpleNamespace(applies=names.__contains__) for names in ("a", "b", "c", "bc")]
    study: Any = SimpleNamespace(hierarchy=hierarchy, scenes=["a", "b"])
    assert list_models_in_use(study) == [hierarchy[0], hierarchy[1], hierarchy[3]]


def test_dots_are_on_a_logarithmic_axis_from_a_power_of_ten_to_another() -> None:
    scale = make_log_scale([0.02, 0.0, 0.5, NAN, math.inf])
    assert (scale.low, scale.high) == pytest.approx((0.01, 1.0))
    assert scale.ticks == [1.0, 50.0, 99.0]
    assert [scale.at(size) for size in (0.0, NAN, 1e-3, math.sqrt(1e-3), 7.0)] == [1.0, 1.0, 1.0, 25.5, 99.0]


def test_a_record_has_value_error_step_and_its_error_below_their_heads() -> None:
    value = SimpleNamespace(body=2, model="spatial", mu=1.234, error=3.1e-4, status="ok")
    bar = WaterfallBar("spatial", -0.057, 7.3e-3, True)
    scene = SimpleNamespace(
        name="tower", title="", recorded=True, values=[value], waterfalls=[SimpleNamespace(body=2, bars=[bar])]
    )
    study = SimpleNamespace(scenes=[SimpleNamespace(excitation=SimpleNamespace(files="a.at2", scale=1.0))])
    results = SimpleNamespace(scenes=[scene], phased=False)
    tables = tables_of("surfaces", results=results, study=study, has_surfaces=lambda scene: False)
    assert tables.rows(0) == [{
        "model": "spatial engine", "μ2": "1.234", "error": "3.1e-04", "step from the model above": "-5.7e-02",
        "its error": "7.3e-03", "status": "ok",
    }]  # fmt: skip


def test_what_was_measured_is_said_with_what_the_study_adds() -> None:
    assert word_measurements(SimpleNamespace(measurement_clauses=[])) == VALIDATED_BRIEFLY  # type: ignore[arg-type]
    assert word_measurements(SimpleNamespace(measurement_clauses=["one", "two"])) == f"{VALIDATED_BRIEFLY}; one; two"  # type: ignore[arg-type]


def bars_of_body(mean: float, largest: float) -> Any:
    """Bar charts of a body with one effect, in the mean and at the largest difference."""
    each = [WaterfallBar("spatial", size, 0.0, True) for size in (mean, largest)]
    nothing = WaterfallBar("total", 0.0, 0.0, True)
    return SimpleNamespace(bars=[each[0]], total=nothing, largest=SimpleNamespace(bars=[each[1]], total=nothing))


def test_a_body_is_drawn_where_any_bar_is_seen() -> None:
    sizes = ((0.009, 0.009), (-0.011, 0.0), (0.0, 0.011), (NAN, NAN))
    assert [page.is_drawn(bars_of_body(*each)) for each in sizes] == [False, True, True, False]


def test_bodies_without_a_seen_bar_are_counted_over_all_scenes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(page, "render_template", lambda name, context: context)
    monkeypatch.setattr(page, "name_second_model", lambda study: "")
    scenes = [
        SimpleNamespace(waterfalls=[bars_of_body(size, 0.0) for size in sizes], headlines=["line"] * len(sizes))
        for sizes in ((0.02, 0.001, 0.002), (0.003, 0.04))
    ]
    report: Any = SimpleNamespace(study=SimpleNamespace(hierarchy=()), results=SimpleNamespace(scenes=scenes))
    context: Any = page.render_summary(report)
    assert (len(context["drawn"]), context["hidden_bodies"]) == (2, 3)


def test_the_table_of_the_terminal_has_mean_spread_and_maximum() -> None:
    console = Console(file=io.StringIO(), width=120)
    scene = SimpleNamespace(differences=[ROW])
    _print_differences(console, SimpleNamespace(phased=True, scenes_with=lambda name: [scene]))  # type: ignore[arg-type]
    heads, cells = (
        re.split(r"\s{2,}", line.strip(" │┃"))
        for line in console.file.getvalue().splitlines()  # type: ignore[attr-defined]
        if "body" in line.split() or "tower" in line
    )
    assert dict(zip(heads, cells, strict=True)) == {
        "scene": "tower", "body": "2", "difference": "like for like", "mean": "−2.1 %", "std. dev.": "5.2 %",
        "maximum": "4.1 %", "not ok": "7",
    }  # fmt: skip
