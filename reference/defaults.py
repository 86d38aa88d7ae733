"""Defaults of the package: each has one name here, which signatures and tests use."""

from __future__ import annotations

# Relative error that is required of every amplification mu, and of the accelerations inside each step of a trajectory.
DEFAULT_TOLERANCE = 1e-6
