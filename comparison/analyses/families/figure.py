"""The budget of a family of scenes against the value that runs: what each model adds to mu_i as it grows."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparison.analyses.families.analysis import FamilyStep
from comparison.report.section import Report
from comparison.study.models import Model
from comparison.surfaces.budget import TOTAL, BudgetEntry
from comparison.surfaces.figures.file_names import figure_file
from comparison.wording import MAX_NAMES
from reference.drawing import verbatim
from reference.problem import Family

COLORS = ("#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00")  # told apart by every eye
MARKERS = "osD^v<>"  # and in print


def draw_families(folder: Path, report: Report) -> None:
    """Write the figure of every body of every family into `folder`, PNG."""
    entries = [entry for scene in report.results.scenes for entry in scene.budget]
    for family, found in zip(report.found["families"], report.results.of("families"), strict=True):
        for body in range(1, family.bodies + 1):
            path = folder / figure_file(family.name, f"body{body}", "family")
            draw_family(path, family, found.steps, entries, report.study.hierarchy, body)


def draw_family(
    path: Path,
    family: Family,
    means: Sequence[FamilyStep],
    entries: Sequence[BudgetEntry],
    hierarchy: Sequence[Model],
    body: int,
) -> None:
    """
    Write mean and largest size of every step of the budget, and of the total, over the values of the family.

    Dashed beside the largest sizes: the median uncertainty of the step. What lies below it is no difference.
    """
    titles = {TOTAL: "total", **{model.key: model.title for model in hierarchy}}
    figure = Figure(figsize=(13.0, 4.4), dpi=110)
    title = family.scenes[0].title
    figure.suptitle(verbatim(f"{title} ({family.name}), body {body}: what each model adds"), fontsize=12, y=0.98)
    left, right = figure.add_axes((0.06, 0.14, 0.31, 0.74)), figure.add_axes((0.44, 0.14, 0.31, 0.74))
    numbers = not any(isinstance(value, str) for value in family.values)
    places = np.array(family.values, dtype=float) if numbers else np.arange(len(family.values), dtype=float)
    steps = [key for key in titles if any(e.step == key and e.scene == family.scenes[0].name for e in entries)]
    for number, step in enumerate([*(key for key in steps if key != TOTAL), TOTAL]):
        mean = np.array(next(bar.size for bar in means if (bar.model, bar.body) == (step, body)))
        largest, error_estimate = (_over(family, entries, body, step, part) for part in ("maximum", "error_estimate"))
        look: dict[str, Any] = {"marker": MARKERS[number % len(MARKERS)], "markersize": 4.0, "linewidth": 1.2}
        look["color"] = "black" if step == TOTAL else COLORS[number % len(COLORS)]
        left.plot(places, 100.0 * mean, **look)
        right.plot(places, 100.0 * largest, label=titles[step], **look)
        right.plot(places, 100.0 * error_estimate, color=look["color"], linewidth=0.8, linestyle="--")
    alone = family.scenes[0].recorded  # one value, no phases
    left.set_ylabel(f"{'signed size' if alone else 'mean over the phases'}, % of the first model's value")
    right.set_ylabel("absolute size, %" if alone else "largest over the phases, %")
    if _positive(right):
        right.set_yscale("log", nonpositive="mask")  # a step of exactly nothing has no place there
    for axes in (left, right):
        axes.set_xlabel(verbatim(family.key))
        axes.grid(color="0.9")
        if not numbers:
            every = slice(None, None, -(-len(places) // MAX_NAMES))
            names = [verbatim(str(value)) for value in family.values[every]]
            axes.set_xticks(places[every], names, rotation=20.0, fontsize=8)
    figure.legend(*right.get_legend_handles_labels(), loc="center left", bbox_to_anchor=(0.765, 0.5), frameon=False)
    figure.savefig(path)


def _over(family: Family, entries: Sequence[BudgetEntry], body: int, step: str, part: str) -> np.ndarray:
    """One number of one step for every scene of the family, NaN where a scene does not have it."""
    sizes = {entry.scene: getattr(entry, part) for entry in entries if (entry.body, entry.step) == (body, step)}
    return np.array([sizes.get(scene.name, np.nan) for scene in family.scenes], dtype=float)


def _positive(axes: Axes) -> bool:
    """Whether a logarithmic axis has anything to show."""
    sizes = np.concatenate([np.asarray(line.get_ydata(), dtype=float) for line in axes.get_lines()])
    return bool((sizes[np.isfinite(sizes)] > 0.0).any())
