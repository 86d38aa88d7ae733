"""The motions that the engine computes: those that govern by the equations, and the one nearest the median."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from comparison.analyses.ensemble.members import Member, group_by
from comparison.cli.arguments import read_whole_number
from comparison.study.models import EXACT
from reference.problem import Scene, SceneError

if TYPE_CHECKING:
    from comparison.analyses.ensemble.analysis import Point
    from comparison.analyses.ensemble.result import EnsembleResult

ALL = "all"
GOVERNING = {  # demands whose largest value chooses a motion, and the words for it; of a demand of bodies the largest
    "displacement": "largest displacement",
    "base_shear": "largest base shear",
    "drift": "largest drift",
    "support_force_max": "largest support force",
}
MEDIAN = "nearest the median displacement"
ASKED, NEXT = "asked for", "next largest displacement"
MOST = 100_000  # motions of every structure that may be asked for
USUAL = 3  # motions of a structure that govern, before it is known which

Asked = int | tuple[str, ...] | None  # so many of each structure, or these motions, or those that govern


@dataclass(frozen=True)
class Choice:
    """A motion of the engine, and why."""

    member: Member
    reasons: tuple[str, ...]


def parse_engine_option(words: Sequence[str] | None, members: Sequence[Member]) -> Asked:
    """Which motions `--engine all | N | NAME ...` asks for; those that govern without it. Raises SceneError."""
    if words is None:
        return None
    names = list(dict.fromkeys(member.motion for member in members))
    if list(words) == [ALL]:
        return MOST
    if len(words) == 1 and words[0] not in names and words[0].lstrip("+-").replace(".", "", 1).isdigit():
        return read_whole_number("--engine", words[0], 0, MOST)
    for word in words:
        if word not in names:
            shown = ", ".join(names[:10]) + (" and so on" if len(names) > 10 else "")
            raise SceneError("command line", "--engine", word, f"must be all, a number, or motions: {shown}")
    return tuple(words)


def expected_count(asked: Asked, motions: int) -> int:
    """How many motions of a structure the engine will compute, before the equations say which."""
    count = USUAL if asked is None else len(asked) if isinstance(asked, tuple) else asked
    return min(count, motions)


def largest_count(asked: Asked, scene: Scene, motions: int) -> int:
    """Return the most motions of a structure that the engine may compute: every demand may choose another one."""
    if asked is not None:
        return expected_count(asked, motions)
    absent = (len(scene.bodies) == 1) + (scene.support_places is None)  # no drift, no support forces
    return min(len(GOVERNING) + 1 - absent, motions)


def choose_motions(points: Sequence[Point], asked: Asked) -> list[Choice]:
    """The motions of the engine by the demands of the equations; with `all` at every scale, else at the largest."""
    if asked == MOST:
        return [Choice(point.member, (ASKED,)) for point in points]
    top = max((point.member.scale for point in points), default=0.0)
    chosen: list[Choice] = []
    for own in group_by([point for point in points if point.member.scale == top], "member.structure").values():
        if isinstance(asked, tuple):
            chosen += [Choice(point.member, (ASKED,)) for point in own if point.member.motion in asked]
            continue
        reasons: dict[int, list[str]] = {}
        for place, reason in _find_governing(own):
            reasons.setdefault(place, []).append(reason)
        if asked is not None:
            for place in sorted(range(len(own)), key=lambda place: -_largest_demand(own[place], "displacement")):
                reasons.setdefault(place, [NEXT])
            reasons = dict(list(reasons.items())[:asked])
        chosen += [Choice(own[place].member, tuple(why)) for place, why in reasons.items()]
    return chosen


def _find_governing(points: Sequence[Point]) -> Iterator[tuple[int, str]]:
    """Places of the motions that govern, and why."""
    for quantity, reason in GOVERNING.items():
        values = [_largest_demand(point, quantity) for point in points]
        if max(values, default=-math.inf) > -math.inf:
            yield int(np.argmax(values)), reason
    moved = np.array([_largest_demand(point, "displacement") for point in points])
    known = moved[moved > -math.inf]
    if len(known):
        yield int(np.argmin(np.abs(moved - np.median(known)))), MEDIAN


def governing_motions(ensemble: EnsembleResult, structure: str) -> list[str]:
    """Return the motions of a structure that govern by the equations at the largest scale, each once."""
    found: dict[str, None] = {}
    for quantity in GOVERNING:
        values = [
            (number.value, motion)
            for numbers in ensemble.values_by_body(structure, quantity, EXACT.key, ensemble.top).values()
            for motion, number in numbers.items()
            if number.value is not None
        ]
        if values:
            found[max(values)[1]] = None
    return list(found)


def _largest_demand(point: Point, quantity: str) -> float:
    """The demand of a motion, of a demand of bodies the largest; minus infinity without an answer."""
    values = [number.value for (name, _), number in point.values.items() if name == quantity]
    return max((value for value in values if math.isfinite(value)), default=-math.inf)
