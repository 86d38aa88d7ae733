"""
The two readings of (5.1), that is, definitions of its peak acceleration, and the friction law of a result, in words.

At each stop, as the slip speed v goes to zero, acceleration under the set-valued law may have a short peak. The
"literal supremum" counts its limit v -> 0+, too. "As integrated" counts what a numerical integration in time resolves.
They differ only for dry friction that is rigid before it slides. See docs/theory.md.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reference.problem.scene import Scene

AS_INTEGRATED = "as integrated"
"""Peak acceleration over slip speeds above v_c, or that of a run with regularized friction."""
LITERAL_SUPREMUM = "literal supremum"
"""Peak acceleration with the limit of vanishing slip speed under the set-valued law, which no integration reaches."""
BOTH_READINGS = "in both readings"
"""Words for an amplification without dry friction, which is the same as integrated and as literal supremum."""
DEFAULT_V_REG = 1e-3  # m/s
"""Slip speed v_reg below which regularized friction grows linearly with the slip velocity, in equations and engine."""
DEFAULT_V_C = 1e-3  # m/s, above which an integration with steps of about 1 ms resolves the motion
"""Slip speed v_c below which accelerations do not count as peaks."""
SECOND_V_REG_RATIO = 0.1
"""Second v_reg over the first, where two runs estimate the effect of regularization: they show 0.9 of it."""


def reading_of(scene: Scene, regularization: float | None, cutoff: float | None = None) -> str:
    """
    Return the reading of (5.1) for a run of a scene, "" without rigid dry friction, where both readings agree.

    regularization: v_reg, m/s, or None for set-valued friction. cutoff: v_c, m/s, or None.
    """
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
    Describe the friction law of a result, and the effect of regularization that the result's error does not cover.

    regularization, cutoff: as in `reading_of`. effect: changes of the amplification and of the displacement, m, with a
    tenth of v_reg, where they were computed.
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
