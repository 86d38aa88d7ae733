"""Demands of every structure: over the scale or as strips of dots, over the height, and floor spectra, with bands."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from comparison.analyses.ensemble.result import Curve, EnsembleResult, Stripe, Structure
from comparison.analyses.ensemble.units import band, fractiles_of, title_of, unit_for_reading
from comparison.study.models import EXACT
from comparison.surfaces.figures.pairs import save
from reference.drawing import verbatim
from reference.problem import GRAVITY

COLORS = ("#1f4e8c", "#b3541e", "#2a7f4f", "#7b3f98", "#8a6d00", "#37808c")
ENGINE = "#222222"
WIDTH = 0.3  # of a strip, in steps from one structure to the next

Quantity = tuple[str, int | None]  # demand, and body from 1 or None for the isolator


def draw_ensemble(path: Path, result: EnsembleResult) -> None:
    """Write the panels to `path`, PNG, and as PDF."""
    shown, several = shown_quantities(result), max(each.bodies for each in result.structures) > 1
    count = len(shown) + (2 if several else 0) + bool(result.spectra)
    columns = 3 if count > 4 else 2
    rows = -(-count // columns)
    figure = Figure(figsize=(4.4 * columns, 3.5 * rows + 0.6), dpi=110, layout="constrained")
    FigureCanvasAgg(figure)
    motions = result.motions
    names = ", ".join(each.title if len(result.structures) == 1 else each.name for each in result.structures)
    title = verbatim(f"{names}: {motions} {'motion' if motions == 1 else 'motions'}")
    if any(stripe.answered < motions for stripe in result.stripes if stripe.model == EXACT.key):
        title += "; ↑ counts those without a value"
    figure.suptitle(title, fontsize=12)
    panels = list(np.atleast_1d(figure.subplots(rows, columns)).ravel())
    for quantity in shown:
        _draw(panels.pop(0), result, quantity)
    for name in ("acceleration", "drift") if several else ():
        _draw_profile(panels.pop(0), result, name)
    if result.spectra:
        _draw_spectra(panels.pop(0), result)
    for axes in panels:
        axes.set_axis_off()
    legend = dict(zip(*reversed(figure.axes[0].get_legend_handles_labels())))
    figure.legend(legend.values(), legend.keys(), loc="outside lower center", ncols=4, frameon=False, fontsize=9)
    save(figure, path)


def shown_quantities(result: EnsembleResult) -> list[Quantity]:
    """Isolator, base shear, and what only the engine has of the supports; bodies are in the profiles."""
    known = {stripe.quantity for stripe in result.stripes}
    supports = [name for name in ("uplift", "support_force_max") if name in known]
    asked: list[Quantity] = [(name, None) for name in ("displacement", "residual", "base_shear", *supports)]
    return asked if max(each.bodies for each in result.structures) > 1 else [*asked, ("acceleration", 1)]


def _draw(axes: Axes, result: EnsembleResult, quantity: Quantity) -> None:
    one = len(result.scales) == 1
    highest = 0.0
    for place, structure in enumerate(result.structures):
        unit, factor = unit_for_reading(quantity[0], structure.weight)
        drawn = _draw_strip if one else _draw_curves
        highest = max(highest, drawn(axes, result, structure, quantity, place, factor))
    axes.set_ylabel(f"{title_of(quantity)}, {unit}".removesuffix(", "))
    axes.set_ylim(0.0, 1.08 * highest if highest > 0.0 else 1.0)
    if one:
        axes.set_xticks(range(len(result.structures)), [verbatim(each.name) for each in result.structures], fontsize=8)
        axes.set_xlim(-0.6, len(result.structures) - 0.4)
    else:
        axes.set_xlabel("scale factor of the motion")
        axes.set_xlim(left=0.0)
    axes.grid(color="0.92")


def _draw_strip(
    axes: Axes, result: EnsembleResult, structure: Structure, quantity: Quantity, place: int, factor: float
) -> float:
    """One dot for every motion at its structure, median and fractiles beside them; the largest value."""
    color, listed = COLORS[place % len(COLORS)], result.stripes_of(structure.name, *quantity)
    motions, engine = result.curves_of(structure.name, *quantity)
    values = _column([curve.values[0] for curve in motions or engine], factor)
    beside = place + WIDTH * ((np.arange(len(values)) + 0.5) / max(len(values), 1) - 0.5)
    axes.plot(beside, values, color=color, ls="", marker=".", ms=5, alpha=0.6, label=f"{structure.name}: one motion")
    at = place + WIDTH
    for stripe, low, middle, high in zip(listed, *map(_column, fractiles_of(listed, factor))):
        axes.plot([at, at], [low, high], color=color, lw=5, alpha=0.3, solid_capstyle="butt", label="16 % to 84 %")
        axes.plot([at], [middle], color=color, marker="_", ms=13, mew=2.2, ls="", label="median")
        _count_missing(axes, stripe, place)
    return max(_largest(values), _draw_engine(axes, engine, factor, place - WIDTH))


def _draw_curves(
    axes: Axes, result: EnsembleResult, structure: Structure, quantity: Quantity, place: int, factor: float
) -> float:
    """One thin curve for every motion over its scale, median and band; the largest value."""
    color, listed, largest = COLORS[place % len(COLORS)], result.stripes_of(structure.name, *quantity), 0.0
    motions, engine = result.curves_of(structure.name, *quantity)
    for curve in motions:
        values = _column(curve.values, factor)
        look: dict[str, Any] = {"color": color, "alpha": 0.35, "lw": 0.7, "marker": ".", "ms": 3}
        axes.plot(curve.scales, values, label=f"{structure.name}: one motion", **look)
        largest = max(largest, _largest(values))
    if listed:
        scales = [stripe.scale for stripe in listed]
        low, middle, high = map(_column, fractiles_of(listed, factor))
        axes.fill_between(scales, low, high, color=color, alpha=0.18, lw=0.0, label="16 % to 84 %")
        axes.plot(scales, middle, color=color, lw=2.0, marker="o", ms=4, label="median")
        for stripe in listed:
            _count_missing(axes, stripe, stripe.scale)
    return max(largest, _draw_engine(axes, engine, factor, None))


def _draw_engine(axes: Axes, engine: Sequence[Curve], factor: float, place: float | None) -> float:
    """The engine's values with their errors, at their scales or at one place; the largest."""
    if not engine:
        return 0.0
    heights = _column([value for curve in engine for value in curve.values], factor)
    errors = _column([error for curve in engine for error in curve.errors], factor)
    places = [scale if place is None else place for curve in engine for scale in curve.scales]
    bars: dict[str, Any] = {"fmt": "x", "color": ENGINE, "ms": 6, "mew": 1.3, "capsize": 3}
    axes.errorbar(places, heights, np.nan_to_num(errors), label="engine with its error", **bars)
    return _largest(heights)


