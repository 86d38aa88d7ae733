"""
Levels of accuracy: from one to the next everything the answer depends on becomes better at once.

The step, the largest and that at stops, falls by two; the compliance of the contact and the tolerance of Newton's
iteration by four. The contact follows a change of the force it must carry within sqrt(penetration) units of time. At a
stop that force changes within the time in which regularised friction relaxes, share * v_reg / mu: the contact must be
faster, or the friction limit it gives is the one of a moment ago. Then its error at the corner of the law is in
proportion to x / (1 + x), x = sqrt(penetration) / relaxation, the answer of a first-order lag to an exponential.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from multibody.models.contact import viscous_relaxation
from multibody.models.supports import GIVES_WAY
from multibody.models.system import EngineModel
from multibody.models.units import link_stiffness
from reference.problem import Scene, exponents

LEVELS = 8
STEPS_PER_PERIOD = 150  # of the fastest motion that matters, at level 0
STEPS_PER_DECAY = 24  # of the time in which a harmonic falls by e, at level 0, while it lasts
LASTS = 28.0  # such times, until a harmonic has fallen by 1e12
CHANCE = 6e-4  # relative: what level 0 typically gets wrong
TURN = 0.14  # allowed change of the slip velocity in one step at level 0, as its fraction
PENETRATION = 1e-6  # of rho, at level 0 and most
LAG = 0.3  # x at level 0 where rounding allows: from there on a level halves the contact's error (measured)
NEWTON = 1e-5  # relative tolerance of the forces, at level 0
NOISE = 0.25  # share of the tolerance that rounding of the forces may take
PEAK = 0.2  # of g: the peak for which it does
MOST, USUAL = 4e-4, 1e-3  # largest share of rho by which warping may give way; tolerance for which it is the smallest
FALL = 4.0  # of the penetration from level to level
RATIO = 4  # between neighbouring step sizes
SHALLOWEST, FINEST = 7, 0.05  # step sizes below the largest, at least; the smallest in allowed steps at a stop


@dataclass(frozen=True)
class Level:
    """
    step: the largest, in units of time. turn: allowed change of the slip velocity in one step, as its fraction.
    penetration: of the contact under the weight, of rho. newton: relative tolerance of the forces. deepest: how often
    the largest step may be divided by `RATIO`. chance: relative error that this level typically has, and below which no
    agreement with another one tells anything. gives_way: of supports against warping under the weight, of rho. decays:
    for everything that dies faster than the largest step resolves (`brief_motions`), the instant until which it lasts
    and the step up to there.
    """

    step: float
    turn: float
    penetration: float
    newton: float
    rounding: float
    deepest: int
    chance: float
    gives_way: float
    decays: tuple[tuple[float, float], ...] = ()

    def shallowest(self, time: float) -> int:
        """How often the largest step must be divided at `time` for the decay of the loading."""
        allowed = min((step for until, step in self.decays if time < until), default=self.step)
        return min(math.ceil(math.log(self.step / allowed, RATIO) - 1e-9), self.deepest)

    @property
    def absolute(self) -> float:
        """Smallest residual that Newton's iteration is asked for, in weights."""
        return max(1e-3 * self.newton, self.rounding)


def largest_step(scene: Scene, model: EngineModel) -> float:
    """
    Step of level 0 in units of the model, from the shortest period of the loading, the pendulum and the chain.

    Of the chain however short: the loading begins at once and sets every mode swinging, and none is damped.
    """
    slow = [2.0 * math.pi]
    if not scene.recorded:  # a record is linear within every step
        slow += [2.0 * math.pi / (pace * model.units.time) for pace in exponents(scene).imag]
    masses = scene.masses / model.units.mass
    fastest = math.inf
    for axis in range(2):
        stiffness = np.zeros((len(masses), len(masses)))
        stiffness[0, 0] = 1.0  # the pendulum carries all bodies
        for link, k in enumerate(link_stiffness(scene, model.units)[:, axis]):
            stiffness[link : link + 2, link : link + 2] += k * np.array([[1.0, -1.0], [-1.0, 1.0]])
        scaled = stiffness / np.sqrt(np.outer(masses, masses))
        fastest = min(fastest, 2.0 * math.pi / math.sqrt(float(np.linalg.eigvalsh(scaled)[-1])))
    return min(fastest, *slow) / STEPS_PER_PERIOD


def brief_motions(scene: Scene, model: EngineModel, step: float) -> list[tuple[float, float]]:
    """
    Until when the harmonics last that `step` does not resolve, and the step they ask for, at level 0.

    So does the start of a lubricated platform: from rest it takes on the speed that balances the loading within its
    relaxation time. Over steps much longer than that the integrator's acceleration would overshoot by as much again.
    """
    rates: list[float] = [] if scene.recorded else list(-exponents(scene).real * model.units.time)
    rates.append(1.0 / viscous_relaxation(scene, model.units))
    times = [1.0 / rate for rate in rates if rate > 0.0]
    return [(LASTS * time, time / STEPS_PER_DECAY) for time in times if time / STEPS_PER_DECAY < step]


def levels(scene: Scene, model: EngineModel, tolerance: float) -> list[Level]:
    """All levels for a relative error of `tolerance`; the penetration stays where rounding would take over."""
    step = largest_step(scene, model)
    stiffest = min(model.rounding / (NOISE * PEAK * tolerance), PENETRATION / FALL)
    softest = float(np.clip(min(LAG * model.relaxation, 1.0) ** 2, stiffest, PENETRATION))
    stiffenings = math.floor(math.log(softest / stiffest, FALL) + 1e-9)
    penetrations = [softest / FALL ** min(level, stiffenings) for level in range(LEVELS)]
    gives_way = float(np.clip(GIVES_WAY * USUAL / tolerance, GIVES_WAY, MOST))
    at_stop = FINEST * TURN * model.relaxation
    brief = brief_motions(scene, model, step)
    smallest = min([at_stop, *(needed for _, needed in brief)])
    deepest = max(SHALLOWEST, math.ceil(math.log(step / smallest, RATIO))) if smallest < step else SHALLOWEST
    return [
        Level(
            step / 2.0**level,
            TURN / 2.0**level,
            penetration,
            NEWTON / 4.0**level,
            model.rounding / penetration,
            deepest,
            CHANCE / 4.0**level,
            gives_way,
            tuple((until, needed / 2.0**level) for until, needed in brief),
        )
        for level, penetration in enumerate(penetrations)
    ]
