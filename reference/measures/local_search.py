"""
Local search for the maximum of a surface over the phases whose denominator is known exactly.

In a square around the best pair of phases, the numerator is interpolated by a polynomial and divided by the exact
denominator, and the pair at which this quotient is largest is computed next. The square moves with the best pair, and
shrinks where that pair lies inside. The exact denominator has kinks, on which maxima of the amplification may lie and
which no polynomial of it can show. Next to a jump of the numerator the square closes on a high pair, and `follow_jump`
goes along the jump to the highest one.
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

DISPLACEMENT_ERROR = 1e-3  # relative error taken for `Amplification.displacement`: the largest that it may have
# Coordinates along each axis of a search's square, at which a function is evaluated on the first and on finer grids
COARSE_COORDINATES, FINE_COORDINATES = np.linspace(-1.0, 1.0, 13), np.linspace(-1.0, 1.0, 9)
QUOTIENT_GRIDS = 5  # number of grids that locate the maximum of the interpolant, each finer than the grid before
MIN_HALF_WIDTH = 1e-7  # rad: a search ends when its square region has a smaller half width
# If the best phase pair of a search's square is off its center by this fraction of the half width or more, the square
# keeps its size and moves
MOVING_FRACTION = 0.8
# Nodes of the interpolating polynomial along each axis of a search's square: at first, and after a poor prediction
INTERPOLATION_NODES, INTERPOLATION_NODES_AFTER_MISS = 3, 5
# Largest error of a predicted maximum, over the range of values in its square, after which the square may shrink fast
MAX_GOOD_PREDICTION_ERROR = 0.1
FAST_SHRINKING, SLOW_SHRINKING = 0.2, 0.6  # factors on a search region's half width after a good and a poor prediction
# A search ends if its best value lies below that of the highest search by more than PROMISE_FACTOR times the range of
# values in its square, or by more than GAIN_FACTOR times what it gained in its last LATEST_ROUNDS rounds. The gain
# counts, too, because next to a jump even a small square has a large range.
PROMISE_FACTOR, LATEST_ROUNDS, GAIN_FACTOR = 2.0, 6, 10.0
MAX_MERGED_WIDTH = 0.04  # rad: two searches within one square of at most this half width have found the same maximum
JUMP_SEARCH_HALF_WIDTH = 0.07  # rad, half width of the first square of phases in which a jump of a surface is followed
JUMP_ROUNDS, JUMP_REFINEMENTS = 2, 5  # number of squares in which a jump is followed, and of ever finer grids in each
FALL_DIRECTIONS = 32  # number of directions in which the fall of the surface from a maximum is computed
FAR_DISTANCE, NEAR_DISTANCE = 1e-3, 1e-4  # rad, distances from the maximum at which the fall is computed
# Ratios of the falls at NEAR_DISTANCE and FAR_DISTANCE above which a maximum is a kink and a jump. The ratio is 0.01
# for a parabola, 0.1 for an edge and 1 for a jump.
KINK_FALL, JUMP_FALL = 0.03, 0.3
CLEAR_FALL = 10.0  # a fall shows the kind of a maximum if it is larger than this times the value's error


@dataclass(frozen=True)
class ComputedPhases:
    """Amplification or displacement at M phase pairs, as numerator over denominator; NaN where a run gave no result."""

    phases: Array  # (M, 2), rad
    numerator: Array  # (M,), largest acceleration of the body, m/s^2, or displacement, m
    denominator: Array  # (M,), largest acceleration of the ground, m/s^2; 1 for a displacement
    error: Array  # (M,), error of the value, numerator / denominator

    @cached_property
    def value(self) -> Array:
        """Quotient of numerator and denominator; -inf for a phase pair whose run gave no result."""
        return np.where(np.isfinite(self.numerator), self.numerator / self.denominator, -np.inf)

    def select(self, places: slice) -> ComputedPhases:
        """Return the values at a slice of the M phase pairs."""
        return ComputedPhases(
            phases=self.phases[places],
            numerator=self.numerator[places],
            denominator=self.denominator[places],
            error=self.error[places],
        )


@dataclass
class Surface:
    """A surface to search: amplification mu of one body, or the displacement of the platform, m, over the phases."""

    scene: Scene
    amplification: Callable[..., Amplification]
    settings: Mapping[str, Any]  # arguments of `amplification` other than scene and phases
    body: int  # index of the body, from 0
    quantity: str = "amplification"  # "amplification" or "displacement"
    evaluations: int = 0  # number of phase pairs computed so far
    outcome: str = ""  # last outcome that was not ok

    def denominator(self, phases: Array) -> Array:
        """Return the ground's peak acceleration, (M,), m/s^2, at phase pairs (M, 2), rad; 1 for a displacement."""
        return ground_peak(self.scene, phases) if self.quantity == "amplification" else np.ones(len(phases))

    def compute(self, phases: Array, **changes: Any) -> ComputedPhases:
        """Compute the values of the surface at phase pairs (M, 2), rad; changes: settings that differ from its own."""
        result = self.amplification(self.scene, phases, **{**self.settings, **changes})
        self.evaluations += len(phases)
        self.outcome = next((str(status) for status in result.status[::-1] if status != Outcome.OK.value), self.outcome)
        denominator = self.denominator(phases)
        if self.quantity == "amplification":
            numerator, error = result.mu[:, self.body] * denominator, result.error[:, self.body]
        else:
            numerator, error = result.displacement, DISPLACEMENT_ERROR * result.displacement
        return ComputedPhases(phases=phases, numerator=numerator, denominator=denominator, error=error)


