"""Defaults of the package: each has one name here, which signatures, options and tests use."""

from __future__ import annotations

from reference.problem.readings import DEFAULT_V_REG as DEFAULT_V_REG

# Relative error that is asked of every mu.
DEFAULT_TOLERANCE = 1e-3

# Penetration of the contact under the weight, in units of rho, of runs at a constant step and of the viewer.
DEFAULT_PENETRATION = 1e-6

# Relative tolerance of the forces in Newton's iteration, of runs at a constant step.
DEFAULT_NEWTON_TOLERANCE = 1e-5
