"""Description of a recorded motion as it was read: size, peaks, zero line, and warnings about unlikely values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reference.records.samples import AXES, Array
from reference.support.constants import GRAVITY

LARGEST_PEAK, SMALLEST_PEAK = 3.0, 0.005  # g: peaks outside these limits give a warning; 0.005 g is 0.05 m/s^2
G_UNIT_QUESTION = (  # end of a warning that a peak is very small
    'values in g that are called m/s^2? Write [g] in the head of the file, or unit = "g" beside a plain text, '
    "which motions.csv has in its column unit"
)
MAX_STEP_VARIATION = 0.01  # relative difference of two steps above which a column of times counts as uneven
MIN_SAMPLES = 100  # in a record with fewer samples the zero line is not checked
# A warning is due if the final velocity exceeds this fraction of the largest departure of the velocity from a straight
# line between its ends. In 289 public records the fraction is at most 0.07.
MAX_FINAL_VELOCITY_SHARE = 0.2
MIN_CLIPPED_SAMPLES = 4  # at least this many equal samples in a row at the peak count as clipped
EQUAL_SAMPLE_TOLERANCE = 1e-9  # relative difference below which two samples count as equal


@dataclass(frozen=True)
class DirectionRead:
    """
    Peak, mean and final motion of one direction of a record as read, before it is scaled and detrended.

    Attributes
    ----------
    axis : str
        "x", "y" or "z".
    peak : float
        Largest size of the acceleration, m/s^2.
    mean : float
        Mean acceleration, m/s^2: the zero line.
    peak_velocity : float
        Largest size of the velocity, integrated from rest, m/s.
    final_velocity : float
        Velocity at the last sample, integrated from rest, m/s.
    final_displacement : float
        Displacement at the last sample, integrated from rest, m.
    """

    axis: str
    peak: float
    mean: float
    peak_velocity: float
    final_velocity: float
    final_displacement: float

    @property
    def mean_over_peak(self) -> float:
        """Ratio of the mean to the peak; 0 for a direction at rest."""
        return self.mean / self.peak if self.peak > 0.0 else 0.0


@dataclass(frozen=True)
class RecordDescription:
    """
    Description of a recorded motion as it was read.

    Attributes
    ----------
    title : str
        Its files, or suite and number.
    origin : tuple of str
        A line for every file with its format, and for everything that was ignored or repaired in it.
    samples : int
        Number of samples.
    step : float
        Median time from sample to sample, s.
    duration : float
        Time from the first to the last sample, s.
    directions : tuple of DirectionRead
        The recorded directions.
    scale : float
        Factor with which the scene takes them.
    detrend : str or None
        What the scene takes off every direction, "mean" or "linear".
    warnings : tuple of str
        One sentence on each value that is hardly intended.
    """

    title: str
    origin: tuple[str, ...]
    samples: int
    step: float
    duration: float
    directions: tuple[DirectionRead, ...]
    scale: float
    detrend: str | None
    warnings: tuple[str, ...]

    @property
    def lines(self) -> list[str]:
        """Return the description as lines of text."""
        # origin lines such as "x: a.csv, CSV" by their axis: they join the line of their direction
        along = {line[0]: line[3:] for line in self.origin if line[1:3] == ": " and line[0] in AXES}
        return [
            self._head,
            *(f"  {line}" for line in self.origin if line[3:] not in along.values()),
            *(
                f"  {one.axis}: {f'{along[one.axis]}: ' if one.axis in along else ''}peak {one.peak:.4g} m/s^2 = "
                f"{one.peak / GRAVITY:.4g} g, mean/peak {one.mean_over_peak:+.2g}, final velocity "
                f"{one.final_velocity:+.2g} m/s, final displacement {one.final_displacement:+.2g} m"
                for one in self.directions
            ),
            *(f"  Warning: {line}" for line in self.warnings),
        ]

    @property
    def short_lines(self) -> list[str]:
        """Return the description as one line of text, and a line for each warning."""
        peaks = ", ".join(f"{one.axis} {one.peak / GRAVITY:.3g} g" for one in self.directions)
        return [f"{self._head}, peaks {peaks or 'none'}", *(f"  Warning: {line}" for line in self.warnings)]

    @property
    def largest_peak(self) -> float:
        """The largest peak of the record's horizontal directions, times the scale, m/s^2."""
        return abs(self.scale) * max((one.peak for one in self.directions if one.axis != "z"), default=0.0)

    @property
    def _head(self) -> str:
        """Return a sentence on the number of samples, the step and the duration."""
        taken = f", times {self.scale:g}" if self.scale != 1.0 else ""
        taken += f', detrend = "{self.detrend}"' if self.detrend else ""
        return f"Record {self.title}: {self.samples} samples, step {self.step:.6g} s, {self.duration:.6g} s{taken}"

    def __str__(self) -> str:
        """Return the description as one text."""
        return "\n".join(self.lines)


