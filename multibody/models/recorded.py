"""
Recorded ground acceleration for the engine, linear between samples, and steps that end at the samples.

The engine's expressions know no tables. But steps end at the knots of a record, so within a step the acceleration is
one straight line, whose numbers are set before the step: one call of Python per step, none inside it.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from multibody.models.engine import exudyn
from multibody.models.units import Units
from reference.problem import Scene

Array = NDArray[np.float64]

# Distance in time from a sample of the record, as a share of its shortest interval, within which both count as equal.
KNOT_TOLERANCE = 1e-6


class RecordedGround:
    """Acceleration of the ground plate from a record, in model units, for the engine; harmonics: `SymbolicGround`."""

    decay_rate = 0.0

    def __init__(self, mbs: Any, scene: Scene, units: Units) -> None:
        """Take over the record of `scene` in units of the model, and have the engine call `before_step`."""
        time, samples = scene.record[:, 0] / units.time, scene.record[:, 1:] / units.acceleration
        self.knots: Array = time[time < scene.duration / units.time]
        self.near = KNOT_TOLERANCE * float(np.diff(time).min())
        self._time, self._samples = time, samples
        self._rates = np.vstack([np.zeros(3), np.diff(samples, axis=0) / np.diff(time)[:, None], np.zeros(3)])
        self._interval = -1
        self._origin = exudyn.symbolic.Real("origin", 0.0)
        self._value, self._rate = ([exudyn.symbolic.Real(f"{name}{k}", 0.0) for k in range(3)] for name in "ar")
        mbs.SetPreStepUserFunction(self.before_step)

    def set_phase(self, phase: Any) -> None:
        """Do nothing, as a record has no phases."""

    def begin(self, time: float) -> None:
        """Set the interval of the record in which a run begins at `time`."""
        self._interval = -1
        self._enter_interval(int(np.searchsorted(self._time, time + self.near, side="right")))

    def accelerates(self, axis: int) -> bool:
        """Return whether the record accelerates the ground plate along `axis`."""
        return bool(self._samples[:, axis].any())

    def acceleration_along(self, axis: int, time: Any) -> Any:
        """Return the expression of the acceleration along `axis` at the symbolic instant `time` of the present step."""
        return self._value[axis] + self._rate[axis] * (time - self._origin)

    def before_step(self, mbs: Any, end: float) -> bool:
        """Set the interval of the record for the step that ends at `end`, before the engine takes that step."""
        self._enter_interval(int(np.searchsorted(self._time, end - self.near)))
        return True

    def _enter_interval(self, interval: int) -> None:
        """Set value and rate of the acceleration for interval k, from sample k - 1 to k; 0 is before the first one."""
        if interval == self._interval:
            return
        self._interval, knot = interval, max(interval - 1, 0)
        self._origin.SetValue(float(self._time[knot]))
        for axis in range(3):
            self._value[axis].SetValue(float(self._samples[knot, axis]))
            self._rate[axis].SetValue(float(self._rates[interval, axis]))


def align_steps(knots: Array, near: float, time: float, step: float, count: int) -> tuple[float, int]:
    """
    Return length and number of the steps from `time`, at most `step` and `count`, so that a step ends at each sample.

    knots: instants of the samples. near: distance in time within which an instant counts as that of a sample.
    """
    # The time to the next knot is divided into equal steps. Further intervals of the same length can have the same
    # step in the same call of the engine; an interval of another length ends the chunk.
    place = int(np.searchsorted(knots, time + near, side="right")) if len(knots) else 0
    if place == len(knots):
        return step, count
    gap = float(knots[place]) - time
    parts = math.ceil(gap / step * (1.0 - 1e-9))
    intervals = 1
    if place > 0 and time - knots[place - 1] <= near:
        most = max(count // parts, 1)
        alike = np.abs(np.diff(knots[place - 1 : place + most]) - gap) <= near
        intervals = int(alike.argmin()) if not alike.all() else len(alike)
    return gap / parts, min(count, max(intervals, 1) * parts)
