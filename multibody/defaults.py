"""Defaults of the package: each has one name here, which signatures, options and tests use."""

from __future__ import annotations

# Slip speed v_reg, m/s, below which dry friction is linear in the slip velocity.
DEFAULT_V_REG = 1e-3

# Relative error that is asked of every mu.
DEFAULT_TOLERANCE = 1e-3

# Penetration of the contact under the weight, in units of rho, of runs at a constant step and of the viewer.
DEFAULT_PENETRATION = 1e-6

# Relative tolerance of the forces in Newton's iteration, of runs at a constant step.
DEFAULT_NEWTON_TOLERANCE = 1e-5
