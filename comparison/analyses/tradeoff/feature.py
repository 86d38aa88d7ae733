"""Speed for accuracy: in the report."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import groupby
from pathlib import Path
from typing import Any

from comparison.analyses.tradeoff import growth, trade
from comparison.analyses.tradeoff.growth import MeasuredGrowth
from comparison.analyses.tradeoff.trade import Answered, Entry, Trade
from comparison.report.plots import MAX_CURVES, Panel
from comparison.report.section import Feature, Report, Section
from comparison.surfaces.figures.file_names import figure_file
from comparison.wording import scientific

TARGETS = 1e-2, 1e-3, 1e-4, 1e-6  # relative errors for which the trade is put into words


def tradeoff_panels(trade: Trade) -> list[Panel]:
    """One panel for each question, of the platform and of the last body."""
    bodies = [0] if trade.bodies == 1 else [0, trade.bodies - 1]
    return [_tradeoff_panel(trade, question, body) for question in trade.questions for body in bodies]


def tradeoff_answers(trade: Trade) -> list[dict[str, str]]:
    """For each question, which method meets which error in the least time: one that estimates its error, if any."""
    answers = []
    for question in trade.questions:
        parts = []
        for target in TARGETS:
            able = [entry for entry in trade.of(question.key) if _meets(entry, target)]
            estimated = [entry for entry in able if entry.controlled]
            if not able:
                parts.append(f"for {target:.0e} none")
                continue
            best = min(estimated or able, key=lambda entry: entry.seconds)
            setting = f"{best.parameter} {best.value:.3g} {best.unit}".strip()
            time = f"{1e3 * best.seconds:.3g} ms{'' if estimated else ', no error estimate'}"
            parts.append(f"for {target:.0e} ask {best.method}, {setting} ({time})")
        answers.append({"title": question.title, "text": "; ".join(parts) + "."})
    return answers


def growth_panels(measured: MeasuredGrowth | None) -> list[Panel]:
    """One log-log panel for each quantity that grows: seconds over it, the slopes in the legend."""
    panels: list[Panel] = []
    if measured is None:
        return panels
    titles = list(dict.fromkeys(each.model for each in measured.series))
    for quantity, group in groupby(measured.series, key=lambda each: each.quantity):
        curves = list(group)
        series: list[dict[str, Any]] = []
        for each in curves:
            slope = "" if each.slope is None else f": slope {each.slope:.2f} ± {each.uncertainty:.2f}"
            points = {"x": list(each.values), "y": list(each.seconds), "marks": True}
            series.append({"name": f"{each.model}{slope}", **points, "color": titles.index(each.model)})
        wall = quantity == "workers"
        time = "wall time, s" if wall else "processor time, s"
        longest = max((value for each in curves for value in each.seconds if value is not None), default=1.0)
        plot = {
            "label": f"{time} over {quantity}; " + "; ".join(str(line["name"]) for line in series),
            "x": {"title": f"{quantity}, {curves[0].unit}".rstrip(", "), "log": True},
            "y": {"title": time, "range": [0.0, 1.1 * longest]} if wall else {"title": time, "log": True},
            "series": series,
        }
        panels.append({"title": quantity, "plot": plot})
    return panels


def _tradeoff_panel(trade: Trade, question: Answered, body: int) -> Panel:
    curves = {
        method: known
        for method, entries in trade.methods(question.key).items()
        if (known := [e for e in entries if e.most[body] is not None and e.answered == e.points])
    }
    order = sorted(curves, key=lambda method: (curves[method][0].model_error, -_fronts(curves[method], body)))
    series = [_curve(method, curves[method], body, number) for number, method in enumerate(order[:MAX_CURVES])]
    title = f"{question.title}, mu_{body + 1}"
    plot = {
        "label": f"{trade.scene}, {title}: relative error over processor time; " + ", ".join(order[:MAX_CURVES]),
        "x": {"title": "processor time per point, s", "log": True},
        "y": {"title": "relative error, 95 %", "log": True},
        "series": series,
        "bands": [{"from": 1e-30, "to": question.error}] if question.error > 0.0 else [],
        "height": 260,
    }
    return {"title": title, "plot": plot}


def _fronts(entries: Sequence[Entry], body: int) -> int:
    return sum(entry.pareto_front[body] for entry in entries if entry.pareto_front)


def _curve(method: str, entries: Sequence[Entry], body: int, number: int) -> dict[str, Any]:
    titles = [
        f"{method}, {entry.parameter} {entry.value:.3g} {entry.unit}: {scientific(entry.most[body] or 0.0)} in "
        f"{1e3 * entry.seconds:.3g} ms"
        for entry in entries
    ]
    line: dict[str, Any] = {
        "name": method,
        "x": [entry.seconds for entry in entries],
        "y": [max(entry.most[body] or 0.0, 1e-16) for entry in entries],
        "marks": True,
        "titles": titles,
        "color": number,
    }
    return {**line, "dash": "5 3"} if entries[0].model_error else line


def _meets(entry: Entry, target: float) -> bool:
    errors = [size for size in entry.most if size is not None]
    complete = len(errors) == len(entry.most) and entry.answered == entry.points
    return complete and not entry.model_error and max(errors) <= target


def _draw(figures: Path, report: Report) -> None:
    from comparison.analyses.tradeoff.figure import draw_growth, draw_tradeoff  # matplotlib: only to draw

    for each in report.results.of("tradeoff") or ():
        draw_tradeoff(figures / figure_file(each.scene, "tradeoff"), each)
    if report.results.of("growth"):
        draw_growth(figures / growth.PICTURE, report.results.of("growth").series)


def _context(report: Report, figures: Path) -> Mapping[str, Any]:
    return {
        "tradeoff_panels": tradeoff_panels,
        "tradeoff_answers": tradeoff_answers,
        "growth_panels": growth_panels(report.results.of("growth")),
        "digests": {scene.digest for scene in report.results.scenes},
    }


GROWTH = Feature(
    "growth",
    MeasuredGrowth,
    "how the cost grows with bodies, duration, phase pairs and workers; null unless python -m comparison.tradeoff "
    "--growth left it beside the report",
    load=growth.STORED.load,
    selected_as="tradeoff",
)
FEATURE = Feature(
    "tradeoff",
    list[Trade],
    "error against compute time for every model and parameter; null unless python -m comparison.tradeoff left it "
    "beside the report",
    load=trade.load,
    section=Section(
        "Speed for accuracy",
        "python -m comparison.tradeoff SCENE makes it, beside the report; the next run of the study shows it",
        _context,
        draw=_draw,
        verifies=True,
        shows=("tradeoff", "growth"),
    ),
)
