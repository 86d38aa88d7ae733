"""All sentences on the assumptions: they say how far variations of a scene change the amplification of its bodies."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from comparison.analyses.assumptions.trials import CHANGE_LIMITS, DirectionTrial
from comparison.analyses.assumptions.validity import (
    AssumptionCell,
    Validity,
    ValidityRange,
    hides_limit,
    list_cells_by_size,
)
from comparison.analyses.assumptions.variations import DIRECTED, FIRST_SIZE, UNDER_LOAD, Axis, Variation
from comparison.wording import percent, word_difference
from reference.problem import Scene

NO_EFFECT = "no effect by symmetry"  # text in place of a change of amplification that a symmetry makes zero
Base = Literal["the translational model", "the stated spatial model"]  # model that amplifications are compared with
TRANSLATIONAL: Base = "the translational model"  # the engine's model without rotations
STATED: Base = "the stated spatial model"  # the engine's model with rotations, of the scene without variations
SHARE = CHANGE_LIMITS[0]  # largest relative change of a body's amplification with which an assumption holds


@dataclass(frozen=True)
class Change:
    """
    Largest relative change of a body's amplification over the phase pairs.

    size: the change with its sign. error: its uncertainty. phases: the pair at which it is largest, rad. reading: which
    peaks count in the amplification. base: the model that the change is relative to. no_effect: why symmetry makes the
    change zero, or "".
    """

    scene: str
    body: int
    size: float
    error: float
    phases: tuple[float, float]
    reading: str
    base: Base
    no_effect: str = ""

    @property
    def verdict(self) -> str:
        """Return "met" if |change| plus error is at most SHARE (1 %), else "not met (by ...)" or "not compared"."""
        if self.no_effect or not math.isfinite(self.size + self.error):
            return "not compared"
        if hides_limit(abs(self.size), self.error, SHARE):
            return "not compared"
        excess = abs(self.size) + self.error - SHARE
        return "met" if excess <= 0.0 else f"not met (by {percent(excess)})"


def largest_change(found: Validity, cell: AssumptionCell, body: int, stated: AssumptionCell | None = None) -> Change:
    """
    Return the largest change of a body's amplification over the phase pairs, caused by the variation of `cell`.

    It is relative to the spatial model of the scene as stated if `stated` gives this, else to the translational model.
    """
    sizes, errors = (np.array(rows)[:, body - 1] for rows in (cell.change, cell.uncertainty))
    base = TRANSLATIONAL
    if stated is not None:
        before, its_error = (np.array(rows)[: len(sizes), body - 1] for rows in (stated.change, stated.uncertainty))
        if len(before) < len(sizes):  # by symmetry equal at all phase pairs: only the first was computed
            before, its_error = np.full_like(sizes, before[0]), np.full_like(sizes, its_error[0])
        # Both changes are relative to the translational model: the ratio of the two amplifications eliminates it.
        sizes, errors = (1.0 + sizes) / (1.0 + before) - 1.0, np.hypot(errors, its_error)
        base = STATED
    place = int(np.argmax(np.abs(sizes)))  # index of a NaN, if there is one: then the change is unknown
    return Change(
        scene=cell.scene,
        body=body,
        size=float(sizes[place]),
        error=float(errors[place]),
        phases=found.phases[place],
        reading=found.reading,
        base=base,
        no_effect=cell.no_effect,
    )


def describe_change(change: Change) -> str:
    """Return in words by how much a body's amplification changes, relative to which model and at which phase pair."""
    if change.no_effect:
        return f"mu_{change.body}: {NO_EFFECT}"
    if not math.isfinite(change.size):
        return f"mu_{change.body}: not compared, a phase pair has no value"
    first, second = change.phases
    size = word_difference(change.size, change.error)
    return (
        f"mu_{change.body} ({change.reading}) changes by {size} against {change.base}, at ({first:g}, {second:g}) rad"
    )


