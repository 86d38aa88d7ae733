"""
The worst initial phases: the largest value over all phase pairs, not over a grid of them.

A grid finds the hills of the surface. From each of the highest ones a climb goes on: in a square around the best pair,
the numerator of (5.1) is interpolated by a polynomial and divided by the exact denominator, and the pair at which this
quotient is largest is computed next. The square moves with the best pair, and shrinks where that pair lies inside. The
exact denominator lets a climb follow its kinks, on which maxima of mu may stand and which no polynomial of mu itself
can show. Beside a jump of the numerator the square closes slowly on the highest pair.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from reference.problem import Scene, ground_peak, phase_grid
from reference.problem.ranges import checked_choice
from reference.problem.symmetry import shifts, sources
from reference.surface import amplification

Array = NDArray[np.float64]

QUANTITIES = ("amplification", "displacement")
DISPLACEMENT_ERROR = 1e-3  # relative, of `Amplification.cap_share`
GRID = 48  # phases per axis on which the hills are found
GRID_TOLERANCE = 1e-4  # relative error of mu there
MAX_CLIMBS = 12  # from the hills that may rise highest
NODES = 5  # of the polynomial along each axis
# Places along each axis of the square at which the quotient is read: at first, and beside the largest of them
COARSE, FINE = np.linspace(-1.0, 1.0, 25), np.linspace(-1.0, 1.0, 9)
READINGS = 6  # of the quotient, each four times finer than the one before
MIN_HALF_WIDTH = 1e-7  # rad, of a square
MAX_ROUNDS = 60
MOVED = 0.8  # of the half width: a best pair farther from the center moves the square, which keeps its size
GOOD_PREDICTION = 0.1  # largest error of a prediction over the differences in the square
SHRINK, SHRINK_SLOWLY = 0.2, 0.6  # after a good prediction, and after another
JUMP_HALF_WIDTH = 0.5 * 2.0 * np.pi / GRID  # rad, of the first square in which a jump is followed
JUMP_ROUNDS, JUMP_READINGS = 2, 5
MAX_SHORTFALL = 0.02  # of the maximum: climbs that end lower need not follow their jumps
MAX_MERGED_WIDTH = 0.3 * 2.0 * np.pi / GRID  # rad: climbs into a common square that is smaller have found one maximum
DIRECTIONS = 32  # in which the surface beside a maximum is looked at
FAR, NEAR = 1e-3, 1e-4  # rad: distances at which it is
# The fall at the near distance over that at the far one: 0.01 of a parabola, 0.1 of an edge, 1 of a jump
KINK_FALL, JUMP_FALL = 0.03, 0.3
CLEAR_FALL = 10.0  # errors of the value: a smaller fall shows nothing


@dataclass(frozen=True)
class WorstPhases:
    """
    The largest value over all phase pairs.

    Attributes
    ----------
    value : float
        mu_i, or the displacement in m. It is attained at `phases`.
    error : float
        Estimated absolute error: of the solution there, and of the climb.
    phases : tuple of float, rad
        (alpha_1, alpha_2) in [0, 2 pi). Symmetries of the scene may give other pairs with the same value.
    kind : {"smooth", "kink", "jump"}
        What the surface has there: a level tangent, an edge, or a jump beside which the value is approached.
    side : tuple of float
        Of a jump: the direction in the plane of phases from it towards the pairs with large values. Otherwise NaN.
    runner_up : float
        The highest other maximum. NaN without one.
    climbs, reached : int
        Hills from which a climb started, and climbs that ended at the maximum.
    evaluations : int
        Phase pairs that were computed.
    """

    value: float
    error: float
    phases: tuple[float, float]
    kind: str
    side: tuple[float, float]
    runner_up: float
    climbs: int
    reached: int
    evaluations: int


def worst_phases(
    scene: Scene,
    body: int = 1,
    quantity: str = "amplification",
    equations: str = "exact",
    regularization: float | None = None,
    tolerance: float = 1e-6,
    cutoff: float | None = None,
) -> WorstPhases:
    """
    Largest amplification factor of a body, or displacement of the isolator, over all initial phases.

    Parameters
    ----------
    scene : Scene
        With a two-frequency loading.
    body : int
        From 1, the platform. It has no effect on the displacement.
    quantity : {"amplification", "displacement"}
        mu_i of (5.1), or the largest horizontal displacement of the platform, m.
    equations, regularization, tolerance, cutoff
        As in `amplification`.

    Returns
    -------
    WorstPhases

    Raises
    ------
    ValueError
        For an argument outside its range, for a recorded motion, and where no phase pair has an answer. In one line.

    Notes
    -----
    The maximum is global as far as the grid shows its hill. `climbs`, `reached` and `runner_up` say what supports it.
    The denominator of (5.1) has kinks, and there mu has edges: the largest mu_2 of fig3-I stands on one.

    Examples
    --------
    >>> import reference
    >>> worst = reference.worst_phases(reference.load_scene("fig3-I"), body=2, equations="small", tolerance=1e-4)
    >>> round(worst.value, 3), worst.kind
    (3.221, 'kink')
    """
    checked_choice("quantity", quantity, QUANTITIES)
    if body not in range(1, len(scene.bodies) + 1):
        raise ValueError(f"body = {body!r}: must be an integer from 1 to {len(scene.bodies)}, the number of bodies")
    if scene.recorded:
        raise ValueError(f"scene {scene.name}: a recorded motion has no phases; use amplification")
    law = {"equations": equations, "regularization": regularization, "cutoff": cutoff}
    search = _Search(scene, body - 1, quantity, tolerance, law)
    climbs = _hills(search)
    for _ in range(MAX_ROUNDS):
        active = [climb for climb in climbs if climb.half_width > MIN_HALF_WIDTH]
        if not active:
            break
        _climb_on(search, active)
        climbs = _merged(climbs, shifts(scene))
    least = (1.0 - MAX_SHORTFALL) * max(climb.value for climb in climbs)
    for climb in climbs:
        if climb.value >= least and _kind(search, climb)[0] == "jump":
            _follow_jump(search, climb)
    best, *others = sorted(_merged(climbs, shifts(scene)), key=lambda climb: -climb.value)
    kind, side = _kind(search, best)
    alpha1, alpha2 = (best.phases % (2.0 * np.pi)).tolist()
    return WorstPhases(
        value=best.value,
        error=best.error + best.search_error,
        phases=(alpha1, alpha2),
        kind=kind,
        side=side,
        runner_up=others[0].value if others else float("nan"),
        climbs=sum(climb.count for climb in climbs),
        reached=best.count,
        evaluations=search.evaluations,
    )


@dataclass(frozen=True)
class _Points:
    """Computed phase pairs; NaN without an answer."""

    phases: Array  # (M, 2), rad
    numerator: Array  # (M,)
    denominator: Array  # (M,)
    error: Array  # (M,), of the quotient

    @property
    def value(self) -> Array:
        """The quotient, -inf without an answer."""
        return np.where(np.isfinite(self.numerator), self.numerator / self.denominator, -np.inf)

    def part(self, places: slice) -> _Points:
        return _Points(self.phases[places], self.numerator[places], self.denominator[places], self.error[places])


@dataclass
class _Search:
    """What is searched, and how many phase pairs it has taken."""

    scene: Scene
    body: int  # from 0
    quantity: str
    tolerance: float
    law: dict[str, Any]
    evaluations: int = 0

    def denominator(self, phases: Array) -> Array:
        """That of (5.1); 1 for a displacement."""
        return ground_peak(self.scene, phases) if self.quantity == "amplification" else np.ones(len(phases))

    def at(self, phases: Array, tolerance: float | None = None) -> _Points:
        result = amplification(self.scene, phases, tolerance=tolerance or self.tolerance, **self.law)
        self.evaluations += len(phases)
        denominator = self.denominator(phases)
        if self.quantity == "amplification":
            return _Points(phases, result.mu[:, self.body] * denominator, denominator, result.error[:, self.body])
        displacement = result.cap_share * self.scene.radius
        return _Points(phases, displacement, denominator, DISPLACEMENT_ERROR * displacement)


@dataclass(eq=False)
class _Climb:
    """The best phase pair so far, and the square that is searched next."""

    phases: Array  # (2,), rad
    value: float
    error: float
    half_width: float  # rad
    count: int = 1  # climbs that have become this one
    history: list[tuple[float, float]] = field(default_factory=list)  # half width and value after each round

    def take(self, points: _Points) -> None:
        """Go to the best of the points, if it is better."""
        top = int(points.value.argmax())
        if points.value[top] > self.value:
            self.phases, self.value, self.error = points.phases[top], float(points.value[top]), float(points.error[top])

    @property
    def search_error(self) -> float:
        """What was gained while the square became ten times smaller for the last time."""
        width, value = self.history[-1]
        return value - next((before for wide, before in reversed(self.history) if wide >= 10.0 * width), value)


def _hills(search: _Search) -> list[_Climb]:
    """Climbs from the points of a grid that are as high as their eight neighbors."""
    place = sources(search.scene, GRID)
    computed, back = np.unique(place, return_inverse=True)
    points = search.at(phase_grid(GRID)[computed], max(search.tolerance, GRID_TOLERANCE))
    surface = points.value[back].reshape(GRID, GRID)
    if not np.isfinite(surface).any():
        raise ValueError(f"scene {search.scene.name}: no phase pair has an answer; amplification says why")
    around = [np.roll(surface, (i, j), (0, 1)) for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)]
    hills = np.isfinite(surface) & (surface >= np.max(around, axis=0))
    lowest = np.min([np.where(np.isfinite(each), each, surface) for each in around], axis=0)
    may_reach = np.where(hills, surface, 0.0) + 0.5 * np.where(hills, surface - np.where(hills, lowest, 0.0), 0.0)
    starts = np.flatnonzero(hills.ravel()[computed])
    order = np.argsort(-may_reach.ravel()[computed][starts], kind="stable")
    starts = starts[order][:MAX_CLIMBS]
    spacing = 2.0 * np.pi / GRID
    return [_Climb(points.phases[n], float(points.value[n]), float(points.error[n]), spacing) for n in starts]


NODE = np.cos(np.pi * np.arange(NODES) / (NODES - 1))
SQUARE = np.stack(np.meshgrid(NODE, NODE, indexing="ij"), axis=-1).reshape(-1, 2)  # (NODES^2, 2) in [-1, 1]
TO_COEFFICIENTS = np.linalg.inv(chebyshev.chebvander2d(SQUARE[:, 0], SQUARE[:, 1], [NODES - 1, NODES - 1]))


def _climb_on(search: _Search, climbs: list[_Climb]) -> None:
    """One round of all climbs at once: their squares, then the pairs predicted to be best."""
    size = len(SQUARE)
    computed = search.at(np.concatenate([climb.phases + climb.half_width * SQUARE for climb in climbs]))
    squares = [computed.part(slice(n * size, (n + 1) * size)) for n in range(len(climbs))]
    predictions = [_predicted(search, climb, square) for climb, square in zip(climbs, squares)]
    best = search.at(np.array([phases for phases, _ in predictions]))
    for n, (climb, square, (_, predicted)) in enumerate(zip(climbs, squares, predictions)):
        center = climb.phases
        climb.take(square)
        climb.take(best.part(slice(n, n + 1)))
        differences = float(np.ptp(square.value[np.isfinite(square.value)]))
        miss = abs(predicted - float(best.value[n]))
        if np.abs(climb.phases - center).max() < MOVED * climb.half_width:
            climb.half_width *= SHRINK if miss <= GOOD_PREDICTION * differences else SHRINK_SLOWLY
        climb.history.append((climb.half_width, climb.value))
        if max(miss, differences) <= climb.error:
            climb.half_width = 0.0


def _predicted(search: _Search, climb: _Climb, square: _Points) -> tuple[Array, float]:
    """Where the interpolated numerator over the exact denominator is largest in the square, and its value there."""
    known = np.isfinite(square.numerator)
    numerator = np.where(known, square.numerator, square.numerator[known].min())
    coefficients = (TO_COEFFICIENTS @ numerator).reshape(NODES, NODES)

    def quotient(first: Array, second: Array) -> Array:
        phases = climb.phases + climb.half_width * np.stack([first, second], axis=-1)
        denominator = search.denominator(phases.reshape(-1, 2)).reshape(first.shape)
        values: Array = chebyshev.chebval2d(first, second, coefficients) / denominator
        return values

    place, value = _largest(quotient, [COARSE, *[FINE] * (READINGS - 1)])
    return climb.phases + climb.half_width * place, value


def _largest(function: Callable[[Array, Array], Array], readings: list[Array]) -> tuple[Array, float]:
    """
    Where a function on the square [-1, 1]^2 is largest, (2,), and its value there.

    From the largest value along the second axis at every place along the first one: an edge or a jump aslant does not
    hold this up. Each of the readings looks, along one axis, at offsets within the interval that the last one left.
    """

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


def _follow_jump(search: _Search, climb: _Climb) -> None:
    """From a place beside a jump to the highest one along it, by computed values alone."""
    center, half_width = climb.phases, JUMP_HALF_WIDTH

    def value(first: Array, second: Array) -> Array:
        phases = center + half_width * np.stack([first, second], axis=-1)
        points = search.at(phases.reshape(-1, 2))
        climb.take(points)
        return points.value.reshape(first.shape)

    for _ in range(JUMP_ROUNDS):
        climb.history.append((half_width, climb.value))
        _largest(value, [FINE] * JUMP_READINGS)
        center, half_width = climb.phases, 0.1 * half_width
    climb.history.append((half_width, climb.value))


def _merged(climbs: list[_Climb], shifted: Array) -> list[_Climb]:
    """Climbs without those whose best pair, shifted by a row of (K, 2), rad, lies in the square of a higher one."""
    kept: list[_Climb] = []
    for climb in sorted(climbs, key=lambda climb: -climb.value):
        for higher in kept:
            apart = climb.phases + shifted - higher.phases
            apart = np.abs(np.remainder(apart + np.pi, 2.0 * np.pi) - np.pi).max(axis=1).min()
            width = max(climb.half_width, higher.half_width, MIN_HALF_WIDTH)
            if apart <= width <= MAX_MERGED_WIDTH:
                higher.count += climb.count
                break
        else:
            kept.append(climb)
    return kept


def _kind(search: _Search, climb: _Climb) -> tuple[str, tuple[float, float]]:
    """What the surface has at the maximum, and to which side of a jump it lies: from its fall at two distances."""
    angle = 2.0 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS
    directions = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    far, near = (climb.value - search.at(climb.phases + distance * directions).value for distance in (FAR, NEAR))
    clear = near > CLEAR_FALL * climb.error
    jumps = clear & (near > JUMP_FALL * far)
    if jumps.any() and not jumps.all():
        x, y = directions[~jumps].sum(axis=0)
        return "jump", (float(x / np.hypot(x, y)), float(y / np.hypot(x, y)))
    nowhere = (float("nan"), float("nan"))
    return ("kink" if (clear & (near > KINK_FALL * far)).any() else "smooth"), nowhere