@dataclass(eq=False)
class LocalSearch:
    """State of one search for a local maximum: the best phase pair so far, and the square of phases to try next."""

    phases: Array  # (2,), rad, best phase pair so far
    value: float
    error: float
    half_width: float  # rad, half width of the next square
    value_range: float = np.inf  # largest minus smallest value in the last square
    nodes: int = INTERPOLATION_NODES  # nodes along each axis of the next square
    count: int = 1  # number of searches that were merged into this one
    history: list[tuple[float, float]] = field(default_factory=list)  # half width and value after each round

    def move_to_best(self, points: ComputedPhases) -> None:
        """Move the search to the phase pair with the highest value among `points` if it exceeds the best so far."""
        top = int(points.value.argmax())
        if points.value[top] > self.value:
            self.phases, self.value, self.error = points.phases[top], float(points.value[top]), float(points.error[top])

    def may_reach(self, highest: float) -> bool:
        """Return True if the search shall go on: its region is not too small and may contain the value `highest`."""
        promise = PROMISE_FACTOR * self.value_range
        if len(self.history) > LATEST_ROUNDS:
            promise = min(promise, GAIN_FACTOR * (self.value - self.history[-1 - LATEST_ROUNDS][1]))
        return self.half_width > MIN_HALF_WIDTH and self.value + promise >= highest

    @property
    def recent_gain(self) -> float:
        """Increase of the search's best value while its square region shrank by the last factor of ten."""
        width, value = self.history[-1]
        return value - next((before for wide, before in reversed(self.history) if wide >= 10.0 * width), value)


@cache
def make_square_nodes(nodes: int) -> tuple[Array, Array]:
    """
    Return the nodes of a polynomial on the square [-1, 1]^2, (nodes^2, 2), and a matrix (nodes^2, nodes^2).

    The matrix times the values at the nodes gives the coefficients of the Chebyshev polynomials of both coordinates.
    """
    node = np.cos(np.pi * np.arange(nodes) / (nodes - 1))
    places = np.stack(np.meshgrid(node, node, indexing="ij"), axis=-1).reshape(-1, 2)
    return places, np.linalg.inv(chebyshev.chebvander2d(places[:, 0], places[:, 1], [nodes - 1, nodes - 1]))


def advance_searches(surface: Surface, searches: Sequence[LocalSearch]) -> None:
    """Advance searches by one round, which computes values in the square of each and at the maximum predicted there."""
    # All searches share two calls of the solver, which computes their pairs in parallel. A prediction is good if the
    # value computed at the predicted pair agrees with the polynomial: then the square shrinks fast, otherwise slowly
    # and with more nodes. A search ends where neither the values of its square nor the prediction differ by more than
    # the error.
    places = [search.phases + search.half_width * make_square_nodes(search.nodes)[0] for search in searches]
    ends = np.cumsum([len(place) for place in places]).tolist()
    computed = surface.compute(np.concatenate(places))
    squares = [computed.select(slice(end - len(place), end)) for place, end in zip(places, ends)]
    predictions = [predict_best(surface, search, square) for search, square in zip(searches, squares)]
    best = surface.compute(np.array([phases for phases, _ in predictions]))
    for n, (search, square, (_, value)) in enumerate(zip(searches, squares, predictions)):
        center = search.phases
        search.move_to_best(square)
        search.move_to_best(best.select(slice(n, n + 1)))
        known = square.value[np.isfinite(square.value)]
        search.value_range = float(np.ptp(known)) if len(known) else 0.0
        miss = abs(value - float(best.value[n]))
        good = miss <= MAX_GOOD_PREDICTION_ERROR * search.value_range
        search.nodes = INTERPOLATION_NODES if good else INTERPOLATION_NODES_AFTER_MISS
        if np.abs(search.phases - center).max() < MOVING_FRACTION * search.half_width:
            search.half_width *= FAST_SHRINKING if good else SLOW_SHRINKING
        search.history.append((search.half_width, search.value))
        if max(miss, search.value_range) <= search.error:
            search.half_width = 0.0


def predict_best(surface: Surface, search: LocalSearch, square: ComputedPhases) -> tuple[Array, float]:
    """Return the phase pair in a search's square region with the largest interpolated value, and this value."""
    known = np.isfinite(square.numerator)
    if not known.any():
        return search.phases, -np.inf
    numerator = np.where(known, square.numerator, square.numerator[known].min())
    nodes = math.isqrt(len(numerator))
    coefficients = (make_square_nodes(nodes)[1] @ numerator).reshape(nodes, nodes)

    def predicted_value(first: Array, second: Array) -> Array:
        """Return the interpolated numerator over the exact denominator at coordinates in [-1, 1] of the square."""
        phases = search.phases + search.half_width * np.stack([first, second], axis=-1)
        denominator = surface.denominator(phases.reshape(-1, 2)).reshape(first.shape)
        values: Array = chebyshev.chebval2d(first, second, coefficients) / denominator
        return values

    grids = [COARSE_COORDINATES, *[FINE_COORDINATES] * (QUOTIENT_GRIDS - 1)]
    place, value = _maximize_on_square(predicted_value, grids)
    return search.phases + search.half_width * place, value


