"""Values of a scene that are valid but hardly meant: a wrong unit shows in what follows from it."""

from __future__ import annotations

import math
from collections.abc import Callable

from reference.building import Building, describe_building, word_force
from reference.problem import GRAVITY, Scene
from reference.support.arguments import Range

LOAD_PER_SUPPORT = Range(1e3, 1e8, "N")
NORMALIZED = 10.0  # kg: a scene of unit masses, as those of the paper, is meant as no building
FIXED_BASE_PERIOD = Range(0.05, 5.0, "s")  # period of the first mode along either axis
LARGEST_RADIUS = 50.0  # m
LARGEST_FRICTION = 1.0
LARGEST_DAMPING = 0.2  # damping ratio of the first fixed-base mode
LARGEST_PEAK = 3.0  # g
LARGEST_DRIFT_RATIO = 0.1
MASS_RATIO = 1e6


def implausible_values(scene: Scene) -> list[str]:
    """Return one line for every kind of value that is hardly meant."""
    building = describe_building(scene)
    lines = [*_implausible_modes(building)]
    load = building.load_per_support
    if load is not None and load not in LOAD_PER_SUPPORT and scene.total_mass > NORMALIZED:
        limit = _word_end_beyond(load, LOAD_PER_SUPPORT, word_force)
        lines.append(f"the weight on each support is {word_force(load)}, {limit}: is mass in kg?")
    if LARGEST_RADIUS < scene.radius < math.inf:
        unit = "mm" if scene.isolator.period is None else "is period in s"
        lines.append(f"the radius of the isolator is {scene.radius:.4g} m, above {LARGEST_RADIUS:g} m: {unit}?")
    if not scene.isolator.lubrication and (friction := scene.dry_friction.largest) > LARGEST_FRICTION:
        lines.append(f"the friction coefficient is {friction:.4g}: percent?")
    spread = float(scene.masses.max() / scene.masses.min())
    if spread >= MASS_RATIO:
        lines.append(f"masses differ by a factor of {spread:.2g}: kg in one place and t in another?")
    # What a record has by itself is said where it is described.
    as_read = scene.largest_acceleration / (scene.excitation.scale or 1.0) if scene.recorded else 0.0
    if (peak := building.ground_peak / GRAVITY) > LARGEST_PEAK and as_read <= LARGEST_PEAK * GRAVITY:
        lines.append(f"the peak of the ground is {peak:.4g} g, above {LARGEST_PEAK:g} g: unit or scale?")
    return lines


def implausible_drift(ratio: float, place: str) -> str:
    """Return the line for a drift ratio that is hardly meant, "" for any other; place: the story, in words."""
    if ratio <= LARGEST_DRIFT_RATIO:
        return ""
    share = f"{100.0 * ratio:.3g} % of the height of the story, above {100.0 * LARGEST_DRIFT_RATIO:g} %"
    return f"the drift {place} is {share}: is stiffness in N/m?"


def _implausible_modes(building: Building) -> list[str]:
    """Return the lines for the first modes above a fixed base."""
    if building.bodies == 1:
        return []
    lines: list[str] = []
    for period in sorted(map(float, building.fixed_base_period[:, 0]), reverse=True):
        if period not in FIXED_BASE_PERIOD and not lines:
            limit = _word_end_beyond(period, FIXED_BASE_PERIOD, lambda value: f"{value:g} s")
            lines.append(f"the period above a fixed base is {period:.4g} s, {limit}: stiffness in N/m, mass in kg?")
    if (ratio := float(building.modal_damping[:, 0].max())) > LARGEST_DAMPING:
        share = f"{100.0 * ratio:.4g} % of critical, above {100.0 * LARGEST_DAMPING:g} %"
        lines.append(f"the damping of the first mode above a fixed base is {share}: percent?")
    return lines


def _word_end_beyond(value: float, allowed: Range, word: Callable[[float], str]) -> str:
    """Return which end of a range a value lies beyond."""
    return f"below {word(allowed.lowest)}" if value < allowed.lowest else f"above {word(allowed.highest)}"
