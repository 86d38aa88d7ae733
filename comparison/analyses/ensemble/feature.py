"""Demands under many motions as engineers read them: in the report, on the terminal and as a picture."""

import re
import textwrap
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from comparison.analyses.ensemble.result import (
    STORED,
    DemandCurve,
    DemandDifference,
    EnsembleResult,
    Statistic,
    Stripe,
    Structure,
    Target,
)
from comparison.report.feature import Feature, ResultField
from comparison.report.panels import draw_panels, panel
from comparison.report.plots import Panel
from comparison.report.section import Section
from comparison.study.models import EXACT, SPATIAL
from comparison.wording import percent
from reference.measures.peak_demands import QUANTITIES, unit_of
from reference.problem import GRAVITY

SHOWN = ("displacement", "residual", "base_shear", "uplift", "support_force_max")
OF_BODY = {"acceleration": "acceleration of body {}", "drift": "drift below body {}", "torsion": "rotation of body {}"}
NAMED = 6  # motions of the engine that are named one by one
PERIOD = {"title": "period, s", "log": True}  # an axis
UNSEEN = 5e-5  # share of a value: a smaller error is not seen in four digits
WIDTH = 0.3  # width of a strip, in steps from one structure to the next
READ = {"m": ("mm", 1e3), "N": ("kN", 1e-3), "J": ("kJ", 1e-3), "rad": ("mrad", 1e3), "m/s^2": ("g", 1.0 / GRAVITY)}


def title_of(quantity: str, body: int | None = None) -> str:
    """A demand in words."""
    return OF_BODY[quantity].format(body) if body else QUANTITIES[quantity][0]


def unit_for_reading(quantity: str, weight: float) -> tuple[str, float]:
    """The unit in which a demand is read, and its factor; weight: of the structure, N."""
    if quantity == "base_shear":
        return "% of the weight", 100.0 / weight
    unit = unit_of(quantity)
    return ("%", 100.0) if quantity.endswith("_share") else READ.get(unit, (unit, 1.0))


def ensemble_panels(ensemble: EnsembleResult) -> list[Panel]:
    """Isolator, base shear and supports over the scale or as strips; profiles over the height; floor spectra."""
    shown = [quantity for quantity in SHOWN if any(curve.quantity == quantity for curve in ensemble.curves)]
    panels = [_panel(ensemble, quantity) for quantity in shown]
    return [*panels, *_profiles(ensemble), *_spectra(ensemble), *_spectra_panels(ensemble)] if ensemble.curves else []


def draw_ensemble(path: Path, ensemble: EnsembleResult) -> None:
    """Write the panels to `path`, PNG, and as PDF."""
    names = textwrap.shorten(
        ", ".join(dict.fromkeys(each.title for each in ensemble.structures)), 110, placeholder="..."
    )
    draw_panels(path, f"{names}\n{_motions(ensemble)}: median, 16 % to 84 %", ensemble_panels(ensemble))


def _motions(ensemble: EnsembleResult) -> str:
    return f"{ensemble.motions} motion{'' if ensemble.motions == 1 else 's'}"


def heading(ensemble: EnsembleResult, structure: Structure, scale: float) -> str:
    """Structure, number of motions, and the scale where there are several."""
    at = f", scale {scale:g}" if len(ensemble.scales) > 1 or scale != 1.0 else ""
    return f"{structure.title} ({labels(ensemble)[structure.name]}): {_motions(ensemble)}{at}"


def labels(ensemble: EnsembleResult) -> dict[str, str]:
    """Return what tells the structures apart, by their names: of those of one file the values in which they differ."""
    names = [each.name for each in ensemble.structures]
    files, values = zip(*(name.rstrip("]").partition("[")[::2] for name in names))
    parts = [re.split(r", |\+(?!\d)", text) for text in values]
    columns = [column for column in zip(*parts) if len({*column}) > 1]
    alike = len({*files}) == 1 and len({len(part) for part in parts}) == 1 and columns
    return dict(zip(names, (", ".join(row) for row in zip(*columns)) if alike else names))


def _panel(ensemble: EnsembleResult, quantity: str) -> Panel:
    one = len(ensemble.scales) == 1
    series: list[dict[str, Any]] = []
    by_engine: list[dict[str, Any]] = []
    for place, structure in enumerate(ensemble.structures):
        name, (unit, factor) = structure.name, unit_for_reading(quantity, structure.weight)
        motions, engine = ensemble.curves_of(name, quantity)
        look: dict[str, Any] = {"name": f"{labels(ensemble)[name]}: one motion", "color": place, "legend": False}
        look |= {"marks": True, "line": False} if one else {"width": 0.7}
        series += _values(motions, factor, place if one else None, **look)
        if stripes := ensemble.stripes_of(name, quantity):
            x = [place + WIDTH if one else stripe.scale for stripe in stripes]
            fractiles = zip(*(stripe.fractiles for stripe in stripes))
            series.append(_median(ensemble, place, x, fractiles, factor, band=not one, line=not one))
        look = {"name": "engine", "color": "ink", "marks": True, "line": False}
        look |= {"legend": False} if by_engine else {}
        by_engine += _values(engine, factor, place - WIDTH if one else None, **look)
    title = title_of(quantity)
    places = range(len(ensemble.structures))
    strips = {"title": "", "ticks": [[place, ""] for place in places], "range": [-0.6, len(places) - 0.4]}
    scales = {"title": "scale factor of the motion", "range": [0.0, 1.04 * max(ensemble.scales)]}
    label = f"{title} {'by scene' if one else 'over the scale factor'}, {_motions(ensemble)}"
    series += by_engine
    return panel(title, label, strips if one else scales, _from_zero(f"{title}, {unit}", series), series)


