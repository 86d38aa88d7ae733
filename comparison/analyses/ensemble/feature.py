"""Demands under many motions: in the report."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from comparison.analyses.ensemble.result import STORED, Curve, EnsembleResult
from comparison.analyses.ensemble.units import (
    band,
    figures_of,
    fractiles_of,
    scaled,
    shown_stripes,
    title_of,
    unit_for_reading,
)
from comparison.report.plots import Panel
from comparison.report.section import Feature, Report, Section
from comparison.study.models import EXACT
from reference.problem import GRAVITY

SHOWN = ("displacement", "residual", "base_shear", "uplift", "support_force_max")
WIDTH = 0.3  # of a strip, in steps from one structure to the next


def ensemble_panels(ensemble: EnsembleResult) -> list[Panel]:
    """Isolator, base shear and supports over the scale or as strips; profiles over the height; floor spectra."""
    if not ensemble.curves:
        return []
    panels = [_panel(ensemble, quantity) for quantity in SHOWN if any(c.quantity == quantity for c in ensemble.curves)]
    return [*panels, *_profiles(ensemble), *_spectra(ensemble)]


def _panel(ensemble: EnsembleResult, quantity: str) -> Panel:
    one, series = len(ensemble.scales) == 1, []
    for place, structure in enumerate(ensemble.structures):
        unit, factor = unit_for_reading(quantity, structure.weight)
        motions, asked = ensemble.curves_of(structure.name, quantity)
        look = {"color": place, "name": f"{structure.name}: one motion", "legend": False}
        if one:
            series += _strips(motions, factor, place, {**look, "legend": True})
        else:
            series += [{**_over_scales(curve, factor), **look, "width": 0.7} for curve in motions]
        stripes = ensemble.stripes_of(structure.name, quantity)
        low, median, high = fractiles_of(stripes, factor)
        values = {"name": f"{structure.name}: median, 16 % to 84 %", "y": median, "low": low, "high": high}
        x = [place + WIDTH if one else stripe.scale for stripe in stripes]
        series.append({**values, "x": x, "color": place, "band": not one, "marks": True, "line": not one, "width": 2.4})
        name = f"{structure.name}: engine"
        if one:
            series += _strips(asked, factor, place - WIDTH, {"color": "ink", "name": name})
        else:
            looks = {"name": name, "color": "ink", "marks": True, "line": False}
            series += [{**_over_scales(curve, factor), **looks, "legend": curve is asked[0]} for curve in asked]
    title = title_of((quantity, None))
    names = [[n, structure.name] for n, structure in enumerate(ensemble.structures)]
    x_axis = {"title": "", "ticks": names, "range": [-0.6, len(names) - 0.4]} if one else {
        "title": "scale factor of the motion", "range": [0.0, 1.04 * max(ensemble.scales)]
    }  # fmt: skip
    y_axis = {"title": f"{title}, {unit}", "range": [0.0, _top(series)]}
    over = "by scene" if one else "over the scale factor"
    label = f"{title} {over}, {ensemble.motions} motions"
    return {"title": title, "plot": {"label": label, "x": x_axis, "y": y_axis, "series": series}}


def _strips(curves: Sequence[Curve], factor: float, place: float, look: dict[str, Any]) -> list[dict[str, Any]]:
    """A dot for every motion, side by side."""
    if not curves:
        return []
    spread = [place + WIDTH * ((n + 0.5) / len(curves) - 0.5) for n in range(len(curves))]
    values = [scaled(curve.values[0], factor) for curve in curves]
    titles = [curve.motion for curve in curves]
    return [{"x": spread, "y": values, "titles": titles, "marks": True, "line": False, **look}]


def _profiles(ensemble: EnsembleResult) -> list[Panel]:
    """Median and band of accelerations and drifts over the bodies, at the largest scale."""
    top, panels = max(ensemble.scales), []
    for quantity in ("acceleration", "drift"):
        series = []
        for place, structure in enumerate(ensemble.structures):
            unit, factor = unit_for_reading(quantity, structure.weight)
            rows = ensemble.profile(structure.name, quantity)
            low, median, high = fractiles_of(rows, factor)
            values = {"x": [s.body for s in rows], "y": median, "low": low, "high": high, "band": True, "marks": True}
            series.append({"name": f"{structure.name}: median, 16 % to 84 %", "color": place, **values})
        if any(each["x"] for each in series):
            ticks = [[n, str(n)] for n in range(1, max(each.bodies for each in ensemble.structures) + 1)]
            x_axis = {"title": "body, from the platform up", "ticks": ticks}
            title = {"acceleration": "acceleration over the height", "drift": "drift over the height"}[quantity]
            y_axis = {"title": f"{quantity}, {unit}", "range": [0.0, _top(series)]}
            label = f"{title}, {ensemble.motions} motions at scale {top:g}"
            panels.append({"title": title, "plot": {"label": label, "x": x_axis, "y": y_axis, "series": series}})
    return panels


def _spectra(ensemble: EnsembleResult) -> list[Panel]:
    """Floor spectra of platform and uppermost body: median and band."""
    panels = []
    tops = {structure.name: structure.bodies for structure in ensemble.structures}
    for title, body_of in (("platform", lambda name: 1), ("top", tops.__getitem__)):
        series = []
        for place, structure in enumerate(ensemble.structures):
            for spectrum in ensemble.spectra:
                if (spectrum.structure, spectrum.body) == (structure.name, body_of(structure.name)):
                    low, median, high = band(spectrum.fractiles, 1.0 / GRAVITY)
                    values = {"x": list(spectrum.period), "y": median, "low": low, "high": high, "band": True}
                    series.append({"name": f"{structure.name}: median, 16 % to 84 %", "color": place, **values})
        if series and (title == "platform" or max(tops.values()) > 1):
            damping = f"{100.0 * ensemble.spectra[0].damping:g} % damping"
            y_axis = {"title": f"pseudo-acceleration, {damping}, g", "range": [0.0, _top(series)]}
            axes = {"x": {"title": "period, s", "log": True}, "y": y_axis}
            label = f"floor spectrum of the {title}, {ensemble.motions} motions"
            panels.append({"title": f"floor spectrum: {title}", "plot": {"label": label, **axes, "series": series}})
    return panels


def _top(series: Sequence[dict[str, Any]]) -> float:
    """Upper end of an axis that starts at zero."""
    values = [value for each in series for key in ("y", "high") for value in each.get(key, ()) if value is not None]
    return 1.06 * max(values, default=0.0) or 1.0


def _over_scales(curve: Curve, factor: float) -> dict[str, Any]:
    values = [scaled(value, factor) for value in curve.values]
    return {"x": list(curve.scales), "y": values, "titles": [f"{curve.motion}, {scale:g}" for scale in curve.scales]}


def demand_rows(ensemble: EnsembleResult) -> list[dict[str, Any]]:
    """Rows of the table of demands: those of every structure at the largest scale first, then the other scales."""
    rows = []
    for scale in sorted(ensemble.scales, reverse=True):
        for structure in ensemble.structures:
            for stripe in shown_stripes(ensemble.stripes, structure.name, scale):
                unit, factor = unit_for_reading(stripe.quantity, structure.weight)
                name = title_of((stripe.quantity, stripe.body))
                model = "" if stripe.model == EXACT.key else f" ({stripe.model} engine)"
                cells = [
                    _text(each, factor) for each in (stripe.mean, *stripe.fractiles, stripe.largest, stripe.smallest)
                ]
                about = {"scene": structure.name, "name": f"{name}{model}", "unit": unit, "scale": scale}
                rows.append({**about, "cells": cells, "stripe": stripe})
    return rows


def _text(number: Any, factor: float) -> str:
    """A value with its error, which may be unknown."""
    if number.value is None:
        return "none"
    error = "" if number.error is None else f" ± {factor * number.error:.1g}"
    return f"{figures_of(factor * number.value)}{error}"


def _context(report: Report, figures: Path) -> Mapping[str, Any]:
    ensemble = report.results.of("ensemble")
    return {"ensemble_panels": ensemble_panels(ensemble), "ensemble_rows": demand_rows(ensemble)}


FEATURE = Feature(
    "ensemble",
    EnsembleResult,
    "demands under many motions at many scales; null unless python -m comparison.ensemble left it beside the report",
    load=STORED.load,
    section=Section(
        "Demands under many motions",
        "python -m comparison.ensemble SCENE makes it, beside the report; the next run of the study shows it",
        _context,
    ),
)
