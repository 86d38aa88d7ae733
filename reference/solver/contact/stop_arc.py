"""
The one-sided limits at a stop, closed: every acceleration the platform takes on the way into rest.

As |v| goes to zero forces are frozen, but the slip direction still turns, theta' = a . e_perp(theta), until its
acceleration points along it. The supremum of (5.1) runs over that whole arc of directions. The bodies above the
platform share its vertical acceleration.
"""

from __future__ import annotations

from math import cos, pi, sin, sqrt

from reference.solver.compiled import compiled
from reference.solver.contact.friction import slip_vector
from reference.solver.contact.platform import acceleration, acceleration_along
from reference.solver.system import Load, System

SAMPLES_PER_TURN = 48
FIRST_STRIDE = 1e-3  # rad: of the search for the direction that does not turn, which may be close
GOLDEN_SECTIONS = 20  # they leave 1e-5 of a sample, and an error of the order of its square
MAX_RISE_BETWEEN_SAMPLES = 0.1  # of the largest squared sample: a peak between two samples is taken to be less above it
MAX_ROUNDING_TURN = 1e-9  # of the drive: sideways acceleration that rounding may make
MAX_ROUNDING_BRAKING = 1e-6  # of friction: deceleration of a slide that begins which rounding of its instant may make


@compiled
def turning_acceleration(system: System, load: Load, angle: float) -> float:
    """a . e_perp: positive when the direction turns counter-clockwise."""
    ex, ey = cos(angle), sin(angle)
    ax, ay, _, _ = acceleration_along(system, load, 0.0, ex, ey)
    return ay * ex - ax * ey


@compiled
def squared_absolute_acceleration(system: System, load: Load, angle: float, horizontal: float) -> float:
    """Squared absolute acceleration, or its vertical part for horizontal = 0, sliding at vanishing speed, m^2/s^4."""
    ax, ay, _, _ = acceleration_along(system, load, 0.0, cos(angle), sin(angle))
    az = load.uz
    if not system.small:
        az += (load.px * ax + load.py * ay) / sqrt(system.radius**2 - load.px * load.px - load.py * load.py)
    return horizontal * ((ax + load.ux) ** 2 + (ay + load.uy) ** 2) + az * az


@compiled
def direction_at_stop(system: System, load: Load, angle: float, no_turn: float) -> float:
    """The direction at which the turning from `angle` ends; `angle` itself if it turns by less than no_turn."""
    here = turning_acceleration(system, load, angle)
    drive = sqrt(load.fx * load.fx + load.fy * load.fy) + system.friction * abs(system.gravity + load.uz)
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
    """Whether a slide from rest has an acceleration in this direction (Painleve), and is not braked by it."""
    ex, ey = cos(angle), sin(angle)
    sx, sy, _ = slip_vector(system, load.px, load.py, 0.0, ex, ey)
    ax, ay, reaction, determinant = acceleration(system, load, 0.0, sx, sy)
    gain = ax * ex + ay * ey
    return determinant > 0.0 and reaction > 0.0 and gain >= -MAX_ROUNDING_BRAKING * system.friction * reaction


@compiled
def locate_direction_at_stop(system: System, load: Load, inside: float, outside: float) -> float:
    """The direction between the two that does not turn, by the Illinois variant of regula falsi."""
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
    """Largest `squared_absolute_acceleration` over the arc from `angle` to `end`, m^2/s^4; below `floor`, the largest sample."""
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
