"""What the plots of the page's sections share, as plot.js draws them."""

from collections.abc import Sequence
from typing import Any

from comparison.json_file import finite_or_none
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


def json_numbers(values: Sequence[float]) -> list[float | None]:
    """Return what JSON can hold: NaN is null."""
    return [finite_or_none(value) for value in values]


def fractile_heads() -> list[str]:
    """Heads of the columns of fractiles, in percent."""
    return [f"{100.0 * probability:g}" for probability in FRACTILES]
