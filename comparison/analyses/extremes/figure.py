"""The matrix of extremes as a picture: one colored field per extreme and model."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from comparison.analyses.extremes.matrix import MEANING, Entry, Matrix, Verdict, describe

Line = tuple[str, Mapping[str, Entry] | None]  # title and its entries; None for the heading of a group

# distinct for those who do not see red and green apart; the letter says it without any color
COLORS = {Verdict.CONVERGED: "#a8d5ba", Verdict.REFUSED: "#bcd4f0", Verdict.LIMIT: "#f7d488", Verdict.FAILED: "#8c1d18"}
HEIGHT, WIDTH, LABELS, MARGIN, TOP = 0.2, 0.9, 1.75, 0.2, 1.15  # of fields, labels and borders, inches
LEGEND = 4.0  # inches, the width of a column of it


def draw_extremes(file: Path, matrix: Matrix) -> None:
    """Write the matrix as PNG: a heading for every group and a line for every extreme, in panels of one length."""
    lines: list[Line] = []
    for rows in matrix.groups():
        lines += [(rows[0].group, None), *((row.title, row.entries) for row in rows)]
    heads = [number for number, (_, entries) in enumerate(lines) if entries is None and number]
    cut = next((number for number in heads if number >= len(lines) / 2 - 2), len(lines))  # no group is cut in two
    panels = [part for part in (lines[:cut], lines[cut:]) if part]
    longest = max(map(len, panels))
    panel = LABELS + WIDTH * len(matrix.columns) + MARGIN
    size = max(MARGIN + panel * len(panels), LEGEND), TOP + HEIGHT * (longest + 1)
    figure = Figure(figsize=size)
    for number, part in enumerate(panels):
        left = MARGIN + number * panel + LABELS
        place = left / size[0], 0.0, WIDTH * len(matrix.columns) / size[0], 1.0 - TOP / size[1]
        axes = figure.add_axes(place, xlim=(0.0, len(matrix.columns)), ylim=(longest + 1, 0.0))
        axes.axis("off")
        _draw_panel(axes, part, matrix.columns)
    counts = matrix.counts()
    handles = [Patch(color=COLORS[verdict], label=f"{counts[verdict]} {MEANING[verdict]}") for verdict in Verdict]
    columns = 2 if size[0] >= 2.0 * LEGEND else 1
    figure.legend(handles=handles, loc="upper center", ncol=columns, fontsize=8, frameon=False)
    figure.savefig(file, dpi=130)


def _draw_panel(axes: Axes, lines: Sequence[Line], columns: Mapping[str, str]) -> None:
    for place, title in enumerate(columns.values()):
        axes.text(place + 0.5, -0.3, title.replace(" ", "\n", 1), ha="center", va="bottom", fontsize=7)
    for number, (title, entries) in enumerate(lines):
        if entries is None:
            axes.text(-LABELS / WIDTH, number + 0.6, title, fontsize=7.5, fontweight="bold", va="center")
            continue
        axes.text(-0.08, number + 0.5, title, fontsize=7, ha="right", va="center")
        for place, entry in ((place, entries[key]) for place, key in enumerate(columns) if key in entries):
            color = "white" if entry.verdict == Verdict.FAILED else "#1b1f24"
            axes.add_patch(Rectangle((place + 0.02, number + 0.06), 0.96, 0.88, color=COLORS[entry.verdict], lw=0))
            text = describe(entry)
            axes.text(place + 0.5, number + 0.52, text, ha="center", va="center", fontsize=6.5, color=color)
