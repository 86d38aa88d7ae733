"""
The worst initial phases: the largest value over all phase pairs instead of those of a grid.

A grid finds local maxima, and from each of the highest ones a search goes on (`reference.measures.local_search`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reference.defaults import DEFAULT_TOLERANCE
from reference.measures.local_maxima import GRID, find_local_maxima
from reference.measures.local_search import (
    LocalSearch,
    Surface,
    advance_searches,
    classify_maximum,
    follow_jump,
    merge_searches,
)
from reference.problem import Scene
from reference.problem.phases import check_phases
from reference.problem.ranges import TOLERANCE_RANGE
from reference.problem.readings import describe_law, reading_of
from reference.problem.result import Array
from reference.problem.scene import require_scene
from reference.problem.symmetry import distinct_pairs, find_half_turns
from reference.support.arguments import check_choice, check_number
from reference.surface import amplification

QUANTITIES = ("amplification", "displacement")  # quantities that `worst_phases` maximizes
GRID_TOLERANCE = 1e-4  # relative error asked on the grid of phases, or the user's if larger: the grid starts searches
MAX_ROUNDS = 60  # largest number of rounds in which all local searches advance
MAX_SHORTFALL = 0.01  # a search that ends below the maximum by more than this fraction is not classified or refined


class NoAnswerError(ValueError):
    """Error of a search over all phases that finds no phase pair with an answer."""

    def __init__(self, scene: str, reason: str) -> None:
        """Set the name of the scene and the reason, from which pickle makes the error again in another process."""
        super().__init__(scene, reason)
        self.reason = reason

    def __str__(self) -> str:
        """Return the message, one line."""
        return f"scene {self.args[0]}: {self.reason}"


@dataclass(frozen=True)
class PhaseMaximum:
    """
    Largest amplification of a body, or displacement of the platform, over all initial phases; result of `worst_phases`.

    Attributes
    ----------
    value : float
        Amplification mu_i, or the displacement in m. It is attained at `phases`.
    error : float
        Estimated absolute error, the sum of the errors of the solution there and of the search.
    phases : tuple of float, rad
        (alpha_1, alpha_2) in [0, 2 pi). Symmetries of the scene may give other pairs with the same value.
    kind : {"smooth", "kink", "jump"}
        Shape of the surface there: a level tangent, an edge, or a jump, next to which the value is approached.
    side : tuple of float
        Direction, a unit vector in the plane of phases, from a jump to the pairs with large values. NaN for others.
    runner_up : float
        The highest other value at which a local search ended. NaN without one.
    climbs, reached : int
        Number of searches, each from a local maximum of the grid, and of those that ended at the maximum.
    evaluations : int
        Number of phase pairs that were computed.
    reading : str
        Which reading of (5.1) a factor has, as of `Amplification`. "" of a displacement, which is the same in both.
    law : str
        Law of friction, and the effect of it that the error leaves out.
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
    reading: str = ""
    law: str = ""


