"""Demands over all phases: in the report."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from comparison.analyses.demands.analysis import DemandStatistics, DemandSurfaces, PhaseExtreme, demand_statistics
from comparison.analyses.motions.feature import MotionDemands
from comparison.analyses.panels import distribution_panels
from comparison.report.plots import DEMANDS, Panel
from comparison.report.results import Results
from comparison.report.scene_result import SceneResult
from comparison.report.section import Feature, Report, SceneField, Section
from comparison.result_types import UncertainNumber
from comparison.wording import shortened
from reference.measures.peak_demands import QUANTITIES, unit_of


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


HEADINGS = (
    "scene", "model", "isolator, mm", "residual, mm", "base shear, N", "platform, m/s²", "top, m/s²", "drift, mm",
    "contact force, N",
)  # fmt: skip
MILLI = 1e3


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
        of_model = [row for row in rows if row.model == key]
        yield key, _cells(partial(_extremes if over_phases else _of_motions, of_model), scene.bodies)


def _extremes(rows: Sequence[DemandStatistics], quantity: str, body: int = 0) -> list[PhaseExtreme]:
    """Of one body, or without one of all."""
    shown = [row for row in rows if row.quantity == quantity and body in (0, row.body)]
    return [row.lowest if quantity == "contact_force_min" else row.highest for row in shown]


def _of_motions(motions: Sequence[MotionDemands], quantity: str, body: int = 0) -> list[UncertainNumber]:
    """Of one body, or without one of all."""
    found = [getattr(motion, quantity) for motion in motions]
    listed = [[each] if isinstance(each, UncertainNumber) else each for each in found]
    return [number for each in listed for number in (each[body - 1 : body] if body else each)]


def _cells(numbers: Callable[..., Sequence[PhaseExtreme | UncertainNumber]], bodies: int) -> list[str]:
    return [
        _text(numbers("displacement"), MILLI),
        _with_error(numbers("residual")),
        _text(numbers("base_shear")),
        _text(numbers("acceleration", 1)),
        _text(numbers("acceleration", bodies)),
        _text(numbers("drift"), MILLI),
        _text(numbers("contact_force_min"), pick=min),
    ]


def _with_error(numbers: Sequence[PhaseExtreme | UncertainNumber]) -> str:
    """The largest residual with its error, which includes the creep of regularized friction, in mm."""
    known = [number for number in numbers if math.isfinite(number.value)]
    largest = max(known, key=lambda number: number.value, default=None)
    if largest is None:
        return ""
    return f"{MILLI * largest.value:.4g}" + (f" ± {MILLI * largest.error:.1g}" if largest.error >= 0.0 else "")


def _text(
    numbers: Sequence[PhaseExtreme | UncertainNumber],
    factor: float = 1.0,
    pick: Callable[[Sequence[float]], float] = max,
) -> str:
    """The largest of the known values, or the one to pick."""
    known = [number.value for number in numbers if math.isfinite(number.value)]
    return f"{factor * pick(known):.4g}" if known else ""
