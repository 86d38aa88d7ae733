"""
Plots of an ensemble: demands of the isolator, profiles of demands over the height, floor and ground spectra.

With several scales the demands of the isolator are lines over the scale, one for each motion. With one scale they are
dots, one for each motion, in a vertical strip for each structure.
"""

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import Any

import numpy as np

from comparison.analyses.ensemble.limits import LIMIT_KEY_PREFIX, MEAN_STATISTIC
from comparison.analyses.ensemble.quantities import SUPREMUM, demand_title, display_unit, word_value
from comparison.analyses.ensemble.result import DemandCurve, EnsembleResult, Statistic, Structure
from comparison.analyses.ensemble.rows import (
    PLATFORM_BODY,
    PROFILE_QUANTITIES,
    label_structures,
    locate_demand,
    name_floor,
)
from comparison.analyses.ensemble.sentences import TRAVEL_REACHED, word_motion_count
from comparison.report.panels import Panel, make_panel
from reference.problem import GRAVITY

PLOTTED_QUANTITIES = ("displacement", "residual", "base_shear", "uplift", "support_force_max")  # isolator demands drawn
PERIOD_TICKS = 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0  # s, periods with a number at the axis
STRIP_WIDTH = 0.3  # width of the strip of a structure's dots, as a share of the distance between strips
# For each fractile: name, index in FRACTILES, dash pattern of its line (SVG)
FRACTILE_LINES = (("16 %", 0, "2 2"), ("50 %", 1, ""), ("84 %", 2, "7 3"))
MEDIAN_MARK, MEAN_MARK, ARROW_MARK = 7, 3, 2  # numbers of marks that plot.js draws: flat bar, diamond, arrow up
MAX_STRETCH = 2.0  # An axis is stretched to show a limit, unless the limit is above so many times the largest value.
HEIGHT_AXIS = "height above the sliding contact, m"  # axis label of profiles


def make_isolator_panels(ensemble: EnsembleResult) -> list[Callable[[], Panel]]:
    """Return functions, one per demand of the isolator, that plot it over the scale or as one dot per motion."""
    # A demand that is zero in every motion is not plotted.
    moved = {curve.quantity for curve in ensemble.curves if any(curve.values)}
    shown = [quantity for quantity in PLOTTED_QUANTITIES if quantity in moved]
    return [partial(_demand_panel, ensemble, quantity) for quantity in shown]


def make_height_panels(ensemble: EnsembleResult) -> list[Callable[[], Panel]]:
    """Return functions, one per demand of the bodies, that plot its fractiles over the height."""
    shown = [
        name
        for name in PROFILE_QUANTITIES
        if any(ensemble.list_demands_of_bodies(each.name, name) for each in ensemble.structures)
    ]
    return [
        partial(_profile_panel, ensemble, name)
        for name in shown
        if name != SUPREMUM and not (name == "drift" and "drift_ratio" in shown)
    ]


def make_floor_spectra_panels(ensemble: EnsembleResult) -> list[Callable[[], Panel]]:
    """Return functions that plot the floor spectra of platform and top body: median, and 16 to 84 % as a band."""
    tallest = max(ensemble.structures, key=lambda each: each.bodies)
    names = {name_floor(tallest, body): body == PLATFORM_BODY for body in (PLATFORM_BODY, tallest.bodies)}
    return [partial(_floor_spectrum, ensemble, *each) for each in names.items() if ensemble.spectra]


def make_ground_panels(ensemble: EnsembleResult) -> list[Callable[[], Panel]]:
    """Return a function that plots the spectra of the ground motions at scale 1 and their target; [] without any."""
    return [partial(_ground_spectra, ensemble)] if ensemble.target or any(m.spectrum for m in ensemble.suite) else []


