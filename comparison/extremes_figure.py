"""The matrix of extremes as a picture: one coloured field per extreme and model."""

from __future__ import annotations

from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from comparison.extreme_matrix import Entry, Matrix
from comparison.extreme_verdicts import Verdict

# distinct for those who do not see red and green apart; the letter says it without any colour
COLOURS = {
    Verdict.CONVERGED: "#a8d5ba",
    Verdict.REFUSED: "#bcd4f0",
    Verdict.LIMIT: "#f7d488",
    Verdict.FAILED: "#8c1d18",
}
MEANING = {
    Verdict.CONVERGED: "converged: error claimed, confirmed by a finer run",
    Verdict.REFUSED: "refused: against a rule, or the motion leaves the model",
    Verdict.LIMIT: "limit: the model says that it cannot",
    Verdict.FAILED: "FAILED: no answer, or a wrong one",
}
SHORT = {"solver failed": "solver", "tolerance not met": "tolerance", "ok": ""}
HEIGHT, WIDTH = 0.2, 1.25  # of a field, inches
LABELS = 3.4  # inches, left of the fields


def draw_extremes(file: Path, found: Matrix) -> None:
    """Write the matrix as PNG."""
    lines = _lines(found)
    columns = list(found.columns)
    size = LABELS + WIDTH * len(columns) + 0.2, HEIGHT * (len(lines) + 7)
    figure = Figure(figsize=size, layout=None)
    axes = figure.add_axes((LABELS / size[0], 0.0, 1.0 - (LABELS + 0.2) / size[0], 1.0))
    axes.set_xlim(0.0, len(columns))
    axes.set_ylim(len(lines) + 1.0, -6.0)
    axes.axis("off")
    for place, key in enumerate(columns):
        axes.text(place + 0.5, -0.4, found.columns[key].replace(" ", "\n", 1), ha="center", va="bottom", fontsize=7)
    for number, (title, entries) in enumerate(lines):
        if entries is None:
            axes.text(-LABELS / WIDTH, number + 0.75, title, fontsize=7.5, fontweight="bold", va="center")
            continue
        axes.text(-0.08, number + 0.5, title, fontsize=7, ha="right", va="center")
        for place, key in enumerate(columns):
            if key in entries:
                _field(axes, place, number, entries[key])
    counts = found.counts()
    handles = [Patch(color=COLOURS[verdict], label=f"{counts[verdict]} {MEANING[verdict]}") for verdict in Verdict]
    figure.legend(handles=handles, loc="upper center", ncol=2, fontsize=7, frameon=False)
    figure.savefig(file, dpi=130)


def _lines(found: Matrix) -> list[tuple[str, dict[str, Entry] | None]]:
    """A heading for every group, and below it a line for every extreme."""
    lines: list[tuple[str, dict[str, Entry] | None]] = []
    group = None
    for row in found.rows:
        if row.group != group:
            group = row.group
            lines.append((group, None))
        lines.append((row.title, dict(row.entries)))
    return lines


def _field(axes: object, place: int, line: int, entry: Entry) -> None:
    verdict = Verdict(entry.verdict)
    dark = verdict == Verdict.FAILED
    axes.add_patch(Rectangle((place + 0.02, line + 0.06), 0.96, 0.88, color=COLOURS[verdict], lw=0))  # type: ignore[attr-defined]
    axes.text(  # type: ignore[attr-defined]
        place + 0.5, line + 0.52, _said(verdict, entry), ha="center", va="center", fontsize=6.5,
        color="white" if dark else "#1b1f24",
    )  # fmt: skip


def _said(verdict: Verdict, entry: Entry) -> str:
    if verdict == Verdict.CONVERGED and entry.error is not None:
        return f"{entry.error:.0e}"
    if verdict == Verdict.FAILED:
        return "FAILED"
    words = entry.reason.split(":")[0]
    return words if len(words) <= 20 else "against a rule"
