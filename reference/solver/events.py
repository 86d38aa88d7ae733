"""Location of events inside a step (onset of sliding, a passage of a level), on polynomials through its stages."""

from __future__ import annotations

import numpy as np

from reference.solver.collocation import SEARCH_POINTS, STAGES
from reference.solver.compiled import compiled
from reference.solver.contact.friction import static_limit
from reference.solver.contact.platform import load_at_stages, rest_excess
from reference.solver.ground import friction_temperature_factor_at
from reference.solver.polynomial import evaluate_polynomial, set_coefficients
from reference.solver.rows import Row, broadcast_like, put, row, row_maximum, where_positive
from reference.solver.system import Load, System
from reference.solver.work import MAX_PARTS, REACTION, SQUARED_SPEED, VELOCITY, Workspace

# Integer codes of events: the polynomial in work.powers[0], a quantity less a given number, passes zero; friction at
# rest reaches its limit; the sliding speed passes a given one. NumPy integers: see system.py.
LEVEL_EVENT, ONSET_EVENT, SPEED_EVENT = np.int64(0), np.int64(1), np.int64(2)
NOT_IN_STEP = 2.0  # theta (share of the step) that stands for "no event in the step", in which theta goes from 0 to 1
# Number of golden sections in the search for a short event: one that lasts less than 1e-6 of a step may be missed
GOLDEN_SECTIONS = 30
GOLDEN_SHARE = 0.382  # share of an interval that a golden section cuts off, (3 - sqrt(5)) / 2
MAX_SECANTS = 200  # largest number of iterations of regula falsi that locate one event
SECANTS_PER_HALVING = 3  # a bisection follows this many iterations of regula falsi that have not halved the interval
LOCATION_TOLERANCE = 1e-15  # largest error in an event's instant, as a share of the step
# Largest possible rise of the squared tangential force between two stages, over the squared friction limit: if the
# force is farther than this below the limit at all stages, no onset of sliding is looked for in the step.
NEAR_LIMIT = 0.5


@compiled
def locate_level_crossing(system: System, work: Workspace, values: Row, start: float, target: float) -> float:
    """Return the share theta of the step at which a quantity first passes `target`, or NOT_IN_STEP.

    `values` are the quantity at the stages, and `start` is its value at the start of the step.
    """
    expand_level(work, values, target)
    return locate_first_event(system, work, LEVEL_EVENT, 1.0 if start < target else -1.0, 0.0, start - target)


@compiled
def expand_level(work: Workspace, values: Row, target: float) -> None:
    """Set work.powers[0] to the coefficients of the polynomial through stage `values`, minus `target`."""
    set_coefficients(values, work.powers[0])
    work.powers[0, 0] -= target


@compiled
def locate_onset(system: System, work: Workspace) -> float:
    """Return the share theta of a step at rest from which friction cannot hold the platform any longer, or NOT_IN_STEP.

    It also sets the reactions at the stages, in work.stage.
    """
    load = load_at_stages(work)
    excess, reaction = rest_excess(system, load)
    put(work.stage, REACTION, reaction)
    limit = static_limit(system, load.k_t, reaction)
    most = row_maximum(excess + NEAR_LIMIT * (limit * limit))
    if most < 0.0:  # the step does not come near the friction limit
        return NOT_IN_STEP
    expand_drive(work)
    return locate_first_event(system, work, ONSET_EVENT, 1.0, 0.0, excess_at(system, work, 0.0))


@compiled
def expand_drive(work: Workspace) -> None:
    """Set the polynomials over a step at rest that `excess_at` evaluates.

    Rows 0 and 1 of work.powers get those of the driving acceleration (link force over mass minus ground acceleration)
    along x and y, and rows 2 to 4 those of the ground acceleration along x, y and z.
    """
    for axis in range(2):
        set_coefficients(row(work.free, axis), work.powers[axis])
    for axis in range(3):
        set_coefficients(row(work.ground, axis), work.powers[2 + axis])


@compiled
def excess_at(system: System, work: Workspace, theta: float) -> float:
    """Return squared tangential force minus squared friction limit, m^2/s^4, at share theta of a step at rest.

    `expand_drive` comes before.
    """
    powers = work.powers
    fx = fy = ux = uy = uz = 0.0
    for k in range(STAGES - 1, -1, -1):
        fx = fx * theta + powers[0, k]
        fy = fy * theta + powers[1, k]
        ux = ux * theta + powers[2, k]
        uy = uy * theta + powers[3, k]
        uz = uz * theta + powers[4, k]
    k_t = friction_temperature_factor_at(system, work.time + theta * work.elapsed[STAGES - 1])
    load = Load(px=work.x[0, 0], py=work.x[0, 1], fx=fx, fy=fy, ux=ux, uy=uy, uz=uz, k_t=k_t)
    excess, _ = rest_excess(system, load)
    return excess


@compiled
def expand_speed(work: Workspace, h: float, target: float) -> None:
    """
    Set what `speed_excess` needs for squared sliding speed minus `target`, m^2/s^2, in a step of length h, s.

    Rows 0 and 1 of work.powers are polynomials of the velocity along x and y; row 2 is that of the squared ratio of the
    sliding speed to the horizontal one, and row 3 begins with the target. The velocity is the integral of the
    polynomial through the accelerations. A polynomial through the squared speeds at the stages would miss a small speed
    in a step whose speed becomes large.
    """
    for axis in range(2):
        expand_velocity(work, h, axis)
    vx, vy = row(work.stage, VELOCITY), row(work.stage, VELOCITY + 1)
    horizontal = vx * vx + vy * vy
    set_coefficients(
        where_positive(horizontal, row(work.stage, SQUARED_SPEED) / horizontal, broadcast_like(1.0, horizontal)),
        work.powers[2],
    )
    work.powers[3, 0] = target