def _demand_panel(ensemble: EnsembleResult, quantity: str) -> Panel:
    """Return a plot of a demand under every motion, with its fractiles, in strips of structures or over the scale."""
    one = len(ensemble.scales) == 1
    series: list[dict[str, Any]] = []
    by_engine: list[dict[str, Any]] = []
    for place, structure in enumerate(ensemble.structures):
        name, (unit, factor) = structure.name, display_unit(quantity, structure.weight)
        motions, engine = (
            ensemble.list_demand_curves(name, quantity, model) for model in ("exact", ensemble.engine.model)
        )
        look: dict[str, Any] = {
            "name": f"{label_structures(ensemble)[name]}: one motion",
            "color": place,
        }
        look |= {"marks": True, "line": False} if one else {"width": 0.7}
        series += _motion_series(motions, factor, place if one else None, **look)
        if quantity == "displacement":
            series += _travel_arrows(ensemble, place, motions, factor)
        if stripes := ensemble.list_demands_over_scales(name, quantity):
            x = [place + STRIP_WIDTH if one else stripe.scale for stripe in stripes]
            fractiles = zip(*(stripe.fractiles for stripe in stripes))
            series.append(_median_line(ensemble, place, x, fractiles, factor, band=not one, line=not one,
                                       marks=MEDIAN_MARK))  # fmt: skip
            if is_mean_limited(ensemble, quantity):
                means = [_scale_value(stripe.mean.value, factor) for stripe in stripes]
                aside = [each + 0.1 for each in x] if one else x
                look = {"name": f"{label_structures(ensemble)[name]}: mean", "color": place}
                series.append({**look, "x": aside, "y": means, "marks": MEAN_MARK, "line": False})
        look = {"name": f"{ensemble.engine.model} engine", "color": "ink", "marks": True, "line": False}
        look |= {"legend": False} if by_engine else {}
        by_engine += _motion_series(engine, factor, place - STRIP_WIDTH if one else None, **look)
    title = demand_title(quantity)
    places = range(len(ensemble.structures))
    bounds = list(label_structures(ensemble).values())
    strips = {"title": "", "ticks": [[place, bounds[place]] for place in places], "range": [-0.6, len(places) - 0.4]}
    scales = {"title": "scale factor of the motion", "range": [0.0, 1.04 * ensemble.largest_scale]}
    axis: dict[str, Any] = strips if one else scales
    series += _stated_lines(ensemble, quantity, axis["range"])
    label = f"{title} {'by bound' if one else 'over the scale factor'}, {word_motion_count(ensemble.motions)}"
    series += by_engine
    return make_panel(title, label, axis, _make_axis_from_zero(f"{title}, {unit}", series), series)


def _travel_arrows(
    ensemble: EnsembleResult, place: int, curves: Sequence[DemandCurve], factor: float
) -> list[dict[str, Any]]:
    """
    Return the arrows of a plot at the limit of travel, one for each motion that reaches it, at its smallest such scale.

    place: index of the structure. curves: the displacements of its motions. factor: from m to the unit of the plot.
    """
    structure, one = ensemble.structures[place], len(ensemble.scales) == 1
    travel = structure.building.travel if structure.building else None
    reached = {
        (each.motion, each.scale)
        for each in ensemble.ended
        if (each.structure, each.status) == (structure.name, TRAVEL_REACHED)
    }
    at = {
        curve.motion: _strip_place(place, number, len(curves)) if one else scale
        for number, curve in enumerate(curves)
        for scale in sorted(curve.scales, reverse=True)
        if (curve.motion, scale) in reached
    }
    if travel is None or not at:
        return []
    look: dict[str, Any] = {
        "color": place,
        "marks": ARROW_MARK,
        "line": False,
        "titles": [f"{motion}: at the travel" for motion in at],
    }
    name = f"{label_structures(ensemble)[structure.name]}: at the travel"
    return [{"name": name, "x": list(at.values()), "y": [factor * travel] * len(at), **look}]


def _stated_lines(ensemble: EnsembleResult, quantity: str, span: Sequence[float]) -> list[dict[str, Any]]:
    """
    Return lines across a plot of a demand, one for each travel of an isolator and each limit of the demand.

    span: horizontal positions of both ends.
    """
    factor = display_unit(quantity, 1.0)[1]  # weight 1: the limit of a base shear is a share of it
    travels: list[tuple[str, float, dict[str, Any]]] = [
        ("travel", each.building.travel, {"color": "ink", "width": 1.0})
        for each in ensemble.structures
        if each.building and each.building.travel and quantity == "displacement"
    ]
    limits = [
        (f"limit ({each.statistic})", each.stated, {"color": "gray", "dash": "7 3"})
        for each in ensemble.limits
        if each.key == f"{LIMIT_KEY_PREFIX}{quantity}" and each.stated is not None
    ]
    stated = {(name, value): look for name, value, look in [*travels, *limits]}
    return [{"name": name, "x": [*span], "y": [factor * value] * 2, **look} for (name, value), look in stated.items()]


def is_mean_limited(ensemble: EnsembleResult, quantity: str) -> bool:
    """Return whether a scene states a limit on the mean of a demand over the motions."""
    key = f"{LIMIT_KEY_PREFIX}{quantity}"
    return any(each.key == key and each.statistic == MEAN_STATISTIC for each in ensemble.limits)


