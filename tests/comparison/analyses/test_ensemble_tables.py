"""Every table, sentence and plot of an ensemble, whole, against planted demands of which none equals another."""

import html
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import pytest

import reference
from comparison.analyses.ensemble import page, panels, sentences
from comparison.analyses.ensemble.analysis import EnsemblePoints, MotionDemandsAtScale
from comparison.analyses.ensemble.build import build_result
from comparison.analyses.ensemble.governing import ChosenMember
from comparison.analyses.ensemble.limits import check_limits, list_verdicts
from comparison.analyses.ensemble.members import EnsembleMember
from comparison.analyses.ensemble.result import EnsembleResult, MatchedMotion, Statistic, TargetSpectrum
from comparison.analyses.ensemble.terminal import print_engine, print_equations
from comparison.runner import progress
from reference.measures import Estimate, FloorSpectra, StoryForces
from reference.problem import GRAVITY, Scene
from reference.problem.acceptance import DemandLimits
from reference.problem.families import make_family
from reference.problem.scene_file import scene_tables
from reference.records.motion_lists import Motion

LOADING = (
    "excitation = {amplitudes = [[1.0, 0.0], [0.0, 1.0]], periods = [1.0, 1.0], decay = [0.1, 0.1]}\nduration = 1.0"
)
TOWER = """title = "A tower"
isolator.radius = 2.0
isolator.friction = {slow = 0.03, fast = 0.06, rate = 50.0}
isolator.sphere_radius = 0.1
isolator.travel = 0.5
isolator.supports = [[3.0, 2.0], [-3.1, 2.2], [-3.3, -2.4], [3.5, -2.6]]
superstructure.damping = 0.03
bodies = [{mass = 40e3, height = 2.6, size = [7.0, 5.5, 0.6], floor = "deck"},
          {mass = 31e3, height = 5.7, size = [7.2, 5.3, 0.3], stiffness = [30e6, 21e6]},
          {mass = 22e3, height = 8.9, stiffness = [19e6, 25e6], floor = "roof"}]
"""
HOUSE = """title = "A house & yard"
isolator.radius = 1.6
isolator.friction = {slow = 0.04, fast = 0.07, rate = 45.0}
isolator.supports = [[2.0, 1.1], [-2.2, 1.3], [0.4, -1.5]]
bodies = [{mass = 25e3, height = 1.2, size = [5.0, 3.5, 0.5], offset = [0.1, -0.2]},
          {mass = 11e3, height = 4.6, stiffness = [9e6, 8e6], damping = [2.1e4, 1.7e4]}]
"""
RADIUS, FRICTION, WEIGHTS = (2.0, 1.6), ((0.03, 0.06), (0.04, 0.07)), (93e3 * GRAVITY, 36e3 * GRAVITY)
PLACES = ("3 2", "-3.1 2.2", "-3.3 -2.4", "3.5 -2.6"), ("2 1.1", "-2.2 1.3", "0.4 -1.5")
NAMES = {"short": ("x[lower bound]", "x[upper bound]"), "long": ("tower[lower bound]", "house[upper bound]")}
LABELS = {"short": ("lower bound", "upper bound"), "long": NAMES["long"]}
SCALES, MOTIONS = (0.5, 0.8, 2.0), ("Chi-Chi", "El Centro", "Kobe", "Northridge", "Tabas")
FLOORS = ("deck", "body 2", "roof"), ("platform", "body 2")  # A place of several structures has the name of the first.
LOST = {(0, "Tabas", 2.0): 7.654, (0, "El Centro", 0.8): 3.21}  # when the travel is reached, s
STAYS, MOVING = (1, "Chi-Chi", 2.0), "moving at the end: take a longer duration"
CHOSEN = {
    (0, "Kobe"): ("largest drift", "largest displacement"), (0, "Northridge"): ("asked for",),
    (0, "Tabas"): ("largest base shear",), (1, "El Centro"): ("nearest the median displacement",),
    (1, "Kobe"): ("largest support force",), (1, "Northridge"): ("smallest support force",),
}  # fmt: skip
FAILED, OTHERS = (1, "Northridge", "spatial"), ("small", "regularised", "translational", "spatial")
SIZES = {  # SI size, and the bodies of the tower that have the demand
    "displacement": (0.18, [0]), "base_shear": (9e4, [0]), "residual": (0.02, [0]), "support_displacement": (0.2, [0]),
    "acceleration": (3.0, [1, 2, 3]), "acceleration_supremum": (3.0, [1, 2, 3]), "story_shear": (5e4, [1, 2, 3]),
    "story_shear_x": (4e4, [1, 2, 3]), "story_shear_y": (3e4, [1, 2, 3]), "overturning_moment": (2e5, [1, 2, 3]),
    "overturning_moment_x": (1.5e5, [1, 2, 3]), "overturning_moment_y": (1.2e5, [1, 2, 3]), "drift": (0.01, [2, 3]),
    "drift_x": (0.008, [2, 3]), "drift_y": (0.007, [2, 3]), "drift_ratio": (0.085, [2, 3]),
    "smallest": (4e4, [1, 2, 3, 4]), "largest": (3e5, [1, 2, 3, 4]), "gap": (2e-3, [1, 2, 3, 4]),  # of the supports
}  # fmt: skip
MODELS = {"support_displacement": ("spatial",), "gap": ("spatial",), "acceleration_supremum": ("exact", "small"),
          "smallest": ("exact", "spatial"), "largest": ("exact", "spatial")}  # fmt: skip
OF_SUPPORTS = {"support_force_min": ("smallest", min), "support_force_max": ("largest", max), "uplift": ("gap", max)}
# Structure, demand, body or support, motion, scale, model
RAW: dict[tuple[int, str, int, str, float, str], Estimate] = {}


def draw() -> None:
    """All demands; those of the engine are of its motions at the largest scale."""
    random = np.random.default_rng(37)
    for structure in (0, 1):
        for quantity, (size, bodies) in SIZES.items():
            for body in bodies[: len(bodies) - structure * (bodies[-1] > 1)]:
                for motion in MOTIONS:
                    for scale in SCALES:
                        base = size * scale / 2.0 * random.uniform(1.0, 2.0) * (1.0, 0.95)[structure]
                        for model in MODELS.get(quantity, ("exact", *OTHERS)):
                            value = base * (1.0 if model == "exact" else random.uniform(0.8, 1.25))
                            error = value * random.uniform(1e-3, 4e-3)
                            chosen = scale == 2.0 and (structure, motion) in CHOSEN
                            if model == "exact" or (chosen and (structure, motion, model) != FAILED):
                                RAW[structure, quantity, body, motion, scale, model] = Estimate(value, error)
    for (structure, quantity, body, motion, scale, model), number in [*RAW.items()]:
        if quantity in ("smallest", "largest") and model == "spatial":  # by statics, which no table compares
            for other in OTHERS[:-1]:
                RAW[structure, quantity, body, motion, scale, other] = Estimate(1.1 * number.value, number.error)
    for (structure, quantity, body, *at), number in [*RAW.items()]:
        if quantity == "acceleration_supremum" and body == 2:
            RAW[structure, quantity, body, *at] = RAW[structure, "acceleration", body, *at]
        if quantity == "displacement" and structure == 0:
            RAW[structure, "travel_share", body, *at] = Estimate(number.value / 0.5, number.error / 0.5)
        for one, (many, choose) in OF_SUPPORTS.items():
            if quantity == many:
                own = [RAW[structure, many, number, *at] for number in range(1, len(PLACES[structure]) + 1)]
                RAW[structure, one, 0, *at] = choose(own, key=lambda each: each.value)
    for structure, quantity, body, motion, scale, model in [*RAW]:
        at = structure, motion, scale
        if model == "exact" and (at in LOST or (at == STAYS and quantity == "residual")):
            del RAW[structure, quantity, body, motion, scale, model]


