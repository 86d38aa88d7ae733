"""Every table and sentence of an ensemble, whole, against planted demands of which none equals another."""

import html
import math
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np
import pytest

import reference
from comparison.analyses.ensemble import page, panels
from comparison.analyses.ensemble.analysis import EnsemblePoints, MotionDemandsAtScale
from comparison.analyses.ensemble.build import build_result
from comparison.analyses.ensemble.governing import ChosenMember
from comparison.analyses.ensemble.limits import check_limits, list_verdicts
from comparison.analyses.ensemble.members import EnsembleMember
from comparison.analyses.ensemble.result import EnsembleResult, MatchedMotion, Statistic, TargetSpectrum
from comparison.analyses.ensemble.sentences import missing_sentences
from comparison.analyses.ensemble.terminal import print_engine, print_equations
from comparison.runner import progress
from reference.measures import Estimate, FloorSpectra, StoryForces
from reference.problem import GRAVITY, Scene
from reference.problem.acceptance import DemandLimits
from reference.problem.families import make_family
from reference.problem.scene_file import scene_tables
from reference.records.motion_lists import Motion

TOWER = """title = "A tower"
[isolator]
radius = 2.0
friction = {slow = 0.03, fast = 0.06, rate = 50.0}
supports = [[3.0, 2.0], [-3.1, 2.2], [-3.3, -2.4], [3.5, -2.6]]
sphere_radius = 0.1
travel = 0.5
[[bodies]]
mass = 40e3
height = 2.6
size = [7.0, 5.5, 0.6]
floor = "deck"
[[bodies]]
mass = 31e3
height = 5.7
size = [7.2, 5.3, 0.3]
stiffness = [30e6, 21e6]
[[bodies]]
mass = 22e3
height = 8.9
stiffness = [19e6, 25e6]
floor = "roof"
[superstructure]
damping = 0.03
"""
HOUSE = """title = "A house & yard"
[isolator]
radius = 1.6
friction = {slow = 0.04, fast = 0.07, rate = 45.0}
supports = [[2.0, 1.1], [-2.2, 1.3], [0.4, -1.5]]
[[bodies]]
mass = 25e3
height = 1.2
size = [5.0, 3.5, 0.5]
offset = [0.1, -0.2]
[[bodies]]
mass = 11e3
height = 4.6
stiffness = [9e6, 8e6]
damping = [2.1e4, 1.7e4]
"""
HARMONIC = "[excitation]\namplitudes = [[1.0, 0.0], [0.0, 1.0]]\nperiods = [1.0, 1.0]\ndecay = [0.1, 0.1]\n"
SCALES = (0.5, 0.8, 2.0)
MOTIONS = ("Chi-Chi", "El Centro", "Kobe", "Northridge", "Tabas")
FLOORS = ("deck", "body 2", "roof"), ("platform", "body 2")  # A place of several structures has the name of the first.
LOST = {(0, "Tabas", 2.0): 7.654, (0, "El Centro", 0.8): 3.21}  # when it reaches the travel, s
STAYS = (1, "Chi-Chi", 2.0)  # moves at the end
MOVING = "moving at the end: take a longer duration"
CHOSEN = {
    (0, "Kobe"): ("largest drift", "largest displacement"), (0, "Northridge"): ("asked for",),
    (0, "Tabas"): ("largest base shear",), (1, "El Centro"): ("nearest the median displacement",),
    (1, "Kobe"): ("largest support force",), (1, "Northridge"): ("smallest support force",),
}  # fmt: skip
FAILED = (1, "Northridge", "spatial")
OTHERS = ("small", "regularised", "translational", "spatial")
OF_BODIES = {  # SI size and first body
    "acceleration": (3.0, 1), "acceleration_supremum": (3.0, 1), "story_shear": (5e4, 1), "story_shear_x": (4e4, 1),
    "story_shear_y": (3e4, 1), "overturning_moment": (2e5, 1), "overturning_moment_x": (1.5e5, 1),
    "overturning_moment_y": (1.2e5, 1), "drift": (0.01, 2), "drift_x": (0.008, 2), "drift_y": (0.007, 2),
    "drift_ratio": (0.06, 2),
}  # fmt: skip
OF_ISOLATOR = {"displacement": 0.18, "base_shear": 9e4, "residual": 0.02}
SUPPORTS = (4, 3)
Key = tuple[int, str, int, str, float, str]  # structure, demand, body (of single supports their number), motion, model
NAMES = {"short": ("x[lower bound]", "x[upper bound]"), "long": ("tower of the north[lower bound]", "house[upper bound]")}


def draw() -> dict[Key, Estimate]:
    """All demands; those of the engine are of its motions at the largest scale."""
    random = np.random.default_rng(11)
    raw: dict[Key, Estimate] = {}

    def put(structure: int, quantity: str, body: int, size: float, only: Sequence[str] = ("exact", *OTHERS)) -> None:
        for motion in MOTIONS:
            for scale in SCALES:
                base = size * scale / 2.0 * random.uniform(1.0, 2.0) * (0.95 if structure else 1.0)
                for model in only:
                    value = base * (1.0 if model == "exact" else random.uniform(0.8, 1.25))
                    chosen = scale == 2.0 and (structure, motion) in CHOSEN and (structure, motion, model) != FAILED
                    if model == "exact" or chosen:
                        raw[structure, quantity, body, motion, scale, model] = Estimate(
                            value, value * random.uniform(1e-3, 4e-3)
                        )

    for structure, floors in enumerate(FLOORS):
        for quantity, size in OF_ISOLATOR.items():
            put(structure, quantity, 0, size)
        put(structure, "support_displacement", 0, 0.2, ("spatial",))
        for quantity, (size, first) in OF_BODIES.items():
            for body in range(first, len(floors) + 1):
                put(structure, quantity, body, size, ("exact", "small") if "supremum" in quantity else ("exact", *OTHERS))
        for number in range(1, SUPPORTS[structure] + 1):
            put(structure, "smallest", number, 4e4, ("exact", "spatial"))
            put(structure, "largest", number, 3e5, ("exact", "spatial"))
            put(structure, "gap", number, 2e-3, ("spatial",))
    for key, number in [*raw.items()]:
        structure, quantity, body, *at = key
        if quantity == "acceleration_supremum" and body == 2:
            raw[key] = raw[structure, "acceleration", body, *at]
        if quantity == "displacement" and structure == 0:
            raw[structure, "travel_share", body, *at] = Estimate(number.value / 0.5, number.error / 0.5)
        for many, one, choose in (
            ("smallest", "support_force_min", min), ("largest", "support_force_max", max), ("gap", "uplift", max)
        ):  # fmt: skip
            if quantity == many:
                all_of = [raw[structure, many, n, *at] for n in range(1, SUPPORTS[structure] + 1)]
                raw[structure, one, 0, *at] = choose(all_of, key=lambda each: each.value)
    for key in [*raw]:
        structure, quantity, _, motion, scale, model = key
        at = structure, motion, scale
        if model == "exact" and (at in LOST or (at == STAYS and quantity == "residual")):
            del raw[key]
    return raw


RAW = draw()
TIME = np.arange(0.0, 3.0, 0.05)


def ground(number: int) -> np.ndarray:
    """A motion along x, y and in the first two of them z, m/s^2."""
    along = [(1.0 + 0.3 * number + 0.4 * axis) * np.sin((4.0 + number + axis) * TIME) for axis in range(3)]
    return np.transpose(along[: 3 if number < 2 else 2])


@cache
def scene(structure: int, number: int, scale: float) -> Scene:
    (read,) = make_family(scene_tables(("duration = 1.0\n" + (TOWER, HOUSE)[structure] + HARMONIC).encode(), "a"), "a.toml").scenes
    loading = {"record": {"time": TIME, "acceleration": ground(number)}, "scale": scale}
    return read.with_values({"duration": float(TIME[-1]), "excitation": loading})


