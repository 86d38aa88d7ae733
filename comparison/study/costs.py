"""
Rough costs: what `--plan` and the bar of a run start from. Every model and every analysis states its own seconds.

Recorded with version 1.0 on one core of a 2-core AMD EPYC virtual machine; they are within a factor of two or three.
"""

from comparison.study.models import Model
from comparison.study.study import Study
from reference.problem import Scene

COMPILING = 20.0  # s: the reference, on its first call on a machine
STARTING, WRITING = 4.0, 4.0  # s: modules and workers; a report
DURATION, BODIES = 20.0, 2  # s and number: the scenes that the seconds of the models are for


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


def seconds_of_analysis(study: Study, key: str, seconds: float) -> float:
    """Rough processor time of an analysis of all scenes that have it, s; seconds: of one scene."""
    return seconds * len(study.selecting(key).scenes)