draw()


def known(s: int, quantity: str, body: int = 0, model: str = "exact", scale: float = 2.0) -> dict[str, Estimate]:
    """A demand by motion that has it."""
    at = {motion: (s, quantity, body, motion, scale, model) for motion in MOTIONS}
    return {motion: RAW[key] for motion, key in at.items() if key in RAW}


TIME = np.arange(0.0, 3.0, 0.05)


def ground(number: int) -> np.ndarray:
    """A motion along x, y and in the first two of them z, m/s^2."""
    along = [(1.0 + 0.3 * number + 0.4 * axis) * np.sin((4.0 + number + axis) * TIME) for axis in range(3)]
    return np.transpose(along[: 3 if number < 2 else 2])


@cache
def scene(structure: int, number: int = 0, scale: float = 1.0) -> Scene:
    (read,) = make_family(scene_tables(((TOWER, HOUSE)[structure] + LOADING).encode(), "a"), "a.toml").scenes
    loading = {"record": {"time": TIME, "acceleration": ground(number)}, "scale": scale}
    return read.with_values({"duration": float(TIME[-1]), "excitation": loading})


def point(names: Sequence[str], structure: int, number: int, scale: float, model: str) -> MotionDemandsAtScale:
    motion = MOTIONS[number]
    member = EnsembleMember(names[structure], motion, scale, scene(structure, number, scale))
    if (structure, motion, scale) in LOST and model == "exact":
        return MotionDemandsAtScale(member, model, "travel reached", instant=LOST[structure, motion, scale])
    if (structure, motion, model) == FAILED:
        return MotionDemandsAtScale(member, model, "tolerance not met")
    own = {key[1:3]: each for key, each in RAW.items() if (key[0], *key[3:]) == (structure, motion, scale, model)}
    supports = [
        [own.pop((name, n)) for n in range(1, 5) if (name, n) in own] for name in ("smallest", "largest", "gap")
    ]
    if (structure, motion, scale) == STAYS and model == "exact":
        own["residual", 0] = Estimate(math.nan, math.nan, MOVING)
    bodies = len(FLOORS[structure])
    accelerations = (1.0 + number + 7.0 * structure) * np.arange(1.0, 6.0 * bodies + 1.0).reshape(bodies, 2, 3)
    spectra = FloorSpectra(np.array([0.1, 0.5, 3.0]), 0.05, accelerations, 0.01 * accelerations)
    forces = StoryForces((), None, *(tuple(each) or None for each in supports))
    return MotionDemandsAtScale(member, model, "ok", own, spectra if model == "exact" else None, forces)


def plant(names: Sequence[str] = NAMES["short"], scales: Sequence[float] = SCALES) -> EnsembleResult:
    """Two structures under five motions; the engine computes three of each at the largest scale."""
    equations = [point(names, s, n, scale, "exact") for s in (0, 1) for n in range(5) for scale in scales]
    at = [(s, MOTIONS.index(motion)) for s, motion in CHOSEN]
    compared = {model: [point(names, *each, 2.0, model) for each in at if 2.0 in scales] for model in OTHERS}
    chosen = [ChosenMember(each.member, why) for each, why in zip(compared["small"], CHOSEN.values())]
    facts = {"command": "ensemble a", "began": "2031-02-03T04:05:06", "compute_seconds": 12.5, "scenes": {},
             "provenance": {"processor": "a chip", "phase-resonance": "9.8", "commit": "abc"}}  # fmt: skip
    matched = [MatchedMotion(name, 1.1 + 0.13 * n, [2.0 + n, 1.0 + n]) for n, name in enumerate(MOTIONS)]
    target = TargetSpectrum(0.2, 1.5, [0.2, 1.5], [3.0, 2.0], matched)
    listed = {"Kobe": Motion("Kobe", {}, 1.3, 6.9)}
    return build_result(EnsemblePoints(equations, chosen, compared), facts, 0.02, target, listed)


class Told(NamedTuple):
    """Mean, three fractiles and worst value of a demand, each with error and mark; motion and body of the worst."""

    numbers: list[tuple[float | None, float, str]]
    motion: str
    body: int
    motions: str


def hazen(values: Sequence[float], share: float, lost: Sequence[float] = ()) -> float | None:
    ordered = sorted([*values, *lost])
    at = share * len(ordered) - 0.5
    low, high = ordered[int(at)], ordered[int(at) + 1]
    return low + at % 1.0 * (high - low) if math.isfinite(low) and math.isfinite(high) else None


def over_bodies(s: int, quantity: str, bodies: Sequence[int], **at: Any) -> dict[str, tuple[Estimate, int]]:
    """Of every motion the largest value over bodies, and its body."""
    rows = [(motion, one, body) for body in bodies for motion, one in known(s, quantity, body, **at).items()]
    ordered = sorted(rows, key=lambda each: (MOTIONS.index(each[0]), each[1].value))
    return {motion: (number, body) for motion, number, body in ordered}


def tell(structure: int, quantity: str, bodies: Sequence[int] = (0,), scale: float = 2.0) -> Told | None:
    """The statistics of the largest value over bodies; None without such a demand."""
    found = over_bodies(structure, quantity, bodies, scale=scale)
    if not found:
        return None
    smallest, count = quantity.endswith("_min"), len(found)
    motion = (min if smallest else max)(found, key=lambda each: found[each][0].value)
    values, errors = zip(*((number.value, number.error) for number, _ in found.values()))
    (worst, body), lost = found[motion], [-math.inf if smallest else math.inf] * (5 - count)
    shares = [(hazen(values, share, lost), 0.0, "") for share in (0.16, 0.5, 0.84)]
    mean, error, last = sum(values) / count, sum(errors) / count, (worst.value, worst.error)
    if not lost:
        return Told([(mean, error, ""), *shares, (*last, "")], motion, body, "5")
    if limit := {"displacement": 0.5, "travel_share": 1.0}.get(quantity):
        least = limit, 0.0, "≥ "
        shares = [least if each[0] is None else each for each in shares]
        return Told([((sum(values) + limit) / 5, error, "≥ "), *shares, least], "", body, "4 of 5")
    return Told([(mean, error, " (of 4)"), *shares, (*last, "≤ " if smallest else "≥ ")], motion, body, "4 of 5")


def word(value: float | None, error: float = 0.0, mark: str = "") -> str:
    if value is None:
        return "none"
    text = f"{value:.4g}" + (f" ± {float(f'{error:.1g}'):g}" if error else "")
    return text + mark if mark.startswith(" ") else mark + text


def say(number: Estimate, factor: float) -> str:
    return word(factor * number.value, factor * number.error)


@dataclass
class Row:
    name: str
    unit: str
    bound: str
    cells: list[str]
    motion: str
    where: str
    motions: str
    bounds: Sequence[str] = ()  # of an envelope whose bounds have short names


def factor_of(by: float | None, structure: int) -> float:
    """The factor to the display unit; of a share of the weight that of the structure."""
    return 100.0 / WEIGHTS[structure] if by is None else by


def place_of(structure: int, quantity: str, body: int) -> str:
    floor = FLOORS[structure][body - 1]
    return floor if "accel" in quantity else "isolator" if body == 1 else f"below {floor}"