@require_scene
def worst_phases(
    scene: Scene,
    body: int = 1,
    quantity: str = "amplification",
    equations: str = "exact",
    regularization: float | None = None,
    tolerance: float = DEFAULT_TOLERANCE,
    cutoff: float | None = None,
    starts: ArrayLike | None = None,
) -> PhaseMaximum:
    """
    Return the largest amplification factor of a body, or displacement of the isolator, over all initial phases.

    Parameters
    ----------
    scene : Scene
        With a two-frequency loading.
    body : int
        From 1, the platform. It has no effect on the displacement.
    quantity : {"amplification", "displacement"}
        Amplification mu_i of (5.1), or the largest horizontal displacement of the platform, m.
    equations, regularization, tolerance, cutoff
        As in `amplification`.
    starts : array_like, (K, 2), rad, optional
        Where searches begin. Without it at the local maxima of a grid of 48 x 48 phases.

    Returns
    -------
    PhaseMaximum

    Raises
    ------
    ValueError
        For an argument outside its range, for a recorded motion, and where no phase pair has an answer. In one line.

    Notes
    -----
    As of `amplification`, the default is the literal supremum of (5.1), and ``cutoff=1e-3`` gives the amplification
    as integrated.

    The maximum is global as far as the grid has a local maximum near it. `climbs`, `reached` and `runner_up` say what
    supports it.
    The denominator of (5.1) has kinks, and there the amplification has edges: the largest mu_2 of fig3-I is on one.

    Examples
    --------
    >>> import reference
    >>> worst = reference.worst_phases(reference.load_scene("fig3-I"), body=2, equations="small", tolerance=1e-4)
    >>> round(worst.value, 3), worst.kind
    (3.06, 'kink')
    """
    check_choice("quantity", quantity, QUANTITIES)
    tolerance = check_number("tolerance", tolerance, TOLERANCE_RANGE)
    if body not in range(1, len(scene.bodies) + 1):
        raise ValueError(f"body = {body!r}: must be an integer from 1 to {len(scene.bodies)}, the number of bodies")
    if scene.recorded:
        raise ValueError(f"scene {scene.name}: a recorded motion has no phases; use amplification")
    law = {"equations": equations, "regularization": regularization, "cutoff": cutoff}
    surface = Surface(
        scene=scene,
        amplification=amplification,
        settings={**law, "tolerance": tolerance},
        body=body - 1,
        quantity=quantity,
    )
    if starts is None:
        phases, taken = distinct_pairs(scene, GRID)
        on_grid = surface.compute(phases, tolerance=max(tolerance, GRID_TOLERANCE)).value[taken]
        starts = find_local_maxima(on_grid, scene)
    searches = _start_searches(surface, check_phases(starts))
    if not searches:
        raise NoAnswerError(scene.name, f"no phase pair has an answer: {surface.outcome}")
    shifts: Array = np.pi * find_half_turns(scene).astype(float)
    for _ in range(MAX_ROUNDS):
        highest = max(search.value for search in searches)
        active = [search for search in searches if search.may_reach(highest)]
        if not active:
            break
        advance_searches(surface, active)
        searches = merge_searches(searches, shifts)
    kinds = _classify_highest(surface, searches)
    best, *others = sorted(merge_searches(searches, shifts), key=lambda search: -search.value)
    kind, side = kinds[best]
    alpha1, alpha2 = (best.phases % (2.0 * np.pi)).tolist()
    return PhaseMaximum(
        value=best.value,
        error=best.error + best.recent_gain,
        phases=(alpha1, alpha2),
        kind=kind,
        side=side,
        runner_up=others[0].value if others else float("nan"),
        climbs=sum(search.count for search in searches),
        reached=best.count,
        evaluations=surface.evaluations,
        reading=reading_of(scene, regularization, cutoff) if quantity == "amplification" else "",
        law=describe_law(scene, regularization, cutoff),
    )


def _start_searches(surface: Surface, phases: Array) -> list[LocalSearch]:
    """Return a local search started at each of the phase pairs (K, 2), rad, at which the motion gave a result."""
    points = surface.compute(phases)
    return [
        LocalSearch(
            phases=points.phases[n],
            value=float(points.value[n]),
            error=float(points.error[n]),
            half_width=2.0 * np.pi / GRID,
        )
        for n in np.flatnonzero(np.isfinite(points.value))
    ]


def _classify_highest(
    surface: Surface, searches: Sequence[LocalSearch]
) -> dict[LocalSearch, tuple[str, tuple[float, float]]]:
    """
    Return for each of the highest searches what `classify_maximum` says, after moving searches along their jumps.
    """
    least = (1.0 - MAX_SHORTFALL) * max(search.value for search in searches)
    kinds = {search: classify_maximum(surface, search) for search in searches if search.value >= least}
    for search in [search for search, (kind, _) in kinds.items() if kind == "jump"]:
        follow_jump(surface, search)
        kinds[search] = classify_maximum(surface, search)
    return kinds
