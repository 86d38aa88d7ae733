"""
The paper's equations, solved to certified accuracy.

The solver is loaded on first use, so that `import reference.problem`, all that the other side may share, stays
independent of it.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from reference.problem import (
    Amplification,
    Outcome,
    Scene,
    SceneError,
    State,
    Trajectory,
    builtin_scenes,
    example_scenes,
    load_scene,
    phase_grid,
)

if TYPE_CHECKING:
    from reference.motion import trajectory
    from reference.natural_modes import modes
    from reference.surface import amplification

SOLVER = {"amplification": "reference.surface", "modes": "reference.natural_modes", "trajectory": "reference.motion"}

__all__ = [
    "Amplification",
    "Outcome",
    "Scene",
    "SceneError",
    "State",
    "Trajectory",
    "amplification",
    "builtin_scenes",
    "example_scenes",
    "load_scene",
    "modes",
    "phase_grid",
    "trajectory",
]


def __getattr__(name: str) -> Any:
    if name in SOLVER:
        return getattr(import_module(SOLVER[name]), name)
    raise AttributeError(f"module 'reference' has no attribute '{name}'")