def make_rows(column: Sequence[Any], labels: Sequence[str], scale: float = 2.0) -> Iterator[Row]:
    """The rows of one demand: of both structures, then of their envelope."""
    name, quantity, unit, by, bodies = column
    sign, found = (-1.0 if quantity.endswith("_min") else 1.0), []

    def cell(structure: int, told: Told, place: int, mark: str) -> str:
        value, error, _ = told.numbers[place]
        factor = factor_of(by, structure)
        end = " (smallest)" * (place == 4 and sign < 0.0)
        return "none" if value is None else word(factor * value, factor * error, mark) + end

    def where(structure: int, told: Told) -> str:
        return place_of(structure, quantity, told.body) if len(bodies) == 3 and told.motion else ""

    for structure in (0, 1):
        if told := tell(structure, quantity, bodies, scale):
            found.append((structure, told))
            cells = [cell(structure, told, place, told.numbers[place][2]) for place in range(5)]
            yield Row(name, unit, labels[structure], cells, told.motion, where(structure, told), told.motions)
    cells, at = [], []
    for place in range(5 if len(found) == 2 else 0):
        sized = [
            (sign * factor_of(by, each[0]) * value, each) for each in found if (value := each[1].numbers[place][0])
        ]
        if sized:
            _, (structure, told) = max(sized)
            sure = len(sized) == 2 and not any(each.numbers[place][2] for _, each in found)
            mark = "" if sure else told.numbers[place][2] or ("≤ " if sign < 0.0 else "≥ ")
        cells.append(cell(structure, told, place, mark))
        at.append(labels[structure].removesuffix(" bound") if sized else "")
    if cells:
        short = "" not in at and max(map(len, at)) <= 8
        motion = told.motion + ("" if short or not told.motion else f", {labels[structure]}")
        yield Row(name, unit, "envelope", cells, motion, where(structure, told), "", at * short)


G, EVERY = 1.0 / GRAVITY, (1, 2, 3)
MAIN = (  # name, demand, unit, factor, bodies
    ("isolator displacement", "displacement", "mm", 1e3, (0,)),
    ("support displacement, with torsion", "support_displacement", "mm", 1e3, (0,)),
    ("displacement over travel", "travel_share", "%", 100.0, (0,)),
    ("base shear", "base_shear", "kN", 1e-3, (0,)),
    ("base shear over weight", "base_shear", "%", None, (0,)),
    ("platform acceleration, as integrated", "acceleration", "g", G, (1,)),
    ("platform acceleration, literal supremum", "acceleration_supremum", "g", G, (1,)),
    ("floor acceleration, as integrated", "acceleration", "g", G, EVERY),
    ("floor acceleration, literal supremum", "acceleration_supremum", "g", G, EVERY),
    ("largest drift", "drift", "mm", 1e3, EVERY),
    ("largest drift ratio", "drift_ratio", "%", 100.0, EVERY),
    ("overturning moment at the isolator", "overturning_moment", "kN m", 1e-3, (1,)),
    ("largest support force", "support_force_max", "kN", 1e-3, (0,)),
    ("smallest support force", "support_force_min", "kN", 1e-3, (0,)),
    ("uplift of a support", "uplift", "mm", 1e3, (0,)),
    ("residual displacement", "residual", "mm", 1e3, (0,)),
)
PROFILES = (  # demand, its title, unit, factor
    ("acceleration", "floor acceleration, as integrated", "g", G),
    ("acceleration_supremum", "floor acceleration, literal supremum", "g", G),
    ("drift", "drift against the body below", "mm", 1e3),
    ("drift_ratio", "drift over the height of the story", "%", 100.0),
    ("story_shear", "story shear", "kN", 1e-3),
    ("overturning_moment", "overturning moment", "kN m", 1e-3),
)
OVER_HEIGHT = [each for each in PROFILES if each[0] not in ("acceleration_supremum", "drift")]
DIRECTIONS = (("story_shear", "story shear", "kN", 1e-3), ("drift", "drift", "mm", 1e3),
              ("overturning_moment", "overturning moment of the forces", "kN m", 1e-3))  # fmt: skip
COMPARED = [MAIN[number] for number in (0, 3, 5, 7, 9, 11, 12, 13)]  # by models
COLUMNS = ("small", "translational", "spatial")


def main_rows(labels: Sequence[str], scale: float = 2.0) -> list[Row]:
    rows: list[Row] = []
    for column in MAIN:
        name, quantity, unit, by, _ = column
        if quantity not in ("support_displacement", "uplift"):
            rows += make_rows(column, labels, scale)
            continue
        for structure in (0, 1) if scale == 2.0 else ():
            own = known(structure, quantity, model="spatial")
            motion = max(own, key=lambda each: own[each].value)
            count = f"{len(own)} of 5 (spatial engine)"
            cells = ["–"] * 4 + [say(own[motion], by)]
            rows.append(Row(name, unit, labels[structure], cells, motion, "", count))
    return rows


def profile_rows(quantity: str, unit: str, factor: float, labels: Sequence[str]) -> list[Row]:
    columns = [(place_of(0, quantity, body), quantity, unit, factor, (body,)) for body in (3, 2, 1)]
    return [row for column in columns for row in make_rows(column, labels)]


def ratios_by_hand(structure: int, quantity: str, bodies: Sequence[int]) -> tuple[float, dict[str, dict[str, float]]]:
    """Mean by the equations over the motions that all models have, and by model and motion the ratio to them."""
    models = ("exact", "spatial") if "force" in quantity else ("exact", *OTHERS)
    own = {model: over_bodies(structure, quantity, bodies, model=model) for model in models}
    common = [motion for motion in MOTIONS if all(motion in each for each in own.values())]
    values = {model: {motion: own[model][motion][0].value for motion in common} for model in models}
    exact = values["exact"]
    ratios = {model: {motion: each[motion] / exact[motion] for motion in common} for model, each in values.items()}
    return sum(exact.values()) / len(common), ratios


def model_rows(structure: int) -> Iterator[tuple[str, str, list[str], list[str]]]:
    """Demand, mean, and of every column mean difference and its range."""
    for name, quantity, unit, factor, bodies in COMPARED:
        mean, by_model = ratios_by_hand(structure, quantity, bodies)
        briefs, texts = [], []
        for model in COLUMNS:
            ratios = [100.0 * (ratio - 1.0) for ratio in by_model.get(model, {}).values()]
            if ratios:
                low, middle, high = (f"{each:+.2f}".replace("-", "−") for each in (
                    min(ratios), sum(ratios) / len(ratios), max(ratios)))  # fmt: skip
            briefs.append(f"{middle} %" if ratios else "")
            texts.append(f"{middle} % ({low} to {high})" if ratios else "")
        yield name, f"{mean * factor:.4g} {unit}", briefs, texts


def trust_by_hand(labels: Sequence[str]) -> str:
    """The sentence on the models: the largest difference of single motions of every kind."""

    def largest(upper: str, lower: str, smallest: bool = False) -> str:
        found = []
        for structure, label in enumerate(labels):
            for name, quantity, _, _, bodies in COMPARED:
                _, by_model = ratios_by_hand(structure, quantity, bodies)
                base = by_model["exact" if "force" in quantity and lower == "translational" else lower
                                if lower in by_model else "exact"]  # fmt: skip
                if upper in by_model and quantity.endswith("_min") == smallest:
                    for motion, ratio in by_model[upper].items():
                        place = f"{name}, " * (not smallest) + f"{label}, {motion}"
                        found.append((abs(ratio / base[motion] - 1.0), place))
        size, place = max(found)
        return f"up to {100.0 * size:.2g} % ({place})"

    return (
        "On the 4 motions that all models computed, four things are apart: the geometry of the sphere, which the small "
        f"equations leave out, is worth {largest('small', 'exact')}; given the same equations and friction law, the "
        f"two codes differ by {largest('translational', 'regularised')}; the regularized friction of the engines, "
        f"which the exact equations have not, is worth {largest('regularised', 'exact')}; bodies that turn on their "
        f"supports change a demand by {largest('spatial', 'translational')}, and the smallest support force, against "
        f"statics, by {largest('spatial', 'translational', smallest=True)}."
    )


