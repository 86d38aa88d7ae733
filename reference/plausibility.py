"""Values of a scene that are valid but hardly intended: a wrong unit shows in quantities computed from them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from reference.building import MAX_NAMES_PER_LINE, Building, word_force
from reference.problem import GRAVITY, Scene
from reference.records.description import G_UNIT_QUESTION, RecordDescription
from reference.support.arguments import Range, name_some

SUPPORT_LOAD_RANGE = Range(1e3, 1e8, "N")  # plausible dead load per support
# Total mass, kg, up to which a scene is taken to have unit masses as in the paper: masses and supports are not checked
MAX_UNIT_MASS_SCENE = 10.0
MIN_FRICTION_RATE = 1.0  # s/m: a smaller rate of change of friction with slip speed is hardly intended
MAX_SUPPORT_EXTENT = 300.0  # m: supports that are farther apart are hardly intended
MAX_EXTENT_OVER_SIZE = 2.0  # a larger ratio of the supports' extent to the platform's size is hardly intended
FIXED_BASE_PERIOD_RANGE = Range(0.05, 5.0, "s")  # plausible period of the first fixed-base mode along either axis
MAX_RADIUS = 50.0  # m: a larger radius of the pendulum is hardly intended
MAX_FRICTION = 1.0  # a larger friction coefficient is hardly intended
MAX_DAMPING_RATIO = 0.2  # a larger damping ratio of a fixed-base mode is hardly intended
MIN_MODAL_MASS_SHARE = 0.05  # the damping of modes that move less of the mass above the platform is not checked
MAX_GROUND_PEAK = 3.0  # g: a larger peak acceleration of the ground is hardly intended
MAX_DRIFT_RATIO = 0.1  # a larger ratio of story drift to story height is hardly intended
MASS_RATIO_RANGE = Range(0.01, 100.0)  # plausible ratio of a body's mass to the mean mass of the other bodies
MAX_LOAD_RATIO = 1.5  # a larger ratio of the largest to the smallest dead load of a support is hardly intended
MIN_ACCELERATION_LIMIT = 1.0  # m/s^2: a smaller limit on the acceleration of a floor is hardly intended
MIN_PEAK_RATIO = 0.2  # a smaller ratio of a motion's peak to the median peak of its suite is hardly intended


def implausible_values(scene: Scene, building: Building) -> list[str]:
    """Return a warning for each implausible value of a scene; building: result of `describe_building`."""
    lines = _implausible_modes(building)
    if scene.total_mass > MAX_UNIT_MASS_SCENE:
        lines += [*_implausible_masses(scene, building), *_implausible_supports(scene, building)]
    if MAX_RADIUS < scene.radius < math.inf:
        unit = "mm" if scene.isolator.period is None else "is period in s"
        lines.append(f"the radius of the isolator is {scene.radius:.4g} m, above {MAX_RADIUS:g} m: {unit}?")
    if (friction := scene.dry_friction.largest) > MAX_FRICTION:
        lines.append(f"the friction coefficient is {friction:.4g}: percent?")
    lines += _implausible_limits(scene, building)
    # `describe_record` warns of a record's own peak. Here a warning is due only if `scale` makes the peak too large.
    as_read = scene.largest_acceleration / (scene.excitation.scale or 1.0) if scene.recorded else 0.0
    if (peak := building.ground_peak / GRAVITY) > MAX_GROUND_PEAK and as_read <= MAX_GROUND_PEAK * GRAVITY:
        lines.append(f"the peak of the ground is {peak:.4g} g, above {MAX_GROUND_PEAK:g} g: unit or scale?")
    return lines


def implausible_suite(motions: Sequence[RecordDescription]) -> list[str]:
    """Return warnings about motions with fewer components, or a far smaller peak, than the others of their suite."""
    lines = []
    axes = ["".join(one.axis for one in motion.directions) for motion in motions]
    common = max(axes, key=lambda own: (axes.count(own), len(own)), default="")
    for own in dict.fromkeys(each for each in axes if len(each) < len(common)):
        names = name_some([motion.title for motion, each in zip(motions, axes) if each == own], MAX_NAMES_PER_LINE)
        verb, kind = ("has", "") if axes.count(own) == 1 else ("have", " each")
        others = f"{axes.count(common)} others have" if axes.count(common) > 1 else "other has"
        has = f"{' and '.join(own)}{' alone' * (len(own) == 1)}{kind}" if own else "no acceleration"
        lines.append(f"{names} {verb} {has}, the {others} {' and '.join(common)}: is a file left out?")
    peaks = [motion.largest_peak for motion in motions]
    median = float(np.median(peaks)) if peaks else 0.0
    for motion, peak in zip(motions, peaks):
        if 0.0 < peak < MIN_PEAK_RATIO * median:
            few = f"{peak / GRAVITY:.3g} g, below a fifth of the median of the suite, {median / GRAVITY:.3g} g"
            lines.append(f"the peak of {motion.title} is {few}: unit? {G_UNIT_QUESTION}")
    return lines


def implausible_drift(ratio: float, place: str) -> str:
    """Return a warning about an implausible ratio of drift to story height, "" for any other; place: story in words."""
    if ratio <= MAX_DRIFT_RATIO:
        return ""
    share = f"{100.0 * ratio:.3g} % of the height of the story, above {100.0 * MAX_DRIFT_RATIO:g} %"
    return f"the drift {place} is {share}: is stiffness in N/m?"


def _implausible_limits(scene: Scene, building: Building) -> Iterator[str]:
    """Iterate over warnings about limits on demands so high that no motion exceeds them, or so low that all do."""
    limits = scene.acceptance.demands
    if limits is None:
        return
    if limits.displacement is not None and limits.displacement > scene.radius:
        yield f"the limit on the displacement is {limits.displacement:.4g} m, above the radius of the isolator: mm?"
    if limits.drift_ratio is not None and limits.drift_ratio > MAX_DRIFT_RATIO:
        share = f"{limits.drift_ratio:.4g}, above {MAX_DRIFT_RATIO:g}"
        yield f"the limit on the drift ratio is {share}: percent?"
    load = building.load_per_support if building.support_loads is None else float(building.support_loads.max())
    if limits.support_force_max is not None and load is not None and limits.support_force_max < load:
        in_kilonewtons = (
            f": kN? Write {1e3 * limits.support_force_max:g}" if 1e3 * limits.support_force_max > load else ""
        )
        stated = f"{limits.support_force_max:.4g} N, below the dead load of {word_force(load)}"
        yield f"the limit on the force of a support is {stated}{in_kilonewtons}"
    if (
        limits.acceleration is not None
        and limits.acceleration < MIN_ACCELERATION_LIMIT
        and scene.total_mass > MAX_UNIT_MASS_SCENE
    ):
        stated = f"{limits.acceleration:.4g} m/s^2, below {MIN_ACCELERATION_LIMIT:g} m/s^2"
        yield f"the limit on the acceleration is {stated}: g? Write {limits.acceleration * GRAVITY:.4g}"


def _implausible_modes(building: Building) -> list[str]:
    """Return the warnings about implausible periods and damping of the modes above a fixed base."""
    if building.bodies == 1:
        return []
    lines: list[str] = []
    periods = sorted(map(float, building.fixed_base_period[:, 0]), reverse=True)
    if (period := next((each for each in periods if each not in FIXED_BASE_PERIOD_RANGE), None)) is not None:
        limit = _word_end_beyond(period, FIXED_BASE_PERIOD_RANGE, lambda value: f"{value:g} s")
        lines.append(f"the period above a fixed base is {period:.4g} s, {limit}: stiffness in N/m, mass in kg?")
    damping, mass = building.modal_damping, building.modal_mass
    if (beyond := np.argwhere(((damping > MAX_DAMPING_RATIO) & (mass >= MIN_MODAL_MASS_SHARE)).T)).size:
        mode, axis = beyond[0]
        share = f"{100.0 * damping[axis, mode]:.4g} % of critical, above {100.0 * MAX_DAMPING_RATIO:g} %"
        which = "the first mode" if mode == 0 else f"mode {mode + 1} along {'xy'[axis]}"
        why = "percent?" if mode == 0 else f"it moves {100.0 * mass[axis, mode]:.2g} % of the mass; is this meant?"
        lines.append(f"the damping of {which} above a fixed base is {share}: {why}")
    return lines


def _implausible_masses(scene: Scene, building: Building) -> Iterator[str]:
    """Iterate over warnings about an implausible support load, and about the mass that differs most from the others."""
    load = building.load_per_support
    if load is not None and load not in SUPPORT_LOAD_RANGE:
        limit = _word_end_beyond(load, SUPPORT_LOAD_RANGE, word_force)
        yield f"the weight on each support is {word_force(load)}, {limit}: is mass in kg?"
    if len(scene.bodies) == 1:
        return
    with np.errstate(divide="ignore"):  # infinite where the sum of all other masses rounds to zero
        ratios = scene.masses * (len(scene.bodies) - 1) / (scene.total_mass - scene.masses)
    place = int(np.argmax(np.abs(np.log(ratios))))
    if (ratio := float(ratios[place])) not in MASS_RATIO_RANGE:
        limit = _word_end_beyond(ratio, MASS_RATIO_RANGE, lambda value: f"{value:g}")
        mass = f"the mass of {_name_body(scene, place)} is {scene.masses[place]:.4g} kg"
        yield f"{mass}, {ratio:.2g} times the mean of the others, {limit}: kg in one place and t in another?"


def _implausible_supports(scene: Scene, building: Building) -> Iterator[str]:
    """Iterate over warnings about an implausible law of friction, positions of supports and heights of bodies."""
    law = scene.dry_friction
    if law.varies and law.rate < MIN_FRICTION_RATE:
        yield f"the rate of friction is {law.rate:.4g} s/m, below {MIN_FRICTION_RATE:g} s/m: s/mm?"
    if law.varies and law.fast < law.slow <= MAX_FRICTION:
        yield f"friction falls with the speed, from {law.slow:.4g} at rest to {law.fast:.4g}: slow and fast swapped?"
    if building.support_extent is not None:
        extent, size = float(building.support_extent.max()), scene.bodies[0].size
        if extent > MAX_SUPPORT_EXTENT:
            yield f"the supports stand {extent:.4g} m apart, above {MAX_SUPPORT_EXTENT:g} m: mm?"
        elif size is not None and extent > MAX_EXTENT_OVER_SIZE * max(size[:2]):
            largest = f"more than twice the platform of {max(size[:2]):.4g} m"
            yield f"the supports stand {extent:.4g} m apart, {largest}: are places and size both in m?"
    yield from _unequal_loads(scene, building)
    if building.heights is None:
        return
    if (falls := np.flatnonzero(np.diff(building.heights) <= 0.0)).size:
        lower, upper = (
            f"{_name_body(scene, place)} at {scene.bodies[place].height:.4g} m" for place in falls[0] + (0, 1)
        )
        yield f"{upper} is not above {lower}, the body below it: bodies stand in the file from the platform up"
    if building.supports is None or scene.flat or building.heights[0] >= 0.0:
        return
    stated = float(scene.bodies[0].height or 0.0)
    depression = stated - float(building.heights[0])
    yield (
        f"the center of mass of {_name_body(scene, 0)} lies {-float(building.heights[0]):.3g} m below the sliding "
        "contact: height counts from the centers of the depressions. Where yours count from the contact, add "
        f"R = {depression:.4g} m to every height: {stated + depression:.4g} for {stated:.4g} m above the contact"
    )


def _unequal_loads(scene: Scene, building: Building) -> Iterator[str]:
    """Yield a warning if the dead loads of the supports are far from equal."""
    loads, places = building.support_loads, scene.support_places
    if loads is None or places is None or loads.max() <= MAX_LOAD_RATIO * loads.min():
        return
    ends = (
        f"{word_force(loads[place])} on support {place + 1} at [{places[place][0]:.4g}, {places[place][1]:.4g}] m"
        for place in map(int, (loads.argmin(), loads.argmax()))
    )
    off = scene.center_of_mass - places.mean(axis=0)
    offset = ", or an offset of a body too large" if scene.offsets.any() else ""
    yield (
        f"the dead loads of the supports go from {' to '.join(ends)}, as the center of mass is [{off[0]:.3g}, "
        f"{off[1]:.3g}] m off their middle: is a support missing{offset}?"
    )


def _name_body(scene: Scene, place: int) -> str:
    """Return the name of a body in warnings: its floor in quotes if the scene states one, otherwise its number."""
    return f'"{floor}"' if (floor := scene.bodies[place].floor) else f"body {place + 1}"


def _word_end_beyond(value: float, allowed: Range, word: Callable[[float], str]) -> str:
    """Return "below" and the lowest, or "above" and the highest value of a range outside which `value` lies."""
    return f"below {word(allowed.lowest)}" if value < allowed.lowest else f"above {word(allowed.highest)}"
