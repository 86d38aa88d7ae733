"""
Quantities that are computed from motions and surfaces of either side.

Functions
---------
demands                 demands of a motion on isolator and structure
effective_isolator      effective period, damping and re-centering ratio of the isolator
factor_for_spectrum     factor of a ground motion for a target spectrum
response_spectrum       pseudo-accelerations of a ground motion
floor_spectra           response spectra of the floors of a motion
story_forces            story shears, overturning moments and support forces of a motion
phase_distribution      mean and fractiles of the amplification over uniform phases

Classes
-------
Demands, PeakDemands                demands of one motion; of the motions of many phase pairs
EffectiveIsolator, FloorSpectra, PhaseDistribution, StoryForces     results of the functions
Estimate, Estimates                 a number with its error; arrays of them
"""

from reference.measures.demand_reader import Estimate
from reference.measures.demands import Demands, demands
from reference.measures.distribution import PhaseDistribution, phase_distribution
from reference.measures.effective import EffectiveIsolator, effective_isolator
from reference.measures.peak_demands import Estimates, PeakDemands
from reference.measures.spectra import FloorSpectra, factor_for_spectrum, floor_spectra, response_spectrum
from reference.measures.story_forces import StoryForces, story_forces

__all__ = [
    "Demands",
    "EffectiveIsolator",
    "Estimate",
    "Estimates",
    "FloorSpectra",
    "PeakDemands",
    "PhaseDistribution",
    "StoryForces",
    "demands",
    "effective_isolator",
    "factor_for_spectrum",
    "floor_spectra",
    "phase_distribution",
    "response_spectrum",
    "story_forces",
]
