"""Effective linear isolator that replaces a friction pendulum in design codes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reference.problem.result import Array
from reference.problem.scene import Scene, require_scene
from reference.support.arguments import check_array, quote
from reference.support.constants import GRAVITY


@dataclass(frozen=True)
class EffectiveIsolator:
    """
    Effective stiffness, period, damping and re-centering of the isolator at amplitudes D; arrays have the shape of D.

    Attributes
    ----------
    stiffness : ndarray, N/m
        Secant stiffness W / rho + mu W / D, with the weight W and the friction coefficient mu.
    period : ndarray, s
        Period of the whole mass on that stiffness.
    damping : ndarray
        Damping ratio with the same energy per cycle, 2 / pi mu / (mu + D / rho).
    restoring : ndarray
        Restoring force over friction force, D / (mu rho). Below 1 the platform may stay at D. Half of it is the energy
        ratio E_S / E_H of EN 15129.
    """

    stiffness: Array
    period: Array
    damping: Array
    restoring: Array


@require_scene
def effective_isolator(scene: Scene, displacement: ArrayLike) -> EffectiveIsolator:
    """
    Return effective stiffness, period and damping of the isolator at a displacement, and its re-centering ratio.

    Parameters
    ----------
    scene : Scene
        With dry friction. Its coefficient at high speed counts, under the weight and without heat.
    displacement : array_like, m
        Amplitude D of the cycle, of any shape, above 0; usually the largest displacement under a ground motion.

    Returns
    -------
    EffectiveIsolator

    Raises
    ------
    ValueError
        For a lubricated scene, and for a displacement that is not a positive number.

    Notes
    -----
    ASCE/SEI 7-22, chapter 17, for a bilinear loop. The formulas are those of small slopes, D much smaller than rho.
    Friction that yields at u_y is elastic up to there; its loop loses 4 mu W (D - u_y), and nothing below u_y.

    Examples
    --------
    >>> import reference
    >>> scene = reference.load_scene("fig3-I").with_values({"isolator": {"radius": 2.0, "friction": 0.05}})
    >>> isolator = reference.effective_isolator(scene, 0.2)
    >>> isolator.period.round(3).item(), isolator.damping.round(3).item(), isolator.restoring.round(3).item()
    (2.316, 0.212, 2.0)
    """
    amplitude = check_array("displacement", displacement, "must be lengths in m above 0").reshape(
        np.shape(displacement)
    )
    if scene.lubricated:
        raise ValueError("effective_isolator: a lubricated scene has no dry friction; take one that has")
    if not (amplitude > 0.0).all():
        raise ValueError(f"displacement = {quote(displacement)}: must be lengths in m above 0")
    weight, largest, slope = scene.total_mass * GRAVITY, scene.dry_friction.fast, amplitude / scene.radius
    # friction force over weight: elastic, in proportion to the displacement, until it reaches the sliding friction
    friction = np.minimum(largest, scene.dry_friction.stiffness * amplitude / weight)
    # energy lost per cycle over 4 W D: mu (1 - u_y / D), with the yield displacement u_y = mu W / k
    dissipating = largest - largest**2 * weight / (scene.dry_friction.stiffness * amplitude)
    stiffness = weight * (friction + slope) / amplitude
    with np.errstate(divide="ignore", invalid="ignore"):
        return EffectiveIsolator(
            stiffness=stiffness,
            period=2.0 * np.pi * np.sqrt(scene.total_mass / stiffness),
            damping=2.0 / np.pi * np.maximum(dissipating, 0.0) / (friction + slope),
            restoring=slope / largest,
        )
