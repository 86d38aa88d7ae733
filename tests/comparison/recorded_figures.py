"""What figures show, as lines: every text, axis, line, color map and surface of a figure of matplotlib."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator
from mpl_toolkits.mplot3d import Axes3D  # type: ignore[import-untyped]
from PIL import Image


def figures_are_told(patch: pytest.MonkeyPatch) -> dict[str, list[str]]:
    """Figures are saved as one dot; returns the lines of each by its name, filled as they are saved."""
    told: dict[str, list[str]] = {}
    surface = Axes3D.plot_surface

    def saved(figure: Figure, place: Any, **options: Any) -> None:
        lines = list(_told(figure))
        told[Path(place).stem] = lines
        Image.new("RGB", (1, 1)).save(place, "PDF" if str(place).endswith(".pdf") else "PNG")

    def drawn(axes: Axes3D, *heights: Any, **look: Any) -> Any:
        axes.heights = heights
        return surface(axes, *heights, **look)

    patch.setattr(Figure, "savefig", saved)
    patch.setattr(Axes3D, "plot_surface", drawn)
    return told


def numbers(values: Any) -> str:
    """A few of the numbers, in six digits."""
    flat = np.ma.filled(np.ma.asarray(values, dtype=float), np.nan).ravel()
    return " ".join(f"{value:.6g}" for value in (*flat[:6], *flat[6::13]))


def _told(figure: Figure) -> Iterator[str]:
    if figure.get_suptitle():
        yield figure.get_suptitle().replace("\n", " ")
    for axes in figure.axes:
        yield " | ".join(part.replace("\n", " ") for part in _parts(axes) if part)
    for legend in figure.legends:
        yield f"legend {[text.get_text() for text in legend.texts]}"


def _parts(axes: Axes) -> Iterator[str]:
    yield from (axes.get_title(), axes.get_xlabel(), axes.get_ylabel())
    yield from (f"{name} {getattr(axes, f'get_{name}scale')()}" for name in "xy" if not isinstance(axes, Axes3D))
    for name in "xyz" if isinstance(axes, Axes3D) else "xy":
        if not getattr(axes, f"get_autoscale{name}_on")():
            yield f"{name} from {numbers(getattr(axes, f'get_{name}lim')())}"
        if isinstance(getattr(axes, f"{name}axis").get_major_locator(), FixedLocator):
            yield f"{name} ticks {[text.get_text() for text in getattr(axes, f'get_{name}ticklabels')()]}"
    if isinstance(axes, Axes3D):
        yield from (axes.get_zlabel(), *(f"surface {numbers(each)}" for each in axes.heights))
    for line in axes.lines:
        look = line.get_color(), line.get_marker(), line.get_linestyle(), line.get_linewidth()
        yield f"line {line.get_label()} {look} x {numbers(line.get_xdata())} y {numbers(line.get_ydata())}"
    for each in axes.collections:
        shown, clim = each.get_array(), each.get_clim()
        if isinstance(each, LineCollection):
            yield f"bars {numbers(np.concatenate(each.get_segments() or [np.zeros(0)]))}"
        elif shown is not None and not isinstance(axes, Axes3D):
            yield f"colors {each.get_cmap().name} {numbers(clim)}: {numbers(shown)}"
        elif isinstance(each, PolyCollection) and each.get_paths() and not isinstance(axes, Axes3D):
            yield f"band {numbers(each.get_paths()[0].vertices)}"
    for patch in axes.patches:
        yield f"patch {numbers(patch.get_extents().transformed(axes.transData.inverted()).extents)}"
    yield from (f"text {text.get_text()!r} at {numbers(text.get_position())}" for text in axes.texts)
    legend = axes.get_legend()
    if legend is not None:
        yield f"legend {[text.get_text() for text in legend.texts]}"
