"""
The one-sided limits at a stop: all accelerations that the platform has while its speed goes to zero.

The forces are constant then, but the slip direction still turns, theta' = a . e_perp(theta) (T7 of docs/theory.md),
until the acceleration points along it. The supremum of (5.1) is taken over that whole arc of directions. The bodies
above the platform share its vertical acceleration. docs/decisions/0001-stretched-time.md has the measurements.
"""

from __future__ import annotations

from math import cos, pi, sin, sqrt

from reference.solver.compiled import compiled
from reference.solver.contact.friction import kinetic_coefficient, slip_vector
from reference.solver.contact.platform import acceleration_along, solve_platform_acceleration
from reference.solver.system import Load, System

SAMPLES_PER_TURN = 48  # number of slip directions, per full circle, at which the acceleration is sampled
# First stride, rad, of the search, from the present direction, for the one in which a slide turns no further
FIRST_STRIDE = 1e-3
GOLDEN_SECTIONS = 20  # golden sections that find the slip direction of peak acceleration to 1e-4 of the sampled spacing
# A squared acceleration between two sampled directions exceeds the largest sampled one by at most this share
MAX_RISE_BETWEEN_SAMPLES = 0.1
# Largest ratio of sideways to driving acceleration that counts as rounding, so that the slide does not turn
MAX_ROUNDING_TURN = 1e-9
# Largest ratio of deceleration to friction, as a slide begins, that is put down to rounding of the instant of onset
MAX_ROUNDING_BRAKING = 1e-6


@compiled
def turning_acceleration(system: System, load: Load, angle: float) -> float:
    """Return the acceleration across a slip direction, m/s^2: a positive one turns the slide counter-clockwise."""
    ex, ey = cos(angle), sin(angle)
    ax, ay, _, _ = acceleration_along(system, load, 0.0, ex, ey)
    return ay * ex - ax * ey


@compiled
def squared_absolute_acceleration(system: System, load: Load, angle: float, horizontal: float) -> float:
    """Return the platform's squared absolute acceleration, m^2/s^4, as its speed goes to 0 in the direction `angle`.

    The angle is in rad; `horizontal` is 1, or 0 for the vertical part alone.
    """
    ax, ay, _, _ = acceleration_along(system, load, 0.0, cos(angle), sin(angle))
    az = load.uz
    if not system.small:
        az += (load.px * ax + load.py * ay) / sqrt(system.radius**2 - load.px * load.px - load.py * load.py)
    return horizontal * ((ax + load.ux) ** 2 + (ay + load.uy) ** 2) + az * az


@compiled
def direction_at_stop(system: System, load: Load, angle: float, no_turn: float) -> float:
    """Return the direction, rad, into which a slide turns from `angle` while its speed goes to zero.

    Where the ratio of the sideways to the driving force is at most `no_turn`, it keeps its direction.
    """
    # The direction turns one way until its turning vanishes: at the first zero of the sideways acceleration that way.
    # This zero may be close by, or there may be several zeros: the search goes in strides that double from FIRST_STRIDE
    # up to the distance of two samples, and ends at the first change of sign, or after a full turn.
    here = turning_acceleration(system, load, angle)
    drive = sqrt(load.fx * load.fx + load.fy * load.fy) + kinetic_coefficient(system) * abs(system.gravity + load.uz)
    if abs(here) <= no_turn * drive:
        return angle
    sense = 1.0 if here > 0.0 else -1.0
    inside, outside, stride = angle, angle, FIRST_STRIDE
    while abs(outside - angle) < 2.0 * pi:
        outside = inside + sense * stride
        if sense * turning_acceleration(system, load, outside) <= 0.0:
            break
        inside = outside
        stride = min(2.0 * stride, 2.0 * pi / SAMPLES_PER_TURN)
    return locate_direction_at_stop(system, load, inside, outside)


@compiled
def can_begin_slide(system: System, load: Load, angle: float) -> bool:
    """Return True if a slide can begin from rest in this direction: not braked, and no Painleve paradox."""
    ex, ey = cos(angle), sin(angle)
    sx, sy, _ = slip_vector(system, load.px, load.py, 0.0, ex, ey)
    ax, ay, reaction, determinant = solve_platform_acceleration(system, load, 0.0, sx, sy)
    gain = ax * ex + ay * ey
    return (
        determinant > 0.0 and reaction > 0.0 and gain >= -MAX_ROUNDING_BRAKING * kinetic_coefficient(system) * reaction
    )


@compiled
def locate_direction_at_stop(system: System, load: Load, inside: float, outside: float) -> float:
    """Return the angle, rad, between two others, at which a slide does not turn any further."""
    # Regula falsi in the variant "Illinois" (Dowell and Jarratt, BIT 11, 1971): the value at an end that stays twice is
    # halved. `inside` and `outside` are angles at which the slide turns in opposite senses.
    low, high = inside, outside
    at_low = turning_acceleration(system, load, low)
    at_high = turning_acceleration(system, load, high)
    for _ in range(60):
        if at_low == at_high or abs(high - low) < 1e-15:
            break
        angle = (low * at_high - high * at_low) / (at_high - at_low)
        here = turning_acceleration(system, load, angle)
        if here == 0.0:
            return angle
        if (here > 0.0) == (at_high > 0.0):
            at_low *= 0.5
        else:
            low, at_low = high, at_high
        done = abs(angle - high) < 1e-14
        high, at_high = angle, here
        if done:
            break
    return high


@compiled
def arc_peak(system: System, load: Load, angle: float, end: float, floor: float, horizontal: float) -> float:
    """
    Return the largest `squared_absolute_acceleration` over the directions from `angle` to `end`, m^2/s^4.

    If the maximum is sure to lie below `floor`, m^2/s^4, the largest sample is returned instead.
    """
    # The squared absolute acceleration is smooth in the angle: sampling finds the highest local maximum, and
    # golden-section search between the neighbors of the best sample refines it. If this maximum cannot
    # exceed `floor`, no peak depends on it and the refinement is skipped.
    samples = 4 + int(abs(end - angle) * SAMPLES_PER_TURN / (2.0 * pi))
    stride = (end - angle) / samples
    best, top = -1.0, 0
    for n in range(samples + 1):
        value = squared_absolute_acceleration(system, load, angle + n * stride, horizontal)
        if value > best:
            best, top = value, n
    if (1.0 + MAX_RISE_BETWEEN_SAMPLES) * best < floor:
        return best
    low = angle + max(top - 1, 0) * stride
    high = angle + min(top + 1, samples) * stride
    golden = 0.5 * (sqrt(5.0) - 1.0)
    left, right = high - golden * (high - low), low + golden * (high - low)
    at_left = squared_absolute_acceleration(system, load, left, horizontal)
    at_right = squared_absolute_acceleration(system, load, right, horizontal)
    for _ in range(GOLDEN_SECTIONS):
        best = max(best, max(at_left, at_right))
        if at_left > at_right:
            high, right, at_right = right, left, at_left
            left = high - golden * (high - low)
            at_left = squared_absolute_acceleration(system, load, left, horizontal)
        else:
            low, left, at_left = left, right, at_right
            right = low + golden * (high - low)
            at_right = squared_absolute_acceleration(system, load, right, horizontal)
    return best
