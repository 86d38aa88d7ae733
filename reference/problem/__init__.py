"""
The question that both sides answer: scene, loading, measured quantity (5.1).

Functions
---------
load_scene, parse_scene, load_family                            scenes from a name, a file or a text
builtin_scenes, example_scenes                                  names of the scenes that are shipped
ground_acceleration, ground_velocity, ground_displacement       motion of the ground (5.2)-(5.4)
exponents, loading_period                                       of the loading
ground_peak                                                     denominator of (5.1)
check_phase, check_phases, flat_phases, phase_axis,
phase_grid                                                      phase pairs
describe_record                                                 what was read of a recorded motion, with warnings
half_turn, own_axes, planar, planar_chain, linear, no_friction,
untilted, mirror_symmetric, unused_harmonics, in_plane          what a scene does not require
escape_for_matplotlib                                           a text of a scene for matplotlib

Classes
-------
Scene, Family                       the system with its loading; the scenes of one file
State, Amplification, Trajectory    arguments and results of both sides
DryFriction                         coefficient of friction over the slip speed
Accuracy                            what the errors of a motion are made from
Outcome, Reduction, SceneError      why a point has no answer; why work is left out; what is wrong with a scene

Constants
---------
GRAVITY    9.81 m/s^2, the paper's value (section 5)
ADVICE     what to try, for every `Outcome`
"""

from __future__ import annotations

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
from reference.problem.phases import check_phase, check_phases, flat_phases, phase_axis, phase_grid
from reference.problem.recorded import describe_record
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
from reference.problem.scene_file import builtin_scenes, example_scenes, load_scene, parse_scene
from reference.support.constants import GRAVITY
from reference.support.drawing import escape_for_matplotlib
from reference.support.scene_error import SceneError

__all__ = [
    "ADVICE",
    "GRAVITY",
    "Accuracy",
    "Amplification",
    "DryFriction",
    "Family",
    "Outcome",
    "Reduction",
    "Scene",
    "SceneError",
    "State",
    "Trajectory",
    "builtin_scenes",
    "check_phase",
    "check_phases",
    "describe_record",
    "escape_for_matplotlib",
    "example_scenes",
    "exponents",
    "flat_phases",
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
    "phase_grid",
    "planar",
    "planar_chain",
    "untilted",
    "unused_harmonics",
]