def point(names: Sequence[str], structure: int, number: int, scale: float, model: str) -> MotionDemandsAtScale:
    motion = MOTIONS[number]
    member = EnsembleMember(names[structure], motion, scale, scene(structure, number, scale), 1.0)
    if (structure, motion, scale) in LOST and model == "exact":
        return MotionDemandsAtScale(member, model, "travel reached", instant=LOST[structure, motion, scale])
    if (structure, motion, model) == FAILED:
        return MotionDemandsAtScale(member, model, "tolerance not met")
    own = {key[1:3]: each for key, each in RAW.items() if (key[0], *key[3:]) == (structure, motion, scale, model)}
    low, high, gaps = (
        tuple(own[name, n] for n in range(1, SUPPORTS[structure] + 1)) if (name, 1) in own else None
        for name in ("smallest", "largest", "gap")
    )
    values = {at: each for at, each in own.items() if at[0] not in ("smallest", "largest", "gap")}
    if (structure, motion, scale) == STAYS and model == "exact":
        values["residual", 0] = Estimate(math.nan, math.nan, MOVING)
    bodies = len(FLOORS[structure])
    accelerations = (1.0 + number + 7.0 * structure) * np.arange(1.0, 6.0 * bodies + 1.0).reshape(bodies, 2, 3)
    spectra = FloorSpectra(np.array([0.1, 0.5, 3.0]), 0.05, accelerations, 0.01 * accelerations)
    forces = StoryForces((), None, low, high, gaps)
    return MotionDemandsAtScale(member, model, "ok", values, spectra if model == "exact" else None, forces)


def plant(names: Sequence[str] = NAMES["short"], scales: Sequence[float] = SCALES) -> EnsembleResult:
    """Two structures under five motions; the engine computes three of each at the largest scale."""
    equations = [point(names, s, n, scale, "exact") for s in (0, 1) for n in range(5) for scale in scales]
    at = [(s, MOTIONS.index(motion)) for s, motion in CHOSEN]
    compared = {model: [point(names, *each, 2.0, model) for each in at] for model in OTHERS}
    chosen = [ChosenMember(each.member, why) for each, why in zip(compared["small"], CHOSEN.values())]
    listed = {"Kobe": Motion("Kobe", {}, 1.3, 6.9)}
    facts = {"command": "ensemble a", "began": "2031-02-03T04:05:06", "compute_seconds": 12.5, "scenes": {}}
    facts |= {"provenance": {"processor": "a chip", "phase-resonance": "9.8", "commit": "abc"}}
    target = TargetSpectrum(0.2, 1.5, [0.2, 1.5], [3.0, 2.0], [
        MatchedMotion(name, 1.1 + 0.13 * n, [2.0 + n, 1.0 + n]) for n, name in enumerate(MOTIONS)
    ])  # fmt: skip
    return build_result(EnsemblePoints(equations, chosen, compared), facts, 0.02, target, listed)


# Demands by hand


@dataclass
class Told:
    """Mean, three fractiles and worst value of a demand, each with error and mark; motion and body of the worst."""

    numbers: list[tuple[float | None, float, str]]
    motion: str
    body: int
    motions: str


def hazen(values: Sequence[float], share: float, lost: Sequence[float]) -> float | None:
    ordered = sorted([*values, *lost])
    at = share * len(ordered) - 0.5
    low, high = ordered[int(at)], ordered[int(at) + 1]
    return low + at % 1.0 * (high - low) if math.isfinite(low) and math.isfinite(high) else None


def tell(structure: int, quantity: str, bodies: Sequence[int], scale: float) -> Told | None:
    """The statistics of the largest value over bodies; None without such a demand."""
    known: dict[str, tuple[float, float, int]] = {}
    for motion in MOTIONS:
        own = [(RAW[at], body) for body in bodies if (at := (structure, quantity, body, motion, scale, "exact")) in RAW]
        if own:
            number, body = max(own, key=lambda each: each[0].value)
            known[motion] = number.value, number.error, body
    if not known:
        return None
    smallest, count = quantity.endswith("_min"), len(known)
    motion = (min if smallest else max)(known, key=lambda each: known[each][0])
    values, (worst, error, body) = [each[0] for each in known.values()], known[motion]
    mean_error = sum(each[1] for each in known.values()) / count
    lost = [-math.inf if smallest else math.inf] * (5 - count)
    shares = [hazen(values, share, lost) for share in (0.16, 0.5, 0.84)]
    if not lost:
        told = [(sum(values) / 5, mean_error, ""), *((each, 0.0, "") for each in shares), (worst, error, "")]
        return Told(told, motion, body, "5")
    if limit := {"displacement": 0.5, "travel_share": 1.0}.get(quantity):
        told = [((sum(values) + limit) / 5, mean_error, "≥ "), *(
            (limit, 0.0, "≥ ") if each is None else (each, 0.0, "") for each in shares
        ), (limit, 0.0, "≥ ")]  # fmt: skip
        return Told(told, "", body, "4 of 5")
    told = [(sum(values) / count, mean_error, " (of 4)"), *((each, 0.0, "") for each in shares)]
    return Told([*told, (worst, error, "≤ " if smallest else "≥ ")], motion, body, "4 of 5")


def word(value: float | None, error: float = 0.0, mark: str = "") -> str:
    if value is None:
        return "none"
    text = f"{value:.4g}" + (f" ± {float(f'{error:.1g}'):g}" if error else "")
    return text + mark if mark.startswith(" ") else mark + text


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


LABELS = {"short": ("lower bound", "upper bound"), "long": NAMES["long"]}


def make_rows(
    name: str, quantity: str, unit: str, factor: Callable[[int], float], bodies: Sequence[int], labels: Sequence[str],
    scale: float = 2.0, placed: bool = False,
) -> Iterator[Row]:  # fmt: skip
    """The rows of one demand by hand: of both structures, then of their envelope."""
    sign, found = (-1.0 if quantity.endswith("_min") else 1.0), []

    def place(structure: int, told: Told) -> str:
        floor = FLOORS[structure][told.body - 1]
        return "" if not placed else floor if "accel" in quantity else f"below {floor}"

    def cell(structure: int, told: Told, column: int, mark: str) -> str:
        value, error, _ = told.numbers[column]
        by = factor(structure)
        text = word(None if value is None else by * value, by * error)
        text += " (smallest)" * (column == 4 and sign < 0.0)
        return text if value is None else text + mark if mark.startswith(" ") else mark + text

    for structure in (0, 1):
        if told := tell(structure, quantity, bodies, scale):
            found.append((structure, told))
            cells = [cell(structure, told, column, told.numbers[column][2]) for column in range(5)]
            yield Row(name, unit, labels[structure], cells, told.motion, place(structure, told), told.motions)
    if len(found) < 2:
        return
    cells, at = [], []
    for column in range(5):
        if not (known := [each for each in found if each[1].numbers[column][0] is not None]):
            cells.append("none")
            at.append("")
            continue
        structure, told = max(known, key=lambda each: sign * factor(each[0]) * each[1].numbers[column][0])
        sure = len(known) == 2 and not any(each.numbers[column][2] for _, each in found)
        mark = "" if sure else told.numbers[column][2] or ("≤ " if sign < 0.0 else "≥ ")
        cells.append(cell(structure, told, column, mark))
        at.append(labels[structure].removesuffix(" bound"))
    short = "" not in at and max(map(len, at)) <= 8
    motion = told.motion + ("" if short or not told.motion else f", {labels[structure]}")
    where = place(structure, told) if told.motion else ""
    yield Row(name, unit, "envelope", cells, motion, where, "", at * short)


