"""Panels: plots of the page's sections, as the data that plot.js draws."""

from collections.abc import Sequence
from itertools import cycle
from typing import Any

from comparison.json_file import finite_or_none
from comparison.report.results import Results
from comparison.surfaces.distribution import CURVE_PROBABILITIES
from reference.measures.distribution import FRACTILES

Panel = dict[str, Any]  # title and data of one plot, in the form that the page's script plot.js reads

MAX_CURVES = 6  # largest number of curves in one panel: more cannot be distinguished
# Demands that are plotted: key in the results, body (0: isolator), name, unit, factor from the unit of the results
PLOTTED_DEMANDS = (
    ("displacement", 0, "isolator displacement", "mm", 1e3),
    ("residual", 0, "residual displacement", "mm", 1e3),
    ("base_shear", 0, "base shear", "N", 1.0),
    ("acceleration", 1, "platform acceleration", "m/s²", 1.0),
    ("drift", 2, "drift of the lowest story", "mm", 1e3),
    ("contact_force_min", 0, "smallest contact force", "N", 1.0),
    ("contact_force_max", 0, "largest contact force", "N", 1.0),
    ("support_force_max", 0, "largest support force", "N", 1.0),
    ("friction_energy", 0, "energy dissipated by friction", "J", 1.0),
)
# Dash patterns of the curves in a plot: where two curves coincide, the first is visible in the gaps of the second
DASH_PATTERNS = ("", "7 3", "2 2", "10 3 2 3", "14 4", "4 4")


def make_panel(title: str, label: str, x: dict[str, Any], y: dict[str, Any], series: Any, **more: Any) -> Panel:
    """
    Return a titled plot in the form that the page's script plot.js reads, which also explains the keys.

    label: description for screen readers. x, y: title, scale and range of an axis. series: the curves.
    """
    return {"title": title, "plot": {"label": label, "x": x, "y": y, "series": series, **more}}


def make_distribution_panels(results: Results, scene: str, quantity: str, unit: str, curves: Any) -> list[Panel]:
    """
    Return a plot of the share of phases below each value of a quantity, in a list that is empty without curves.

    curves: key of a model, and the values of the quantity at CURVE_PROBABILITIES, for each curve.
    """
    models = {model.key: (model.title, number) for number, model in enumerate(results.models)}
    series = [
        {
            "name": models[key][0],
            "x": replace_nan(values),
            "y": CURVE_PROBABILITIES.tolist(),
            "color": models[key][1],
            "dash": dash,
        }
        for (key, values), dash in zip(curves, cycle(DASH_PATTERNS))
    ]
    title = f"{scene}, {quantity}"
    label = f"{title}: share of the phases at which it stays below a value, by model"
    axes = {"title": f"{quantity}, {unit}".removesuffix(", ")}, {"title": "share of the phases"}
    return [make_panel(title, label, *axes, series)] if series else []


def replace_nan(values: Sequence[float]) -> list[float | None]:
    """Return the numbers with None for NaN, which JSON cannot hold."""
    return [finite_or_none(value) for value in values]


def fractile_heads() -> list[str]:
    """Return the column heads of a table of fractiles: each probability in percent."""
    return [f"{100.0 * probability:g}" for probability in FRACTILES]
