"""
Ranges of the arguments of both sides and of other numbers that are no key of a scene; `keys.key` has those of keys.

Inside its range a value is answered, or refused under a named outcome; outside it is refused in one line that states
the range. The ranges are far wider than any isolator: they end where double precision or the work would.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from reference.support.arguments import Range, check_array, quote

Array = NDArray[np.float64]

MAX_SUPPORTS = 1000  # largest number of supports in a scene
SUPPORT_POSITION_RANGE = Range(-1e6, 1e6, "m")  # allowed coordinates of a support along x and y
DAMPING_COEFFICIENT_RANGE = Range(0.0, 1e30, "N s/m")  # allowed coefficients of a link's damper along one axis
MAX_CYCLES = 1e6  # largest duration, counted in the shortest of the periods of loading and pendulum

# allowed phases: beyond these, neighboring double-precision numbers are 1.2e-10 rad apart, the strictest tolerance
PHASE_RANGE = Range(-1e6, 1e6, "rad")
REGULARIZATION_RANGE = Range(1e-12, 1e6, "m/s")  # allowed v_reg: slip speed below which regularized friction is linear
CUTOFF_RANGE = Range(1e-15, 1e6, "m/s")  # allowed v_c: accelerations at lower slip speeds do not count as peaks
POSITION_RANGE = Range(-1e12, 1e12, "m")  # allowed displacements in an initial state
VELOCITY_RANGE = Range(-1e9, 1e9, "m/s")  # allowed velocities in an initial state
TOLERANCE_RANGE = Range(1e-10, 0.1)  # allowed tolerance: relative error asked of amplifications or accelerations

LEAST_ACCELERATION = 1e-140  # m/s^2: squares of smaller accelerations lose digits, so the ground counts as at rest


def check_state(initial: Any, bodies: int, radius: float, travel: float | None = None) -> tuple[Array, Array]:
    """
    Return the checked position, m, and velocity, m/s, of an initial `State`, each (N, 2). Raises ValueError.

    radius, travel: m, inside which the platform must start.
    """
    rule = f"must have finite position and velocity of shape ({bodies}, 2)"
    try:
        x, v = check_array("initial", initial.position, rule), check_array("initial", initial.velocity, rule)
    except AttributeError:
        raise ValueError(f"initial = {quote(initial)}: must be a reference.problem.State") from None
    if x.shape != (bodies, 2) or v.shape != (bodies, 2):
        raise ValueError(f"initial: {rule}")
    for values, allowed in ((x, POSITION_RANGE), (v, VELOCITY_RANGE)):
        if np.abs(values).max() > allowed.highest:
            raise ValueError(f"initial: {values.flat[np.abs(values).argmax()]:g}: {allowed.rule}")
    if float(np.hypot(*x[0])) >= radius:
        raise ValueError(f"initial: the platform must start inside the rim (4.1), rho = {radius:.6g} m")
    if travel is not None and float(np.hypot(*x[0])) > travel:
        raise ValueError(f"initial: the platform must start within isolator.travel = {travel:.6g} m")
    return x, v
