"""Panels: plots described once, drawn by plot.js on the page and by `draw_panels` as a picture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import cycle, zip_longest
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from comparison.report.plots import Panel, json_numbers
from comparison.report.results import Results
from comparison.surfaces.distribution import CURVE
from comparison.wording import mathtext
from reference.support.drawing import escape_for_matplotlib

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLORS = ("#1f4e8c", "#b3541e", "#2a7f4f", "#7b3f98", "#8a6d00", "#37808c", "#b3124b", "#5b9bd5")
DASHES = ("", "7 3", "2 2", "10 3 2 3", "14 4", "4 4")  # curves that lie on each other: the later ones leave gaps
GRAYS = {"ink": "#222222", "gray": "0.5"}
LEGEND_ROWS, LEGEND_ROW = 4, 11.5  # rows of a legend in one column; height of a row, points
MARKERS = "os^Dv<>PX*"  # told apart without colors, too


def make_panel(title: str, label: str, x: dict[str, Any], y: dict[str, Any], series: Any, **more: Any) -> Panel:
    """A panel with its plot, as plot.js has it; label: the plot in words."""
    return {"title": title, "plot": {"label": label, "x": x, "y": y, "series": series, **more}}


def distribution_panels(results: Results, scene: str, quantity: str, unit: str, curves: Any) -> list[Panel]:
    """The share of all phases at which a quantity stays below a value, by (model, values); none without curves."""
    models = {model.key: (model.title, number) for number, model in enumerate(results.models)}
    series = [
        {"name": models[key][0], "x": json_numbers(values), "y": CURVE.tolist(), "color": models[key][1], "dash": dash}
        for (key, values), dash in zip(curves, cycle(DASHES))
    ]
    title = f"{scene}, {quantity}"
    label = f"{title}: share of the phases at which it stays below a value, by model"
    axes = {"title": f"{quantity}, {unit}".removesuffix(", ")}, {"title": "share of the phases"}
    return [make_panel(title, label, *axes, series)] if series else []


def draw_panels(path: Path, title: str, panels: Sequence[Panel], columns: int = 3, height: float = 4.0) -> None:
    """Write the panels below a title to `path`, PNG, and as PDF."""
    from matplotlib.figure import Figure  # matplotlib: only what draws needs it

    from comparison.surfaces.figures.pairs import save_figure

    columns = min(columns, max(len(panels), 1))
    rows = -(-len(panels) // columns) or 1
    figure = Figure(figsize=(5.0 * columns, height * rows + 0.6), dpi=110, layout="constrained")
    figure.suptitle(escape_for_matplotlib(title), fontsize=12)
    for axes, each in zip_longest(figure.subplots(rows, columns, squeeze=False).flat, panels):
        if each is None:
            axes.set_axis_off()
        else:
            _draw_series(axes, each)
    save_figure(figure, path)


def _draw_series(axes: Axes, each: Panel) -> None:
    plot = each["plot"]
    axes.grid(color="0.92")
    for line in plot["series"]:
        number = line.get("color", 0)
        look: dict[str, Any] = {"color": GRAYS.get(number) or COLORS[number % len(COLORS)]}
        x, y, low, high = (np.array(line.get(key, ()), dtype=float) for key in ("x", "y", "low", "high"))
        if line.get("band"):
            axes.fill_between(x, low, high, alpha=0.18, lw=0.0, **look)
        elif low.size:
            axes.vlines(x, low, high, lw=3.0, alpha=0.4, **look)
        marker = MARKERS[0 if number in GRAYS else number % len(MARKERS)] if line.get("marks") else ""
        style = "none" if line.get("line") is False else "--" if "dash" in line else "-"
        label = mathtext(line["name"]) if line.get("legend", True) else "_"
        axes.plot(x, y, ls=style, marker=marker, ms=4.5, lw=line.get("width", 1.4), label=label, **look)
    for name in "xy":
        axis = plot[name]
        scale = "log" if axis.get("log") and has_positive(plot["series"], name) else "linear"
        axes.set(**{f"{name}label": mathtext(axis["title"]), f"{name}scale": scale})
        if "ticks" in axis:
            places, names = zip(*axis["ticks"])
            axes.set(**{f"{name}ticks": places, f"{name}ticklabels": [mathtext(text) for text in names]})
        if "range" in axis:
            axes.set(**{f"{name}lim": axis["range"]})
    bottom, top = axes.get_ylim()
    for band in plot.get("bands", ()):
        axes.axhspan(*np.clip([band["from"], band["to"]], bottom, top), color="0.93", lw=0.0, zorder=0)
    axes.set_ylim(bottom, top)
    named = len(axes.get_legend_handles_labels()[1])
    columns = 1 if named <= LEGEND_ROWS else 2
    axes.set_title(mathtext(each["title"]), fontsize=10, pad=6.0 + LEGEND_ROW * -(-named // columns))
    axes.legend(fontsize=7.5, frameon=False, ncols=columns, loc="lower left", bbox_to_anchor=(0.0, 1.0), borderpad=0.0)


def has_positive(series: Sequence[Mapping[str, Any]], axis: str) -> bool:
    """Return whether some point of the series is on a logarithmic axis: without any Matplotlib raises."""
    points = (pair for line in series for pair in zip(line[axis], line["y"]))
    return any(place is not None and place > 0.0 and value is not None for place, value in points)
