"""Effective values of each model, read back from one of its motions and not from its inputs."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Annotated, Any

import numpy as np
import xarray as xr

from comparison.result_types import Number, Radius, Text, result
from comparison.runner.mapped_analysis import MappedAnalysis
from comparison.runner.task_results import TaskResults
from comparison.study.batches import compute_motion
from comparison.study.models import Model, chain_of
from comparison.study.study import Study
from comparison.wording import percent, word_exception
from reference.problem import GRAVITY, Outcome, Scene, Trajectory, ground_acceleration
from reference.problem.friction import LEAST_LOAD

PHASES = (0.3, 1.1)  # rad, phases of the harmonics in the motion from which radius, friction, mass and link are read
DURATION = 6.0  # s, longest motion under two harmonics, strongest in the first seconds; a record is followed to its end
# High-speed friction is not read from a motion so slow that friction changes by at most this share of (fast - slow).
MIN_FRICTION_CHANGE_SHARE = 0.1
MAX_FLAT_SLOPE = 1e-5  # A flat slider may rise by this share of its displacement, as its contacts are elastic.
MEASURED_SPEED_SHARE = 0.9  # Friction is measured while the platform moves faster than this share of its top speed.


@result
class EffectiveModelValues:
    """
    Properties of the structure: those that a scene states, or those that the motion of one model shows.

    A value that cannot be read is null.
    """

    scene: Annotated[Text, "name of the scene"]
    model: Annotated[str, "key of the model, or scene"]
    radius: Annotated[Radius, 'radius of the sphere that the platform moves on, m; "inf" on a plane'] = float("nan")
    friction: Annotated[Number, "coefficient of friction, or s/m in a lubricated scene"] = float("nan")
    contact: Annotated[Number, "contact force at t = 0, N"] = float("nan")
    mass: Annotated[Number, "total mass, kg"] = float("nan")
    acceleration: Annotated[Number, "absolute acceleration of the platform at t = 0, m/s^2"] = float("nan")
    damping: Number = float("nan")
    """coefficient of the damper of the top link along x, N s/m; null without dampers, and where bodies turn"""
    stiffness: Annotated[Number, "of the top link along x, N/m; null where it is not given by bars"] = float("nan")
    error_message: Annotated[Text, "why there are no values, or empty"] = ""


def word_effective(values: Sequence[EffectiveModelValues]) -> str:
    """Return in words how far radius, friction and mass read from motions are at most from those that scenes state."""
    known = {each.scene: each for each in values if each.model == "scene"}
    parts = []
    for name, words in (("radius", "radius"), ("friction", "friction"), ("mass", "total mass")):
        pairs = [(getattr(each, name), getattr(known[each.scene], name)) for each in values if each.model != "scene"]
        apart = [
            abs(found / meant - 1.0) for found, meant in pairs if math.isfinite(found) and meant not in (0.0, math.inf)
        ]
        parts.append(f"{words} {percent(max(apart))}" if apart else f"{words} not compared")
    return f"largest departures from what the scenes state: {', '.join(parts)}"


def read_scene_values(scene: Scene) -> EffectiveModelValues:
    """Return the values that a scene states; contact force and acceleration are those of the first instant, at rest."""
    ground = ground_acceleration(scene, PHASES, [0.0])[0]
    return EffectiveModelValues(
        scene=scene.name,
        model="scene",
        radius=scene.radius,
        friction=scene.dry_friction.fast if scene.dry_friction.varies else scene.friction_coefficient,
        contact=float(scene.total_mass * (GRAVITY + ground[2])),
        mass=scene.total_mass,
        acceleration=float(np.linalg.norm(ground)),
        damping=float(scene.damping[-1, 0]) if scene.damping.any() else float("nan"),
        stiffness=float(scene.stiffness[-1, 0]) if scene.bodies[-1].bars is not None else float("nan"),
    )


def read_values_back(task: tuple[Scene, Model]) -> EffectiveModelValues:
    """Compute a motion by a model and return the values that it shows, or the reason why there are none."""
    scene, model = task
    nothing = EffectiveModelValues(scene.name, model.key)
    lasting = scene.duration if scene.recorded else min(scene.duration, DURATION)
    short = scene.with_values({"duration": lasting})
    try:
        motion = compute_motion(short, model, PHASES)
        ended = {"error_message": f"the motion ended: {motion.status}"}
        return replace(nothing, **(_read_values(short, motion) if motion.status == Outcome.OK else ended))
    except Exception as error:
        return replace(nothing, error_message=word_exception(error))


class EffectiveValues(MappedAnalysis[list[EffectiveModelValues]]):
    """Analysis that reads radius, friction, mass and the top link back from a motion of every model."""

    key, stage, level = "effective", "effective values", 2
    seconds = 1.0
    function = staticmethod(read_values_back)
    without_value = staticmethod(
        lambda task, failed: EffectiveModelValues(task[0].name, task[1].key, error_message=failed.reason)
    )

    def task_arguments(self, study: Study, surfaces: xr.Dataset | None = None) -> list[tuple[Scene, Model]]:
        """Return the pairs of every scene and every model that applies to it."""
        return [(scene, model) for scene in study.scenes for model in chain_of(scene, study.hierarchy)]

    def collect(self, study: Study, surfaces: xr.Dataset | None, results: TaskResults) -> list[EffectiveModelValues]:
        """Return, scene by scene, the values that the scene states, and then those that each model's motion shows."""
        read = self.values(study, surfaces, results)
        of_scenes = (
            [read_scene_values(scene), *(each for each in read if each.scene == scene.name)] for scene in study.scenes
        )
        return [value for values in of_scenes for value in values]


