"""
The law of friction: its keys in a scene file, and its coefficient over slip speed, load and heat.

This is the one place of the law. `reference/solver/contact/friction.py` has its compiled form, `yielding.py` next to
it that of friction that yields, and `multibody/models/speed_friction.py` gives its coefficients to the engine.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Discriminator, Tag, model_validator

from reference.problem.keys import REQUIRED, NonNegative, Positive, Table, key
from reference.problem.validation import FRICTION_FORMS
from reference.support.arguments import Range

LEAST_LOAD = 1e-6  # ratio of normal force to weight below which the coefficient no longer changes with the load


@dataclass(frozen=True)
class Heat:
    """
    Temperature at the center of a sliding surface, degrees C: initial + rise * integral of P(t - s) / sqrt(s) over s.

    P is the power of friction, counted only while the slider covers the center. The law is that of heat conduction into
    a half space from a slider's whole contact.

    Attributes
    ----------
    initial : float
        Degrees C, before the motion.
    rise : float
        K / (W s^0.5), for the power of the whole isolator.
    cover : float
        m, the largest displacement at which the slider covers the center: half the side of a square of the contact's
        area.
    """

    initial: float
    rise: float
    cover: float

    @classmethod
    def of(cls, radius: float, conductivity: float, diffusivity: float, initial: float, supports: int) -> Heat:
        """
        Return the temperature law of equal sliders, one for each support, with round contacts.

        radius: m, of a contact. conductivity: W/(m K). diffusivity: m^2/s. initial: degrees C.
        """
        area = supports * math.pi * radius**2
        return cls(
            initial=initial,
            rise=math.sqrt(diffusivity / math.pi) / (conductivity * area),
            cover=0.5 * math.sqrt(math.pi) * radius,
        )

    @staticmethod
    def factor(temperature: ArrayLike) -> NDArray[np.float64]:
        """Return the ratio of the friction coefficient at a temperature, degrees C, to the stated coefficient."""
        return 0.79 * (0.7 ** (0.02 * np.asarray(temperature)) + 0.4)


@dataclass(frozen=True)
class DryFriction:
    """
    The friction coefficient mu(|v|) = fast - (fast - slow) exp(-rate |v|) of Mokha and Constantinou.

    Under a normal force N in place of the weight W it is mu (N / W)^exponent; heat multiplies it by `Heat.factor`.

    Attributes
    ----------
    slow : float
        At rest.
    fast : float
        At high speed.
    rate : float
        s/m. 0 for a coefficient that does not depend on the speed.
    exponent : float
        0 for a coefficient that does not depend on the normal force.
    heat : Heat, optional
        None for a coefficient that does not depend on the heat of sliding.
    stiffness : float
        N/m, of friction that is elastic before it slides; inf for rigid friction.

    Examples
    --------
    >>> law = DryFriction(slow=0.03, fast=0.06, rate=100.0)
    >>> law.largest, round(float(law.at(0.01)), 4)
    (0.06, 0.049)
    """

    slow: float
    fast: float
    rate: float
    exponent: float = 0.0
    heat: Heat | None = None
    stiffness: float = math.inf

    @property
    def needs_load(self) -> bool:
        """True if a model needs the normal force for the coefficient of friction, or for the onset of sliding."""
        return self.depends_on_load or self.elastic

    @property
    def elastic(self) -> bool:
        """True if friction is elastic, not rigid, before it slides."""
        return self.stiffness < math.inf

    @property
    def varies(self) -> bool:
        """True if the coefficient depends on the slip speed."""
        return self.rate > 0.0 and self.slow != self.fast

    @property
    def constant(self) -> bool:
        """True if the coefficient depends on neither speed nor load nor temperature."""
        return not self.varies and self.exponent == 0.0 and self.heat is None

    @property
    def depends_on_load(self) -> bool:
        """True if the coefficient depends on the normal force, directly or by the heat of friction under it."""
        return self.exponent != 0.0 or self.heat is not None

    @property
    def kind(self) -> str:
        """Name of the law in texts: "Coulomb" for a constant coefficient, "dry" for any other."""
        return "Coulomb" if self.constant else "dry"

    @property
    def largest(self) -> float:
        """The larger of `slow` and `fast`, which bounds the coefficient at every speed under the weight."""
        return max(self.slow, self.fast)

    def at(self, speed: ArrayLike, load: ArrayLike = 1.0) -> NDArray[np.float64]:
        """
        Return the friction coefficient at slip speeds, m/s, and normal forces over the weight.

        Parameters
        ----------
        speed : array_like
            m/s, of any shape.
        load : array_like
            Normal force over the weight, of a shape that fits.

        Returns
        -------
        ndarray
            Of the shape of both.
        """
        coefficient: NDArray[np.float64] = self.slow - (self.fast - self.slow) * np.expm1(
            -self.rate * np.asarray(speed, dtype=float)
        )
        return coefficient if self.exponent == 0.0 else coefficient * np.maximum(load, LEAST_LOAD) ** self.exponent

    def coefficient_at(self, speed: float, load: float) -> float:
        """Return the friction coefficient of one contact at a slip speed, m/s, and a normal force over the weight."""
        coefficient = self.slow - (self.fast - self.slow) * math.expm1(-self.rate * speed)
        return coefficient if self.exponent == 0.0 else coefficient * max(load, LEAST_LOAD) ** self.exponent

    def steepness(self, speed: ArrayLike) -> NDArray[np.float64]:
        """Return the absolute derivative of the coefficient by slip speed, s/m, the normal force being the weight."""
        steepness: NDArray[np.float64] = (
            abs(self.fast - self.slow) * self.rate * np.exp(-self.rate * np.asarray(speed, dtype=float))
        )
        return steepness

    def in_unit_of_speed(self, unit: float) -> DryFriction:
        """Return the same law for slip speeds that are given in a unit of `unit` m/s."""
        return replace(self, rate=self.rate * unit)


class Heating(Table):
    """
    Heating of the sliding surface, which lowers dry friction.

    The coefficient is that at 20 degrees C times 0.79 (0.7^(0.02 T) + 0.40), T in degrees C.
    """

    contact_radius: Positive = key(
        "radius of the slider's round contact, of each of the supports where these are given",
        Range(1e-3, 10.0, "m"),
        default=REQUIRED,
    )
    conductivity: Positive = key(
        "thermal conductivity of the plate that the slider runs on", Range(0.01, 1e4, "W/(m K)"), default=REQUIRED
    )
    diffusivity: Positive = key("thermal diffusivity of that plate", Range(1e-8, 1e-2, "m^2/s"), default=REQUIRED)
    initial_temperature: float = key("temperature before the motion", Range(-50.0, 300.0, "degrees C"), default=20.0)


class VelocityFriction(Table):
    """
    Dry friction that is elastic before it slides, or depends on the slip speed, the normal force or its own heat.

    The coefficient is (fast - (fast - slow) exp(-rate |v|)) (N / N_ref)^n, times the temperature factor of `heating`.
    """

    # Without friction at rest the platform would never stop: such a law is no dry friction.
    slow: Positive = key("coefficient at rest", Range(1e-9, 1e3), default=REQUIRED)
    fast: NonNegative | None = key(
        "coefficient at high speed, above or below slow; without it and rate, slow at every speed", Range(0.0, 1e3)
    )
    rate: Positive | None = key("rate of the change from slow to fast", Range(1e-6, 1e10, "s/m"))
    load_exponent: float | None = key(
        "exponent n: the coefficient grows like N^n with the normal force N, and not without it", Range(-0.5, 1.0)
    )
    reference_load: Positive | None = key(
        "normal force of the whole isolator under which the coefficients are those stated; the weight without it",
        Range(1e-11, 1e16, "N"),
    )

    initial_stiffness: Positive | None = key(
        "stiffness k of the whole isolator's friction before it slides: friction is k times an elastic displacement, "
        "bounded by mu N; rigid without it",
        Range(1e-12, 1e18, "N/m"),
    )
    yield_displacement: Positive | None = key(
        "mu N / k under the weight, of the larger of slow and fast; give this or initial_stiffness",
        Range(1e-12, 1e3, "m"),
    )
    heating: Heating | None = key("the table below; without it the surface stays cold")

    @model_validator(mode="after")
    def _check_pairs(self) -> VelocityFriction:
        """Require keys that belong together, and refuse keys that exclude each other."""
        if (self.fast is None) != (self.rate is None):
            raise ValueError("give fast and rate together, or neither")
        yields = self.initial_stiffness is not None or self.yield_displacement is not None
        if not yields and self.fast is None and self.load_exponent is None and self.heating is None:
            keys = "fast and rate, load_exponent, heating or initial_stiffness"
            raise ValueError(f"give {keys}, or one number in place of the table")
        if yields and None not in (self.initial_stiffness, self.yield_displacement):
            raise ValueError("give initial_stiffness or yield_displacement, the other follows: remove one of them")
        if yields and self.heating is not None:
            raise ValueError(
                "heating is that of rigid friction: remove it, or initial_stiffness and yield_displacement"
            )
        if self.reference_load is not None and self.load_exponent is None:
            raise ValueError("reference_load belongs to a load_exponent: state that, too, or remove this key")
        return self


def kind_of_friction(friction: Any) -> str:
    """Return which form of friction the user means, an entry of FRICTION_FORMS; pydantic then validates this form."""
    return FRICTION_FORMS[int(isinstance(friction, dict | VelocityFriction))]


Friction = Annotated[  # friction in a scene file: a constant, or a table
    Annotated[NonNegative, Tag(FRICTION_FORMS[0])] | Annotated[VelocityFriction, Tag(FRICTION_FORMS[1])],
    Discriminator(kind_of_friction),
]


def law_of_friction(stated: float | VelocityFriction | None, weight: float, sliders: int) -> DryFriction:
    """
    Return the law of dry friction that a scene states, for an isolator that carries a weight, N.

    stated: constant coefficient, table, or None for no friction. sliders: number of sliders, over which the heat
    spreads. Coefficients that are stated for a `reference_load` are converted to the weight.
    """
    if not isinstance(stated, VelocityFriction):
        return DryFriction(slow=stated or 0.0, fast=stated or 0.0, rate=0.0)
    exponent, heating = stated.load_exponent or 0.0, stated.heating
    factor = (weight / stated.reference_load) ** exponent if stated.reference_load else 1.0
    heat = None
    if heating is not None:
        heat = Heat.of(
            radius=heating.contact_radius,
            conductivity=heating.conductivity,
            diffusivity=heating.diffusivity,
            initial=heating.initial_temperature,
            supports=sliders,
        )
    fast = stated.slow if stated.fast is None else stated.fast
    law = DryFriction(
        slow=factor * stated.slow, fast=factor * fast, rate=stated.rate or 0.0, exponent=exponent, heat=heat
    )
    if stated.yield_displacement is not None:
        return replace(law, stiffness=law.largest * weight / stated.yield_displacement)
    return law if stated.initial_stiffness is None else replace(law, stiffness=stated.initial_stiffness)