def supports_said(labels: Sequence[str]) -> list[str]:
    """Largest and smallest force and the uplift over supports, bounds and motions, by the equations and the engine."""
    said = []
    for model, by, counts in (("exact", "equations and statics", ("4 of 5", "5")),
                              ("spatial", "spatial engine", ("3 of 5", "2 of 5"))):  # fmt: skip
        parts = []
        for name, choose in (("largest", max), ("smallest", min), ("gap", max)):
            every = {at: each for at, each in RAW.items() if (at[1], *at[4:]) == (name, 2.0, model)}
            if every:
                structure, _, number, motion, *_ = choose(every, key=lambda at: every[at].value)
                number_said, place = known(structure, name, number, model)[motion], PLACES[structure][number - 1]
                where = f"support {number} at [{place.replace(' ', ', ')}] m ({motion}, {labels[structure]})"
                gap = f"largest uplift {1e3 * number_said.value:.4g} mm at support {number} ({labels[structure]})"
                parts.append(gap if name == "gap" else f"{name} force {say(number_said, 1e-3)} kN, {where}")
        of = ", ".join(f"{count} motions of the {label}" for count, label in zip(counts, labels))
        said.append(f"By the {by}, {of}: {'; '.join(parts)}.")
    return [f"{said[0]} The worst may be under a motion without a value.", said[1]]


def isolator_by_hand(structure: int) -> tuple[str, str, str]:
    """Its sentence, its cell on the page, and the ratio: of the bilinear loop at mean or median displacement."""
    radius, (_, friction), place = RADIUS[structure], FRICTION[structure], (2, 0)[structure]
    moved = tell(structure, "displacement").numbers[place][0]  # type: ignore[union-attr]
    stiffness = 1.0 / radius + friction / moved  # over the weight
    period, damping = 2.0 * math.pi / math.sqrt(GRAVITY * stiffness), 200.0 / math.pi * friction / moved / stiffness
    at = f"at the {('median', 'mean')[structure]} displacement, {1e3 * moved:.4g} mm, and friction {friction}"
    ratio = f"{moved / radius / friction:.3g}"
    said = f"{at}: period {period:.3g} s, damping {damping:.0f} %, re-centering ratio {ratio}."
    return f"Effective isolator of design codes {said}", f"{period:.3g} s, {damping:.3g} % {at}", ratio


def drift_by_hand(structure: int) -> str:
    motion, (number, body) = max(over_bodies(structure, "drift_ratio", EVERY).items(), key=lambda at: at[1][0].value)
    share = f"{100.0 * number.value:.3g} % of the height of the story, above 10 %"
    return f"Warning: the drift {place_of(structure, 'drift', body)} under {motion} is {share}: is stiffness in N/m?"


SCALED_SAID = (
    "Scale 1 is that of the target spectrum: least squares over periods from 0.2 to 1.5 s, in the logarithm, at 5 % "
    "damping."
)


def sentences_by_hand(labels: Sequence[str]) -> list[str]:
    """What the terminal says after the tables of the equations; the last is the answer."""
    first, second = labels
    moved, shear = tell(1, "displacement"), tell(1, "base_shear")
    mean, largest, share, most = (
        factor * told.numbers[at][0] for told, factor in ((moved, 1e3), (shear, 100.0 / WEIGHTS[1])) for at in (0, 4)
    )  # fmt: skip
    return [
        f"{first}: {isolator_by_hand(0)[0]}", f"{first}: {drift_by_hand(0)}",
        f"{second}: Without a value for 1 motion: residual displacement ({MOVING}).",
        f"{second}: {isolator_by_hand(1)[0]}",
        f"{second}: The center of mass of the platform is 0.4 m below the sliding contact: `height` counts from the "
        "centers of the depressions, which lie R = radius + sphere_radius below it.",
        f"{second}: {drift_by_hand(1)}",
        f"The travel is reached under Tabas at 7.654 s ({first}). No demand has a value there. A run without `travel` "
        "gives the displacement that is needed.",
        f"No value under Tabas ({first}). Isolator displacement: at least the travel, 500 mm ({first}); mean "
        f"{mean:.4g} mm, largest {largest:.4g} mm ({second} alone, {moved.motion}); base shear: mean {share:.4g} % of "
        f"the weight, largest {most:.4g} % of the weight ({second} alone, {shear.motion}). Outcomes by the equations: "
        "28 ok, 2 travel reached.",
    ]  # fmt: skip


def chosen_said(labels: Sequence[str]) -> list[str]:
    return [
        f"The spatial engine computed, {labels[0]}: Kobe (largest drift, largest displacement); Northridge (asked "
        "for); Tabas (largest base shear).",
        f"The spatial engine computed, {labels[1]}: El Centro (nearest the median displacement); Kobe (largest support "
        "force); Northridge (smallest support force; tolerance not met).",
        "The engine was asked for largest accelerations to 2 %.",
    ]


HEADS = ["mean", "16 %", "50 %", "84 %", "largest"]


@pytest.mark.parametrize("names", NAMES)
def test_the_terminal_shows_every_table_and_sentence(names: str, capsys: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    found, labels = plant(NAMES[names]), LABELS[names]
    monkeypatch.setattr(progress, "PLAIN_WIDTH", 400)  # No cell is folded.
    console = progress.make_wide_console()
    print_equations(console, found)
    print_engine(console, found)
    lines = [line.strip() for line in capsys.readouterr().out.splitlines()]
    printed = [re.split(r"\s{2,}", line) for line in lines if line and not {*line} <= {"─", " "}]
    expected = [[SCALED_SAID], ["motion", "factor"]]
    expected += [[motion, f"{1.1 + 0.13 * number:.4g}"] for number, motion in enumerate(MOTIONS)]
    expected.append(["A tower, A house & yard: 5 motions, scale 2."])
    for bound in (*labels, "envelope"):
        expected += [[f"{bound.replace('env', 'Env')}:"], ["quantity", "unit", *HEADS, "motion"]]
        for row in main_rows(labels):
            mean, *others = row.cells
            last = ", ".join(filter(None, [row.motion, row.where, *row.bounds[-1:]]))
            cells = [row.name, row.unit, mean, *(each.partition(" ±")[0] for each in others), last]
            expected += [[*filter(None, cells)]] if row.bound == bound else []
    expected += [[line] for line in (*sentences_by_hand(labels), *chosen_said(labels))]
    for structure, label in enumerate(labels):
        expected += [[f"{label}, mean difference from the exact equations on 2 motions:"],
                     ["quantity", "exact", "small", "translational", "spatial"]]  # fmt: skip
        expected += [[name, mean, *filter(None, briefs)] for name, mean, briefs, _ in model_rows(structure)]
    assert printed == [*expected, [trust_by_hand(labels)], *([line] for line in supports_said(labels))]


def test_the_answer_is_of_the_bound_where_each_demand_is_largest() -> None:
    found, labels = plant(scales=(0.5,)), LABELS["short"]
    said = []
    for quantity, unit, by in (("displacement", "mm", 1e3), ("base_shear", "% of the weight", None)):
        told = [(tell(structure, quantity, scale=0.5), factor_of(by, structure), structure) for structure in (0, 1)]
        read = [(*(factor * one.numbers[place][0] for place in (4, 0)), at, one.motion) for one, factor, at in told]
        largest, mean, at, motion = max(read)
        share = f" = {largest / 5.0:.0f} % of the travel" if (quantity, at) == ("displacement", 0) else ""
        said.append(f"mean {mean:.4g} {unit}, largest {largest:.4g} {unit}{share} ({labels[at]}, {motion})")
    assert len({line.partition("(")[2].partition(",")[0] for line in said}) == 2, "of two bounds"
    assert sentences.answer_sentence(found) == (
        f"Isolator displacement: {said[0]}; base shear: {said[1]}. Outcomes by the equations: 10 ok."
    )
    assert "at the travel" not in str(drawn(panels.make_isolator_panels(found))), "none reaches it"
    both = plant()
    ended = [*both.ended, *(replace(each, scale=0.8) for each in both.ended)]
    plots = drawn(panels.make_isolator_panels(replace(both, ended=ended))).values()
    arrows = [each["x"] for plot in plots for each in plot["series"] if "at the travel" in each["name"]]
    assert arrows == [[0.8, 0.8]], "where it begins"
    heads = [
        sentences.word_heading(replace(found, scales=scales, stripes=[])) for scales in ((1.0,), (0.5,), (0.5, 1.0))
    ]
    assert [head.partition("motions")[2] for head in heads] == ["", ", scale 0.5", ", scale 1"]


Table = list[list[str]]


def sections_of(text: str) -> dict[str, tuple[list[Table], list[str]]]:
    """The tables, as rows of cells, and the headings and paragraphs of every section of a page."""

    def plain(part: str) -> str:
        return html.unescape(re.sub(r"<[^>]+>", "", part.replace("<br><small>", " / ")))

    def read(table: str) -> Table:
        rows = re.findall("<tr>(.*?)</tr>", table)
        return [[plain(cell) for cell in re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row)] for row in rows]

    found = {}
    for name, part in re.findall(r'<section id="(\w+)".*?</h2>(.*?)</section>', text, re.DOTALL):
        tables = [read(each) for each in re.findall(r"<table.*?</table>", part, re.DOTALL)]
        lines = re.findall(r'<(?:p|h3|p class="alert amber")>(.*?)</(?:p|h3)>', part)
        found[name] = tables, [plain(line) for line in lines]
    return found


