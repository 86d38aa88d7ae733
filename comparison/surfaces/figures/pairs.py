"""Figures in the paper's manner: amplification mu_i over [0, 2 pi]^2 from two models, and their signed difference."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D  # type: ignore[import-untyped]

from comparison.result_types import Array
from comparison.study.models import Model, Pair, label_of
from comparison.surfaces.model_difference import ModelDifference, compute_difference
from comparison.surfaces.surfaces import find_common_stride, select_values
from comparison.wording import mathtext
from reference.problem import Scene
from reference.support.drawing import escape_for_matplotlib

HEIGHT_COLORS = "cividis"  # color map that reads alike with and without color vision deficiency, and in print
SIGN_COLORS = "RdBu_r"  # color map of differences: blue below zero, red above
PHASE_RANGE = (0.0, 2.0 * np.pi)  # rad, range of the axes of both phases
# Ticks of the axes of phases, rad, and their labels
QUARTER_TICKS = ([0.0, np.pi / 2.0, np.pi, 1.5 * np.pi, 2.0 * np.pi], ["0", "π/2", "π", "3π/2", "2π"])
# Settings of PNG files: for dense surfaces level 3 makes smaller files than the usual level 6, in 0.6 of the time.
PNG_SETTINGS = {"compress_level": 3}


def draw_pair(path: Path, surfaces: xr.Dataset, scene: Scene, body: int, pair: Pair) -> None:
    """Write a PNG file with a body's surfaces by two models, on one scale of heights, and a map of their difference."""
    both = [extend_surface_to_two_pi(surfaces, scene, model, body) for model in (pair.first, pair.second)]
    figure = Figure(figsize=(13.0, 4.6), dpi=110)
    figure.suptitle(
        escape_for_matplotlib(f"{scene.title} ({scene.name}), body {body}: {pair.title} difference"),
        fontsize=12,
        y=0.98,
    )
    low, high = find_height_limits([height for _, height in both])
    for left, surface, model in zip((0.0, 0.315), both, (pair.first, pair.second)):
        axes = figure.add_axes((left, 0.0, 0.31, 0.86), projection="3d")
        assert isinstance(axes, Axes3D)
        _draw_surface(axes, *surface, low, high)
        axes.set_title(f"$\\mu_{{{body}}}$, {mathtext(label_of(model, scene))}", fontsize=11, pad=0)
    _draw_difference_map(
        figure, figure.add_axes((0.70, 0.14, 0.22, 0.65)), compute_difference(surfaces, scene.name, pair, body)
    )
    figure.savefig(path, pil_kwargs=PNG_SETTINGS)


def close_period(phase: Array, mu: Array) -> tuple[Array, Array]:
    """Return the phases up to 2 pi and the surface on them, with its first row and column repeated at the end."""
    return np.append(phase, 2.0 * np.pi), np.pad(mu, ((0, 1), (0, 1)), mode="wrap")


def find_height_limits(heights: Sequence[Array]) -> tuple[float, float]:
    """Return the lowest and the highest of all values, with some room around a flat surface."""
    finite = np.concatenate([height[np.isfinite(height)] for height in heights])
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    return (low, high) if low < high else (0.9 * low - 0.1, 1.1 * high + 0.1)


def draw_map(axes: Axes, phase: Array, values: Array, **style: Any) -> QuadMesh:
    """Draw values over the phases as colors, alpha1 to the right and alpha2 upward; gray where there is none."""
    phase, height = close_period(phase, values)
    axes.set_facecolor("0.75")
    image = axes.pcolormesh(phase, phase, height.T, shading="nearest", **style)
    axes.set(xlim=PHASE_RANGE, ylim=PHASE_RANGE, aspect="equal")
    axes.set_xticks(*QUARTER_TICKS)
    axes.set_yticks(*QUARTER_TICKS)
    return image


def extend_surface_to_two_pi(surfaces: xr.Dataset, scene: Scene, model: Model, body: int) -> tuple[Array, Array]:
    """Return the phases of a model up to 2 pi, and the amplification mu on them."""
    phase = surfaces["alpha1"].values[:: find_common_stride(surfaces, scene.name, model)]
    return close_period(phase, select_values(surfaces, "mu", scene.name, model)[body - 1])


def draw_in_space(
    axes: Axes3D, phase: Array, height: Array, limits: tuple[float, float], aspect: float, zoom: float, **style: Any
) -> None:
    """
    Draw a surface over the phases in perspective.

    limits: ends of the axis of heights. aspect: ratio of the height of the box to either side. zoom: size in the axes.
    """
    alpha1, alpha2 = np.meshgrid(phase, phase, indexing="ij")
    axes.plot_surface(alpha1, alpha2, height, rcount=200, ccount=200, antialiased=True, **style)
    axes.set_zlim(*limits)
    axes.set_box_aspect((1.0, 1.0, aspect), zoom=zoom)
    axes.view_init(elev=28.0, azim=-125.0)
    axes.set_xticks(*QUARTER_TICKS)
    axes.set_yticks(*QUARTER_TICKS)


def _draw_surface(axes: Axes3D, phase: Array, height: Array, low: float, high: float) -> None:
    """Draw the amplification mu over the phases as a surface in space."""
    colors = {"cmap": HEIGHT_COLORS, "vmin": low, "vmax": high, "linewidth": 0.2, "edgecolor": (0, 0, 0, 0.35)}
    draw_in_space(axes, phase, height, (low, high), 0.62, 0.88, **colors)
    axes.tick_params(labelsize=8, pad=0)
    axes.set_xlabel(r"$\alpha_1$, rad", labelpad=2)
    axes.set_ylabel(r"$\alpha_2$, rad", labelpad=2)


def _draw_difference_map(figure: Figure, axes: Axes, difference: ModelDifference) -> None:
    """Draw the relative difference of two models over the phases, in percent; colors end at the 98 % fractile."""
    percent = 100.0 * difference.size
    size = np.abs(percent[np.isfinite(percent)])
    largest = float(size.max()) if size.size else 0.0
    limit = float(np.percentile(size, 98.0)) if largest > 0.0 else 1.0
    limit = limit if limit > 0.0 else largest
    image = draw_map(axes, difference.alpha1, percent, cmap=SIGN_COLORS, vmin=-limit, vmax=limit)
    axes.set_xlabel(r"$\alpha_1$, rad")
    axes.set_ylabel(r"$\alpha_2$, rad")
    missing = int((~np.isfinite(percent)).sum())
    count = len(difference.alpha1)
    size_text = f"largest of {count} × {count}: {largest:.2g} %" if size.size else "no point to compare"
    gray = f", {missing} without a value (gray)" if missing else ""
    axes.set_title(f"second minus first, % of first\n{size_text}{gray}", fontsize=10)
    bar = figure.colorbar(image, cax=figure.add_axes((0.935, 0.14, 0.012, 0.65)), extend="both")
    bar.ax.tick_params(labelsize=8)
