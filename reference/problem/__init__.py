"""The question both sides answer: scene, loading, measured quantity. The only thing they share."""

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
from reference.problem.figure_text import verbatim
from reference.problem.outcome import ADVICE, Outcome
from reference.problem.phases import checked_phase, checked_phases, phase_grid
from reference.problem.reductions import (
    Reduction,
    even_ring,
    half_turn,
    in_plane,
    linear,
    no_friction,
    own_axes,
    planar,
    planar_chain,
    untilted,
    unused_harmonics,
)
from reference.problem.result import Amplification, State, Trajectory
from reference.problem.scene import Scene
from reference.problem.scene_error import SceneError
from reference.problem.scene_file import builtin_scenes, example_scenes, load_scene, parse_scene

__all__ = [
    "ADVICE",
    "GRAVITY",
    "Amplification",
    "Family",
    "Outcome",
    "Reduction",
    "Scene",
    "SceneError",
    "State",
    "Trajectory",
    "builtin_scenes",
    "checked_phase",
    "checked_phases",
    "even_ring",
    "example_scenes",
    "exponents",
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
    "no_friction",
    "own_axes",
    "parse_scene",
    "phase_grid",
    "planar",
    "planar_chain",
    "untilted",
    "unused_harmonics",
    "verbatim",
]
