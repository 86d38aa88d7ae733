"""All that a study computes beside its surfaces, as tasks for the workers, with what each is predicted to cost."""

from __future__ import annotations

import xarray as xr

from comparison.analysis.assumptions.variations import variation_arguments, varied
from comparison.analysis.claims.claims import CLAIMS
from comparison.analysis.claims.evidence import gathered
from comparison.analysis.claims.readings import READINGS
from comparison.analysis.claims.table import GRID, SECONDS, questions
from comparison.analysis.convergence import LIMITS, convergence_arguments, limit_trends
from comparison.analysis.effective import effective_arguments, read_back
from comparison.analysis.errata import errata_arguments, measured
from comparison.analysis.scaling import scaling_arguments, scene_trends
from comparison.analysis.trajectories import SPREAD, motion_arguments, moved, shown_models
from comparison.execution.task import Task
from comparison.study.models import Model, at_samples
from comparison.study.selection import EVERYTHING, Selection
from comparison.study.study import Study
from reference.problem import Scene, builtin_scenes

# s of one task, recorded on `study.models.RECORDED_ON` for the built-in scenes
EFFECTIVE = {"reference": 0.02, "engine": 0.2}
ERRATUM, SCALING = 0.35, 0.12
VARIATION = {"translational": 0.5, "spatial": 1.1}
MOTION = {"reference": 0.11, "engine": 0.55}
PICTURE, PAPER = 0.5, 1.0  # of two models or a budget; in the manner of the paper


def analysis_tasks(study: Study, selection: Selection = EVERYTHING) -> list[Task]:
    """What the selected analyses compute without knowing the surfaces."""
    tasks = [
        Task("effective values", read_back, (scene, model), EFFECTIVE[model.side] * at_samples(scene), scene)
        for scene, model in effective_arguments(selection.study(study, "effective"))
    ]
    tasks += [
        Task("errata", measured, argument, ERRATUM, argument[0])
        for argument in errata_arguments(selection.study(study, "errata"))
    ]
    tasks += [
        Task("scaling test", scene_trends, argument, SCALING, argument[0])
        for argument in scaling_arguments(selection.study(study, "scaling"))
    ]
    tasks += [
        Task("convergence", limit_trends, (scene, number), LIMITS[number].seconds, scene)
        for scene, number in convergence_arguments(selection.study(study, "convergence"))
    ]
    if paper_complete(selection.study(study, "claims")):
        tasks += [Task("claims", gathered, question, SECONDS) for question in questions(READINGS, CLAIMS, GRID)]
    for argument in variation_arguments(selection.study(study, "assumptions")):
        seconds = VARIATION["translational" if argument[2] is None else "spatial"]
        tasks.append(Task("assumptions", varied, argument, seconds, argument[0], compiled=False))
    return tasks


def predicted(study: Study, selection: Selection = EVERYTHING) -> dict[str, tuple[int, float]]:
    """
    Tasks and s on one core of all that is computed beside the surfaces, by stage.

    Motions and pictures are counted before the surfaces are known that choose them.
    """
    tasks = analysis_tasks(study, selection)
    costs = {}
    for stage in dict.fromkeys(task.stage for task in tasks):
        seconds = [task.seconds for task in tasks if task.stage == stage]
        costs[stage] = len(seconds), sum(seconds)
    motions = [
        MOTION[model.side] * at_samples(scene)
        for scene in selection.study(study, "trajectories").scenes
        for model in _moving(study, scene)
    ]
    pictures = []
    for scene in study.phased:
        if selection.has("surfaces", scene.name):
            pictures += [PAPER, *(PICTURE,) * len(scene.bodies) * len(study.pairs(scene))]
        if selection.has("budget", scene.name):
            pictures += [PICTURE] * len(scene.bodies)
    return costs | {"motions": (len(motions), sum(motions)), "pictures": (len(pictures), sum(pictures))}


def analysis_cost(study: Study, selection: Selection = EVERYTHING) -> float:
    """s on one core of all that is computed beside the surfaces."""
    return sum(seconds for _, seconds in predicted(study, selection).values())


def _moving(study: Study, scene: Scene) -> list[Model]:
    """The models of the motions: all where a difference is largest; at evenly spread phases those that have all."""
    shown = shown_models(study, scene)
    if scene.recorded:
        return shown
    return [
        *(model for model in shown for _ in scene.bodies),
        *(model for model in shown for _ in range(SPREAD) if study.strides[model.key] == 1),
    ]


def motion_tasks(study: Study, surfaces: xr.Dataset) -> list[Task]:
    """The motions kept for the report, which are chosen by what the surfaces show."""
    return [
        Task("motions", moved, task, MOTION[task[1].side] * at_samples(task[0]), task[0])
        for task in motion_arguments(study, surfaces)
    ]


def paper_complete(study: Study) -> bool:
    """Whether the study has every scene of the paper, whose claims speak about all of them."""
    return {scene.name for scene in study.scenes} >= set(builtin_scenes())
