"""The largest values over all phases: in the report."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from comparison.analyses.worst_phases.analysis import Worst, WorstPhases
from comparison.report.panels import distribution_panels
from comparison.report.plots import fractile_heads
from comparison.report.scene_result import SceneResult
from comparison.report.section import Feature, Report, Section
from comparison.study.models import SMALL, SMALL_RESOLVED, smooth
from comparison.surfaces.headline import BOTH_READINGS


def _kind(worst: Worst) -> str:
    if worst.reason:
        return worst.reason
    if worst.kind == "nearby":
        if not math.isfinite(worst.at_start):
            return "beside the worst phases of the equations, at which it has none"
        same = worst.at_start == worst.value
        return "at the worst phases of the equations" if same else "beside the worst phases of the equations"
    if worst.kind == "grid":
        return "at a phase pair of its grid"
    if worst.kind == "jump":
        first, second = (f"{side:+.2f}" for side in worst.side)
        return f"beside a jump, approached from ({first}, {second})"
    return "on an edge of the surface" if worst.kind == "kink" else "on a smooth maximum"


def _curves(scene: SceneResult, body: int) -> list[tuple[str, tuple[float, ...]]]:
    """The distributions that answer the question: the small equations in both readings, and the last model."""
    (last,) = (line.second for line in scene.headlines if line.body == body)
    kept = (SMALL.key, SMALL_RESOLVED.key, last)
    return [(each.model, each.curve) for each in scene.distributions if each.body == body and each.model in kept]


def _reading(report: Report, worst: Worst) -> str:
    """The reading of (5.1) that a largest value has; "" of a displacement."""
    if worst.quantity == "displacement":
        return ""
    (scene,) = (scene for scene in report.study.scenes if scene.name == worst.scene)
    (model,) = (model for model in report.study.hierarchy if model.key == worst.model)
    return BOTH_READINGS.removeprefix("in ") if smooth(scene) else model.reading


def _context(report: Report, figures: Path) -> Mapping[str, Any]:
    results = report.results
    titles = {model.key: model.title for model in results.models}
    return {
        "distribution_panels": [
            panel
            for scene in results.scenes_with("worst_phases")
            for body in range(1, scene.bodies + 1)
            for curves in [_curves(scene, body)]
            for panel in distribution_panels(results, scene.name, f"μ_{body}", "", curves)
        ],
        "worst_lines": [
            {"worst": worst, "title": titles[worst.model], "kind": _kind(worst), "reading": _reading(report, worst)}
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
        "Largest values over all phases",
        "python -m comparison.run makes it, of scenes with phases",
        _context,
        folded=False,
    ),
)