def table_by_hand(rows: Sequence[Row], first: str = "demand") -> Table:
    """A table of demands of the page; the name of a demand stands once, with its unit in a table of several demands."""
    placed = first == "demand"
    table, above = [[first, "bound", *HEADS, "motion", *["where"] * placed, "motions"]], ""
    for row in rows:
        name = f"{row.name}, {row.unit}" if placed else row.name
        every = row.bounds and len({*row.bounds}) == 1
        bound = f"{row.bound}: {row.bounds[0]}" if every else row.bound
        cells = [f"{cell} / {at}" for cell, at in zip(row.cells, row.bounds)] if row.bounds and not every else row.cells
        table.append(["" if name == above else name, bound, *cells, row.motion, *[row.where] * placed, row.motions])
        above = name
    return table


def directions_by_hand(labels: Sequence[str]) -> Iterator[Table]:
    for quantity, _, *unit in DIRECTIONS:
        heads = [f"along {axis}, {part}" for axis in "xy" for part in ("mean", "largest")]
        table, above = [["place", "bound", *heads]], ""
        for x, y in zip(*(profile_rows(f"{quantity}_{axis}", *unit, labels) for axis in "xy")):
            cells = []
            for row, place in ((x, 0), (x, 4), (y, 0), (y, 4)):
                source = ", ".join(filter(None, [row.motion * (place == 4), *row.bounds[place : place + 1]]))
                cells.append(f"{row.cells[place]} / {source}" if source else row.cells[place])
            table.append(["" if x.name == above else x.name, x.bound, *cells])
            above = x.name
        yield table


def motions_by_hand(labels: Sequence[str]) -> Table:
    shown = [MAIN[number] for number in (0, 3, 7, 10, 12, 13, 15)]
    table = [["motion", "bound", *(f"{name}, {unit}" for name, _, unit, _, _ in shown), "outcome"]]
    for structure, label in enumerate(labels):
        for motion in MOTIONS:
            cells = []
            for _, quantity, _, factor, bodies in shown:
                own = over_bodies(structure, quantity, bodies)
                cells.append(word(factor * own[motion][0].value) if motion in own else "none")
            table.append([motion, label, *cells, "travel reached" if (structure, motion, 2.0) in LOST else "ok"])
    return table


def supports_by_hand(labels: Sequence[str]) -> Table:
    ends = ["smallest by {}, kN", "motion", "largest by {}, kN", "motion", "motions"]
    heads = [each.format(by) for by in ("statics", "the engine") for each in ends]
    table = [["bound", "support", "x, m", "y, m", "at rest, kN", *heads, "uplift, mm"]]
    for structure, label in enumerate(labels):
        loads = reference.describe_building(scene(structure)).support_loads
        for number, place in enumerate(PLACES[structure], start=1):
            row = [label, str(number), *place.split(), f"{loads[number - 1] / 1e3:.4g}"]
            for model, count in (("exact", ("4 of 5", "5")), ("spatial", ("3 of 5", "2 of 5"))):
                for name, choose in (("smallest", min), ("largest", max)):
                    own = known(structure, name, number, model)
                    motion = choose(own, key=lambda each: own[each].value)
                    row += [say(own[motion], 1e-3), motion]
                row.append(count[structure])
            gap = max(known(structure, "gap", number, "spatial").values(), key=lambda one: one.value)
            table.append([*row, say(gap, 1e3)])
    return table


def extended_by_hand(labels: Sequence[str]) -> Table:
    """Statistics of the equations times the engine's mean ratio, with the range of the ratio."""
    table = [["demand", "bound", "ratio", "motions", "mean", "84 %", "largest"]]
    for structure, label in enumerate(labels):
        for name, quantity, unit, factor, bodies in COMPARED:
            ratios = [*ratios_by_hand(structure, quantity, bodies)[1]["spatial"].values()]
            times, cells = (sum(ratios) / len(ratios), min(ratios), max(ratios)), []
            smallest = quantity.endswith("_min")
            for head, place in (("", 0), ("16 %: ", 1), ("smallest: ", 4)) if smallest else (("", 0), ("", 3), ("", 4)):
                value, _, mark = tell(structure, quantity, bodies).numbers[place]
                text = "none"
                if value is not None and not (quantity == "displacement" and mark and place):
                    text = "{:.4g} ({:.4g} to {:.4g})".format(*(each * value * factor for each in times))
                    text = text + mark if mark.startswith(" ") else mark + text
                cells.append(head + text)
            table.append([f"{name}, {unit}", label, "{:.3f} ({:.3f} to {:.3f})".format(*times), "2", *cells])
    return table


