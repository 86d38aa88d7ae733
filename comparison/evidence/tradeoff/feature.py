"""Report section of error against compute time."""

from collections.abc import Mapping, Sequence
from itertools import groupby
from typing import Any

from comparison.evidence.tradeoff import growth, trade
from comparison.evidence.tradeoff.growth import CostSeries
from comparison.evidence.tradeoff.trade import MeasuredSetting, SceneTrade, SolvedQuestion
from comparison.report.feature import Feature, ResultField, make_stored_field
from comparison.report.panels import MAX_CURVES, Panel, make_panel
from comparison.report.section import Report, Section
from comparison.wording import scientific

TARGET_ERRORS = 1e-2, 1e-3, 1e-4, 1e-6  # relative errors for which the fastest method is stated in words


def make_tradeoff_panels(trade: SceneTrade) -> list[Panel]:
    """Return plots of the platform's and top body's errors over processor time, for each set of equations solved."""
    bodies = sorted({0, trade.bodies - 1})
    return [_tradeoff_panel(trade, question, body) for question in trade.questions for body in bodies]


def word_trades(trades: Sequence[SceneTrade]) -> str:
    """Return a clause that says how many settings (methods with a parameter value) and scenes were measured."""
    settings = sum(len(trade.entries) for trade in trades)
    return f"{settings} settings measured in {len(trades)} scene{'' if len(trades) == 1 else 's'}; speed has no verdict"


def word_fastest_methods(trade: SceneTrade) -> list[dict[str, str]]:
    """
    Return, for each question (equations to solve), its title and a text on the fastest method for each target error.

    A method that estimates its error is preferred to a faster one that does not.
    """
    answers = []
    for question in trade.questions:
        parts = []
        for target in TARGET_ERRORS:
            listed = [entry for entry in trade.entries_of(question.key) if entry.complete and not entry.model_error]
            able = [entry for entry in listed if all(size is not None and size <= target for size in entry.most)]
            estimated = [entry for entry in able if entry.controlled]
            if question.error is not None and target < question.error:
                why = f"the reference solution has an error of {question.error:.0e}"
                parts.append(f"for {target:.0e} not compared, {why}")
                continue
            if not able:
                parts.append(f"for {target:.0e} none")
                continue
            best = min(estimated or able, key=lambda entry: entry.seconds)
            time = f"{1e3 * best.seconds:.3g} ms{'' if estimated else ', no error estimate'}"
            parts.append(f"for {target:.0e} ask {best.method}, {best.setting} ({time})")
        answers.append({"title": question.title, "text": "; ".join(parts) + "."})
    return answers


def make_growth_panels(listed: Sequence[CostSeries]) -> list[Panel]:
    """Return a plot of compute time, s, against each growing quantity, with fitted slopes in the legend."""
    panels: list[Panel] = []
    titles = list(dict.fromkeys(each.model for each in listed))
    for quantity, group in groupby(listed, key=lambda each: each.quantity):
        curves = list(group)
        series: list[dict[str, Any]] = []
        for each in curves:
            slope = "" if each.slope is None else f": slope {each.slope:.2f} ± {each.uncertainty:.2f}"
            points = {"x": list(each.values), "y": list(each.seconds), "marks": True}
            series.append({"name": f"{each.model}{slope}", **points, "color": titles.index(each.model)})
        wall = quantity == "workers"
        time = "wall time, s" if wall else "processor time, s"
        longest = max((value for each in curves for value in each.seconds if value is not None), default=1.0)
        label = f"{time} over {quantity}; " + "; ".join(str(line["name"]) for line in series)
        x = {"title": f"{quantity}, {curves[0].unit}".rstrip(", "), "log": True}
        y = {"title": time, "range": [0.0, 1.1 * longest]} if wall else {"title": time, "log": True}
        panels.append(make_panel(quantity, label, x, y, series))
    return panels


def _tradeoff_panel(trade: SceneTrade, question: SolvedQuestion, body: int) -> Panel:
    """Return the plot of relative error against processor time for one body, one curve for each method."""
    curves = {
        method: known
        for method, entries in trade.methods(question.key).items()
        if (known := [entry for entry in entries if entry.most[body] is not None and entry.complete])
    }

    def rank(method: str) -> tuple[bool, int]:
        """Return the sort key of a method: first those of the same model, then those often on the Pareto front."""
        return curves[method][0].model_error, -sum(any(entry.pareto_front[body:][:1]) for entry in curves[method])

    shown = sorted(curves, key=rank)[:MAX_CURVES]
    title = f"{question.title}, mu_{body + 1}"
    return make_panel(
        title,
        f"{trade.scene}, {title}: relative error over processor time; " + ", ".join(shown),
        {"title": "processor time per point, s", "log": True},
        {"title": "relative error, 95 %", "log": True},
        [_line_of_method(method, curves[method], body, number) for number, method in enumerate(shown)],
        bands=[{"from": 1e-30, "to": question.error}] if question.error else [],
        height=260,
    )


def _line_of_method(method: str, entries: Sequence[MeasuredSetting], body: int, number: int) -> dict[str, Any]:
    """Return the curve of a method: relative error against processor time, s; dashed if it solves another model."""
    times = [f"{scientific(entry.most[body] or 0.0)} in {1e3 * entry.seconds:.3g} ms" for entry in entries]
    x, y = [entry.seconds for entry in entries], [max(entry.most[body] or 0.0, 1e-16) for entry in entries]
    titles = [f"{method}, {entry.setting}: {time}" for entry, time in zip(entries, times)]
    line: dict[str, Any] = {"name": method, "x": x, "y": y, "marks": True, "titles": titles, "color": number}
    return {**line, "dash": "5 3"} if entries[0].model_error else line


TRADES = ResultField(  # results field: error against compute time, read from the file that the command `tradeoff` wrote
    name="tradeoff",
    kind=list[SceneTrade],
    meaning=trade.STORED.word_field("error against compute time for every model and parameter"),
    load=trade.load_trades,
)
GROWTH = make_stored_field(  # results field: growth of the compute time, read from the file of `tradeoff --growth`
    growth.STORED, name="growth", meaning="how the cost grows with bodies, duration, phase pairs and workers"
)


def _section_context(report: Report) -> Mapping[str, Any]:
    """Return the variables for the template of the report section on speed and accuracy."""
    measured = GROWTH.get(report.results)
    panels, digests = make_growth_panels(measured.series if measured else ()), {s.digest for s in report.results.scenes}
    functions = {"make_tradeoff_panels": make_tradeoff_panels, "word_fastest_methods": word_fastest_methods}
    return {**functions, "growth_panels": panels, "digests": digests}


FEATURE = Feature(  # error against compute time, and growth of this time: results fields and report section
    "tradeoff",
    fields=(TRADES, GROWTH),
    section=Section(
        "Speed for accuracy",
        absent=trade.STORED.word_how_to_make(" SCENE"),
        context=_section_context,
        verifies=True,
        verdict=lambda results: word_trades(TRADES.get(results) or ()),
    ),
)