WEIGHTS = 93e3 * GRAVITY, 36e3 * GRAVITY
G, ISOLATOR, PLATFORM, EVERY = 1.0 / GRAVITY, (0,), (1,), (1, 2, 3)
MAIN = (
    ("isolator displacement", "displacement", "mm", 1e3, ISOLATOR),
    ("support displacement, with torsion", "support_displacement", "mm", 1e3, ISOLATOR),
    ("displacement over travel", "travel_share", "%", 100.0, ISOLATOR),
    ("base shear", "base_shear", "kN", 1e-3, ISOLATOR),
    ("base shear over weight", "base_shear", "%", None, ISOLATOR),
    ("platform acceleration, as integrated", "acceleration", "g", G, PLATFORM),
    ("platform acceleration, literal supremum", "acceleration_supremum", "g", G, PLATFORM),
    ("floor acceleration, as integrated", "acceleration", "g", G, EVERY),
    ("floor acceleration, literal supremum", "acceleration_supremum", "g", G, EVERY),
    ("largest drift", "drift", "mm", 1e3, EVERY),
    ("largest drift ratio", "drift_ratio", "%", 100.0, EVERY),
    ("overturning moment at the isolator", "overturning_moment", "kN m", 1e-3, PLATFORM),
    ("largest support force", "support_force_max", "kN", 1e-3, ISOLATOR),
    ("smallest support force", "support_force_min", "kN", 1e-3, ISOLATOR),
    ("uplift of a support", "uplift", "mm", 1e3, ISOLATOR),
    ("residual displacement", "residual", "mm", 1e3, ISOLATOR),
)
OF_ENGINE = "support_displacement", "uplift"


def factor_of(factor: float | None) -> Callable[[int], float]:
    """The factor to the display unit; of a share of the weight that of the structure."""
    return lambda structure: 100.0 / WEIGHTS[structure] if factor is None else factor


def main_rows(labels: Sequence[str], scale: float = 2.0) -> list[Row]:
    rows: list[Row] = []
    for name, quantity, unit, factor, bodies in MAIN:
        if quantity not in OF_ENGINE:
            placed = bodies == EVERY
            rows += make_rows(name, quantity, unit, factor_of(factor), bodies, labels, scale, placed)
            continue
        for structure in (0, 1) if scale == 2.0 else ():
            about = [(structure, quantity, 0, motion, 2.0, "spatial") for motion in MOTIONS]
            known = {at[3]: RAW[at] for at in about if at in RAW}
            motion = max(known, key=lambda each: known[each].value)
            worst = word(1e3 * known[motion].value, 1e3 * known[motion].error)
            count = f"{len(known)} of 5 (spatial engine)"
            rows.append(Row(name, unit, labels[structure], ["–"] * 4 + [worst], motion, "", count))
    return rows


def profile_rows(quantity: str, unit: str, factor: float, labels: Sequence[str]) -> list[Row]:
    rows: list[Row] = []
    for body in (3, 2, 1):
        name = FLOORS[0][body - 1] if "acceleration" in quantity else f"below {FLOORS[0][body - 1]}"
        name = name.replace("below deck", "isolator")
        rows += make_rows(name, quantity, unit, factor_of(factor), (body,), labels)
    return rows


def ratios_by_hand(structure: int, quantity: str, bodies: Sequence[int]) -> tuple[float, dict[str, dict[str, float]]]:
    """Mean by the equations over the motions that all models have, and by model and motion the ratio to them."""
    models = ("exact", "spatial") if "force" in quantity else ("exact", *OTHERS)
    largest = {
        model: {
            motion: max(own)
            for motion in MOTIONS
            if (own := [RAW[at].value for body in bodies if (at := (structure, quantity, body, motion, 2.0, model)) in RAW])
        }
        for model in models
    }
    exact, *others = largest.values()
    common = [motion for motion in exact if all(motion in each for each in others)]
    ratios = {model: {each: numbers[each] / exact[each] for each in common} for model, numbers in largest.items()}
    return sum(exact[motion] for motion in common) / len(common), ratios


def signed(ratio: float) -> str:
    return f"{100.0 * (ratio - 1.0):+.2f}".replace("-", "−")


COMPARED = [each for each in MAIN if each[0] not in (
    "support displacement, with torsion", "displacement over travel", "base shear over weight",
    "platform acceleration, literal supremum", "floor acceleration, literal supremum", "largest drift ratio",
    "uplift of a support", "residual displacement",
)]  # fmt: skip
COLUMNS = ("small", "translational", "spatial")


def model_rows(structure: int) -> Iterator[tuple[str, str, list[str], list[str]]]:
    """Demand, mean, and of every column mean difference and its range."""
    for name, quantity, unit, factor, bodies in COMPARED:
        mean, by_model = ratios_by_hand(structure, quantity, bodies)
        known = {model: [*by_model[model].values()] for model in COLUMNS if model in by_model}
        briefs = {model: f"{signed(sum(each) / len(each))} %" for model, each in known.items()}
        texts = {model: f"{briefs[model]} ({signed(min(each))} to {signed(max(each))})" for model, each in known.items()}
        shown = f"{mean * (factor or 0.0):.4g} {unit}"
        yield name, shown, [briefs.get(each, "") for each in COLUMNS], [texts.get(each, "") for each in COLUMNS]


def trust_by_hand(labels: Sequence[str]) -> str:
    """The sentence on the models: the largest difference of single motions of every kind."""

    def largest(upper: str, lower: str, smallest: bool = False) -> tuple[str, str]:
        found = []
        for structure, label in enumerate(labels):
            for name, quantity, _, _, bodies in COMPARED:
                _, by_model = ratios_by_hand(structure, quantity, bodies)
                below = "exact" if "force" in quantity and lower == "translational" else lower
                if upper in by_model and below in by_model and quantity.endswith("_min") == smallest:
                    for motion, ratio in by_model[upper].items():
                        size = abs(ratio / by_model[below][motion] - 1.0)
                        found.append((size, f"{name}, " * (not smallest) + f"{label}, {motion}"))
        size, place = max(found)
        return f"up to {100.0 * size:.2g} %", place

    parts = [largest("small", "exact"), largest("translational", "regularised"), largest("regularised", "exact"),
             largest("spatial", "translational"), largest("spatial", "translational", smallest=True)]  # fmt: skip
    geometry, codes, law, turning, smallest = (f"{size} ({place})" for size, place in parts)
    return (
        "On the 4 motions that all models computed, four things are apart: the geometry of the sphere, which the small "
        f"equations leave out, is worth {geometry}; given the same equations and friction law, the two codes differ by "
        f"{codes}; the regularized friction of the engines, which the exact equations have not, is worth {law}; bodies "
        f"that turn on their supports change a demand by {turning}, and the smallest support force, against statics, "
        f"by {smallest}."
    )


def support_sentences_by_hand(labels: Sequence[str]) -> list[str]:
    """Largest and smallest force and the uplift over supports, bounds and motions, by the equations and the engine."""
    said = []
    for model, head in (("exact", f"By the equations and statics, 4 of 5 motions of the {labels[0]}, 5 motions of the "
                         f"{labels[1]}"), ("spatial", f"By the spatial engine, 3 of 5 motions of the {labels[0]}, 2 of "
                         f"5 motions of the {labels[1]}")):  # fmt: skip
        parts = []
        for name, choose in (("largest", max), ("smallest", min)):
            known = {at: each for at, each in RAW.items() if (at[1], at[4], at[5]) == (name, 2.0, model)}
            at = choose(known, key=lambda each: known[each].value)
            x, y = PLACES[at[0]][at[2] - 1]
            value = word(1e-3 * known[at].value, 1e-3 * known[at].error)
            parts.append(f"{name} force {value} kN, support {at[2]} at [{x}, {y}] m ({at[3]}, {labels[at[0]]})")
        if model == "spatial":
            gaps = {at: each for at, each in RAW.items() if at[1] == "gap"}
            at = max(gaps, key=lambda each: gaps[each].value)
            parts.append(f"largest uplift {1e3 * gaps[at].value:.4g} mm at support {at[2]}")
        end = " The worst may be under a motion without a value." if model == "exact" else ""
        said.append(f"{head}: {'; '.join(parts)}.{end}")
    return said


