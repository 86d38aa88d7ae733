"""The largest values over all phases: in the report."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from comparison.analyses.panels import distribution_panels
from comparison.analyses.worst_phases.analysis import Worst, WorstPhases
from comparison.report.plots import fractile_heads
from comparison.report.section import Feature, Report, Section
from comparison.wording import significant


def _kind(worst: Worst) -> str:
    if worst.reason:
        return worst.reason
    if worst.kind == "nearby":
        there = f"where it has {significant(worst.at_start)}"
        there = there if math.isfinite(worst.at_start) else "at which it has none"
        return f"the engine's largest value beside the phases above, {there}"
    if worst.kind == "jump":
        first, second = (f"{side:+.2f}" for side in worst.side)
        return f"beside a jump, approached from ({first}, {second})"
    return "on an edge of the surface" if worst.kind == "kink" else "on a smooth maximum"


def _context(report: Report, figures: Path) -> Mapping[str, Any]:
    results = report.results
    titles = {model.key: model.title for model in results.models}
    return {
        "distribution_panels": [
            panel
            for scene in results.scenes_with("worst_phases")
            for body in range(1, scene.bodies + 1)
            for curves in [[(each.model, each.curve) for each in scene.distributions if each.body == body]]
            for panel in distribution_panels(results, scene.name, f"μ_{body}", "", curves)
        ],
        "worst_lines": [
            {"worst": worst, "title": titles[worst.model], "kind": _kind(worst)}
            for worst in results.of("worst_phases") or ()
        ],
        "fractiles": fractile_heads(),
    }


FEATURE = Feature(
    "worst_phases",
    list[Worst],
    "the largest values over all phases; null if not computed",
    analysis=WorstPhases(),
    section=Section(
        "Largest values over all phases", "python -m comparison.run makes it, of scenes with phases", _context
    ),
)
