"""
Parts of the computation that a scene does not need, with the reason, decided from the scene alone.

Each reduction is exact: a phase pair has the same amplification with and without it, within the errors. The equations,
the engine and the study ask here and nowhere else; with `full=True` (`--full`) they do not ask and compute everything.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from reference.problem.excitation import exponents
from reference.problem.scene import Scene
from reference.support.constants import GRAVITY

# Largest angle, rad, through which the fastest vibration runs in a motion that is computed as a sum of harmonics; a
# motion with a larger one is integrated in time steps
MAX_VIBRATION_ANGLE = 2e5
RECORDED_REASON = "a recorded motion: no harmonics, no phases"  # why a record permits no symmetry, plane or linear sum

MAX_TURNABLE_ACCELERATION = 1e300  # m/s^2: larger amplitudes may overflow when turned about the vertical
# Safety factor on the distance by which friction shifts the supports' center of force. The distance is computed as if
# all contacts were level, which they are not on a displaced platform.
LOAD_SHIFT_FACTOR = 2.0


@dataclass(frozen=True)
class Reduction:
    """Decision on leaving out a part of a scene's computation, with the reason; true if the scene permits it."""

    allowed: bool
    reason: str

    def __bool__(self) -> bool:
        """Return True if the part of the computation may be left out."""
        return self.allowed


def has_half_turn_symmetry(scene: Scene) -> Reduction:
    """Find whether adding pi to both phases turns the motion by half a turn, which keeps every amplification."""
    if scene.recorded:
        return Reduction(False, RECORDED_REASON)
    if scene.amplitudes[2].any():
        return Reduction(False, "vertical loading: every phase pair is its own")
    return Reduction(True, "no vertical loading: adding pi to both phases turns the motion by half a turn")


def has_one_axis_per_harmonic(scene: Scene) -> Reduction:
    """Find whether adding pi to either phase alone mirrors the motion, with the same amplification mu."""
    if not has_half_turn_symmetry(scene):
        return has_half_turn_symmetry(scene)
    used = scene.amplitudes[:2] != 0.0
    if (used.sum(axis=0) <= 1).all() and (used.sum(axis=1) <= 1).all():
        return Reduction(
            True, "each harmonic has its own axis and none is vertical: adding pi to either phase mirrors the motion"
        )
    return Reduction(False, "a harmonic acts along both axes, or both along one")


def body_cannot_tilt(scene: Scene) -> Reduction:
    """
    Find whether the spatial model is a single body that cannot rotate.

    The engine's translational model, whose bodies do not rotate, then gives its motion.
    """
    # All contact forces on a body that does not turn are parallel, so a single body is in balance with them at unequal
    # shares. If its center of mass is level with the depressions' centers, friction moves the supports' center of force
    # off the axis by at most its coefficient times the depressions' radius. It must stay inside the ring of supports.
    # The weight of a second body shifts with its displacement across the direction of sliding, and turns the platform.
    isolator = scene.isolator
    if scene.support_places is None or isolator.sphere_radius is None:
        return Reduction(False, "no supports are stated")
    if not isinstance(isolator.supports, int) or scene.offsets.any():
        return Reduction(False, "supports or centers of mass at stated places: uneven loads may tilt the platform")
    assert isolator.ring is not None
    if len(scene.bodies) > 1:
        return Reduction(False, "bodies above the platform: their weight shifts, tilts and twists it")
    if scene.flat:
        return Reduction(False, "a flat slider: its weight shifts over the supports as far as it moves")
    if scene.bodies[0].height != 0.0 or scene.bodies[0].size is None:
        return Reduction(False, "a body above the depressions: inertia shifts the supports' load")
    if isolator.support_stiffness is not None:
        return Reduction(False, "supports that give way: unequal loads tilt the platform")
    if scene.friction_coefficient > 0.0:
        if scene.lubricated:
            return Reduction(False, "lubricated: the friction that shifts the supports' load has no limit")
        if scene.dry_friction.depends_on_load:
            return Reduction(False, "friction that depends on the load: unequal loads twist the platform")
        shift = scene.friction_coefficient * (scene.radius + isolator.sphere_radius)
        if not LOAD_SHIFT_FACTOR * shift <= isolator.ring * math.cos(math.pi / isolator.supports):
            return Reduction(False, "a narrow ring: friction may lift the platform off a support")
    return Reduction(True, "one body, its center level with the depressions: it does not turn")


def is_planar(scene: Scene) -> Reduction:
    """
    Find whether the motion stays in one vertical plane (4.7).

    Half of the coordinates are then enough, after `turn_loading_to_x`.
    """
    if scene.recorded:
        return Reduction(False, RECORDED_REASON)
    x, y = scene.amplitudes[:2]
    if not np.abs(scene.amplitudes).max() < MAX_TURNABLE_ACCELERATION:
        return Reduction(False, "loads that may overflow when turned")
    if not (x.any() and y.any()):
        return Reduction(True, "loading along one axis: the motion stays in its plane")
    if (np.divide(x, np.abs(x).max()) * y[::-1] @ [1.0, -1.0]) != 0.0:  # x1 y2 - x2 y1: cross product of the harmonics
        return Reduction(False, "the harmonics act in different directions")
    if (scene.stiffness[:, 0] != scene.stiffness[:, 1]).any():
        return Reduction(False, "loading across links that are not equally stiff in x and y")
    if (scene.damping[:, 0] != scene.damping[:, 1]).any():
        return Reduction(False, "loading across links that are not equally damped in x and y")
    return Reduction(
        True, "(4.7): one direction of loading, links equally stiff and damped in x and y: the motion stays in a plane"
    )


