"""
Draw the packages as boxes, from the command down to the question, and the imports between them as arrows.

`python docs/imports.py` writes docs/imports.svg. The width of an arrow grows with the number of importing modules.
"""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import grimp
import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

ROWS = [  # of boxes, from above; a box stands for the modules whose names begin with it
    ["comparison.run"],
    ["comparison.cli"],
    ["comparison.registry"],
    ["comparison.analyses", "comparison.evidence"],
    ["comparison.report"],
    ["comparison.surfaces"],
    ["comparison.runner"],
    ["comparison.study"],
    ["multibody", "reference"],
    ["multibody.integration", "reference.solver", "reference.analytical"],
    ["multibody.models", "reference.natural_modes"],
    ["reference.measures"],
    ["reference.problem"],
    ["reference.records"],
    ["reference.support"],
]


def box_of(module: str) -> str:
    """The longest box name that a module's name begins with."""
    boxes = [box for row in ROWS for box in row if module == box or module.startswith(f"{box}.")]
    return max(boxes, key=len, default="")


def counted() -> Counter[tuple[str, str]]:
    """Number of imports from box to box."""
    graph = grimp.build_graph("comparison", "multibody", "reference", cache_dir=None)
    pairs: Counter[tuple[str, str]] = Counter()
    for module in graph.modules:
        for imported in graph.find_modules_directly_imported_by(module):
            start, end = box_of(module), box_of(imported)
            if start and end and start != end:
                pairs[start, end] += 1
    return pairs


def main() -> None:
    """Write the picture beside this file."""
    places = {
        box: ((column - 0.5 * (len(row) - 1)) * 3.2, -float(number))
        for number, row in enumerate(ROWS)
        for column, box in enumerate(row)
    }
    figure, axes = plt.subplots(figsize=(9, 8))
    for number, ((start, end), count) in enumerate(sorted(counted().items())):
        bend = 0.25 if number % 2 else -0.25
        upward = places[end][1] > places[start][1]
        style = {
            "arrowstyle": "-|>",
            "lw": 0.5 + 0.05 * count,
            "color": "tab:red" if upward else "0.45",
            "connectionstyle": f"arc3,rad={bend}",
            "shrinkA": 14,
            "shrinkB": 14,
        }
        axes.annotate("", places[end], places[start], arrowprops=style)
    for box, place in places.items():
        frame = {"boxstyle": "round,pad=0.4", "fc": "white", "ec": "black"}
        axes.text(*place, box, ha="center", va="center", bbox=frame, zorder=5)
    axes.set_xlim(-4.5, 4.5)
    axes.set_ylim(-len(ROWS) + 0.3, 0.7)
    axes.axis("off")
    figure.savefig(Path(__file__).with_name("imports.svg"), bbox_inches="tight", metadata={"Date": None})


if __name__ == "__main__":
    main()
