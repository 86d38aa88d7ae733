"""Drawings of results: a surface over the phases, and a motion over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from mpl_toolkits.mplot3d import Axes3D  # type: ignore[import-untyped]

from reference.problem.figure_text import verbatim
from reference.problem.phases import grid_axes
from reference.problem.ranges import brief, checked_choice

if TYPE_CHECKING:
    from reference.problem.result import Amplification, Trajectory

COLORS = "cividis"  # read alike with and without color vision deficiency, and in print
MAX_TIME_POINTS = 20_000  # of a drawn line
QUANTITIES = {
    "position": "displacement against the plate, m",
    "velocity": "velocity against the plate, m/s",
    "absolute_acceleration": "absolute acceleration, m/s$^2$",
}


def draw_amplification(result: Amplification, body: int, axes: Axes | None) -> Axes:
    """What `Amplification.plot` does."""
    bodies = result.mu.shape[-1]
    if not (isinstance(body, int) and 1 <= body <= bodies):
        raise ValueError(f"body = {brief(body)}: must be a whole number from 1 to {bodies}")
    grid = grid_axes(result.phases)
    if grid is None:
        rule = "must be a grid of at least 2 x 2 phases, as phase_grid(8) is"
        raise ValueError(f"phases: shape {result.phases.shape}: {rule}, to be drawn as a surface")
    height = result.mu[..., body - 1].reshape(len(grid[0]), len(grid[1]))
    if axes is None:
        axes = plt.figure(layout="constrained").add_subplot(projection="3d")
    if isinstance(axes, Axes3D):
        first, second = np.meshgrid(*grid, indexing="ij")
        axes.plot_surface(first, second, height, cmap=COLORS, rcount=200, ccount=200, linewidth=0.2)
        axes.set_zlabel(rf"$\mu_{{{body}}}$")
    else:
        image = axes.pcolormesh(*grid, height.T, cmap=COLORS, shading="nearest")
        axes.figure.colorbar(image, ax=axes, label=rf"$\mu_{{{body}}}$")
        axes.set_aspect("equal")
    axes.set_xlabel(r"$\alpha_1$, rad")
    axes.set_ylabel(r"$\alpha_2$, rad")
    return axes


def draw_trajectory(motion: Trajectory, quantity: str, axes: Axes | None) -> Axes:
    """What `Trajectory.plot` does."""
    label = QUANTITIES[checked_choice("quantity", quantity, list(QUANTITIES))]
    if axes is None:
        axes = plt.figure(layout="constrained").add_subplot()
    every = slice(None, None, -(-len(motion.time) // MAX_TIME_POINTS) or 1)
    for body in range(motion.position.shape[1]):
        for axis, (name, style) in enumerate((("x", "-"), ("y", "--"))):
            values = getattr(motion, quantity)[every, body, axis]
            axes.plot(motion.time[every], values, style, color=f"C{body}", lw=1.0, label=f"body {body + 1}, {name}")
    for start, end in motion.stick:
        axes.axvspan(start, end, color="0.5", alpha=0.15, lw=0.0)
    axes.set_xlabel("time, s")
    axes.set_ylabel(label)
    axes.set_title(verbatim(motion.scene.title), fontsize="medium")
    axes.legend(fontsize="small")
    return axes