def checks_by_hand(labels: Sequence[str]) -> Table:
    """Weight, dead loads, period, base shear and top drift; the planted ones are beyond their ranges."""
    table = [["quantity", "bound", "formula", "by hand", "in this report", "difference"]]
    for structure, label in enumerate(labels):
        building, weight, radius = (
            reference.describe_building(scene(structure)),
            WEIGHTS[structure] / 1e3,
            RADIUS[structure],
        )
        rigid, fixed = 2.0 * math.pi * math.sqrt(radius / GRAVITY), building.fixed_base_period[0, 0]
        at_rest, sliding = FRICTION[structure]
        motion, moved = max(known(structure, "displacement").items(), key=lambda each: each[1].value)
        slope, shear = math.tan(math.asin(moved.value / radius)), known(structure, "base_shear")[motion].value / 1e3
        top = len(FLOORS[structure])
        above, drift = (
            1e3 * max(each.value for each in known(structure, name, top).values()) for name in ("story_shear", "drift")
        )
        above, zeta, (soft, stiff) = above / 1e6, building.modal_damping[:, -1].max(), ((19, 25), (8, 9))[structure]
        period = building.isolated_period[0, 0]
        for what, formula, low, high, found, unit in (
            ("weight", f"{weight / GRAVITY:.5g} t × 9.81 m/s²", weight, weight, weight, "kN"),
            ("dead loads of all supports together", "weight", weight, weight, weight, "kN"),
            ("first period on the isolator, along x", f"T = 2π √({radius:g} / 9.81) to √(T² + {fixed:.3g}²)", rigid,
             math.hypot(rigid, fixed), period, "s"),
            (f"base shear under {motion}", f"W √(tan² φ + {at_rest}²) to W (tan φ + {sliding}), sin φ = "
             f"{1e3 * moved.value:.4g} / {1e3 * radius:g}", weight * math.hypot(slope, at_rest),
             weight * (slope + sliding), shear, "kN"),
            (f"largest drift below {FLOORS[structure][-1]}", f"V / (k √(1 + (2 ζ)²)) to V / k, V = {above:.4g} kN, k = "
             f"{stiff} to {soft} MN/m, ζ = {zeta:.3g}", above / stiff / math.hypot(1.0, 2.0 * zeta), above / soft,
             drift, "mm"),
        ):  # fmt: skip
            ends = f"{low:.4g}" if low == high else f"{low:.4g} to {high:.4g}"
            off = f"outside by {100.0 * max(low - found, found - high) / found:.2g} %"
            verdict = "0.00 %" if low == high else "inside" if low <= found <= high else off
            table.append([what, label, formula, f"{ends} {unit}", f"{found:.4g} {unit}", verdict])
    return table


def suite_by_hand() -> Table:
    table = [["motion", "magnitude", "step, s", "duration, s", *(f"peak {axis}, g" for axis in "xyz"),
              *(f"peak velocity {axis}, m/s" for axis in "xyz"), "peak, g", "factor", "files"]]  # fmt: skip
    for number, motion in enumerate(MOTIONS):
        along = ground(number).T
        peaks = [f"{np.abs(one).max() / GRAVITY:.3g}" for one in along]
        moved = [f"{np.abs(np.cumsum(0.025 * (one[1:] + one[:-1]))).max():.3g}" for one in along]
        empty, (magnitude, factor) = [""] * (3 - len(along)), ("6.9", "1.3") if motion == "Kobe" else ("not known", "1")
        largest = f"{np.hypot(*along[:2]).max() / GRAVITY:.3g}"
        table.append([motion, magnitude, "0.05", "2.95", *peaks, *empty, *moved, *empty, largest, factor, ""])
    return table


def building_by_hand(labels: Sequence[str]) -> Table:
    buildings, isolators = ([read(structure) for structure in (0, 1)] for read in (
        lambda structure: reference.describe_building(scene(structure)), isolator_by_hand))  # fmt: skip

    def axes(name: str, factor: float = 1.0) -> list[str]:
        texts = [
            [", ".join(f"{factor * one:.3g}" for one in axis) for axis in getattr(each, name)] for each in buildings
        ]
        return [f"{x} along x; {y} along y" for x, y in texts]

    kilo = [np.asarray(each.support_loads) / 1e3 for each in buildings]
    loads = [f"{len(own)}, {own.min():.4g} to {own.max():.4g}, mean {own.mean():.4g}" for own in kilo]
    return [
        ["quantity", "unit", *labels], ["bodies, the platform among them", "", "3", "2"],
        ["weight", "kN", f"{93 * GRAVITY:.5g}", f"{36 * GRAVITY:.5g}"],
        ["supports, and dead load of each", "kN", *loads], ["effective radius", "m", "2", "1.6"],
        ["radius of the spheres", "m", "0.1", "none stated"],
        ["friction at rest, at high speed", "", "0.03, 0.06", "0.04, 0.07"],
        ["rate of friction with the speed", "s/m", "50", "45"], ["travel", "mm", "500", "none stated"],
        ["periods on the isolator, without friction", "s", *axes("isolated_period")],
        ["periods above a fixed base", "s", *axes("fixed_base_period")],
        ["damping of these modes", "%", *axes("modal_damping", 100.0)],
        ["masses of the bodies, from the platform", "t", "40, 31, 22", "25, 11"],
        ["offsets of their centers of mass", "m", "0, 0; 0, 0; 0, 0", "0.1, -0.2; 0, 0"],
        ["stiffness of the stories, from the lowest", "MN/m", "30 along x, 21 along y; 19 along x, 25 along y",
         "9 along x, 8 along y"],
        ["sizes of the bodies in plan", "m", "7 × 5.5; 7.2 × 5.3; not stated", "5 × 3.5; not stated"],
        ["heights above the sliding contact", "m", "0.5, 3.6, 6.8", "-0.4, 3"],
        ["effective period and damping", "s, %", *(each[1] for each in isolators)],
        ["re-centering ratio there", "", *(each[2] for each in isolators)],
    ]  # fmt: skip


def building_said(labels: Sequence[str]) -> list[str]:
    ratios = [f"{100.0 * one[0]:.2g} %" for one in reference.describe_building(scene(1)).modal_damping]
    law = (
        "{}: Damping is in proportion to the stiffness of the links, c = 2 ζ k / ω₁ with ζ = {} in the first mode "
        "above a fixed base; a higher mode has a ratio in proportion to its frequency."
    )
    moved = (
        "{}: Fixed spheres below, depressions in the platform’s underside: the weight W moves with the platform by the "
        "displacement, and the contact points on the spheres move the other way by r / ρ of it. The displaced weight, "
        "a moment of W × (R / ρ × displacement + drift) about the contact points, loads the supports: ρ = {} m, r = {} "
        "m, R = ρ + r = {} m, R / ρ = {}."
    )
    first, second = labels
    lines = [moved.format(first, "2", "0.1", "2.1", "1.05"), moved.format(second, "1.6", "0", "1.6", "1")]
    lines += [law.format(first, "3 %"), law.format(second, f"{ratios[0]} along x, {ratios[1]} along y")]
    warning = f"Amber: {sentences_by_hand(labels)[4].replace('`', '')}"
    ratio = "The re-centering ratio is the restoring force over the friction force at that displacement."
    return [warning, *(line[:1].upper() + line[1:] for line in lines), ratio, "Not modeled:"]


