"""
One short call of the reference before its share of the work begins.

The reference is compiled on its first call on a machine and then kept on disk. One worker does that while the others
are busy with the engine, so that no two of them compile the same code side by side.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import reference
from comparison.runner.task import Task
from comparison.study.batches import Batch
from comparison.study.study import Study
from reference.problem import Scene, load_scene

DURATION = 0.5  # s of motion: enough to reach every function, and over in milliseconds
WARM_UP = "warm-up"  # model of the batch, which belongs to no surface


def warm_up(study: Study) -> Batch:
    """
    One phase pair of the first scene under the exact equations, which no reduction solves without stepping, or under
    the first model. Over so short a time its numbers mean nothing.
    """
    batches = study.batches()
    batch = next((batch for batch in batches if batch.model == "exact"), batches[0])
    scene = batch.scene.with_values({"duration": DURATION})
    return replace(batch, model=WARM_UP, scene=scene, phases=batch.phases[:1])


def compiling_task(stage: str) -> Task:
    """
    A task that compiles the reference, for commands without a study: one phase pair of a built-in scene.

    Parameters
    ----------
    stage : str
        Stage of the task.

    Returns
    -------
    Task
    """
    return Task(
        _first_call,
        load_scene("fig3-I").with_values({"duration": DURATION}),
        stage,
        0.0,
        needs_compiled_reference=False,
    )


def _first_call(scene: Scene) -> None:
    reference.amplification(scene, np.zeros((1, 2)), equations="exact")
