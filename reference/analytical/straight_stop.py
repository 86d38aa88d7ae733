"""A body sliding straight on a plane under dry friction: v' = -mu g. On the isolator, the limit of a large radius."""

from __future__ import annotations

from reference.problem import GRAVITY


def stopping_time(speed: float, friction: float) -> float:
    """Time to stop, s, from `speed`, m/s: v / (mu g)."""
    return speed / (friction * GRAVITY)


def stopping_distance(speed: float, friction: float) -> float:
    """Way to stop, m, from `speed`, m/s: v^2 / (2 mu g)."""
    return speed * speed / (2.0 * friction * GRAVITY)