PLACES = ((("3", "2"), ("-3.1", "2.2"), ("-3.3", "-2.4"), ("3.5", "-2.6")), (("2", "1.1"), ("-2.2", "1.3"), ("0.4", "-1.5")))
CHOSEN_SAID = (
    "The spatial engine computed, {}: Kobe (largest drift, largest displacement); Northridge (asked for); Tabas "
    "(largest base shear).",
    "The spatial engine computed, {}: El Centro (nearest the median displacement); Kobe (largest support force); "
    "Northridge (smallest support force; tolerance not met).",
)
TRAVEL_SAID = (
    "The travel is reached under Tabas at 7.654 s ({}). No demand has a value there. A run without `travel` gives the "
    "displacement that is needed."
)
SCALED_SAID = (
    "Scale 1 is that of the target spectrum: least squares over periods from 0.2 to 1.5 s, in the logarithm, at 5 % "
    "damping."
)


def isolator_by_hand(structure: int) -> tuple[str, str]:
    """Its sentence, and its cell on the page: of the bilinear loop at mean or median displacement."""
    radius, friction = ((2.0, 0.06), (1.6, 0.07))[structure]
    told = tell(structure, "displacement", ISOLATOR, 2.0)
    assert told is not None
    statistic, moved = (("median", told.numbers[2][0]), ("mean", told.numbers[0][0]))[structure]
    assert moved is not None
    stiffness = 1.0 / radius + friction / moved  # over the weight
    period, damping = 2.0 * math.pi / math.sqrt(GRAVITY * stiffness), 2.0 / math.pi * friction / moved / stiffness
    ratio, at = moved / radius / friction, f"{1e3 * moved:.4g} mm"
    said = (
        f"Effective isolator of design codes at the {statistic} displacement, {at}, and friction {friction}: period "
        f"{period:.3g} s, damping {100.0 * damping:.0f} %, re-centering ratio {ratio:.3g}."
    )
    cell = f"{period:.3g} s, {100 * damping:.3g} % at the {statistic} displacement, {at}, and friction {friction}"
    return said, cell


def drift_by_hand(structure: int) -> str:
    known = {at: each.value for at, each in RAW.items() if (at[0], at[1], at[4], at[5]) == (structure, "drift_ratio", 2.0, "exact")}
    at = max(known, key=lambda each: known[each])
    share = f"{100.0 * known[at]:.3g} % of the height of the story, above 10 %"
    return f"Warning: the drift below {FLOORS[structure][at[2] - 1]} under {at[3]} is {share}: is stiffness in N/m?"


def sentences_by_hand(labels: Sequence[str]) -> list[str]:
    """What the terminal says after the tables of the equations."""
    first, second = labels
    moved, shear = tell(1, "displacement", ISOLATOR, 2.0), tell(1, "base_shear", ISOLATOR, 2.0)
    assert moved is not None
    assert shear is not None
    mean, largest = (1e3 * (moved.numbers[place][0] or 0.0) for place in (0, 4))
    share, most = (100.0 / WEIGHTS[1] * (shear.numbers[place][0] or 0.0) for place in (0, 4))
    return [
        f"{first}: {isolator_by_hand(0)[0]}",
        f"{first}: {drift_by_hand(0)}",
        f"{second}: Without a value for 1 motion: residual displacement ({MOVING}).",
        f"{second}: {isolator_by_hand(1)[0]}",
        f"{second}: The center of mass of the platform is 0.4 m below the sliding contact: `height` counts from the "
        "centers of the depressions, which lie R = radius + sphere_radius below it.",
        f"{second}: {drift_by_hand(1)}",
        TRAVEL_SAID.format(first),
        f"No value under Tabas ({first}). Isolator displacement: at least the travel, 500 mm ({first}); mean "
        f"{mean:.4g} mm, largest {largest:.4g} mm ({second} alone, {moved.motion}); base shear: mean {share:.4g} % of "
        f"the weight, largest {most:.4g} % of the weight ({second} alone, {shear.motion}). Outcomes by the equations: "
        "28 ok, 2 travel reached.",
    ]


HEADS = ["mean", "16 %", "50 %", "84 %", "largest"]


def without_error(cell: str) -> str:
    return cell.partition(" ±")[0]


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
        expected += [[f"{'Envelope' if bound == 'envelope' else bound}:"], ["quantity", "unit", *HEADS, "motion"]]
        for row in main_rows(labels):
            mean, *others = row.cells
            last = ", ".join(filter(None, [row.motion, row.where, *row.bounds[-1:]]))
            cells = [row.name, row.unit, mean, *map(without_error, others), last]
            expected += [[*filter(None, cells)]] if row.bound == bound else []
    expected += [[line] for line in sentences_by_hand(labels)]
    expected += [[CHOSEN_SAID[structure].format(label)] for structure, label in enumerate(labels)]
    expected += [["The engine was asked for largest accelerations to 2 %."]]
    for structure, label in enumerate(labels):
        expected += [[f"{label}, mean difference from the exact equations on 2 motions:"],
                     ["quantity", "exact", "small", "translational", "spatial"]]  # fmt: skip
        expected += [[name, mean, *filter(None, briefs)] for name, mean, briefs, _ in model_rows(structure)]
    expected += [[trust_by_hand(labels)], *([line] for line in support_sentences_by_hand(labels))]
    assert printed == expected


Tables = list[list[list[str]]]


def sections_of(text: str) -> dict[str, tuple[Tables, list[str]]]:
    """The tables, as rows of cells, and the headings and paragraphs of every section of a page."""

    def plain(part: str) -> str:
        return html.unescape(re.sub(r"<[^>]+>", "", part.replace("<br><small>", " / ")))

    found = {}
    for name, part in re.findall(r'<section id="(\w+)".*?</h2>(.*?)</section>', text, re.DOTALL):
        tables = [
            [[plain(cell) for cell in re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row)] for row in re.findall("<tr>(.*?)</tr>", each)]
            for each in re.findall(r"<table.*?</table>", part, re.DOTALL)
        ]
        lines = re.findall(r'<(?:p|h3|figcaption|p class="alert amber")>(.*?)</(?:p|h3|figcaption)>', part)
        found[name] = tables, [plain(line) for line in lines]
    return found


def table_by_hand(rows: Sequence[Row], first: str, placed: bool) -> list[list[str]]:
    """A table of demands of the page; the name of a demand stands once, with its unit in a table of several demands."""
    heads = [first, "bound", *HEADS, "motion", *["where"] * placed, "motions"]
    table, above = [heads], ""
    for row in rows:
        name = f"{row.name}, {row.unit}" if first == "demand" else row.name
        every = row.bounds and len({*row.bounds}) == 1
        bound = f"{row.bound}: {row.bounds[0]}" if every else row.bound
        cells = [f"{cell} / {at}" for cell, at in zip(row.cells, row.bounds)] if row.bounds and not every else row.cells
        where = [row.where] * placed
        table.append(["" if name == above else name, bound, *cells, row.motion, *where, row.motions])
        above = name
    return table


