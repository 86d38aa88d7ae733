"""The two readings of (5.1), and the friction law of a result, in words."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reference.problem.scene import Scene

AS_INTEGRATED = "as integrated"  # peak acceleration in amplification (5.1): what an integration in time resolves
"""The resolved peak at v_c, 1 mm/s by default of the comparison, or what a run with regularized friction reaches."""
LITERAL_SUPREMUM = "literal supremum"  # peak acceleration in amplification (5.1) with the limit v -> 0+ of slip speed
"""The limit of vanishing slip speed under the set-valued law, which no integration reaches."""
BOTH_READINGS = "in both readings"  # without dry friction peaks as integrated and as literal supremum (5.1) are equal
"""Reading of a factor without dry friction, which is the same as integrated and as literal supremum."""
DEFAULT_V_REG = 1e-3  # m/s, slip speed below which regularized friction is linear
"""Slip speed v_reg, m/s, below which dry friction grows linearly with the slip velocity on both sides."""
DEFAULT_V_C = 1e-3  # m/s, slip speed below which accelerations do not count as peaks
"""Slip speed v_c, m/s, above which an integration with steps of about 1 ms sees the motion."""
SECOND_V_REG_RATIO = 0.1  # second regularization speed over the first, to see the effect of regularization
"""Second v_reg over the first where two runs estimate the effect of regularization: they show 0.9 of it."""


def reading_of(scene: Scene, regularization: float | None, cutoff: float | None = None) -> str:
    """Return how peak acceleration in (5.1) is taken: as integrated, literal supremum, "" if no rigid dry friction."""
    if not scene.has_dry_friction:
        return ""
    return LITERAL_SUPREMUM if regularization is None and cutoff is None else AS_INTEGRATED


def describe_law(
    scene: Scene,
    regularization: float | None,
    cutoff: float | None = None,
    effect: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None,
) -> str:
    """
    Describe the friction law of a result, and the change by regularization that the result's error does not cover.

    effect: what a tenth of v_reg changes in the amplification and in the displacement, m, where that was computed.
    """
    if scene.friction_coefficient == 0.0:
        return "no friction"
    if scene.lubricated:
        return "viscous friction (3.14)"
    if scene.dry_friction.elastic:
        kind, way = scene.dry_friction.kind, scene.yield_displacement
        return f"{kind} friction that yields elastically before it slides, by {way:.3g} m under the weight"
    if regularization is None:
        peak = LITERAL_SUPREMUM if cutoff is None else f"{AS_INTEGRATED}, v_c = {cutoff:g} m/s"
        return f"set-valued {scene.dry_friction.kind} friction; {peak}"
    law = f"regularized below v_reg = {regularization:g} m/s: the error leaves out what this changes against set-valued"
    if effect is None or not all(np.isfinite(part).any() for part in effect):
        return f"{law} friction"
    factor, displacement = (f"{np.nanmax(np.abs(part)):.2g}" for part in effect)
    changes = f"mu changes by up to {factor} and the displacement by up to {displacement} m"
    return f"{law} friction; from there to v_reg = {SECOND_V_REG_RATIO * regularization:g} m/s {changes}"
