"""Drawings of arrays with matplotlib: a surface over the phases, and a motion over time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

COLORS = "cividis"  # read alike with and without color vision deficiency, and in print
MAX_TIME_POINTS = 20_000  # of a drawn line


def verbatim(text: str) -> str:
    r"""
    A text of a scene for matplotlib, which would read dollar signs as the marks of a formula.

    Parameters
    ----------
    text : str

    Returns
    -------
    str

    Examples
    --------
    >>> print(verbatim("price in $"))
    price in \$
    """
    return text.replace("$", r"\$")


def draw_surface(grid: tuple[Array, Array], height: Array, label: str, axes: Axes | None) -> Axes:
    """A surface (A, B) over alpha_1 (A,) and alpha_2 (B,), rad; as a map on axes without the projection "3d"."""
    axes = _new_axes("3d") if axes is None else axes
    if axes.name == "3d":
        first, second = np.meshgrid(*grid, indexing="ij")
        axes.plot_surface(first, second, height, cmap=COLORS, rcount=200, ccount=200, linewidth=0.2)  # type: ignore[attr-defined]
        axes.set_zlabel(label)  # type: ignore[attr-defined]
    else:
        image = axes.pcolormesh(*grid, height.T, cmap=COLORS, shading="nearest")
        axes.figure.colorbar(image, ax=axes, label=label)
        axes.set_aspect("equal")
    axes.set_xlabel(r"$\alpha_1$, rad")
    axes.set_ylabel(r"$\alpha_2$, rad")
    return axes


def draw_motion(
    time: Array, values: Array, rests: Sequence[tuple[float, float]], label: str, title: str, axes: Axes | None
) -> Axes:
    """Values (T, N, 3) of every body along x and y over `time` (T,), s, with the intervals of rest shaded."""
    axes = _new_axes(None) if axes is None else axes
    every = slice(None, None, -(-len(time) // MAX_TIME_POINTS) or 1)
    for body in range(values.shape[1]):
        for axis, (name, style) in enumerate((("x", "-"), ("y", "--"))):
            line = values[every, body, axis]
            axes.plot(time[every], line, style, color=f"C{body}", lw=1.0, label=f"body {body + 1}, {name}")
    for start, end in rests:
        axes.axvspan(start, end, color="0.5", alpha=0.15, lw=0.0)
    axes.set_xlabel("time, s")
    axes.set_ylabel(label)
    axes.set_title(verbatim(title), fontsize="medium")
    axes.legend(fontsize="small")
    return axes


def _new_axes(projection: str | None) -> Axes:
    import matplotlib.pyplot as plt  # loaded on first use

    axes: Axes = plt.figure(layout="constrained").add_subplot(projection=projection)
    return axes
