"""
Local search on a surface over the phases whose denominator is known exactly.

In a square around the best pair of phases, the numerator is interpolated by a polynomial and divided by the exact
denominator, and the pair at which this quotient is largest is computed next. The square moves with the best pair, and
shrinks where that pair lies inside. The exact denominator lets a search follow its kinks, on which maxima of mu may
stand and which no polynomial of mu itself can show. Beside a jump of the numerator the square closes on a high pair,
and `follow_jump` goes along the jump to the highest one.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache, cached_property
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev

from reference.problem.definition import ground_peak
from reference.problem.outcome import Outcome
from reference.problem.result import Amplification, Array
from reference.problem.scene import Scene

DISPLACEMENT_ERROR = 1e-3  # relative, of `Amplification.displacement`
# Places along each axis of the square at which the quotient is read: at first, and beside the largest of them
COARSE_PLACES, FINE_PLACES = np.linspace(-1.0, 1.0, 13), np.linspace(-1.0, 1.0, 9)
REFINEMENTS = 5  # of the quotient, each four times finer than the one before
MIN_HALF_WIDTH = 1e-7  # rad, of a square
MOVING_FRACTION = 0.8  # of the half width: a best pair farther from the center moves the square, which keeps its size
NODES, MANY_NODES = 3, 5  # of a square's polynomial along each axis: at first, and after a prediction that is not good
GOOD_PREDICTION = 0.1  # largest error of a prediction over the differences in the square
FAST_SHRINKING, SLOW_SHRINKING = 0.2, 0.6  # after a good prediction, and after another
PROMISE_FACTOR = 2.0  # times the differences in its square: a search that lies farther below the highest one ends
# rounds, and times what they have gained: likewise. Beside a jump a square has large differences however small it is
LATEST_ROUNDS, GAIN_FACTOR = 6, 10.0
MAX_MERGED_WIDTH = 0.04  # rad: searches into a common square that is smaller have found one maximum
JUMP_HALF_WIDTH = 0.07  # rad, of the first square in which a jump is followed
JUMP_ROUNDS, JUMP_REFINEMENTS = 2, 5
DIRECTIONS = 32  # in which the surface beside a maximum is looked at
FAR_DISTANCE, NEAR_DISTANCE = 1e-3, 1e-4  # rad: distances at which it is
# The fall at the near distance over that at the far one: 0.01 of a parabola, 0.1 of an edge, 1 of a jump
KINK_FALL, JUMP_FALL = 0.03, 0.3
CLEAR_FALL = 10.0  # errors of the value: a smaller fall shows nothing


@dataclass(frozen=True)
class ComputedPhases:
    """Computed phase pairs; NaN without an answer."""

    phases: Array  # (M, 2), rad
    numerator: Array  # (M,)
    denominator: Array  # (M,)
    error: Array  # (M,), of the quotient

    @cached_property
    def value(self) -> Array:
        """The quotient, -inf without an answer."""
        return np.where(np.isfinite(self.numerator), self.numerator / self.denominator, -np.inf)

    def part(self, places: slice) -> ComputedPhases:
        """The points at some places."""
        return ComputedPhases(self.phases[places], self.numerator[places], self.denominator[places], self.error[places])


@dataclass
class Surface:
    """What is searched: mu of one body, or the displacement of the platform, m."""

    scene: Scene
    amplification: Callable[..., Amplification]
    settings: Mapping[str, Any]  # its arguments beside scene and phases
    body: int  # from 0
    quantity: str = "amplification"  # or "displacement"
    evaluations: int = 0  # phase pairs that were computed
    outcome: str = ""  # of the last phase pair whose outcome was not ok

    def denominator(self, phases: Array) -> Array:
        """That of (5.1), exact and cheap, (M,) at (M, 2), rad; 1 for a displacement."""
        return ground_peak(self.scene, phases) if self.quantity == "amplification" else np.ones(len(phases))

    def at(self, phases: Array, **changes: Any) -> ComputedPhases:
        """Computed at (M, 2), rad, with `changes` of the settings."""
        result = self.amplification(self.scene, phases, **{**self.settings, **changes})
        self.evaluations += len(phases)
        self.outcome = next((str(status) for status in result.status[::-1] if status != Outcome.OK.value), self.outcome)
        denominator = self.denominator(phases)
        if self.quantity == "amplification":
            return ComputedPhases(
                phases, result.mu[:, self.body] * denominator, denominator, result.error[:, self.body]
            )
        error = DISPLACEMENT_ERROR * result.displacement
        return ComputedPhases(phases, result.displacement, denominator, error)


@dataclass(eq=False)
class LocalSearch:
    """The best phase pair so far, and the square that is searched next."""

    phases: Array  # (2,), rad
    value: float
    error: float
    half_width: float  # rad
    differences: float = np.inf  # between values in the last square
    nodes: int = NODES  # of the next square along each axis
    count: int = 1  # searches that have become this one
    history: list[tuple[float, float]] = field(default_factory=list)  # half width and value after each round

    def take(self, points: ComputedPhases) -> None:
        """Go to the best of the points, if it is better."""
        top = int(points.value.argmax())
        if points.value[top] > self.value:
            self.phases, self.value, self.error = points.phases[top], float(points.value[top]), float(points.error[top])

    def may_reach(self, highest: float) -> bool:
        """Whether the search goes on: its square is not closed yet, and can hold the highest value."""
        promise = PROMISE_FACTOR * self.differences
        if len(self.history) > LATEST_ROUNDS:
            promise = min(promise, GAIN_FACTOR * (self.value - self.history[-1 - LATEST_ROUNDS][1]))
        return self.half_width > MIN_HALF_WIDTH and self.value + promise >= highest

    @property
    def search_error(self) -> float:
        """What was gained while the square became ten times smaller for the last time."""
        width, value = self.history[-1]
        return value - next((before for wide, before in reversed(self.history) if wide >= 10.0 * width), value)


@cache
def square_nodes(nodes: int) -> tuple[Array, Array]:
    """Places (nodes^2, 2) in [-1, 1], and what makes Chebyshev coefficients of values there."""
    node = np.cos(np.pi * np.arange(nodes) / (nodes - 1))
    places = np.stack(np.meshgrid(node, node, indexing="ij"), axis=-1).reshape(-1, 2)
    return places, np.linalg.inv(chebyshev.chebvander2d(places[:, 0], places[:, 1], [nodes - 1, nodes - 1]))


def search_round(surface: Surface, searches: Sequence[LocalSearch]) -> None:
    """One round of all searches at once: their squares, then the pairs predicted to be best."""
    places = [search.phases + search.half_width * square_nodes(search.nodes)[0] for search in searches]
    ends = np.cumsum([len(place) for place in places]).tolist()
    computed = surface.at(np.concatenate(places))
    squares = [computed.part(slice(end - len(place), end)) for place, end in zip(places, ends)]
    predictions = [predict_best(surface, search, square) for search, square in zip(searches, squares)]
    best = surface.at(np.array([phases for phases, _ in predictions]))
    for n, (search, square, (_, value)) in enumerate(zip(searches, squares, predictions)):
        center = search.phases
        search.take(square)
        search.take(best.part(slice(n, n + 1)))
        known = square.value[np.isfinite(square.value)]
        search.differences = float(np.ptp(known)) if len(known) else 0.0
        miss = abs(value - float(best.value[n]))
        good = miss <= GOOD_PREDICTION * search.differences
        search.nodes = NODES if good else MANY_NODES
        if np.abs(search.phases - center).max() < MOVING_FRACTION * search.half_width:
            search.half_width *= FAST_SHRINKING if good else SLOW_SHRINKING
        search.history.append((search.half_width, search.value))
        if max(miss, search.differences) <= search.error:
            search.half_width = 0.0


def predict_best(surface: Surface, search: LocalSearch, square: ComputedPhases) -> tuple[Array, float]:
    """Where the interpolated numerator over the exact denominator is largest in the square, and its value there."""
    known = np.isfinite(square.numerator)
    if not known.any():
        return search.phases, -np.inf
    numerator = np.where(known, square.numerator, square.numerator[known].min())
    nodes = math.isqrt(len(numerator))
    coefficients = (square_nodes(nodes)[1] @ numerator).reshape(nodes, nodes)

    def quotient(first: Array, second: Array) -> Array:
        phases = search.phases + search.half_width * np.stack([first, second], axis=-1)
        denominator = surface.denominator(phases.reshape(-1, 2)).reshape(first.shape)
        values: Array = chebyshev.chebval2d(first, second, coefficients) / denominator
        return values

    place, value = _maximize_on_square(quotient, [COARSE_PLACES, *[FINE_PLACES] * (REFINEMENTS - 1)])
    return search.phases + search.half_width * place, value


def _maximize_on_square(function: Callable[[Array, Array], Array], readings: list[Array]) -> tuple[Array, float]:
    """Where a function on the square [-1, 1]^2 is largest, (2,), and its value, by ever finer readings."""

    def largest_along_second(first: Array) -> tuple[Array, Array]:
        second, half = np.zeros((len(first), 1)), 1.0
        for offsets in readings:
            tried = np.clip(second + half * offsets, -1.0, 1.0)
            values = function(np.repeat(first[:, None], len(offsets), axis=1), tried)
            top = values.argmax(axis=1)[:, None]
            second, half = np.take_along_axis(tried, top, axis=1), half * (offsets[1] - offsets[0])
        return second[:, 0], np.take_along_axis(values, top, axis=1)[:, 0]

    middle, half = 0.0, 1.0
    for offsets in readings:
        first = np.clip(middle + half * offsets, -1.0, 1.0)
        second, values = largest_along_second(first)
        top = int(values.argmax())
        middle, half = float(first[top]), half * (offsets[1] - offsets[0])
    return np.array([middle, second[top]]), float(values[top])


def follow_jump(surface: Surface, search: LocalSearch) -> None:
    """From a place beside a jump to the highest one along it, by computed values alone."""
    center, half_width = search.phases, JUMP_HALF_WIDTH

    def value(first: Array, second: Array) -> Array:
        phases = center + half_width * np.stack([first, second], axis=-1)
        points = surface.at(phases.reshape(-1, 2))
        search.take(points)
        return points.value.reshape(first.shape)

    for _ in range(JUMP_ROUNDS):
        search.history.append((half_width, search.value))
        _maximize_on_square(value, [FINE_PLACES] * JUMP_REFINEMENTS)
        center, half_width = search.phases, 0.1 * half_width
    search.history.append((half_width, search.value))


def merge_searches(searches: list[LocalSearch], shifted: Array) -> list[LocalSearch]:
    """Searches without those whose best pair, shifted by a row of (K, 2), rad, lies in the square of a higher one."""
    kept: list[LocalSearch] = []
    for search in sorted(searches, key=lambda search: -search.value):
        for higher in kept:
            apart = search.phases + shifted - higher.phases
            apart = np.abs(np.remainder(apart + np.pi, 2.0 * np.pi) - np.pi).max(axis=1).min()
            width = max(search.half_width, higher.half_width, MIN_HALF_WIDTH)
            if apart <= width <= MAX_MERGED_WIDTH:
                higher.count += search.count
                break
        else:
            kept.append(search)
    return kept


def classify_maximum(surface: Surface, search: LocalSearch) -> tuple[str, tuple[float, float]]:
    """What the surface has at the maximum, and to which side of a jump it lies: from its fall at two distances."""
    angle = 2.0 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS
    directions = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    far, near = (
        search.value - surface.at(search.phases + distance * directions).value
        for distance in (FAR_DISTANCE, NEAR_DISTANCE)
    )
    clear = near > CLEAR_FALL * search.error
    jumps = clear & (near > JUMP_FALL * far)
    if jumps.any() and not jumps.all():
        x, y = directions[~jumps].sum(axis=0)
        return "jump", (float(x / np.hypot(x, y)), float(y / np.hypot(x, y)))
    nowhere = (float("nan"), float("nan"))
    return ("kink" if (clear & (near > KINK_FALL * far)).any() else "smooth"), nowhere