def _values(curves: Sequence[DemandCurve], factor: float, place: float | None, **look: Any) -> list[dict[str, Any]]:
    """The motions, each over its scales, or all side by side about a place; dots have their errors."""
    series = []
    for number, curve in enumerate(curves):
        x = list(curve.scales) if place is None else [place + WIDTH * ((number + 0.5) / len(curves) - 0.5)]
        line = {"x": x, "y": [_scale(value, factor) for value in curve.values], "legend": number == 0} | look
        for key, side in (("low", -1.0), ("high", 1.0)) if "line" in look else ():
            both = zip(curve.values, curve.errors)
            line[key] = [None if None in pair else factor * (pair[0] + side * pair[1]) for pair in both]  # type: ignore[operator]
        series.append({**line, "titles": [f"{curve.motion}, {scale:g}" for scale in curve.scales]})
    return series


def _median(
    ensemble: EnsembleResult,
    place: int,
    x: list[Any],
    fractiles: Iterable[Sequence[Statistic]],
    factor: float,
    **look: Any,
) -> dict[str, Any]:
    """Median of a structure with its band, from low, median and high at every x."""
    columns = zip(("low", "y", "high"), fractiles)
    numbers = {key: [_scale(each.value, factor) for each in column] for key, column in columns}
    name = labels(ensemble)[ensemble.structures[place].name]
    return {"name": name, "color": place, "x": x, **numbers, "band": True, "marks": True, "width": 2.4, **look}


def _profiles(ensemble: EnsembleResult) -> list[Panel]:
    """Median and band of accelerations and drifts over the bodies, at the largest scale."""
    panels = []
    for quantity in ("acceleration", "drift"):
        series = []
        for place, structure in enumerate(ensemble.structures):
            unit, factor = unit_for_reading(quantity, structure.weight)
            if rows := ensemble.profile(structure.name, quantity):
                fractiles = zip(*(row.fractiles for row in rows))
                series.append(_median(ensemble, place, [row.body for row in rows], fractiles, factor))
        if series:
            ticks = [[n, str(n)] for n in range(1, max(each.bodies for each in ensemble.structures) + 1)]
            axes = {"title": "body, from the platform up", "ticks": ticks}, _from_zero(f"{quantity}, {unit}", series)
            label = f"{quantity} over the height, {_motions(ensemble)} at scale {max(ensemble.scales):g}"
            panels.append(panel(f"{quantity} over the height", label, *axes, series))
    return panels


def _spectra(ensemble: EnsembleResult) -> list[Panel]:
    """Floor spectra of platform and uppermost body: median and band."""
    panels = []
    for title in ("platform", "top"):
        series = [
            _median(ensemble, place, list(spectrum.period), spectrum.fractiles, 1.0 / GRAVITY, marks=False)
            for place, structure in enumerate(ensemble.structures)
            for spectrum in ensemble.spectra
            if (spectrum.structure, spectrum.body) == (structure.name, 1 if title == "platform" else structure.bodies)
        ]
        if series and (title == "platform" or max(each.bodies for each in ensemble.structures) > 1):
            quantity = f"pseudo-acceleration, {100.0 * ensemble.spectra[0].damping:g} % damping, g"
            label = f"floor spectrum of the {title}, {_motions(ensemble)}"
            panels.append(panel(f"floor spectrum: {title}", label, PERIOD, _from_zero(quantity, series), series))
    return panels


def target_sentence(target: Target) -> str:
    """Return what the motions are scaled to."""
    between = f"from {target.low:.3g} to {target.high:.3g} s, in the logarithm, at 5 % damping"
    return f"Scale 1 is that of the target spectrum: least squares over periods {between}."


def isolator_sentence(structure: Structure) -> str:
    """The effective isolator of a structure; "" without one."""
    if (at := structure.isolator) is None:
        return ""
    return (
        f"Effective isolator of design codes at the {at.statistic} displacement, {1e3 * at.displacement:.4g} mm: "
        f"period {at.period:.3g} s, damping {percent(at.damping)}, re-centering ratio {at.restoring:.3g}."
    )