def directions_by_hand(labels: Sequence[str]) -> tuple[list[str], Tables]:
    titles, tables = [], []
    for quantity, title, unit, factor in (
        ("story_shear", "Story shear", "kN", 1e-3), ("drift", "Drift", "mm", 1e3),
        ("overturning_moment", "Overturning moment of the forces", "kN m", 1e-3),
    ):  # fmt: skip
        heads = [f"along {axis}, {part}" for axis in "xy" for part in ("mean", "largest")]
        table, above = [["place", "bound", *heads]], ""
        for x, y in zip(*(profile_rows(f"{quantity}_{axis}", unit, factor, labels) for axis in "xy")):
            cells = []
            for row in (x, y):
                for place in (0, 4):
                    source = ", ".join(filter(None, [row.motion * (place == 4), *row.bounds[place : place + 1]]))
                    cells.append(f"{row.cells[place]} / {source}" if source else row.cells[place])
            table.append(["" if x.name == above else x.name, x.bound, *cells])
            above = x.name
        titles.append(f"{title}, {unit}")
        tables.append(table)
    return titles, tables


def motions_by_hand(labels: Sequence[str]) -> list[list[str]]:
    shown = [each for each in MAIN if each[1] in (
        "displacement", "base_shear", "acceleration", "drift_ratio", "support_force_max", "support_force_min", "residual"
    ) and each[2] != "%" * (each[1] == "base_shear") and not each[0].startswith("platform")]  # fmt: skip
    table = [["motion", "bound", *(f"{name}, {unit}" for name, _, unit, _, _ in shown), "outcome"]]
    for structure, label in enumerate(labels):
        for motion in MOTIONS:
            cells = []
            for _, quantity, _, factor, bodies in shown:
                at = [(structure, quantity, body, motion, 2.0, "exact") for body in bodies]
                own = [RAW[each].value for each in at if each in RAW]
                cells.append(f"{max(own) * (factor or 0.0):.4g}" if own else "none")
            outcome = "travel reached" if (structure, motion, 2.0) in LOST else "ok"
            table.append([motion, label, *cells, outcome])
    return table


def supports_by_hand(labels: Sequence[str]) -> list[list[str]]:
    ends = ["smallest by {}, kN", "motion", "largest by {}, kN", "motion", "motions"]
    heads = [each.format(by) for by in ("statics", "the engine") for each in ends]
    table = [["bound", "support", "x, m", "y, m", "at rest, kN", *heads, "uplift, mm"]]
    for structure, label in enumerate(labels):
        loads = reference.describe_building(scene(structure, 0, 1.0)).support_loads
        assert loads is not None
        for number in range(1, SUPPORTS[structure] + 1):
            row = [label, str(number), *PLACES[structure][number - 1], f"{loads[number - 1] / 1e3:.4g}"]
            for model, count in (("exact", ("4 of 5", "5")), ("spatial", ("3 of 5", "2 of 5"))):
                for name, choose in (("smallest", min), ("largest", max)):
                    known = {motion: RAW[at] for motion in MOTIONS
                             if (at := (structure, name, number, motion, 2.0, model)) in RAW}  # fmt: skip
                    motion = choose(known, key=lambda each: known[each].value)
                    row += [word(1e-3 * known[motion].value, 1e-3 * known[motion].error), motion]
                row.append(count[structure])
            gap = max((each for at, each in RAW.items() if at[:3] == (structure, "gap", number)), key=lambda one: one.value)
            table.append([*row, word(1e3 * gap.value, 1e3 * gap.error)])
    return table


def extended_by_hand(labels: Sequence[str]) -> list[list[str]]:
    """Statistics of the equations times the engine's mean ratio, with the range of the ratio."""
    table = [["demand", "bound", "ratio", "motions", "mean", "84 %", "largest"]]
    for structure, label in enumerate(labels):
        for name, quantity, unit, factor, bodies in COMPARED:
            ratios = [*ratios_by_hand(structure, quantity, bodies)[1]["spatial"].values()]
            times = sum(ratios) / len(ratios), min(ratios), max(ratios)
            told, cells = tell(structure, quantity, bodies, 2.0), []
            assert told is not None
            smallest = quantity.endswith("_min")
            for head, place in (("", 0), ("16 %: ", 1), ("smallest: ", 4)) if smallest else (("", 0), ("", 3), ("", 4)):
                value, _, mark = told.numbers[place]
                text = "none"
                if value is not None and not (quantity == "displacement" and mark and place):
                    mean, low, high = (f"{each * value * (factor or 0.0):.4g}" for each in times)
                    text = f"{mean} ({low} to {high})"
                    text = text + mark if mark.startswith(" ") else mark + text
                cells.append(head + text)
            ratio = "{:.3f} ({:.3f} to {:.3f})".format(*times)
            table.append([f"{name}, {unit}", label, ratio, "2", *cells])
    return table


def checks_by_hand(labels: Sequence[str]) -> list[list[str]]:
    """Weight, dead loads, period, base shear and top drift; the planted ones are beyond their ranges."""
    table = [["quantity", "bound", "formula", "by hand", "in this report", "difference"]]
    for structure, label in enumerate(labels):
        building = reference.describe_building(scene(structure, 0, 1.0))
        radius, friction, tons = ((2.0, (0.03, 0.06), "93"), (1.6, (0.04, 0.07), "36"))[structure]
        weight, top = WEIGHTS[structure] / 1e3, len(FLOORS[structure])
        rigid, fixed = 2.0 * math.pi * math.sqrt(radius / GRAVITY), building.fixed_base_period[0, 0]

        def row(what: str, formula: str, low: float, high: float, found: float, unit: str) -> list[str]:
            ends = f"{low:.4g}" if low == high else f"{low:.4g} to {high:.4g}"
            off = f"outside by {100.0 * max(low - found, found - high) / found:.2g} %"
            verdict = "0.00 %" if low == high else "inside" if low <= found <= high else off
            return [what, label, formula, f"{ends} {unit}", f"{found:.4g} {unit}", verdict]

        table.append(row("weight", f"{tons} t × 9.81 m/s²", weight, weight, weight, "kN"))
        table.append(row("dead loads of all supports together", "weight", weight, weight, weight, "kN"))
        formula = f"T = 2π √({radius:g} / 9.81) to √(T² + {fixed:.3g}²)"
        period = building.isolated_period[0, 0]
        table.append(row("first period on the isolator, along x", formula, rigid, math.hypot(rigid, fixed), period, "s"))
        known = {at[3]: each.value for at, each in RAW.items() if (at[0], *at[1:3], *at[4:]) == (
            structure, "displacement", 0, 2.0, "exact")}  # fmt: skip
        motion = max(known, key=lambda each: known[each])
        slope = math.tan(math.asin(known[motion] / radius))
        formula = (
            f"W √(tan² φ + {friction[0]}²) to W (tan φ + {friction[1]}), sin φ = {1e3 * known[motion]:.4g} / "
            f"{1e3 * radius:g}"
        )
        low, high = weight * math.hypot(slope, friction[0]), weight * (slope + friction[1])
        shear = RAW[structure, "base_shear", 0, motion, 2.0, "exact"].value / 1e3
        table.append(row(f"base shear under {motion}", formula, low, high, shear, "kN"))
        shear, drift = (max(each.value for at, each in RAW.items() if (*at[:3], *at[4:]) == (
            structure, name, top, 2.0, "exact")) for name in ("story_shear", "drift"))  # fmt: skip
        soft, stiff = ((19.0, 25.0), (8.0, 9.0))[structure]
        zeta = building.modal_damping[:, -1].max()
        formula = f"V / (k √(1 + (2 ζ)²)) to V / k, V = {shear / 1e3:.4g} kN, k = {stiff:g} to {soft:g} MN/m, ζ = {zeta:.3g}"
        what = f"largest drift below {FLOORS[structure][-1]}"
        table.append(row(what, formula, shear / stiff / 1e3 / math.hypot(1.0, 2.0 * zeta), shear / soft / 1e3, 1e3 * drift, "mm"))
    return table


