"""Physical constants that every part of the project shares."""

from __future__ import annotations

GRAVITY = 9.81  # m/s^2, the paper's value (section 5)
