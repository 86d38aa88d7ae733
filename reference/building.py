"""Description of the building of a scene as it was read: weight, periods, modal damping, and the ground's peak."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reference.measures.story_forces import heights_above_contact, support_loads_at_rest
from reference.natural_modes import linear_stiffness
from reference.problem import GRAVITY, Scene
from reference.problem.chain_modes import solve_chain_modes
from reference.problem.result import Array
from reference.problem.scene import require_scene
from reference.support.arguments import name_some

# Number of modes along each axis in a description; of a tall chain only the lowest modes are computed
MAX_DESCRIBED_MODES = 10
MAX_NAMES_PER_LINE = 6  # largest number of values, or of names of buildings, in a line of the description
EQUAL_LOAD_TOLERANCE = 1e-6  # largest difference of dead loads, over their mean, at which they count as equal
MAX_KINDS = 3  # largest number of different buildings, or of kinds of friction, that are described one by one


@dataclass(frozen=True)
class Building:
    """
    Weight, periods, damping and isolator of a building as read from a scene. On axes of length 2, index 0 is x, 1 is y.

    Attributes
    ----------
    name : str
        Name of the scene.
    bodies : int
        Number N of bodies, the platform among them.
    weight : float, N
        Weight of all bodies.
    supports : int or None
        Number of supports; None where the scene states none.
    load_per_support : float or None, N
        Weight over the number of supports; None where the scene states none.
    isolated_period : ndarray, (2, M), s
        Natural periods on the isolator, linear and without friction, of the M = min(N, 10) lowest modes; inf for the
        rigid motion on a plane.
    fixed_base_period : ndarray, (2, L), s
        Natural periods of the bodies above a platform that is held, of the L = min(N - 1, 10) lowest modes.
    modal_damping : ndarray, (2, L)
        Damping ratio of each of these modes, X^T D0 X / (2 omega) with X of unit modal mass, from the dampers of the
        links. Friction of the isolator has no part in it.
    modal_mass : ndarray, (2, L)
        Effective mass of each of these modes over the mass of the bodies above the platform.
    ground_peak : float, m/s^2
        Largest horizontal acceleration of the ground, the resultant of x and y; of two frequencies the largest over
        all phases; 0 without a loading.
    radius : float, m
        Effective radius of the isolator; inf for a flat slider.
    friction : tuple of float
        Coefficients at rest and at high speed, under the weight, and the rate between them, s/m; the coefficient of
        lubrication, s/m, alone where the isolator is lubricated.
    travel : float or None, m
        None where the scene states none.
    support_extent : ndarray or None, (2,), m
        Distance of the outermost supports along x and y; None where the scene states no places.
    heights : ndarray or None, (N,), m
        Heights of the centers of mass above the sliding contact; None unless the scene states all.
    support_loads : ndarray or None, (K,), N
        Dead load of every support by statics, with the centers of mass where they are; None where none is placed.
    """

    name: str
    bodies: int
    weight: float
    supports: int | None
    load_per_support: float | None
    isolated_period: Array
    fixed_base_period: Array
    modal_damping: Array
    modal_mass: Array
    ground_peak: float
    radius: float
    friction: tuple[float, ...]
    travel: float | None
    support_extent: Array | None
    heights: Array | None
    support_loads: Array | None

    @property
    def lines(self) -> list[str]:
        """Return the description of the building as lines of text."""
        return word_buildings([self])

    def __str__(self) -> str:
        """Return the description of the building as one text."""
        return "\n".join(self.lines)


@require_scene
def describe_building(scene: Scene) -> Building:
    """
    Return the description of a scene's building, which shows whether its numbers and their units are the intended ones.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    Building
        Weight, load of a support, isolator, heights, natural periods, modal damping and peak of the ground. `lines` has
        it as text.

    Notes
    -----
    Natural periods are those of (4.8)-(4.11); the fixed-base ones of the same chain above a platform that is held.
    The modal damping ratio is that of Chopra, Dynamics of Structures, chapter 11: the diagonal of the damping matrix
    in modal coordinates over 2 omega. Bars with an axial stiffness count by their stiffness in sway alone.

    Examples
    --------
    >>> import reference
    >>> building = reference.describe_building(reference.load_scene("fig3-I"))
    >>> building.fixed_base_period.round(3).tolist()
    [[1.5], [1.2]]
    >>> round(building.load_per_support, 2)
    4.91
    """
    weight, supports = scene.total_mass * GRAVITY, scene.isolator.support_count
    places, law = scene.support_places, scene.dry_friction
    isolated = [
        solve_chain_modes(scene.masses, stiffness, MAX_DESCRIBED_MODES)[0] for stiffness in linear_stiffness(scene).T
    ]
    fixed = [_solve_fixed_base(scene, axis) for axis in range(2)]
    with np.errstate(divide="ignore"):
        return Building(
            name=scene.name,
            bodies=len(scene.bodies),
            weight=weight,
            supports=supports,
            load_per_support=None if supports is None else weight / supports,
            isolated_period=2.0 * np.pi / np.array(isolated),
            fixed_base_period=2.0 * np.pi / np.array([frequency for frequency, _, _ in fixed]),
            modal_damping=np.array([ratio for _, ratio, _ in fixed]),
            modal_mass=np.array([mass for _, _, mass in fixed]),
            ground_peak=largest_horizontal_acceleration(scene),
            radius=scene.radius,
            friction=(scene.friction_coefficient,) if scene.lubricated else (law.slow, law.fast, law.rate),
            travel=scene.isolator.travel,
            support_extent=None if places is None else np.ptp(places, axis=0),
            heights=heights_above_contact(scene),
            support_loads=support_loads_at_rest(scene),
        )


def _solve_fixed_base(scene: Scene, axis: int) -> tuple[Array, Array, Array]:
    """
    Return the frequencies, rad/s, damping ratios and relative effective masses, (L,), of the modes along one axis.

    They are those of the bodies above a platform that is held. axis: 0 for x, 1 for y.
    """
    if len(scene.bodies) == 1:
        return np.zeros(0), np.zeros(0), np.zeros(0)
    frequency, shape = solve_chain_modes(scene.masses[1:], scene.stiffness[:, axis], MAX_DESCRIBED_MODES)
    elongation = np.diff(shape, axis=0, prepend=0.0)
    ratio: Array = scene.damping[:, axis] @ elongation**2 / (2.0 * frequency)
    above = scene.masses[1:]
    return frequency, ratio, (above @ shape) ** 2 / above.sum()


def largest_horizontal_acceleration(scene: Scene) -> float:
    """Return the largest horizontal acceleration of the ground, m/s^2; for two frequencies over all phases."""
    with np.errstate(over="ignore"):
        if scene.recorded:
            # Between samples the vector changes linearly, so its length is convex and largest at a sample.
            return float(np.hypot(*scene.record[:, 1:3].T).max())
        # The length is convex in the cosines of both phases, so it is largest where each is 1 or -1. As both harmonics
        # decay, they are largest at the start.
        first, second = scene.amplitudes[:2].T
        return float(max(np.hypot(*(first + second)), np.hypot(*(first - second))))


def word_buildings(buildings: Sequence[Building]) -> list[str]:
    """Return lines of text that describe buildings: equal ones together, and at most MAX_KINDS different ones."""
    alike: dict[str, list[Building]] = {}
    for building in buildings:
        alike.setdefault("\n".join(_word_structure(building)), []).append(building)
    lines = []
    for text, own in [*alike.items()][:MAX_KINDS]:
        names = [*dict.fromkeys(building.name for building in own)]
        lines.append(f"Building {name_some(names, MAX_NAMES_PER_LINE)}: {text}")
        lines += _word_frictions(own)
        lines.append(f"  peak of the ground: {_word_peaks([building.ground_peak for building in own])}")
    if (more := len(alike) - MAX_KINDS) > 0:
        lines.append(f"and {more} more kind{'' if more == 1 else 's'} of buildings")
    return "\n".join(lines).splitlines()


def are_equal_loads(loads: ArrayLike, mean: float) -> bool:
    """Return True if dead loads of supports, N, count as equal; mean: weight over the number of supports, N."""
    return float(np.ptp(loads)) <= EQUAL_LOAD_TOLERANCE * mean


def _word_loads(building: Building) -> str:
    """Return a phrase on how evenly the supports carry the weight at rest."""
    loads, mean = building.support_loads, building.load_per_support
    if loads is None or mean is None or are_equal_loads(loads, mean):
        return "(equal dead load)"
    return f"in the mean ({word_force(loads.min())} to {word_force(loads.max())} at rest, by statics)"


def _word_structure(building: Building) -> list[str]:
    """Return lines of text on bodies, weight, isolator, heights, periods and damping of a building."""
    bodies = f"{building.bodies} {'body' if building.bodies == 1 else 'bodies'}"
    load = building.load_per_support
    each = (
        "" if load is None else f", {word_force(load)} on each of {building.supports} supports {_word_loads(building)}"
    )
    lines = [f"{bodies}, weight {word_force(building.weight)}{each}"]
    travel = "no travel stated" if building.travel is None else f"travel {building.travel:.4g} m"
    lines.append(f"  isolator: {_word_radius(building.radius)}, {travel}{_word_extent(building.support_extent)}")
    if building.heights is not None:
        lines.append(f"  heights above the sliding contact: {_word_values(building.heights, 'm')}")
    lines.append(f"  periods on the isolator, without friction: {_word_axes(building.isolated_period, 's')}")
    if building.bodies > 1:
        lines.append(f"  periods above a fixed base: {_word_axes(building.fixed_base_period, 's')}")
        lines.append(f"  damping of these modes: {_word_axes(100.0 * building.modal_damping, '%')}")
    return lines


def _word_radius(radius: float) -> str:
    """Return the effective radius of the isolator as text, "plane" if it is infinite."""
    return "plane" if math.isinf(radius) else f"radius {radius:.4g} m"


def _word_extent(extent: Array | None) -> str:
    """Return a clause on how far the outermost supports are apart along x and y, m; "" if that is not stated."""
    return "" if extent is None else f", supports over {extent[0]:.4g} m along x and {extent[1]:.4g} m along y"


def _word_frictions(buildings: Sequence[Building]) -> list[str]:
    """Return lines on the friction of buildings: one for each of at most MAX_KINDS kinds, or the ranges over all."""
    alike: dict[tuple[float, ...], list[str]] = {}
    for building in buildings:
        alike.setdefault(building.friction, []).append(building.name)
    if len(alike) == 1 or len(alike) > MAX_KINDS:
        return [f"  {_word_friction([*alike])}"]
    lines = []
    for friction, own in alike.items():
        lines.append(f"  {_word_friction([friction])} ({name_some([*dict.fromkeys(own)], MAX_KINDS)})")
    return lines


def _word_friction(kinds: Sequence[tuple[float, ...]]) -> str:
    """
    Return the coefficients of one kind of friction, or their ranges over several kinds, as text.

    kinds: (slow, fast, rate) of dry friction or (lubrication,), as `Building.friction`.
    """
    dry = [kind for kind in kinds if len(kind) > 1]
    lubricated = [kind[0] for kind in kinds if len(kind) == 1]
    words = [f"lubrication: {_word_range(lubricated)} s/m"] if lubricated else []
    if any(slow != fast for slow, fast, _ in dry):
        slow, fast, rate = map(_word_range, zip(*dry))
        words.insert(0, f"friction: {slow} at rest, {fast} at high speed, rate {rate} s/m")
    elif dry:
        words.insert(0, f"friction: {_word_range([kind[0] for kind in dry])} at every speed")
    return "; ".join(words)


def _word_range(values: Sequence[float], digits: int = 4) -> str:
    """Return one value, or the least and the largest of several, as text."""
    return " to ".join(dict.fromkeys(f"{end:.{digits}g}" for end in (min(values), max(values))))


def _word_peaks(peaks: Sequence[float]) -> str:
    """Return the peak of the ground, m/s^2, or the least and the largest over several motions, as text."""
    if not any(peaks):
        return "none, the ground is at rest"
    return f"{_word_range(peaks, 3)} m/s^2 = {_word_range([peak / GRAVITY for peak in peaks], 3)} g"


def word_force(force: float) -> str:
    """Return a force, N, as text in a suitable unit."""
    unit, factor = next(((unit, size) for unit, size in (("MN", 1e6), ("kN", 1e3)) if force >= size), ("N", 1.0))
    return f"{force / factor:.4g} {unit}"


def _word_axes(values: Array, unit: str) -> str:
    """Return values along both axes (2, M) as text, once if they are equal."""
    along_x, along_y = (_word_values(axis, unit) for axis in values)
    return f"{along_x} along x and y" if along_x == along_y else f"{along_x} along x; {along_y} along y"


def _word_values(values: Sequence[float] | Array, unit: str) -> str:
    """Return the first MAX_NAMES_PER_LINE values, to three digits, with their unit and the number of the others."""
    more = f" and {len(values) - MAX_NAMES_PER_LINE} more" if len(values) > MAX_NAMES_PER_LINE else ""
    return f"{', '.join(f'{value:.3g}' for value in values[:MAX_NAMES_PER_LINE])} {unit}{more}"
