"""Demands over all phases: in the report."""

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from comparison.analyses.demands.analysis import DemandStatistics, DemandSurfaces, PhaseExtreme, demand_statistics
from comparison.report.panels import distribution_panels
from comparison.report.plots import DEMANDS, Panel
from comparison.report.results import Results
from comparison.report.scene_result import SceneResult
from comparison.report.section import Feature, Report, SceneField, Section
from comparison.result_types import UncertainNumber
from comparison.wording import shortened
from reference.measures.peak_demands import QUANTITIES, unit_of

MILLI = 1e3
COLUMNS = (  # of report.pdf: heading, demand, body (None: all of them, -1: the uppermost), factor
    ("isolator, mm", "displacement", None, MILLI),
    ("residual, mm", "residual", None, MILLI),
    ("base shear, N", "base_shear", None, 1.0),
    ("platform, m/s²", "acceleration", 1, 1.0),
    ("top, m/s²", "acceleration", -1, 1.0),
    ("drift, mm", "drift", None, MILLI),
    ("contact force, N", "contact_force_min", None, 1.0),
)
HEADINGS = ("scene", "model", *(column[0] for column in COLUMNS))


def demand_panels(scene: SceneResult, results: Results) -> list[Panel]:
    """One panel for each demand: the share of all phases at which it stays below a value, by model."""
    panels = []
    for quantity, body, title, unit, scale in DEMANDS if not scene.recorded else ():
        curves = [
            (row.model, [scale * value for value in row.curve])
            for row in scene.of("demand_statistics")
            if (row.quantity, row.body) == (quantity, body)
        ]
        panels += distribution_panels(results, scene.name, title, unit, curves)
    return panels


def demand_lines(results: Results) -> list[dict[str, Any]]:
    """Rows of the table of demands, each with the names of its scene, demand and model."""
    titles = {model.key: model.title for model in results.models}
    lines = []
    for scene in results.scenes:
        for row in scene.of("demand_statistics"):
            meaning, _ = QUANTITIES[row.quantity]
            name = f"{meaning} of body {row.body}" if row.body else meaning
            name = f"{name}, {unit_of(row.quantity)}".removesuffix(", ")
            lines.append({"scene": scene.name, "name": name, "title": titles[row.model], "row": row})
    return lines


def _context(report: Report, figures: Path) -> Mapping[str, Any]:
    results = report.results
    return {
        "demand_panels": [panel for scene in results.scenes for panel in demand_panels(scene, results)],
        "demand_lines": demand_lines(results),
    }


def demand_rows(results: Results) -> list[list[str]]:
    """Cells under HEADINGS of the first and last model of every scene, over all phases or the stored motions."""
    titles = {model.key: model.title for model in results.models}
    with_demands = [scene for scene in results.scenes if scene.of("demand_statistics") or scene.of("demands")]
    return [
        [shortened(scene.name, 40), titles[key], *cells]
        for scene in with_demands
        for key, cells in _of_two_models(scene, titles)
    ]


def demands_note(results: Results) -> str:
    """Which motions the rows are of."""
    if any(scene.of("demand_statistics") for scene in results.scenes):
        return "Largest values over all phases; of the contact force, the smallest."
    return "Largest values over the stored motions of index.html; of the contact force, the smallest."


def _of_two_models(scene: SceneResult, titles: dict[str, str]) -> Iterator[tuple[str, list[str]]]:
    over_phases = scene.of("demand_statistics")
    rows = over_phases or scene.of("demands")
    keys = [key for key in titles if key in {row.model for row in rows}]
    for key in dict.fromkeys((keys[0], keys[-1])):
        own, cells = [row for row in rows if row.model == key], []
        for _, name, place, factor in COLUMNS:
            body = scene.bodies if place == -1 else place
            if over_phases:
                shown = [row for row in own if row.quantity == name and body in (None, row.body)]
                numbers = [row.lowest if name.endswith("_min") else row.highest for row in shown]
            else:
                found = [getattr(motion, name) for motion in own]
                listed = [[each] if isinstance(each, UncertainNumber) else each for each in found]
                numbers = [number for each in listed for number in (each[body - 1 : body] if body else each)]
            cells.append(_cell(name, numbers, factor))
        yield key, cells


def _cell(name: str, numbers: Sequence[PhaseExtreme | UncertainNumber], factor: float) -> str:
    """The worst known value; of a residual with its error, which includes the creep of regularized friction."""
    known = [number for number in numbers if math.isfinite(number.value)]
    if not known:
        return ""
    worst = (min if name.endswith("_min") else max)(known, key=lambda number: number.value)
    error = f" ± {factor * worst.error:.1g}" if name == "residual" and worst.error >= 0.0 else ""
    return f"{factor * worst.value:.4g}{error}"


FEATURE = Feature(
    "demands",
    analysis=DemandSurfaces(),
    scene_fields={
        "demand_statistics": SceneField(
            list[DemandStatistics],
            "one per demand, body and model; empty unless demands of every phase pair were asked for",
            lambda findings, scene: demand_statistics(findings.study, findings.found.get("demands"), scene),
        )
    },
    section=Section("Demands over all phases", context=_context),
)
