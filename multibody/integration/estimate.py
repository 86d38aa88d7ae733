"""
Error of a run's peaks, from the same run at coarser levels.

Peaks in smooth motion converge by four from level to level, those at stops by two to four, and by less where the
contact is slower than friction relaxes (see `level`): there a level takes away no more than 1 / (2 + x) of what is
left, x of the coarser of the two. A difference that is smaller than convergence by four explains is chance, sources
that cancel, and counts for nothing.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from multibody.integration.adaptive import March
from multibody.integration.level import Level
from multibody.integration.peak import Peaks
from multibody.models.system import EngineModel
from reference.problem import Outcome

Array = NDArray[np.float64]

SAFETY_TWO, SAFETY_MORE = 1.5, 1.25  # on the error that two levels, and three or more, show (Roache)
SLOWEST, FASTEST = 2.0, 4.0  # factor by which a level reduces the error: at stops, in smooth motion
TOO_GOOD = 5.0  # a larger factor is chance
WARPING = 0.05  # relative change of a peak over the largest load that warping takes (measured: up to 0.02)
FLOOR = 1e-6  # relative: what is left below is not measured


def from_levels(peaks: list[Peaks], levels: list[Level], model: EngineModel) -> Array:
    """Error (N,) of the last of `peaks`, two or three of the last of consecutive levels, in units of the model."""
    now, before = peaks[-1].value, peaks[-2].value
    change = np.abs(now - before)
    safety, rate = SAFETY_TWO, np.full_like(change, SLOWEST)
    if len(peaks) > 2:
        safety, earlier = SAFETY_MORE, np.abs(before - peaks[-3].value)
        rate = earlier / np.maximum(change, 1e-290)
        change = np.where(rate > TOO_GOOD, earlier / SLOWEST, change)
        rate = np.where(rate > TOO_GOOD, SLOWEST, np.clip(rate, SLOWEST, FASTEST))
    change = safety * change * (1.0 + lag(levels[-2], model)) / (rate - 1.0)
    likely: Array = np.maximum(change, levels[-1].chance * now)
    return likely + peaks[-1].sampling + levels[-1].rounding + FLOOR * now


def from_sharing(run: March) -> Array:
    """Error (N,) of a run whose supports do not quite share the load as elastic ones do."""
    error: Array = WARPING * run.warping * run.peaks.value
    return error


def from_compliance(stiff: Peaks, soft: March, level: Level, model: EngineModel) -> Array:
    """
    Error (N,) that the contact's compliance leaves in `stiff`, from a run with the softer contact of `level`.

    Never less than its share of rho: the geometry of the contact is not known better.
    """
    if soft.outcome != Outcome.OK:
        return np.full_like(stiff.value, np.inf)
    change: Array = SAFETY_TWO * np.abs(stiff.value - soft.peaks.value) * (1.0 + lag(level, model))
    return change + level.penetration * stiff.value


def lag(level: Level, model: EngineModel) -> float:
    """How slow the contact is beside the relaxation of friction, x."""
    return math.sqrt(level.penetration) / model.relaxation
