"""
Rough costs, one number for each model and analysis: what `--plan` and the bar of a run start from.

Recorded with version 1.0 on one core of a 2-core AMD EPYC virtual machine; they are within a factor of two or three.
"""

from collections.abc import Mapping

from comparison.study.models import SOFTENED, Model
from comparison.study.study import Study
from reference.problem import Scene

# s of processor time: of a model for a phase pair of a scene of 20 s and two bodies; of an analysis for one scene
SECONDS: Mapping[str, float] = {
    "small": 0.0005,
    "exact": 0.0005,
    "small-resolved": 0.0005,
    "resolved": 0.0005,
    "small-regularised": 0.001,
    "regularised": 0.001,
    "translational": 0.06,
    "spatial": 0.22,
    "effective values": 1.0,
    "scaling": 0.1,
    "conditioning": 4.0,
    "convergence": 1.5,
    "claims": 0.3,
    "assumptions": 5.0,
    "motions": 4.0,
    "worst phases": 2.0,
    "demands": 10.0,
    "measured peaks": 1.0,
    "pictures": 3.0,
    "held-out phases": 3.5,
}
UNKNOWN = 1.0  # s: of a model of the user, and of an analysis that is not listed
COMPILING = 20.0  # s: the reference, on its first call on a machine
STARTING, WRITING = 4.0, 4.0  # s: modules and workers; a report
DURATION, BODIES = 20.0, 2  # of the scenes that the costs of the models were recorded with


def seconds_per_point(scene: Scene, model: Model) -> float:
    """Rough processor time of a phase pair, s."""
    return (
        SECONDS.get(model.key.removeprefix(SOFTENED), UNKNOWN) * scene.duration / DURATION * len(scene.bodies) / BODIES
    )


def seconds_of_model(study: Study, model: Model) -> float:
    """Rough processor time of a model on every scene that it applies to, s."""
    return sum(
        seconds_per_point(scene, model) * len(study.solved(scene, model))
        for scene in study.scenes
        if model.applies(scene)
    )


def seconds_of_analysis(study: Study, key: str, stage: str) -> float:
    """Rough processor time of an analysis of all scenes that have it, s."""
    return SECONDS.get(stage, UNKNOWN) * len(study.selecting(key).scenes)
