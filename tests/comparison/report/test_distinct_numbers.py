"""A study of pairwise different numbers, read back from page, texts, terminal and figures: each stands in its place."""

import json
import re
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from html import unescape
from itertools import pairwise
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
    grid_phases,
    heights,
    in_percent,
    of_sizes,
    pair_sizes,
    step,
)
from known_analyses import analyses_are
from known_results import MEASURED, SEARCHED
from mpl_toolkits.mplot3d import Axes3D  # type: ignore[import-untyped]
from report_texts import Tables, data_of, flat, page_of, summary_of, text_of
from runs import RUN, Run, quick_figures

from comparison.analyses.worst_phases.analysis import Worst
from comparison.registry import report_of
from comparison.report.page_data import page_data
from comparison.report.pdf import map_tasks
from comparison.run import main
from comparison.surfaces.distribution import distributions, grid_maxima
from comparison.surfaces.figures import pairs, print_maps

EFFECTS = (
    "geometry",
    "the peak at the stop",
    "regularized friction",
    "elastic contact",
    "turning of the bodies",
)


def with_error(size: float, error: float) -> str:
    """A share with the digits that its error leaves, and the error where these show it."""
    if error <= 0.01 * abs(size):
        return in_percent(size, "+")
    digits = max(0, -int(np.floor(np.log10(100.0 * error))))
    sign = "−" if size < 0.0 else "+"
    return f"{sign}{100.0 * abs(size):.{digits}f} ± {100.0 * error:.{digits}f} %"


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("distinct") / "report"
    with pytest.MonkeyPatch.context() as patch:
        quick_figures(patch)
        analyses_are(patch, motions=[], worst_phases=SEARCHED, measured=MEASURED)
        words = ["fig3-I", "--grid", str(GRID), "--skip", "assumptions", "--out", str(place)]
        assert main(words, distinct_hierarchy(), ThreadPoolExecutor) == 0
    return place


@pytest.fixture(scope="module")
def tables(report: Path) -> Tables:
    return Tables(page_of(report))


@pytest.fixture(scope="module")
def summary(report: Path) -> dict[str, Any]:
    found: dict[str, Any] = summary_of(report)
    return found


def test_no_two_statistics_of_the_study_are_written_alike() -> None:
    for pair, body in ROWS:
        written = {in_percent(abs(value)) for value in of_sizes(pair, body).values()}
        assert len(written) == 5, f"{pair}, body {body}"
        signed = pair_sizes(pair, body)
        assert in_percent(signed.mean()) != in_percent(np.median(signed)), f"{pair}, body {body}"
    means = [of_sizes(pair, body)["mean"] for pair, body in ROWS]
    assert min(means) < 0.0 < max(means), "of both signs"


@pytest.mark.parametrize(("pair", "body"), ROWS)
def test_every_statistic_of_a_pair_stands_in_its_own_column(
    pair: str, body: int, tables: Tables, summary: dict[str, Any]
) -> None:
    numbers, place = of_sizes(pair, body), lambda row: (row["body"], row["difference"]) == (str(body), pair)
    [row] = filter(place, tables.headed("mean, 95 %, maximum", "standard deviation"))
    for name in ("mean", "standard deviation", "95 %", "maximum"):
        assert row[name] == in_percent(numbers[name], "+" if name == "mean" else "")
    [row] = filter(place, tables.headed("median size", "beyond uD"))
    assert row["median size"] == in_percent(numbers["median size"])
    [stored] = [
        each
        for each in summary["scenes"][0]["differences"]
        if (each["body"], each["pair"]) == (body, pair.replace(" ", "-"))
    ]
    fields = {"mean": "mean", "spread": "standard deviation", "median": "median size", "percentile95": "95 %"}
    for field, name in (fields | {"maximum": "maximum"}).items():
        assert stored[field] == pytest.approx(numbers[name], rel=1e-9)


def test_the_largest_is_at_the_phases_where_it_is(tables: Tables) -> None:
    for row in tables.headed("median size", "beyond uD"):
        sizes = np.abs(pair_sizes(row["difference"], int(row["body"])))
        alpha1, alpha2 = np.degrees(grid_phases(COARSE)[sizes.argmax()])
        assert (row["maximum at α₁"], row["at α₂"]) == (f"{alpha1:.0f}°", f"{alpha2:.0f}°")


