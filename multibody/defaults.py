"""Default values of the package, which signatures, options and tests use by name."""

from __future__ import annotations

from reference.problem.readings import DEFAULT_V_REG as DEFAULT_V_REG

# Largest relative error of every amplification factor mu, unless the caller gives a tolerance.
DEFAULT_TOLERANCE = 1e-3

# Stiffness of the contact in the viewer and at a constant step, as its penetration under the weight / pendulum radius
DEFAULT_PENETRATION = 1e-6

# Relative tolerance of the forces in Newton's iteration, in runs at a constant step.
DEFAULT_NEWTON_TOLERANCE = 1e-5