# Five phrases for each varied quantity, one for each result: the change of amplification exceeds its limit at the first
# size; is within it only at size zero; is within it up to the size {holds}; exceeds it at the size {fails}; is within
# it at all sizes tried. `describe_range` fills in the sizes, the {direction} and the {sense} of rotation.
WORDS: dict[Axis, tuple[str, str, str, str, str]] = {
    "ring": ("with a ring of {fails:g} m, the largest tried", "", "with rings from {holds:g} m",
             "at {fails:g} m", "every smaller one tried too"),
    "height": ("with heights of {fails:g} times the stated ones", "at zero heights",
               "with heights up to {holds:g} times the stated ones", "at {fails:g} times",
               "the largest tried"),
    "oval": ("with the ring narrowed by {fails:.2g} of its radius along {direction:.0f} degrees",
             "with the ring as stated",
             "with the ring narrowed by up to {holds:.2g} of its radius along {direction:.0f} degrees",
             "by {fails:.2g}", "the most tried"),
    "offset": ("with centers of mass moved by {fails:.2g} m towards {direction:.0f} degrees",
               "with centers of mass as stated",
               "with centers of mass moved by up to {holds:.2g} m towards {direction:.0f} degrees",
               "by {fails:.2g} m", "the largest tried"),
    "yaw": ("with bodies and links turned by {fails:.2g} rad {sense}", "with bodies and links as stated",
            "with bodies and links turned by up to {holds:.2g} rad {sense}", "by {fails:.2g} rad",
            "the largest tried"),
}  # fmt: skip


def describe_range(validity: ValidityRange) -> str:
    """Return in words up to which size of a variation a body's amplification changes by at most `validity.share`."""
    none, zero, holds, fails, every = WORDS[validity.key]
    name = f"mu_{validity.body}"
    if validity.no_effect:
        return f"{name} over {VARIED[validity.key]}: {NO_EFFECT}, which is no evidence ({validity.no_effect})"
    if validity.no_value:
        if validity.holds is None:
            return f"{name} over {VARIED[validity.key]}: not compared, a phase pair has no value that tells"
        fails = f"not known at {fails.partition(' ')[2]}"
    else:
        fails = f"no longer {fails}"
    if validity.holds is None:
        verb, where = "leaves", f"already {zero if validity.fails == 0.0 else none}"
    else:
        verb = "stays within"
        where = f"{zero if validity.holds == 0.0 else holds}, {every if validity.fails is None else fails}"
    place = math.degrees(validity.direction or 0.0)
    sense = "counterclockwise" if (validity.direction or 0.0) > 0.0 else "clockwise"
    values = {**vars(validity), "direction": place, "sense": sense}
    return f"{name} {verb} {100.0 * validity.share:g} % {where.format(**values)}"


VARIED: dict[Axis, str] = {  # name of each varied quantity in a phrase
    "ring": "the radius of the ring", "height": "the heights", "oval": "an oval ring", "offset": "offsets of bodies",
    "yaw": "turned bodies and links",
}  # fmt: skip


def range_cell(validity: ValidityRange) -> str:
    """
    Return a table cell on the range in which a body's amplification changes by at most the limit.

    It has the last size of the variation within the limit and the first size beyond it, or says NO_EFFECT.
    """
    if validity.no_effect:
        return NO_EFFECT
    if validity.holds is None:
        return "not compared" if validity.no_value else f"not {validity.fails:.3g}"
    beyond = "not known at" if validity.no_value else "not"
    every = " (all tried)" if validity.fails is None else f", {beyond} {validity.fails:.3g}"
    holds = f"{validity.holds:.3g}"
    return f"{'≥' if validity.key == 'ring' else '≤'} {holds}{every}"


def describe_variation(scene: Scene, variation: Variation) -> str:
    """Return in words how a variation narrows the ring of supports, moves bodies or rotates them."""
    radius, towards = scene.support_radius or 0.0, f"{math.degrees(variation.direction):.0f} degrees"
    parts = [f"ring narrowed by {variation.oval:.2g} of its radius along {towards}"] if variation.oval else []
    if variation.offset:
        parts.append(f"bodies above the platform {variation.offset * radius:.2g} m off the axis towards {towards}")
    if variation.yaw:
        parts.append(f"bodies above the platform and their links turned by {variation.yaw:.2g} rad")
    return " and ".join(parts)


def describe_direction(scene: Scene, trial: DirectionTrial) -> str:
    """Return in words how a variation in one direction changed each body's amplification, or NO_EFFECT."""
    what = describe_variation(scene, trial.variation)
    if trial.no_effect:
        return f"{what}: {NO_EFFECT}"
    changes = (
        f"mu_{body} {word_difference(size, error) if math.isfinite(size) else 'no value'}"
        for body, (size, error) in enumerate(zip(trial.change, trial.uncertainty), start=1)
    )
    return f"{what}: {', '.join(changes)}{f' ({_word_worst(trial)})' if trial.worst else ''}"