def suite_by_hand() -> list[list[str]]:
    table = [["motion", "magnitude", "step, s", "duration, s", *(f"peak {axis}, g" for axis in "xyz"),
              *(f"peak velocity {axis}, m/s" for axis in "xyz"), "peak, g", "factor", "files"]]  # fmt: skip
    for number, motion in enumerate(MOTIONS):
        along = ground(number).T
        peaks = [f"{np.abs(one).max() / GRAVITY:.3g}" for one in along]
        moved = [f"{np.abs(np.cumsum(0.025 * (one[1:] + one[:-1]))).max():.3g}" for one in along]
        empty, listed = [""] * (3 - len(along)), motion == "Kobe"
        largest = f"{np.hypot(*along[:2]).max() / GRAVITY:.3g}"
        cells = ["0.05", "2.95", *peaks, *empty, *moved, *empty, largest, "1.3" if listed else "1", ""]
        table.append([motion, "6.9" if listed else "not known", *cells])
    return table


def building_by_hand(labels: Sequence[str]) -> list[list[str]]:
    buildings = [reference.describe_building(scene(structure, 0, 1.0)) for structure in (0, 1)]

    def axes(read: np.ndarray, factor: float = 1.0) -> str:
        texts = [", ".join(f"{factor * each:.3g}" for each in one) for one in read]
        return "; ".join(f"{text} along {axis}" for text, axis in zip(texts, "xy"))

    loads = []
    for building in buildings:
        own = np.asarray(building.support_loads) / 1e3
        loads.append(f"{len(own)}, {own.min():.4g} to {own.max():.4g}, mean {own.mean():.4g}")
    tower, house = (isolator_by_hand(structure) for structure in (0, 1))
    ratios = [said[0].rpartition(" ")[2].removesuffix(".") for said in (tower, house)]
    return [
        ["quantity", "unit", *labels], ["bodies, the platform among them", "", "3", "2"],
        ["weight", "kN", f"{93 * GRAVITY:.5g}", f"{36 * GRAVITY:.5g}"],
        ["supports, and dead load of each", "kN", *loads], ["effective radius", "m", "2", "1.6"],
        ["radius of the spheres", "m", "0.1", "none stated"],
        ["friction at rest, at high speed", "", "0.03, 0.06", "0.04, 0.07"],
        ["rate of friction with the speed", "s/m", "50", "45"], ["travel", "mm", "500", "none stated"],
        ["periods on the isolator, without friction", "s", *(axes(each.isolated_period) for each in buildings)],
        ["periods above a fixed base", "s", *(axes(each.fixed_base_period) for each in buildings)],
        ["damping of these modes", "%", *(axes(each.modal_damping, 100.0) for each in buildings)],
        ["masses of the bodies, from the platform", "t", "40, 31, 22", "25, 11"],
        ["offsets of their centers of mass", "m", "0, 0; 0, 0; 0, 0", "0.1, -0.2; 0, 0"],
        ["stiffness of the stories, from the lowest", "MN/m", "30 along x, 21 along y; 19 along x, 25 along y",
         "9 along x, 8 along y"],
        ["sizes of the bodies in plan", "m", "7 × 5.5; 7.2 × 5.3; not stated", "5 × 3.5; not stated"],
        ["heights above the sliding contact", "m", "0.5, 3.6, 6.8", "-0.4, 3"],
        ["effective period and damping", "s, %", tower[1], house[1]], ["re-centering ratio there", "", *ratios],
    ]  # fmt: skip


PROFILES = (
    ("acceleration", "Floor acceleration, as integrated", "g", G),
    ("acceleration_supremum", "Floor acceleration, literal supremum", "g", G),
    ("drift", "Drift against the body below", "mm", 1e3),
    ("drift_ratio", "Drift over the height of the story", "%", 100.0),
    ("story_shear", "Story shear", "kN", 1e-3), ("overturning_moment", "Overturning moment", "kN m", 1e-3),
)  # fmt: skip


@pytest.mark.parametrize("names", NAMES)
def test_the_page_shows_every_table_and_sentence(names: str) -> None:
    found, labels = plant(NAMES[names]), LABELS[names]
    text = page.render_ensemble_page(found)
    tables, lines = ({name: part[place] for name, part in sections_of(text).items()} for place in (0, 1))
    assert tables["building"] == [building_by_hand(labels)]
    assert tables["suite"] == [suite_by_hand()]
    assert tables["demands"] == [table_by_hand(main_rows(labels), "demand", True)]
    profiles = []
    for quantity, _, *unit in PROFILES:
        rows = [row for row in profile_rows(quantity, *unit, labels) if (quantity, row.name) != (
            "acceleration_supremum", "body 2")]  # fmt: skip
        profiles.append(table_by_hand(rows, "place", False))
    assert tables["height"] == profiles
    titles, directions = directions_by_hand(labels)
    assert (lines["directions"], tables["directions"]) == (titles, directions)
    assert tables["supports"] == [supports_by_hand(labels)]
    assert tables["motions"] == [motions_by_hand(labels)]
    assert tables["hand_checks"] == [checks_by_hand(labels)]
    heads = ["demand", "bound", "exact equations", "small equations", "translational engine", "spatial engine", "motions"]
    trust = [[name, label, mean, *texts, "2"] for s, label in enumerate(labels) for name, mean, _, texts in model_rows(s)]
    assert tables["trust"] == [[heads, *trust]]
    assert tables["extended"] == [extended_by_hand(labels)]
    assert tables["scales"] == [table_by_hand(main_rows(labels, scale), "demand", True) for scale in (0.8, 0.5)]
    assert (lines["scales"], tables["run"]) == (["Scale 0.8", "Scale 0.5"], [])
    said = sentences_by_hand(labels)
    assert lines["suite"][:1] == [
        f"Peaks from 0.173 g to 0.345 g, resultant of x and y, with the factors; duration 2.95 s. {SCALED_SAID}"
    ]
    house = f"{labels[1][:1].upper()}{labels[1][1:]}"
    assert lines["demands"][:3] == [
        "By the exact equations where no engine is named. Outcomes by the equations: 28 ok, 2 travel reached.",
        house + said[2].removeprefix(labels[1]), TRAVEL_SAID.format(labels[0]),
    ]  # fmt: skip
    assert [line for line in lines["height"] if not line.endswith("over the height")] == [
        "floor spectrum: deck", "floor spectrum: roof", *(f"{title}, {unit}" for _, title, unit, _ in PROFILES),
    ]  # fmt: skip
    assert lines["supports"] == support_sentences_by_hand(labels)
    chosen = [CHOSEN_SAID[structure].format(label) for structure, label in enumerate(labels)]
    asked = "The engine was asked for largest accelerations to 2 %."
    assert lines["trust"] == [*chosen, asked, trust_by_hand(labels)]
    assert f'<p class="answer">{said[-1]}</p>' in text
    assert "<h1>A tower, A house &amp; yard: 5 motions, scale 2</h1>" in text
    digests = [f"{each.motion} {each.digest[:12]}" for each in found.suite]
    assert lines["run"] == [
        "Made by ensemble a, 2031-02-03T04:05:06, 12.5 s of compute on a chip; phase-resonance 9.8, commit abc. "
        "ensemble.csv has every motion, summary.json every statistic. SHA-256, its first 12 digits, of samples of the "
        f"motions with their factors: {', '.join(digests)}."
    ]
    ratios = [f"{100.0 * one[0]:.2g} %" for one in reference.describe_building(scene(1, 0, 1.0)).modal_damping]
    law = "Damping is in proportion to the stiffness of the links, c = 2 ζ k / ω₁ with ζ = {} in the first mode above a fixed "
    law += "base; a higher mode has a ratio in proportion to its frequency."
    moved = (
        "Fixed spheres below, depressions in the platform’s underside: the weight W moves with the platform by the "
        "displacement, and the contact points on the spheres move the other way by r / ρ of it. The displaced weight, a "
        "moment of W × (R / ρ × displacement + drift) about the contact points, loads the supports: ρ = {} m, r = {} m, "
        "R = ρ + r = {} m, R / ρ = {}."
    )
    first = f"{labels[0][:1].upper()}{labels[0][1:]}"
    assert lines["building"] == [
        f"Amber: {said[4].replace('`', '')}",
        f"{first}: {moved.format('2', '0.1', '2.1', '1.05')}", f"{house}: {moved.format('1.6', '0', '1.6', '1')}",
        f"{first}: {law.format('3 %')}", f"{house}: {law.format(' along x, '.join(ratios))}",
        "The re-centering ratio is the restoring force over the friction force at that displacement.", "Not modeled:",
    ]  # fmt: skip


