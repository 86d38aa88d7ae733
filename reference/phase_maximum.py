"""
The worst initial phases: the largest value over all phase pairs, not over a grid of them.

A grid finds the hills of the surface, and from each of the highest ones a climb goes on (`reference.problem.climb`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reference.problem import Scene, checked_phases, ground_peak, phase_grid
from reference.problem.climb import Climb, Points, climb_on, follow_jump, kind_of, merged
from reference.problem.ranges import checked_choice
from reference.problem.symmetry import shifts, sources
from reference.surface import amplification

Array = NDArray[np.float64]

QUANTITIES = ("amplification", "displacement")
DISPLACEMENT_ERROR = 1e-3  # relative, of `Amplification.cap_share`
GRID = 48  # phases per axis on which the hills are found
GRID_TOLERANCE = 1e-4  # relative error of mu there
MAX_CLIMBS = 12  # from the hills that may rise highest
MAX_ROUNDS = 60
NODES = 5  # of a square's polynomial along each axis
MAX_SHORTFALL = 0.01  # of the maximum: climbs that end lower need not follow their jumps


@dataclass(frozen=True)
class PhaseMaximum:
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
        The highest other value at which a climb ended. NaN without one.
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
    starts: ArrayLike | None = None,
) -> PhaseMaximum:
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
    starts : array_like, (K, 2), rad, optional
        Where climbs begin. Without it at the hills of a grid of 48 x 48 phases (`hills` finds those of a surface).

    Returns
    -------
    PhaseMaximum

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
    (3.06, 'kink')
    """
    checked_choice("quantity", quantity, QUANTITIES)
    if body not in range(1, len(scene.bodies) + 1):
        raise ValueError(f"body = {body!r}: must be an integer from 1 to {len(scene.bodies)}, the number of bodies")
    if scene.recorded:
        raise ValueError(f"scene {scene.name}: a recorded motion has no phases; use amplification")
    law = {"equations": equations, "regularization": regularization, "cutoff": cutoff}
    search = _Search(scene, body - 1, quantity, tolerance, law)
    points = search.at(_on_grid(search) if starts is None else checked_phases(starts))
    climbs = [
        Climb(points.phases[n], float(points.value[n]), float(points.error[n]), 2.0 * np.pi / GRID)
        for n in np.flatnonzero(np.isfinite(points.value))
    ]
    if not climbs:
        raise ValueError(f"scene {scene.name}: no phase pair has an answer; amplification says why")
    for _ in range(MAX_ROUNDS):
        highest = max(climb.value for climb in climbs)
        active = [climb for climb in climbs if climb.may_reach(highest)]
        if not active:
            break
        climb_on(search, active, NODES)
        climbs = merged(climbs, shifts(scene))
    least = (1.0 - MAX_SHORTFALL) * max(climb.value for climb in climbs)
    for climb in climbs:
        if climb.value >= least and kind_of(search, climb)[0] == "jump":
            follow_jump(search, climb)
    best, *others = sorted(merged(climbs, shifts(scene)), key=lambda climb: -climb.value)
    kind, side = kind_of(search, best)
    alpha1, alpha2 = (best.phases % (2.0 * np.pi)).tolist()
    return PhaseMaximum(
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

    def at(self, phases: Array, tolerance: float | None = None) -> Points:
        result = amplification(self.scene, phases, tolerance=tolerance or self.tolerance, **self.law)
        self.evaluations += len(phases)
        denominator = self.denominator(phases)
        if self.quantity == "amplification":
            return Points(phases, result.mu[:, self.body] * denominator, denominator, result.error[:, self.body])
        displacement = result.cap_share * self.scene.radius
        return Points(phases, displacement, denominator, DISPLACEMENT_ERROR * displacement)


def hills(surface: Array, scene: Scene) -> Array:
    """
    Phase pairs of a surface that are as high as their eight neighbors, those first that may rise highest between them.

    Parameters
    ----------
    surface : ndarray, (n, n)
        On `phase_grid(n)`; NaN without an answer.
    scene : Scene
        Of pairs that a symmetry of the motion makes alike only one is listed.

    Returns
    -------
    ndarray, (K, 2), rad
        At most MAX_CLIMBS of them.

    Examples
    --------
    >>> import numpy as np
    >>> from reference.problem import load_scene
    >>> alpha = 2.0 * np.pi * np.arange(8) / 8
    >>> hills(np.cos(2.0 * alpha)[:, None] + np.cos(2.0 * alpha)[None, :], load_scene("fig3-I")).tolist()
    [[0.0, 0.0]]
    """
    points = len(surface)
    height = np.where(np.isfinite(surface), surface, -np.inf)
    around = [np.roll(height, (i, j), (0, 1)) for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)]
    lowest = np.min([np.where(np.isfinite(each), each, height) for each in around], axis=0)
    places = np.flatnonzero(np.isfinite(height) & (height >= np.max(around, axis=0)))
    places = places[sources(scene, points)[places] == places]
    high, low = height.ravel()[places], lowest.ravel()[places]
    may_reach = high + 0.5 * (high - low)
    return phase_grid(points)[places[np.argsort(-may_reach, kind="stable")][:MAX_CLIMBS]]


def _on_grid(search: _Search) -> Array:
    """The hills on a grid of phases."""
    solved, back = np.unique(sources(search.scene, GRID), return_inverse=True)
    points = search.at(phase_grid(GRID)[solved], max(search.tolerance, GRID_TOLERANCE))
    return hills(points.value[back].reshape(GRID, GRID), search.scene)
