"""
Motions of the system that have a closed form: what the solver must reproduce, one case per file.

None of them uses the solver. They hold for the linearized equations, or for the exact ones on the sphere where said.
"""

from reference.closed_form.circular_shaking import CircularMotion, circular_shaking
from reference.closed_form.coulomb_decay import coulomb_decay, coulomb_rest
from reference.closed_form.den_hartog import SteadyOscillation, den_hartog, no_stop_bound
from reference.closed_form.frictionless import frictionless_amplification, frictionless_motion
from reference.closed_form.planar_sliding import squared_rate, turning_angle, turning_time
from reference.closed_form.spherical_pendulum import conical_frequency, planar_period
from reference.closed_form.straight_stop import stopping_distance, stopping_time
from reference.closed_form.uniform_chain import uniform_chain_frequencies, uniform_chain_shapes

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
