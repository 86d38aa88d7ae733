"""
One phase pair to a tolerance: the whole run at successive levels of accuracy, and an error from their differences.

From one level to the next everything the answer depends on becomes better at once: the step, the largest and that at
stops, by two; the compliance of the contact and the tolerance of Newton's iteration by four. Peaks in smooth motion
converge by four, those at stops by two to four (measured), so that the difference of two levels, at the factor seen or
at two, is the error of the finer one from all these sources together.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from multibody.integrate import Engine
from multibody.march import Control, March, march
from multibody.system import EngineModel
from multibody.units import link_stiffness
from reference.problem import Outcome, Scene, State, ground_acceleration

Array = NDArray[np.float64]

LEVELS = 8
STEPS_PER_PERIOD = 150  # of the fastest motion that matters, at level 0
STATIC = 0.02  # of the shortest period of loading and pendulum: faster links follow without swinging
TURN = 0.14  # allowed change of the slip velocity in one step at level 0, as its fraction
PENETRATION = 1e-6  # of rho, at level 0
STIFFEST = 1e-8  # of rho: rounding of the position is then 2e-8 of the weight
NEWTON = 1e-5  # relative tolerance of the forces, at level 0
ROUNDING = 1e-15  # of the position, in units of rho; over the penetration: of the forces
SAFETY_TWO, SAFETY_MORE = 1.5, 1.25  # on the error that two levels, and three or more, show (Roache)
SLOWEST, FASTEST = 2.0, 4.0  # factor by which a level reduces the error: at stops, in smooth motion
CHANCE = 4e-4  # relative: what level 0 typically gets wrong; two levels may agree by chance, so no estimate is smaller
FLOOR = 1e-6  # relative: below this, rounding and the compliance that is left are not measured


@dataclass(frozen=True)
class Refined:
    """
    What refinement found for one phase pair.

    peaks, errors: (N,), m/s^2, NaN without an answer. instant: s, when a status other than ok arose. finest: the last
    march.
    """

    peaks: Array
    errors: Array
    outcome: Outcome
    instant: float
    finest: March


def largest_step(scene: Scene, model: EngineModel) -> float:
    """Step of level 0 in units of the model, from the shortest period of the loading, the pendulum and the chain."""
    slow = [period / model.units.time for period in scene.excitation.periods] + [2.0 * math.pi]
    masses = scene.masses / model.units.mass
    fastest = math.inf
    for axis in range(2):
        stiffness = np.zeros((len(masses), len(masses)))
        stiffness[0, 0] = 1.0  # the pendulum carries all bodies
        for link, k in enumerate(link_stiffness(scene, model.units)[:, axis]):
            stiffness[link : link + 2, link : link + 2] += k * np.array([[1.0, -1.0], [-1.0, 1.0]])
        scaled = stiffness / np.sqrt(np.outer(masses, masses))
        fastest = min(fastest, 2.0 * math.pi / math.sqrt(float(np.linalg.eigvalsh(scaled)[-1])))
    return min(max(fastest, STATIC * min(slow)), *slow) / STEPS_PER_PERIOD


def refine(
    scene: Scene,
    model: EngineModel,
    phase: Array,
    tolerance: float,
    *,
    initial: State | None = None,
    keep: bool = False,
) -> Refined:
    """Peaks of the absolute accelerations for one phase pair (2,), rad, with a relative error below `tolerance`."""
    units = model.units
    step, end = largest_step(scene, model), scene.duration / units.time
    model.ground.set_phase(phase)
    first = ground_acceleration(scene, phase, [0.0])[0]
    marches: list[March] = []

    def ground(time: Array) -> Array:
        return ground_acceleration(scene, phase, time * units.time) / units.acceleration

    for level in range(LEVELS):
        penetration = max(PENETRATION / 4.0**level, STIFFEST)
        model.stiffen(penetration)
        newton = NEWTON / 4.0**level
        engine = Engine(model, newton, max(1e-3 * newton, ROUNDING / penetration))
        control = Control(step / 2.0**level, TURN / 2.0**level, penetration)
        marches.append(march(engine, model.start(initial, first, penetration), end, ground, control, keep=keep))
        if level == 0:
            continue
        before, now = marches[-2:]
        if before.outcome != now.outcome:
            continue
        if now.outcome != Outcome.OK:
            return _refused(model, now, now.outcome, now.instant * units.time)
        errors = _errors(marches)
        if (errors <= tolerance * now.peaks.value).all():
            return Refined(now.peaks.value * units.acceleration, errors * units.acceleration, Outcome.OK, math.nan, now)
    if before.outcome != Outcome.OK or now.outcome != Outcome.OK:
        failed = now if now.outcome != Outcome.OK else before
        return _refused(model, failed, failed.outcome, failed.instant * units.time)
    return Refined(
        now.peaks.value * units.acceleration,
        errors * units.acceleration,
        Outcome.TOLERANCE_NOT_MET,
        float(now.peaks.instant[(errors / now.peaks.value).argmax()]) * units.time,
        now,
    )


def _errors(marches: list[March]) -> Array:
    """Estimated errors of the last march's peaks, in units of the model."""
    now, before = marches[-1].peaks, marches[-2].peaks
    change = np.abs(now.value - before.value)
    safety, rate = SAFETY_TWO, np.full_like(change, SLOWEST)
    if len(marches) > 2 and marches[-3].outcome == Outcome.OK:
        earlier = np.abs(before.value - marches[-3].peaks.value)
        change = np.maximum(change, earlier / FASTEST)  # guards against two levels that agree by chance
        safety, rate = SAFETY_MORE, np.clip(earlier / np.maximum(change, np.finfo(float).tiny), SLOWEST, FASTEST)
    level = len(marches) - 1
    likely = np.maximum(safety * change / (rate - 1.0), CHANCE / 4.0**level * now.value)
    errors: Array = likely + now.sampling + FLOOR * now.value
    return errors


def _refused(model: EngineModel, finest: March, outcome: Outcome, instant: float) -> Refined:
    nothing = np.full(len(model.bodies), np.nan)
    return Refined(nothing, nothing, outcome, instant, finest)
