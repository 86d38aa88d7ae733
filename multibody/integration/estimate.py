"""
Error estimates of a run's peaks, from runs at coarser levels or on a softer contact.

A level of accuracy is a choice of step, contact stiffness and tolerances (`level`). Peaks in smooth motion converge by
a factor of four from level to level. Those at stops converge by two to four. Where the contact is slower than friction
relaxes, a level removes at most 1 / (2 + x) of the error, where x is the `contact_lag` of the coarser level. A
difference that is smaller than convergence by four explains is accidental: errors cancel. It does not count. Two
changes of opposite sign show no rate.

References
----------
Roache, P. J. (1994). Perspective: a method for uniform reporting of grid refinement studies. Journal of Fluids
Engineering 116, 405-413: Richardson's estimate with a safety factor, the grid convergence index.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from multibody.integration.engine_run import EngineRun
from multibody.integration.level import COMPLIANCE_RATIO, Level
from multibody.integration.peak import PeakReader
from multibody.models.system import EngineModel
from reference.problem import Outcome, Scene

Array = NDArray[np.float64]

# Safety factors on the error from the difference of two levels, and from three or more (Roache: 3 and 1.25). For two
# levels 1.5 is enough, because they are assumed to converge at the lowest rate that occurs, MIN_RATE;
# docs/records/multibody.md records how often stated errors hold.
SAFETY_TWO_LEVELS, SAFETY_THREE_LEVELS = 1.5, 1.25

# Safety factor on the rounding error that is estimated by a run on a softer contact in the same steps: the change of
# compliance may cancel a part of it (measured: a factor of 2.4 was needed at most, in 1 of 48 cases).
SAFETY_OF_ROUNDING = 3.0

# Noise of the contact force as a share of the bound of its rounding error, if the platform does not rotate (measured:
# up to 0.27; up to 0.10 if it rotates).
FORCE_NOISE_RATIO = 0.5
FORCE_NOISE_RATIO_OF_TURNING = 0.2  # noise of contact force over its bound of rounding error, if the platform rotates

# Largest force on a flat slider's platform, over Newton's residual, up to which the error includes the whole residual:
# the engine may take a step without an iteration and miss as much in all runs (measured: up to 34).
MAX_FORCE_WITHOUT_ITERATION = 40.0

# Safety factor on how much bearings of finite stiffness change the peaks, if only a run in larger steps has shown it
SAFETY_OF_BEARINGS = 2.0

# Time from the start in which a peak may come from oscillating stiff links, over the contact's response time, which is
# the square root of its penetration in model units (measured: these peaks come at 1.7).
STARTING_TIME = 4.0

# Factor by which a level of accuracy reduces the error: smallest at stops, largest in smooth motion. A factor above
# MAX_CREDIBLE_RATE counts as accidental.
MIN_RATE, MAX_RATE = 2.0, 4.0
MAX_CREDIBLE_RATE = 5.0  # factor of error reduction by one level, above which two errors count as canceling

# Relative error of a peak per largest warping load (part of the support forces that has no resultant) while all
# supports are closed (measured: up to 0.22, where supports reach the slip speed v_reg one by one).
ERROR_PER_WARPING_LOAD = 0.25

# Smallest relative error at the first level of a motion with impacts, halved by every level of equally stiff supports:
# rounding decides in which order supports close, and two levels may agree better by chance (measured: 1.1e-3 between
# levels 1 to 4).
MIN_ERROR_WITH_IMPACTS = 4e-3

# Ratio of a level's typical error with friction that yields to that with rigid friction (measured at level 2: 2.0).
ERROR_FLOOR_RATIO_OF_YIELDING = 3.0

# Smallest relative error that any peak is given: no smaller one has been verified.
SMALLEST_MEASURED_ERROR = 1e-6

# Relative error beyond which successive levels count as different motions, which do not converge.
MAX_CONVERGED_ERROR = 0.3

# Smallest change of a peak by which an earlier change is divided, so that the rate of convergence stays finite.
SMALLEST_CHANGE = 1e-290


def error_between_levels(peaks: list[PeakReader], levels: list[Level], model: EngineModel) -> Array:
    """
    Estimate the error (N,) of the last of two or three sets of peaks at successive levels, without contact rounding.

    The estimate is Richardson's, with Roache's safety factors.
    """
    # If every level divides the error by `rate`, the change between two levels is (rate - 1) times the error of the
    # finer one. Two levels show no rate, nor do two changes of opposite sign: then the lowest rate that occurs, at
    # stops, is assumed. A rate above that of smooth motion means that two errors cancel at one level; then the error
    # follows from the earlier change, at the lowest rate. A slow contact enlarges the error by 1 + x, where x is
    # `contact_lag`. The error is never below the typical one of the level, nor below the tolerance of Newton's
    # iteration. On a plane the latter is added, since friction alone accelerates the platform there.
    last, before = peaks[-1].value, peaks[-2].value
    change = np.abs(last - before)
    safety, rate = SAFETY_TWO_LEVELS, np.full_like(change, MIN_RATE)
    if len(peaks) > 2:
        safety, earlier = SAFETY_THREE_LEVELS, np.abs(before - peaks[-3].value)
        rate = earlier / np.maximum(change, SMALLEST_CHANGE)
        change = np.where(rate > MAX_CREDIBLE_RATE, earlier / MIN_RATE, change)
        turned = np.sign(last - before) != np.sign(before - peaks[-3].value)
        rate = np.where(turned | (rate > MAX_CREDIBLE_RATE), MIN_RATE, np.clip(rate, MIN_RATE, MAX_RATE))
    change = safety * change * (1.0 + contact_lag(levels[-2], model)) / (rate - 1.0)
    unsolved = levels[-1].newton * levels[-1].load
    floor = levels[-1].error_floor * (1.0 if model.springs is None else ERROR_FLOOR_RATIO_OF_YIELDING)
    level_error: Array = np.maximum(change, floor * last)
    level_error = level_error + unsolved if levels[-1].flat else np.maximum(level_error, unsolved)
    starting = _error_of_starting_links(peaks[-1], levels[-1], model)
    return level_error + peaks[-1].sampling_error + starting + SMALLEST_MEASURED_ERROR * last


def _error_of_starting_links(peaks: PeakReader, level: Level, model: EngineModel) -> Array:
    """Return the error (N,) by stiff links that oscillate at the start: an early peak minus the first sample."""
    if model.depressions is None or peaks.first_sample is None:
        return np.zeros_like(peaks.value)
    starting = peaks.instant < STARTING_TIME * math.sqrt(level.penetration)
    swings = starting & (peaks.value <= 2.0 * peaks.first_sample)
    added: Array = np.where(swings, np.abs(peaks.value - peaks.first_sample), 0.0)
    return added


def rounding_error(
    peaks: PeakReader, level: Level, other: PeakReader, softer: Level, safety: float = SAFETY_TWO_LEVELS
) -> Array:
    """Return the error (N,) by rounding of contact forces, from the difference to a run on a softer contact."""
    # Rounding of the force is in inverse proportion to the penetration. If the other contact is softer by a factor q,
    # it has 1 / q of the error, so that the peaks differ by (1 - 1 / q) times the error.
    stiffer = softer.penetration / level.penetration
    if stiffer < COMPLIANCE_RATIO * (1.0 - 1e-9):
        return np.full_like(peaks.value, level.rounding)
    change = np.abs(peaks.value - other.value)
    shown = np.maximum(safety * stiffer / (stiffer - 1.0) * change, level.error_floor * peaks.value)
    return np.minimum(level.rounding, shown)


def contact_noise_error(run: EngineRun, level: Level, scene: Scene, model: EngineModel) -> Array:
    """
    Return the smallest error (N,) of a run, which the noise of the contact force causes however well runs agree.

    A platform that hardly moves has the same position in all runs, which round alike. The noise accelerates all bodies
    along the vertical, where it adds to the other components as a square. On a plane the engine takes a step without an
    iteration if the force on the platform changes by less than Newton's residual, so that this force is missing in all
    runs. Where the platform turns, levels round differently and show the error, unless the peak itself is noise.
    """
    peaks, shares = run.peaks.value, scene.masses / scene.total_mass
    if model.depressions is not None:
        noise = FORCE_NOISE_RATIO_OF_TURNING * level.rounding
        return np.where(peaks <= noise, noise, 0.0)
    noise = FORCE_NOISE_RATIO * level.rounding
    vertical = peaks if model.ground.accelerates(2) else np.minimum(run.max_vertical, peaks)
    # Noise n on a vertical component v adds `gain` = (v + n)^2 - v^2 to the square of the peak p, and so to the peak
    # p - sqrt(p^2 - gain), which is written without a difference of nearly equal numbers.
    gain = (2.0 * vertical + noise) * noise
    error = np.minimum(noise, gain / np.maximum(peaks + np.sqrt(np.maximum(peaks**2 - gain, 0.0)), SMALLEST_CHANGE))
    if scene.flat:
        left = level.residual / shares[0]  # acceleration of the platform by a force as large as the residual
        error[0] += left * min(1.0, MAX_FORCE_WITHOUT_ITERATION * left / max(peaks[0], SMALLEST_CHANGE))
    return error


def impact_error_floor(before: int) -> float:
    """Return the smallest relative error after impacts; before: number of coarser levels on equally stiff supports."""
    return MIN_ERROR_WITH_IMPACTS / 2.0**before


def widen_by_impacts(errors: Array, peaks: list[PeakReader], run: EngineRun, before: int) -> Array:
    """
    Return errors (N,) that are enlarged if the run had impacts, behind which levels may agree by chance.

    They are at least a share of the peaks and, where levels scatter, at least the range of the peak over the levels.
    before: number of coarser levels on equally stiff supports.
    """
    if not run.impacts:
        return errors
    widened = np.maximum(errors, impact_error_floor(before) * run.peaks.value)
    if len(peaks) < 3:
        return widened
    values = np.array([each.value for each in peaks])
    earlier, change = np.diff(values, axis=0)
    scattered = earlier * change < MIN_RATE * change**2  # opposite sign, or smaller by less than convergence makes it
    return np.where(scattered, np.maximum(widened, np.ptp(values, axis=0)), widened)


def widen_without_convergence(errors: Array, run: EngineRun) -> Array:
    """Return `errors` (N,); if one is too large for levels that converge, all are at least as large as the peaks."""
    peaks = run.peaks.value
    if (errors <= MAX_CONVERGED_ERROR * peaks).all():
        return errors
    return np.maximum(errors, peaks)


def load_sharing_error(run: EngineRun) -> Array:
    """Return the error (N,) of a run in which closed supports share the load not exactly as elastic bearings do."""
    error: Array = ERROR_PER_WARPING_LOAD * run.warping_load * run.peaks.value
    return error


def compliance_error(stiff: PeakReader, soft: EngineRun, level: Level, model: EngineModel) -> Array:
    """Return the error (N,) by the contact's compliance in the peaks `stiff`, from a run `soft` on a softer contact."""
    if soft.outcome != Outcome.OK:
        return np.full_like(stiff.value, np.inf)
    change: Array = SAFETY_TWO_LEVELS * np.abs(stiff.value - soft.peaks.value) * (1.0 + contact_lag(level, model))
    return change + level.penetration * stiff.value


def error_share_of_change(other: Level, model: EngineModel) -> float:
    """Return the ratio of a run's error to its difference from a coarser or softer run, at the slowest convergence."""
    return SAFETY_TWO_LEVELS * (1.0 + contact_lag(other, model)) / (MIN_RATE - 1.0)


def contact_lag(level: Level, model: EngineModel) -> float:
    """Return the contact lag x: response time of the contact divided by the relaxation time of friction."""
    return math.sqrt(level.penetration) / model.relaxation
