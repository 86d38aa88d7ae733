"""Panels: the plots of the page's sections, described as plot.js draws them."""

from collections.abc import Sequence
from itertools import cycle
from typing import Any

from comparison.json_file import finite_or_none
from comparison.report.results import Results
from comparison.surfaces.distribution import CURVE
from reference.measures.distribution import FRACTILES

Panel = dict[str, Any]  # title, and plot: see plot.js

MAX_CURVES = 6  # in one panel: more cannot be told apart
# demands that are drawn: key, body (0: of the isolator), name, unit, and the unit in those of the results
DEMANDS = (
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
DASHES = ("", "7 3", "2 2", "10 3 2 3", "14 4", "4 4")  # curves that lie on each other: the later ones leave gaps


def make_panel(title: str, label: str, x: dict[str, Any], y: dict[str, Any], series: Any, **more: Any) -> Panel:
    """A panel with its plot, as plot.js has it; label: the plot in words."""
    return {"title": title, "plot": {"label": label, "x": x, "y": y, "series": series, **more}}


def distribution_panels(results: Results, scene: str, quantity: str, unit: str, curves: Any) -> list[Panel]:
    """The share of all phases at which a quantity stays below a value, by (model, values); none without curves."""
    models = {model.key: (model.title, number) for number, model in enumerate(results.models)}
    series = [
        {"name": models[key][0], "x": json_numbers(values), "y": CURVE.tolist(), "color": models[key][1], "dash": dash}
        for (key, values), dash in zip(curves, cycle(DASHES))
    ]
    title = f"{scene}, {quantity}"
    label = f"{title}: share of the phases at which it stays below a value, by model"
    axes = {"title": f"{quantity}, {unit}".removesuffix(", ")}, {"title": "share of the phases"}
    return [make_panel(title, label, *axes, series)] if series else []


def json_numbers(values: Sequence[float]) -> list[float | None]:
    """Return what JSON can hold: NaN is null."""
    return [finite_or_none(value) for value in values]


def fractile_heads() -> list[str]:
    """Heads of the columns of fractiles, in percent."""
    return [f"{100.0 * probability:g}" for probability in FRACTILES]