def largest_differences(ensemble: EnsembleResult) -> list[tuple[str, float | None, float | None, float | None]]:
    """Every demand with its largest difference over the structures, that like for like, and its error."""
    found: dict[str, list[DemandDifference]] = {}
    for each in ensemble.engine.differences:
        if each.points:
            found.setdefault(title_of(each.quantity, each.body), []).append(each)
    rows = []
    for name, own in found.items():
        worst = max(own, key=lambda each: each.like_for_like or 0.0)
        largest = max((each.largest for each in own if each.largest is not None), default=None)
        rows.append((name, largest, worst.like_for_like, worst.errors))
    return rows


def agreement_sentence(ensemble: EnsembleResult) -> str:
    """Return how closely both codes agree under the same friction law."""
    engine = ensemble.engine
    ran = ", ".join(
        dict.fromkeys(f"{point.get('motion', point['scene'])} ({point['status']})" for point in engine.points[:NAMED])
    )
    more = f" and {len(engine.points) - NAMED} more" if len(engine.points) > NAMED else ""
    known = [(size, name) for name, _, size, _ in largest_differences(ensemble) if size is not None]
    title = f"The {engine.model} engine computed {len(engine.points)} of the motions: {ran}{more}. "
    title += f"It was asked for largest accelerations to {percent(engine.tolerance)}."
    if not known:
        return title
    size, name = max(known)
    agreement = f"Given the same friction law, the two codes agree to {percent(size)} or better"
    if engine.model == SPATIAL.key:
        agreement = f"Its bodies turn; given the same friction law, it is within {percent(size)} of the equations"
    return f"{title} {agreement} (worst: {name})."


def _spectra_panels(ensemble: EnsembleResult) -> list[Panel]:
    """Response spectra of the motions with their factors, at scale 1, and the target."""
    if (target := ensemble.target) is None:
        return []
    x = list(target.period)
    motions = [
        {"x": x, "y": [value / GRAVITY for value in each.acceleration], "name": "one motion", "color": 0, "width": 0.7}
        for each in target.motions
    ]
    series = [{**line, "legend": number == 0} for number, line in enumerate(motions)]
    mean = np.exp(np.log([each.acceleration for each in target.motions]).mean(axis=0)) / GRAVITY
    series.append({"x": x, "y": mean.tolist(), "name": "geometric mean of the motions", "color": 0, "width": 2.4})
    wanted = [value / GRAVITY for value in target.acceleration]
    series.append({"x": x, "y": wanted, "name": "target", "color": "ink", "width": 2.4})
    y = _from_zero("pseudo-acceleration, 5 % damping, g", series)
    label = f"response spectra of the ground and their target, {_motions(ensemble)} at scale 1"
    return [panel("response spectra of the ground", label, PERIOD, y, series)]


def _from_zero(title: str, series: Sequence[dict[str, Any]]) -> dict[str, Any]:
    values = [value for each in series for key in ("y", "high") for value in each.get(key, ()) if value is not None]
    return {"title": title, "range": [0.0, 1.06 * max(values, default=0.0) or 1.0]}


def _scale(value: float | None, factor: float) -> float | None:
    return None if value is None else factor * value


def demand_rows(ensemble: EnsembleResult, structure: Structure, scale: float) -> list[dict[str, Any]]:
    """The table of demands of a structure at a scale, in the order of QUANTITIES; by the engine what is its alone."""

    def place(stripe: Stripe) -> tuple[int, int]:
        return [*QUANTITIES].index(stripe.quantity), stripe.body or 0

    own, rows = [each for each in ensemble.stripes if (each.structure, each.scale) == (structure.name, scale)], []
    known = {place(each): each for each in reversed(own)}  # by the equations, which come first, if they have it
    for stripe in (known[key] for key in sorted(known)):
        unit, factor = unit_for_reading(stripe.quantity, structure.weight)
        model = "" if stripe.model == EXACT.key else f" ({stripe.model} engine)"
        name, cells = title_of(stripe.quantity, stripe.body), [text_of(each, factor) for each in stripe.statistics]
        rows.append({"name": f"{name}{model}", "unit": unit, "cells": cells, "stripe": stripe})
    return rows


def text_of(number: Statistic, factor: float) -> str:
    """A value to four digits without power of ten, with its error where these digits show it."""
    if number.value is None:
        return "none"
    value = factor * number.value
    digits = f"{value:.4g}" if abs(value) < 1e4 else f"{float(f'{value:.4g}'):.0f}"
    return (
        digits
        if number.error is None or factor * number.error <= UNSEEN * abs(value)
        else f"{digits} ± {float(f'{factor * number.error:.1g}'):g}"
    )


FOUND = ResultField(
    "ensemble",
    EnsembleResult,
    STORED.word_field("demands under many motions at many scales"),
    load=STORED.load,
)
FEATURE = Feature(
    "ensemble",
    (FOUND,),
    section=Section(
        "Demands under many motions",
        STORED.word_origin(" SCENE"),
        lambda report: {
            "ensemble_panels": ensemble_panels(FOUND.of(report.results)),
            "demand_rows": demand_rows,
            "agreement_sentence": agreement_sentence,
            "heading": heading,
            "isolator_sentence": isolator_sentence,
            "labels": labels(FOUND.of(report.results)),
            "target_sentence": target_sentence,
            "title_of": title_of,
        },
    ),
)
