"""
Dynamic amplification by a multibody engine, with rigid bodies, springs and a compliant contact with friction.

Functions
---------
amplification   factors mu_i of (5.1) for many phase pairs, with errors and outcomes
trajectory      one motion to a tolerance
single_run      one run at a level of accuracy or at a constant step, without an error estimate
peak_demands    peak demands on isolator and structure at many phase pairs, with errors
demands         peak demands of one motion, with errors
floor_spectra   response spectra of the floors in one motion, with errors
levels          the levels of accuracy that `amplification` goes through
refusal         why a model is refused for a scene, or ""

Classes
-------
Level           one level of accuracy: step, contact, tolerances

Constants
---------
MAX_WORK        default limit of the engine's steps for a phase pair

Examples
--------
>>> import multibody, reference
>>> scene = reference.load_scene("fig3-I").with_values({"duration": 1.0})
>>> str(multibody.amplification(scene, [(0.3, 1.1)]).status[0])
'ok'

Notes
-----
A function that takes a scene or a motion raises TypeError, one line that says what to pass, for anything else in its
place. Every other wrong argument is a ValueError in one line.

The engine is loaded on first use, so that a command can be stopped while it loads.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from multibody.demand_surface import peak_demands
    from multibody.integration.level import Level, levels
    from multibody.integration.refine import MAX_WORK
    from multibody.integration.work_limit import refusal
    from multibody.motion import single_run, trajectory
    from multibody.surface import amplification
    from reference.measures import demands, floor_spectra

_MODULE_OF_NAME = {  # module from which each public name is imported when it is first used
    "MAX_WORK": "multibody.integration.refine",
    "Level": "multibody.integration.level",
    "amplification": "multibody.surface",
    "demands": "reference.measures",
    "floor_spectra": "reference.measures",
    "levels": "multibody.integration.level",
    "peak_demands": "multibody.demand_surface",
    "refusal": "multibody.integration.work_limit",
    "single_run": "multibody.motion",
    "trajectory": "multibody.motion",
}

__all__ = [
    "MAX_WORK",
    "Level",
    "amplification",
    "demands",
    "floor_spectra",
    "levels",
    "peak_demands",
    "refusal",
    "single_run",
    "trajectory",
]


def __getattr__(name: str) -> Any:
    """Return a public name of the package; its module is imported when the name is first used."""
    if name in _MODULE_OF_NAME:
        return getattr(import_module(_MODULE_OF_NAME[name]), name)
    raise AttributeError(f"module 'multibody' has no attribute '{name}'")


def __dir__() -> list[str]:
    """Return the names in the module and the public names that are not imported yet, sorted."""
    return sorted({*globals(), *__all__})