def test_beyond_u_d_counts_differences_of_both_signs(tables: Tables) -> None:
    shares = set()
    for row in tables.headed("median size", "beyond uD"):
        pair, body = row["difference"], int(row["body"])
        signed, phases = pair_sizes(pair, body), grid_phases(COARSE)
        first, second = (
            ("regularised" if pair == "like for like" else "small"),
            ("spatial" if pair == "total" else "translational"),
        )
        ratio = (1.0 + differences_of(second, body, phases)) / (1.0 + differences_of(first, body, phases))
        error = np.hypot(STEPS[first][-1], STEPS[second][-1] * ratio)
        beyond = np.abs(signed) > error
        assert row["beyond uD"] == f"{100.0 * beyond.mean():.0f} %"
        if (signed[beyond] < 0.0).any():
            shares.add((pair, body))
    assert len(shares) > 2, "there are negative ones among them"


def test_ring_and_bar_of_the_chart_are_at_95_percent_and_maximum(report: Path) -> None:
    page = page_of(report)
    charts = re.findall(r'<svg class="dots body-(\d)".*?</svg>', page)
    drawn = re.findall(r'<svg class="dots body-\d".*?</svg>', page)
    assert len(charts) == len(drawn) == 6
    ends = re.search(r"logarithmic axis from ([\d.e+-]+) % to ([\d.e+-]+) %", page)
    assert ends is not None
    low, high = (float(end) / 100.0 for end in ends.groups())

    def at(size: float) -> float:
        return 1.0 + 98.0 * np.log(size / low) / np.log(high / low)

    for (pair, body), chart in zip(ROWS, drawn):
        numbers = of_sizes(pair, body)
        ring = float(re.search(r'class="ring" cx="([\d.]+)%', chart)[1])  # type: ignore[index]
        end = float(re.search(r'class="end" x1="([\d.]+)%', chart)[1])  # type: ignore[index]
        dot = float(re.search(r'<circle cx="([\d.]+)%', chart)[1])  # type: ignore[index]
        expected = [at(abs(numbers[name])) for name in ("mean", "95 %", "maximum")]
        assert [dot, ring, end] == pytest.approx(expected, abs=2e-3)


def bars_of_page(report: Path, body: int, view: str = "mean") -> Iterator[tuple[str, str]]:
    """Title and markup of every row of a waterfall of the page."""
    page = page_of(report)
    tables = re.findall(rf'<table class="waterfall fixed" data-waterfall="{view}".*?</table>', page, re.DOTALL)
    for row in re.findall(r"<tr class=\"(?!axis).*?</tr>", tables[body - 1], re.DOTALL):
        yield re.sub("<.*?>", "", re.search(r"<th.*?</th>", row, re.DOTALL)[0]), row  # type: ignore[index]


@pytest.mark.parametrize("body", [1, 2])
def test_an_error_bar_is_as_long_as_the_error_on_either_side(body: int, report: Path) -> None:
    rows = list(bars_of_page(report, body))
    assert len(rows) == 6
    ticks = [float(x) for x in re.findall(r'class="(?:grid|zero)" x1="([\d.]+)%', rows[0][1])]
    page = page_of(report)
    labels = re.findall(r'<text x="[\d.]+%" y="11" text-anchor="middle"[^>]*>(.*?)</text>', page)[: len(ticks)]
    sizes = [float(label.replace("−", "-").replace("+", "").replace(" %", "")) / 100.0 for label in labels]
    per_share = (ticks[-1] - ticks[0]) / (sizes[-1] - sizes[0])  # percent of the width for a size of 1
    phases = grid_phases(COARSE)
    levels = {key: 1.0 + differences_of(key, body, phases) for key in KEYS}
    for (first, second), (_, row) in zip([*pairwise(KEYS), (KEYS[0], KEYS[-1])], rows, strict=True):
        error = np.hypot(STEPS[first][-1] * levels[first], STEPS[second][-1] * levels[second]).mean()
        low, high = map(float, re.search(r'class="error" x1="([-\d.]+)%" x2="([-\d.]+)%', row).groups())  # type: ignore[union-attr]
        assert high - low == pytest.approx(2.0 * error * per_share, abs=2.1e-3), "the places have three decimals"


