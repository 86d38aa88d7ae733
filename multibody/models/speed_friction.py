"""
Friction that depends on slip speed, normal force or heat, for the engine's contacts with a constant coefficient.

Before every step the coefficient of each contact is set to that at the slip speed and the normal force which the
contact will have at the end of the step, by straight lines through the last two values of each, and at the temperature
that follows from them (surface_heat.py). Within a step the engine solves for constant coefficients. So the error is of
second order in the step, like that of the integrator, as long as a step is shorter than the time in which the change of
friction acts back on the speed (`friction_feedback_rate`).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from multibody.models.engine import exudyn
from multibody.models.loading import Ground
from multibody.models.state import EngineState
from multibody.models.surface_heat import SurfaceHeat
from multibody.models.units import Units
from reference.problem import GRAVITY, Scene
from reference.problem.friction import Heat

Array = NDArray[np.float64]

# Number of values that the engine stores for a contact, and index of the slip speed among them.
DATA_PER_CONTACT, SLIP_INDEX = 4, 1


class SpeedFriction:
    """Friction law that sets the friction coefficient of every contact before every step, in units of the model."""

    def __init__(
        self, mbs: Any, scene: Scene, units: Units, threshold: float, contacts: list[Any], ground: Ground
    ) -> None:
        """Set up the law of `contacts`; threshold: slip speed below which their friction is linear in it."""
        law = self.law = scene.dry_friction.in_unit_of_speed(units.velocity)
        self._heat: SurfaceHeat | None = None
        if law.heat is not None:
            self._heat = SurfaceHeat(law.heat, len(contacts), scene.duration, units.time, units.length)
            self._factor_of_heat = np.ones(len(contacts))
            # friction power, W, of one contact with coefficient 1 under its share of the weight, at slip speed 1
            self._watt = scene.total_mass * GRAVITY * units.velocity / len(contacts)
        # each contact's coefficient over the law's: above 1 to hold a contact at rest if friction yields on springs
        self.coefficient_ratios = [1.0] * len(contacts)
        self._contacts, self._ground, self._threshold = contacts, ground, threshold
        self._mass_ratio = scene.total_mass / float(scene.masses[0])
        # Contacts at `_start`, the begin of the step that ends at `_end`: slip speeds, their rates, loads (in shares of
        # the weight), and the rates of these.
        self._slip = self._rate = self._load_rate = [0.0] * len(contacts)
        self._load = [1.0] * len(contacts)
        self._start = self._end = 0.0
        mbs.SetPreStepUserFunction(self._before_step)

    def begin(self, mbs: Any, state: EngineState, time: float) -> None:
        """Set slip speeds, normal forces and friction coefficients for a run that starts at `time` from `state`."""
        nothing = [0.0] * len(self._contacts)
        self._slip = self._read_speeds(state.contact, state.velocities)
        self._rate = nothing if state.slip_rate is None else state.slip_rate.tolist()
        if self.law.elastic:
            self._rate = [_compute_rate_of_length(state.velocities[:3], state.accelerations)] * len(nothing)
        self._load = [1.0] * len(nothing) if state.load is None else state.load.tolist()
        self._load_rate = nothing if state.load is None or state.load_rate is None else state.load_rate.tolist()
        self._start = self._end = time
        if self._heat is not None and not self._heat.begin(time):
            self._set_coefficients(mbs, 0.0)
            self._heat.step_to(
                time,
                self._friction_power(self._coefficients_without_heat(0.0), 0.0),
                math.hypot(*state.coordinates[:2]),
            )
        self._set_coefficients(mbs, 0.0)

    def friction_feedback_rate(self, slip: Array) -> Array:
        """Return the largest rate (T,), 1/time, at which friction makes changes of slip speeds (T, K) grow or decay."""
        rate: Array = (self._mass_ratio * self.law.steepness(slip) * np.minimum(slip / self._threshold, 1.0)).max(
            axis=1
        )
        return rate

    def _before_step(self, mbs: Any, end: float) -> bool:
        """Set friction coefficients for the step that ends at `end`; the engine calls this before every step."""
        # If the engine cannot solve a step, it repeats the step with another length. The slip speeds differ from the
        # stored ones only after a solved step: only then the stored state of the contacts is replaced.
        self._ground.before_step(mbs, end)
        data = mbs.systemData
        slip = self._read_speeds(data.GetDataCoordinates(), data.GetODE2Coordinates_t())
        if slip != self._slip:
            span = self._end - self._start
            self._rate = [(new - old) / span for new, old in zip(slip, self._slip, strict=True)]
            if self.law.depends_on_load:
                load = self._read_loads(mbs)
                self._load_rate = [(new - old) / span for new, old in zip(load, self._load, strict=True)]
                self._load = load
            self._slip, self._start = slip, self._end
            if self._heat is not None:
                place = mbs.systemData.GetODE2Coordinates()[:2]
                self._heat.step_to(
                    self._end, self._friction_power(self._coefficients_without_heat(0.0), 0.0), math.hypot(*place)
                )
        self._end = end
        self._set_coefficients(mbs, end - self._start)
        return True

    def _read_speeds(self, contact: Array, velocities: Array) -> list[float]:
        """Return the speeds that friction depends on: slip speeds or, where friction yields, the platform's speed."""
        if self.law.elastic:
            return [math.hypot(*velocities[:3])] * len(self._contacts)
        speeds: list[float] = contact[SLIP_INDEX::DATA_PER_CONTACT].tolist()
        return speeds

    def _read_loads(self, mbs: Any) -> list[float]:
        """Return each contact's normal force, read from the engine, divided by its share of the weight."""
        kind, count = exudyn.OutputVariableType, len(self._contacts)
        pairs = [(mbs.GetObjectOutput(each, kind.Force), mbs.GetObjectOutput(each, kind.Director1))
                 for each in self._contacts]  # fmt: skip
        return [count * abs(float(force @ normal)) for force, normal in pairs]

    def _set_coefficients(self, mbs: Any, span: float) -> None:
        """Set the friction coefficients for slip speeds and loads that are extrapolated by the time `span`."""
        coefficients = self._coefficients_without_heat(span)
        if self._heat is not None:
            end = self._start + span
            celsius = self._heat.temperature(end, self._friction_power(coefficients, span), self._heat.distance(end))
            self._factor_of_heat = Heat.factor(celsius)
            coefficients = list(self._factor_of_heat * coefficients)
        for contact, coefficient, factor in zip(self._contacts, coefficients, self.coefficient_ratios, strict=True):
            mbs.SetObjectParameter(contact, "dynamicFriction", factor * coefficient)

    def _coefficients_without_heat(self, span: float) -> list[float]:
        """Return the friction coefficients after the time `span` from the stored state, without the effect of heat."""
        contacts = zip(self._slip, self._rate, self._load, self._load_rate, strict=True)
        return [
            self.law.coefficient_at(max(slip + span * rate, 0.0), load + span * load_rate)
            for slip, rate, load, load_rate in contacts
        ]

    def _friction_power(self, cold: list[float], span: float) -> Array:
        """
        Return the friction power of each contact, (K,), W, after the time `span` from the stored state.

        cold: friction coefficients without the effect of heat.
        """
        slip, rate, load, load_rate = map(np.array, (self._slip, self._rate, self._load, self._load_rate))
        speed, pressed = np.maximum(slip + span * rate, 0.0), np.maximum(load + span * load_rate, 0.0)
        regularized = np.minimum(speed / self._threshold, 1.0)  # the share of friction that acts below v_reg
        power: Array = self._watt * (self._factor_of_heat * cold) * pressed * regularized * speed
        return power


def _compute_rate_of_length(vector: Array, rates: Array | None) -> float:
    """
    Return the rate at which the length of a vector (3,) grows.

    rates: their first three are the rates of its components; None makes the result 0.
    """
    length = math.hypot(*vector)
    return 0.0 if rates is None or length == 0.0 else float(vector @ rates[:3]) / length
