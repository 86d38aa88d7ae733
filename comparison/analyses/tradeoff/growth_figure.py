"""How the cost grows: a panel with logarithmic axes for every quantity, a line for every model."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from comparison.analyses.tradeoff.growth import Series
from comparison.surfaces.figures.pairs import save

COLORS = ("#1f4e8c", "#b3541e", "#6a1b9a", "#2e7d32")
MARKERS = "osD^"


def draw_growth(path: Path, series: Sequence[Series]) -> None:
    """Write the panels to `path`, PNG, and as PDF."""
    quantities = list(dict.fromkeys(each.quantity for each in series))
    figure = Figure(figsize=(4.4 * len(quantities), 3.8), dpi=110, layout="constrained")
    for axes, quantity in zip(np.atleast_1d(figure.subplots(1, len(quantities))), quantities):
        shown = [each for each in series if each.quantity == quantity]
        for each, color, marker in zip(shown, COLORS, MARKERS):
            exponent = "" if each.slope is None else f", slope {each.slope:.2f}"
            seconds = [math.nan if value is None else value for value in each.seconds]
            axes.loglog(each.values, seconds, color=color, marker=marker, ms=4.5, label=f"{each.model}{exponent}")
        axes.set_xlabel(f"{quantity}, {shown[0].unit}".rstrip(", "))
        axes.set_ylabel("wall time, s" if quantity == "workers" else "processor time, s")
        axes.grid(alpha=0.25)
        axes.legend(fontsize=7.5, frameon=False)
    save(figure, path)
