"""Maps of the surfaces for print: the paper's equations, the engine, their difference; two bodies in a row."""

from collections.abc import Sequence
from io import BytesIO
from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparison.result_types import Array
from comparison.study.models import Model
from comparison.surfaces.completion import Completion
from comparison.surfaces.figures.pairs import HEIGHT_COLORS, SIGN_COLORS, draw_map, limits_of
from comparison.surfaces.steps import known_mu
from comparison.wording import mathtext
from reference.problem import Scene

RESOLUTION = 300  # dots per inch of the maps; letters and lines are vectors
WIDTH, HEIGHT = 7.0, 1.52  # inches
STYLE: dict[Any, Any] = {"font.size": 6.5, "svg.hashsalt": "phase-resonance", "svg.fonttype": "path"}
ENDS = ([0.0, np.pi, 2.0 * np.pi], ["0", "π", "2π"])


def draw_maps(
    surfaces: xr.Dataset,
    scene: Scene,
    models: tuple[Model, Model],
    bodies: Sequence[int],
    completed: Sequence[Completion],
) -> bytes:
    """
    The maps of one scene as SVG, the same bytes for the same numbers.

    models: the first model and the engine model. bodies: one or two bodies, from 1. completed: of the scene. Where the
    engine's surface may be drawn as completed, it is, and dots mark the computed phases. Returns phases run to the
    right (alpha1) and upward (alpha2). A cross marks the highest value.
    """
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(WIDTH, HEIGHT), dpi=RESOLUTION)
        for column, body in enumerate(bodies[:2]):
            done = next((c for c in completed if (c.model, c.body, c.accepted) == (models[1].key, body, True)), None)
            _row(figure, 0.5 * column, surfaces, scene, models, body, done)
        content = BytesIO()
        figure.savefig(content, format="svg", dpi=RESOLUTION, metadata={"Date": None})
    return content.getvalue()


def _row(
    figure: Figure,
    left: float,
    surfaces: xr.Dataset,
    scene: Scene,
    models: tuple[Model, Model],
    body: int,
    done: Completion | None,
) -> None:
    own = [known_mu(surfaces, scene.name, model)[body - 1] for model in models]
    heights = [own[0], own[1] if done is None else done.mu]
    if done is not None and done.difference_accepted:
        first, second = own[0], done.mu
    else:
        first, second = (known_mu(surfaces, scene.name, model, *models)[body - 1] for model in models)
    difference = 100.0 * (second - first) / first
    low, high = limits_of(heights)
    sizes = np.abs(difference[np.isfinite(difference)])
    limit = float(np.percentile(sizes, 98.0)) if sizes.size else 1.0
    limit = limit or 1.0
    titles = [*(rf"$\mu_{{{body}}}$, {mathtext(model.title)}" for model in models), "difference, %"]
    scales = [(low, high, HEIGHT_COLORS), (low, high, HEIGHT_COLORS), (-limit, limit, SIGN_COLORS)]
    for place, (values, title, scale) in enumerate(zip((*heights, difference), titles, scales)):
        axes = figure.add_axes((left + 0.022 + 0.16 * place, 0.25, 0.135, 0.622))
        image = _map(axes, values, scale, peak=place < 2)
        axes.set_title(title, fontsize=6.5, pad=3)
        if place:
            axes.set_yticklabels([])
            bar = figure.add_axes((left + 0.022 + 0.16 * place, 0.095, 0.135, 0.045))
            figure.colorbar(image, cax=bar, orientation="horizontal").ax.tick_params(labelsize=5.5, length=1.5, pad=1)
        if place == 1 and done is not None:
            phase = np.arange(len(own[1])) * 2.0 * np.pi / len(own[1])
            alpha1, alpha2 = np.meshgrid(phase, phase, indexing="ij")
            axes.plot(alpha1, alpha2, ".", color="white", markersize=0.7, markeredgewidth=0.0)


def _map(axes: Axes, values: Array, scale: tuple[float, float, str], peak: bool) -> Any:
    low, high, colors = scale
    phase = np.arange(len(values)) * 2.0 * np.pi / len(values)
    image = draw_map(axes, phase, values, ENDS, cmap=colors, vmin=low, vmax=high, rasterized=True)
    if peak and np.isfinite(values).any():
        row, column = np.unravel_index(np.nanargmax(values), values.shape)
        axes.plot(phase[row], phase[column], "x", color="red", markersize=3.5, markeredgewidth=0.7)
    axes.tick_params(length=1.5, pad=1, labelsize=5.5)
    return image