def _word_worst(trial: DirectionTrial) -> str:
    """Return "the worst" for a direction, or "taken for the worst" if its change of amplification is not known."""
    return "the worst" if np.isfinite(trial.change).all() else "taken for the worst"


def describe_uneven(found: Validity, scene: Scene) -> list[str]:
    """
    Return a line each for an oval ring, an offset and turned bodies, as far as they were tried.

    A line says how each body's amplification changes in the worst direction, at the size FIRST_SIZE.
    """
    lines = []
    for key in DIRECTED:
        trials = [each for each in found.directions if (each.scene, each.key) == (scene.name, key)]
        sizes = dict(list_cells_by_size(scene, found.cells, key))
        first, stated = sizes.get(FIRST_SIZE[key]), sizes.get(0.0)
        if first is None or stated is None:
            continue
        bodies = range(1, len(scene.bodies) + 1)
        changes = "; ".join(describe_change(largest_change(found, first, body, stated)) for body in bodies)
        telling = sum(not trial.no_effect for trial in trials)
        worst = "".join(f", {_word_worst(trial)} of {telling} directions" for trial in trials if trial.worst)
        lines.append(f"{describe_variation(scene, first.variation)}{worst}: {changes}")
    return lines


def describe_shortening(loaded: Sequence[AssumptionCell]) -> list[str]:
    """
    Return a line on how much the amplification changes if loaded bars also shorten as they sway.

    loaded: results with bars that only soften, then with bars that shorten, too. Without both there is no line.
    """
    if len(loaded) != len(UNDER_LOAD):
        return []
    softened, shortened = (1.0 + np.array(cell.change) for cell in loaded)
    change = np.abs(shortened / softened - 1.0).max(axis=0)
    error = np.hypot(*(np.array(cell.uncertainty) for cell in loaded)).max(axis=0)
    if not np.isfinite(change).all():
        return ["no value says what it changes that bars shorten as they sway"]
    numbers = [f"{100.0 * size:.2g} ± {100.0 * about:.1g} %" for size, about in zip(change, error)]
    changes = ", ".join(f"mu_{body} by up to {text}" for body, text in enumerate(numbers, start=1))
    return [f"bars that shorten as they sway, and not only soften under the weight, change {changes}"]


def assumption_lines(found: Validity, scene: Scene) -> list[str]:
    """
    Return the lines of text below a scene's plots.

    They name the varied quantities without effect on the amplification, the changes in the worst directions, the effect
    of bars that shorten, and errors.
    """
    blind = {each.key: each for each in found.ranges if each.scene == scene.name and each.no_effect}
    lines = [f"{VARIED[key]}: {NO_EFFECT}, which is no evidence ({each.no_effect})" for key, each in blind.items()]
    cells = [cell for cell in found.cells if cell.scene == scene.name]
    loaded = [cell for cell in cells if cell.variation in UNDER_LOAD]
    lost = dict.fromkeys(f"{cell.status[0]}: {cell.error_message}" for cell in cells if cell.error_message)
    return [*lines, *describe_uneven(found, scene), *describe_shortening(loaded), *lost]


def list_turning_changes(found: Validity, scene: str) -> list[Change]:
    """
    Return how much each body's amplification changes when the bodies may rotate, in the scene as stated.

    The list is empty if this was not computed.
    """
    stated = next((cell for cell in found.cells if (cell.scene, cell.variation) == (scene, Variation())), None)
    return [largest_change(found, stated, body + 1) for body in range(len(stated.change[0]))] if stated else []


def describe_verdict(found: Validity) -> str:
    """Return a line that says for each scene how rotation, excluded by assumption (vi), changes the amplification."""
    parts = []
    for scene in dict.fromkeys(cell.scene for cell in found.cells):
        changes = list_turning_changes(found, scene)
        if not changes:
            continue
        worst = max(changes, key=lambda change: np.nan_to_num(abs(change.size) + change.error, nan=np.inf))
        reason = NO_EFFECT if worst.no_effect else "no value"
        if math.isfinite(worst.size) and not worst.no_effect:
            reason = f"mu_{worst.body} {word_difference(worst.size, worst.error)}"
        parts.append(f"{scene} {worst.verdict}: {reason}")
    about = f"Bodies that turn leave mu_i ({found.reading}) within {percent(SHARE)} of {TRANSLATIONAL}"
    return f"{about}: {'; '.join(parts)}." if parts else ""
