"""
Friction that depends on the slip speed, for contacts of the engine, whose coefficient is one number.

Before every step the coefficient of each contact is set to that at the slip speed which the contact will have at the
end of the step: the straight line through its last two speeds. Within a step the engine solves for constant
coefficients. So the error is of second order in the step, like that of the integrator, as long as a step is short
beside the time in which the change of friction acts back on the speed (`feedback`).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from multibody.models.loading import Ground
from multibody.models.units import Units
from reference.problem import DryFriction, Scene

Array = NDArray[np.float64]

DATA_PER_CONTACT, SLIP = 4, 1  # data coordinates of a contact, and which of them is the slip speed


class SpeedFriction:
    """Sets the coefficients of `contacts`; in units of the model."""

    def __init__(
        self, mbs: Any, scene: Scene, units: Units, threshold: float, contacts: list[Any], ground: Ground
    ) -> None:
        law = scene.dry_friction
        self.law = DryFriction(law.slow, law.fast, law.rate * units.velocity)
        self._contacts, self._ground, self._threshold = contacts, ground, threshold
        self._mass_ratio = scene.total_mass / float(scene.masses[0])
        self._slip = self._rate = [0.0] * len(contacts)  # at the start of the step
        self._start = self._end = 0.0  # of the step
        mbs.SetPreStepUserFunction(self._before_step)

    def begin(self, mbs: Any, contact: Array, slip_rate: Array | None, time: float) -> None:
        """Make ready for a run from contact data (4 K,) at this instant; slip_rate: (K,), of the step before it."""
        self._slip = contact[SLIP::DATA_PER_CONTACT].tolist()
        self._rate = [0.0] * len(self._slip) if slip_rate is None else slip_rate.tolist()
        self._start = self._end = time
        self._set(mbs, 0.0)

    def feedback(self, slip: Array) -> Array:
        """Rate at which a change of the coefficients acts back on slip speeds (T, K), the largest of the contacts."""
        law = self.law
        steepness = abs(law.fast - law.slow) * law.rate * np.exp(-law.rate * slip)
        rate: Array = (self._mass_ratio * steepness * np.minimum(slip / self._threshold, 1.0)).max(axis=1)
        return rate

    def _before_step(self, mbs: Any, end: float) -> bool:
        self._ground.before_step(mbs, end)
        slip = mbs.systemData.GetDataCoordinates()[SLIP::DATA_PER_CONTACT].tolist()
        if slip != self._slip:  # the step before was made; otherwise the engine tries it again with another length
            span = self._end - self._start
            self._rate = [(new - old) / span for new, old in zip(slip, self._slip, strict=True)]
            self._slip, self._start = slip, self._end
        self._end = end
        self._set(mbs, end - self._start)
        return True

    def _set(self, mbs: Any, span: float) -> None:
        """Set the coefficients at the speeds that the contacts have after `span`."""
        law = self.law
        for contact, slip, rate in zip(self._contacts, self._slip, self._rate, strict=True):
            speed = max(slip + span * rate, 0.0)
            coefficient = law.slow - (law.fast - law.slow) * math.expm1(-law.rate * speed)
            mbs.SetObjectParameter(contact, "dynamicFriction", coefficient)
