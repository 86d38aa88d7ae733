"""The plots of an ensemble: isolator over scale or motions, profiles over the height, floor and ground spectra."""

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import Any

import numpy as np

from comparison.analyses.ensemble.quantities import SUPREMUM, title_of, unit_for_reading
from comparison.analyses.ensemble.result import DemandCurve, EnsembleResult, Statistic, Structure
from comparison.analyses.ensemble.rows import HEIGHTS, floor_of, labels
from comparison.analyses.ensemble.sentences import motions_in_words
from comparison.report.panels import Panel, make_panel
from reference.problem import GRAVITY

SHOWN = ("displacement", "residual", "base_shear", "uplift", "support_force_max")
PERIOD = {"title": "period, s", "log": True}  # an axis
WIDTH = 0.3  # width of a strip, in steps from one structure to the next
FRACTILE_LINES = (("16 %", 0, "2 2"), ("50 %", 1, ""), ("84 %", 2, "7 3"))
HEIGHT_AXIS = "height above the sliding contact, m"


def isolator_panels(ensemble: EnsembleResult) -> list[Callable[[], Panel]]:
    """Demands of the isolator over the scale or as strips, a dot or a line for every motion."""
    moved = {curve.quantity for curve in ensemble.curves if any(curve.values)}  # nothing is drawn of zeros alone
    shown = [quantity for quantity in SHOWN if quantity in moved]
    return [partial(_demand_panel, ensemble, quantity) for quantity in shown]


def height_panels(ensemble: EnsembleResult) -> list[Callable[[], Panel]]:
    """Fractiles of accelerations, drifts, shears and moments over the height."""
    shown = [name for name in HEIGHTS if any(ensemble.profile(each.name, name) for each in ensemble.structures)]
    return [
        partial(_profile_panel, ensemble, name)
        for name in shown
        if name != SUPREMUM and not (name == "drift" and "drift_ratio" in shown)
    ]


def floor_spectra_panels(ensemble: EnsembleResult) -> list[Callable[[], Panel]]:
    """Floor spectra of platform and uppermost body: median and band."""
    titles = ("platform", "top") if max(each.bodies for each in ensemble.structures) > 1 else ("platform",)
    return [partial(_floor_spectrum, ensemble, title) for title in titles if ensemble.spectra]


def ground_panels(ensemble: EnsembleResult) -> list[Callable[[], Panel]]:
    """Response spectra of the motions with their factors, at scale 1, and the target."""
    return [partial(_ground_spectra, ensemble)] if ensemble.target else []


def _demand_panel(ensemble: EnsembleResult, quantity: str) -> Panel:
    one = len(ensemble.scales) == 1
    series: list[dict[str, Any]] = []
    by_engine: list[dict[str, Any]] = []
    for place, structure in enumerate(ensemble.structures):
        name, (unit, factor) = structure.name, unit_for_reading(quantity, structure.weight)
        motions, engine = (ensemble.curves_of(name, quantity, model) for model in ("exact", ensemble.engine.model))
        look: dict[str, Any] = {"name": f"{labels(ensemble)[name]}: one motion", "color": place, "legend": False}
        look |= {"marks": True, "line": False} if one else {"width": 0.7}
        series += _motion_series(motions, factor, place if one else None, **look)
        if stripes := ensemble.stripes_of(name, quantity):
            x = [place + WIDTH if one else stripe.scale for stripe in stripes]
            fractiles = zip(*(stripe.fractiles for stripe in stripes))
            series.append(_median_line(ensemble, place, x, fractiles, factor, band=not one, line=not one))
        look = {"name": f"{ensemble.engine.model} engine", "color": "ink", "marks": True, "line": False}
        look |= {"legend": False} if by_engine else {}
        by_engine += _motion_series(engine, factor, place - WIDTH if one else None, **look)
    title = title_of(quantity)
    places = range(len(ensemble.structures))
    bounds = list(labels(ensemble).values())
    strips = {"title": "", "ticks": [[place, bounds[place]] for place in places], "range": [-0.6, len(places) - 0.4]}
    scales = {"title": "scale factor of the motion", "range": [0.0, 1.04 * ensemble.top]}
    label = f"{title} {'by bound' if one else 'over the scale factor'}, {motions_in_words(ensemble.motions)}"
    series += by_engine
    return make_panel(title, label, strips if one else scales, _from_zero(f"{title}, {unit}", series), series)


