"""Where inside a step something happens, from the polynomials through its stages."""

from __future__ import annotations

from reference.solver.collocation import DENSE, MONOMIALS, STAGES
from reference.solver.compiled import compiled
from reference.solver.contact.platform import load_at_stage, rest_excess
from reference.solver.system import Array, Load, System
from reference.solver.work import POWERS, REACTION, Work

NEVER = 2.0  # theta of an event that is not within the step
GOLDEN_SECTIONS = 30  # of two instants: an event shorter than a millionth of the step moves nothing
GOLDEN_SHARE = 0.382
BISECTIONS = 50
NEAR_LIMIT = 0.5  # of the squared friction limit: between two stages of a step at rest the excess changes by less


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
def expand(values: Array, coefficients: Array) -> None:
    """Coefficients (POWERS,) of the powers of theta of the polynomial through the stage values (S,)."""
    for k in range(STAGES):
        coefficients[k] = 0.0
        for m in range(STAGES):
            coefficients[k] += MONOMIALS[k, m] * values[m]
    for k in range(STAGES, POWERS):
        coefficients[k] = 0.0


@compiled
def value_at(coefficients: Array, theta: float) -> float:
    """The polynomial through stage values at theta."""
    value = 0.0
    for k in range(STAGES - 1, -1, -1):
        value = value * theta + coefficients[k]
    return value


@compiled
def first_crossing(work: Work, values: Array, start: float, target: float) -> float:
    """First theta at which the polynomial through `values` has passed `target`, seen from `start` at theta = 0."""
    way = 1.0 if start < target else -1.0
    expand(values, work.powers[0])
    for k in range(STAGES):
        work.powers[0, k] *= way
    work.powers[0, 0] -= way * target
    return first_passage(None, work, way * (start - target))


@compiled
def first_onset(system: System, work: Work) -> float:
    """First theta of a step at rest at which friction can no longer hold the platform; fills the reaction."""
    most = -1.0e300
    for k in range(STAGES):
        excess, reaction = rest_excess(system, load_at_stage(work, k))
        work.stage[REACTION, k] = reaction
        most = max(most, excess + NEAR_LIMIT * (system.friction * reaction) ** 2)
    if most < 0.0:  # only a step that comes near the limit is looked at closely
        return NEVER
    expand_drive(work)
    return first_passage(system, work, excess_at(system, work, 0.0))


@compiled
def expand_drive(work: Work) -> None:
    """Powers of theta of the drive and the ground acceleration of a step at rest, in `powers`."""
    for axis in range(2):
        expand(work.free[axis], work.powers[axis])
    for axis in range(3):
        expand(work.ground[axis], work.powers[2 + axis])


@compiled
def excess_at(system: System, work: Work, theta: float) -> float:
    """Excess over the condition for rest at theta of a step at rest, after `expand_drive`."""
    powers = work.powers
    fx = fy = ux = uy = uz = 0.0
    for k in range(STAGES - 1, -1, -1):
        fx = fx * theta + powers[0, k]
        fy = fy * theta + powers[1, k]
        ux = ux * theta + powers[2, k]
        uy = uy * theta + powers[3, k]
        uz = uz * theta + powers[4, k]
    excess, _ = rest_excess(system, Load(work.x[0, 0], work.x[0, 1], fx, fy, ux, uy, uz))
    return excess


@compiled
def beyond(system: System | None, work: Work, theta: float) -> float:
    """How far the step is past an event at theta: of the onset of slip, or without a system of powers[0] past zero."""
    if system is None:
        return value_at(work.powers[0], theta)
    return excess_at(system, work, theta)


@compiled
def first_passage(system: System | None, work: Work, start: float) -> float:
    """First theta at which `beyond` is positive, which is `start` at theta = 0."""
    top, place, change, before = -1.0e300, 0.0, 0.0, start
    for n in range(1, DENSE.shape[0]):
        here = beyond(system, work, DENSE[n])
        if here > 0.0:
            return passed(system, work, DENSE[n - 1], DENSE[n])
        change = max(change, abs(here - before))
        if here > top:
            top, place = here, DENSE[n]
        before = here
    if top + change < 0.0:
        return NEVER
    # it may pass and return between two of these instants
    low, high = max(0.0, place - DENSE[1]), min(1.0, place + DENSE[1])
    begin = low
    for _ in range(GOLDEN_SECTIONS):
        left, right = low + GOLDEN_SHARE * (high - low), high - GOLDEN_SHARE * (high - low)
        at_left, at_right = beyond(system, work, left), beyond(system, work, right)
        if max(at_left, at_right) > 0.0:
            return passed(system, work, begin, left if at_left > 0.0 else right)
        if at_left > at_right:
            high = right
        else:
            low = left
    return NEVER


@compiled
def passed(system: System | None, work: Work, low: float, high: float) -> float:
    """Where `beyond`, not positive at low and positive at high, becomes positive."""
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        if beyond(system, work, middle) > 0.0:
            high = middle
        else:
            low = middle
    return high


@compiled
def counted_part(work: Work, values: Array, start: float, level: float) -> tuple[float, float]:
    """The part [low, high] of a step, in theta, in which the polynomial through `values` is above `level`."""
    end = values[STAGES - 1]
    if start < level and end < level:
        return 0.0, 0.0
    if start < level:
        return min(1.0, first_crossing(work, values, start, level)), 1.0
    if end < level:
        return 0.0, min(1.0, first_crossing(work, values, start, level))
    return 0.0, 1.0
