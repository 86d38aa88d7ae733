"""The conditioning of mu_i over the smallest resolved speed: in the report."""

from collections.abc import Mapping, Sequence
from typing import Any

from comparison.analyses.conditioning.analysis import SPEEDS, Conditioning, ConditioningCurve
from comparison.analyses.conditioning.statement import conditioning_line, speed_text
from comparison.report.feature import Feature, ResultField
from comparison.report.panels import Panel, json_numbers, make_panel
from comparison.report.section import Report, Section
from comparison.wording import scientific, signed, significant
from reference.problem.readings import LITERAL_SUPREMUM

NAMES = {
    "small": "small equations",
    "exact": "exact equations",
    "translational": "Exudyn in translation",
    "spatial": "Exudyn, bodies that turn",
}
COLORS = {"exact": 0, "translational": 1, "spatial": 2}
QUANTITIES = {"mean": "mean", "largest": "largest", "relative_mean": "mean from the literal supremum"}


def conditioning_panels(curves: Sequence[ConditioningCurve]) -> list[Panel]:
    """Two panels of mu_1 for each scene: the small equations over a grid; the engine and the exact equations."""
    panels = []
    for scene in dict.fromkeys(curve.scene for curve in curves):
        own = [curve for curve in curves if (curve.scene, curve.body) == (scene, 1) and curve.pairs]
        on_grid, at_few = ([curve for curve in own if (curve.grid > 0) == wanted] for wanted in (True, False))
        if on_grid:
            means = [_speed_line(curve, "mean", "mean", 0 if curve.speed == "v_c" else 2) for curve in on_grid]
            largest = [_speed_line(curve, "largest", "largest", 1) for curve in on_grid if curve.speed == "v_c"]
            over = f"small equations, {on_grid[0].grid} × {on_grid[0].grid} phases"
            panels.append(_speed_panel(f"{scene}, {over}", "μ_1", [*means, *largest]))
        if at_few:
            series = [_speed_line(curve, "mean", NAMES[curve.model], COLORS[curve.model]) for curve in at_few]
            over = f"engine, {at_few[0].pairs} phase pairs, the first {at_few[0].duration:.2g} s"
            panels.append(_speed_panel(f"{scene}, {over}", "mean μ_1", series))
    return panels


def _speed_panel(title: str, quantity: str, series: list[dict[str, Any]]) -> Panel:
    label = f"{title}: {quantity} over the smallest resolved speed; " + "; ".join(line["name"] for line in series)
    return make_panel(
        title, label, {"title": "v_c or v_reg, m/s", "log": True}, {"title": quantity}, series, height=280
    )


def _speed_line(curve: ConditioningCurve, quantity: str, name: str, color: int) -> dict[str, Any]:
    """One curve over the speeds; the literal supremum, which has none, as a broken level line."""
    values = json_numbers(getattr(curve, quantity))
    named = {"name": f"{name}, {_name_reading(curve)}", "color": color}
    if curve.reading == LITERAL_SUPREMUM:
        return {**named, "x": [SPEEDS[-1], SPEEDS[0]], "y": values * 2, "dash": "5 3"}
    return {**named, "x": list(curve.v), "y": values, "marks": True}


def _name_reading(curve: ConditioningCurve) -> str:
    return curve.reading if curve.reading == LITERAL_SUPREMUM else f"{curve.reading} at {curve.speed}"


def conditioning_tables(curves: Sequence[ConditioningCurve]) -> list[dict[str, Any]]:
    """One table for each kind of speed: a row for each curve and quantity, the literal supremum in the last column."""
    suprema = {_owner_of_curve(curve): curve for curve in curves if curve.reading == LITERAL_SUPREMUM}
    tables = []
    for speed in ("v_c", "v_reg"):
        own = [curve for curve in curves if curve.speed == speed and curve.reading != LITERAL_SUPREMUM]
        rows = [
            _table_row(curve, quantity, suprema.get((curve.scene, curve.body, curve.base, curve.grid)))
            for curve in own
            for quantity in QUANTITIES
        ]
        if rows:
            tables.append({"speed": speed, "heads": [*map(speed_text, own[0].v)], "rows": rows})
    return tables


def _owner_of_curve(curve: ConditioningCurve) -> tuple[str, int, str, int]:
    return curve.scene, curve.body, curve.model, curve.grid


def _table_row(curve: ConditioningCurve, quantity: str, supremum: ConditioningCurve | None) -> dict[str, Any]:
    write = signed if quantity == "relative_mean" else significant
    values = [*getattr(curve, quantity), *([] if supremum is None else getattr(supremum, quantity))]
    errors = getattr(curve, quantity.removesuffix("_mean") + "_error")
    return {
        "curve": curve,
        "name": NAMES[curve.model],
        "phases": f"{curve.grid} × {curve.grid}" if curve.grid else f"{curve.pairs} pairs",
        "quantity": QUANTITIES[quantity],
        "cells": [(value, write(value)) for value in values] + ([(None, "")] if supremum is None else []),
        "error": (max(errors), scientific(max(errors))),
    }


FOUND = ResultField(
    Conditioning.key,
    list[ConditioningCurve],
    "mu over the smallest resolved speed, and its literal supremum; null if not computed",
)


def _section_context(report: Report) -> Mapping[str, Any]:
    curves = FOUND.of(report.results)
    return {
        "conditioning_panels": conditioning_panels(curves),
        "conditioning_tables": conditioning_tables(curves),
    }


FEATURE = Feature(
    Conditioning.key,
    (FOUND,),
    analysis=Conditioning(),
    section=Section(
        "Conditioning of the literal supremum",
        "phase-resonance run makes it, of scenes with phases and dry friction",
        _section_context,
        lead=lambda results: conditioning_line(FOUND.of(results)),
    ),
)
