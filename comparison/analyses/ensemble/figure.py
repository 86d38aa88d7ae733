"""Demand against intensity: a curve for every motion, median and fractiles, and the engine where it was asked."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparison.analyses.ensemble.analysis import FRACTILES, EnsembleResult, Quantity, of_quantity
from comparison.surfaces.figures.pairs import save
from reference.drawing import verbatim
from reference.measures.peak_demands import unit_of
from reference.problem import GRAVITY

TITLES = {
    "displacement": "isolator displacement",
    "residual": "residual displacement",
    "base_shear": "base shear",
    "acceleration": "acceleration of body {}",
    "drift": "drift below body {}",
}
CURVE, MEDIAN, BAND, ENGINE = "0.72", "#1f4e8c", "#1f4e8c", "#b3541e"


def draw_ensemble(path: Path, result: EnsembleResult) -> None:
    """Write the panels to `path`, PNG, and as PDF."""
    shown = shown_quantities(result)
    columns = 3 if len(shown) > 4 else 2
    rows = -(-len(shown) // columns)
    figure = Figure(figsize=(4.4 * columns, 3.5 * rows + 0.6), dpi=110, layout="constrained")
    scene, motions = result.family.scenes[0], len({point.curve for point in result.points})
    title = verbatim(f"{scene.title} ({result.family.name}): {motions} motions")
    if any(stripe.answered < motions for stripe in result.stripes if stripe.quantity in shown):
        title += "; ↑ counts those without a value"
    figure.suptitle(title, fontsize=12)
    panels = np.atleast_1d(figure.subplots(rows, columns)).ravel()
    for axes, quantity in zip(panels, shown):
        _draw(axes, result, quantity)
    for axes in panels[len(shown) :]:
        axes.set_axis_off()
    figure.legend(
        *panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=4, frameon=False, fontsize=9
    )
    save(figure, path)


def shown_quantities(result: EnsembleResult) -> list[Quantity]:
    """Isolator, base shear, platform, uppermost body, and the drift with the largest median."""
    bodies = result.family.bodies
    drifts = [stripe for stripe in result.stripes if stripe.quantity[0] == "drift"]
    largest = max(drifts, key=lambda stripe: _known(stripe.fractiles[1].value), default=None)
    asked: list[Quantity] = [("displacement", 0), ("residual", 0), ("base_shear", 0), ("acceleration", 1)]
    asked += [("acceleration", bodies)] if bodies > 1 else []
    return asked + ([largest.quantity] if largest else [])


def _known(value: float) -> float:
    return value if math.isfinite(value) else -math.inf


def _draw(axes: Axes, result: EnsembleResult, quantity: Quantity) -> None:
    unit, factor = unit_of(quantity[0]), 1.0
    if quantity[0] == "base_shear":
        unit, factor = "of the weight", 1.0 / (result.family.scenes[0].total_mass * GRAVITY)
    for number, curve in enumerate(dict.fromkeys(point.curve for point in result.points)):
        points = sorted((point for point in result.points if point.curve == curve), key=lambda point: point.scale)
        values = [factor * point.estimate(quantity).value for point in points]
        label = "one motion" if number == 0 else None
        axes.plot([point.scale for point in points], values, color=CURVE, lw=0.8, marker=".", ms=3, label=label)
    stripes = of_quantity(result.stripes, quantity)
    scales = [stripe.scale for stripe in stripes] or sorted({point.scale for point in result.points})
    low, middle, high = (_column([stripe.fractiles[n].value for stripe in stripes], factor) for n in range(3))
    band = f"{100.0 * FRACTILES[0]:.0f} % to {100.0 * FRACTILES[2]:.0f} %"
    if stripes:
        axes.fill_between(scales, low, high, color=BAND, alpha=0.18, lw=0.0, label=band)
        axes.plot(scales, middle, color=MEDIAN, lw=2.0, marker="o", ms=4, label="median")
    if result.engine:
        places = [point.scale for point in result.engine]
        found = [point.estimate(quantity) for point in result.engine]
        heights, errors = (_column([getattr(each, part) for each in found], factor) for part in ("value", "error"))
        bars: dict[str, Any] = {"fmt": "x", "color": ENGINE, "ms": 8, "mew": 1.8, "capsize": 3}
        axes.errorbar(places, heights, np.nan_to_num(errors), label="engine with its error", **bars)
    axes.set_xlabel("scale factor of the motion")
    axes.set_ylabel(f"{TITLES[quantity[0]].format(quantity[1])}, {unit}".replace("m/s^2", "m/s$^2$"))
    drawn = np.concatenate([np.asarray(line.get_ydata(), dtype=float) for line in axes.get_lines()])
    highest = float(drawn[np.isfinite(drawn)].max(initial=0.0))
    axes.set_ylim(0.0, 1.08 * highest if highest > 0.0 else 1.0)
    margin = 0.04 * (scales[-1] - scales[0]) if len(scales) > 1 else 0.1
    axes.set_xlim(scales[0] - margin, scales[-1] + margin)
    for stripe in stripes:
        absent = sum(point.scale == stripe.scale for point in result.points) - stripe.answered
        if absent:
            place: dict[str, Any] = {"transform": axes.get_xaxis_transform(), "ha": "center", "va": "top"}
            axes.text(stripe.scale, 0.985, f"↑{absent}", fontsize=7.5, color=ENGINE, **place)
    axes.grid(color="0.92")


def _column(values: Sequence[float], factor: float) -> np.ndarray:
    return factor * np.array(values)
