"""Straight slide of a body on a plane under dry friction, v' = -mu g: the isolator of infinite radius."""

from __future__ import annotations

from reference.problem import GRAVITY


def stopping_time(speed: float, friction: float) -> float:
    """Return the time to the stop, s, from `speed`, m/s: v / (mu g)."""
    return speed / (friction * GRAVITY)


def stopping_distance(speed: float, friction: float) -> float:
    """Return the distance to the stop, m, from `speed`, m/s: v^2 / (2 mu g)."""
    return speed * speed / (2.0 * friction * GRAVITY)
