"""Where inside a step something happens, from the polynomials through its stages."""

from __future__ import annotations

import numpy as np

from reference.solver.collocation import DENSE, DENSE_VALUES, MONOMIALS, STAGES
from reference.solver.compiled import compiled
from reference.solver.contact.platform import rest_excess
from reference.solver.system import Array, System, Work

NEVER = 2.0  # theta of an event that is not within the step
GOLDEN_SECTIONS = 30  # of two instants: an event shorter than a millionth of the step moves nothing
BISECTIONS = 50


@compiled
def lowest(values: Array) -> float:
    """The smallest of the stage values (S,)."""
    least = values[0]
    for k in range(1, STAGES):
        least = min(least, values[k])
    return least


@compiled
def highest(values: Array) -> float:
    """The largest of the stage values (S,)."""
    most = values[0]
    for k in range(1, STAGES):
        most = max(most, values[k])
    return most


@compiled
def powers_of(values: Array) -> Array:
    """Coefficients of the powers of theta of the polynomial through the stage values (S,)."""
    coefficients = np.zeros(STAGES)
    for k in range(STAGES):
        for m in range(STAGES):
            coefficients[k] += MONOMIALS[k, m] * values[m]
    return coefficients


@compiled
def value_at(coefficients: Array, theta: float) -> float:
    """The polynomial at theta."""
    value = 0.0
    for k in range(STAGES - 1, -1, -1):
        value = value * theta + coefficients[k]
    return value


@compiled
def first_crossing(values: Array, start: float, target: float) -> float:
    """First theta at which the polynomial through `values` has passed `target`, seen from `start` at theta = 0."""
    way = 1.0 if start < target else -1.0
    top, place, change, before = -1.0e300, 0.0, 0.0, way * (start - target)
    for n in range(1, DENSE.shape[0]):
        here = 0.0
        for k in range(STAGES):
            here += DENSE_VALUES[n, k] * values[k]
        here = way * (here - target)
        if here > 0.0:
            return crossed(powers_of(values), target, way, DENSE[n - 1], DENSE[n])
        change = max(change, abs(here - before))
        if here > top:
            top, place = here, DENSE[n]
        before = here
    if top + change < 0.0:
        return NEVER
    # it may pass the target and return between two of these instants
    coefficients = powers_of(values)
    low, high = max(0.0, place - DENSE[1]), min(1.0, place + DENSE[1])
    begin = low
    for _ in range(GOLDEN_SECTIONS):
        left, right = low + 0.382 * (high - low), high - 0.382 * (high - low)
        at_left = way * (value_at(coefficients, left) - target)
        at_right = way * (value_at(coefficients, right) - target)
        if max(at_left, at_right) > 0.0:
            return crossed(coefficients, target, way, begin, left if at_left > 0.0 else right)
        if at_left > at_right:
            high = right
        else:
            low = left
    return NEVER


@compiled
def crossed(coefficients: Array, target: float, way: float, low: float, high: float) -> float:
    """Where the polynomial, not beyond the target at low and beyond it at high, passes it."""
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        if way * (value_at(coefficients, middle) - target) > 0.0:
            high = middle
        else:
            low = middle
    return high


@compiled
def expand(work: Work) -> None:
    """Powers of theta of the drive and the ground acceleration of a step at rest, in `powers`."""
    for k in range(STAGES):
        for row in range(5):
            work.powers[row, k] = 0.0
        for m in range(STAGES):
            weight = MONOMIALS[k, m]
            for axis in range(2):
                work.powers[axis, k] += weight * work.free[axis, m]
            for axis in range(3):
                work.powers[2 + axis, k] += weight * work.ground[axis, m]


@compiled
def excess_at(system: System, work: Work, theta: float) -> float:
    """Excess over the condition for rest at theta of a step at rest, after `expand`."""
    fx = fy = ux = uy = uz = 0.0
    for k in range(STAGES - 1, -1, -1):
        fx = fx * theta + work.powers[0, k]
        fy = fy * theta + work.powers[1, k]
        ux = ux * theta + work.powers[2, k]
        uy = uy * theta + work.powers[3, k]
        uz = uz * theta + work.powers[4, k]
    excess, _ = rest_excess(system, work.x[0, 0], work.x[0, 1], fx, fy, ux, uy, system.gravity + uz)
    return excess


@compiled
def first_onset(system: System, work: Work) -> float:
    """First theta of a step at rest at which friction can no longer hold the platform; fills the reaction."""
    highest = -1.0e300
    for k in range(STAGES):
        excess, reaction = rest_excess(
            system, work.x[0, 0], work.x[0, 1], work.free[0, k], work.free[1, k],
            work.ground[0, k], work.ground[1, k], system.gravity + work.ground[2, k],
        )  # fmt: skip
        work.stage[6, k] = reaction
        # between two stages the force changes little: only a step that comes near the limit is looked at closely
        highest = max(highest, excess + 0.5 * (system.friction * reaction) ** 2)
    if highest < 0.0:
        return NEVER
    expand(work)
    top, place, before, slope = -1.0e300, 0.0, excess_at(system, work, 0.0), 0.0
    for n in range(1, DENSE.shape[0]):
        here = excess_at(system, work, DENSE[n])
        if here > 0.0:
            return passed(system, work, DENSE[n - 1], DENSE[n])
        slope = max(slope, abs(here - before))
        if here > top:
            top, place = here, DENSE[n]
        before = here
    if top + slope < 0.0:
        return NEVER
    # the force may pass the limit and return between two of these instants
    low, high = max(0.0, place - DENSE[1]), min(1.0, place + DENSE[1])
    begin = low
    for _ in range(30):
        left, right = low + 0.382 * (high - low), high - 0.382 * (high - low)
        at_left, at_right = excess_at(system, work, left), excess_at(system, work, right)
        if max(at_left, at_right) > 0.0:
            return passed(system, work, begin, left if at_left > 0.0 else right)
        if at_left > at_right:
            high = right
        else:
            low = left
    return NEVER


@compiled
def passed(system: System, work: Work, low: float, high: float) -> float:
    """Where the excess, not positive at low and positive at high, becomes positive."""
    for _ in range(BISECTIONS // 2):  # located_onset does the rest
        middle = 0.5 * (low + high)
        if excess_at(system, work, middle) > 0.0:
            high = middle
        else:
            low = middle
    return high
