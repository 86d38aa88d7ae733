"""
Smoothness of a surface: how its second difference falls with the step where its curvature is sharpest.

In every direction the second difference f(p - h) - 2 f(p) + f(p + h) of a surface with a curvature falls like h^2, of
one with a fold like h, and of one with a jump not at all. The zoom starts at the places of the grid that bend most and
halves the step again and again, every time around the point of the three that bends most.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from comparison.result_types import Array

DIFFERENCE_DIRECTIONS = np.array([(1, 0), (0, 1), (1, 1), (1, -1)])  # directions of second differences, grid steps
SEARCHED_PLACES = 2  # number of grid points on each surface around which ever smaller phase steps are tried
STEP_HALVINGS = 5  # number of times the phase step is halved around a searched point: down to 1/32 of the grid step
# Number of last phase-step halvings in the fit of the second difference's exponent; longer steps show a peak's shape
FITTED_HALVINGS = 3
# Second difference ~ (phase step)^exponent: smooth surface above 1.5, a fold from 0.5 to 1.5, a jump below 0.5
MAX_FOLD_EXPONENT, MAX_JUMP_EXPONENT = 1.5, 0.5


@dataclass(frozen=True)
class SharpestCurvature:
    """
    Place where a surface is least smooth: its second difference there falls with the lowest power of the phase step.

    exponent: that power, NaN where a value is missing. phases: (alpha1, alpha2) of the place, rad.
    """

    exponent: float
    phases: tuple[float, float]

    @property
    def smooth(self) -> bool:
        """Return whether the surface is smooth at this place: no fold and no jump."""
        return self.exponent > MAX_FOLD_EXPONENT

    @property
    def kind(self) -> str:
        """Return what the surface has at this place: "smooth", "fold", "jump", or "no answer" if values are missing."""
        if not np.isfinite(self.exponent):
            return "no answer"
        return "smooth" if self.smooth else "fold" if self.exponent > MAX_JUMP_EXPONENT else "jump"


def find_sharpest_curvatures(mu: Array, solve: Callable[[Array], Array]) -> tuple[SharpestCurvature, ...]:
    """
    Return, for each body, where its amplification is least smooth.

    mu: amplification on a grid, (n phases alpha1, n phases alpha2, N bodies). solve: returns the amplification, (M, N),
    at M phase pairs, (M, 2), rad.
    """
    # Every start is a body, a grid point and a direction (`way`). `values` has the amplification at the center and one
    # step to either side. Each round halves the step, computes the two new points between the three, and moves to that
    # of the three inner points where the second difference is largest.
    n, _, bodies = mu.shape
    step = 2.0 * np.pi / n
    starts = [(body, *start) for body in range(bodies) for start in _sharpest_places(mu[..., body])]
    body, places, ways = (np.array(part) for part in zip(*starts))
    center, way = step * places, step * ways
    values = np.array([[mu[*((at + side * go) % n), i] for side in (-1, 0, 1)] for i, at, go in starts])
    every = np.arange(len(starts))
    sizes = [np.abs(_second_differences(values))]
    for _ in range(STEP_HALVINGS):
        way = way / 2.0
        new = solve(np.concatenate([center - way, center + way])).reshape(2, len(starts), bodies)[:, every, body]
        row = np.stack([values[:, 0], new[0], values[:, 1], new[1], values[:, 2]], axis=1)
        best = np.argmax([np.abs(_second_differences(row[:, i : i + 3])) for i in range(3)], axis=0)
        values = np.stack([row[every, best + i] for i in range(3)], axis=1)
        center = center + (best - 1)[:, None] * way
        sizes.append(np.abs(_second_differences(values)))
    tiny = np.finfo(float).tiny
    exponents = np.log2(np.maximum(sizes[-1 - FITTED_HALVINGS], tiny) / np.maximum(sizes[-1], tiny)) / FITTED_HALVINGS
    of_bodies = (np.flatnonzero(body == number) for number in range(bodies))
    sharpest = [of_body[np.argmin(exponents[of_body])] for of_body in of_bodies]  # numpy's argmin picks a NaN, if any
    phases = np.mod(center, 2.0 * np.pi)
    return tuple(
        SharpestCurvature(float(exponents[at]), (float(phases[at, 0]), float(phases[at, 1]))) for at in sharpest
    )


def _second_differences(values: Array) -> Array:
    """Return the second differences (K,) of three equally spaced values (K, 3)."""
    difference: Array = values[:, 0] - 2.0 * values[:, 1] + values[:, 2]
    return difference


def _sharpest_places(mu: Array) -> list[tuple[NDArray[np.int_], NDArray[np.int_]]]:
    """Return the grid indices of the largest second differences, no two adjacent, with the direction of each."""
    # Divided by the squared length of the step, so that a diagonal direction compares with the others
    size = np.array(
        [
            np.abs(np.roll(mu, -way, (0, 1)) - 2.0 * mu + np.roll(mu, way, (0, 1))) / (way @ way)
            for way in DIFFERENCE_DIRECTIONS
        ]
    )
    best, direction = size.max(axis=0), size.argmax(axis=0)
    n = len(mu)
    places: list[tuple[NDArray[np.int_], NDArray[np.int_]]] = []
    for at in np.argsort(-best.ravel(), kind="stable"):
        place = np.array(divmod(int(at), n))
        apart = [np.abs((place - other + n // 2) % n - n // 2).max() for other, _ in places]
        if all(distance > 1 for distance in apart):
            places.append((place, DIFFERENCE_DIRECTIONS[direction[*place]]))
        if len(places) == SEARCHED_PLACES:
            break
    return places
