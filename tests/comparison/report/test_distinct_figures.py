"""Figures, statistics and tables of a study of pairwise different numbers: a swap of any two fails."""

import re
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from distinct_models import (
    COARSE,
    GRID,
    KEYS,
    ROWS,
    STEPS,
    Array,
    by_phase,
    differences_of,
    distinct_hierarchy,
    distinct_study,
    drawn,
    first_mu,
    grid_phases,
    heights,
    in_percent,
    of_sizes,
)
from known_analyses import analyses_are
from known_results import FOUND
from matplotlib.colors import to_hex
from mpl_toolkits.mplot3d import Axes3D  # type: ignore[import-untyped]
from places import limited_scene
from report_texts import summary_of
from runs import quick_figures

from comparison.analyses.assumptions.figure import draw_assumptions
from comparison.analyses.assumptions.validity import AssumptionCell, Variation
from comparison.analyses.extremes.figure import draw_extremes
from comparison.analyses.panels import COLORS, draw_panels, panel
from comparison.analyses.tradeoff.feature import draw_growth, draw_tradeoff
from comparison.analyses.tradeoff.growth import SCHEMA, MeasuredGrowth, with_slope
from comparison.analyses.tradeoff.trade import Answered, Entry, Trade
from comparison.run import main
from comparison.surfaces.budget import TOTAL
from comparison.surfaces.figures import budget as budget_figure
from comparison.surfaces.figures import paper
from reference.problem import load_scene

UNUSED = Path("unused.png")
FEWER = ("translational", "spatial")  # models on COARSE phases
TITLES = ["exact equations", "exact equations, resolved peak", "exact equations, $v_{\\mathrm{reg}}$",
          "translational engine", "spatial engine", "total"]  # fmt: skip


