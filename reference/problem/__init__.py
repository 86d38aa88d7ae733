"""
The question that both sides answer: scene, loading, measured quantity (5.1).

Functions
---------
load_scene, parse_scene, load_family                            scenes from a name, a file or a text
builtin_scenes, example_scenes                                  names of the scenes that are shipped
ground_acceleration, ground_velocity, ground_displacement       motion of the ground (5.2)-(5.4)
exponents, loading_period                                       of the loading
ground_peak                                                     denominator of (5.1)
demands, floor_spectra, phase_distribution                      those of `reference.measures`
checked_phase, checked_phases, flat_phases, phase_axis,
phase_grid                                                      phase pairs
half_turn, own_axes, planar, planar_chain, linear, no_friction,
untilted, mirror_symmetric, unused_harmonics, in_plane          what a scene does not require
verbatim                                                        a text of a scene for matplotlib (`reference.drawing`)

Classes
-------
Scene, Family                       the system with its loading; the scenes of one file
State, Amplification, Trajectory    arguments and results of both sides
Demands, PeakDemands, FloorSpectra,
PhaseDistribution                   those of `reference.measures`
DryFriction                         coefficient of friction over the slip speed
Estimate, Estimates, Accuracy       a number with its error; what errors are made from
Outcome, Reduction, SceneError      why a point has no answer; why work is left out; what is wrong with a scene

Constants
---------
GRAVITY    9.81 m/s^2, the paper's value (section 5)
ADVICE     what to try, for every `Outcome`
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from reference.drawing import verbatim
from reference.problem.constants import GRAVITY
from reference.problem.definition import ground_peak
from reference.problem.excitation import (
    exponents,
    ground_acceleration,
    ground_displacement,
    ground_velocity,
    loading_period,
)
from reference.problem.families import Family, load_family
from reference.problem.friction import DryFriction
from reference.problem.outcome import ADVICE, Outcome
from reference.problem.phases import checked_phase, checked_phases, flat_phases, phase_axis, phase_grid
from reference.problem.reductions import (
    Reduction,
    half_turn,
    in_plane,
    linear,
    mirror_symmetric,
    no_friction,
    own_axes,
    planar,
    planar_chain,
    untilted,
    unused_harmonics,
)
from reference.problem.result import Accuracy, Amplification, State, Trajectory
from reference.problem.scene import Scene
from reference.problem.scene_error import SceneError
from reference.problem.scene_file import builtin_scenes, example_scenes, load_scene, parse_scene

if TYPE_CHECKING:
    from reference.measures import (
        Demands,
        Estimate,
        Estimates,
        FloorSpectra,
        PeakDemands,
        PhaseDistribution,
        demands,
        floor_spectra,
        phase_distribution,
    )

__all__ = [
    "ADVICE",
    "GRAVITY",
    "Accuracy",
    "Amplification",
    "Demands",
    "DryFriction",
    "Estimate",
    "Estimates",
    "Family",
    "FloorSpectra",
    "Outcome",
    "PeakDemands",
    "PhaseDistribution",
    "Reduction",
    "Scene",
    "SceneError",
    "State",
    "Trajectory",
    "builtin_scenes",
    "checked_phase",
    "checked_phases",
    "demands",
    "example_scenes",
    "exponents",
    "flat_phases",
    "floor_spectra",
    "ground_acceleration",
    "ground_displacement",
    "ground_peak",
    "ground_velocity",
    "half_turn",
    "in_plane",
    "linear",
    "load_family",
    "load_scene",
    "loading_period",
    "mirror_symmetric",
    "no_friction",
    "own_axes",
    "parse_scene",
    "phase_axis",
    "phase_distribution",
    "phase_grid",
    "planar",
    "planar_chain",
    "untilted",
    "unused_harmonics",
    "verbatim",
]


def __getattr__(name: str) -> Any:
    if name in __all__:  # read off motions: here, too, for scripts that import them from here
        return getattr(import_module("reference.measures"), name)
    raise AttributeError(f"module 'reference.problem' has no attribute '{name}'")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
