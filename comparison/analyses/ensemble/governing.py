"""Choice of the motions for the engine: those with a worst demand by the equations, and the one nearest the median."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from comparison.analyses.ensemble.members import EnsembleMember, group_rows_by
from comparison.analyses.ensemble.quantities import SMALLEST_IS_WORST
from comparison.cli.arguments import read_whole_number
from comparison.study.models import EXACT
from reference.problem import Scene, SceneError

if TYPE_CHECKING:
    from comparison.analyses.ensemble.analysis import MotionDemandsAtScale
    from comparison.analyses.ensemble.result import EnsembleResult

ALL_MOTIONS = "all"  # value of the option --engine that selects every motion
# Demands that govern: the engine computes the motion with the worst value of each, for the reason stated in words
GOVERNING = {
    "displacement": "largest displacement",
    "base_shear": "largest base shear",
    "drift": "largest drift",
    "support_force_max": "largest support force",
    "support_force_min": "smallest support force",
}
# For each demand that the equations lack: their demands whose worst motions are taken to be its worst motions, too
GOVERNING_OF_LIMITS = {
    "uplift": ("support_force_max", "support_force_min"),
    "support_displacement": ("displacement",),
}
# Further reasons why the engine computes a motion
MEDIAN_REASON = "nearest the median displacement"
ASKED_REASON, NEXT_LARGEST_REASON = "asked for", "next largest displacement"
MAX_ENGINE_MOTIONS = 100_000  # largest number of motions per structure that a user may ask for
EXPECTED_GOVERNING_COUNT = 3  # assumed number of governing motions per structure while the equations are not solved

# Motions that the engine is asked to compute: their number per structure, or their names, or None for those with a
# worst demand or the median displacement
EngineRequest = int | tuple[str, ...] | None


@dataclass(frozen=True)
class ChosenMember:
    """A motion chosen for the multibody engine to compute, and the reasons for the choice."""

    member: EnsembleMember
    reasons: tuple[str, ...]


def parse_engine_option(words: Sequence[str] | None, members: Sequence[EnsembleMember]) -> EngineRequest:
    """Return which motions `--engine all | N | NAME` asks for (None: those that govern demands). Raises SceneError."""
    if words is None:
        return None
    names = list(dict.fromkeys(member.motion for member in members))
    if list(words) == [ALL_MOTIONS]:
        return MAX_ENGINE_MOTIONS
    if len(words) == 1 and words[0] not in names and words[0].lstrip("+-").replace(".", "", 1).isdigit():
        return read_whole_number("--engine", words[0], 0, MAX_ENGINE_MOTIONS)
    for word in words:
        if word not in names:
            shown = ", ".join(names[:10]) + (" and so on" if len(names) > 10 else "")
            raise SceneError("command line", "--engine", word, f"must be all, a number, or motions: {shown}")
    return tuple(words)


def estimate_engine_motion_count(asked: EngineRequest, motions: int) -> int:
    """Return how many motions of a structure the engine is expected to compute, before the equations are solved."""
    count = EXPECTED_GOVERNING_COUNT if asked is None else len(asked) if isinstance(asked, tuple) else asked
    return min(count, motions)


def bound_motion_count(asked: EngineRequest, scene: Scene, motions: int) -> int:
    """Return an upper bound on the number of motions of a structure that the engine will compute."""
    if asked is not None:
        return estimate_engine_motion_count(asked, motions)
    # Every demand in GOVERNING and the median may choose another motion, but for demands that the scene lacks: the
    # drift of a single body, both support forces without supports.
    absent = (len(scene.bodies) == 1) + 2 * (scene.support_places is None)
    return min(len(GOVERNING) + 1 - absent, motions)


def choose_motions(points: Sequence[MotionDemandsAtScale], asked: EngineRequest) -> list[ChosenMember]:
    """
    Return the motions that the engine is to compute, chosen by the demands of the exact equations.

    They are at the largest scale, or all motions at every scale if these are asked for. points: the demands of every
    motion by the exact equations.
    """
    if asked == MAX_ENGINE_MOTIONS:
        return [ChosenMember(point.member, (ASKED_REASON,)) for point in points]
    top = max((point.member.scale for point in points), default=0.0)
    chosen: list[ChosenMember] = []
    for own in group_rows_by([point for point in points if point.member.scale == top], "member.structure").values():
        if isinstance(asked, tuple):
            chosen += [ChosenMember(point.member, (ASKED_REASON,)) for point in own if point.member.motion in asked]
            continue
        reasons: dict[int, list[str]] = {}
        for place, reason in _find_governing(own):
            reasons.setdefault(place, []).append(reason)
        if asked is not None:
            for place in sorted(range(len(own)), key=lambda place: -_largest_demand(own[place], "displacement")):
                reasons.setdefault(place, [NEXT_LARGEST_REASON])
            reasons = dict(list(reasons.items())[:asked])
        chosen += [ChosenMember(own[place].member, tuple(why)) for place, why in reasons.items()]
    return chosen


def _find_governing(points: Sequence[MotionDemandsAtScale]) -> Iterator[tuple[int, str]]:
    """Yield the index in `points` of each motion with a worst or the median demand, and the reason in words."""
    for quantity, reason in GOVERNING.items():
        values = [_largest_demand(point, quantity) for point in points]
        if max(values, default=-math.inf) > -math.inf:
            yield int(np.argmax(values)), reason
    moved = np.array([_largest_demand(point, "displacement") for point in points])
    known = moved[moved > -math.inf]
    if len(known):
        yield int(np.argmin(np.abs(moved - np.median(known)))), MEDIAN_REASON


def list_governing_motions(ensemble: EnsembleResult, structure: str, limited: str) -> dict[str, str]:
    """
    Return the motions with the worst values of a demand on which a limit is, each with the reason in words.

    They are those by the equations at the largest scale. limited: key of the demand; one that the equations lack has
    the motions of GOVERNING_OF_LIMITS.
    """
    worst: dict[str, str] = {}
    for quantity in GOVERNING:
        values = [
            (_sign_of_worst(quantity) * number.value, motion)
            for numbers in ensemble.values_by_body(structure, quantity, EXACT.key, ensemble.largest_scale).values()
            for motion, number in numbers.items()
            if number.value is not None
        ]
        if values:
            worst[quantity] = max(values)[1]
    own = [quantity for quantity in GOVERNING_OF_LIMITS.get(limited, ()) if quantity in worst] or list(worst)
    found: dict[str, list[str]] = {}
    for quantity in own:
        found.setdefault(worst[quantity], []).append(GOVERNING[quantity])
    return {motion: " and the ".join(reasons) for motion, reasons in found.items()}


def _sign_of_worst(quantity: str) -> float:
    """Return -1 for a demand whose smallest value is the worst, else 1."""
    return -1.0 if quantity in SMALLEST_IS_WORST else 1.0


def _largest_demand(point: MotionDemandsAtScale, quantity: str) -> float:
    """Return a motion's worst value of a demand over the bodies, negated if small is worse; -inf if unknown."""
    values = [_sign_of_worst(quantity) * number.value for (name, _), number in point.values.items() if name == quantity]
    return max((value for value in values if math.isfinite(value)), default=-math.inf)
