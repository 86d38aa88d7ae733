"""
The question that both sides answer: scene, loading, and the measured quantity, the amplification factor (5.1).

Functions
---------
load_scene, parse_scene, load_family                            scenes from a name, a file or a text
builtin_scenes, example_scenes                                  names of the scenes that are shipped
ground_acceleration, ground_velocity, ground_displacement       motion of the ground (5.2)-(5.4)
exponents, loading_period                                       of the loading
ground_peak                                                     denominator of (5.1)
phase_grid                                                      phase pairs
describe_record                                                 what was read of a recorded motion, with warnings

Classes
-------
Scene, Family                       the system with its loading; the scenes of one file
State, Amplification, Trajectory    arguments and results of both sides
DryFriction                         coefficient of friction over the slip speed
Accuracy                            what the errors of a motion are made from
Outcome, SceneError                 why a point has no answer; what is wrong with a scene

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
from reference.problem.phases import phase_grid
from reference.problem.recorded import describe_record
from reference.problem.result import Accuracy, Amplification, State, Trajectory
from reference.problem.scene import Scene
from reference.problem.scene_file import builtin_scenes, example_scenes, load_scene, parse_scene
from reference.support.constants import GRAVITY
from reference.support.scene_error import SceneError

__all__ = [
    "ADVICE",
    "GRAVITY",
    "Accuracy",
    "Amplification",
    "DryFriction",
    "Family",
    "Outcome",
    "Scene",
    "SceneError",
    "State",
    "Trajectory",
    "builtin_scenes",
    "describe_record",
    "example_scenes",
    "exponents",
    "ground_acceleration",
    "ground_displacement",
    "ground_peak",
    "ground_velocity",
    "load_family",
    "load_scene",
    "loading_period",
    "parse_scene",
    "phase_grid",
]
