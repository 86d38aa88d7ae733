"""
Openings and closings of supports in a run: every closing is an impact, located between two steps of the engine.

A contact whose gap has opened is taken out of the engine, so that every part of a run is smooth. Its gap then follows
from the positions. When the gap closes, the last step is repeated with the length at which the gap is zero, velocities
jump by `ImpactLaw`, and the run continues from that instant. The contact itself damps slow closings and the remaining
normal motion after an impact, within a time in proportion to the square root of its penetration.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from multibody.integration.constant_step import EngineMotion, EngineSolver
from multibody.models.impact import ImpactLaw
from multibody.models.state import EngineState

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

# Largest gap, as a share of the penetration, at which the instant of a closing counts as located.
GAP_TOLERANCE = 1e-4

# Gap / penetration beyond which a contact is open. It is larger than the gap of a located closing, so that a
# contact that has just closed stays closed.
OPENING_GAP = 2.0 * GAP_TOLERANCE

# Time, in units of the model, within which contacts that close share one impact.
SIMULTANEOUS_CLOSING_TIME = 1e-7

# Gap / penetration up to which open contacts share the impact of one that closes: a platform leaves compliant
# contacts with uneven loads at a tilt, which rigid contacts would not cause.
MAX_GAP_OF_JOINT_IMPACT = 1.0

# Speed of approach, in units of the model, below which a closing makes no impact: the contact's damper stops it.
MIN_IMPACT_SPEED = 1e-5

# Force of the contact's damper at a closing, in weights, beyond which no peak counts until contact forces have settled.
MAX_QUIET_FORCE = 1e-3

# After a closing no peak is read until contact forces have settled: for this multiple of the contact's response time,
# the square root of its penetration in model units, or for BEARING_SETTLING_TIME if that is longer.
CONTACT_SETTLING_TIME = 40.0
BEARING_SETTLING_TIME = 0.04  # time in which real bearings spring back after a closing, in the model's unit of time

# Numbers by which a step is divided to find a flight that begins and ends within the step.
FLIGHT_SEARCH_DIVISORS = 2.0 ** np.arange(1, 8)

# First step after an impact, as a share of the contact's response time, which is the square root of the penetration.
FIRST_STEP_OVER_RESPONSE = 0.25


@dataclass(frozen=True)
class Event:
    """
    First opening or closing of contacts in a chunk of a motion.

    row: the last row before it. closes: whether contacts close, rather than open. contacts: mask (K,) of those that do.
    """

    row: int
    closes: bool
    contacts: Mask


@dataclass
class Openings:
    """
    Openings and closings of the contacts (K,) in a run: which are open, and the number of impacts so far.

    settled_at: instant at which contact forces have settled after the last impact, in units of time.
    """

    solver: EngineSolver
    law: ImpactLaw
    penetration: float
    is_open: Mask = field(init=False)
    settled_at: float = -math.inf
    impacts: int = 0

    def __post_init__(self) -> None:
        """Start with all contacts closed."""
        self._mark_open(np.zeros(len(self.law.depressions.ring), bool))

    def _mark_open(self, is_open: Mask) -> None:
        """Remove the open contacts from the engine's system, and put the closed ones in."""
        self.is_open = is_open
        take_out_open_contacts = self.solver.model.take_out_open_contacts
        assert take_out_open_contacts is not None
        take_out_open_contacts(is_open, self.penetration)

    def gaps(self, coordinates: Array) -> Array:
        """Return the gaps (T, K) of all contacts for coordinates (T, n)."""
        return self.law.depressions.clearance(coordinates) - self.penetration

    def fill_gaps_of_open_contacts(self, motion: EngineMotion) -> EngineMotion:
        """Return `motion` with the gaps of open contacts recomputed, since the engine's contact sphere has no rim."""
        if not self.is_open.any():
            return motion
        contact = motion.contact.copy()
        contact[:, 0::4][:, self.is_open] = np.maximum(self.gaps(motion.coordinates)[:, self.is_open], 0.0)
        return motion._replace(contact=contact)

    def find_first_event(self, motion: EngineMotion) -> Event | None:
        """Find the first opening or closing behind the first row of `motion`; return None if there is none."""
        opens = (motion.gap[1:] > OPENING_GAP * self.penetration) & ~self.is_open
        closes = np.zeros_like(opens)
        if self.is_open.any():
            gaps = self.gaps(motion.coordinates)
            closes = (gaps[1:] < 0.0) & (gaps[1:] < gaps[:-1]) & self.is_open
        rows = np.flatnonzero((opens | closes).any(axis=1))
        if not len(rows):
            return None
        row = int(rows[0])
        closing = bool(closes[row].any())
        return Event(row, closing, closes[row] if closing else opens[row])

    def open_contacts(self, event: Event) -> None:
        """Remove the contacts that have opened from the engine's system."""
        self._mark_open(self.is_open | event.contacts)

    def locate_event(self, state: EngineState, time: float, step: float, event: Event) -> EngineMotion | None:
        """
        Integrate one step from `state`, of at most `step`, to the instant at which the first contact opens or closes.

        Returns None if the event lies at the start of the step.
        """
        # The engine has no events, so the length of the step is the unknown: steps of trial lengths are made from the
        # same state until the smallest gap of the event's contacts is zero (Brent's method). There are two special
        # cases. A contact that touches within the tolerance at the start has no later change of sign, unless the
        # platform leaves it and comes back within the step; such a flight is searched for in shorter and shorter steps.
        # And because of rounding the gap may still be positive after the whole step; then the event lies at its end.
        sign = 1.0 if event.closes else -1.0
        done: dict[float, EngineMotion | None] = {}
        values: dict[float, float] = {}

        def gap_before_event(length: float) -> float:
            """Return the smallest gap after a step of this length; for an opening, minus the largest gap."""
            if length not in values:
                done[length] = motion = self.solver.run(state, time, length, 1)
                gaps = None if motion is None else self.gaps(motion.coordinates[-1:])[0, event.contacts]
                # a step that the engine cannot solve counts as one beyond the event
                values[length] = -self.penetration if gaps is None else float((sign * gaps).min())
            return values[length]

        tolerance = GAP_TOLERANCE * self.penetration
        first, begin = 0.0, float((sign * self.gaps(state.coordinates[None])[0, event.contacts]).min())
        values[first] = begin
        if begin <= tolerance:
            if not event.closes:
                return None
            first = next(
                (length for length in step / FLIGHT_SEARCH_DIVISORS if gap_before_event(length) > tolerance), 0.0
            )
            if first == 0.0:
                return None
            begin = values[first]
        end = gap_before_event(step)
        if end >= 0.0:
            return done[step]
        length = float(
            brentq(gap_before_event, first, step, xtol=max(tolerance * step / (begin - end), 1e-300), rtol=1e-15)
        )
        gap_before_event(length)
        return done.get(length)

    def close_contacts(self, motion: EngineMotion, which: Mask) -> EngineMotion:
        """Return `motion` with those contacts of `which` that touch in the last row marked there as closed."""
        motion = self.fill_gaps_of_open_contacts(motion)
        touched = which & (self.gaps(motion.coordinates[-1:])[0] <= GAP_TOLERANCE * self.penetration)
        motion.contact[-1, 0::4][touched] = -GAP_TOLERANCE * self.penetration
        return motion

    def apply_impact(self, state: EngineState, time: float, which: Mask) -> EngineState:
        """Return the state after the impact of the contacts `which` and of others that close at the same time."""
        # Contacts that close within SIMULTANEOUS_CLOSING_TIME, or whose gap is within MAX_GAP_OF_JOINT_IMPACT, share
        # one impact: successive impacts, in an order that rounding decides, would end with other velocities. A contact
        # with a slow approach closes without a jump of velocities, because its damper stops it, and only the light
        # spheres follow the platform. Otherwise velocities jump by the impact law, and the elongation of the bars
        # changes so that their dampers exert no force. Until contact forces have settled, they depend on the contact's
        # stiffness, so that no acceleration counts before `settled_at`.
        gaps = self.gaps(state.coordinates[None])[0]
        leaving, relative = self.law.normal_speeds(state.coordinates, state.velocities)
        at_once = np.maximum(SIMULTANEOUS_CLOSING_TIME * -relative, MAX_GAP_OF_JOINT_IMPACT * self.penetration)
        hit = which & (gaps <= 2.0 * GAP_TOLERANCE * self.penetration)
        hit |= self.is_open & (gaps <= np.where(relative < 0.0, at_once, 0.0))
        if not hit.any():
            hit = which & (gaps == gaps[which].min())
        contact = state.contact.copy()
        contact[0::4][hit] = -GAP_TOLERANCE * self.penetration
        response = math.sqrt(self.penetration)
        if -2.0 * relative[hit].min() > MAX_QUIET_FORCE * response:
            self.settled_at = time + max(CONTACT_SETTLING_TIME * response, BEARING_SETTLING_TIME)
        if -leaving[hit].min() < MIN_IMPACT_SPEED:
            self._mark_open(self.is_open & ~hit)
            velocities = self.law.carry_spheres_along(state.coordinates, state.velocities, hit)
            return replace(state, velocities=velocities, contact=contact)
        velocities, is_open = self.law.solve_impact(state.coordinates, state.velocities, ~self.is_open & ~hit, hit)
        self._mark_open(is_open)
        self.impacts += 1
        bar_damping_times = self.solver.model.bar_damping_times
        assert bar_damping_times is not None
        damping_times = bar_damping_times(self.penetration)
        coordinates = self.law.unload_bar_dampers(state.coordinates, state.velocities, velocities, damping_times)
        return replace(
            state, coordinates=coordinates, velocities=velocities, contact=contact, slip_rate=None, load=None
        )
