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
USUAL_DURATION, USUAL_BODIES = 20.0, 2  # s of motion and number of bodies for which Model.seconds is stated
# Estimated processor time, s, of one motion computed by the reference: a constant part; then, both times the number of
# bodies + 1, the parts per second of motion and per sample of the record.
MOTION_COST, MOTION_SECOND_COST, MOTION_KNOT_COST = 0.02, 4e-4, 3.7e-6
# Estimated processor time, s, of Exudyn per radian that the fastest link vibrates; of the spatial model, also per body.
MOTION_RADIAN_COST, SPATIAL_RADIAN_COST = 8e-4, 1.25e-3
DEFAULT_FREQUENCY = 7.0  # rad/s, lower bound on the frequency of the fastest link in the estimate


def estimate_motion_seconds(scene: Scene, model: Model) -> float:
    """Return the rough processor time of one motion to its end, s."""
    bodies, knots = len(scene.bodies), len(scene.record)
    if model.side == "reference":
        return MOTION_COST + (bodies + 1) * (MOTION_SECOND_COST * scene.duration + MOTION_KNOT_COST * knots)
    softness = 1.0 / scene.masses[:-1, None] + 1.0 / scene.masses[1:, None]
    radians = scene.duration * max(DEFAULT_FREQUENCY, float(np.sqrt(scene.stiffness * softness).max(initial=0.0)))
    return radians * (SPATIAL_RADIAN_COST * bodies if model.is_spatial else MOTION_RADIAN_COST)


def estimate_wall_seconds(seconds: Sequence[float], jobs: int) -> float:
    """Return the rough elapsed time, s, of tasks on `jobs` idle cores; seconds: processor time of each, never split."""
    return max(sum(seconds) / jobs, max(seconds, default=0.0))


def estimate_point_seconds(scene: Scene, model: Model) -> float:
    """Return the rough processor time, s, that a model needs for one phase pair of a scene."""
    return model.seconds * scene.duration / USUAL_DURATION * len(scene.bodies) / USUAL_BODIES


def estimate_model_seconds(study: Study, model: Model) -> float:
    """Return the rough processor time of a model on every scene that it applies to, s."""
    return sum(
        estimate_point_seconds(scene, model) * len(study.solved(scene, model))
        for scene in study.scenes
        if model.applies(scene)
    )