def _read_values(scene: Scene, motion: Trajectory) -> dict[str, Any]:
    """Return the values that a motion shows, by name of the field of `EffectiveModelValues`."""
    # A point at height z of a sphere of radius R is at the distance sqrt(2 R z) from its lowest point. The radius is
    # read where the platform is farthest away, the mass from the contact force before anything moves.
    place = motion.position[:, 0]
    ground = ground_acceleration(scene, PHASES, motion.time)
    swing = (place**2).sum(axis=1)
    far = int(np.argmax(swing))
    radius = float(swing[far] / (2.0 * place[far, 2])) if place[far, 2] > 0.0 else float("nan")
    if scene.flat and abs(place[far, 2]) <= MAX_FLAT_SLOPE * float(np.hypot(*place[far, :2])):
        radius = float("inf")
    return {
        "radius": radius,
        "friction": _measure_friction(scene, motion, radius),
        "contact": float(motion.contact_force[0]),
        "mass": float(motion.contact_force[0] / (GRAVITY + ground[0, 2])),
        "acceleration": float(np.linalg.norm(motion.absolute_acceleration[0, 0])),
        **_fit_top_link(scene, motion),
    }


def _fit_top_link(scene: Scene, motion: Trajectory) -> dict[str, float]:
    """
    Return stiffness and damping of the link below the top body, fitted by least squares to the force on that body.

    Where bodies rotate, the force acts half-way up the link and leans with its bars. The mean of both rotations is
    their lean: it takes no part in the stretch, and gives the weight a part along x.
    """
    turning, damped = "turns" in motion.extra, bool(scene.damping.any())
    barred = scene.bodies[-1].bars is not None and not (scene.offsets.any() or scene.yaws.any())
    if not barred and (turning or not damped):
        return {}
    stretch, rate = (part[:, -1, 0] - part[:, -2, 0] for part in (motion.position, motion.velocity))
    force = -scene.masses[-1] * motion.absolute_acceleration[:, -1, 0]
    if turning:
        lower, upper = scene.bodies[-2].height, scene.bodies[-1].height
        assert lower is not None
        assert upper is not None
        lean = motion.extra["turns"][:, -2:, 1].mean(axis=1)
        stretch = stretch - (upper - lower) * lean
        force = force + scene.masses[-1] * (GRAVITY + motion.absolute_acceleration[:, -1, 2]) * lean
        rate = np.gradient(stretch, motion.time)
    columns = [stretch, rate] if damped else [stretch]
    factors, _, rank, _ = np.linalg.lstsq(np.column_stack(columns), force)
    if rank < len(columns):
        return {}
    read = {"stiffness": float(factors[0])} if barred else {}
    return read | ({"damping": float(factors[1])} if damped and not turning else {})


def _measure_friction(scene: Scene, motion: Trajectory, radius: float) -> float:
    """
    Return the friction coefficient: the median ratio of tangential to normal contact force while the platform is fast.

    It is NaN where heat changes the friction. In a lubricated scene it is divided by the speed, s/m.
    """
    if np.isnan(radius) or scene.dry_friction.heat is not None:
        return float("nan")
    # The contact carries what accelerates all bodies and their weight, `force`, (instants, x y z).
    force = np.einsum("i,tik->tk", scene.masses, motion.absolute_acceleration)
    force[:, 2] += scene.total_mass * GRAVITY
    if radius == np.inf:
        normal = np.broadcast_to([0.0, 0.0, 1.0], motion.position[:, 0].shape)
    else:
        normal = np.array([0.0, 0.0, radius]) - motion.position[:, 0]
        normal = normal / np.linalg.norm(normal, axis=1)[:, None]
    along = np.einsum("tk,tk->t", force, normal)
    across = np.linalg.norm(force - along[:, None] * normal, axis=1)
    speed = np.linalg.norm(motion.velocity[:, 0], axis=1)
    fast = speed > MEASURED_SPEED_SHARE * speed.max()
    ratio = across[fast] / along[fast]
    law = scene.dry_friction
    if law.exponent:  # Friction depends on the contact force: convert the ratio to a contact force equal to the weight.
        ratio /= np.maximum(along[fast] / (scene.total_mass * GRAVITY), LEAST_LOAD) ** law.exponent
    if law.varies:
        share = -np.expm1(-law.rate * speed[fast])  # (friction at this speed - slow value) / (fast - slow value)
        if not share.min() > MIN_FRICTION_CHANGE_SHARE:
            return float("nan")
        ratio = law.slow + (ratio - law.slow) / share
    return float(np.median(ratio / speed[fast] if scene.lubricated else ratio))
