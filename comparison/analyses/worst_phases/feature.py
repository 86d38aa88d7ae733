"""Report section of the largest values over all phases."""

import math
from collections.abc import Mapping
from typing import Any

from comparison.analyses.worst_phases.analysis import LargestOverPhases, WorstPhases, find_nearest_search
from comparison.report.feature import Feature, ResultField
from comparison.report.page_data import MU_DIGITS
from comparison.report.panels import fractile_heads, make_distribution_panels
from comparison.report.scene_result import SceneResult
from comparison.report.section import Report, Section
from comparison.study.models import SMALL, SMALL_AS_INTEGRATED, has_smooth_friction, models_of
from reference.problem import Scene
from reference.problem.readings import BOTH_READINGS


def _word_kind(worst: LargestOverPhases) -> str:
    """Return in words where the largest value over phases is, such as "on a smooth maximum", or why it is unknown."""
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


def _distribution_curves(scene: SceneResult, body: int) -> list[tuple[str, tuple[float, ...]]]:
    """
    Return the distributions of a body's amplification over the phases, each with the key of its model.

    They are by the small-vibration equations, in both readings, and by the most complete model.
    """
    (last,) = (line.second for line in scene.headlines if line.body == body)
    kept = (SMALL.key, SMALL_AS_INTEGRATED.key, last)
    return [(each.model, each.curve) for each in scene.distributions if each.body == body and each.model in kept]


def _name_reading(report: Report, worst: LargestOverPhases) -> str:
    """
    Return the name of the peaks that count in a largest amplification; "" for a displacement.

    They are peaks at any slip speed ("literal supremum"), at resolved ones ("as integrated"), or both without dry
    friction.
    """
    if worst.quantity == "displacement":
        return ""
    (scene,) = (scene for scene in report.study.scenes if scene.name == worst.scene)
    (model,) = (model for model in report.study.hierarchy if model.key == worst.model)
    return BOTH_READINGS.removeprefix("in ") if has_smooth_friction(scene) else model.reading


FOUND = ResultField(  # field of summary.json with the result of this analysis
    name=WorstPhases.key,
    kind=list[LargestOverPhases],
    meaning="the largest values over all phases; null if not computed",
)


def _list_marks(report: Report, scene: Scene) -> Mapping[str, Any]:
    """
    Return the marks of the largest amplifications on the surfaces of the page, by model a list of one for each body.

    A mark is [alpha1, alpha2, amplification, key of the model that was searched], with phases in rad. That is this
    model or one near it; the mark is None where neither was searched.
    """
    keys = [each.key for each in models_of(scene, report.study.hierarchy)]
    searched, bodies = report.found.get(WorstPhases.key) or (), range(1, len(scene.bodies) + 1)
    nearest = {key: [find_nearest_search(searched, keys, scene.name, key, body) for body in bodies] for key in keys}
    return {"worst": {key: [worst and _make_mark(worst) for worst in of_bodies] for key, of_bodies in nearest.items()}}


def _make_mark(worst: LargestOverPhases) -> list[float | str]:
    """Return the phases, rad, value and model of a largest amplification, for its mark on the surface."""
    return [*(round(phase, 4) for phase in worst.phases), float(f"{worst.value:.{MU_DIGITS}g}"), worst.model]


def _section_context(report: Report) -> Mapping[str, Any]:
    """Return the template variables of the report section on worst phases: distributions and largest values."""
    results = report.results
    return {
        "distribution_panels": [
            panel
            for scene in results.scenes_with("worst_phases")
            for body in range(1, scene.bodies + 1)
            for curves in [_distribution_curves(scene, body)]
            for panel in make_distribution_panels(results, scene.name, f"μ_{body}", "", curves)
        ],
        "worst_lines": [
            {
                "worst": worst,
                "title": results.titles[worst.model],
                "kind": _word_kind(worst),
                "reading": _name_reading(report, worst),
            }
            for worst in FOUND.read_from(results)
        ],
        "fractiles": fractile_heads(),
    }


# Registration of this analysis with the program: field of summary.json, computation, marks, section of the report
FEATURE = Feature(
    key=WorstPhases.key,
    fields=(FOUND,),
    analysis=WorstPhases(),
    page_data=_list_marks,
    section=Section(
        title="Largest values over all phases",
        absent="phase-resonance run makes it, of scenes with phases",
        context=_section_context,
        folded=False,
    ),
)
