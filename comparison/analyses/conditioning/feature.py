"""The report section on how the amplification mu_i depends on the smallest slip speed that is resolved."""

from collections.abc import Mapping, Sequence
from typing import Any

from comparison.analyses.conditioning.analysis import SPEEDS, Conditioning, ConditioningCurve
from comparison.analyses.conditioning.statement import conditioning_line, name_damping, speed_text, yielding_line
from comparison.report.feature import Feature, ResultField
from comparison.report.panels import Panel, make_panel, replace_nan
from comparison.report.results import Results
from comparison.report.section import Report, Section
from comparison.wording import scientific, signed, significant
from reference.problem.readings import LITERAL_SUPREMUM

NAMES = {  # names, in plots and tables, of the small-vibration and exact equations and the models of Exudyn
    "small": "small equations",
    "exact": "exact equations",
    "translational": "Exudyn in translation",
    "spatial": "Exudyn, bodies that turn",
}
# Index, in the palette of plots, of the color of a model's curve
COLORS = {"exact": 0, "translational": 1, "spatial": 2}
# Units of cutoff speed, regularization speed of friction, and yield displacement; tables over them are in this order
UNITS = {"v_c": "m/s", "v_reg": "m/s", "u_y": "m"}
# Statistics over phases of the amplification, in the rows of the tables: key and name
QUANTITIES = {"mean": "mean", "largest": "largest", "relative_mean": "mean from the literal supremum"}


def conditioning_panels(curves: Sequence[ConditioningCurve]) -> list[Panel]:
    """
    Return up to three plots of the platform's amplification for each scene.

    They are over the slip speed by the small equations on a grid, over the slip speed by all models at a few phase
    pairs, and over the yield displacement.
    """
    panels = []
    for scene in dict.fromkeys(curve.scene for curve in curves):
        every = [curve for curve in curves if (curve.scene, curve.body) == (scene, 1) and curve.pairs]
        own = [curve for curve in every if curve.speed != "u_y"]
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
        yields = [curve for curve in every if curve.speed == "u_y"]
        if yields:
            over = f"friction that yields, exact equations, {yields[0].grid} × {yields[0].grid} phases"
            panels.append(_yield_panel(f"{scene}, {over}", yields))
    return panels


def _speed_panel(title: str, quantity: str, series: list[dict[str, Any]]) -> Panel:
    """Return a plot of a statistic of the amplification over cutoff or regularization speed, m/s, on a log axis."""
    label = f"{title}: {quantity} over the smallest resolved speed; " + "; ".join(line["name"] for line in series)
    return make_panel(
        title, label, {"title": "v_c or v_reg, m/s", "log": True}, {"title": quantity}, series, height=280
    )


def _yield_panel(title: str, curves: Sequence[ConditioningCurve]) -> Panel:
    """
    Return a plot of the mean and largest amplification mu_1 over the yield displacement.

    Horizontal lines are the values of rigid friction in the limit of zero slip speed.
    """
    dampings = [*dict.fromkeys(curve.damping for curve in curves)]
    series: list[dict[str, Any]] = []
    ends = [f(v for curve in curves for v in curve.v if v) for f in (min, max)]
    for curve in curves:
        for number, quantity in enumerate(("mean", "largest")):
            values, color = replace_nan(getattr(curve, quantity)), 2 * dampings.index(curve.damping) + number
            name = f"{quantity}, {name_damping(curve)}"
            if curve.reading == LITERAL_SUPREMUM:
                name = f"{name}, rigid, {LITERAL_SUPREMUM}"
                series.append({"name": name, "color": color, "x": ends, "y": values * 2, "dash": "5 3"})
            else:
                series.append({"name": name, "color": color, "x": list(curve.v), "y": values, "marks": True})
    label = f"{title}: μ_1 over the yield displacement; " + "; ".join(line["name"] for line in series)
    axes = {"title": "yield displacement u_y, m", "log": True}, {"title": "μ_1"}
    return make_panel(title, label, *axes, series, height=280)