def _maximize_on_square(function: Callable[[Array, Array], Array], offset_grids: list[Array]) -> tuple[Array, float]:
    """
    Return the point (2,) of the square [-1, 1]^2 with the largest value of a function, and this value.

    offset_grids: coordinates in [-1, 1] to try around the best point, on one grid after another, each scaled to the
    spacing of the grid before. For every first coordinate the best second one is found, and then the best first one.
    """

    def largest_along_second(first: Array) -> tuple[Array, Array]:
        """Return the second coordinate with the largest value for each first coordinate, and these values."""
        second, half = np.zeros((len(first), 1)), 1.0
        for offsets in offset_grids:
            tried = np.clip(second + half * offsets, -1.0, 1.0)
            values = function(np.repeat(first[:, None], len(offsets), axis=1), tried)
            top = values.argmax(axis=1)[:, None]
            second, half = np.take_along_axis(tried, top, axis=1), half * (offsets[1] - offsets[0])
        return second[:, 0], np.take_along_axis(values, top, axis=1)[:, 0]

    middle, half = 0.0, 1.0
    for offsets in offset_grids:
        first = np.clip(middle + half * offsets, -1.0, 1.0)
        second, values = largest_along_second(first)
        top = int(values.argmax())
        middle, half = float(first[top]), half * (offsets[1] - offsets[0])
    return np.array([middle, second[top]]), float(values[top])


def follow_jump(surface: Surface, search: LocalSearch) -> None:
    """Move a search that ended next to a jump of the surface to the largest value along the jump."""
    # The polynomial of a square fails across a jump. So the maximum over the second phase is taken for each first one,
    # on ever finer grids of computed values, and then the maximum over the first phase: a ridge of any direction
    # is followed. The square is centered anew and made ten times smaller once.
    center, half_width = search.phases, JUMP_SEARCH_HALF_WIDTH

    def value(first: Array, second: Array) -> Array:
        """Return the computed values at coordinates in [-1, 1] of a square of phases; move the search to the best."""
        phases = center + half_width * np.stack([first, second], axis=-1)
        points = surface.compute(phases.reshape(-1, 2))
        search.move_to_best(points)
        return points.value.reshape(first.shape)

    for _ in range(JUMP_ROUNDS):
        search.history.append((half_width, search.value))
        _maximize_on_square(value, [FINE_COORDINATES] * JUMP_REFINEMENTS)
        center, half_width = search.phases, 0.1 * half_width
    search.history.append((half_width, search.value))


def merge_searches(searches: list[LocalSearch], shifts: Array) -> list[LocalSearch]:
    """
    Return the searches without those that are at the same maximum as a higher one.

    shifts: (K, 2), rad, shifts of both phases that leave the surface the same; two maxima apart by one are the same.
    """
    kept: list[LocalSearch] = []
    for search in sorted(searches, key=lambda search: -search.value):
        for higher in kept:
            apart = search.phases + shifts - higher.phases
            apart = np.abs(np.remainder(apart + np.pi, 2.0 * np.pi) - np.pi).max(axis=1).min()
            width = max(search.half_width, higher.half_width, MIN_HALF_WIDTH)
            if apart <= width <= MAX_MERGED_WIDTH:
                higher.count += search.count
                break
        else:
            kept.append(search)
    return kept


def classify_maximum(surface: Surface, search: LocalSearch) -> tuple[str, tuple[float, float]]:
    """
    Return "jump", "kink" or "smooth" for the shape of the surface at a maximum.

    For a jump also the direction (unit vector in the plane of the phases) to its high side, otherwise (NaN, NaN).
    """
    # The surface falls from its maximum like the square of the distance where it is smooth, like the distance at an
    # edge, and at once beyond a jump. The ratio of the falls at a near and a far distance distinguishes them, in any of
    # FALL_DIRECTIONS. A fall within a few errors of the value shows nothing. The high side of a jump is the mean of the
    # directions without a jump.
    angle = 2.0 * np.pi * np.arange(FALL_DIRECTIONS) / FALL_DIRECTIONS
    directions = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    far, near = (
        search.value - surface.compute(search.phases + distance * directions).value
        for distance in (FAR_DISTANCE, NEAR_DISTANCE)
    )
    clear = near > CLEAR_FALL * search.error
    jumps = clear & (near > JUMP_FALL * far)
    if jumps.any() and not jumps.all():
        x, y = directions[~jumps].sum(axis=0)
        return "jump", (float(x / np.hypot(x, y)), float(y / np.hypot(x, y)))
    nowhere = (float("nan"), float("nan"))
    return ("kink" if (clear & (near > KINK_FALL * far)).any() else "smooth"), nowhere
