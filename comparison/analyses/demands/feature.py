"""Report section of the demands over all phases."""

from collections.abc import Mapping
from typing import Any

from comparison.analyses.demands.analysis import DemandStatistics, DemandSurfaces, demand_statistics, with_demands
from comparison.report.feature import Feature, Findings, SceneField
from comparison.report.panels import PLOTTED_DEMANDS, Panel, make_distribution_panels
from comparison.report.results import Results
from comparison.report.scene_result import SceneResult
from comparison.report.section import Report, Section
from reference.measures.peak_demands import QUANTITIES, unit_of
from reference.problem import Scene


def _statistics_of_scene(findings: Findings, scene: Scene) -> list[DemandStatistics]:
    """Return the statistics of each demand of a scene, from the demand surfaces that a study found."""
    return demand_statistics(findings.study, findings.found.get(DemandSurfaces.key), scene)


STATISTICS = SceneField(  # field of summary.json on each scene: statistics of its demands
    name="demand_statistics",
    kind=list[DemandStatistics],
    meaning="one per demand, body and model; empty unless demands of every phase pair were asked for",
    compute=_statistics_of_scene,
)


def demand_panels(scene: SceneResult, results: Results) -> list[Panel]:
    """Return for each demand a plot of its cumulative distribution over all phases, by model."""
    panels = []
    for quantity, body, title, unit, scale in PLOTTED_DEMANDS if not scene.recorded else ():
        curves = [
            (row.model, [scale * value for value in row.curve])
            for row in STATISTICS.read_from(scene)
            if (row.quantity, row.body) == (quantity, body)
        ]
        panels += make_distribution_panels(results, scene.name, title, unit, curves)
    return panels


def demand_lines(results: Results) -> list[dict[str, Any]]:
    """Return a table row of statistics for each scene, demand and model. Demand and model are named in words."""
    lines = []
    for scene in results.scenes:
        for row in STATISTICS.read_from(scene):
            meaning, _ = QUANTITIES[row.quantity]
            name = f"{meaning} of body {row.body}" if row.body else meaning
            name = f"{name}, {unit_of(row.quantity)}".removesuffix(", ")
            lines.append({"scene": scene.name, "name": name, "title": results.titles[row.model], "row": row})
    return lines


def _section_context(report: Report) -> Mapping[str, Any]:
    """Return the template variables of the report section on demands: its plots and table."""
    results = report.results
    return {
        "demand_panels": [panel for scene in results.scenes for panel in demand_panels(scene, results)],
        "demand_lines": demand_lines(results),
    }


# Registration of this analysis with the program: field of summary.json, computation, dataset, section of the report
FEATURE = Feature(
    key=DemandSurfaces.key,
    scene_fields=(STATISTICS,),
    analysis=DemandSurfaces(),
    on_request=True,
    dataset=with_demands,
    section=Section("Demands over all phases", context=_section_context),
)
