"""
Motions of the system that have a closed form, which the solver must reproduce: one case per file.

None of them uses the solver. They hold for the linearized equations, or for the exact ones on the sphere where stated.
"""

from reference.analytical.circular_shaking import CircularMotion, circular_shaking
from reference.analytical.coulomb_decay import coulomb_decay, coulomb_rest
from reference.analytical.den_hartog import SteadyOscillation, den_hartog, no_stop_bound
from reference.analytical.frictionless import frictionless_amplification, frictionless_motion
from reference.analytical.planar_sliding import squared_rate, turning_angle, turning_time
from reference.analytical.spherical_pendulum import conical_frequency, planar_period
from reference.analytical.straight_stop import stopping_distance, stopping_time
from reference.analytical.uniform_chain import uniform_chain_frequencies, uniform_chain_shapes

__all__ = [
    "CircularMotion",
    "SteadyOscillation",
    "circular_shaking",
    "conical_frequency",
    "coulomb_decay",
    "coulomb_rest",
    "den_hartog",
    "frictionless_amplification",
    "frictionless_motion",
    "no_stop_bound",
    "planar_period",
    "squared_rate",
    "stopping_distance",
    "stopping_time",
    "turning_angle",
    "turning_time",
    "uniform_chain_frequencies",
    "uniform_chain_shapes",
]
