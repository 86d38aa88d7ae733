"""All that a study computes beside its surfaces, as errands for the workers, with what each is predicted to cost."""

from __future__ import annotations

import xarray as xr

from comparison.analysis.assumptions.variations import variation_tasks, varied
from comparison.analysis.claims.claims import CLAIMS
from comparison.analysis.claims.evidence import gathered
from comparison.analysis.claims.readings import READINGS
from comparison.analysis.claims.table import GRID, SECONDS, questions
from comparison.analysis.convergence import LIMITS, convergence_tasks, limit_trends
from comparison.analysis.effective import effective_tasks, read_back
from comparison.analysis.errata import measured, slip_tasks
from comparison.analysis.scaling import scaling_tasks, scene_trends
from comparison.analysis.trajectories import SPREAD, motion_tasks, moved, shown_rungs
from comparison.execution.task import Errand
from comparison.study.models import Rung, at_samples
from comparison.study.study import Study
from reference.problem import Scene, builtin_scenes

# s of one task, recorded on `study.models.RECORDED_ON` for the built-in scenes
EFFECTIVE = {"reference": 0.02, "engine": 0.2}
SLIP, SCALING = 0.35, 0.12
CONVERGENCE = dict(zip((limit.what for limit in LIMITS), (0.13, 0.14, 0.7, 4.0, 2.1)))
VARIATION = {"translational": 0.5, "spatial": 1.1}
MOTION = {"reference": 0.11, "engine": 0.55}
PICTURE, PAPER = 0.5, 1.0  # of two models or a budget; in the manner of the paper


def errands(study: Study, whole: bool = True) -> list[Errand]:
    """What can be computed without knowing the surfaces; not `whole`: only what every report needs."""
    found = [
        Errand("effective values", read_back, (scene, rung), EFFECTIVE[rung.side] * at_samples(scene), scene)
        for scene, rung in effective_tasks(study)
    ]
    found += [Errand("slips", measured, task, SLIP, task[0]) for task in slip_tasks(study)]
    if not whole:
        return found
    found += [Errand("scaling test", scene_trends, task, SCALING, task[0]) for task in scaling_tasks(study)]
    for scene, number in convergence_tasks(study):
        found.append(Errand("convergence", limit_trends, (scene, number), LIMITS[number].seconds, scene))
    if paper_complete(study):
        found += [Errand("claims", gathered, question, SECONDS) for question in questions(READINGS, CLAIMS, GRID)]
    for task in variation_tasks(study):
        seconds = VARIATION["translational" if task[2] is None else "spatial"]
        found.append(Errand("assumptions", varied, task, seconds, task[0], compiled=False))
    return found


def predicted(study: Study, whole: bool = True) -> dict[str, tuple[int, float]]:
    """
    Tasks and s on one core of all that is computed beside the surfaces, by stage.

    Motions and pictures are counted before the surfaces are known that choose them.
    """
    known = errands(study, whole)
    found = {}
    for name in dict.fromkeys(errand.stage for errand in known):
        own = [errand.seconds for errand in known if errand.stage == name]
        found[name] = len(own), sum(own)
    motions = [
        MOTION[rung.side] * at_samples(scene)
        for scene in study.scenes
        for rung in (_moving(study, scene) if whole else ())
    ]
    drawn = [
        seconds
        for scene in study.phased
        for seconds in (PAPER, *(PICTURE,) * len(scene.bodies) * (1 + len(study.pairs(scene))))
    ]
    return found | {"motions": (len(motions), sum(motions)), "pictures": (len(drawn), sum(drawn))}


def seconds_beside(study: Study, whole: bool) -> float:
    """s on one core of all that is computed beside the surfaces."""
    return sum(seconds for _, seconds in predicted(study, whole).values())


def _moving(study: Study, scene: Scene) -> list[Rung]:
    """The models of the motions: all where a difference is largest; at evenly spread phases those that have all."""
    shown = shown_rungs(study, scene)
    if scene.recorded:
        return shown
    return [
        *(rung for rung in shown for _ in scene.bodies),
        *(rung for rung in shown for _ in range(SPREAD) if study.strides[rung.key] == 1),
    ]


def motion_errands(study: Study, surfaces: xr.Dataset) -> list[Errand]:
    """The motions kept for the report, which are chosen by what the surfaces show."""
    return [
        Errand("motions", moved, task, MOTION[task[1].side] * at_samples(task[0]), task[0])
        for task in motion_tasks(study, surfaces)
    ]


def paper_complete(study: Study) -> bool:
    """Whether the study has every scene of the paper, whose claims speak about all of them."""
    return {scene.name for scene in study.scenes} >= set(builtin_scenes())
