"""Drawing of arrays with matplotlib: a quantity over both initial phases (a surface), and a motion over time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

COLOR_MAP = "cividis"  # color map that also people with color vision deficiency can read, and that prints well
MAX_TIME_POINTS = 20_000  # largest number of points in a drawn line over time


def escape_for_matplotlib(text: str) -> str:
    """Escape the dollar signs in a text, which would begin a formula in matplotlib, and return it."""
    return text.replace("$", r"\$")


def draw_surface(grid: tuple[Array, Array], height: Array, label: str, title: str, axes: Axes | None) -> Axes:
    """
    Draw a quantity `height` (A, B) over the initial phases alpha_1 (A,) and alpha_2 (B,), rad, which are in `grid`.

    It is drawn as a surface on axes with the projection "3d", else as a color map. label: text of the color bar.
    """
    axes = _new_axes("3d") if axes is None else axes
    if axes.name == "3d":
        first, second = np.meshgrid(*grid, indexing="ij")
        ends = {"vmin": np.nanmin(height), "vmax": np.nanmax(height)}  # without them, colors span the means of faces
        image = axes.plot_surface(first, second, height, cmap=COLOR_MAP, rcount=200, ccount=200, linewidth=0.2, **ends)  # type: ignore[attr-defined]
        axes.set_zlabel(label)  # type: ignore[attr-defined]
        axes.figure.colorbar(image, ax=axes, label=label, shrink=0.6, pad=0.12)
    else:
        image = axes.pcolormesh(*grid, height.T, cmap=COLOR_MAP, shading="nearest")
        axes.figure.colorbar(image, ax=axes, label=label)
        axes.set_aspect("equal")
    pad = 10.0 if axes.name == "3d" else 4.0  # points: the tick labels of a surface are wide
    axes.set_xlabel(r"$\alpha_1$, rad", labelpad=pad)
    axes.set_ylabel(r"$\alpha_2$, rad", labelpad=pad)
    for axis, phases in zip((axes.xaxis, axes.yaxis), grid):
        _mark_quarter_turns(axis, float(np.ptp(phases)))
    axes.set_title(title, fontsize="medium")
    return axes


def _mark_quarter_turns(axis: Axis, span: float) -> None:
    """Set the ticks of an axis in rad to multiples of pi / 2, written as "π/2", if it spans 0.9 pi to 8 pi."""
    from matplotlib.ticker import FuncFormatter, MultipleLocator  # matplotlib is loaded on first use

    if 0.9 * np.pi <= span <= 8.0 * np.pi:
        axis.set_major_locator(MultipleLocator(0.5 * np.pi))
        axis.set_major_formatter(FuncFormatter(lambda phase, _: write_half_turns(phase)))


def write_half_turns(phase: float) -> str:
    """
    Return an angle in rad that is a multiple of pi / 2 as text such as "3π/2".

    >>> [write_half_turns(quarters * np.pi / 2.0) for quarters in (-1, 0, 1, 2, 3, 4)]
    ['-π/2', '0', 'π/2', 'π', '3π/2', '2π']
    """
    quarters = round(2.0 * phase / np.pi)
    number, half = (quarters, "/2") if quarters % 2 else (quarters // 2, "")
    return f"{number}π{half}".replace("1π", "π") if number in (-1, 1) else f"{number}π{half}" if number else "0"


def draw_motion(
    time: Array, values: Array, rests: Sequence[tuple[float, float]], label: str, title: str, axes: Axes | None
) -> Axes:
    """
    Draw a quantity of all bodies along x and y over `time` (T,), s, and shade the intervals of rest.

    values: (T, N, 3), along x, y and z. rests: start and end of every rest, s. label: text of the vertical axis.
    """
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
    axes.set_title(escape_for_matplotlib(title), fontsize="medium")
    axes.legend(fontsize="small")
    return axes


def _new_axes(projection: str | None) -> Axes:
    """Return the axes of a new matplotlib figure; projection: "3d", or None for a plane."""
    import matplotlib.pyplot as plt  # matplotlib is loaded on first use

    axes: Axes = plt.figure(layout="constrained").add_subplot(projection=projection)
    return axes
