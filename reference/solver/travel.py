"""Travel limit: a motion ends when the platform reaches the largest displacement that the isolator permits."""

from __future__ import annotations

from math import inf

from reference.solver.collocation import SEARCH_POINTS
from reference.solver.compiled import compiled
from reference.solver.peaks import IN_THE_PLANE, expand_position, largest_square, sum_of_squares
from reference.solver.polynomial import evaluate_polynomial, set_coefficients
from reference.solver.rows import row
from reference.solver.system import REST, STOPPING, System
from reference.solver.work import CLOCK, Workspace

BISECTIONS = 50  # number of bisections that find, up to rounding, when a displacement is reached in a step


@compiled
def instant_of_travel(system: System, work: Workspace, contact: int, h: float) -> float:
    """Return the time, s, at which the platform passes the isolator's travel in the step just solved, or infinity."""
    if contact == REST or system.travel == inf:
        return inf
    for axis in range(2):
        if contact == STOPPING:
            set_coefficients(row(work.positions, (0, axis)), work.powers[axis])
        else:
            expand_position(work, h, axis)
    limit = system.travel * system.travel
    top, place = largest_square(work, IN_THE_PLANE, 0.0, 1.0)
    if top <= limit:
        return inf
    theta = locate_displacement(work, limit, place)
    if contact != STOPPING:
        return work.time + h * theta
    set_coefficients(row(work.turning, CLOCK), work.powers[2])
    return evaluate_polynomial(work.powers[2], theta)


@compiled
def locate_displacement(work: Workspace, limit: float, place: float) -> float:
    """Return the first share of the step, up to `place`, at which the squared displacement exceeds `limit`, m^2."""
    low, high = 0.0, place
    for n in range(1, SEARCH_POINTS.shape[0]):
        if SEARCH_POINTS[n] >= place:
            break
        square, _, _ = sum_of_squares(work, IN_THE_PLANE, SEARCH_POINTS[n])
        if square > limit:
            high = SEARCH_POINTS[n]
            break
        low = SEARCH_POINTS[n]
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        square, _, _ = sum_of_squares(work, IN_THE_PLANE, middle)
        if square > limit:
            high = middle
        else:
            low = middle
    return high