def _count_missing(axes: Axes, stripe: Stripe, place: float) -> None:
    if missing := sum(stripe.reasons.values()):
        where: dict[str, Any] = {"transform": axes.get_xaxis_transform(), "ha": "center", "va": "top"}
        axes.text(place, 0.985, f"↑{missing}", fontsize=7.5, color=ENGINE, **where)


def _draw_profile(axes: Axes, result: EnsembleResult, name: str) -> None:
    """Median and band of a demand over the height: one level for every body."""
    for place, structure in enumerate(result.structures):
        unit, factor = unit_for_reading(name, structure.weight)
        color = COLORS[place % len(COLORS)]
        rows = result.profile(structure.name, name)
        low, middle, high = map(_column, fractiles_of(rows, factor))
        bodies = _column([each.body for each in rows])
        axes.fill_betweenx(bodies, low, high, color=color, alpha=0.18, lw=0.0)
        axes.plot(middle, bodies, color=color, lw=2.0, marker="o", ms=4)
    axes.set_xlabel(f"{name}, {unit}, at scale {max(result.scales):g}")
    axes.set_ylabel("body" if name == "acceleration" else "body above the link")
    axes.yaxis.set_major_locator(MaxNLocator(integer=True))
    axes.set_xlim(left=0.0)
    axes.grid(color="0.92")


def _draw_spectra(axes: Axes, result: EnsembleResult) -> None:
    """Floor spectra of the uppermost body: median and band."""
    for place, structure in enumerate(result.structures):
        for spectrum in result.spectra:
            if (spectrum.structure, spectrum.body) == (structure.name, structure.bodies):
                color = COLORS[place % len(COLORS)]
                low, middle, high = map(_column, band(spectrum.fractiles, 1.0 / GRAVITY))
                axes.fill_between(spectrum.period, low, high, color=color, alpha=0.18, lw=0.0)
                axes.plot(spectrum.period, middle, color=color, lw=2.0)
                axes.set_ylabel(f"floor spectrum of the top, {100.0 * spectrum.damping:g} % damping, g")
    axes.set_xscale("log")
    axes.set_xlabel("period, s")
    axes.set_ylim(bottom=0.0)
    axes.grid(color="0.92")


def _largest(values: np.ndarray) -> float:
    return float(values[np.isfinite(values)].max(initial=0.0))


def _column(values: Sequence[float | None], factor: float = 1.0) -> np.ndarray:
    """Values as an array, NaN where one is unknown."""
    return factor * np.array(values, dtype=float)