def has_planar_chain(scene: Scene) -> Reduction:
    """Find whether the bodies above the platform need no coordinates normal to the vertical plane of motion."""
    if len(scene.bodies) == 1:
        return Reduction(False, "one body: none above it whose coordinates could be left out")
    return is_planar(scene)


def turn_loading_to_x(scene: Scene) -> Scene:
    """
    Return a scene of planar motion, turned about the vertical so that its loading acts along x.

    The amplification of every body stays the same.
    """
    table = scene.model_dump(exclude_none=True)
    horizontal = scene.amplitudes[:2]
    if not horizontal[0].any():  # the loading acts along y: what links have along y becomes theirs along x
        for body in table["bodies"][1:]:
            for key in ("period", "stiffness", "damping"):  # bars and damping ratios are the same along x and y
                if isinstance(body.get(key), list):
                    body[key] = body[key][::-1]
    direction = horizontal[:, np.abs(horizontal).sum(axis=0).argmax()]
    length = float(np.hypot(*direction))
    along = direction @ horizontal / length if length > 0.0 else np.zeros(2)
    table["excitation"].pop("scale", None)  # the amplitudes include the scale
    table["excitation"]["amplitudes"] = [along.tolist(), [0.0, 0.0], scene.amplitudes[2].tolist()]
    return Scene.model_validate(table)


def is_mirror_symmetric(scene: Scene) -> Reduction:
    """
    Find whether supports and bodies are mirror images of themselves about the axes x and y.

    Only then does a symmetry of the loading over the phases hold for the amplifications in the spatial model, too.
    """
    supports = scene.isolator.supports or 0
    if scene.offsets.any():
        return Reduction(False, "a center of mass off the axis: mirrored, it is another one")
    if scene.yaws.any():
        return Reduction(False, "a body or link at an angle to the axes: mirrored, it is another one")
    if isinstance(supports, list):
        places = {(x, y) for x, y in supports}
        if not all({(sx * x, sy * y) for x, y in places} == places for sx, sy in ((-1.0, 1.0), (1.0, -1.0))):
            return Reduction(False, "supports at positions that are no mirror images of themselves about both axes")
        return Reduction(True, "positions of supports that are mirror images of themselves, boxes centered above them")
    if supports % 2 or supports == 0:
        return Reduction(False, "an odd number of supports: a turned or mirrored ring is another one")
    return Reduction(
        True, "an even number of supports on a ring, boxes centered above it: both are mirror images of themselves"
    )


def find_unused_harmonics(scene: Scene) -> list[int]:
    """Return the indices (0: first, 1: second) of harmonics without amplitudes, whose phases change nothing."""
    if scene.recorded:
        return [0, 1]
    return [int(harmonic) for harmonic in np.flatnonzero(~scene.amplitudes.any(axis=0))]


def has_no_friction_law(scene: Scene) -> Reduction:
    """Find whether a scene has no friction, so that it makes no difference whether a model regularizes friction."""
    if scene.friction_coefficient > 0.0:
        return Reduction(False, "friction")
    return Reduction(True, "no friction: without it v_reg and v_c change nothing")


def is_linear(scene: Scene) -> Reduction:
    """
    Find whether the equations for small displacements (4.3)-(4.4) are linear.

    The motion is then the sum of the motions that each harmonic causes alone.
    """
    # Lubrication is not linear: its main force f_c v is, but (4.3) also keeps a product of displacement and velocity.
    if scene.lubricated and scene.friction_coefficient > 0.0:
        return Reduction(False, "lubricated: (4.3) keeps friction terms with xi'' x1 x1', which are not linear")
    if scene.friction_coefficient > 0.0:
        return Reduction(False, "dry friction is not linear")
    if scene.damping.any():
        return Reduction(False, "damped links: the sum is one of undamped modes")
    if scene.recorded:
        return Reduction(False, RECORDED_REASON)
    if scene.amplitudes[2].any():
        return Reduction(False, "vertical loading: it is no part of the sum and varies the pendulum's stiffness")
    if not bound_fastest_rate(scene) * scene.duration <= MAX_VIBRATION_ANGLE:
        return Reduction(False, f"more than {MAX_VIBRATION_ANGLE:g} rad of the fastest vibration: cheaper to step over")
    return Reduction(True, "no friction, no vertical loading: the small equations are linear, the surface is a sum")


def bound_fastest_rate(scene: Scene) -> float:
    """Return an upper bound, rad/s, on angular frequencies and decay rates in the equations for small displacements."""
    below = np.vstack([np.full((1, 2), scene.total_mass * GRAVITY / scene.radius), scene.stiffness])
    above = np.vstack([scene.stiffness, np.zeros((1, 2))])
    natural = math.sqrt(float((2.0 * (below + above) / scene.masses[:, None]).max()))  # bound by Gershgorin's circles
    load = exponents(scene)
    return max(natural, float(load.imag.max()), float(-load.real.min()))
