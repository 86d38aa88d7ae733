"""
Rough costs: what `--plan` and the bar of a run start from. Every model and every analysis states its own seconds.

Recorded on one core of a 2-core AMD EPYC virtual machine. Those of a surface are within a factor of two or three, those
of a motion mostly within 1.5.
"""

from collections.abc import Sequence

import numpy as np

from comparison.study.models import Model
from comparison.study.study import Study
from reference.problem import Scene

COMPILING = 20.0  # s: the reference, on its first call on a machine
STARTING, WRITING = 4.0, 4.0  # s: modules and workers; a report
DURATION, BODIES = 20.0, 2  # s and number: the scenes that the seconds of the models are for
# s of processor time of a motion to its end. By the equations once, for a second of the motion and for a knot of its
# record, these of every body and once more; by the engine for a radian of the fastest link, in space for every body.
MOTION, MOTION_SECOND, MOTION_KNOT = 0.02, 4e-4, 3.7e-6
MOTION_RADIAN, SPATIAL_RADIAN = 8e-4, 1.25e-3
SLOWEST = 7.0  # rad/s: of a motion without a faster link


def seconds_per_motion(scene: Scene, model: Model) -> float:
    """Rough processor time of one motion to its end, s."""
    bodies, knots = len(scene.bodies), len(scene.record)
    if model.side == "reference":
        return MOTION + (bodies + 1) * (MOTION_SECOND * scene.duration + MOTION_KNOT * knots)
    softness = 1.0 / scene.masses[:-1, None] + 1.0 / scene.masses[1:, None]
    radians = scene.duration * max(SLOWEST, float(np.sqrt(scene.stiffness * softness).max(initial=0.0)))
    return radians * (SPATIAL_RADIAN * bodies if model.is_spatial else MOTION_RADIAN)


def wall_seconds(seconds: Sequence[float], jobs: int) -> float:
    """Rough time of tasks of so much processor time on idle cores, s: one task is not shared by workers."""
    return max(sum(seconds) / jobs, max(seconds, default=0.0))


def seconds_per_point(scene: Scene, model: Model) -> float:
    """Rough processor time of a phase pair, s."""
    return model.seconds * scene.duration / DURATION * len(scene.bodies) / BODIES


def seconds_of_model(study: Study, model: Model) -> float:
    """Rough processor time of a model on every scene that it applies to, s."""
    return sum(
        seconds_per_point(scene, model) * len(study.solved(scene, model))
        for scene in study.scenes
        if model.applies(scene)
    )