@pytest.mark.parametrize("names", NAMES)
def test_the_page_shows_every_table_and_sentence(names: str) -> None:
    found, labels = plant(NAMES[names]), LABELS[names]
    text, said = page.render_ensemble_page(found), sentences_by_hand(labels)
    tables, lines = ({name: part[place] for name, part in sections_of(text).items()} for place in (0, 1))
    models = [
        [name, label, mean, *texts, "2"] for s, label in enumerate(labels) for name, mean, _, texts in model_rows(s)
    ]
    heads = [
        *(f"{each} equations" for each in ("exact", "small")),
        *(f"{each} engine" for each in COLUMNS[1:]),
        "motions",
    ]
    profiles = [(quantity, profile_rows(quantity, *unit, labels)) for quantity, _, *unit in PROFILES]
    expected = {
        "building": [building_by_hand(labels)], "suite": [suite_by_hand()],
        "demands": [table_by_hand(main_rows(labels))],
        "height": [
            table_by_hand([row for row in rows if (quantity, row.name) != ("acceleration_supremum", "body 2")], "place")
            for quantity, rows in profiles
        ],
        "directions": [*directions_by_hand(labels)], "supports": [supports_by_hand(labels)],
        "motions": [motions_by_hand(labels)], "hand_checks": [checks_by_hand(labels)],
        "trust": [[["demand", "bound", *heads], *models]], "extended": [extended_by_hand(labels)],
        "scales": [table_by_hand(main_rows(labels, scale)) for scale in (0.8, 0.5)], "run": [],
    }  # fmt: skip
    for name, shown in tables.items():
        assert shown == expected.pop(name), name
    assert expected == {}
    first, *_ = lines["extended"]
    digests, scaled = [f"{each.motion} {each.digest[:12]}" for each in found.suite], SCALED_SAID
    assert lines == {
        "building": building_said(labels), "scales": ["Scale 0.8", "Scale 0.5"], "motions": [], "hand_checks": [],
        "suite": [f"Peaks from 0.173 g to 0.345 g, resultant of x and y, with the factors; duration 2.95 s. {scaled}"],
        "demands": [
            f"By the exact equations where no engine is named. {said[-1][said[-1].index('Outcomes') :]}",
            f"{said[2][:1].upper()}{said[2][1:]}", said[-2],
        ],
        "height": [f"{title[:1].upper()}{title[1:]}, {unit}" for _, title, unit, _ in PROFILES],
        "directions": [f"{title[:1].upper()}{title[1:]}, {unit}" for _, title, unit, _ in DIRECTIONS],
        "supports": supports_said(labels), "trust": [*chosen_said(labels), trust_by_hand(labels)],
        "extended": [first],
        "run": ["Made by ensemble a, 2031-02-03T04:05:06, 12.5 s of compute on a chip; phase-resonance 9.8, commit "
                "abc. ensemble.csv has every motion, summary.json every statistic. SHA-256, its first 12 digits, of "
                f"samples of the motions with their factors: {', '.join(digests)}."],
    }  # fmt: skip
    assert f'<p class="answer">{said[-1]}</p>' in text
    assert "<h1>A tower, A house &amp; yard: 5 motions, scale 2</h1>" in text


def drawn(makers: Sequence[Any]) -> dict[str, dict[str, Any]]:
    """Plots by their titles, with numbers to twelve digits."""
    return {each["title"]: rounded(each["plot"]) for each in (make() for make in makers)}