def test_a_block_has_no_table_of_drifts_and_takes_no_row_of_a_tower_behind_it() -> None:
    found, plain = plant(), {"fixed_base_period": [[], []], "modal_damping": [[], []], "stiffness": (), "sizes": (None,)}
    tower, house = found.structures
    assert house.building is not None
    block = replace(house, bodies=1, building=replace(house.building, heights=None, **plain))
    own = {name: [each for each in getattr(found, name) if each.structure == tower.name or each.body in (None, 1)]
           for name in ("stripes", "curves", "spectra")}  # fmt: skip
    both = replace(found, **own, supports=[], structures=[block, tower])
    (table,) = sections_of(page.render_ensemble_page(both))["building"][0]
    assert [row[0] for row in table] == [row[0] for row in building_by_hand(("", ""))]
    drawn = {each["title"]: each["plot"] for each in (make() for make in panels.make_height_panels(both))}
    assert [*drawn] == [f"{title} over the height" for _, title, *_ in OVER_HEIGHT], "drifts, too"
    plot = drawn["floor acceleration, as integrated over the height"]
    assert [line["y"] for line in plot["series"] if line["color"] == 0] == [[1.0]] * 3
    assert plot["y"] == {"title": "body, from the platform up", "ticks": [[1, "1"], [2, "2"], [3, "3"]]}
    own = {name: [each for each in rows if each.structure == block.name] for name, rows in own.items()}
    shown = sections_of(page.render_ensemble_page(replace(both, **own, structures=[block])))
    titles = [line for line in shown["height"][1] if not line.endswith("over the height")]
    kept = [f"{title}, {unit}" for name, title, unit, _ in PROFILES if "drift" not in name]
    assert titles == ["floor spectrum: platform", *kept]
    assert shown["directions"][1] == ["Story shear, kN", "Overturning moment of the forces, kN m"]
    checks = [row[0] for row in shown["hand_checks"][0][0][1:]]
    assert checks == ["weight", "dead loads of all supports together", "first period on the isolator, along x",
                      "base shear under Tabas"]  # fmt: skip


def motion_lines(structure: int, quantity: str, factor: float, scales: Sequence[float], label: str) -> list[dict[str, Any]]:
    """Every motion over the scales, or as a dot in the strip of its structure."""
    series = []
    for number, motion in enumerate(MOTIONS):
        own = [RAW.get((structure, quantity, 0, motion, scale, "exact")) for scale in scales]
        line: dict[str, Any] = {"name": f"{label}: one motion", "color": structure, "legend": number == 0}
        line |= {"x": [*scales], "y": [one and factor * one.value for one in own]}
        line["titles"] = [f"{motion}, {scale:g}" for scale in scales]
        if len(scales) == 1:
            line |= {"x": [structure + 0.3 * ((number + 0.5) / 5 - 0.5)], "marks": True, "line": False}
            line |= {key: [one and factor * (one.value + side * one.error) for one in own]
                     for key, side in (("low", -1.0), ("high", 1.0))}  # fmt: skip
        series.append(line if len(scales) == 1 else line | {"width": 0.7})
    return series


