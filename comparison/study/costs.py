"""
Rough costs, from which `--plan` and the bar of a run start; every model and every analysis states its own seconds.

Recorded on one core of a 2-core AMD EPYC virtual machine. Those of a surface are within a factor of two or three, those
of a motion mostly within 1.5.
"""

from collections.abc import Sequence

import numpy as np

from comparison.study.models import Model
from comparison.study.study import Study
from reference.problem import Scene

COMPILING_SECONDS = 20.0  # s, time that compiling the reference takes, at its first call on a machine
STARTING_SECONDS, WRITING_SECONDS = 4.0, 4.0  # s, durations of loading modules and workers, and of writing a report
# Duration, s, and bodies of a scene whose phase pair takes `Model.seconds` of processor time; others in proportion.
USUAL_DURATION, USUAL_BODIES = 20.0, 2
# Estimated processor time, s, of one motion computed by the reference. It has a constant part, a part per second of
# motion and a part per sample of the record; the latter two are multiplied by the number of bodies + 1.
MOTION_COST, MOTION_SECOND_COST, MOTION_KNOT_COST = 0.02, 4e-4, 3.7e-6
# Processor time, s, of Exudyn per radian that the link of highest frequency vibrates; if bodies rotate, also per body.
MOTION_RADIAN_COST, SPATIAL_RADIAN_COST = 8e-4, 1.25e-3
DEFAULT_FREQUENCY = 7.0  # rad/s, used to estimate processor time if every link between bodies vibrates more slowly


def estimate_motion_seconds(scene: Scene, model: Model) -> float:
    """Return the rough processor time, s, for computing one motion over the whole duration of its scene."""
    bodies, knots = len(scene.bodies), len(scene.record)
    if model.side == "reference":
        return MOTION_COST + (bodies + 1) * (MOTION_SECOND_COST * scene.duration + MOTION_KNOT_COST * knots)
    softness = 1.0 / scene.masses[:-1, None] + 1.0 / scene.masses[1:, None]
    radians = scene.duration * max(DEFAULT_FREQUENCY, float(np.sqrt(scene.stiffness * softness).max(initial=0.0)))
    return radians * (SPATIAL_RADIAN_COST * bodies if model.is_spatial else MOTION_RADIAN_COST)


def estimate_wall_seconds(seconds: Sequence[float], jobs: int) -> float:
    """Return the rough elapsed time, s, of tasks on `jobs` idle cores; seconds: processor time of each, never split."""
    return max(sum(seconds) / jobs, max(seconds, default=0.0))


def scale_seconds(seconds: float, scene: Scene) -> float:
    """Return the rough processor time, s, of a phase pair of `scene` that takes `seconds` in the usual scene."""
    return seconds * scene.duration / USUAL_DURATION * len(scene.bodies) / USUAL_BODIES


def estimate_point_seconds(scene: Scene, model: Model) -> float:
    """Return the rough processor time, s, that a model needs for one phase pair of a scene."""
    return scale_seconds(model.seconds, scene)


def estimate_model_seconds(study: Study, model: Model) -> float:
    """Return the rough processor time of a model on every scene that it applies to, s."""
    return sum(
        estimate_point_seconds(scene, model) * len(study.solved(scene, model))
        for scene in study.scenes
        if model.applies(scene)
    )
