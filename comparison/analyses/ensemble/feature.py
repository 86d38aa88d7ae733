"""Demands under many motions: in the report."""

from __future__ import annotations

from typing import Any

from comparison.analyses.ensemble.result import STORED, StoredCurve, StoredEnsemble
from comparison.report.plots import DEMANDS, Panel
from comparison.report.section import Feature, Section


def ensemble_panels(ensemble: StoredEnsemble) -> list[Panel]:
    """One panel for each demand that is drawn: every motion over its scale, the fractiles, and the engine."""
    top = ("acceleration", ensemble.bodies, "acceleration of the uppermost body", "m/s²", 1.0)
    panels = []
    for quantity, number, title, unit, factor in (*DEMANDS, *([top] if ensemble.bodies > 1 else [])):
        shown = quantity, number or None
        stripes = [stripe for stripe in ensemble.stripes if (stripe.quantity, stripe.body) == shown]
        if not stripes:
            continue
        curves = [curve for curve in ensemble.curves if (curve.quantity, curve.body) == shown]
        motions = [curve for curve in curves if curve.model != ensemble.engine.model]
        series = [
            {
                **_over_scales(curve, factor),
                "name": "one motion",
                "color": "gray",
                "width": 0.8,
                "legend": curve is motions[0],
            }
            for curve in motions
        ]
        low, median, high = ([_scaled(stripe.fractiles[n].value, factor) for stripe in stripes] for n in range(3))
        shares = [f"{100.0 * each.share:.0f} %" for each in stripes[0].fractiles]
        fractiles = {"name": f"median, {shares[0]} to {shares[2]}", "y": median, "low": low, "high": high, "band": True}
        series.append({**fractiles, "x": [stripe.scale for stripe in stripes], "color": 0, "marks": True, "width": 2.4})
        asked = [curve for curve in curves if curve.model == ensemble.engine.model]
        series += [
            {
                **_over_scales(curve, factor),
                "name": "engine",
                "color": 1,
                "marks": True,
                "line": False,
                "legend": curve is asked[0],
            }
            for curve in asked
        ]
        axes = {"x": {"title": "scale factor of the motion"}, "y": {"title": f"{title}, {unit}"}}
        label = f"{title} of {ensemble.scene} over the scale factor of {ensemble.motions} motions"
        panels.append({"title": title, "plot": {"label": label, **axes, "series": series}})
    return panels


def _over_scales(curve: StoredCurve, factor: float) -> dict[str, Any]:
    values = [_scaled(value, factor) for value in curve.values]
    return {"x": list(curve.scales), "y": values, "titles": [f"{curve.motion}, {scale:g}" for scale in curve.scales]}


def _scaled(value: float | None, factor: float) -> float | None:
    return None if value is None else factor * value


FEATURE = Feature(
    "ensemble",
    StoredEnsemble,
    "demands under many motions at many scales; null unless python -m comparison.ensemble left it beside the report",
    load=STORED.load,
    section=Section(
        "Demands under many motions",
        "python -m comparison.ensemble SCENE makes it, beside the report; the next run of the study shows it",
        lambda report, figures: {"ensemble_panels": ensemble_panels(report.results.of("ensemble"))},
    ),
)