def rounded(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: rounded(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [rounded(each) for each in value]
    return float(f"{value:.11e}") if isinstance(value, float) else value


def test_a_block_has_no_table_of_drifts_and_takes_no_row_of_a_tower_behind_it() -> None:
    found = plant()
    tower, house = found.structures
    empty: Any = {"fixed_base_period": [[], []], "modal_damping": [[], []], "stiffness": (), "sizes": (None,)}
    block = replace(house, bodies=1, building=replace(house.building, heights=None, **empty))
    kept: Any = {name: [each for each in getattr(found, name) if each.structure == tower.name or each.body in (None, 1)]
                 for name in ("stripes", "curves", "spectra")}  # fmt: skip
    both = replace(found, **kept, supports=[], structures=[block, tower])
    (table,) = sections_of(page.render_ensemble_page(both))["building"][0]
    assert [row[0] for row in table] == [row[0] for row in building_by_hand(("", ""))]
    places = [row[0] for row in sections_of(page.render_ensemble_page(both))["height"][0][0] if row[0]]
    assert places == ["place", "roof", "body 2", "platform"]
    plots = drawn(panels.make_height_panels(both))
    assert [*plots] == [f"{title} over the height" for _, title, *_ in OVER_HEIGHT], "drifts, too"
    plot = plots["floor acceleration, as integrated over the height"]
    assert [line["y"] for line in plot["series"] if line["color"] == 0] == [[1.0]] * 3
    assert plot["y"] == {"title": "body, from the platform up", "ticks": [[1, "1"], [2, "2"], [3, "3"]]}
    assert [*drawn(panels.make_floor_spectra_panels(both))] == ["floor spectrum: deck", "floor spectrum: roof"]
    kept = {name: [each for each in rows if each.structure == block.name] for name, rows in kept.items()}
    shown = sections_of(page.render_ensemble_page(replace(both, **kept, structures=[block])))
    titles = [[title.partition(",")[0] for title in shown[name][1]] for name in ("height", "directions")]
    expected = ["Floor acceleration", "Floor acceleration", "Story shear", "Overturning moment"]
    assert titles == [expected, ["Story shear", "Overturning moment of the forces"]]
    assert [row[0] for row in shown["hand_checks"][0][0]][2:] == [
        "dead loads of all supports together", "first period on the isolator, along x", "base shear under Tabas"
    ]  # fmt: skip


STATED = ({"displacement": 0.3}, {"base_shear": 0.25, "acceleration": 4.0, "statistic": "mean"})
GRAY = {"color": "gray", "dash": "7 3"}


@pytest.mark.parametrize("scales", [SCALES, (2.0,)])
def test_plots_of_the_isolator_have_every_motion_median_mean_travel_and_limit(scales: Sequence[float]) -> None:
    found, labels, one = plant(scales=scales), LABELS["short"], len(scales) == 1
    limits = {name: DemandLimits(**stated) for name, stated in zip(NAMES["short"], STATED)}
    found = replace(found, limits=list_verdicts(check_limits(found, limits)))
    asked = (
        ("displacement", "largest displacement of the isolator", "mm", 1e3),
        ("residual", "residual displacement of the isolator", "mm", 1e3),
        ("base_shear", "base shear", "% of the weight", None), ("uplift", "largest uplift of a support", "mm", 1e3),
        ("support_force_max", "largest support force", "kN", 1e-3),
    )  # fmt: skip
    plots = drawn(panels.make_isolator_panels(found))
    assert [*plots] == [title for _, title, _, _ in asked]
    span = [-0.6, 1.6] if one else [0.0, 2.08]

    def dots(
        place: float, number: int, count: int, at: Sequence[float], own: Sequence[Estimate | None]
    ) -> dict[str, Any]:
        """A motion over the scales, or with its error in the strip of its structure."""
        x = [place + 0.3 * ((number + 0.5) / count - 0.5)] if one else [*at]
        y, low, high = (
            [each and factor * (each.value + side * each.error) for each in own] for side in (0.0, -1.0, 1.0)
        )
        return {"x": x, "y": y, "low": low, "high": high}

    for quantity, title, unit, by in asked:
        series: list[dict[str, Any]] = []
        engine: list[dict[str, Any]] = []
        for structure, label in enumerate(labels):
            factor, at = factor_of(by, structure), [structure + 0.3] if one else [*scales]
            for number, motion in enumerate(MOTIONS if quantity != "uplift" else ()):
                line = dots(
                    structure,
                    number,
                    5,
                    scales,
                    [known(structure, quantity, scale=scale).get(motion) for scale in scales],
                )
                look = {"marks": True, "line": False} if one else {"width": 0.7}
                kept = line if one else {key: line[key] for key in "xy"}
                series.append(kept | look | {"name": f"{label}: one motion", "color": structure, "legend": number == 0,
                                             "titles": [f"{motion}, {scale:g}" for scale in scales]})  # fmt: skip
            if (structure, quantity) == (0, "displacement"):
                reached = {"Tabas": 0.12} if one else {"El Centro": 0.8, "Tabas": 2.0}
                look = {
                    "color": 0,
                    "marks": 2,
                    "line": False,
                    "titles": [f"{motion}: at the travel" for motion in reached],
                }
                x, y = [*reached.values()], [500.0] * len(reached)
                series.append({"name": f"{label}: at the travel", "x": x, "y": y, **look})
            if quantity != "uplift":
                told = [tell(structure, quantity, scale=scale).numbers for scale in scales]
                values = [[None if mark else value and factor * value for value, _, mark in each] for each in told]
                mean, low, median, high, _ = map(list, zip(*values))
                look = {"color": structure, "band": not one, "marks": 7, "width": 2.4, "line": not one, "x": at}
                series.append({"name": f"{label}: median, 16 to 84 %", **look, "low": low, "y": median, "high": high})
            if quantity == "base_shear":
                look = {
                    "color": structure,
                    "marks": 3,
                    "line": False,
                    "x": [each + 0.1 if one else each for each in at],
                }
                series.append({"name": f"{label}: mean", **look, "y": mean})
            order = [motion for s, motion in CHOSEN if s == structure]
            for number, motion in enumerate(order):
                own = known(structure, quantity, model="spatial").get(motion)
                look = {
                    "name": "spatial engine",
                    "color": "ink",
                    "marks": True,
                    "line": False,
                    "titles": [f"{motion}, 2"],
                }
                look["legend"] = structure == number == 0
                engine.append(dots(structure - 0.3, number, 3, [2.0], [own]) | look)
        lines = {"displacement": [("travel", 500.0, {"color": "ink", "width": 1.0}), ("limit (largest)", 300.0, GRAY)],
                 "base_shear": [("limit (mean)", 25.0, GRAY)]}  # fmt: skip
        series += [{"name": name, "x": span, "y": [value] * 2, **look} for name, value, look in lines.get(quantity, ())]
        most = max(
            value for each in (*series, *engine) for key in ("y", "high") for value in each.get(key, ()) if value
        )
        ticks = {"ticks": [[0, labels[0]], [1, labels[1]]]} if one else {}
        assert plots[title] == rounded({
            "label": f"{title} {'by bound' if one else 'over the scale factor'}, 5 motions",
            "series": [*series, *engine],
            "x": {"title": "" if one else "scale factor of the motion", "range": span, **ticks},
            "y": {"title": f"{title}, {unit}", "range": [0.0, 1.06 * most]},
        }), quantity  # fmt: skip
    note = panels.plots_note(found)
    assert note.endswith(" A diamond is the mean, where a limit is on it."), "of any of the plots"
    assert note.startswith("Every dot is one motion" if one else "Every thin line is one motion")


def test_plots_over_the_height_have_both_structures() -> None:
    found, labels = plant(), LABELS["short"]
    plots = drawn(panels.make_height_panels(found))
    stories = [0.25, 2.05, 5.2], [-0.2, 1.3]
    heights = ([0.5, 3.6, 6.8], [-0.4, 3.0]), (stories[0][1:], stories[1][1:]), stories, ([0.0, 0.5, 3.6], [0.0, -0.4])
    assert [*plots] == [f"{title} over the height" for _, title, *_ in OVER_HEIGHT]
    for (quantity, title, unit, factor), at in zip(OVER_HEIGHT, heights):
        series, largest = [], 0.0
        for structure, label in enumerate(labels):
            bodies = range(1 + ("drift" in quantity), len(FLOORS[structure]) + 1)
            told = [tell(structure, quantity, (body,)).numbers for body in bodies]
            for place, share, dash in ((1, "16 %", "2 2"), (2, "50 %", ""), (3, "84 %", "7 3")):
                values = [factor * each[place][0] for each in told if each[place][0] is not None]
                look = {
                    "color": structure,
                    "width": 2.4 if place == 2 else 1.2,
                    "marks": place == 2,
                    "y": at[structure],
                }
                look |= {"dash": dash} if dash else {}
                texts = [f"{place_of(structure, quantity, body)}: {word(value)}" for body, value in zip(bodies, values)]
                series += [{"name": f"{label}, {share}", "x": values, "titles": texts, **look}] if values else []
                largest = max(largest, *values, 0.0)
        assert plots[f"{title} over the height"] == rounded({
            "label": f"{title} over the height: 16, 50 and 84 %, 5 motions", "series": series,
            "x": {"title": f"{title}, {unit}", "range": [0.0, 1.06 * largest]},
            "y": {"title": "height above the sliding contact, m"},
        }), quantity  # fmt: skip
    unknown = [replace(each, fractiles=(replace(each.fractiles[0], value=None), *each.fractiles[1:]))
               if (each.quantity, each.body) == ("story_shear", 2) else each for each in found.stripes]  # fmt: skip
    line = drawn(panels.make_height_panels(replace(found, stripes=unknown)))["story shear over the height"]["series"][0]
    assert (line["x"][1], line["titles"][1], len(line["x"])) == (None, "below body 2: none", 3)


def test_spectra_of_floors_and_ground_have_both_structures_and_every_motion() -> None:
    found, labels = plant(), LABELS["short"]
    plots = drawn(panels.make_floor_spectra_panels(found))
    assert [*plots] == ["floor spectrum: deck", "floor spectrum: roof"]
    ticks = [[value, f"{value:g}"] for value in (0.1, 0.2, 0.5, 1.0, 2.0)]
    for (title, plot), bodies in zip(plots.items(), ((1, 1), (3, 2))):
        series = []
        for structure, (label, body) in enumerate(zip(labels, bodies)):
            along_y = 6.0 * body + np.arange(-2.0, 1.0)  # The numbers of a body rise; those of y are larger.
            motions = [1.0 + number + 7.0 * structure for number in range(4 + structure)]
            shares = (hazen(motions, share, [math.inf] * (1 - structure)) for share in (0.16, 0.5, 0.84))
            low, median, high = ([share and float(share * one) * G for one in along_y] for share in shares)
            look = {"color": structure, "x": [0.1, 0.5, 3.0], "band": True, "marks": False, "width": 2.4}
            series.append({"name": f"{label}: median, 16 to 84 %", **look, "low": low, "y": median, "high": high})
        most = max(value for each in series for key in ("y", "high") for value in each[key] if value)
        assert plot == rounded({
            "label": f"floor spectrum of the {title.partition(': ')[2]}, 5 motions", "series": series,
            "x": {"title": "period, s", "log": True, "ticks": ticks},
            "y": {"title": "pseudo-acceleration, 5 % damping, g", "range": [0.0, 1.06 * most]},
        }), title  # fmt: skip
    nothing = replace(found.spectra[0], fractiles=[[Statistic(None, None)] * 3] * 3)
    plots = drawn(panels.make_floor_spectra_panels(replace(found, spectra=[nothing])))
    assert plots["floor spectrum: deck"]["y"]["range"] == [0.0, 1.0], "without a value"
    (plot,) = drawn(panels.make_ground_panels(found)).values()
    spectra = [[(2.0 + number) * G, (1.0 + number) * G] for number in range(5)]
    series = [{"x": [0.2, 1.5], "name": "one motion", "color": "gray", "width": 0.7, "y": values, "legend": number == 0,
               "titles": [MOTIONS[number]] * 2} for number, values in enumerate(spectra)]  # fmt: skip
    mean = [float(each) for each in np.prod(spectra, axis=0) ** 0.2]
    for name, color, values in (("geometric mean of the motions", 0, mean), ("target", "ink", [3.0 * G, 2.0 * G])):
        series.append({"x": [0.2, 1.5], "y": values, "name": name, "color": color, "width": 2.4})
    assert (plot["series"], plot["x"]["ticks"]) == (rounded(series), ticks[1:4])
    assert plot["label"] == "response spectra of the ground and their target, 5 motions at scale 1"
    upward = replace(found, target=None, suite=[replace(found.suite[0], spectrum=()), *found.suite[1:]])
    (plot,) = drawn(panels.make_ground_panels(upward)).values()
    assert [line.get("titles", [""])[0] for line in plot["series"]] == [*MOTIONS[1:], ""], "one has no spectrum"
