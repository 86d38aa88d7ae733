"""Demands as engineers read them: which are shown, in which order, in which unit and under which name."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol, TypeVar

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


class _Statistics(Protocol):
    @property
    def structure(self) -> str: ...
    @property
    def model(self) -> str: ...
    @property
    def scale(self) -> float: ...


S = TypeVar("S", bound=_Statistics)


def shown_stripes(stripes: Sequence[S], structure: str, scale: float) -> list[S]:
    """Those of one structure at one scale, in the order of reading: by the engine what the equations do not have."""
    own = [stripe for stripe in stripes if (stripe.structure, stripe.scale) == (structure, scale)]
    known = {_place(stripe) for stripe in own if stripe.model == EXACT.key}
    shown = [stripe for stripe in own if stripe.model == EXACT.key or _place(stripe) not in known]
    return sorted(shown, key=_place)


def _place(stripe: object) -> tuple[int, int]:
    """Place of a demand in the order of reading. A stored one has its body apart."""
    quantity = stripe.quantity  # type: ignore[attr-defined]
    name, body = quantity if isinstance(quantity, tuple) else (quantity, stripe.body or 0)  # type: ignore[attr-defined]
    return ORDER.index(name), body
