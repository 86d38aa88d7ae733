"""Physical constants that every part of the project shares."""

from __future__ import annotations

GRAVITY = 9.81  # m/s^2, acceleration of gravity, as in the paper (section 5)
