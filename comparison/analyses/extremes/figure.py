"""The matrix of extremes as a picture: one colored field per extreme and model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from comparison.analyses.extremes.matrix import MEANING, Entry, Matrix, Verdict, describe

Line = tuple[str, Mapping[str, Entry] | None]  # title and its entries; None for the heading of a group

# distinct for those who do not see red and green apart; the letter says it without any color
COLORS = {
    Verdict.CONVERGED: "#a8d5ba",
    Verdict.REFUSED: "#bcd4f0",
    Verdict.LIMIT: "#f7d488",
    Verdict.FAILED: "#8c1d18",
}
HEIGHT, WIDTH, LABELS, MARGIN, TOP = 0.2, 0.9, 1.75, 0.2, 1.15  # of fields, labels and borders, inches
PANELS = 2  # side by side, so that the whole fits a screen
LEGEND = 4.0  # inches, the width of a column of it


def draw_extremes(file: Path, matrix: Matrix) -> None:
    """Write the matrix as PNG."""
    panels = _panels(_lines(matrix))
    longest = max(len(lines) for lines in panels)
    panel = LABELS + WIDTH * len(matrix.columns) + MARGIN
    size = max(MARGIN + panel * len(panels), LEGEND), TOP + HEIGHT * (longest + 1)
    figure = Figure(figsize=size)
    for number, lines in enumerate(panels):
        left = MARGIN + number * panel + LABELS
        place = left / size[0], 0.0, WIDTH * len(matrix.columns) / size[0], 1.0 - TOP / size[1]
        _draw_panel(figure.add_axes(place), lines, matrix.columns, longest + 1)
    counts = matrix.counts()
    handles = [Patch(color=COLORS[verdict], label=f"{counts[verdict]} {MEANING[verdict]}") for verdict in Verdict]
    columns = 2 if size[0] >= 2.0 * LEGEND else 1
    figure.legend(handles=handles, loc="upper center", ncol=columns, fontsize=8, frameon=False)
    figure.savefig(file, dpi=130)


def _draw_panel(axes: Axes, lines: Sequence[Line], columns: Mapping[str, str], height: int) -> None:
    axes.set_xlim(0.0, len(columns))
    axes.set_ylim(height, 0.0)
    axes.axis("off")
    for place, title in enumerate(columns.values()):
        axes.text(place + 0.5, -0.3, title.replace(" ", "\n", 1), ha="center", va="bottom", fontsize=7)
    for number, (title, entries) in enumerate(lines):
        if entries is None:
            axes.text(-LABELS / WIDTH, number + 0.6, title, fontsize=7.5, fontweight="bold", va="center")
            continue
        axes.text(-0.08, number + 0.5, title, fontsize=7, ha="right", va="center")
        for place, key in enumerate(columns):
            if key in entries:
                _field(axes, place, number, entries[key])


def _panels(lines: Sequence[Line]) -> list[list[Line]]:
    """The lines in panels of about the same length, no group cut in two."""
    panels: list[list[Line]] = [[]]
    for title, entries in lines:
        full = len(panels[-1]) >= len(lines) / PANELS - 2
        if entries is None and full and len(panels) < PANELS:
            panels.append([])
        panels[-1].append((title, entries))
    return panels


def _lines(matrix: Matrix) -> list[Line]:
    """A heading for every group, and below it a line for every extreme."""
    lines: list[Line] = []
    for rows in matrix.groups():
        lines += [(rows[0].group, None), *((row.title, row.entries) for row in rows)]
    return lines


def _field(axes: Axes, place: int, line: int, entry: Entry) -> None:
    color = "white" if entry.verdict == Verdict.FAILED else "#1b1f24"
    axes.add_patch(Rectangle((place + 0.02, line + 0.06), 0.96, 0.88, color=COLORS[entry.verdict], lw=0))
    axes.text(place + 0.5, line + 0.52, describe(entry), ha="center", va="center", fontsize=6.5, color=color)