def part(key: str, body: int) -> tuple[Array, Array]:
    """A step of the budget, or the total, on its phases, and its uncertainty: relative to the first model."""
    phases = grid_phases(COARSE if key in (*FEWER, TOTAL) else GRID)
    before, after = (KEYS[0], KEYS[-1]) if key == TOTAL else (KEYS[KEYS.index(key) - 1], key)
    first, second = (differences_of(each, body, phases) for each in (before, after))
    return second - first, np.hypot(STEPS[before][-1] * (1.0 + first), STEPS[after][-1] * (1.0 + second))


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study with limits that are broken, each by another number."""
    folder = tmp_path_factory.mktemp("limited")
    limits = "[acceptance]\nmedian = 1e-6\nmaximum = 2e-6\nratio = 1.0\n[acceptance.total]\nmaximum = 3e-6\n"
    with pytest.MonkeyPatch.context() as patch:
        quick_figures(patch)
        analyses_are(patch, motions=[])
        words = [limited_scene(folder, limits), "--grid", str(GRID), "--skip", "assumptions"]
        assert main([*words, "--out", str(folder / "report")], distinct_hierarchy(), ThreadPoolExecutor) == 0
    return folder / "report"


@pytest.mark.parametrize("body", [1, 2])
def test_every_statistic_of_a_step_is_that_of_its_sizes(body: int, report: Path) -> None:
    [scene] = summary_of(report)["scenes"]
    entries = {entry["step"]: entry for entry in scene["budget"] if entry["body"] == body}
    assert list(entries) == [*KEYS[1:], TOTAL]
    for key, entry in entries.items():
        signed, error = part(key, body)
        size, phases = np.abs(signed), grid_phases(COARSE if key in (*FEWER, TOTAL) else GRID)
        expected = {
            "median": np.median(size), "rms": np.sqrt((size**2).mean()), "maximum": size.max(),
            "percentile95": np.percentile(size, 95.0, method="hazen"), "error_estimate": np.median(error),
            "real": (size > 5.0 * error).mean(), "unresolved": ((size > error) & (size <= 5.0 * error)).mean(),
            "points": len(size), "asked": len(size),
        }  # fmt: skip
        before = KEYS[0] if key == TOTAL else KEYS[KEYS.index(key) - 1]
        both = [1.0 + differences_of(each, body, phases) for each in (before, KEYS[-1] if key == TOTAL else key)]
        expected["correlation"] = np.corrcoef(*(first_mu(body, phases) * each for each in both))[0, 1]
        for name, number in expected.items():
            assert entry[name] == pytest.approx(number, rel=1e-9), (key, name)
        assert entry["phases"] == pytest.approx(phases[size.argmax()].tolist())


@pytest.mark.parametrize("body", [1, 2])
@pytest.mark.parametrize("key", KEYS)
def test_largest_value_mean_and_fractiles_are_those_of_the_model(key: str, body: int, report: Path) -> None:
    [scene] = summary_of(report)["scenes"]
    count = COARSE if key in FEWER else GRID
    phases = grid_phases(count)
    mu = first_mu(body, phases) * (1.0 + differences_of(key, body, phases))
    [largest] = [each for each in scene["grid_maxima"] if (each["model"], each["body"]) == (key, body)]
    assert largest["mu"] == pytest.approx(mu.max(), rel=1e-12)
    assert largest["error"] == pytest.approx(STEPS[key][-1] * mu.max(), rel=1e-9)
    assert largest["phases"] == pytest.approx(phases[mu.argmax()].tolist())
    [spread] = [each for each in scene["distributions"] if (each["model"], each["body"]) == (key, body)]
    assert spread["mean"]["value"] == pytest.approx(mu.mean(), rel=1e-12)
    for each in spread["fractiles"]:
        assert each["value"] == pytest.approx(np.quantile(mu, each["probability"], method="hazen"), rel=1e-9)
    assert [each["probability"] for each in spread["fractiles"]] == sorted(
        each["probability"] for each in spread["fractiles"]
    )
    assert (scene["models"][key]["phases_per_axis"], spread["points"]) == (count, count**2)
    assert scene["models"][key]["cost"] == pytest.approx(0.001 * count**2), "1 ms for each phase pair"


def markdown_tables(report: Path) -> list[list[dict[str, str]]]:
    """The tables of summary.md: rows as cells by heading."""
    found: list[list[list[str]]] = [[]]
    for line in (report / "summary.md").read_text(encoding="utf-8").replace("\\", "").splitlines():
        if line.startswith("|"):
            found[-1].append([cell.strip() for cell in line.strip("|").split("|")])
        elif found[-1]:
            found.append([])
    return [[dict(zip(rows[0], row, strict=True)) for row in rows[2:]] for rows in found if rows]


def test_every_column_of_the_summary_holds_what_its_head_says(report: Path) -> None:
    differences, causes = markdown_tables(report)
    assert [(row["difference"], int(row["body"])) for row in differences] == ROWS
    for row, (pair, body) in zip(differences, ROWS):
        numbers = of_sizes(pair, body)
        assert row["mean"] == in_percent(numbers["mean"], "+")
        for name in ("standard deviation", "95 %", "maximum"):
            assert row[name] == in_percent(numbers[name]), (pair, body, name)
        [stored] = [
            each
            for each in summary_of(report)["scenes"][0]["differences"]
            if (each["pair"].replace("-", " "), each["body"]) == (pair, body)
        ]
        assert row["at (α₁, α₂)"] == "({:.0f}°, {:.0f}°)".format(*np.degrees(stored["phases"]))
        assert row["beyond u_D"] == in_percent(stored["beyond_error"])
        assert row["no value"] == f"0 of {COARSE**2}"
    for body, row in enumerate(causes, start=1):
        cells = []
        for key in (*KEYS[1:], TOTAL):
            before, after = (KEYS[0], KEYS[-1]) if key == TOTAL else (KEYS[KEYS.index(key) - 1], key)
            levels = [1.0 + differences_of(each, body, grid_phases(COARSE)) for each in (before, after)]
            error = np.hypot(*(STEPS[each][-1] * level for each, level in zip((before, after), levels))).mean()
            mean = (levels[1] - levels[0]).mean()
            text = in_percent(mean, "+")
            cells.append(text if abs(mean) > 5.0 * error else f"({text})")
        assert list(row.values()) == ["limited", str(body), *cells, str(COARSE**2)]
        assert 0 < sum(cell.startswith("(") for cell in cells) < len(cells)
    names = [name.replace("$v_{\\mathrm{reg}}$", "v_reg") for name in TITLES]
    assert list(causes[0]) == ["scene", "body", *names, "phase pairs"]


def test_junit_has_the_numbers_that_break_each_limit(report: Path) -> None:
    suite = ElementTree.parse(report / "junit.xml").getroot()[0]
    found = {
        str(case.get("name")): re.findall(r"body (\d).*?: ([\d.e-]+) found", case.findtext("failure") or "")
        for case in suite.findall("testcase")
    }
    for name, pair, statistic in (
        ("acceptance.median = 1e-06", "like for like", "median size"),
        ("acceptance.maximum = 2e-06", "like for like", "maximum"),
        ("acceptance.total.maximum = 3e-06", "total", "maximum"),
    ):
        assert found.pop(name) == [(str(body), f"{of_sizes(pair, body)[statistic]:.3g}") for body in (1, 2)], name
    phases, [(name, breaches)] = grid_phases(COARSE), [pair for pair in found.items() if pair[1]]
    assert name == "acceptance.ratio = 1"
    for body, (_, ratio) in enumerate(breaches, start=1):
        first, second = (1.0 + differences_of(key, body, phases) for key in ("regularised", "translational"))
        units = np.hypot(STEPS["regularised"][-1] * first, STEPS["translational"][-1] * second)
        assert float(ratio) == pytest.approx((np.abs(second - first) / units).max(), rel=5e-3)
    costs = sum((COARSE if key in FEWER else GRID) ** 2 for key in KEYS)
    assert suite.get("time") == f"{0.001 * costs:.1f}"


@pytest.mark.parametrize("body", [1, 2])
def test_every_map_of_the_budget_is_under_its_title(body: int, monkeypatch: pytest.MonkeyPatch) -> None:
    study, surfaces = distinct_study()
    figure = drawn(monkeypatch, budget_figure.draw_budget, UNUSED, study, surfaces, study.scenes[0], body)
    *maps, bar = figure.axes
    most = 100.0 * max(np.abs(part(key, body)[0]).max() for key in (*KEYS[1:], TOTAL))
    for axes in maps:
        assert axes.collections[0].get_clim() == pytest.approx((-most, most))
    assert [axes.get_title().split("\n")[0] for axes in maps] == TITLES
    for axes, key in zip(maps, [*KEYS[1:], TOTAL], strict=True):
        size, error = part(key, body)
        shown = 100.0 * by_phase(size)
        np.testing.assert_allclose(axes.collections[0].get_array().reshape(shown.shape), shown.T, rtol=1e-9)
        real = np.abs(size) > 5.0 * error
        assert axes.get_title().split("\n")[1] == f"real at {100.0 * real.mean():.0f} % of {len(size)}"
        [dots] = axes.lines
        count = round(len(size) ** 0.5)
        row, column = np.nonzero(~real.reshape(count, count))
        assert dots.get_xdata() == pytest.approx(2.0 * np.pi * row / count)
        assert dots.get_ydata() == pytest.approx(2.0 * np.pi * column / count)
    assert bar.get_ylabel() == "% of the first model's value"
    assert f"body {body}" in figure.get_suptitle()


def test_the_manuscript_has_both_models_on_one_scale(monkeypatch: pytest.MonkeyPatch) -> None:
    study, surfaces = distinct_study()
    shown: list[tuple[Any, ...]] = []
    surface = Axes3D.plot_surface

    def told(axes: Axes3D, *xyz: Array, **look: object) -> object:
        shown.append(xyz)
        return surface(axes, *xyz, **look)

    monkeypatch.setattr(Axes3D, "plot_surface", told)
    figure = drawn(monkeypatch, paper.draw_paper_figure, UNUSED, study, surfaces, study.scenes[0])
    assert [axes.get_title() for axes in figure.axes] == [
        rf"({letter}) $\mu_{{{body}}}$, {title}"
        for letter, body, title in zip("abcd", (1, 1, 2, 2), 2 * ["small equations", "translational engine"])
    ]
    for number, axes in enumerate(figure.axes):
        body, key = number // 2 + 1, ("small", "translational")[number % 2]
        alpha1, alpha2, mu = shown[number]
        count = COARSE if key in FEWER else GRID
        np.testing.assert_allclose(mu, heights(key, body, count), rtol=1e-12)
        assert alpha1[1, 0] == alpha2[0, 1] == pytest.approx(2.0 * np.pi / count)
        both = np.concatenate([heights("small", body, GRID).ravel(), heights("translational", body, COARSE).ravel()])
        assert (axes.get_xlabel(), axes.get_ylabel()) == (r"$\alpha_1$", r"$\alpha_2$")
        assert axes.get_zlabel() == rf"$\mu_{{{body}}}$"  # type: ignore[attr-defined]
        assert axes.get_zlim() == pytest.approx((both.min(), both.max()))  # type: ignore[attr-defined]


def test_the_map_of_the_assumptions_has_every_change_in_its_field(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = load_scene("fig3-I")
    rings, levels = (0.5, 1.0, 2.0), (0.5, 1.0)

    def size(ring: float, height: float, body: int) -> float:
        return 0.01 * ring + 0.001 * height * body

    cells = [
        AssumptionCell(
            scene.name, Variation(ring, height), ((size(ring, height, 1), -size(ring, height, 2)),), ((1e-5,) * 2,),
            ("ok",),
        )
        for ring in rings
        for height in levels
    ]  # fmt: skip
    figure = drawn(monkeypatch, draw_assumptions, UNUSED, scene, cells)
    for body, axes in enumerate(figure.axes, start=1):
        assert rf"change of $\mu_{{{body}}}$, %" in axes.get_title()
        texts = {text.get_position(): text.get_text() for text in axes.texts}
        assert texts == {
            (column, row): f"{100.0 * size(ring, height, body):.2g}"
            for column, ring in enumerate(rings)
            for row, height in enumerate(levels)
        }
        radius = scene.support_radius or 0.0
        assert [label.get_text() for label in axes.get_xticklabels()] == [f"{ring * radius:g}" for ring in rings]
        ticks = [label.get_text() for label in axes.get_yticklabels()]
        assert ticks == [f"{height:g}" for height in levels] or body > 1, "the panels share them"
        assert (axes.get_xlabel(), axes.get_ylabel()) == (
            "radius of the ring of supports, m",
            "heights, times the stated ones",
        )


def test_the_trade_off_has_every_curve_in_its_panel(monkeypatch: pytest.MonkeyPatch) -> None:
    def setting(question: str, number: int) -> Entry:
        base = (1.0 if question == "exact" else 3.0) * 10.0**-number
        errors = (1e-3 * base, 2e-3 * base), (5e-3 * base, 7e-3 * base), (1.0, 1.0)
        numbers = base, True, False, 4, 4, 0.01 * (number + 1) * base
        return Entry(question, "reference, one run", "tolerance", "", *numbers, *errors, None, (number == 1, False))

    questions = [Answered(key, f"title of {key}", 4, "itself", 1e-9, []) for key in ("exact", "small")]
    entries = [setting(question.key, number) for question in questions for number in (1, 2)]
    figure = drawn(monkeypatch, draw_tradeoff, UNUSED, Trade("fig3-I", "Case I", "0", 2, questions, entries, {}))
    for place, axes in enumerate(figure.axes):
        body, question = place % 2, questions[place // 2]
        shown = [entry for entry in entries if entry.question == question.key]
        [line] = axes.lines
        assert line.get_xdata() == pytest.approx([entry.seconds for entry in shown])
        assert line.get_ydata() == pytest.approx([entry.most[body] for entry in shown])
        assert axes.get_title() == rf"{question.title}, $μ_{{\mathrm{{{body + 1}}}}}$"
        assert (axes.get_xlabel(), axes.get_ylabel()) == ("processor time per point, s", "relative error, 95 %")


def test_a_panel_is_drawn_as_it_is_described(monkeypatch: pytest.MonkeyPatch) -> None:
    x = {"title": "μ_1", "log": True, "range": (0.5, 40.0)}
    y = {"title": "share", "ticks": [[1.0, "one"], [3.0, "three"]], "range": (-1.0, 8.0)}
    about = {"x": [1.0, 10.0], "y": [1.0, 3.0], "low": [0.5, 2.0], "high": [2.0, 5.0]}
    series = [
        {**about, "name": "band", "band": True, "color": 1, "width": 2.5},
        {**about, "name": "bars", "color": "gray", "marks": True, "dash": "4 2"},
        {"name": "points", "x": [3.0], "y": [2.0], "color": 10, "line": False, "marks": True, "legend": False},
        *({"name": f"more {number}", "x": [3.0], "y": [None]} for number in range(3)),
    ]
    described = panel("title of μ_2", "", x, y, series, bands=[{"from": -9.0, "to": 0.5}])
    figure = drawn(monkeypatch, draw_panels, UNUSED, "a title", [described] * 2, 3)
    assert (figure.get_suptitle(), len(figure.axes)) == ("a title", 2)
    axes = figure.axes[0]
    band, bars = axes.collections
    corners = band.get_paths()[0].vertices
    assert {tuple(corner) for corner in corners} == {(1.0, 0.5), (1.0, 2.0), (10.0, 2.0), (10.0, 5.0)}
    assert [segment.tolist() for segment in bars.get_segments()] == [  # type: ignore[attr-defined]
        [[1.0, 0.5], [1.0, 2.0]],
        [[10.0, 2.0], [10.0, 5.0]],
    ]
    first, second, third, *_ = axes.lines
    assert [tuple(line.get_xydata().ravel()) for line in (first, second, third)] == [  # type: ignore[union-attr]
        (1.0, 1.0, 10.0, 3.0), (1.0, 1.0, 10.0, 3.0), (3.0, 2.0),
    ]  # fmt: skip
    looks = [(line.get_color(), line.get_linestyle(), line.get_marker(), line.get_linewidth()) for line in axes.lines]
    assert looks[:4] == [
        (COLORS[1], "-", "", 2.5), ("0.5", "--", "o", 1.4), (COLORS[2], "None", "o", 1.4), (COLORS[0], "-", "", 1.4),
    ]  # fmt: skip
    assert to_hex(band.get_facecolor()[0]) == COLORS[1]  # type: ignore[index]
    assert tuple(bars.get_color()[0][:3]) == (0.5, 0.5, 0.5)  # type: ignore[attr-defined]
    assert (axes.get_xlabel(), axes.get_ylabel()) == (r"$μ_{\mathrm{1}}$", "share")
    assert axes.get_title() == r"title of $μ_{\mathrm{2}}$"
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "linear")
    assert (axes.get_xlim(), axes.get_ylim()) == ((0.5, 40.0), (-1.0, 8.0))
    assert list(zip(axes.get_yticks(), (tick.get_text() for tick in axes.get_yticklabels()))) == [
        (1, "one"),
        (3, "three"),
    ]
    [shade] = axes.patches
    assert shade.get_extents().transformed(axes.transData.inverted()).intervaly == pytest.approx((-1.0, 0.5))
    legend = axes.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.texts] == ["band", "bars", "more 0", "more 1", "more 2"]
    assert legend._ncols == 2, "five names are more than a column holds"  # type: ignore[attr-defined]


def test_growth_and_extremes_are_drawn_as_they_are(monkeypatch: pytest.MonkeyPatch) -> None:
    series = [
        with_slope("bodies", "", "engine", (2.0, 4.0, 8.0), (1.0, 4.0, 16.0)),
        with_slope("workers", "", "equations", (1.0, 2.0), (2.0, 1.5)),
    ]
    axes = drawn(monkeypatch, draw_growth, UNUSED, MeasuredGrowth(SCHEMA, "fig3-I", "a scene", series, {})).axes
    assert [(each.get_xlabel(), each.get_ylabel()) for each in axes] == [
        ("bodies", "processor time, s"),
        ("workers", "wall time, s"),
    ]
    assert [(*each.lines[0].get_xdata(), *each.lines[0].get_ydata()) for each in axes] == [
        (*one.values, *one.seconds) for one in series
    ]
    assert axes[0].lines[0].get_label() == "engine: slope 2.00 ± 0.00"
    figure = drawn(monkeypatch, draw_extremes, UNUSED, FOUND)
    fields = {text.get_text(): text.get_position() for panel in figure.axes for text in panel.texts}
    assert [fields[text][0] for text in ("2e-07", "step limit", "FAILED")] == [0.5, 1.5, 0.5], "columns of the models"
    titles = {text.replace("\n", " "): place for text, place in fields.items()}
    assert [titles[name][0] for name in FOUND.columns.values()] == [0.5, 1.5]
    for title, text in (("1e-9", "2e-07"), ("10", "step limit"), ("1e3", "FAILED")):
        assert fields[title][1] == pytest.approx(fields[text][1], abs=0.05), "in the line of its extreme"
    [legend] = figure.legends
    assert [text.get_text().split(":")[0] for text in legend.texts] == [
        "1 converged", "0 refused", "1 limit", "1 FAILED",
    ]  # fmt: skip