def _motion_series(
    curves: Sequence[DemandCurve], factor: float, place: float | None, **look: Any
) -> list[dict[str, Any]]:
    """The motions, each over its scales, or all side by side about a place; dots have their errors."""
    series = []
    for number, curve in enumerate(curves):
        x = list(curve.scales) if place is None else [place + WIDTH * ((number + 0.5) / len(curves) - 0.5)]
        line = {"x": x, "y": [_scale_value(value, factor) for value in curve.values], "legend": number == 0} | look
        for key, side in (("low", -1.0), ("high", 1.0)) if "line" in look else ():
            both = zip(curve.values, curve.errors)
            line[key] = [None if None in pair else factor * (pair[0] + side * pair[1]) for pair in both]  # type: ignore[operator]
        series.append({**line, "titles": [f"{curve.motion}, {scale:g}" for scale in curve.scales]})
    return series


def _median_line(
    ensemble: EnsembleResult,
    place: int,
    x: list[Any],
    fractiles: Iterable[Sequence[Statistic]],
    factor: float,
    **look: Any,
) -> dict[str, Any]:
    """Median of a structure with its band, from low, median and high at every x."""
    columns = zip(("low", "y", "high"), fractiles)
    numbers = {key: [_scale_value(each.value, factor) for each in column] for key, column in columns}
    name = labels(ensemble)[ensemble.structures[place].name]
    return {"name": name, "color": place, "x": x, **numbers, "band": True, "marks": True, "width": 2.4, **look}


def _profile_panel(ensemble: EnsembleResult, quantity: str) -> Panel:
    """Fractiles of a demand along x, and the height along y."""
    series, unit, heights = [], "", True
    for place, structure in enumerate(ensemble.structures):
        unit, factor = unit_for_reading(quantity, structure.weight)
        rows = ensemble.profile(structure.name, quantity)
        places, stated = _body_heights(structure)
        heights = heights and stated
        for share, number, dash in FRACTILE_LINES:
            values = [row.fractiles[number].value for row in rows]
            line: dict[str, Any] = {
                "name": f"{labels(ensemble)[structure.name]}, {share}", "color": place,
                "width": 2.4 if share == "50 %" else 1.2,
                "x": [None if value is None else factor * value for value in values],
                "y": [places[(row.body or 1) - 1] for row in rows], "marks": share == "50 %",
                "titles": [
                    f"{floor_of(structure, row.body or 1)}: {'none' if value is None else f'{factor * value:.4g}'}"
                    for row, value in zip(rows, values)
                ],
            }  # fmt: skip
            series.append(line | ({"dash": dash} if dash else {}))
    largest = max((value for each in series for value in each["x"] if value is not None), default=0.0)
    x = {"title": f"{title_of(quantity)}, {unit}", "range": [0.0, 1.06 * largest or 1.0]}
    y: dict[str, Any] = {"title": HEIGHT_AXIS} if heights else {"title": "body, from the platform up"}
    if not heights:
        y["ticks"] = [[n, str(n)] for n in range(1, max(each.bodies for each in ensemble.structures) + 1)]
    label = f"{title_of(quantity)} over the height: 16, 50 and 84 %, {motions_in_words(ensemble.motions)}"
    return make_panel(f"{title_of(quantity)} over the height", label, x, y, series)


def _body_heights(structure: Structure) -> tuple[list[float], bool]:
    """Heights of the bodies, m, and True; or their numbers, and False."""
    heights = structure.building.heights if structure.building else None
    return (list(heights), True) if heights else ([float(n) for n in range(1, structure.bodies + 1)], False)


def _floor_spectrum(ensemble: EnsembleResult, title: str) -> Panel:
    series = [
        _median_line(ensemble, place, list(spectrum.period), spectrum.fractiles, 1.0 / GRAVITY, marks=False)
        for place, structure in enumerate(ensemble.structures)
        for spectrum in ensemble.spectra
        if (spectrum.structure, spectrum.body) == (structure.name, 1 if title == "platform" else structure.bodies)
    ]
    quantity = f"pseudo-acceleration, {100.0 * ensemble.spectra[0].damping:g} % damping, g"
    label = f"floor spectrum of the {title}, {motions_in_words(ensemble.motions)}"
    return make_panel(f"floor spectrum: {title}", label, PERIOD, _from_zero(quantity, series), series)


def _ground_spectra(ensemble: EnsembleResult) -> Panel:
    target = ensemble.target
    assert target is not None
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
    label = f"response spectra of the ground and their target, {motions_in_words(ensemble.motions)} at scale 1"
    return make_panel("response spectra of the ground", label, PERIOD, y, series)


def _from_zero(title: str, series: Sequence[dict[str, Any]]) -> dict[str, Any]:
    values = [value for each in series for key in ("y", "high") for value in each.get(key, ()) if value is not None]
    return {"title": title, "range": [0.0, 1.06 * max(values, default=0.0) or 1.0]}


def _scale_value(value: float | None, factor: float) -> float | None:
    return None if value is None else factor * value
