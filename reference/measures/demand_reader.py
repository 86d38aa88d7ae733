"""Reading of extreme values, energies and counts from the samples of a motion, with their errors."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from reference.measures.energy import Energy, compute_energy
from reference.problem.outcome import Outcome
from reference.problem.result import Array, Trajectory

FULL_LENGTH_OUTCOMES = (Outcome.OK, Outcome.TOLERANCE_NOT_MET)  # outcomes of a motion that lasts the whole duration
DURATION_TOLERANCE = 1e-9  # a rest counts as final if it ends within this fraction of the duration before its end
DECIMATION = 5  # the sampling error is the largest change of a value if only every fifth sample is used


@dataclass(frozen=True)
class Estimate:
    """
    A number with its estimated error, and the reason if it has no value.

    Attributes
    ----------
    value : float
        NaN without an answer.
    error : float
        Estimated absolute error; NaN where it is not known.
    reason : str
        Why there is no value although the motion lasts as long as the scene; "" otherwise.
    """

    value: float
    error: float
    reason: str = ""


# Reasons why a motion has no residual displacement
NEVER_RESTS = "never at rest: no dry friction"
MOVING_AT_END = "moving at the end: take a longer duration"
NOT_SAMPLED = "no samples of the last rest"
UNKNOWN_ESTIMATE = Estimate(math.nan, math.nan)  # stands for any number of a motion that ended early


def largest_displacement(time: Array, place: Array, velocity: Array) -> float:
    """Return the largest length, m, of the displacement `place` (T, 2), also between the instants `time` (T,)."""
    square, summits = squared_lengths_and_interval_maxima(time, place, velocity)
    return float(np.sqrt(max(square.max(), summits.max(initial=0.0))))


def squared_lengths_and_interval_maxima(time: Array, place: Array, velocity: Array) -> tuple[Array, Array]:
    """
    Return the squared lengths of displacements `place` (T, 2) at the instants, (T,), m^2, and between them, (T - 1,).

    Between two instants it is the largest squared length if that lies inside, else the one at the later instant.
    """
    # Between two instants the rate of half the squared length is taken as linear. Where the rate passes zero downward,
    # the length has a maximum: its square exceeds the squared length at the earlier instant by rate^2 over the fall of
    # the rate, times the interval.
    square, rate = (place**2).sum(axis=1), (place * velocity).sum(axis=1)
    before, behind = rate[:-1], rate[1:]
    peaks = (before > 0.0) & (behind < 0.0)
    rise = np.divide(before**2, before - behind, where=peaks, out=np.zeros_like(before)) * np.diff(time)
    return square, np.where(peaks, square[:-1] + rise, square[1:])


class DemandSamples(NamedTuple):
    """Samples of a motion at T instants, from which extremes are read."""

    time: Array  # (T,) s
    place: Array  # (T, N, 2) m, horizontal displacements
    velocity: Array  # (T, N, 2) m/s
    isolator: Array  # (T, 2) N, horizontal force of the isolator
    contact: Array  # (T,) N, normal force of the isolator
    support: Array  # (T, K) N, normal forces of the supports; K = 0 in a model without single supports
    rotation: Array  # (T, N) rad, about the vertical; (T, 0) in a model whose bodies do not turn
    uplift: Array  # (T, K) m, gaps of the supports
    acceleration: Array  # (T, N, 2) m/s^2, absolute and horizontal

    @staticmethod
    def from_motion(motion: Trajectory) -> DemandSamples:
        """Return the samples of a motion: instants and histories; a history is empty where the motion has none."""
        support = motion.support_force
        return DemandSamples(
            time=motion.time,
            place=motion.position[:, :, :2],
            velocity=motion.velocity[:, :, :2],
            isolator=motion.isolator_force,
            contact=motion.contact_force,
            support=support,
            rotation=motion.vertical_rotation,
            uplift=motion.extra.get("uplift", np.zeros_like(support)),
            acceleration=motion.absolute_acceleration[:, :, :2],
        )

    def split_into_subsamples(self) -> list[DemandSamples]:
        """Return DECIMATION sets of samples: each takes every fifth sample and starts with another one."""
        firsts = range(min(DECIMATION, len(self.time)))
        return [DemandSamples(*(history[first::DECIMATION] for history in self)) for first in firsts]

    def largest_length(self, place: Array, velocity: Array) -> float:
        """Return the largest length, m, of the displacement `place` (T, 2), also between the samples."""
        return largest_displacement(self.time, place, velocity)

    def residual_and_creep(self, stick: list[tuple[float, float]]) -> tuple[float, float]:
        """
        Return the displacement at the start of the last rest, and the sum of the distances crept during all rests, m.

        stick: start and end of every rest, s. A regularized law of friction lets the platform creep while it rests.
        """
        place, creep, first = self.place[:, 0], 0.0, 0
        for begin, end in stick:
            first = int(np.searchsorted(self.time, begin))
            rest = place[first : np.searchsorted(self.time, end, side="right")]
            creep += float(np.hypot(*(rest - rest[:1]).T).max(initial=0.0))
        return float(np.hypot(*place[min(first, len(place) - 1)])), creep


ReadNumber = Callable[[DemandSamples], float]  # function that reads one number from samples
ReadNumbers = Callable[[DemandSamples], Sequence[float]]  # function that reads several numbers from samples


class DemandReader:
    """
    Reader of peaks, energies and counts of a motion, with their errors.

    An error is the sum of the sampling error, from subsets of the samples, and of the solution's, from less accurate
    runs of the same motion.
    """

    def __init__(self, motion: Trajectory) -> None:
        """Take the samples of the motion, subsets of every DECIMATION-th of them, and samples of less accurate runs."""
        self.motion, self.accuracy = motion, motion.accuracy
        # False for a motion that ended early: all of its numbers are then NaN
        self.answered = motion.status in FULL_LENGTH_OUTCOMES and len(motion.time) > 0
        self.samples = DemandSamples.from_motion(motion)
        self.decimated = self.samples.split_into_subsamples()
        self.others = self.accuracy.coarser if self.accuracy else ()
        self.coarser = [DemandSamples.from_motion(other) for other in self.others]

    def extreme(self, read: ReadNumber) -> Estimate:
        """Return a number that `read` computes from samples, with its error."""
        [estimate] = self.extremes(lambda samples: [read(samples)], 1)
        return estimate

    def extremes(self, read: ReadNumbers, count: int) -> tuple[Estimate, ...]:
        """Return the `count` numbers that one call of `read` computes from samples, with their errors."""
        if not self.answered:
            return (UNKNOWN_ESTIMATE,) * count
        values = read(self.samples)
        decimated, coarser = ([read(samples) for samples in each] for each in (self.decimated, self.coarser))
        estimates = []
        for n, value in enumerate(values):
            sampling = max(abs(subset[n] - value) for subset in decimated)
            estimates.append(Estimate(value, sampling + self._solution_error(value, [other[n] for other in coarser])))
        return tuple(estimates)

    def residual(self) -> Estimate:
        """Return the displacement of the platform in its last rest, m; its error includes the creep during rests."""
        if not self.answered:
            return UNKNOWN_ESTIMATE
        scene, stick = self.motion.scene, self.motion.stick
        yields = scene.dry_friction.elastic
        stick = stick[-1:] if yields else stick  # elastic friction springs back: no creep of earlier rests remains
        if not stick or stick[-1][1] < (1.0 - DURATION_TOLERANCE) * scene.duration:
            rests = scene.has_dry_friction or yields
            return Estimate(math.nan, math.nan, MOVING_AT_END if rests else NEVER_RESTS)
        if stick[-1][0] > self.samples.time[-1]:
            return Estimate(math.nan, math.nan, NOT_SAMPLED)
        value, creep = self.samples.residual_and_creep(stick)
        decimated = (
            samples.residual_and_creep(stick) for samples in self.decimated if samples.time[-1] >= stick[-1][0]
        )
        sampling = max(abs(place - value) + abs(way - creep) for place, way in decimated)
        others = [samples.residual_and_creep(motion.stick)[0] for samples, motion in zip(self.coarser, self.others)]
        return Estimate(value, creep + sampling + self._solution_error(value, others))

    def energy(self, read: Callable[[Energy], float]) -> Estimate:
        """Return an energy that `read` integrates over the samples, with its error."""
        if not self.answered:
            return UNKNOWN_ESTIMATE
        (energy, *coarser), decimated = self._energies
        value = read(energy)
        # the error of the trapezoidal rule grows at least like the spacing
        sampling = max(abs(read(subset) - value) for subset in decimated) / (DECIMATION - 1)
        others = [read(other) for other in coarser]
        return Estimate(value, sampling + self._solution_error(value, others, energy.friction_energy()))

    @cached_property
    def _energies(self) -> tuple[list[Energy], list[Energy]]:
        """Energies of the motion and of its less accurate runs, and energies from every DECIMATION-th sample."""
        energies = [compute_energy(motion) for motion in (self.motion, *self.others)]
        return energies, energies[0].split_into_subsamples(DECIMATION)

    def count(self, read: Callable[[Trajectory], float]) -> Estimate:
        """Return the number of events that `read` counts; its error is the largest difference to less accurate runs."""
        if not self.answered:
            return UNKNOWN_ESTIMATE
        value = read(self.motion)
        return Estimate(value, max((abs(value - read(other)) for other in self.others), default=math.nan))

    def peaks(self) -> tuple[Estimate, ...]:
        """Return the largest accelerations of all bodies, with their errors."""
        bodies = len(self.motion.scene.bodies)
        if not self.answered:
            return (UNKNOWN_ESTIMATE,) * bodies
        errors = self.accuracy.peak_error if self.accuracy else np.full(bodies, np.nan)
        return tuple(Estimate(float(value), float(error)) for value, error in zip(self.motion.peak, errors))

    def _solution_error(self, value: float, others: list[float], scale: float | None = None) -> float:
        """Return the numerical error of a value from `others`, its values in less accurate runs; NaN without any."""
        return math.nan if self.accuracy is None else self.accuracy.error_of(value, others, scale)
