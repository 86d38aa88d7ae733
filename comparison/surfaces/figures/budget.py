"""One map per step of the budget: how much each model of the hierarchy adds to mu_i, and where that is real."""

from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import SymLogNorm
from matplotlib.figure import Figure

from comparison.study.study import Study
from comparison.surfaces.budget import TOTAL, steps
from comparison.surfaces.figures.pairs import SIGN_COLORS, draw_map
from comparison.surfaces.steps import Step
from comparison.wording import mathtext
from reference.drawing import verbatim
from reference.problem import Scene

LINEAR = 1e-6  # relative: below it the colors are linear, above it logarithmic in both directions


def draw_budget(path: Path, study: Study, surfaces: xr.Dataset, scene: Scene, body: int) -> None:
    """Write one map per step, and of the total, to `path`, PNG: % of the first model's mu_i."""
    bars = steps(study, surfaces, scene.name, body)
    figure = Figure(figsize=(13.0, 3.4), dpi=110)
    heading = f"{scene.title} ({scene.name}), body {body}: what each model adds (dots: not resolved)"
    figure.suptitle(verbatim(heading), fontsize=12, y=0.98)
    sizes = np.abs(np.concatenate([step.size[np.isfinite(step.size)] for step in bars] or [np.zeros(0)]))
    largest = max(float(sizes.max()) if sizes.size else 0.0, 10.0 * LINEAR)
    norm = SymLogNorm(100.0 * LINEAR, vmin=-100.0 * largest, vmax=100.0 * largest)
    width = 0.86 / len(bars)
    for index, step in enumerate(bars):
        axes = figure.add_axes((0.045 + index * width, 0.14, 0.82 * width, 0.64))
        image = _map(axes, step, norm)
        if index:
            axes.set_yticklabels([])
    bar = figure.colorbar(image, cax=figure.add_axes((0.915, 0.14, 0.01, 0.64)))
    bar.set_label("% of the first model's value", fontsize=8)
    bar.ax.tick_params(labelsize=8)
    figure.savefig(path)


def _map(axes: Axes, step: Step, norm: SymLogNorm) -> QuadMesh:
    image = draw_map(axes, step.alpha1, 100.0 * step.size, cmap=SIGN_COLORS, norm=norm)
    axes.tick_params(labelsize=8)
    phase = step.alpha1
    row, column = np.nonzero(step.known & ~step.real)
    size = 40.0 / (len(phase) + 1)
    axes.plot(phase[row], phase[column], ".", color="0.35", markersize=size, markeredgewidth=0.0)
    known = step.known
    share = f"real at {100.0 * step.real[known].mean():.0f} % of {known.sum()}" if known.any() else "no common point"
    axes.set_title(f"{'total' if step.key == TOTAL else mathtext(step.second.title)}\n{share}", fontsize=8)
    return image
