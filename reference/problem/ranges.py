"""
The range of every quantity of a scene and of every argument of both sides.

Inside its range a value is answered, or refused under a named outcome; outside it is refused in one line that states
the range. The ranges are far wider than any isolator: they end where double precision or the work would.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reference.support.arguments import Range, brief, checked_array

Array = NDArray[np.float64]

SCENE: dict[str, Range] = {
    "duration": Range(1e-6, 1e9, "s"),
    "isolator.period": Range(1e-3, 1e6, "s"),
    "isolator.radius": Range(1e-7, 1e12, "m", or_infinite=True),
    "isolator.friction": Range(0.0, 1e3),
    # without friction at rest nothing ever stops, which is no dry friction
    "isolator.friction.slow": Range(1e-9, 1e3),
    "isolator.friction.fast": Range(0.0, 1e3),
    "isolator.friction.rate": Range(1e-6, 1e10, "s/m"),
    "isolator.friction.load_exponent": Range(-0.5, 1.0),
    "isolator.friction.reference_load": Range(1e-11, 1e16, "N"),
    "isolator.friction.heating.contact_radius": Range(1e-3, 10.0, "m"),
    "isolator.friction.heating.conductivity": Range(0.01, 1e4, "W/(m K)"),
    "isolator.friction.heating.diffusivity": Range(1e-8, 1e-2, "m^2/s"),
    "isolator.friction.heating.initial_temperature": Range(-50.0, 300.0, "degrees C"),
    "isolator.lubrication": Range(0.0, 1e9, "s/m"),
    "isolator.supports": Range(3, 1000),
    "isolator.ring": Range(1e-6, 1e6, "m"),
    "isolator.support_stiffness": Range(1e-12, 1e18, "N/m"),
    "isolator.support_damping": Range(0.01, 100.0),
    "isolator.restitution": Range(0.0, 1.0),
    "isolator.travel": Range(1e-9, 1e12, "m"),
    "isolator.sphere_radius": Range(1e-9, 1e6, "m"),
    "bodies.mass": Range(1e-12, 1e15, "kg"),
    "bodies.period": Range(1e-7, 1e9, "s"),
    "bodies.stiffness": Range(1e-30, 1e30, "N/m"),
    "bodies.bars.count": Range(1, 1_000_000),
    "bodies.bars.bending_stiffness": Range(1e-30, 1e30, "N m^2"),
    "bodies.bars.length": Range(1e-9, 1e6, "m"),
    "bodies.bars.axial_stiffness": Range(1e-30, 1e30, "N"),
    "bodies.bars.torsional_stiffness": Range(0.0, 1e30, "N m^2"),
    "bodies.bars.spread": Range(0.0, 1e6, "m"),
    "bodies.damping": Range(0.0, 100.0),
    "bodies.height": Range(0.0, 1e6, "m"),
    "bodies.size": Range(1e-9, 1e6, "m"),
    "bodies.offset": Range(-1e6, 1e6, "m"),
    "bodies.yaw": Range(-2.0 * math.pi, 2.0 * math.pi, "rad"),
    "excitation.amplitudes": Range(-1e308, 1e308, "m/s^2"),  # from about 1e150 on the outcome is "non-finite load"
    "excitation.periods": Range(1e-9, 1e12, "s"),
    "excitation.decay": Range(0.0, 1e12, "1/s"),
    "measured.body": Range(1, 10_000),
    "measured.value": Range(-1e30, 1e30),
    "measured.uncertainty": Range(0.0, 1e30),
    "measured.phases": Range(-1e6, 1e6, "rad"),
}
SUPPORT_POSITION = Range(-1e6, 1e6, "m")  # of a support, along x and y
DAMPING_COEFFICIENT = Range(0.0, 1e30, "N s/m")  # of a link along one axis
MAX_CYCLES = 1e6  # of the loading's shortest period, and of the pendulum's, in the duration

# rad; beyond, neighboring double-precision numbers are more than 1.2e-10 rad apart, the strictest tolerance
PHASE = Range(-1e6, 1e6, "rad")
REGULARIZATION = Range(1e-12, 1e6, "m/s")
CUTOFF = Range(1e-15, 1e6, "m/s")
POSITION = Range(-1e12, 1e12, "m")  # of an initial state
VELOCITY = Range(-1e9, 1e9, "m/s")
TOLERANCE = Range(1e-10, 0.1)

LEAST_ACCELERATION = 1e-140  # m/s^2: squares of smaller accelerations lose digits; the ground is at rest


def checked_state(initial: Any, bodies: int, radius: float, travel: float | None = None) -> tuple[Array, Array]:
    """
    Position and velocity (N, 2) of an initial `State`, inside the rim and the travel. Raises ValueError, one line.
    """
    rule = f"must have finite position and velocity of shape ({bodies}, 2)"
    try:
        x, v = checked_array("initial", initial.position, rule), checked_array("initial", initial.velocity, rule)
    except AttributeError:
        raise ValueError(f"initial = {brief(initial)}: must be a reference.problem.State") from None
    if x.shape != (bodies, 2) or v.shape != (bodies, 2):
        raise ValueError(f"initial: {rule}")
    for values, allowed in ((x, POSITION), (v, VELOCITY)):
        if np.abs(values).max() > allowed.highest:
            raise ValueError(f"initial: {values.flat[np.abs(values).argmax()]:g}: {allowed.rule}")
    if float(np.hypot(*x[0])) >= radius:
        raise ValueError(f"initial: the platform must start inside the rim (4.1), rho = {radius:.6g} m")
    if travel is not None and float(np.hypot(*x[0])) > travel:
        raise ValueError(f"initial: the platform must start within isolator.travel = {travel:.6g} m")
    return x, v