@pytest.mark.parametrize("body", [1, 2])
def test_every_place_has_the_one_mean_of_the_total(
    body: int, report: Path, tables: Tables, summary: dict[str, Any]
) -> None:
    signed = differences_of("spatial", body, grid_phases(COARSE))
    mean, spread = signed.mean(), signed.std()
    scene = summary["scenes"][0]
    headline, waterfall = scene["headlines"][body - 1], scene["waterfalls"][body - 1]
    total = next(row for row in scene["differences"] if (row["body"], row["pair"]) == (body, "total"))
    for held in (headline["mean"], waterfall["total"]["size"], total["mean"]):
        assert held == pytest.approx(mean, rel=1e-9)
    for held in (headline["spread"], waterfall["spread"], total["spread"]):
        assert held == pytest.approx(spread, rel=1e-9)
    assert sum(bar["size"] for bar in waterfall["bars"]) == pytest.approx(mean, rel=1e-12)
    digits = f"{abs(100.0 * mean):.2g} %"
    direction = "less" if mean < 0.0 else "more"
    assert f"the engine gives {digits} {direction} than the paper's equations (mean over 4 × 4" in headline["sentence"]
    assert f"standard deviation {100.0 * spread:.2g} %;" in headline["sentence"]
    rows = [text for title, text in bars_of_page(report, body) if title == "= total"]
    sign = "−" if mean < 0.0 else "+"
    assert [re.search(r'<td class="size">(.*?)</td>', row)[1] for row in rows] == [sign + digits]  # type: ignore[index]
    [row] = [
        row for row in tables.headed("step to", "real at") if (row["body"], row["step to"]) == (str(body), "total")
    ]
    assert row["mean"] == in_percent(mean, "+")
    statement = headline["sentence"].removeprefix("fig3-I, ")
    assert statement in unescape(re.sub("<.*?>", "", page_of(report)))
    assert statement in (report / "summary.md").read_text(encoding="utf-8").replace("\\", "")
    assert statement in str(ElementTree.parse(report / "junit.xml").getroot().findtext("testsuite/system-out"))
    assert flat(statement) in flat(text_of(report / "report.pdf")[1])


def test_means_of_the_steps_in_the_table_are_the_bars(tables: Tables, summary: dict[str, Any]) -> None:
    titles = {model["title"].replace("_", ""): model["key"] for model in summary["models"]}
    rows = [row for row in tables.headed("step to", "real at") if row["step to"] != "total"]
    assert len(rows) == 10
    for row in rows:
        key, body = titles[row["step to"]], int(row["body"])
        count = COARSE if key in ("translational", "spatial") else GRID  # of the sizes: of both models of the step
        sizes = np.abs(step(key, body, count))
        assert row["mean"] == in_percent(step(key, body).mean(), "+")
        assert row["95 %"] == in_percent(np.percentile(sizes, 95.0, method="hazen"))
        assert row["maximum"] == in_percent(sizes.max())