@compiled
def expand_velocity(work: Workspace, h: float, axis: int) -> None:
    """Set work.powers[axis] to coefficients of the platform's velocity, a polynomial over the step of length h, s."""
    powers = work.powers[axis]
    set_coefficients(row(work.a, (0, axis)), powers)
    for k in range(STAGES - 1, -1, -1):
        powers[k + 1] = h * powers[k] / (k + 1.0)
    powers[0] = work.v[0, axis]


@compiled
def speed_excess(work: Workspace, theta: float) -> float:
    """Return the squared sliding speed at share theta of the step minus the target of `expand_speed`, m^2/s^2."""
    powers = work.powers
    vx = vy = 0.0
    for k in range(STAGES, -1, -1):
        vx = vx * theta + powers[0, k]
        vy = vy * theta + powers[1, k]
    return (vx * vx + vy * vy) * evaluate_polynomial(powers[2], theta) - powers[3, 0]


@compiled
def event_value(system: System, work: Workspace, event: int, way: float, theta: float) -> float:
    """Return an event's quantity at share theta of the step, with the sign that makes it positive behind the event.

    The quantity is the excess of force or speed, or the polynomial in work.powers[0]. `way` is 1 if the event is that
    the quantity rises through zero, and -1 if it falls.
    """
    if event == ONSET_EVENT:
        return way * excess_at(system, work, theta)
    return way * (speed_excess(work, theta) if event == SPEED_EVENT else evaluate_polynomial(work.powers[0], theta))


@compiled
def locate_first_event(system: System, work: Workspace, event: int, way: float, begin: float, start: float) -> float:
    """Return the first share theta of a step, from `begin` on, at which `event_value` is positive, or NOT_IN_STEP.

    `start` is the event's quantity at `begin`.
    """
    # SEARCH_POINTS show every event that lasts longer than the distance between two of them. A shorter event may lie
    # between two points: the value passes zero and returns. This is possible only if the largest value seen lies below
    # zero by no more than the largest change from point to point. Then a golden-section search looks for a positive
    # value around the largest one. Once a positive value is found, `locate_crossing` locates the passage before it.
    top, place, change, low, before = -1.0e300, begin, 0.0, begin, way * start
    for n in range(1, SEARCH_POINTS.shape[0]):
        if SEARCH_POINTS[n] <= begin:
            continue
        here = event_value(system, work, event, way, SEARCH_POINTS[n])
        if here > 0.0:
            return locate_crossing(system, work, event, way, low, SEARCH_POINTS[n])
        change = max(change, abs(here - before))
        if here > top:
            top, place = here, SEARCH_POINTS[n]
        before, low = here, SEARCH_POINTS[n]
    if top + change < 0.0:
        return NOT_IN_STEP
    low, high = max(begin, place - SEARCH_POINTS[1]), min(1.0, place + SEARCH_POINTS[1])
    first = low
    for _ in range(GOLDEN_SECTIONS):
        left, right = low + GOLDEN_SHARE * (high - low), high - GOLDEN_SHARE * (high - low)
        at_left, at_right = event_value(system, work, event, way, left), event_value(system, work, event, way, right)
        if max(at_left, at_right) > 0.0:
            return locate_crossing(system, work, event, way, first, left if at_left > 0.0 else right)
        if at_left > at_right:
            high = right
        else:
            low = left
    return NOT_IN_STEP


@compiled
def locate_crossing(system: System, work: Workspace, event: int, way: float, low: float, high: float) -> float:
    """Return the share theta of the step, between low and high, at which `event_value` turns positive."""
    # Regula falsi in the variant "Illinois" (Dowell and Jarratt, BIT 11, 1971): the value at an end that stays twice is
    # halved. Where the values at the ends differ by orders of magnitude the secants creep; a bisection follows after
    # SECANTS_PER_HALVING secants that have not halved the interval. The end with the positive value is returned, so
    # that the event has happened there.
    at_low, at_high = event_value(system, work, event, way, low), event_value(system, work, event, way, high)
    rose = fell = False
    width, secants = high - low, 0
    for _ in range(MAX_SECANTS):
        if high - low <= LOCATION_TOLERANCE:
            break
        if high - low <= 0.5 * width:
            width, secants = high - low, 0
        middle = high - (high - low) * at_high / (at_high - at_low)
        if secants == SECANTS_PER_HALVING or not low <= middle <= high:
            middle, secants = 0.5 * (low + high), 0
        middle = min(max(middle, low + 0.5 * LOCATION_TOLERANCE), high - 0.5 * LOCATION_TOLERANCE)
        secants += 1
        here = event_value(system, work, event, way, middle)
        if here > 0.0:
            high, at_high = middle, here
            at_low = 0.5 * at_low if fell else at_low
        else:
            low, at_low = middle, here
            at_high = 0.5 * at_high if rose else at_high
        rose, fell = not here > 0.0, here > 0.0
    return high


@compiled
def mark_parts(system: System, work: Workspace, event: int, way: float, start: float) -> int:
    """
    Find the parts of a step in which the quantity of `event` is at least 0 (or at most 0, if `way` is -1).

    Return their number, and set work.edges to start and end of each in turn, as shares theta of the step. `start` is
    the quantity at theta = 0.
    """
    parts, theta, counts, value = 0, 0.0, way * start >= 0.0, start
    while theta < 1.0 and parts < MAX_PARTS:
        end = min(1.0, locate_first_event(system, work, event, -way if counts else way, theta, value))
        if counts:
            work.edges[2 * parts], work.edges[2 * parts + 1] = theta, end
            parts += 1
        theta, counts, value = end, not counts, 0.0
    return parts
