"""Time scales of the motion of a scene, in units of its model: periods, decay times, relaxation times."""

from __future__ import annotations

import math

import numpy as np

from multibody.models.contact import viscous_relaxation
from multibody.models.system import EngineModel
from multibody.models.units import Units, link_stiffness
from reference.problem import Scene, exponents

# Number of steps at accuracy level 0 in the shortest period of loading, pendulum and chain of bodies.
STEPS_PER_PERIOD = 150

# Number of steps at accuracy level 0 in the shortest period of elastic bars, whose vibration is a small part of the
# accelerations.
STEPS_PER_BAR_PERIOD = 40
MAX_BAR_DIVISION = 20.0  # largest factor by which elastic bars reduce the step: faster bars are not resolved

# Number of steps at accuracy level 0 in a decay time, in which a brief motion decays by a factor e.
STEPS_PER_DECAY = 24
DECAY_TIMES = 28.0  # number of decay times in which a brief motion decays by 1e12; then it needs no short steps


def largest_step(period: float, model: EngineModel) -> float:
    """Return the largest step at level 0, in the model's unit of time, for this shortest period; less for fast bars."""
    step = period / STEPS_PER_PERIOD
    if model.fastest_bar_frequency > 0.0:
        of_bars = 2.0 * math.pi / model.fastest_bar_frequency / STEPS_PER_BAR_PERIOD
        step = min(step, max(of_bars, step / MAX_BAR_DIVISION))
    return step


def shortest_period(scene: Scene, model: EngineModel) -> float:
    """
    Return the shortest period of loading, pendulum and all modes of the chain of bodies, in the model's unit of time.

    A record has no period: it is linear within every step.
    """
    periods = [2.0 * math.pi]
    if not scene.recorded:
        periods += [2.0 * math.pi / (pace * model.units.time) for pace in exponents(scene).imag]
    masses = scene.masses / model.units.mass
    spring = scene.dry_friction.stiffness * model.units.length / model.units.force if model.springs is not None else 0.0
    fastest = math.inf
    for axis in range(2):
        stiffness = np.zeros((len(masses), len(masses)))
        pendulum_of_all_bodies = 0.0 if scene.flat else 1.0
        stiffness[0, 0] = pendulum_of_all_bodies + spring
        for link, k in enumerate(link_stiffness(scene, model.units)[:, axis]):
            stiffness[link : link + 2, link : link + 2] += k * np.array([[1.0, -1.0], [-1.0, 1.0]])
        scaled = stiffness / np.sqrt(np.outer(masses, masses))
        highest = float(np.linalg.eigvalsh(scaled)[-1])
        fastest = min(fastest, 2.0 * math.pi / math.sqrt(highest) if highest > 0.0 else math.inf)
    return min(fastest, *periods)


def fastest_damper_rate(scene: Scene, units: Units) -> float:
    """Return an upper bound of the decay rates of damped links, per model unit of time (Gershgorin's theorem)."""
    per_mass = scene.damping.max(axis=1)
    below, above = per_mass / scene.masses[1:], per_mass / scene.masses[:-1]
    return float(2.0 * (np.append(above, 0.0) + np.append(0.0, below)).max() * units.time)


def list_brief_motions(scene: Scene, model: EngineModel, step: float) -> list[tuple[float, float]]:
    """
    List end and step needed at level 0, in the model's time unit, of every brief motion that `step` does not resolve.

    They are harmonics that decay, the start of a lubricated platform, and that of strongly damped links. From rest the
    platform takes on the speed that balances the loading within its relaxation time. Over much longer steps the
    integrator's acceleration would overshoot by as much again.
    """
    rates: list[float] = [] if scene.recorded else list(-exponents(scene).real * model.units.time)
    rates.append(1.0 / viscous_relaxation(scene, model.units))
    if scene.damping.any():
        rates.append(fastest_damper_rate(scene, model.units))
    times = [1.0 / rate for rate in rates if rate > 0.0]
    return [(DECAY_TIMES * time, time / STEPS_PER_DECAY) for time in times if time / STEPS_PER_DECAY < step]