def plots_note(ensemble: EnsembleResult) -> str:
    """Return the note that explains dots, lines and marks of the plots of demands."""
    means = any(is_mean_limited(ensemble, quantity) for quantity in PLOTTED_QUANTITIES)
    diamond = " A diamond is the mean, where a limit is on it." * means
    if len(ensemble.scales) > 1:
        return f"Every thin line is one motion; a band is from 16 % to 84 % about the median.{diamond}"
    return (
        "Every dot is one motion that has a value. The flat mark at the right of a group is the median of all motions, "
        f"with a line from 16 % to 84 % where all three have a value.{diamond}"
    )


def _strip_place(place: float, number: int, count: int) -> float:
    """Return the horizontal position of the dot of motion `number` of `count`, in the strip of dots around `place`."""
    return place + STRIP_WIDTH * ((number + 0.5) / count - 0.5)


def _motion_series(
    curves: Sequence[DemandCurve], factor: float, place: float | None, **look: Any
) -> list[dict[str, Any]]:
    """
    Return a plot line of each motion's demand over the scale, or a dot of each in the strip around `place`.

    factor: from SI units to those of the plot. place: center of the strip, None for lines. look: style of the plot's
    series; dots have error bars.
    """
    series = []
    for number, curve in enumerate(curves):
        x = list(curve.scales) if place is None else [_strip_place(place, number, len(curves))]
        line = {
            "x": x,
            "y": [_scale_value(value, factor) for value in curve.values],
        } | look
        line["legend"] = number == 0 and line.get("legend", True)
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
    """
    Return the plot line of the median of a structure, with a band from 16 to 84 %.

    place: index of the structure. x: positions of the points. fractiles: for each of 16, 50 and 84 %, the values at x.
    factor: from SI units to those of the plot. look: style of the line.
    """
    columns = zip(("low", "y", "high"), fractiles)
    numbers = {key: [_scale_value(each.value, factor) for each in column] for key, column in columns}
    name = f"{label_structures(ensemble)[ensemble.structures[place].name]}: median, 16 to 84 %"
    return {"name": name, "color": place, "x": x, **numbers, "band": True, "marks": True, "width": 2.4, **look}


def _profile_panel(ensemble: EnsembleResult, quantity: str) -> Panel:
    """Return a plot of a demand's fractiles (horizontal) over the height of the building (vertical)."""
    unit = display_unit(quantity, ensemble.structures[0].weight)[0]
    series = [
        line
        for place, structure in enumerate(ensemble.structures)
        for line in _profiles_of_structure(ensemble, structure, place, quantity)
    ]
    largest = max((value for each in series for value in each["x"] if value is not None), default=0.0)
    across = [value for each in series for value in each["y"]] or [0.0]
    for limit in _stated_lines(ensemble, quantity, [min(across), max(across)]):
        (value, _), inside = limit["y"], limit["y"][0] <= MAX_STRETCH * largest
        beyond = "" if inside else f": {value:.4g} {unit}, beyond the axis"
        series.append({**limit, "x": limit["y"], "y": limit["x"], "name": f"{limit['name']}{beyond}"})
        largest = max(largest, value) if inside else largest
    x = {"title": f"{demand_title(quantity)}, {unit}", "range": [0.0, 1.06 * largest or 1.0]}
    y: dict[str, Any] = {"title": HEIGHT_AXIS}
    if not all(_demand_heights(structure, quantity)[1] for structure in ensemble.structures):
        y = {"title": "body, from the platform up"}
        y["ticks"] = [[n, str(n)] for n in range(1, max(each.bodies for each in ensemble.structures) + 1)]
    label = f"{demand_title(quantity)} over the height: 16, 50 and 84 %, {word_motion_count(ensemble.motions)}"
    return make_panel(f"{demand_title(quantity)} over the height", label, x, y, series)


def _profiles_of_structure(
    ensemble: EnsembleResult, structure: Structure, place: int, quantity: str
) -> list[dict[str, Any]]:
    """Return the lines of a structure over its height: fractiles of a demand, and its mean if a limit is on that."""
    series, name = [], label_structures(ensemble)[structure.name]
    factor = display_unit(quantity, structure.weight)[1]
    rows = ensemble.list_demands_of_bodies(structure.name, quantity)
    heights = _demand_heights(structure, quantity)[0]
    y = [heights[(row.body or 1) - 1] for row in rows]
    for share, number, dash in FRACTILE_LINES:
        values = [row.fractiles[number].value for row in rows]
        line: dict[str, Any] = {
            "name": f"{name}, {share}", "color": place, "width": 2.4 if share == "50 %" else 1.2,
            "x": [_scale_value(value, factor) for value in values], "y": y, "marks": share == "50 %",
            "titles": [
                f"{locate_demand(structure, quantity, row.body)}: {word_value(value, None, factor)}"
                for row, value in zip(rows, values)
            ],
        }  # fmt: skip
        if any(value is not None for value in values):
            series.append(line | ({"dash": dash} if dash else {}))
    if is_mean_limited(ensemble, quantity) and rows:
        means = {"x": [_scale_value(row.mean.value, factor) for row in rows], "y": y}
        series.append({"name": f"{name}, mean", "color": place, **means, "marks": MEAN_MARK, "line": False})
    return series