def _speed_line(curve: ConditioningCurve, quantity: str, name: str, color: int) -> dict[str, Any]:
    """
    Return one line of a plot: a statistic of the amplification over the cutoff or regularization speed.

    That of the literal supremum, the limit at zero speed, is horizontal and dashed.
    """
    values = replace_nan(getattr(curve, quantity))
    named = {"name": f"{name}, {_name_reading(curve)}", "color": color}
    if curve.reading == LITERAL_SUPREMUM:
        return {**named, "x": [SPEEDS[-1], SPEEDS[0]], "y": values * 2, "dash": "5 3"}
    return {**named, "x": list(curve.v), "y": values, "marks": True}


def _name_reading(curve: ConditioningCurve) -> str:
    """Name the peaks that count: at any slip speed ("literal supremum"), or only at resolved ones ("as integrated")."""
    return curve.reading if curve.reading == LITERAL_SUPREMUM else f"{curve.reading} at {curve.speed}"


def conditioning_tables(curves: Sequence[ConditioningCurve]) -> list[dict[str, Any]]:
    """
    Return tables of amplification statistics, one for all curves at the same speeds or yield displacements.

    Their last column is rigid friction in the limit of zero slip speed.
    """
    suprema = {_owner_of_curve(curve): curve for curve in curves if curve.reading == LITERAL_SUPREMUM}
    tables = []
    integrated = [curve for curve in curves if curve.reading != LITERAL_SUPREMUM]
    for speed, v in sorted(dict.fromkeys((curve.speed, curve.v) for curve in integrated), key=_place_of_table):
        rows = [
            _table_row(curve, quantity, suprema.get(_owner_of_curve(curve, curve.base)))
            for curve in integrated
            if (curve.speed, curve.v) == (speed, v)
            for quantity in QUANTITIES
        ]
        tables.append({"speed": speed, "unit": UNITS[speed], "heads": [*map(speed_text, v)], "rows": rows})
    return tables


def _place_of_table(table: tuple[str, tuple[float, ...]]) -> int:
    """Return a table's place in the order cutoff speed v_c, regularization speed v_reg, yield displacement u_y."""
    return [*UNITS].index(table[0])


def _owner_of_curve(curve: ConditioningCurve, model: str = "") -> tuple[str, int, str, int, float | None]:
    """Return (scene, body, model, grid, damping), equal for a curve and for its limit, the literal supremum."""
    return curve.scene, curve.body, model or curve.model, curve.grid, curve.damping


def _table_row(curve: ConditioningCurve, quantity: str, supremum: ConditioningCurve | None) -> dict[str, Any]:
    """
    Return a table row: a statistic of the amplification at each speed or yield displacement.

    The last cell is the same statistic of `supremum`, empty without it.
    """
    write = signed if quantity == "relative_mean" else significant
    values = [*getattr(curve, quantity), *([] if supremum is None else getattr(supremum, quantity))]
    errors = getattr(curve, quantity.removesuffix("_mean") + "_error")
    return {
        "curve": curve,
        "name": NAMES[curve.model] + (f", {name_damping(curve)}" if curve.speed == "u_y" else ""),
        "phases": f"{curve.grid} × {curve.grid}" if curve.grid else f"{curve.pairs} pairs",
        "quantity": QUANTITIES[quantity],
        "cells": [(value, write(value)) for value in values] + ([(None, "")] if supremum is None else []),
        "error": (max(errors), scientific(max(errors))),
    }


FOUND = ResultField(  # field of summary.json with the result of this analysis
    name=Conditioning.key,
    kind=list[ConditioningCurve],
    meaning="mu over the smallest resolved speed, and its literal supremum; null if not computed",
)


def _section_context(report: Report) -> Mapping[str, Any]:
    """Return template variables of the section on amplification at falling slip speeds: its plots and tables."""
    curves = FOUND.read_from(report.results)
    return {
        "conditioning_panels": conditioning_panels(curves),
        "conditioning_tables": conditioning_tables(curves),
    }


def _write_lead(results: Results) -> str:
    """Return the sentences on the conditioning of the amplification for the first screen of the report."""
    curves = FOUND.read_from(results)
    return f"{conditioning_line(curves)} {yielding_line(curves)}".strip()


# Registration of this analysis with the program: field of summary.json, computation, section of the report
FEATURE = Feature(
    key=Conditioning.key,
    fields=(FOUND,),
    analysis=Conditioning(),
    section=Section(
        title="Conditioning of the literal supremum",
        absent="phase-resonance run makes it, of scenes with phases and dry friction",
        context=_section_context,
        lead=_write_lead,
    ),
)
