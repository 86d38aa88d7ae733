"""Demands as engineers read them: which are shown, in which order, in which unit and under which name."""

from __future__ import annotations

from collections.abc import Sequence

from comparison.analyses.ensemble.result import Fractile, Statistic, Stripe
from comparison.study.models import EXACT
from reference.measures.peak_demands import unit_of
from reference.problem import GRAVITY

ORDER = (
    "displacement", "support_displacement", "residual", "base_shear", "torsion", "acceleration", "drift", "uplift",
    "support_force_min", "support_force_max", "contact_force_min", "contact_force_max", "travel_share", "cap_share",
    "stops", "friction_energy", "damping_energy",
)  # fmt: skip
TITLES = {
    "displacement": "isolator displacement",
    "support_displacement": "displacement of a support",
    "residual": "residual displacement",
    "base_shear": "base shear",
    "torsion": "rotation of body {}",
    "acceleration": "acceleration of body {}",
    "drift": "drift below body {}",
    "uplift": "uplift of a support",
    "support_force_min": "smallest support force",
    "support_force_max": "largest support force",
    "contact_force_min": "smallest contact force",
    "contact_force_max": "largest contact force",
    "travel_share": "displacement over travel",
    "cap_share": "displacement over radius",
    "stops": "stops",
    "friction_energy": "energy dissipated by friction",
    "damping_energy": "energy dissipated by dampers",
}
READ = {"m": ("mm", 1e3), "N": ("kN", 1e-3), "J": ("kJ", 1e-3), "rad": ("mrad", 1e3), "m/s^2": ("g", 1.0 / GRAVITY)}


def title_of(quantity: tuple[str, int | None]) -> str:
    """A demand in words."""
    return TITLES[quantity[0]].format(quantity[1])


def unit_for_reading(quantity: str, weight: float) -> tuple[str, float]:
    """
    The unit in which a demand is read, and its factor.

    weight: of the structure, N.
    """
    if quantity == "base_shear":
        return "% of the weight", 100.0 / weight
    unit = unit_of(quantity)
    return ("%", 100.0) if quantity.endswith("_share") else READ.get(unit, (unit, 1.0))


def figures_of(value: float) -> str:
    """Four digits, and no power of ten for a large value."""
    return f"{value:.4g}" if abs(value) < 1e4 else f"{float(f'{value:.4g}'):.0f}"


def shown_stripes(stripes: Sequence[Stripe], structure: str, scale: float) -> list[Stripe]:
    """Those of one structure at one scale, in the order of reading: by the engine what the equations do not have."""
    own = [stripe for stripe in stripes if (stripe.structure, stripe.scale) == (structure, scale)]
    known = {_place(stripe) for stripe in own if stripe.model == EXACT.key}
    return sorted((each for each in own if each.model == EXACT.key or _place(each) not in known), key=_place)


def _place(stripe: Stripe) -> tuple[int, int]:
    """Place of a demand in the order of reading."""
    return ORDER.index(stripe.quantity), stripe.body or 0


def band(rows: Sequence[Sequence[Statistic | Fractile]], factor: float) -> list[list[float | None]]:
    """The values of each row in the unit of reading: low, median and high of a band."""
    return [[scaled(each.value, factor) for each in row] for row in rows]


def scaled(value: float | None, factor: float) -> float | None:
    """A value, which may be unknown, in the unit of reading."""
    return None if value is None else factor * value


def fractiles_of(stripes: Sequence[Stripe], factor: float) -> list[list[float | None]]:
    """Low, median and high of stripes in the unit of reading."""
    return band([[each.fractiles[n] for each in stripes] for n in range(3)], factor)
