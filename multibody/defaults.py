"""Default values of the package, which signatures, options and tests use by name."""

from __future__ import annotations

from reference.problem.readings import DEFAULT_V_REG as DEFAULT_V_REG

# Largest relative error of every amplification factor mu, unless the caller gives a tolerance.
DEFAULT_TOLERANCE = 1e-3

# Penetration of the contact under the weight, as a share of the pendulum radius, at a constant step and in the viewer.
DEFAULT_PENETRATION = 1e-6

# Relative tolerance of the forces in Newton's iteration, in runs at a constant step.
DEFAULT_NEWTON_TOLERANCE = 1e-5