def test_the_terminal_has_statistics_and_times_of_the_page(
    command: Callable[..., Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    run = command("fig3-I", "--grid", str(GRID), "--skip", "assumptions", hierarchy=distinct_hierarchy())
    cells = [re.split(r"\s{2,}", line.strip()) for line in run.out.splitlines()]
    heading = next(row for row in cells if row[0] == "scene")
    assert heading[3:6] == ["mean", "std. dev.", "maximum"]
    for pair, body in ROWS:
        [row] = [row for row in cells if row[1:3] == [str(body), pair]]
        numbers = of_sizes(pair, body)
        written = [float(cell.replace("−", "-").replace("+", "").replace(" %", "")) / 100.0 for cell in row[3:6]]
        expected = [numbers[name] for name in ("mean", "standard deviation", "maximum")]
        assert written == pytest.approx(expected, rel=0.06), "two digits"
    text = summary_of(run.report)["run"]
    took = f"{text['wall_seconds']:.1f} s of wall time with {text['jobs']} workers, {text['processor_seconds']:.1f} s"
    for place in (run.out, *((run.report / name).read_text(encoding="utf-8") for name in ("index.html", "summary.md"))):
        assert f"{took} of processor time" in place
    assert flat(f"{took} of processor time") in flat(text_of(run.report / "report.pdf")[1])


def test_a_pair_of_surfaces_has_each_under_its_title(monkeypatch: pytest.MonkeyPatch) -> None:
    study, surfaces = distinct_study()
    scene = study.scenes[0]
    [pair] = [pair for pair in study.pairs(scene) if pair.key == "translational"]
    shown: list[tuple[Any, ...]] = []
    surface = Axes3D.plot_surface

    def told(axes: Axes3D, *xyz: Array, **look: object) -> object:
        shown.append((axes, *xyz))
        return surface(axes, *xyz, **look)

    monkeypatch.setattr(Axes3D, "plot_surface", told)
    figure = drawn(monkeypatch, pairs.draw_pair, Path("unused.png"), surfaces, scene, 2, pair)
    first, second, difference, _ = figure.axes
    assert ["small equations" in first.get_title(), "translational engine" in second.get_title()] == [True, True]
    for axes, key, count in ((first, "small", GRID), (second, "translational", COARSE)):
        [(_, alpha1, alpha2, mu)] = [call for call in shown if call[0] is axes]
        np.testing.assert_allclose(mu, heights(key, 2, count), rtol=1e-12)
        assert alpha1[1, 0] == alpha2[0, 1] == pytest.approx(2.0 * np.pi / count)
        assert alpha1[0, 1] == alpha2[1, 0] == 0.0
    for axes in (first, second, difference):
        assert (axes.get_xlabel(), axes.get_ylabel()) == (r"$\alpha_1$, rad", r"$\alpha_2$, rad")
    [mesh] = difference.collections
    sizes = 100.0 * by_phase(pair_sizes("translational", 2))
    np.testing.assert_allclose(mesh.get_array().reshape(COARSE + 1, COARSE + 1), sizes.T, rtol=1e-9)
    assert f"largest of 4 × 4: {np.abs(sizes).max():.2g} %" in difference.get_title()
    limit = np.percentile(np.abs(sizes[:-1, :-1]), 98.0)
    assert mesh.get_clim() == pytest.approx((-limit, limit)), "white is zero"


def test_maps_for_print_have_each_model_under_its_title(monkeypatch: pytest.MonkeyPatch) -> None:
    study, surfaces = distinct_study()
    models = study.hierarchy[0], study.hierarchy[4]
    figure = drawn(monkeypatch, print_maps.draw_maps, surfaces, study.scenes[0], models, [2], [])
    maps = [axes for axes in figure.axes if axes.get_title()]
    assert [axes.get_title().split(", ")[1] for axes in maps] == ["small equations", "translational engine", "%"]
    percent = 100.0 * by_phase(pair_sizes("translational", 2))
    expected = heights("small", 2, GRID), heights("translational", 2, COARSE), percent
    for axes, values in zip(maps, expected, strict=True):
        [mesh] = axes.collections
        np.testing.assert_allclose(mesh.get_array().reshape(values.shape), values.T, rtol=1e-9)
    for axes, values in zip(maps[:2], expected):
        [cross] = [line for line in axes.lines if line.get_marker() == "x"]
        row, column = np.unravel_index(values[:-1, :-1].argmax(), values[:-1, :-1].shape)
        place = 2.0 * np.pi * np.array([row, column]) / (len(values) - 1)
        assert [float(cross.get_xdata()[0]), float(cross.get_ydata()[0])] == pytest.approx(place.tolist())


def test_what_is_not_real_is_explained_as_not_real(report: Path) -> None:
    page = page_of(report)
    [tip] = re.findall(r'data-tip="([^"]*)">not real</span>', page)
    assert tip.startswith("Not larger than five times the error estimates")


def test_a_largest_value_names_its_grid_and_the_search() -> None:
    study, surfaces = distinct_study()
    searched = [
        Worst("fig3-I", "exact", "amplification", 1, value=8.765, phases=(1.0, 2.0)),
        Worst("fig3-I", "translational", "amplification", 1, value=7.654, phases=(1.1, 2.1)),
    ]
    for each in grid_maxima(study, surfaces.assign(error=1e-3 * (100.0 - surfaces["mu"])), study.scenes[0]):
        assert each.error == pytest.approx(1e-3 * (100.0 - each.mu))
    for row in distributions(study, surfaces, study.scenes[0]):
        mu = surfaces["mu"].sel(model=row.model, body=row.body).values.ravel()
        expected = np.percentile(mu[np.isfinite(mu)], np.linspace(1.0, 99.0, 50), method="hazen")
        assert row.curve == pytest.approx(expected), "rising, from 1 % to 99 %"
    report = report_of(study, surfaces, {"worst_phases": searched}, [], RUN)
    [(about, _)] = map_tasks(report)
    fine, coarse = heights("small", 1, GRID).max(), heights("spatial", 1, COARSE).max()
    for words in (
        f"μ_1, small equations: {fine:.4g} of 8 × 8 phases, 8.765 over all phases by the exact equations",
        f"μ_1, spatial engine: {coarse:.4g} of 4 × 4 phases, 7.654 over all phases by the translational engine",
        f"μ_2, small equations: {heights('small', 2, GRID).max():.4g} of 8 × 8 phases, not searched over all phases",
    ):
        assert words in about["note"]
    data = json.loads(page_data(report))["scenes"][0]["models"]
    assert data["small"]["worst"] == [[1.0, 2.0, 8.765, "exact"], None]
    assert data["resolved"]["worst"] == [[1.1, 2.1, 7.654, "translational"], None], "the next one that was searched"
    assert data["spatial"]["worst"] == [[1.1, 2.1, 7.654, "translational"], None]


def test_outcomes_costs_and_largest_values_are_in_their_columns(tables: Tables) -> None:
    for row, key in zip(tables.headed("model", "s per point"), KEYS, strict=True):
        count = (COARSE if key in ("translational", "spatial") else GRID) ** 2
        assert (row["ok"], row["phase pairs"], row["s per point"]) == (str(count), str(count), "0.001")
        assert row["processor time, s"] == f"{0.001 * count:.1f}"
    shown = tables.headed("quantity", "next maximum")
    assert [list(row.values())[3:] for row in shown] == [
        ["8.765", "1.0e-04", "1.0000", "2.0000", "on a smooth maximum", "8.5", "3 of 4"],
        ["0.123", "2.0e-05", "3.0000", "4.0000", "on an edge of the surface", "0.11", "5 of 6"],
        ["7.321", "3.0e-04", "5.0000", "6.0000", "beside a jump, approached from (+0.25, -0.75)", "7.1", "7 of 8"],
    ]
    assert [row["quantity"] for row in shown] == ["μ1", "displacement, m", "μ2"]
    [row] = tables.headed("measured", "D, relative")
    assert list(row.values())[3:] == ["1, 2", "4 ± 0.25", "exact equations", "5 ± 0.001", "+1", "+25 %", "yes"]


def test_the_page_draws_the_surfaces_under_their_models(report: Path) -> None:
    [scene] = data_of(report)["scenes"]
    for key in KEYS:
        count = COARSE if key in ("translational", "spatial") else GRID
        assert scene["models"][key]["phases"] == count
        for body in (1, 2):
            shown = np.array(scene["models"][key]["mu"][body - 1])
            np.testing.assert_allclose(shown, heights(key, body, count)[:-1, :-1], rtol=1e-6)  # 7 digits
    pairs_shown = {pair["title"]: (pair["first"], pair["second"]) for pair in scene["pairs"]}
    assert pairs_shown == {
        "total": ("small", "spatial"),
        "translational": ("small", "translational"),
        "like for like": ("regularised", "translational"),
    }


def test_the_pdf_has_every_bar_and_number(report: Path) -> None:
    text = text_of(report / "report.pdf")[1]
    for body in (1, 2):
        for key, effect in zip(KEYS[1:], EFFECTS, strict=True):
            before = KEYS[KEYS.index(key) - 1]
            levels = [1.0 + differences_of(each, body, grid_phases(COARSE)) for each in (before, key)]
            error = np.hypot(*(STEPS[each][-1] * level for each, level in zip((before, key), levels))).mean()
            assert f"{effect} {with_error(step(key, body).mean(), error)}" in text, (body, key)