def describe_samples(
    title: str, origin: Sequence[str], samples: Array, scale: float = 1.0, detrend: str | None = None
) -> RecordDescription:
    """
    Return the description of a record from its samples (K, 4): time, s, and accelerations along x, y and z, m/s^2.

    title, origin: as in `RecordDescription`. scale, detrend: what the scene will apply; the samples are without them.
    """
    time, steps = samples[:, 0], np.diff(samples[:, 0])
    step = float(np.median(steps))
    read, warnings = [], []
    with np.errstate(over="ignore", invalid="ignore"):
        for axis, values in zip(AXES, samples[:, 1:].T):
            if values.any():
                velocity = np.concatenate([[0.0], np.cumsum(0.5 * steps * (values[1:] + values[:-1]))])
                gains = steps * (velocity[:-1] + steps * (2.0 * values[:-1] + values[1:]) / 6.0)
                peak, mean = float(np.abs(values).max()), float(values.mean())
                fastest, last = float(np.abs(velocity).max()), float(velocity[-1])
                read.append(
                    DirectionRead(
                        axis=axis,
                        peak=peak,
                        mean=mean,
                        peak_velocity=fastest,
                        final_velocity=last,
                        final_displacement=float(gains.sum()),
                    )
                )
                warnings += _list_warnings(read[-1], values, velocity, time, detrend)
    largest = max((one.peak for one in read), default=0.0) / GRAVITY
    if largest > LARGEST_PEAK:
        warnings.append(f"the peak is {largest:.4g} g, above {LARGEST_PEAK:g} g: is the unit right?")
    elif largest < SMALLEST_PEAK:
        warnings.append(f"the peak is {largest:.4g} g, below {SMALLEST_PEAK:g} g: {G_UNIT_QUESTION}")
    if samples[:, 1].any() and np.array_equal(samples[:, 1], samples[:, 2]):
        warnings.append("x and y have the same samples: one file for both?")
    if np.ptp(steps) > MAX_STEP_VARIATION * step:
        warnings.append(f"the steps are not equal: {steps.min():.4g} to {steps.max():.4g} s")
    return RecordDescription(
        title=title,
        origin=tuple(origin),
        samples=len(samples),
        step=step,
        duration=float(time[-1]),
        directions=tuple(read),
        scale=scale,
        detrend=detrend,
        warnings=tuple(warnings),
    )


def _list_warnings(one: DirectionRead, values: Array, velocity: Array, time: Array, detrend: str | None) -> list[str]:
    """Return warnings about values of one direction that are hardly intended."""
    warnings = []
    # An offset of the zero line lets the velocity grow with time: the final velocity then far exceeds the departure of
    # the velocity from the straight line between its ends. With noise alone both are about equal.
    strayed = float(np.abs(velocity - velocity[-1] * time / time[-1]).max())
    drifts = abs(one.final_velocity) > MAX_FINAL_VELOCITY_SHARE * strayed
    if drifts and len(values) >= MIN_SAMPLES and detrend is None:
        warnings.append(
            f"{one.axis} ends at {one.final_velocity:+.3g} m/s with a mean of {one.mean:+.3g} m/s^2 "
            f"({100.0 * abs(one.mean_over_peak):.2g} % of its peak): a zero line left in? "
            'detrend = "mean" or "linear" in [excitation] takes it off'
        )
    # A clipped record stays at its peak: find the longest run of neighboring samples that equal the peak.
    at_limit = np.abs(values) >= one.peak * (1.0 - EQUAL_SAMPLE_TOLERANCE)
    ends = np.flatnonzero(np.diff(np.concatenate([[0], at_limit.astype(int), [0]])))
    longest = int((ends[1::2] - ends[::2]).max(initial=0))
    if longest >= MIN_CLIPPED_SAMPLES:
        warnings.append(f"{one.axis} stays at its peak of {one.peak:.4g} m/s^2 for {longest} samples: clipped?")
    return warnings