def approximate(value: Any) -> Any:
    """Numbers inside, to twelve digits."""
    if isinstance(value, dict):
        return {key: approximate(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [approximate(each) for each in value]
    return float(f"{value:.11e}") if isinstance(value, float) else value


STATED = ({"displacement": 0.3}, {"base_shear": 0.25, "acceleration": 4.0, "statistic": "mean"})


@pytest.mark.parametrize("scales", [SCALES, (2.0,)])
def test_plots_of_the_isolator_have_every_motion_median_mean_travel_and_limit(scales: Sequence[float]) -> None:
    found, labels, one = plant(scales=scales), LABELS["short"], len(scales) == 1
    limits = {name: DemandLimits(**stated) for name, stated in zip(NAMES["short"], STATED)}
    found = replace(found, limits=list_verdicts(check_limits(found, limits)))
    drawn = [make() for make in panels.make_isolator_panels(found)]
    asked = (
        ("displacement", "largest displacement of the isolator", "mm", 1e3),
        ("residual", "residual displacement of the isolator", "mm", 1e3),
        ("base_shear", "base shear", "% of the weight", None), ("uplift", "largest uplift of a support", "mm", 1e3),
        ("support_force_max", "largest support force", "kN", 1e-3),
    )  # fmt: skip
    assert [each["title"] for each in drawn] == [title for _, title, _, _ in asked]
    for panel, (quantity, title, unit, by) in zip(drawn, asked):
        series, engine = [], []
        for structure, label in enumerate(labels):
            factor = factor_of(by)(structure)
            if quantity != "uplift":
                series += motion_lines(structure, quantity, factor, scales, label)
            if (structure, quantity) == (0, "displacement"):
                reached = {"El Centro": 0.8, "Tabas": 2.0} if not one else {"Tabas": 0.3 * 0.4}
                series.append({
                    "name": f"{label}: at the travel", "x": [*reached.values()], "y": [500.0] * len(reached), "color": 0,
                    "marks": 2, "line": False, "titles": [f"{motion}: at the travel" for motion in reached],
                })  # fmt: skip
            if quantity != "uplift":
                at = [structure + 0.3] if one else [*scales]
                told = [tell(structure, quantity, ISOLATOR, scale) for scale in scales]
                values = [[None if mark else value and factor * value for value, _, mark in each.numbers] for each in told if each]
                low, median, high = ([each[place] for each in values] for place in (1, 2, 3))
                look = {"color": structure, "band": not one, "marks": 7, "width": 2.4, "line": not one}
                name = f"{label}: median, 16 to 84 %"
                series.append({**look, "name": name, "x": at, "low": low, "y": median, "high": high})
                if quantity == "base_shear":
                    aside = [each + 0.1 if one else each for each in at]
                    mean = {"name": f"{label}: mean", "x": aside, "y": [each[0] for each in values]}
                    series.append({**mean, "color": structure, "marks": 3, "line": False})
            by_engine = {motion: RAW[key] for motion in MOTIONS
                         if (key := (structure, quantity, 0, motion, 2.0, "spatial")) in RAW}  # fmt: skip
            count = 3  # motions of the engine, with the one that failed
            order = [motion for s, motion in CHOSEN if s == structure]
            for number, motion in enumerate(order):
                estimate = by_engine.get(motion)
                ends = [estimate and factor * (estimate.value + side * estimate.error) for side in (0.0, -1.0, 1.0)]
                x = structure - 0.3 + 0.3 * ((number + 0.5) / count - 0.5) if one else 2.0
                engine.append({
                    "name": "spatial engine", "color": "ink", "marks": True, "line": False, "titles": [f"{motion}, 2"],
                    "x": [x], "y": ends[:1], "low": ends[1:2], "high": ends[2:], "legend": structure == number == 0,
                })  # fmt: skip
        span = [-0.6, 1.6] if one else [0.0, 2.08]
        lines = {"displacement": [("travel", 500.0, {"color": "ink", "width": 1.0}),
                                  ("limit (largest)", 300.0, {"color": "gray", "dash": "7 3"})],
                 "base_shear": [("limit (mean)", 25.0, {"color": "gray", "dash": "7 3"})]}  # fmt: skip
        series += [{"name": name, "x": span, "y": [value] * 2, **look} for name, value, look in lines.get(quantity, ())]
        series += engine
        assert approximate(panel["plot"]["series"]) == approximate(series), quantity
        most = max(value for each in series for key in ("y", "high") for value in each.get(key, ()) if value)
        ticks = {"ticks": [[0, labels[0]], [1, labels[1]]]} if one else {}
        x = {"title": "" if one else "scale factor of the motion", "range": span, **ticks}
        y = {"title": f"{title}, {unit}", "range": [0.0, 1.06 * most]}
        assert approximate((panel["plot"]["x"], panel["plot"]["y"])) == approximate((x, y)), quantity
        assert panel["plot"]["label"] == f"{title} {'by bound' if one else 'over the scale factor'}, 5 motions"
    note = panels.plots_note(found)
    assert note.endswith(" A diamond is the mean, where a limit is on it."), "of any of the plots"
    assert note.startswith("Every dot is one motion" if one else "Every thin line is one motion")


OVER_HEIGHT = (
    ("acceleration", "floor acceleration, as integrated", "g", G),
    ("drift_ratio", "drift over the height of the story", "%", 100.0), ("story_shear", "story shear", "kN", 1e-3),
    ("overturning_moment", "overturning moment", "kN m", 1e-3),
)  # fmt: skip


def test_plots_over_the_height_and_of_spectra_have_both_structures() -> None:
    found, labels = plant(), LABELS["short"]
    drawn = {each["title"]: each["plot"] for each in (make() for make in panels.make_height_panels(found))}
    heights = ([0.5, 3.6, 6.8], [-0.4, 3.0]), ([0.0, 0.5, 3.6], [0.0, -0.4]), ([0.25, 2.05, 5.2], [-0.2, 1.3])
    drifts = [2.05, 5.2], [1.3]
    assert [*drawn] == [f"{title} over the height" for _, title, *_ in OVER_HEIGHT]
    for (quantity, title, unit, factor), at in zip(OVER_HEIGHT, (heights[0], drifts, heights[2], heights[1])):
        series, largest = [], 0.0
        for structure, label in enumerate(labels):
            floors = FLOORS[structure]
            bodies = range(1 + ("drift" in quantity), len(floors) + 1)
            told = [tell(structure, quantity, (body,), 2.0) for body in bodies]
            places = [floors[body - 1] if quantity == "acceleration" else f"below {floors[body - 1]}" if body > 1
                      else "isolator" for body in bodies]  # fmt: skip
            for place, share, dash in ((1, "16 %", "2 2"), (2, "50 %", ""), (3, "84 %", "7 3")):
                values = [factor * (each.numbers[place][0] or math.nan) for each in told if each]
                if math.isfinite(values[0]):
                    largest = max(largest, *values)
                    series.append({
                        "name": f"{label}, {share}", "color": structure, "width": 2.4 if place == 2 else 1.2, "x": values,
                        "y": at[structure], "marks": place == 2, **({"dash": dash} if dash else {}),
                        "titles": [f"{where}: {word(value)}" for where, value in zip(places, values)],
                    })  # fmt: skip
        plot = drawn[f"{title} over the height"]
        assert approximate(plot["series"]) == approximate(series), quantity
        assert approximate(plot["x"]) == approximate({"title": f"{title}, {unit}", "range": [0.0, 1.06 * largest]})
        assert plot["y"] == {"title": "height above the sliding contact, m"}
        assert plot["label"] == f"{title} over the height: 16, 50 and 84 %, 5 motions"
    unknown = [replace(each, fractiles=(replace(each.fractiles[0], value=None), *each.fractiles[1:]))
               if (each.quantity, each.body) == ("story_shear", 2) else each for each in found.stripes]  # fmt: skip
    plots = (make()["plot"] for make in panels.make_height_panels(replace(found, stripes=unknown)))
    line = next(plot for plot in plots if plot["x"]["title"] == "story shear, kN")["series"][0]
    assert (line["x"][1], line["titles"][1], len(line["x"])) == (None, "below body 2: none", 3)
    nothing = replace(found.spectra[0], fractiles=[[Statistic(None, None)] * 3] * 3)
    plot, _ = (make()["plot"] for make in panels.make_floor_spectra_panels(replace(found, spectra=[nothing])))
    assert plot["y"]["range"] == [0.0, 1.0], "without a value"
    spectra = [make() for make in panels.make_floor_spectra_panels(found)]
    for panel, name, bodies in zip(spectra, ("deck", "roof"), ((1, 1), (3, 2)), strict=True):
        series = []
        for structure, (label, body) in enumerate(zip(labels, bodies)):
            # Of x and y, whose numbers rise by 3: the periods of y of this body
            largest = np.arange(6.0 * body - 2.0, 6.0 * body + 1.0)
            motions = [1.0 + number + 7.0 * structure for number in range(4 + structure)]
            lost = [math.inf] * (1 - structure)
            shares = {key: hazen(motions, share, lost) for key, share in (("low", 0.16), ("y", 0.5), ("high", 0.84))}
            bands = {key: [value and float(value * one) * G for one in largest] for key, value in shares.items()}
            look = {"color": structure, "x": [0.1, 0.5, 3.0], "band": True, "marks": False, "width": 2.4}
            series.append({"name": f"{label}: median, 16 to 84 %", **look, **bands})
        assert approximate(panel["plot"]["series"]) == approximate(series), name
        assert panel["title"] == f"floor spectrum: {name}"
        assert panel["plot"]["label"] == f"floor spectrum of the {name}, 5 motions"
        axes = panel["plot"]["x"], panel["plot"]["y"]["title"]
        ticks = [[0.1, "0.1"], [0.2, "0.2"], [0.5, "0.5"], [1.0, "1"], [2.0, "2"]]
        assert axes == ({"title": "period, s", "log": True, "ticks": ticks}, "pseudo-acceleration, 5 % damping, g")
    (ground_plot,) = (make() for make in panels.make_ground_panels(found))
    spectra = [[(2.0 + number) * G, (1.0 + number) * G] for number in range(5)]
    look = {"x": [0.2, 1.5], "name": "one motion", "color": "gray", "width": 0.7}
    series = [{**look, "y": each, "legend": number == 0, "titles": [MOTIONS[number]] * 2}
              for number, each in enumerate(spectra)]  # fmt: skip
    for name, color, values in (("geometric mean of the motions", 0, np.prod(spectra, axis=0) ** 0.2),
                                ("target", "ink", np.array([3.0, 2.0]) * G)):  # fmt: skip
        series.append({"x": [0.2, 1.5], "y": values.tolist(), "name": name, "color": color, "width": 2.4})
    assert approximate(ground_plot["plot"]["series"]) == approximate(series)
    assert ground_plot["plot"]["label"] == "response spectra of the ground and their target, 5 motions at scale 1"
