"""
One short call of the reference before its share of the work begins.

The reference is compiled on its first call on a machine and then kept on disk. One worker does that while the others
are busy with the engine, so that no two of them compile the same code side by side.
"""

from __future__ import annotations

import numpy as np

import reference
from comparison.runner.task import Task
from reference.problem import Scene, load_scene

DURATION = 0.5  # s of motion: enough to reach every function, and over in milliseconds
COMPILING = "compiling the reference, once"


def compiling_task() -> Task:
    """One phase pair of a built-in scene."""
    scene = load_scene("fig3-I").with_values({"duration": DURATION})
    return Task(_first_call, scene, COMPILING, 0.0, needs_compiled_reference=False)


def _first_call(scene: Scene) -> None:
    reference.amplification(scene, np.zeros((1, 2)), equations="exact")
