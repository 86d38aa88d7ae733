"""
The paper's equations, solved with an error estimate on every value.

Functions
---------
amplification   factors mu_i of (5.1) for many phase pairs, with errors and outcomes
worst_phases    the largest factor, or displacement, over all phases
trajectory      one motion, sampled in time
peak_demands    what the motions at many phase pairs demand of isolator and structure, with errors
demands         that of one motion
floor_spectra   response spectra of its floors, with errors
effective_isolator  effective period, damping and re-centering ratio of the isolator
factor_for_spectrum  factor of a ground motion for a target spectrum
response_spectrum  pseudo-accelerations of a ground motion
modes           natural frequencies and modes of the frictionless chain (4.8)-(4.11)
damped_modes    complex modes and damping ratios of the chain with the dampers of its links
describe_building  weight, periods, modal damping and peak of the ground of a scene
describe_record  what was read of a recorded motion, with warnings
load_scene      a scene from a built-in name or a TOML file
load_family     all scenes of a file in which values run
builtin_scenes  names of the paper's own cases
example_scenes  names of the examples with a recorded motion
phase_grid      equally spaced phase pairs
sensitivity     derivatives of any of these with respect to values of the scene, with errors
phase_distribution  mean and fractiles of mu over uniform phases, from its surface

Classes
-------
Scene           the system, its loading and the duration
Family          the scenes of one file, and their results as one data set
State           displacement and velocity at the start of a trajectory
Amplification   what `amplification` returns
Building        what `describe_building` returns
Trajectory      what `trajectory` returns
PhaseMaximum    what `worst_phases` returns
Demands         what `demands` returns
PeakDemands     what `peak_demands` returns
Estimates       arrays of numbers and their errors
Sensitivity     what `sensitivity` returns for each key
EffectiveIsolator  what `effective_isolator` returns
FloorSpectra    what `floor_spectra` returns
Estimate        a number and its error
Outcome         how the run of one phase pair ended
SceneError      a scene that cannot be used, in one line

Examples
--------
>>> import reference
>>> scene = reference.load_scene("fig3-I")
>>> result = reference.amplification(scene, [(0.3, 1.1)], tolerance=1e-4)
>>> result.mu.round(2).tolist()
[[1.71, 2.33]]

Notes
-----
A function that takes a scene or a motion raises TypeError, one line that says what to pass, for anything else in its
place. Every other wrong argument is a ValueError in one line.

The solver is loaded when one of its functions is first used: `import reference.problem`, all that `multibody` shares,
does not load it.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from reference.measures import (
    Demands,
    EffectiveIsolator,
    Estimate,
    Estimates,
    FloorSpectra,
    PeakDemands,
    demands,
    effective_isolator,
    factor_for_spectrum,
    floor_spectra,
    phase_distribution,
    response_spectrum,
)
from reference.problem import (
    Amplification,
    Family,
    Outcome,
    Scene,
    SceneError,
    State,
    Trajectory,
    builtin_scenes,
    describe_record,
    example_scenes,
    load_family,
    load_scene,
    phase_grid,
)
from reference.support.version import __version__ as __version__

if TYPE_CHECKING:
    from reference.building import Building, describe_building
    from reference.demand_surface import peak_demands
    from reference.derivatives import Sensitivity, sensitivity
    from reference.motion import trajectory
    from reference.natural_modes import damped_modes, modes
    from reference.phase_maximum import PhaseMaximum, worst_phases
    from reference.surface import amplification

LOADED_ON_FIRST_USE = {  # public names that are imported only when first used, with their modules
    "Building": "reference.building",
    "PhaseMaximum": "reference.phase_maximum",
    "Sensitivity": "reference.derivatives",
    "amplification": "reference.surface",
    "damped_modes": "reference.natural_modes",
    "describe_building": "reference.building",
    "modes": "reference.natural_modes",
    "peak_demands": "reference.demand_surface",
    "sensitivity": "reference.derivatives",
    "trajectory": "reference.motion",
    "worst_phases": "reference.phase_maximum",
}

__all__ = [
    "Amplification",
    "Building",
    "Demands",
    "EffectiveIsolator",
    "Estimate",
    "Estimates",
    "Family",
    "FloorSpectra",
    "Outcome",
    "PeakDemands",
    "PhaseMaximum",
    "Scene",
    "SceneError",
    "Sensitivity",
    "State",
    "Trajectory",
    "amplification",
    "builtin_scenes",
    "damped_modes",
    "demands",
    "describe_building",
    "describe_record",
    "effective_isolator",
    "example_scenes",
    "factor_for_spectrum",
    "floor_spectra",
    "load_family",
    "load_scene",
    "modes",
    "peak_demands",
    "phase_distribution",
    "phase_grid",
    "response_spectrum",
    "sensitivity",
    "trajectory",
    "worst_phases",
]


def __getattr__(name: str) -> Any:
    """Return a public name of the package; its module is imported when the name is first used."""
    if name in LOADED_ON_FIRST_USE:
        return getattr(import_module(LOADED_ON_FIRST_USE[name]), name)
    raise AttributeError(f"module 'reference' has no attribute '{name}'")


def __dir__() -> list[str]:
    """Return the names in the module and the public names that are not imported yet, sorted."""
    return sorted({*globals(), *__all__})
