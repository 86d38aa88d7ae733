"""Work-precision diagrams, one panel per question and body, and how the cost grows."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from comparison.analyses.tradeoff.growth import Series
from comparison.analyses.tradeoff.trade import Answered, Entry, Trade
from comparison.surfaces.figures.pairs import save
from comparison.wording import mathtext
from reference.drawing import verbatim

LOWEST, HIGHEST = 1e-12, 10.0
# one hue for each family, a marker for each method in it: told apart without colors, too
FAMILIES = (
    ("reference", "#1f4e8c", "#5b9bd5"),
    ("v_reg", "#7f7f7f", "#b0b0b0"),
    ("SciPy", "#2e7d32", "#8bc34a"),
    ("Exudyn", "#b3541e", "#f0a35e"),
    ("translational", "#6a1b9a", "#ce93d8"),
    ("spatial", "#6a1b9a", "#ce93d8"),
    ("user", "#b3124b", "#ec7aa2"),
)
MARKERS = "osD^v<>PX*"
GROWTH_COLORS = "#1f4e8c", "#b3541e", "#6a1b9a", "#2e7d32"  # of the models
MAX_TICKS = 6  # labels of the axis of times that do not touch


def draw_tradeoff(path: Path, trade: Trade) -> None:
    """Write the diagrams to `path`, PNG, and as PDF: questions across, the first and the last body downwards."""
    bodies = [0] if trade.bodies == 1 else [0, trade.bodies - 1]
    columns = len(trade.questions)
    figure = Figure(figsize=(1.0 + 5.0 * columns, 4.1 * len(bodies) + 3.6), dpi=100, layout="constrained")
    widths = [1.5 if question.key == "regularised" else 1.0 for question in trade.questions]
    panels = figure.subplots(len(bodies), columns, squeeze=False, sharey=True, width_ratios=widths)
    for column, question in enumerate(trade.questions):
        for row, body in enumerate(bodies):
            axes = panels[row, column]
            _panel(axes, trade, question, body)
            if row == 0:
                axes.set_title(mathtext(question.title), fontsize=11)
            if row == len(bodies) - 1:
                axes.set_xlabel("processor time per point, s")
                axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), fontsize=7.5, frameon=False)
            if column == 0:
                axes.set_ylabel(rf"relative error of $\mu_{{{body + 1}}}$")
    figure.suptitle(
        verbatim(f"{trade.title} ({trade.scene}): speed for accuracy")
        + "\nline: error that 95 % of the points meet; dotted: median; ring: on the Pareto front; dashed: model error"
        + "\nshaded: below the error estimate of the reference solution",
        fontsize=11,
    )
    save(figure, path)


def draw_growth(path: Path, series: Sequence[Series]) -> None:
    """Write how the cost grows to `path`, PNG, and as PDF: a panel for every quantity, a line for every model."""
    quantities = list(dict.fromkeys(each.quantity for each in series))
    figure = Figure(figsize=(4.4 * len(quantities), 3.8), dpi=110, layout="constrained")
    for axes, quantity in zip(np.atleast_1d(figure.subplots(1, len(quantities))), quantities):
        shown = [each for each in series if each.quantity == quantity]
        for each, color, marker in zip(shown, GROWTH_COLORS, MARKERS):
            exponent = "" if each.slope is None else f", slope {each.slope:.2f}"
            seconds = [math.nan if value is None else value for value in each.seconds]
            axes.loglog(each.values, seconds, color=color, marker=marker, ms=4.5, label=f"{each.model}{exponent}")
        axes.set_xlabel(f"{quantity}, {shown[0].unit}".rstrip(", "))
        axes.set_ylabel("wall time, s" if quantity == "workers" else "processor time, s")
        axes.grid(alpha=0.25)
        axes.legend(fontsize=7.5, frameon=False)
    save(figure, path)


def _panel(axes: Axes, trade: Trade, question: Answered, body: int) -> None:
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylim(LOWEST, HIGHEST)
    axes.grid(alpha=0.25)
    axes.axhspan(LOWEST, max(question.error, LOWEST), color="0.9", zorder=0)
    seen: dict[str, int] = {}
    for method, entries in trade.methods(question.key).items():
        family, dark, light = next((one for one in FAMILIES if method.startswith(one[0])), FAMILIES[0])
        number = seen[family] = seen.get(family, -1) + 1
        _curve(axes, method, entries, body, dark if number % 2 == 0 else light, MARKERS[number % len(MARKERS)])
    front = sorted(
        (entry.seconds, _height(entry.most[body])) for entry in trade.of(question.key) if entry.pareto_front[body]
    )
    if front:
        axes.plot(*np.transpose(front), "o", ms=12, mfc="none", mec="k", mew=1.1, label="on the Pareto front")
    ticks = round_ticks(*axes.get_xlim())
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.xaxis.set_minor_locator(NullLocator())


def round_ticks(low: float, high: float) -> list[float]:
    """Three to MAX_TICKS round numbers between the two, if they are not closer than such numbers are."""
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    ticks: list[float] = []
    for parts in ((10,), (10, 20, 50), (10, 15, 20, 30, 50, 70), range(10, 100)):
        ticks = [tick for k in decades for part in parts if low <= (tick := float(f"{part}e{k - 1}")) <= high]
        if len(ticks) >= 3:
            break
    return ticks[:: max(1, math.ceil(len(ticks) / MAX_TICKS))]


def _curve(axes: Axes, method: str, entries: list[Entry], body: int, color: str, marker: str) -> None:
    known = [entry for entry in entries if entry.most[body] is not None and entry.answered == entry.points]
    if not known:
        axes.plot([], [], color=color, marker=marker, label=f"{method}: not every point has a value")
        return
    seconds = [entry.seconds for entry in known]
    style = "--" if known[0].model_error else "-"
    values = f"{known[0].parameter} {known[0].value:.3g} … {known[-1].value:.3g} {known[0].unit}".strip()
    most, median = ([_height(getattr(entry, part)[body]) for entry in known] for part in ("most", "median"))
    text = method if known[0].model_error else f"{method}: {values}"
    axes.plot(seconds, most, style, color=color, marker=marker, ms=4.5, lw=1.3, label=mathtext(text))
    axes.plot(seconds, median, ":", color=color, lw=1.0)


def _height(error: float | None) -> float:
    return float(np.clip(np.inf if error is None else error, 1.5 * LOWEST, 0.7 * HIGHEST))
