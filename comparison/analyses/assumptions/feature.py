"""The section of the report on how far the paper's assumptions hold."""

from collections.abc import Mapping
from typing import Any

from comparison.analyses.assumptions.statements import (
    assumption_lines,
    describe_direction,
    describe_verdict,
    largest_change,
    range_cell,
)
from comparison.analyses.assumptions.trials import CHANGE_LIMITS
from comparison.analyses.assumptions.validity import Assumptions, Validity, list_cells_by_size
from comparison.analyses.assumptions.variations import Axis
from comparison.report.feature import Feature, ResultField
from comparison.report.panels import Panel, make_panel, replace_nan
from comparison.report.results import Results
from comparison.report.section import Report, Section
from reference.problem import Scene

# Label of a plot's horizontal axis by the quantity of the building that is varied
AXES: dict[Axis, str] = {
    "ring": "radius of the ring of supports, m",
    "height": "heights of the bodies, times the stated ones",
    "oval": "narrowing of the ring along its worst direction, share of its radius",
    "offset": "offset of bodies in the worst direction, m",
    "yaw": "angle of bodies and links in the worse sense, rad",
}
# Shaded bands of a plot, one for each limit on the change of amplification: from minus to plus the limit, percent
BANDS = [
    {"from": -100.0 * share, "to": 100.0 * share, "text": f"within {100.0 * share:g} %"} for share in CHANGE_LIMITS
]


def assumption_panels(found: Validity, scene: Scene) -> list[Panel]:
    """Return plots of each body's largest change of amplification, one for each varied quantity with an effect."""
    told = {each.key for each in found.ranges if each.scene == scene.name and not each.no_effect}
    panels = []
    for key in (key for key in AXES if key in told):
        line = sorted(list_cells_by_size(scene, found.cells, key), key=lambda pair: pair[0])
        unit = (scene.support_radius or 0.0) if key in ("ring", "offset") else 1.0
        places, series = [unit * size for size, _ in line], []
        for body in range(1, len(scene.bodies) + 1):
            changes = [largest_change(found, cell, body) for _, cell in line]
            low, middle, high = (
                replace_nan([100.0 * (change.size + side * change.error) for change in changes])
                for side in (-1.0, 0.0, 1.0)
            )
            bars = {"x": places, "y": middle, "low": low, "high": high, "color": body - 1, "marks": True}
            series.append({"name": f"μ_{body}", **bars})
        axes = {"title": AXES[key], "log": key == "ring"}, {"title": "largest change of μ_i, %"}
        label = f"{scene.name}: largest change of every mu, {found.reading}, over {AXES[key]}"
        panels.append(make_panel(AXES[key].split(",")[0], label, *axes, series, bands=BANDS))
    return panels


# Field of summary.json with the result of this analysis
FOUND = ResultField(Assumptions.key, Validity, "how far the paper's assumptions hold; null without a spatial model")


def section_context(report: Report) -> Mapping[str, Any]:
    """Return the template variables of the report section on assumptions: plots and text of every varied scene."""
    found = FOUND.read_from(report.results)
    shown = []
    for scene in report.study.scenes:
        if any(cell.scene == scene.name for cell in found.cells):
            tried = [describe_direction(scene, each) for each in found.directions if each.scene == scene.name]
            shown.append(
                {
                    "title": scene.title,
                    "name": scene.name,
                    "panels": assumption_panels(found, scene),
                    "lines": assumption_lines(found, scene),
                    "directions": tried,
                }
            )
    return {"assumption_scenes": shown, "range_cell": range_cell, "within": CHANGE_LIMITS}


def assumption_verdict(results: Results) -> str:
    """Return the verdict in the section's title: how much the amplification changes when bodies may rotate."""
    return describe_verdict(FOUND.read_from(results))


# Registration of this analysis with the program: field of summary.json, computation, section of the report
FEATURE = Feature(
    key=Assumptions.key,
    fields=(FOUND,),
    analysis=Assumptions(),
    section=Section(
        title="How far the paper's assumptions hold",
        absent=(
            "no scene with phases says where its supports are and how high and large its bodies, as the spatial model "
            "asks"
        ),
        context=section_context,
        verdict=assumption_verdict,
    ),
)
