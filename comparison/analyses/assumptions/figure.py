"""How far mu_i of the spatial model is from the translational one, over ring and heights, as one map per body."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from comparison.analyses.assumptions.validity import WITHIN, AssumptionCell
from comparison.surfaces.figures.pairs import save
from reference.drawing import verbatim
from reference.problem import Scene

COLORS = ("#fde725", "#35b779", "#440154")  # within 1 %, within 5 %, beyond: told apart without color vision too
NO_VALUE, NOT_TRIED = "0.6", "0.95"


def draw_assumptions(path: Path, scene: Scene, cells: Sequence[AssumptionCell]) -> None:
    """Write one map per body to `path`, PNG, and as PDF: ring across, heights upwards, largest change in percent."""
    shown = [cell for cell in cells if cell.scene == scene.name and cell.variation.is_usual]
    bodies = len(scene.bodies)
    figure = Figure(figsize=(1.2 + 4.6 * bodies, 3.9), dpi=110, layout="constrained")
    figure.suptitle(verbatim(f"{scene.title} ({scene.name}): spatial against translational model"), fontsize=11)
    for body, axes in enumerate(np.atleast_1d(figure.subplots(1, bodies, sharey=True)), start=1):
        _map(axes, scene, shown, body)
    save(figure, path)


def _map(axes: Axes, scene: Scene, cells: Sequence[AssumptionCell], body: int) -> None:
    rings = sorted({cell.variation.ring for cell in cells})
    heights = sorted({cell.variation.height for cell in cells})
    axes.set_facecolor(NOT_TRIED)
    image = np.full((len(heights), len(rings)), np.nan)
    for cell in cells:
        row, column = heights.index(cell.variation.height), rings.index(cell.variation.ring)
        image[row, column] = size = cell.largest(body)
        known = np.isfinite(size)
        if not known:
            axes.add_patch(Rectangle((column - 0.5, row - 0.5), 1.0, 1.0, color=NO_VALUE))
        dark = known and size > WITHIN[1]
        error = cell.error_estimate(body)
        text = f"{100.0 * size:.2g}" if known else "none"
        if known and error > 0.2 * size:
            text += f"\n± {100.0 * error:.2g}"
        axes.text(column, row, text, ha="center", va="center", fontsize=9, color="w" if dark else "k")
    norm = BoundaryNorm([0.0, *WITHIN, np.inf], len(COLORS))
    axes.imshow(image, cmap=ListedColormap(COLORS), norm=norm, origin="lower", aspect="auto")
    axes.set_xticks(range(len(rings)), [f"{ring * (scene.support_radius or np.nan):g}" for ring in rings])
    axes.set_yticks(range(len(heights)), [f"{height:g}" for height in heights])
    axes.set_xlabel("radius of the ring of supports, m")
    axes.set_ylabel("heights, times the stated ones")
    axes.set_title(rf"change of $\mu_{{{body}}}$, %: yellow within 1, green within 5", fontsize=10)
