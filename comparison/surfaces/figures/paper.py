"""Figures for a manuscript, in the paper's own manner: gray surfaces mu_i over [0, 2 pi]^2, one row per body."""

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D  # type: ignore[import-untyped]

from comparison.study.models import label_of
from comparison.study.study import Study
from comparison.surfaces.figures.pairs import PNG_SETTINGS, draw_in_space, extend_surface_to_two_pi, find_height_limits
from comparison.wording import mathtext
from reference.problem import Scene

PRINT_STYLE: dict[Any, Any] = {
    "font.family": "STIXGeneral",
    "mathtext.fontset": "stix",
    "font.size": 8.0,
    "pdf.fonttype": 42,  # TrueType fonts, as journals require
}  # style of matplotlib for figures in journals
FIGURE_WIDTH = 6.9  # inches, width of two columns of a page
PRINT_RESOLUTION = 300  # dots per inch of the PNG file


def draw_paper_figure(path: Path, study: Study, surfaces: xr.Dataset, scene: Scene) -> None:
    """
    Write a figure of a scene's surfaces in the style of the paper, as a PNG file at `path` and a PDF file beside it.

    It shows for every body the surface of the paper's equations and that of the engine under the paper's assumption
    that no body turns, on one height scale per body.
    """
    pairs = [pair for pair in study.pairs(scene) if pair.second.side != "user"]
    first, last = pairs[0].first, pairs[-1].second
    bodies = len(scene.bodies)
    with mpl.rc_context(PRINT_STYLE):
        figure = Figure(figsize=(FIGURE_WIDTH, 2.7 * bodies))
        for row in range(bodies):
            heights = [extend_surface_to_two_pi(surfaces, scene, model, row + 1) for model in (first, last)]
            limits = find_height_limits([height for _, height in heights])
            for column, ((phase, height), model) in enumerate(zip(heights, (first, last))):
                place = (0.02 + 0.5 * column, 1.0 - (row + 0.98) / bodies, 0.46, 0.88 / bodies)
                axes = figure.add_axes(place, projection="3d")
                letter = chr(ord("a") + 2 * row + column)
                draw_surface(axes, phase, height, limits, rf"$\mu_{{{row + 1}}}$")
                label = mathtext(label_of(model, scene))
                axes.set_title(f"({letter}) $\\mu_{{{row + 1}}}$, {label}", y=1.0, fontsize=9.0)
        # Without a creation date the same figure gives the same file.
        figure.savefig(path.with_suffix(".pdf"), metadata={"CreationDate": None})
        figure.savefig(path, dpi=PRINT_RESOLUTION, pil_kwargs=PNG_SETTINGS)


def draw_surface(axes: Axes, phase: np.ndarray, height: np.ndarray, limits: tuple[float, float], name: str) -> None:
    """
    Draw one gray surface in the manner of the paper.

    phase: rad, from 0 to 2 pi. limits: ends of the vertical axis. name: label of the vertical axis.
    """
    assert isinstance(axes, Axes3D)
    lines = {"color": "white", "edgecolor": "black", "linewidth": 0.4, "shade": False}
    draw_in_space(axes, phase, height, limits, 0.66, 1.02, **lines)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_rotate_label(False)
        axis.set_pane_color((1.0, 1.0, 1.0, 0.0))
        axis._axinfo["grid"].update(color="0.8", linewidth=0.3)
    axes.tick_params(pad=-2)
    axes.set_xlabel(r"$\alpha_1$", labelpad=-4)
    axes.set_ylabel(r"$\alpha_2$", labelpad=-4)
    axes.set_zlabel(name, labelpad=-4, rotation=0.0)
