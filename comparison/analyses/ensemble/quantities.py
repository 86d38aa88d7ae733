"""Demands of an ensemble: their names in words, their units, and their values by motion."""

from collections.abc import Sequence

from reference.measures import Demands, Estimate, StoryForces
from reference.measures.peak_demands import QUANTITIES, list_demands
from reference.measures.story_forces import heights_above_contact
from reference.problem import GRAVITY, Scene

Quantity = tuple[str, int]  # name of a demand and number of the body, 0 for the isolator

# Key of the demand "floor acceleration, literal supremum": the largest value, however short, also at slow sliding
SUPREMUM = "acceleration_supremum"
DIRECTED_DEMANDS = {  # demands of every story; besides their resultant, those along x and y are shown
    "story_shear": ("story shear", "N"),
    "drift": ("drift", "m"),
    "overturning_moment": ("overturning moment of the forces", "N m"),
}
# Title and SI unit of the demands along x or y alone, by key
ALONG = {
    f"{name}_{axis}": (f"{title} along {axis}", unit)
    for name, (title, unit) in DIRECTED_DEMANDS.items()
    for axis in "xy"
}
# Title and SI unit of every demand
DEMANDS: dict[str, tuple[str, str]] = {
    **{name: about for name, about in QUANTITIES.items() if name != "energy_balance"},
    "acceleration": ("floor acceleration, as integrated", "m/s^2"),
    SUPREMUM: ("floor acceleration, literal supremum", "m/s^2"),
    "drift_ratio": ("drift over the height of the story", "1"),
    "story_shear": ("story shear", "N"),
    "overturning_moment": ("overturning moment", "N m"),
    **ALONG,
}
BODY_DEMAND_TITLES = {  # title of each demand of a body; {} stands for the body's number
    "acceleration": "acceleration of body {}, as integrated",
    SUPREMUM: "acceleration of body {}, literal supremum",
    "drift": "drift below body {}",
    "drift_ratio": "drift ratio below body {}",
    "story_shear": "story shear below body {}",
    "overturning_moment": "overturning moment below body {}",
    "torsion": "rotation of body {}",
    **{name: f"{title} below body {{}}" for name, (title, _) in ALONG.items()},
}
FRACTILES = (0.16, 0.5, 0.84)  # fractiles computed, as shares of motions below them
SMALLEST_IS_WORST = ("contact_force_min", "support_force_min")  # demands whose smallest value is the worst
# By SI unit: the unit in which a report shows a demand, and the factor to it
DISPLAY_UNITS = {
    "m": ("mm", 1e3),
    "N": ("kN", 1e-3),
    "N m": ("kN m", 1e-3),
    "J": ("kJ", 1e-3),
    "rad": ("mrad", 1e3),
    "m/s^2": ("g", 1.0 / GRAVITY),
}
MAX_FOUR_DIGITS = 9999.5  # from here on the format .4g rounds to a power of ten, and a number is written without it
HIDDEN_IN_FOUR_DIGITS = 5e-5  # An error below this share of the value is not printed: it is below the fourth digit.


def unit_of_demand(quantity: str) -> str:
    """Return the SI unit of a demand; "" for a pure number."""
    unit = DEMANDS[quantity][1]
    return "" if unit == "1" else unit


def demand_title(quantity: str, body: int | None = None) -> str:
    """Return the name of a demand in words."""
    return BODY_DEMAND_TITLES[quantity].format(body) if body else DEMANDS[quantity][0]


def display_unit(quantity: str, weight: float) -> tuple[str, float]:
    """Return the unit in which a demand is displayed, and the factor from SI to it. weight: of the structure, N."""
    if quantity == "base_shear":
        return "% of the weight", 100.0 / weight
    if quantity.endswith("_share") or quantity == "drift_ratio":
        return "%", 100.0
    unit = unit_of_demand(quantity)
    return DISPLAY_UNITS.get(unit, (unit, 1.0))


def unit_of_check(unit: str) -> tuple[str, float]:
    """Return the unit in which a demand with a limit is shown, and the factor to it from SI; "%" if it has no unit."""
    return DISPLAY_UNITS.get(unit, (unit, 1.0)) if unit else ("%", 100.0)


def word_value(value: float | None, error: float | None, factor: float) -> str:
    """Return factor * value as text with four digits; with "± error" if that is not below the last digit."""
    if value is None:
        return "none"
    read = factor * value
    digits = f"{read:.4g}" if abs(read) < MAX_FOUR_DIGITS else f"{float(f'{read:.4g}'):.0f}"
    if abs(read) < 1e-4:
        digits = "0" if read == 0.0 else f"{read:.1e}"
    if error is None or factor * error <= HIDDEN_IN_FOUR_DIGITS * abs(read):
        return digits
    return f"{digits} ± {float(f'{factor * error:.1g}'):g}"


def collect_demand_values(
    scene: Scene, demands: Demands, forces: StoryForces, resolved: Sequence[Estimate] = ()
) -> dict[Quantity, Estimate]:
    """
    Return all demands of one motion by name and body, story forces and drift ratios included.

    Support forces of a model without single supports are those of statics (`story_forces`). resolved: by body, peak
    accelerations as integrated (see `read_as_integrated`), if `demands` have the literal suprema instead; else empty.
    """
    values = {(name, body): number for name, body, number in list_demands(demands) if name in DEMANDS}
    for body, number in enumerate(resolved, start=1):
        values[SUPREMUM, body] = values["acceleration", body]
        values["acceleration", body] = number
    heights = heights_above_contact(scene)
    if heights is not None:
        for body, drift in enumerate(demands.drift, start=2):
            story = float(heights[body - 1] - heights[body - 2])
            if story > 0.0:
                values["drift_ratio", body] = Estimate(drift.value / story, drift.error / story)
    values |= {("story_shear", body): number for body, number in enumerate(forces.shear, start=1)}
    values |= {("overturning_moment", body): number for body, number in enumerate(forces.moment or (), start=1)}
    for place, axis in enumerate("xy"):
        moment = forces.moment_along[place] if forces.moment_along else ()
        values |= {(f"story_shear_{axis}", body): number for body, number in enumerate(forces.shear_along[place], 1)}
        values |= {(f"drift_{axis}", body): number for body, number in enumerate(forces.drift_along[place], 2)}
        values |= {(f"overturning_moment_{axis}", body): number for body, number in enumerate(moment, 1)}
    worst = {"support_force_min": (forces.support_min, min), "support_force_max": (forces.support_max, max)}
    for name, (supports, choose) in worst.items():
        if supports:
            values.setdefault((name, 0), choose(supports, key=lambda number: number.value))
    return values