def _body_heights(structure: Structure) -> tuple[list[float], bool]:
    """Return the heights of the bodies, m, and True; if these are not stated, the numbers of the bodies and False."""
    heights = structure.building.heights if structure.building else None
    return (list(heights), True) if heights else ([float(n) for n in range(1, structure.bodies + 1)], False)


def _demand_heights(structure: Structure, quantity: str) -> tuple[list[float], bool]:
    """
    Return the heights at which the demand of each body acts, m, and True; without heights, numbers and False.

    A moment is at the height about which it is taken, a drift or shear in the middle of its story.
    """
    heights, stated = _body_heights(structure)
    if quantity in ("acceleration", SUPREMUM):
        return heights, stated
    below = [0.0, *heights[:-1]]
    return (below if quantity == "overturning_moment" else [0.5 * (a + b) for a, b in zip(below, heights)]), stated


def _make_period_axis(periods: Sequence[float]) -> dict[str, Any]:
    """Return the logarithmic axis of the periods of a spectrum, with round numbers."""
    ticks = [[tick, f"{tick:g}"] for tick in PERIOD_TICKS if min(periods) <= tick <= max(periods)]
    return {"title": "period, s", "log": True, "ticks": ticks}


def _floor_spectrum(ensemble: EnsembleResult, title: str, is_platform: bool) -> Panel:
    """Return the plot of the floor spectra, in g, of the platform or the top body: the median for each structure."""
    series = [
        _median_line(ensemble, place, list(spectrum.period), spectrum.fractiles, 1.0 / GRAVITY, marks=False)
        for place, structure in enumerate(ensemble.structures)
        for spectrum in ensemble.spectra
        if (spectrum.structure, spectrum.body) == (structure.name, PLATFORM_BODY if is_platform else structure.bodies)
    ]
    quantity = f"pseudo-acceleration, {100.0 * ensemble.spectra[0].damping:g} % damping, g"
    axis = _make_period_axis(ensemble.spectra[0].period)
    label = f"floor spectrum of the {title}, {word_motion_count(ensemble.motions)}"
    return make_panel(f"floor spectrum: {title}", label, axis, _make_axis_from_zero(quantity, series), series)


def _ground_spectra(ensemble: EnsembleResult) -> Panel:
    """Return the plot of the spectra of the ground motions, with the target spectrum where one is given."""
    target = ensemble.target
    x = list(target.period if target else ensemble.ground_periods)
    spectra = (
        [(each.motion, each.acceleration) for each in target.motions]
        if target
        else [(each.motion, each.spectrum) for each in ensemble.suite if each.spectrum]
    )
    series: list[dict[str, Any]] = [
        {
            "x": x, "y": [value / GRAVITY for value in values], "name": "one motion", "color": "gray", "width": 0.7,
            "legend": number == 0, "titles": [motion] * len(x),
        }
        for number, (motion, values) in enumerate(spectra)
    ]  # fmt: skip
    mean = np.exp(np.log([values for _, values in spectra]).mean(axis=0)) / GRAVITY
    series.append({"x": x, "y": mean.tolist(), "name": "geometric mean of the motions", "color": 0, "width": 2.4})
    if target:
        wanted = [value / GRAVITY for value in target.acceleration]
        series.append({"x": x, "y": wanted, "name": "target", "color": "ink", "width": 2.4})
    y = _make_axis_from_zero("pseudo-acceleration, 5 % damping, g", series)
    of = " and their target" if target else ""
    label = f"response spectra of the ground{of}, {word_motion_count(ensemble.motions)} at scale 1"
    return make_panel("response spectra of the ground", label, _make_period_axis(x), y, series)


def _make_axis_from_zero(title: str, series: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Return a plot's vertical axis from zero to 6 % above the largest value of its series."""
    values = [value for each in series for key in ("y", "high") for value in each.get(key, ()) if value is not None]
    return {"title": title, "range": [0.0, 1.06 * max(values, default=0.0) or 1.0]}


def _scale_value(value: float | None, factor: float) -> float | None:
    """Return a value times a factor; None where it is not known."""
    return None if value is None else factor * value
