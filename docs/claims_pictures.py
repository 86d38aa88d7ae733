"""The surfaces of a reading in the manner of the paper's Figures 3 and 4, and the spike of the literal (4.6)."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import matplotlib as mpl
import numpy as np
from claims_literal import PHASES, STEPS, Spike
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from comparison.analyses.claims.evidence import Evidence
from comparison.surfaces.figures.paper import PRINT, draw_surface
from comparison.wording import mathtext

PANELS = (("fig3-I", "3", "ab"), ("fig3-II", "3", "cd"), ("fig4-dry", "4", "ab"), ("fig4-viscous", "4", "cd"))
RESOLUTION = 110  # dots per inch
COLORS = "#1f4e8c", "#b3541e", "#2e7d32"


def draw_reading(path: Path, title: str, evidence: Mapping[str, Evidence]) -> None:
    """
    Write the eight surfaces of Figures 3 and 4 under one reading, PNG.

    Parameters
    ----------
    path : Path
    title : str
        Of the reading.
    evidence : mapping of str to Evidence
        By case; a case with points without a value is left blank.
    """
    with mpl.rc_context(PRINT):
        figure = Figure(figsize=(11.0, 6.2))
        FigureCanvasAgg(figure)
        figure.suptitle(mathtext(title), fontsize=10.0, y=0.985)
        for column, (case, number, letters) in enumerate(PANELS):
            for row in range(2):
                name = rf"$\mu_{row + 1}$"
                place = (0.018 + 0.247 * column, 0.01 + 0.475 * (1 - row), 0.225, 0.45)
                heading = f"Fig. {number}{letters[row]}: {name}"
                if not evidence[case].complete:
                    figure.text(place[0] + 0.06, place[1] + 0.2, f"{heading}: no answer")
                    continue
                mu = evidence[case].mu[..., row]
                axes = figure.add_axes(place, projection="3d")
                phase = 2.0 * np.pi * np.arange(len(mu) + 1) / len(mu)
                limits = float(mu.min()), float(mu.max())
                draw_surface(axes, phase, np.pad(mu, ((0, 1), (0, 1)), mode="wrap"), limits, name)
                axes.set_title(heading, y=1.0, fontsize=9.0)
        figure.savefig(path, dpi=RESOLUTION)


def draw_spike(path: Path, spikes: Mapping[float, Spike]) -> None:
    """
    Write mu_1 of the literal integration over its step, and how often slip begins, PNG.

    Parameters
    ----------
    path : Path
    spikes : mapping of float to Spike
        By amplitude of the loading, m/s^2.
    """
    figure = Figure(figsize=(4.2 * len(spikes), 6.4), dpi=RESOLUTION, layout="constrained")
    FigureCanvasAgg(figure)
    rows = figure.subplots(2, len(spikes), squeeze=False, sharex=True, sharey="row")
    for (amplitude, spike), values, numbers in zip(spikes.items(), *rows):
        for k, (phase, color) in enumerate(zip(PHASES, COLORS)):
            place = f"({phase[0]:g}, {phase[1]:g})"
            values.semilogx(STEPS, [row[k] for row in spike.counted], "o-", color=color, ms=4, label=place)
            values.semilogx(STEPS, [row[k] for row in spike.left_out], "o-", color=color, ms=4, mfc="white")
            values.axhline(spike.limit[k], color=color, ls=":", lw=1.0)
            numbers.loglog(STEPS, [row[k] for row in spike.starts], "o-", color=color, ms=4)
        values.set_title(f"{amplitude:g} m/s²", fontsize=10)
        values.set_ylabel(r"$\mu_1$")
        numbers.set_xlabel("step, s")
        numbers.set_ylabel("beginnings of slip")
        for axes in (values, numbers):
            axes.xaxis.set_minor_formatter(NullFormatter())
            axes.set_xlim(1e-4, 1e-2)
            axes.grid(alpha=0.25)
    rows[0][0].set_ylim(0.0)
    rows[1][0].set_ylim(1.0)
    rows[0][0].legend(title=r"$(\alpha_1, \alpha_2)$, rad", fontsize=8, title_fontsize=8, frameon=False)
    figure.savefig(path)
